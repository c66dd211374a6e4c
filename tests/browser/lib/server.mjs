// Starts `mimique serve` and `mimique preview` on the loopback interface, the server with its data in a new folder.

import { spawn, execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, symlinkSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

export const root = resolve(dirname(fileURLToPath(import.meta.url)), "../../..");
export const binary = process.env.MIMIQUE_BINARY ?? join(root, "target/release/mimique");

/** Runs `mimique` to its end; its standard output. Throws with its standard error on failure. */
export function mimique(args, options = {}) {
  return execFileSync(binary, args, { encoding: "utf8", cwd: root, maxBuffer: 1 << 28, ...options });
}

/** The servers of a run share their prepared stimuli (run.mjs): they are stored by the hash of all that they are made of. */
function sharePacks(folder) {
  const packs = process.env.MIMIQUE_TEST_PACKS;
  if (packs && !existsSync(join(folder, "packs"))) symlinkSync(packs, join(folder, "packs"));
}

/** A running server: `{url, folder, database, said(), log(), researcher(), stop()}`. */
export async function serve(studies, { folder = mkdtempSync(join(tmpdir(), "mimique-")), port, more = [] } = {}) {
  port ??= await freePort();
  sharePacks(folder);
  const database = `sqlite:${join(folder, "answers.sqlite")}`;
  const args = ["serve", ...studies, "--listen", `127.0.0.1:${port}`, "--database", database, "--data-dir", folder, "--open-preview", "--json", ...more];
  // In development the pages may lie in a folder instead of the binary.
  if (process.env.MIMIQUE_WEB_DIR) args.push("--web-dir", process.env.MIMIQUE_WEB_DIR);
  const child = spawn(binary, args, { cwd: root, stdio: ["ignore", "pipe", "pipe"] });
  let out = "";
  let err = "";
  child.stdout.on("data", (text) => (out += text));
  child.stderr.on("data", (text) => (err += text));
  const ended = new Promise((done) => {
    child.on("exit", (code, signal) => done({ code, signal }));
    // A program that is not there never exits.
    child.on("error", (error) => done({ code: error.message }));
  });
  const url = `http://127.0.0.1:${port}`;
  const deadline = Date.now() + 120_000;
  for (;;) {
    const state = await Promise.race([ended, ready(url)]);
    if (state === true) break;
    if (state && typeof state === "object") throw new Error(`the server ended (${state.code ?? state.signal}):\n${err}`);
    if (Date.now() > deadline) {
      child.kill("SIGKILL");
      throw new Error(`the server did not become ready in two minutes:\n${err}`);
    }
    await new Promise((done) => setTimeout(done, 50));
  }
  return {
    url,
    port,
    folder,
    database,
    said: () => out,
    log: () => err,
    /** The address that makes the first account, or the page to log in where there is one. */
    researcher: () => JSON.parse(out).researcher,
    kill: async () => {
      child.kill("SIGKILL");
      await ended;
    },
    stop: async () => {
      child.kill("SIGTERM");
      const kill = setTimeout(() => child.kill("SIGKILL"), 10_000);
      await ended;
      clearTimeout(kill);
    },
  };
}

async function ready(url) {
  try {
    return (await fetch(`${url}/readyz`)).ok;
  } catch {
    return false;
  }
}

function freePort() {
  return new Promise((done, fail) => {
    const probe = createServer();
    probe.on("error", fail);
    probe.listen(0, "127.0.0.1", () => {
      const { port } = probe.address();
      probe.close(() => done(port));
    });
  });
}

/** A running `mimique preview`: `{url, stop()}`. */
export async function preview(args) {
  const web = process.env.MIMIQUE_WEB_DIR ? ["--web-dir", process.env.MIMIQUE_WEB_DIR] : [];
  const child = spawn(binary, ["preview", ...args, "--listen", "127.0.0.1:0", "--json", ...web], { cwd: root, stdio: ["ignore", "pipe", "inherit"] });
  const line = await new Promise((resolve, reject) => {
    child.stdout.once("data", (text) => resolve(String(text)));
    child.once("exit", (code) => reject(new Error(`mimique preview ended (${code})`)));
  });
  const ended = new Promise((resolve) => child.once("exit", resolve));
  return { url: JSON.parse(line).url, stop: async () => (child.kill("SIGTERM"), ended) };
}
