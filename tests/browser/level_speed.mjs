// How long the page's module takes for the next level of an adaptive block, in Chromium at full speed and slowed down
// four times: the block of study-config/jnd-alpha.json, and the largest grid that a study may have.
//
//   node tests/browser/level_speed.mjs WEB_DIST
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { join, normalize, resolve } from "node:path";
import { open } from "./lib/browser.mjs";

const modules = resolve(process.argv[2] ?? "target/web-dist");
const types = { js: "text/javascript", wasm: "application/wasm" };

function answer(path) {
  if (path === "/") return { status: 200, type: "text/html", body: "<!doctype html><title>levels</title>" };
  try {
    return { status: 200, type: types[path.split(".").pop()] ?? "application/octet-stream", body: readFileSync(join(modules, normalize(path))) };
  } catch {
    return { status: 404, type: "text/plain", body: "" };
  }
}

const steps = (from, to, count) => [from, to, count];
const block = (levels, threshold, spread) => ({
  vary: { parameter: "alpha", from: 0, to: 1, levels },
  method: "lsts",
  against: "reference",
  rule: { questPlus: { threshold, spread, lapse: [0.02] } },
  trials: 40,
  question: "smoother",
  shown: [{ levels: "joy3.lsts@alpha=", against: "joy3.reference" }],
  steps: 40,
});
const blocks = {
  study: block(21, steps(0.05, 0.95, 19), [0.1, 0.2, 0.4]),
  largest: block(41, steps(0.01, 0.99, 1000), Array.from({ length: 20 }, (_, at) => 0.02 * (at + 1))),
};

const server = createServer((request, response) => {
  const { status, type, body } = answer(new URL(request.url, "http://localhost").pathname);
  response.writeHead(status, { "content-type": type }).end(body);
});
await new Promise((done) => server.listen(0, "127.0.0.1", done));
const browser = await open("webgl2");
try {
  const { page, context } = browser;
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  const cdp = await context.newCDPSession(page);
  for (const slowed of [1, 4]) {
    await cdp.send("Emulation.setCPUThrottlingRate", { rate: slowed });
    for (const [name, block] of Object.entries(blocks)) {
      const figures = await page.evaluate(async (block) => {
        const { nextLevel, levelsAhead } = await import("/adaptive/levels.js");
        const request = (step, answers) => JSON.stringify({ step, component: "limit", block, seed: 7, configHash: "h", slot: 1, answers });
        // As the page does while the step before the block stands there.
        const before = performance.now();
        await nextLevel(request("limit/1", []));
        const ready = performance.now() - before;
        const answers = [];
        const times = [];
        const ahead = [];
        for (let trial = 1; trial <= 40; trial++) {
          const start = performance.now();
          const event = JSON.parse(await nextLevel(request(`limit/${trial}`, answers)));
          times.push(performance.now() - start);
          const then = performance.now();
          levelsAhead();
          ahead.push(performance.now() - then);
          answers.push(event.level > 0.5 === event.left ? "right" : "left");
        }
        const [first, ...rest] = times;
        rest.sort((a, b) => a - b);
        ahead.sort((a, b) => a - b);
        return { ready_ms: ready, first_ms: first, median_ms: rest[19], longest_ms: rest[38], ahead_median_ms: ahead[20], ahead_longest_ms: ahead[39] };
      }, block);
      console.log(JSON.stringify({ block: name, slowed, ...figures }));
    }
  }
} finally {
  await browser.close();
  server.close();
}
