// Runs test files as `node --test` does, with what starts once for all of them: a browser for each graphics back end, in
// which every test has a context of its own, and a folder of prepared stimuli.
//
//   node run.mjs [options of node --test] FILE...

import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";
import { backends, executable, launching } from "./lib/browser.mjs";

// Without Chromium each test says that it cannot run.
const servers = executable ? await Promise.all(backends.map(async (backend) => [backend, await chromium.launchServer(launching(backend))])) : [];
const packs = mkdtempSync(join(tmpdir(), "mimique-packs-"));
const env = {
  ...process.env,
  MIMIQUE_BROWSERS: JSON.stringify(Object.fromEntries(servers.map(([backend, server]) => [backend, server.wsEndpoint()]))),
  MIMIQUE_TEST_PACKS: packs,
};
// A test that fails before it has stopped its servers must not keep everything waiting.
const tests = spawn(process.execPath, ["--test", "--test-force-exit", ...process.argv.slice(2)], { env, stdio: "inherit" });
const [code, signal] = await new Promise((done) => tests.on("exit", (...ended) => done(ended)));
await Promise.all(servers.map(([, server]) => server.close()));
rmSync(packs, { recursive: true, force: true });
process.exitCode = signal ? 1 : code;
