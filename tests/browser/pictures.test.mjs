// The same picture from the browser as from the offscreen stage: a head with a texture, drawn by
// both canvases, next to the golden picture of `crates/stage/tests/golden.rs`, same tolerance.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { test } from "node:test";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { root } from "./lib/server.mjs";

const unable = skip(!executable && "Chromium not found");
const pages = process.env.MIMIQUE_WEB_DIR ?? join(root, "target/web-dist");
const golden = join(root, "crates/stage/tests/golden");
const types = { ".js": "text/javascript", ".wasm": "application/wasm", ".png": "image/png", ".html": "text/html" };
const blank = "<!doctype html><title>pictures</title><link rel=icon href=data:,><canvas id=canvas></canvas>";

// Mean difference of a colour byte, and the part of the pixels that are off by more than 12.
const MOST_MEAN = 0.75;
const MOST_OUTLIERS = 0.005;

/** The pages' modules and the golden files, on the loopback interface. */
async function files() {
  const server = createServer((request, response) => {
    const path = normalize(new URL(request.url, "http://localhost").pathname);
    const file = path.startsWith("/golden/") ? join(golden, path.slice(8)) : join(pages, path);
    let bytes = path === "/" ? Buffer.from(blank) : null;
    try {
      bytes ??= readFileSync(file);
    } catch {
      response.writeHead(404).end();
      return;
    }
    response.writeHead(200, { "content-type": types[path === "/" ? ".html" : extname(file)] ?? "application/octet-stream" });
    response.end(bytes);
  });
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  return { url: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}

for (const backend of ["webgl2", "webgpu"]) {
  test(`pictures: a textured head is the golden one, ${backend}`, { skip: unable, timeout: 120_000 }, async () => {
    const server = await files();
    const browser = await open(backend);
    try {
      const { page } = browser;
      await page.goto(`${server.url}/?backend=${backend}`);
      const drawn = await page.evaluate(async () => {
        const { openStage, putClip } = await import("/stage-host.js");
        const pack = new Uint8Array(await (await fetch("/golden/egg-picture.mmav")).arrayBuffer());
        const weights = Float32Array.of(0.3, 0.2, 0);
        await putClip({ clip: "egg", avatarHash: "egg", avatarPack: pack, weights, frames: 1, shapes: 3, rate_hz: 60 });
        const stage = await openStage(document.getElementById("canvas"), { width: 192, height: 240 });
        await stage.show("egg", 0);
        // The device is lost and comes back with all its pictures.
        stage.lose();
        await new Promise(requestAnimationFrame);
        await stage.reopen();
        await stage.show("egg", 0);
        return stage.state();
      });
      assert.equal(drawn.backend, backend);
      assert.equal(drawn.lost, null);
      const shot = await page.locator("#canvas").screenshot();
      writeFileSync(join(screenshotFolder("pictures"), `egg-picture-${backend}.png`), shot);
      const found = await page.evaluate(async (shot) => {
        const pixels = async (address) => {
          const bitmap = await createImageBitmap(await (await fetch(address)).blob());
          const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
          context.drawImage(bitmap, 0, 0);
          return context.getImageData(0, 0, bitmap.width, bitmap.height);
        };
        const [here, there] = [await pixels(`data:image/png;base64,${shot}`), await pixels("/golden/egg-picture.png")];
        let sum = 0;
        let outliers = 0;
        for (let at = 0; at < there.data.length; at += 4) {
          const off = [0, 1, 2].map((c) => Math.abs(here.data[at + c] - there.data[at + c]));
          sum += off[0] + off[1] + off[2];
          outliers += Math.max(...off) > 12 ? 1 : 0;
        }
        const count = there.data.length / 4;
        return { size: [here.width, here.height], mean: sum / (3 * count), outliers: outliers / count };
      }, shot.toString("base64"));
      console.log(`  ${backend}: mean ${found.mean.toFixed(3)}, outliers ${(100 * found.outliers).toFixed(2)} %`);
      assert.deepEqual(found.size, [192, 240]);
      assert.ok(found.mean <= MOST_MEAN && found.outliers <= MOST_OUTLIERS, JSON.stringify(found));
      assert.deepEqual(browser.errors, []);
    } finally {
      await browser.close();
      server.close();
    }
  });
}
