// The same picture from the browser as from the offscreen stage: a head with a texture, and the
// built-in head in a strong expression, drawn by both canvases, next to the golden pictures of
// `crates/stage/tests/it/golden.rs`, same tolerances.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join, normalize } from "node:path";
import { test } from "node:test";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { mimique, root } from "./lib/server.mjs";
import { small, stimuli, trials } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");
const pages = process.env.MIMIQUE_WEB_DIR ?? join(root, "target/web-dist");
const golden = join(root, "crates/stage/tests/golden");
const types = { ".js": "text/javascript", ".wasm": "application/wasm", ".png": "image/png", ".html": "text/html" };
const blank = "<!doctype html><title>pictures</title><link rel=icon href=data:,><canvas id=canvas></canvas>";

// Mean difference of a colour byte, and the part of the pixels that are off by more than 12. Chromium's
// software differs from lavapipe along edges: by 0.225 and 0.08 % (egg), 0.18 and 0.38 % (head).
const MOST_MEAN = { egg: 0.75, head: 0.25 };
const MOST_OUTLIERS = 0.005;

/** The pack of a built-in head, as a study gets it. */
function headPack(seed) {
  const folder = mkdtempSync(join(tmpdir(), "mimique-head-"));
  const study = small("head", {
    components: { faces: trials(["joy2.box"], []) },
    sequence: { order: "fixed", components: ["faces"] },
    staticHosting: { download: true },
    stimuli: stimuli({ head: { builtin: { seed } } }, { box: { method: "box" } }, [["head", "box"]]),
  });
  writeFileSync(join(folder, "head.json"), JSON.stringify(study));
  const web = process.env.MIMIQUE_WEB_DIR ? ["--web-dir", process.env.MIMIQUE_WEB_DIR] : [];
  const places = ["--out", join(folder, "site"), "--packs", join(folder, "packs")];
  mimique(["export-site", join(folder, "head.json"), ...places, ...web]);
  const site = JSON.parse(readFileSync(join(folder, "site", "site.json"), "utf8"));
  const hash = /"avatar":"([0-9a-f]{64})"/.exec(JSON.stringify(site))[1];
  return join(folder, "site", "packs", hash);
}

const told = JSON.parse(readFileSync(join(golden, "head.json"), "utf8"));
const heads = {
  egg: { picture: "egg-picture.png", pack: () => join(golden, "egg-picture.mmav"), size: [192, 240], yaw: 0, weights: [0.3, 0.2, 0] },
  head: { picture: "head.png", pack: () => headPack(told.seed), ...told },
};

/** The pages' modules and the golden files, on the loopback interface. */
async function files(pack) {
  const server = createServer((request, response) => {
    const path = normalize(new URL(request.url, "http://localhost").pathname);
    const file = path.startsWith("/golden/") ? join(golden, path.slice(8)) : join(pages, path);
    let bytes = path === "/pack" ? pack : path === "/" ? Buffer.from(blank) : null;
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

const cases = Object.keys(heads).flatMap((name) => ["webgl2", "webgpu"].map((backend) => [name, backend]));
for (const [name, backend] of cases) {
  test(`pictures: the ${name} is the golden one, ${backend}`, { skip: unable, timeout: 120_000 }, async () => {
    const { picture, pack, ...pose } = heads[name];
    const server = await files(readFileSync(pack()));
    const browser = await open(backend);
    try {
      const { page } = browser;
      await page.goto(`${server.url}/?backend=${backend}`);
      const drawn = await page.evaluate(async ({ size: [width, height], yaw, weights: posed }) => {
        const { openStage, putClip } = await import("/stage/host.js");
        const pack = new Uint8Array(await (await fetch("/pack")).arrayBuffer());
        const weights = Float32Array.from(posed);
        await putClip({ clip: "head", avatarHash: "head", avatarPack: pack, weights, frames: 1, shapes: weights.length, rate_hz: 60 });
        const stage = await openStage(document.getElementById("canvas"), { width, height });
        stage.setView({ yaw });
        await stage.show("head", 0);
        // The device is lost and comes back with all its pictures.
        stage.lose();
        await new Promise(requestAnimationFrame);
        await stage.reopen();
        await stage.show("head", 0);
        return stage.state();
      }, pose);
      assert.equal(drawn.backend, backend);
      assert.equal(drawn.lost, null);
      const shot = await page.locator("#canvas").screenshot();
      writeFileSync(join(screenshotFolder("pictures"), `${name}-${backend}.png`), shot);
      const found = await page.evaluate(async ([shot, picture]) => {
        const pixels = async (address) => {
          const bitmap = await createImageBitmap(await (await fetch(address)).blob());
          const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
          context.drawImage(bitmap, 0, 0);
          return context.getImageData(0, 0, bitmap.width, bitmap.height);
        };
        const [here, there] = [await pixels(`data:image/png;base64,${shot}`), await pixels(`/golden/${picture}`)];
        let sum = 0;
        let outliers = 0;
        for (let at = 0; at < there.data.length; at += 4) {
          const off = [0, 1, 2].map((c) => Math.abs(here.data[at + c] - there.data[at + c]));
          sum += off[0] + off[1] + off[2];
          outliers += Math.max(...off) > 12 ? 1 : 0;
        }
        const count = there.data.length / 4;
        return { size: [here.width, here.height], mean: sum / (3 * count), outliers: outliers / count };
      }, [shot.toString("base64"), picture]);
      console.log(`  ${name}, ${backend}: mean ${found.mean.toFixed(3)}, outliers ${(100 * found.outliers).toFixed(2)} %`);
      assert.deepEqual(found.size, pose.size);
      assert.ok(found.mean <= MOST_MEAN[name] && found.outliers <= MOST_OUTLIERS, JSON.stringify(found));
      assert.deepEqual(browser.errors, []);
    } finally {
      await browser.close();
      server.close();
    }
  });
}
