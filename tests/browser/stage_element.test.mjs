// The element <mimique-stage> in pages of somebody else, from files as npm installs them: clips of packs and of files, plays
// with their logs, errors, sizes, elements that leave the page and come back.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { taken } from "./lib/guide_picture.mjs";
import { exportedClips } from "./lib/exported_clips.mjs";
import { packageHost, unpacked } from "./lib/package_host.mjs";
import { settled } from "./lib/participant.mjs";
import { mimique } from "./lib/server.mjs";

const unable = skip(executable ? false : "Chromium not found");
const page = `<!doctype html><meta charset="utf-8"><title>Embedding</title>
<script type="module" src="/node_modules/@mimique/stage/element.js"></script>
<style>mimique-stage { width: 200px; }</style><body></body>`;
const SITE = { src: "/site/site.json", clip: "joy2.box" };
let host, browser, exported, samples;

before(async () => {
  if (unable) return;
  exported = exportedClips();
  samples = join(mkdtempSync(join(tmpdir(), "mimique-samples-")), "sample");
  mimique(["sample", "--out", samples]);
  host = await packageHost({ "/site/": exported.folder, "/samples/": samples, ...unpacked }, { "/page": page, "/broken.json": "{", "/empty.json": "{}" });
  browser = await open("webgl2");
});
after(async () => {
  await browser?.close();
  await host?.close();
});

/** A fresh page with elements of these attributes; their place in the page is their number. */
async function shown(...elements) {
  await browser.page.goto(`${host.url}/page?backend=webgl2`);
  await browser.page.evaluate(async (elements) => {
    await customElements.whenDefined("mimique-stage");
    window.stages = elements.map((attributes) => {
      const stage = document.createElement("mimique-stage");
      for (const [name, value] of Object.entries(attributes)) stage.setAttribute(name, value);
      stage.heard = [];
      for (const type of ["progress", "ready", "onset", "played", "error"]) stage.addEventListener(`stage-${type}`, ({ detail }) => stage.heard.push([type, detail.message ?? detail.part ?? detail]));
      document.body.append(stage);
      return stage;
    });
  }, elements);
  return browser.page;
}

const picture = (page, k = 0) => page.locator("mimique-stage").nth(k).screenshot();

test("element: a clip of packs has the weights of its description, and a whole log", { skip: unable, timeout: 180_000 }, async () => {
  const page = await shown(SITE);
  const source = exported.clips["joy2.box"];
  const found = await page.evaluate(async () => {
    const [stage] = stages;
    const summary = await stage.ready;
    const log = await stage.play();
    return { summary, log, state: stage.state, time: stage.time, duration: stage.duration, heard: stage.heard, ended: performance.now() };
  });
  assert.equal(found.summary.weights_hash, source.weights_hash, "the same bits as where it was exported");
  assert.deepEqual([found.summary.clip, found.state, found.duration, found.time], ["joy2.box", "ready", source.duration_ms, source.duration_ms]);
  const { log } = found;
  assert.deepEqual([log.provenance, log.weights_hash, log.renderer, log.aborted], [source.provenance, source.weights_hash, "@mimique/stage@0.1.0", null]);
  assert.deepEqual([log.clips, log.backend], [["joy2.box"], "webgl2"]);
  assert.ok(log.frames.length > 3 && log.frames.at(-1)[1] === source.duration_ms, `${log.frames.length} frames to the end`);
  assert.ok(log.onset_ms === log.frames[0][0] && log.end_ms < found.ended);
  const types = found.heard.map(([type]) => type).filter((type, k, all) => type !== all[k - 1]);
  assert.deepEqual(types, ["progress", "ready", "onset", "played"]);
  assert.equal(found.heard.find(([type]) => type === "onset")[1].onset_ms, log.onset_ms);
  assert.deepEqual(found.heard.filter(([type]) => type === "progress").at(-1), ["progress", 1]);
  assert.ok(!host.requests.some((path) => path.includes("studio")), "the studio's module is not loaded for packs");
});

test("element: it is sought, turned and sized; the picture follows", { skip: unable, timeout: 180_000 }, async () => {
  const page = await shown({ ...SITE, background: "#204060", label: "Somebody smiles" });
  const size = () => page.evaluate(() => {
    const canvas = stages[0].shadowRoot.querySelector("canvas");
    return [canvas.width, canvas.height];
  });
  await page.evaluate(() => stages[0].ready);
  const first = await picture(page);
  await page.evaluate(() => stages[0].seek(stages[0].duration / 2));
  const middle = await picture(page);
  assert.ok(!first.equals(middle), "another frame is another picture");
  await page.evaluate(async () => (stages[0].view({ yaw: 0.7 }), await new Promise((done) => setTimeout(done, 500))));
  assert.ok(!middle.equals(await picture(page)), "a turned head is another picture");
  await page.evaluate(async () => (stages[0].view({ yaw: 0 }), await stages[0].seek(0)));
  assert.ok(first.equals(await picture(page)), "back at the first frame it is the first picture");
  assert.deepEqual(await size(), [200, 200]);
  await page.evaluate(() => (stages[0].style.width = "320px"));
  await page.waitForFunction(() => stages[0].shadowRoot.querySelector("canvas").width === 320);
  assert.deepEqual(await size(), [320, 320]);
  assert.equal(await page.getByRole("img", { name: "Somebody smiles" }).count(), 1, "it is heard as a picture with its label");
  await page.evaluate(() => stages[0].seek(stages[0].duration / 2));
  await page.locator("mimique-stage").screenshot({ path: join(screenshotFolder("stage_element"), "one.png") });
  const refused = await page.evaluate(() => stages[0].seek(NaN).catch((error) => [error.code, error.message]));
  assert.deepEqual(refused, ["time", `mimique-stage: seek(NaN): no time; give milliseconds from 0 to ${exported.clips["joy2.box"].duration_ms.toFixed(0)}`]);
});

test("element: nine of them play in step, one clip in turn; a pause keeps the frame", { skip: unable, timeout: 240_000 }, async () => {
  const page = await shown(...Array.from({ length: 9 }, (_, k) => ({ ...SITE, clip: k % 2 ? "joy2.soft" : "joy2.box" })));
  await page.addStyleTag({ content: "mimique-stage { width: 90px !important }" });
  const { together, after, inTurn } = await page.evaluate(async () => {
    const [first, ...beside] = stages;
    const together = await first.play({ beside });
    const after = stages.map((stage) => [stage.state, stage.time === stage.duration]);
    const inTurn = await first.play({ beside: [beside[0]], inTurn: true });
    return { together, after, inTurn };
  });
  assert.equal(together.aborted, null);
  assert.deepEqual(together.clips, Array.from({ length: 9 }, (_, k) => (k % 2 ? "joy2.soft" : "joy2.box")));
  assert.equal(together.panel.length, 9);
  assert.deepEqual(together.panel.slice(0, 2).map(({ provenance }) => provenance), [exported.clips["joy2.box"].provenance, exported.clips["joy2.soft"].provenance]);
  assert.deepEqual(after, Array(9).fill(["ready", true]));
  assert.ok(together.drift_ms <= together.longest_ms, `in step within a frame: ${together.drift_ms} of ${together.longest_ms} ms`);
  assert.equal(inTurn.frames.at(-1)[1], 2 * exported.clips["joy2.box"].duration_ms, "one after the other");
  await page.screenshot({ path: join(screenshotFolder("stage_element"), "nine.png") });
  const paused = await page.evaluate(async () => {
    const [stage] = stages;
    const twice = await Promise.all([stage.play({ told: { frame: (_, ms) => ms > 300 && stage.pause() } }), stage.play().catch((error) => error.message)]);
    return { aborted: twice[0].aborted, refused: twice[1], time: stage.time, last: twice[0].frames.at(-1)[1], state: stage.state };
  });
  assert.deepEqual([paused.aborted, paused.state], ["paused", "ready"]);
  assert.ok(paused.time > 300 && paused.time === paused.last && paused.time < exported.clips["joy2.box"].duration_ms, `${paused.time} ms`);
  assert.equal(paused.refused, "mimique-stage: clip joy2.box is playing; stop it first, or await its log");
});

test("element: moved it keeps its canvas, taken out it gives it back, and it comes back", { skip: unable, timeout: 180_000 }, async () => {
  const page = await shown(SITE);
  const found = await page.evaluate(async () => {
    const [stage] = stages;
    await stage.ready;
    const canvas = () => stage.shadowRoot.querySelector("canvas");
    const first = canvas();
    const box = document.body.appendChild(document.createElement("div"));
    box.append(stage);
    await new Promise((done) => setTimeout(done, 100));
    const moved = [canvas() === first, stage.state];
    const play = stage.play({ told: { frame: () => stage.remove() } });
    const { aborted } = await play;
    await new Promise((done) => setTimeout(done, 100));
    const out = [canvas(), stage.state, first.getContext("webgl2").isContextLost()];
    const refused = await stage.ready.catch((error) => error.code);
    box.append(stage);
    const summary = await stage.ready;
    const again = (await stage.play()).aborted;
    // Twenty elements, one after the other: more than browsers have contexts for.
    for (let k = 0; k < 20; k++) {
      const one = document.createElement("mimique-stage");
      for (const { name, value } of stage.attributes) if (name !== "state") one.setAttribute(name, value);
      box.append(one);
      await one.ready;
      one.remove();
    }
    await new Promise((done) => setTimeout(done, 100));
    return { moved, aborted, out, refused, again, frames: summary.frames, lost: canvas().getContext("webgl2").isContextLost() };
  });
  assert.deepEqual(found.moved, [true, "ready"]);
  assert.equal(found.aborted, "removed from the page");
  assert.deepEqual(found.out, [null, "empty", true]);
  assert.deepEqual([found.refused, found.again, found.lost], ["detached", null, false]);
});

test("element: by WebGPU it plays, goes and comes back, too", { skip: unable, timeout: 180_000 }, async () => {
  const own = await open("webgpu");
  try {
    await own.page.goto(`${host.url}/page?backend=webgpu`);
    const found = await own.page.evaluate(async (attributes) => {
      await customElements.whenDefined("mimique-stage");
      const stage = document.createElement("mimique-stage");
      Object.assign(stage, attributes);
      document.body.append(stage);
      const first = await stage.play();
      stage.remove();
      await new Promise((done) => setTimeout(done, 100));
      const { state } = stage;
      document.body.append(stage);
      const second = await stage.play();
      return { state, logs: [first, second].map(({ backend, aborted, weights_hash: hash }) => [backend, aborted, hash]) };
    }, SITE);
    const log = ["webgpu", null, exported.clips["joy2.box"].weights_hash];
    assert.deepEqual(found, { state: "empty", logs: [log, log] });
  } finally {
    await own.close();
  }
});

test("element: a clip of files has the bits of mimique solve", { skip: unable, timeout: 240_000 }, async () => {
  const file = (name) => join(samples, name);
  const settings = JSON.stringify({ method: "lsts", alpha: 0.3 });
  mimique(["solve", "--avatar", file("head.glb"), "--mocap", file("take.c3d"), "--markers", file("markers.json"), "--method", "lsts", "--alpha", "0.3", "--out", file("solved.csv"), "--report", file("report.json")]);
  const report = JSON.parse(readFileSync(file("report.json"), "utf8"));
  const page = await shown({ avatar: "/samples/head.glb", capture: "/samples/take.c3d", map: "/samples/markers.json", method: settings });
  const found = await page.evaluate(async () => {
    const [stage] = stages;
    const whole = await stage.ready;
    stage.frames = "60:360";
    const part = await stage.ready;
    const log = await stage.play();
    // Files that somebody chose, and weights that were recorded.
    const weights = new File([await (await fetch("/samples/weights.csv")).text()], "weights.csv");
    stage.frames = stage.map = stage.method = null;
    stage.capture = weights;
    return { whole, part, log, recorded: await stage.ready, state: stage.state, words: stage.shadowRoot.querySelector("p").textContent };
  });
  assert.equal(found.whole.weights_hash, report.weights_hash);
  assert.deepEqual([found.part.frames, found.part.clip, found.part.weights_hash], [300, "take.c3d 60:360", ""]);
  assert.ok(found.log.frames.length > 3 && found.log.provenance.length === 64);
  assert.deepEqual([found.recorded.clip, found.state, found.words], ["weights.csv", "ready", ""]);
});

test("element: what is wrong is said with its place, value and remedy", { skip: unable, timeout: 240_000 }, async () => {
  const cases = [
    [{}, "attribute", /no clip is given; give src, or the property source, or avatar and capture$/],
    [{ src: "/nowhere.json" }, "attribute", /^mimique-stage: src="http:\S+\/nowhere\.json": the host answered 404; give the address of a file that is there$/],
    [{ src: "http://127.0.0.1:9/x.json" }, "attribute", /not reached \(.*\); see that the host runs/],
    [{ src: "/broken.json" }, "attribute", /no JSON \(.*\); give the address of a clip's description/],
    [{ src: "/empty.json" }, "description", /avatar is missing instead of a text; take it as mimique describes it/],
    [{ src: "/site/site.json" }, "attribute", /2 clips are described there, and attribute clip is empty; name one of: joy2\.box, joy2\.soft$/],
    [{ ...SITE, clip: "joy3" }, "attribute", /^mimique-stage: clip="joy3": no such clip is described there; there are: joy2\.box, joy2\.soft$/],
    [{ ...SITE, packs: "/nowhere/" }, "refused", /^mimique-stage: clip joy2\.box: pack [0-9a-f]{12}: the server answered 404; asked was http:\S+\/nowhere: let packs name the folder that has them$/],
    [{ ...SITE, avatar: "built-in" }, "attribute", /a clip is given in 2 ways \(src, avatar\)/],
    [{ avatar: "built-in" }, "attribute", /avatar is given, capture is not; give the address of a capture/],
    [{ avatar: "built-in", capture: "built-in", method: "{" }, "attribute", /^mimique-stage: method="\{": no JSON .*write a name/],
    [{ avatar: "built-in", capture: "built-in", method: '{"method": "lsts", "alpha": -1}' }, "method", /alpha/],
    [{ avatar: "built-in", capture: "built-in", frames: "9:3" }, "attribute", /^mimique-stage: frames="9:3": no part of the \d+ frames of the capture; write FIRST:END, such as 0:\d+$/],
    [{ avatar: "/samples/take.c3d", capture: "built-in" }, "failed", /^mimique-stage: take\.c3d: /],
  ];
  const page = await shown(...cases.map(([attributes]) => attributes));
  const found = await page.evaluate(() => Promise.all(stages.map(async (stage) => {
    const error = await stage.ready.then(() => null, (error) => error);
    const box = stage.shadowRoot.querySelector("p");
    return { code: error?.code, message: error?.message, told: stage.heard.filter(([type]) => type === "error").length, state: stage.state, words: box.hidden ? "" : box.textContent };
  })));
  for (const [k, [attributes, code, words]] of cases.entries()) {
    const of = JSON.stringify(attributes);
    assert.match(found[k].message ?? "", words, of);
    assert.equal(found[k].code, code, of);
    const isEmpty = k === 0;
    assert.deepEqual([found[k].told, found[k].state, found[k].words], isEmpty ? [0, "empty", ""] : [1, "failed", found[k].message], of);
  }
  await page.screenshot({ path: join(screenshotFolder("stage_element"), "errors.png") });
  // Another value mends it.
  const mended = await page.evaluate(async () => {
    stages[6].clip = "joy2.soft";
    await stages[6].ready;
    return [stages[6].state, stages[6].shadowRoot.querySelector("p").hidden];
  });
  assert.deepEqual(mended, ["ready", true]);
});

test("element: from another host, as a content delivery network has it", { skip: unable, timeout: 180_000 }, async () => {
  const own = await packageHost({}, { "/page": `<!doctype html><meta charset="utf-8"><title>Elsewhere</title><script type="module" src="${host.url}/node_modules/@mimique/stage/element.js"></script>
<mimique-stage src="${host.url}/site/site.json" clip="joy2.box"></mimique-stage><mimique-stage avatar="built-in" capture="built-in" frames="0:30"></mimique-stage>` });
  try {
    const { page } = browser;
    await page.goto(`${own.url}/page?backend=webgl2`);
    const found = await page.evaluate(async () => {
      await customElements.whenDefined("mimique-stage");
      const both = await Promise.all([...document.querySelectorAll("mimique-stage")].map((stage) => stage.ready));
      return [both[0].weights_hash, both[1].frames];
    });
    assert.deepEqual(found, [exported.clips["joy2.box"].weights_hash, 30]);
    assert.deepEqual(own.requests.filter((path) => !["/page", "/favicon.ico"].includes(path)), [], "nothing is asked of the page's own host");
  } finally {
    await own.close();
  }
});

test("element: the example of the package is solved and played without a build step", { skip: unable, timeout: 240_000 }, async () => {
  const { page, errors } = browser;
  errors.length = 0;
  await page.setViewportSize({ width: 780, height: 600 });
  await page.goto(`${host.url}/node_modules/@mimique/stage/example/index.html?backend=webgl2`);
  await page.getByRole("button", { name: "Play" }).click({ timeout: 120_000 });
  await page.waitForFunction(() => /^\d+ frames: /.test(document.getElementById("log").textContent), null, { timeout: 60_000 });
  assert.match(await page.locator("#log").textContent(), /"aborted": null/);
  await page.evaluate(() => (document.getElementById("time").value = 500, document.getElementById("time").dispatchEvent(new Event("input"))));
  await page.waitForFunction(() => [...document.querySelectorAll("mimique-stage")].every((stage) => stage.time === stage.duration / 2));
  await settled(page);
  await taken(page, "stage-element.jpg");
  await page.setViewportSize({ width: 390, height: 800 });
  await settled(page);
  await page.screenshot({ path: join(screenshotFolder("stage_element"), "example-narrow.png"), fullPage: true });
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), true);
  await page.setViewportSize({ width: 1280, height: 900 });
  assert.deepEqual(errors, []);
});
