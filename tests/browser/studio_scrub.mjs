// How smoothly the studio scrubs with four faces: moves the play head through the take and prints the time between frames,
// the longest task of the page's thread, and what of it the page's own scripts and modules take. The rest is the browser's:
// where the processor draws (SwiftShader), the page's thread waits for the pictures. Not a test: machines differ.
//
//   node studio_scrub.mjs [--moves 200]

import { open } from "./lib/browser.mjs";
import { preview } from "./lib/server.mjs";
import { builtIn, fact } from "./lib/studio.mjs";

const at = process.argv.indexOf("--moves");
const moves = at < 0 ? 200 : Number(process.argv[at + 1]);
const shown = await preview([]);
const browser = await open("webgl2", { viewport: { width: 1440, height: 900 } });
try {
  const { page } = browser;
  await builtIn(page, { url: shown.url });
  for (const letter of ["B", "C", "D"]) {
    await page.click("#add-panel");
    await fact(page, letter, "Residual");
  }
  await page.waitForTimeout(3000);
  const profiler = await page.context().newCDPSession(page);
  await profiler.send("Profiler.enable");
  await profiler.send("Profiler.start");
  const found = await page.evaluate(async (moves) => {
    const tasks = [];
    const observer = new PerformanceObserver((list) => tasks.push(...list.getEntries().map(({ duration }) => duration)));
    observer.observe({ entryTypes: ["longtask"] });
    const scrub = document.querySelector("#scrub");
    const last = Number(scrub.max);
    const between = [];
    let before = await new Promise(requestAnimationFrame);
    for (let i = 0; i < moves; i++) {
      scrub.value = String(Math.round((last * i) / moves));
      scrub.dispatchEvent(new Event("input", { bubbles: true }));
      const now = await new Promise(requestAnimationFrame);
      between.push(now - before);
      before = now;
    }
    await new Promise((done) => setTimeout(done, 200));
    observer.disconnect();
    const vertices = document.querySelector("#avatar-facts").textContent;
    return { vertices, between: between.sort((a, b) => a - b), tasks: tasks.sort((a, b) => a - b) };
  }, moves);
  const { profile } = await profiler.send("Profiler.stop");
  // What has a place in a script or a module; calls into the browser, such as drawing one canvas into another, have none.
  const own = new Set(profile.nodes.filter(({ callFrame }) => callFrame.url !== "").map(({ id }) => id));
  const ownMs = profile.samples.reduce((sum, id, k) => sum + (own.has(id) ? profile.timeDeltas[k] / 1000 : 0), 0);
  const share = (q) => found.between[Math.min(found.between.length - 1, Math.floor(q * found.between.length))].toFixed(1);
  console.log(found.vertices);
  console.log(`${moves} moves, four faces: between frames median ${share(0.5)} ms, 95 % ${share(0.95)} ms, longest ${share(1)} ms`);
  console.log(`tasks of the page's thread over 50 ms: ${found.tasks.length}, longest ${(found.tasks.at(-1) ?? 0).toFixed(1)} ms`);
  console.log(`of each move the page's own scripts and modules take ${(ownMs / moves).toFixed(1)} ms`);
} finally {
  await browser.close();
  await shown.stop();
}
