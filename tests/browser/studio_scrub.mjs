// How smoothly the studio scrubs with four faces: moves the play head through the take and prints the time between frames
// and the longest task of the page's thread. Not a test: machines differ.
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
  const share = (q) => found.between[Math.min(found.between.length - 1, Math.floor(q * found.between.length))].toFixed(1);
  console.log(found.vertices);
  console.log(`${moves} moves, four faces: between frames median ${share(0.5)} ms, 95 % ${share(0.95)} ms, longest ${share(1)} ms`);
  console.log(`tasks of the page's thread over 50 ms: ${found.tasks.length}, longest ${(found.tasks.at(-1) ?? 0).toFixed(1)} ms`);
} finally {
  await browser.close();
  await shown.stop();
}
