// The orders stored in the repository (crates/study/tests/golden), drawn by WebAssembly in Chromium: seed, hash
// of the configuration and participant give the same order as natively, where tests/it/golden_orders.rs draws
// them. Built as the page is, by `cargo xtask web`.

import assert from "node:assert/strict";
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { createServer } from "node:http";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, skip } from "./lib/browser.mjs";
import { root } from "./lib/server.mjs";

const unable = skip(executable ? false : "Chromium not found");
const module = join(root, "target/web-modules/bits");
const golden = join(root, "crates/study/tests/golden");

test("order: the stored orders are drawn in the browser, too", { skip: unable, timeout: 120_000 }, async () => {
  assert.ok(existsSync(join(module, "bits.js")), `${module} is not there; run cargo xtask web`);
  const types = { js: "text/javascript", wasm: "application/wasm" };
  const host = createServer(({ url }, answer) => {
    if (url === "/") return answer.writeHead(200, { "content-type": "text/html" }).end("<!doctype html><title>Orders</title>");
    const file = join(module, url.slice(1));
    if (!existsSync(file)) return answer.writeHead(404).end();
    answer.writeHead(200, { "content-type": types[url.split(".").at(-1)] }).end(readFileSync(file));
  });
  await new Promise((done) => host.listen(0, "127.0.0.1", done));
  const browser = await open("webgl2");
  try {
    await browser.page.goto(`http://127.0.0.1:${host.address().port}/`);
    const drawn = await browser.page.evaluate(async () => {
      const bits = await import("/bits.js");
      await bits.default();
      return Object.fromEntries(bits.order_names().map((name) => [name, bits.order_lines(name)]));
    });
    const kept = Object.fromEntries(readdirSync(golden).map((file) => [file.replace(/\.txt$/, ""), readFileSync(join(golden, file), "utf8")]));
    assert.ok(Object.keys(kept).length >= 10);
    assert.deepEqual(drawn, kept);
  } finally {
    await browser.close();
    host.closeAllConnections();
    host.close();
  }
});
