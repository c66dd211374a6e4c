// What a frame costs the page's thread: the time of the call that draws it (wasm and the browser's own
// side of WebGPU or WebGL2, not the drawing itself), and the frames per second that drawing in software
// reaches, at 1280 x 720. Not a test: figures.
//
//   node frame_cost.mjs [frames]          (MIMIQUE_DATA for ICT-FaceKit, else the built-in head alone)

import { existsSync } from "node:fs";
import { join } from "node:path";
import { open } from "./lib/browser.mjs";
import { preview, root } from "./lib/server.mjs";

const frames = Number(process.argv[2] ?? 300);
const ict = join(process.env.MIMIQUE_DATA ?? join(root, "../shared/data"), "ict-facekit/ict-facekit.glb");
const heads = [["built-in head", []], ...(existsSync(ict) ? [["ICT-FaceKit", [ict]]] : [])];

// In the page: the canvas module by itself, on a canvas of its own, with the head that the studio has.
async function measure(frames) {
  const script = document.querySelector('script[src*="studio.js"]').src;
  const { callWorker } = await import(new URL("./worker-calls.js", script));
  const { backend, loadModule } = await import(new URL("../stage/host.js", script));
  const module = await loadModule(await backend());
  const element = document.createElement("canvas");
  [element.width, element.height] = [1280, 720];
  element.style.cssText = "position:fixed;inset:0;width:1280px;height:720px;z-index:9";
  document.body.append(element);
  const canvas = await module.Canvas.open(element, 1280, 720, "#808080", "stimulus");
  const shapes = canvas.loadAvatar("head", await callWorker("avatarPack"), new Uint32Array(0), []);
  const weights = new Float32Array(shapes);
  const costs = [];
  let began = 0;
  while (costs.length < frames + 20) {
    await new Promise(requestAnimationFrame);
    for (let k = 0; k < shapes; k++) weights[k] = 0.5 + 0.5 * Math.sin(costs.length * 0.1 + k);
    const start = performance.now();
    if (!canvas.draw("head", weights, 0, 0, 1)) continue;
    costs.push(performance.now() - start);
    // The first frames compile shaders.
    if (costs.length === 20) began = performance.now();
  }
  const seconds = (performance.now() - began) / 1000;
  return { adapter: canvas.adapter(), shapes, costs: costs.slice(20), rate: frames / seconds };
}

for (const backend of ["webgl2", "webgpu"]) {
  for (const [name, args] of heads) {
    const server = await preview(args);
    const browser = await open(backend, { viewport: { width: 1280, height: 800 } });
    try {
      const { page } = browser;
      await page.goto(`${server.url}?backend=${backend}`);
      if (args.length === 0) await page.click("#avatar-built-in");
      await page.waitForFunction(() => / shapes/.test(document.querySelector("#avatar-facts").textContent), null, { timeout: 120_000 });
      const { costs, rate, shapes, adapter } = await page.evaluate(measure, frames);
      const sorted = costs.sort((a, b) => a - b);
      const at = (part) => sorted[Math.floor(part * (sorted.length - 1))].toFixed(2);
      const mean = (costs.reduce((sum, each) => sum + each, 0) / costs.length).toFixed(2);
      console.log(`${backend}, ${name} (${shapes} shapes): call to draw ${at(0.5)} ms median, ${mean} ms mean, ${at(0.95)} ms at 95 %; ${rate.toFixed(1)} frames per second at 1280 x 720 on ${adapter || "a software adapter"}`);
    } finally {
      await browser.close();
      await server.stop();
    }
  }
}
