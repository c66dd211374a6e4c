// Sound of clips: the sound check by keyboard, the sound of a clip measured against its first frame in the export,
// mismatched and silent clips, captions in two languages, a sound that the browser cannot decode.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { looker } from "./lib/access.mjs";
import { parse } from "./lib/csv.mjs";
import { answer, go, leave, phase, place, tabTo, until } from "./lib/participant.mjs";
import { mimique, serve } from "./lib/server.mjs";
import { small, text, trials } from "./lib/small_study.mjs";
import { wav } from "./lib/wav.mjs";

const unable = skip(!executable && "Chromium not found");

const cue = [{ fromS: 0, toS: 30, text: { en: "I have won!", fr: "J’ai gagné !" } }];
const study = small("sound", {
  sound: { captions: "offered", check: { rounds: 1, correct: 1, attempts: 2, text: text("Headphones, please.") } },
  questions: [{ id: "goes", type: "comparison", prompt: text("Which sound goes with the face?") }, { id: "rating", prompt: text("How strong?"), type: "likert", numItems: 7, leftLabel: text("weak"), rightLabel: text("strong") }],
  components: {
    faces: trials(["joy.real.own", "joy.real.later", "joy.real.other", "joy.real.none"], ["rating"]),
    turns: { type: "pairs", compare: "sound", levels: ["other", "own"], within: ["segment"], show: "inTurn", question: "goes" },
  },
  sequence: { order: "fixed", components: ["faces", "turns"] },
  exclusions: { soundOffsetMs: 45, soundNotHeard: true },
  stimuli: {
    avatars: { head: { builtin: { seed: 1, vertices: 2000 } } },
    captures: { take: { file: "take.csv" } },
    methods: { real: { method: "recorded" } },
    look: { width: 240, height: 240 },
    segments: [
      { id: "joy", capture: "take", first: 0, end: 100, sound: { file: "joy.wav", captions: cue } },
      { id: "fear", capture: "take", first: 100, end: 200, sound: { file: "fear.wav" } },
    ],
    sounds: { own: {}, later: { delayMs: 120 }, other: { from: { joy: "fear" } }, none: { silent: true } },
    clips: { cross: { segments: ["joy"] } },
  },
});

function written() {
  const folder = mkdtempSync(join(tmpdir(), "mimique-sound-"));
  writeFileSync(join(folder, "sound.json"), JSON.stringify(study));
  // Four seconds of a mouth that opens and shuts, 50 frames per second.
  const rows = Array.from({ length: 200 }, (_, frame) => `${frame},${(frame / 50).toFixed(2)},${Math.abs(Math.sin(frame / 8)).toFixed(3)}`);
  writeFileSync(join(folder, "take.csv"), ["frame,time,jawOpen", ...rows, ""].join("\n"));
  writeFileSync(join(folder, "joy.wav"), wav(2.5, 440));
  writeFileSync(join(folder, "fear.wav"), wav(2.5, 220));
  return join(folder, "sound.json");
}

/** Counts the tones that are begun, as ears do. */
const ears = () => {
  globalThis.tones = 0;
  const start = OscillatorNode.prototype.start;
  OscillatorNode.prototype.start = function (...args) {
    globalThis.tones += 1;
    return start.apply(this, args);
  };
};

const press = async (page, action) => {
  await tabTo(page, `[data-action=${action}]`);
  await page.keyboard.press("Enter");
};

/** Goes through the sound check by keyboard, wrong in the first attempt where that is asked for. */
async function check(page, { wrong = false, look } = {}) {
  await press(page, "sound-test");
  await page.locator("[data-action=sound-continue]:visible").waitFor({ timeout: 10_000 });
  await look?.("sound-check-test");
  await press(page, "sound-continue");
  await page.getByText(/(Round|Écoute) 1 /).waitFor();
  // Without having listened nothing goes on.
  await press(page, "sound-next");
  await page.locator("#tones-problem:visible").waitFor();
  await page.evaluate(() => (globalThis.tones = 0));
  await press(page, "sound-tones");
  await page.locator("fieldset:not([disabled]) input[name=tones]").first().waitFor({ timeout: 10_000 });
  const heard = await page.evaluate(() => globalThis.tones);
  assert.ok(heard >= 1 && heard <= 4, `${heard} tones`);
  const counted = wrong ? (heard % 4) + 1 : heard;
  await tabTo(page, "input[name=tones]");
  await page.keyboard.press("Space");
  const radio = page.locator(`input[name=tones][value="${counted}"]`);
  for (let steps = 0; steps < 4 && !(await radio.isChecked()); steps++) await page.keyboard.press("ArrowDown");
  await look?.("sound-check-round");
  await press(page, "sound-next");
}

/** Consent and sound check; stands at the first trial. */
async function begin(page, address, options = {}) {
  await page.addInitScript(ears);
  await page.goto(address);
  await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
  await go(page, "keyboard");
  await page.waitForSelector("main[data-view=sound] [data-action=sound-test]", { timeout: 60_000 });
  const here = await place(page);
  if (options.wrong) {
    await check(page, { wrong: true });
    await page.locator(".notice.warn").waitFor();
  }
  await check(page, { look: options.look });
  await leave(page, here);
}

/** Plays the clip on the screen, rates it, goes on. */
async function trial(page, during = async () => {}) {
  await phase(page, "ready");
  const here = await place(page);
  await press(page, "play");
  await phase(page, "playing");
  await during();
  await phase(page, ["answering", "ready"]);
  return here;
}

async function rate(page, here) {
  await answer(page, "keyboard", here.step);
  await go(page, "keyboard");
  await leave(page, here);
}

const ends = (page) => page.waitForSelector("main[data-view=end]", { timeout: 30_000 });

test("sound: checked by keyboard, heard with the first frame, late and mismatched as the study asks, in the export", { skip: unable, timeout: 180_000 }, async () => {
  const file = written();
  const said = mimique(["check", file, "--without-clips"]);
  assert.match(said, /sound joy\.wav: WAV, 2\.500 s, 8000 Hz, 1 channel/);
  const server = await serve([file]);
  const address = `${server.url}/s/sound/?backend=webgl2`;
  const english = await open("undrawn");
  const french = await open("undrawn", { locale: "fr-FR", viewport: { width: 390, height: 780 }, colorScheme: "dark" });
  try {
    const { page } = english;
    const folder = screenshotFolder("sound");
    const { look } = looker(page, folder);
    await begin(page, address, { wrong: true, look });
    await phase(page, "ready");
    // Captions are off until they are switched on.
    await press(page, "captions");
    // In the order of the study's clips: sounds by their names.
    for (const sound of ["later", "none", "other", "own"]) {
      const here = await trial(page, async () => {
        // The clip whose sound is another's has none of its captions; neither has the silent one.
        const line = page.locator(".caption-line");
        if (["later", "own"].includes(sound)) await page.getByText("I have won!").waitFor({ timeout: 5_000 });
        else assert.equal(await line.textContent(), "");
        if (sound === "own") await page.screenshot({ path: join(folder, "captions-light.png") });
      });
      await rate(page, here);
    }
    // Each of two in turn with its own sound: the captions are those of the one that plays.
    let spoken = null;
    const pair = await trial(page, async () => {
      await page.getByText("I have won!").waitFor({ timeout: 8_000 });
      spoken = await page.evaluate(() => [...document.querySelectorAll(".stage-frame.pair canvas")].findIndex((canvas) => !canvas.hasAttribute("data-waiting")));
    });
    await rate(page, pair);
    await ends(page);

    // A browser that cannot decode: the clip is offered once more, then the trial goes on and says so.
    const small = french.page;
    await small.addInitScript(() => {
      OfflineAudioContext.prototype.decodeAudioData = () => Promise.reject(new DOMException("no", "EncodingError"));
    });
    await begin(small, address, { look: looker(small, screenshotFolder("sound-phone-dark")).look });
    await phase(small, "ready");
    await press(small, "captions");
    let here = await trial(small, async () => {
      await small.getByText("J’ai gagné !").waitFor({ timeout: 5_000 });
      await small.screenshot({ path: join(screenshotFolder("sound"), "captions-phone-dark.png") });
    });
    assert.match(await small.locator(".trial-message").textContent(), /n’a pas pu être joué/);
    assert.equal((await place(small)).phase, "ready", "it is offered again");
    here = await trial(small);
    assert.equal((await place(small)).phase, "answering");
    assert.match(await small.locator(".trial-message").textContent(), /n’a pas pu être joué/);
    await rate(small, here);

    let rows = [];
    await until("the rows are stored", async () => {
      rows = parse(mimique(["export", "--format", "csv", "--study", "sound", "--database", server.database]));
      return rows.filter(({ trial_type, response_id }) => trial_type === "trial" && response_id === "rating").length === 5;
    });
    const rated = rows.filter(({ trial_type, response_id }) => trial_type === "trial" && response_id === "rating");
    const inTurn = rows.find(({ response_id }) => response_id === "goes");
    assert.equal(inTurn.sound_status, "played");
    assert.ok(Math.abs(Number(inTurn.sound_offset_ms)) < 100, `in turn: offset ${inTurn.sound_offset_ms} ms`);
    assert.equal([inTurn.item_left, inTurn.item_right][spoken], "own", "the words came with their own face");
    const of = (id) => rated.find(({ stimulus, language }) => stimulus === id && language === "en");
    const [own, later, other, none] = ["own", "later", "other", "none"].map((name) => of(`joy.real.${name}`));
    for (const [row, delay] of [[own, 0], [later, 120], [other, 0]]) {
      assert.equal(row.sound_status, "played", row.stimulus);
      assert.equal(Number(row.sound_delay_ms), delay);
      // A frame of a loaded machine may come late; the sound does not wait for it.
      assert.ok(Math.abs(Number(row.sound_offset_ms) - delay) < 100, `${row.stimulus}: offset ${row.sound_offset_ms} ms`);
      assert.ok(Math.abs(Number(row.sound_drift_ms)) < 60, `${row.stimulus}: drift ${row.sound_drift_ms} ms`);
      assert.ok(["timestamp", "outputLatency", "baseLatency"].includes(row.sound_latency_source), row.sound_latency_source);
      assert.ok(Number(row.sound_latency_ms) >= 0 && Number(row.sound_latency_ms) < 500, row.sound_latency_ms);
      assert.equal(row.captions_shown, "true");
      assert.equal(row.sound, row.stimulus.split(".").at(-1), "the factor");
    }
    assert.equal(own.sound_file, later.sound_file);
    assert.notEqual(own.sound_file, other.sound_file, "another segment's");
    assert.equal(none.sound_status, "", "silence is no failure");
    assert.notEqual(own.provenance, other.provenance);
    const [checked] = rows.filter(({ response_id, language }) => response_id === "sound_check" && language === "en");
    assert.equal(checked.answer, "heard");
    assert.equal(own.sound_check, "heard");
    assert.equal(own.sound_check_attempts, "2");
    assert.equal(own.sound_check_correct, "1");
    const undecoded = rated.find(({ language }) => language === "fr");
    assert.equal(undecoded.sound_status, "undecodable");
    assert.equal(undecoded.interruptions, "1", "the first play did not count");
    assert.deepEqual(english.errors, []);
    console.log(`offsets: ${[own, later, other].map((row) => row.sound_offset_ms)} ms; drift: ${own.sound_drift_ms} ms; latency ${own.sound_latency_ms} ms by ${own.sound_latency_source}`);
  } finally {
    await english.close();
    await french.close();
    await server.stop();
  }
});

test("sound: who cannot hear says so, and goes on or not as the study rules", { skip: unable, timeout: 120_000 }, async () => {
  const strict = structuredClone(study);
  strict.id = "strict";
  strict.sound.check.hearing = "required";
  const file = written();
  writeFileSync(file.replace("sound.json", "strict.json"), JSON.stringify(strict));
  const server = await serve([file, file.replace("sound.json", "strict.json")]);
  const browser = await open("undrawn");
  const { page } = browser;
  try {
    for (const [id, view] of [["sound", "trial"], ["strict", "end"]]) {
      await page.goto(`${server.url}/s/${id}/?backend=webgl2`);
      await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
      await go(page, "keyboard");
      await page.waitForSelector("main[data-view=sound] [data-action=sound-none]", { timeout: 60_000 });
      await press(page, "sound-none");
      await press(page, "sound-none-yes");
      await page.waitForSelector(`main[data-view=${view}]`, { timeout: 30_000 });
    }
    assert.match(await page.locator("main").innerText(), /can hear its sound/);
  } finally {
    await browser.close();
    await server.stop();
  }
});
