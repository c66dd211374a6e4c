// A module that panics in a browser: the message and the place reach the server's log, the values that the
// message holds do not, and the page goes on.

import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, skip } from "./lib/browser.mjs";
import { root, serve } from "./lib/server.mjs";

const unable = skip(executable ? false : "Chromium not found");
const module = join(root, "target/web-modules/panicking");

test("panic: a solver's panic is in the server's log, without values", { skip: unable, timeout: 120_000 }, async () => {
  assert.ok(existsSync(join(module, "panicking.js")), `${module} is not there; run cargo xtask web`);
  const server = await serve([join(root, "study-config/demo.json")]);
  const browser = await open("undrawn");
  try {
    const { page } = browser;
    const instead = (name, contentType) => ({ contentType, body: readFileSync(join(module, name)) });
    // The routes of a page do not see what its workers ask for; those of its context do.
    await page.context().route("**/solver.js", (route) => route.fulfill(instead("panicking.js", "text/javascript")));
    await page.context().route("**/panicking_bg.wasm", (route) => route.fulfill(instead("panicking_bg.wasm", "application/wasm")));
    const console = [];
    page.on("console", (message) => console.push(message.text()));
    await page.goto(`${server.url}/preview/demo`);
    const { clips } = await (await fetch(`${server.url}/api/studies/demo`)).json();
    const [id, source] = Object.entries(clips).find(([, clip]) => clip.operators !== "");
    const said = await page.evaluate(async ([id, source]) => {
      const page = document.querySelector('script[type="module"][src*="preview.js"]').src;
      const { prepareClip } = await import(new URL("../stage/host.js", page).href);
      return prepareClip(id, source).then(() => "solved", (error) => error.message);
    }, [id, source]);
    assert.match(said, /^solver: /, "the clip is refused");
    const line = await logged(server, /a module panicked in a browser.*/);
    for (const part of ['module="solver"', 'study="demo"', 'panic="a planted panic: \\"…\\""', 'place="web/panicking/src/lib.rs:']) {
      assert.ok(line.includes(part), `${part} in ${line}`);
    }
    assert.ok(!server.log().includes("my-secret-answer"), server.log());
    assert.ok(console.some((text) => text.includes("my-secret-answer")), `the console has all of it: ${console}`);
  } finally {
    await browser.close();
    await server.stop();
  }
});

/** The first match in what the server logs, as soon as it is there. */
async function logged(server, pattern) {
  for (let tries = 0; tries < 100; tries++) {
    const found = pattern.exec(server.log());
    if (found) return found[0];
    await new Promise((done) => setTimeout(done, 100));
  }
  throw new Error(`no ${pattern} in the log:\n${server.log()}`);
}
