// plugin-mimique in timelines of jsPsych itself: clips, pairs, panels, buttons, keys, their times and data, simulated people,
// what is refused.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { infoOf } from "../../xtask/package/jspsych/info.js";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { taken } from "./lib/guide_picture.mjs";
import { exportedClips } from "./lib/exported_clips.mjs";
import { packageHost, unpacked } from "./lib/package_host.mjs";
import { root } from "./lib/server.mjs";

const unable = skip(executable ? false : "Chromium not found");
const page = `<!doctype html><html lang="en"><head><meta charset="utf-8"><title>Timeline</title>
<link rel="stylesheet" href="/node_modules/jspsych/css/jspsych.css">
<script src="/node_modules/jspsych/dist/index.browser.min.js"></script>
<script type="module" src="/node_modules/@mimique/jspsych-plugin/browser.js"></script></head><body></body></html>`;
const BOX = { src: "/site/site.json", clip: "joy2.box" };
const SOFT = { src: "/site/site.json", clip: "joy2.soft" };
let host, browser, clips;

before(async () => {
  if (unable) return;
  const exported = exportedClips();
  clips = exported.clips;
  host = await packageHost({ "/site/": exported.folder, ...unpacked }, { "/page": page });
  browser = await open("undrawn");
});
after(async () => {
  await browser?.close();
  await host?.close();
});

/** Starts a timeline of such trials; `timeline(act)` waits for its data while `act` takes part. */
async function timeline(trials, act = async () => {}, { simulation = null, by = browser } = {}) {
  const { page, errors } = by;
  errors.length = 0;
  await page.goto(`${host.url}/page?backend=webgl2`);
  await page.waitForFunction(() => globalThis.jsPsychMimique && globalThis.initJsPsych);
  await page.evaluate(([trials, simulation]) => {
    window.answeredAt = [];
    for (const type of ["keydown", "click"]) addEventListener(type, (event) => answeredAt.push(event.timeStamp), true);
    window.jsPsych = initJsPsych();
    const all = trials.map((trial) => ({ type: jsPsychMimique, ...trial }));
    window.done = (simulation ? jsPsych.simulate(all, simulation) : jsPsych.run(all)).then(() => jsPsych.data.get().values());
    window.done.catch(() => {});
  }, [trials, simulation]);
  await act(page);
  const data = await page.evaluate(() => done);
  return { data, answeredAt: await page.evaluate(() => answeredAt) };
}

const button = (page, name) => page.getByRole("button", { name, exact: true });

test("jspsych: a clip, a pair and a panel, answered by button and key, with times from the frame shown", { skip: unable, timeout: 240_000 }, async () => {
  const shots = screenshotFolder("jspsych");
  const trials = [
    { clips: [BOX], prompt: "<p>Which emotion?</p>", choices: ["anger", "joy"], keys: ["a", "j"] },
    { clips: [BOX, SOFT], clip_labels: ["A", "B"], prompt: "<p>Which moves more?</p>", choices: ["A", "B"], keys: ["ArrowLeft", "ArrowRight"], clip_size: 240 },
    { clips: Array.from({ length: 9 }, (_, k) => (k % 2 ? SOFT : BOX)), columns: 3, clip_size: 110, choices: Array.from({ length: 9 }, (_, k) => `${k + 1}`), view: { yaw: 0.4 }, save_frames: false },
    { clips: [SOFT, BOX], in_turn: true, clip_size: 200, keys: ["f", "j"], response_allowed_while_playing: true },
  ];
  const { data, answeredAt } = await timeline(trials, async (page) => {
    // The first face stands before it plays; buttons wait for the end.
    await page.waitForSelector("mimique-stage[state=playing]", { timeout: 60_000 });
    assert.equal(await button(page, "joy").isDisabled(), true);
    await page.keyboard.press("a");
    await page.waitForSelector("button:enabled:text-is('joy')", { timeout: 60_000 });
    await page.screenshot({ path: join(shots, "one.png") });
    await button(page, "joy").click();
    await page.waitForSelector("button:enabled:text-is('B')", { timeout: 60_000 });
    await page.screenshot({ path: join(shots, "pair.png") });
    await page.keyboard.press("ArrowRight");
    await page.waitForSelector("button:enabled:text-is('9')", { timeout: 90_000 });
    await page.screenshot({ path: join(shots, "panel.png") });
    await button(page, "9").click();
    await page.waitForSelector("mimique-stage[state=playing]", { timeout: 60_000 });
    await page.waitForTimeout(300);
    await page.keyboard.press("J");
  });
  assert.deepEqual(browser.errors, [], "the console is clean");
  const [one, pair, panel, turn] = data;
  assert.deepEqual(data.map(({ trial_type: type, plugin_version: version }) => [type, version]), Array(4).fill(["mimique", "0.1.0"]));
  assert.deepEqual(data.map((row) => [row.response, row.response_source, row.response_key]), [[1, "button", null], [1, "key", "ArrowRight"], [8, "button", null], [1, "key", "J"]]);
  // The time is the event's own, from the first frame's.
  const times = [one, pair, panel, turn].map(({ rt, onset_ms: onset }) => rt + onset);
  for (const at of times) assert.ok(answeredAt.some((other) => Math.abs(other - at) < 0.5), `${at} among ${answeredAt}`);
  const { duration_ms: duration } = clips["joy2.box"];
  for (const row of [one, pair, panel]) assert.ok(row.rt > duration, `${row.rt} after ${duration}: only then the buttons answer`);
  for (const row of [one, pair]) {
    assert.equal(row.frames[0][0], row.onset_ms);
    assert.equal(row.frames.at(-1)[1], duration);
    assert.deepEqual([row.aborted, row.interrupted, row.failure, row.backend, row.renderer], [null, [], null, "webgl2", "@mimique/stage@0.1.0"]);
  }
  assert.equal(panel.frames, null);
  const of = (names, what) => names.map((name) => clips[name][what]);
  assert.deepEqual([pair.clips, pair.provenance, pair.weights_hash], [["joy2.box", "joy2.soft"], of(["joy2.box", "joy2.soft"], "provenance"), of(["joy2.box", "joy2.soft"], "weights_hash")]);
  assert.deepEqual([panel.clips.length, panel.provenance], [9, of(panel.clips, "provenance")]);
  assert.ok(turn.rt > 0 && turn.aborted === "the trial ended" && turn.rt < 2 * duration, `answered at ${turn.rt} while it played`);
  const info = infoOf(Proxied);
  for (const row of data) for (const name of Object.keys(info.data)) assert.ok(name in row, `column ${name} of ${row.trial_index}`);
});

test("jspsych: trials end by the clips, by time, and go on with what was interrupted", { skip: unable, timeout: 240_000 }, async () => {
  const trials = [
    { clips: [BOX], trial_ends_after_clips: true },
    { clips: [BOX], choices: ["yes"], trial_duration: 700 },
    { clips: [BOX], choices: ["yes"], response_ends_trial: false, response_allowed_while_playing: true },
    { clips: [BOX], choices: ["yes"], again_label: "Once more" },
  ];
  const { data } = await timeline(trials, async (page) => {
    // In the page itself, where nothing comes too late.
    await page.evaluate(() => {
      let isStopped = false;
      document.addEventListener("stage-onset", ({ target }) => {
        const trial = jsPsych.getProgress().current_trial_global;
        if (trial === 2) setTimeout(() => document.querySelector("button").click(), 50);
        if (trial === 3 && !isStopped) setTimeout(() => target.stop("page hidden"), 50);
        isStopped ||= trial === 3;
      });
    });
    await button(page, "Once more").click();
    await page.waitForSelector("button:enabled:text-is('yes')", { timeout: 60_000 });
    await button(page, "yes").click();
  });
  const [shown, timed, early, again] = data;
  const { duration_ms: duration } = clips["joy2.box"];
  assert.deepEqual([shown.rt, shown.response, shown.aborted, shown.frames.at(-1)[1]], [null, null, null, duration]);
  assert.deepEqual([timed.rt, timed.aborted], [null, "the trial ended"]);
  // On a slow machine the last frame that came may be long before the end.
  assert.ok(timed.frames.at(-1)[1] < duration && timed.frames.at(-1)[1] > 0, `ended at ${timed.frames.at(-1)[1]}`);
  assert.deepEqual([early.response, early.aborted, early.frames.at(-1)[1]], [0, null, duration]);
  assert.ok(early.rt < duration, `${early.rt}`);
  assert.deepEqual([again.interrupted, again.aborted, again.response], [["page hidden"], null, 0]);
});

test("jspsych: simulated people, data alone and on the page", { skip: unable, timeout: 240_000 }, async () => {
  const trials = [
    { clips: [{ source: clips?.["joy2.box"], clip: "joy2.box", packs: "/site/packs" }], choices: ["yes", "no"] },
    { clips: [BOX, SOFT], keys: ["f", "j"], simulation_options: { data: { response: 1, rt: 9000 } } },
  ];
  const alone = await timeline(trials, async () => {}, { simulation: "data-only" });
  assert.ok(!browser.requests.some((address) => address.includes("joy")));
  const { duration_ms: duration, provenance } = clips["joy2.box"];
  const [first, second] = alone.data;
  assert.ok(first.rt > duration && [0, 1].includes(first.response) && first.response_source === "button", JSON.stringify(first));
  assert.deepEqual([first.clips, first.provenance, first.frames], [["joy2.box"], [provenance], null]);
  assert.deepEqual([second.rt, second.response, second.response_source], [9000, 1, "key"]);
  const onPage = await timeline([trials[0], { ...trials[1], simulation_options: {} }], async () => {}, { simulation: "visual" });
  const [button, key] = onPage.data;
  for (const row of [button, key]) assert.ok(row.rt > duration && row.frames.at(-1)[1] === duration && row.failure === null, JSON.stringify({ ...row, frames: row.frames?.length }));
  assert.deepEqual([button.response_source, key.response_source, ["f", "j"][key.response]], ["button", "key", key.response_key]);
});

test("jspsych: what is wrong is said, in the data where nothing can be shown", { skip: unable, timeout: 240_000 }, async () => {
  const { data } = await timeline([{ clips: [{ ...BOX, clip: "joy9" }], choices: ["yes"] }, { clips: [BOX], trial_ends_after_clips: true }]);
  assert.deepEqual(data[0].failure, { code: "attribute", message: 'mimique-stage: clip="joy9": no such clip is described there; there are: joy2.box, joy2.soft' });
  assert.deepEqual([data[0].rt, data[0].response, data[1].failure, data[1].aborted], [null, null, null, null]);
  const refused = [
    [{ clips: [] }, /clips: 0; give a list of 1 to 9 clips/],
    [{ clips: [BOX, SOFT], clip_labels: ["A"] }, /clip_labels: 1 for 2 clips; give one for each/],
    [{ clips: [BOX], choices: ["a"], keys: ["a", "b"] }, /keys: 2 for 1 choices/],
    [{ clips: [BOX], choices: ["a"], trial_ends_after_clips: true }, /before anything can be answered; set response_allowed_while_playing/],
  ];
  for (const [trial, words] of refused) await assert.rejects(timeline([trial]), words);
});

test("jspsych: clips are prepared ahead, and canvases opened once", { skip: unable, timeout: 240_000 }, async () => {
  const { page } = browser;
  await page.goto(`${host.url}/page?backend=webgl2`);
  await page.waitForFunction(() => globalThis.jsPsychMimique && globalThis.initJsPsych);
  const found = await page.evaluate(async (clips) => {
    const summaries = await jsPsychMimique.preload(clips);
    const jsPsych = initJsPsych();
    const canvases = [];
    const on_load = () => canvases.push(document.querySelector("#jspsych-content mimique-stage").shadowRoot.querySelector("canvas"));
    await jsPsych.run([...clips, clips[0]].map((clip) => ({ type: jsPsychMimique, clips: [clip], trial_ends_after_clips: true, on_load })));
    return { frames: summaries.map(({ frames }) => frames), same: canvases.every((canvas) => canvas === canvases[0]), clips: jsPsych.data.get().select("clips").values.flat(), apa: jsPsych.getCitations([jsPsychMimique], "apa") };
  }, [BOX, SOFT]);
  assert.ok(found.frames.every((frames) => frames > 10), `${found.frames}`);
  assert.deepEqual([found.same, found.clips], [true, ["joy2.box", "joy2.soft", "joy2.box"]]);
  assert.match(found.apa, /The Mimique maintainers/);
});

const Proxied = new Proxy({}, { get: (_, name) => name });

test("jspsych: the package's page and types name every parameter and column", () => {
  const info = infoOf(Proxied);
  const folder = join(root, "xtask/package/jspsych");
  const [page, types] = ["README.md", "index.d.ts"].map((name) => readFileSync(join(folder, name), "utf8"));
  for (const [name, { default: value, type }] of Object.entries(info.parameters)) {
    const row = page.split("\n").find((line) => line.startsWith(`| \`${name}\` |`));
    assert.ok(row, `parameter ${name} in README.md`);
    assert.ok(types.includes(`  ${name}?: `) || types.includes(`  ${name}: `), `parameter ${name} in index.d.ts`);
    const told = value === undefined ? "required" : type === "FUNCTION" ? "function" : `\`${JSON.stringify(value)}\``;
    assert.ok(row.includes(`| ${told} |`), `${row}: its default is ${told}`);
  }
  for (const name of Object.keys(info.data)) {
    assert.ok(page.includes(`\n| \`${name}\` |`), `column ${name} in README.md`);
    assert.ok(types.includes(`  ${name}: `), `column ${name} in index.d.ts`);
  }
});

test("jspsych: the picture of the guide", { skip: unable, timeout: 240_000 }, async () => {
  const drawing = await open("webgl2", { viewport: { width: 780, height: 520 } });
  const pair = { clips: [SOFT, BOX], clip_labels: ["A", "B"], prompt: "<p>Which face moves more?</p>", choices: ["A", "B"], clip_size: 300 };
  try {
    await timeline([pair], async (page) => {
      await page.waitForSelector("button:enabled:text-is('B')", { timeout: 90_000 });
      await page.mouse.move(0, 0);
      await page.evaluate(() => Promise.all([...document.querySelectorAll("mimique-stage")].map((stage) => stage.seek(stage.duration / 2))));
      await taken(page, "stage-jspsych.jpg");
      await button(page, "B").click();
    }, { by: drawing });
  } finally {
    await drawing.close();
  }
});
