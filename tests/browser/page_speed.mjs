// How fast the participant's page is over 10 Mbit/s (40 ms round trip) on a processor slowed down four
// times: time until the first page, the first question and the first clip. Not a test: figures.
//
//   node page_speed.mjs [times]

import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { open } from "./lib/browser.mjs";
import { serve } from "./lib/server.mjs";
import { small, stimuli, text, trials } from "./lib/small_study.mjs";

const times = Number(process.argv[2] ?? 5);
const rating = { id: "rating", type: "likert", prompt: text("How strong?"), numItems: 7, leftLabel: text("weak"), rightLabel: text("strong") };
const study = small("speed", {
  demographics: { questions: [{ ...rating, id: "mood" }] },
  questions: [rating],
  components: { faces: trials(["joy2.lsts"], ["rating"]) },
  sequence: { order: "fixed", components: ["faces"] },
  stimuli: stimuli({ head: { builtin: { seed: 1 } } }, { lsts: { method: "lsts", alpha: 0.3 } }, [["head", "lsts"]]),
});
const folder = mkdtempSync(join(tmpdir(), "mimique-speed-"));
writeFileSync(join(folder, "speed.json"), JSON.stringify(study));
const server = await serve([join(folder, "speed.json")]);

// When each view or phase first stood there; and a participant who presses at once.
const watcher = () => {
  window.__seen = {};
  // The first command to the graphics driver after "play" was pressed: all has arrived, is solved and loaded.
  const drawing = (prototype, names) => {
    for (const name of names) {
      const draw = prototype?.[name];
      if (!draw) continue;
      prototype[name] = function (...given) {
        if (window.__seen["trial playing"] !== undefined && window.__seen.drawn === undefined) {
          window.__seen.drawn = performance.now();
          window.firstDrawn("");
        }
        return draw.apply(this, given);
      };
    }
  };
  drawing(globalThis.WebGL2RenderingContext?.prototype, ["drawElements", "drawElementsInstanced", "drawArrays", "drawArraysInstanced"]);
  drawing(globalThis.GPUQueue?.prototype, ["submit"]);
  const pressed = new Set();
  const press = (name, selector) => {
    const element = document.querySelector(`main ${selector}`);
    if (!pressed.has(name) && element && element.getAttribute("aria-disabled") !== "true") {
      pressed.add(name);
      element.click();
    }
  };
  setInterval(() => {
    const main = document.querySelector("main[data-view]");
    if (!main) return;
    const phase = main.querySelector("[data-phase]")?.dataset.phase ?? main.dataset.phase;
    for (const name of [main.dataset.view, phase && `trial ${phase}`]) {
      if (name && !(name in window.__seen)) {
        window.__seen[name] = null;
        requestAnimationFrame(() => (window.__seen[name] = performance.now()));
      }
    }
    if (main.dataset.view === "consent") press("agree", "[data-action=agree]");
    if (main.dataset.view === "questions" && window.__seen.questions) {
      press("answer", "input");
      if (main.querySelector("input:checked")) press("next", "[data-action=next]");
    }
    if (phase === "ready") press("play", "[data-action=play]");
  }, 20);
};

const results = [];
// The browser as it is started for WebGPU in software is slower before the page does anything: its WebGL2, too.
const rows = [["webgl2", "webgl2"], ["webgpu", "webgpu"], ["webgl2", "webgpu"]];
for (const [backend, started] of rows) {
  for (let time = 0; time < times; time++) {
    const browser = await open(started, { viewport: { width: 1280, height: 800 } });
    try {
      const { page, context } = browser;
      const cdp = await context.newCDPSession(page);
      await cdp.send("Network.enable");
      await cdp.send("Network.emulateNetworkConditions", { offline: false, latency: 40, downloadThroughput: 1.25e6, uploadThroughput: 1.25e6 });
      await cdp.send("Emulation.setCPUThrottlingRate", { rate: 4 });
      await page.addInitScript(watcher);
      // The page says itself when it draws: what asks it over and over takes a tenth of a second of its own.
      await cdp.send("Runtime.enable");
      await cdp.send("Runtime.addBinding", { name: "firstDrawn" });
      const drawn = new Promise((told) => cdp.on("Runtime.bindingCalled", told));
      // The page's own log says when the first frame of the play was presented.
      const onset = new Promise((logged) => {
        page.on("request", (request) => {
          const found = /"onset_ms":([0-9.]+)/.exec(request.postData() ?? "");
          if (found && Number(found[1]) > 0) logged(Number(found[1]));
        });
      });
      await page.goto(`${server.url}/s/speed/?backend=${backend}`);
      await Promise.race([drawn, page.waitForTimeout(120_000).then(() => Promise.reject(new Error("nothing was drawn in 120 s")))]);
      const shown = (await onset) - (await page.evaluate(() => performance.timeOrigin));
      const seen = await page.evaluate(() => window.__seen);
      const bytes = await page.evaluate(() => performance.getEntriesByType("resource").reduce((sum, each) => sum + each.transferSize, 0));
      results.push({ backend, started, consent: seen.consent, question: seen.questions, ready: seen["trial ready"], drawn: seen.drawn, shown, bytes });
    } finally {
      await browser.close();
    }
  }
}
await server.stop();
const median = (list) => [...list].sort((a, b) => a - b)[list.length >> 1];
for (const [backend, started] of rows) {
  const of = (key) => results.filter((each) => each.backend === backend && each.started === started).map((each) => each[key]);
  const seconds = (key) => (median(of(key)) / 1000).toFixed(2);
  console.log(`${backend}, browser started for ${started}: first page ${seconds("consent")} s, first question ${seconds("question")} s, clip ready ${seconds("ready")} s, first drawing command ${seconds("drawn")} s, first frame of the play shown ${seconds("shown")} s; ${(median(of("bytes")) / 1e6).toFixed(2)} MB (median of ${times})`);
}
