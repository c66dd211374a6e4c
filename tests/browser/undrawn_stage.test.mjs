// The stage of tests that draws nothing (lib/undrawn_stage.js) is used as the one that draws: the same exports, the same
// number of blendshapes of a pack, the same refusals.

import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, skip } from "./lib/browser.mjs";
import { packageHost } from "./lib/package_host.mjs";
import { root } from "./lib/server.mjs";

const unable = skip(!executable && "Chromium not found");
const pages = process.env.MIMIQUE_WEB_DIR ?? join(root, "target/web-dist");
const texts = { "/page": "<!doctype html><title>stages</title>" };

/** What a page can do with the canvas module that it is given. */
async function used(backend, url) {
  const browser = await open(backend);
  try {
    await browser.page.goto(`${url}/page`);
    const found = await browser.page.evaluate(async () => {
      const { default: initialize, Canvas } = await import("/stage_webgl.js");
      await initialize();
      const own = (object) => Object.getOwnPropertyNames(object).filter((name) => typeof object[name] === "function" && !name.startsWith("__"));
      const exports = [...own(Canvas.prototype), ...own(Canvas)].filter((name) => !["constructor", "prototype"].includes(name)).sort();
      const pack = async (name) => new Uint8Array(await (await fetch(`/golden/${name}`)).arrayBuffer());
      const said = (act) => { try { return act(); } catch (error) { return error.message; } };
      const element = document.body.appendChild(document.createElement("canvas"));
      [element.width, element.height] = [32, 32];
      const canvas = await Canvas.open(element, 32, 32, "#204060", "stimulus");
      const head = await pack("egg-picture.mmav");
      const pictures = [Uint32Array.of(1), [new Uint8Array(4)]];
      const shapes = canvas.loadAvatar("egg", head, ...pictures);
      const weights = new Float32Array(shapes);
      const results = {
        exports,
        shapes,
        has: [canvas.hasAvatar("egg"), canvas.hasAvatar("other")],
        drawn: canvas.draw("egg", weights, 0, 0, 1),
        other: said(() => canvas.draw("other", weights, 0, 0, 1)),
        look: said(() => canvas.setLook("", "other")),
        colour: said(() => canvas.setLook("red", "stimulus")),
        lost: canvas.lost() ?? null,
      };
      canvas.resize(16, 16);
      canvas.lose();
      const after = [canvas.lost(), said(() => canvas.draw("egg", weights, 0, 0, 1))];
      canvas.dropAvatar("egg");
      const dropped = canvas.hasAvatar("egg");
      canvas.free();
      return { ...results, after, dropped, adapter: undefined };
    });
    assert.deepEqual(browser.errors, []);
    return { found, requests: browser.requests.filter((address) => /_bg\.wasm/.test(address)).length };
  } finally {
    await browser.close();
  }
}

test("undrawn stage: used as the one that draws", { skip: unable, timeout: 120_000 }, async () => {
  const host = await packageHost({ "/golden/": join(root, "crates/stage/tests/golden"), "/": pages }, texts);
  try {
    const [drawn, undrawn] = [await used("webgl2", host.url), await used("undrawn", host.url)];
    assert.deepEqual([drawn.requests, undrawn.requests], [1, 0], "the module of the pages, and the one in its place");
    assert.ok(drawn.found.shapes > 0 && drawn.found.drawn, JSON.stringify(drawn.found));
    assert.deepEqual(undrawn.found, drawn.found);
  } finally {
    await host.close();
  }
});
