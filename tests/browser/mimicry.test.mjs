// Mimicry: the consent of its own, the camera (Chromium's, which shows a pattern), pictures measured on the clock of the
// shown frames, a gap where no face is found, the button that switches off, a reload; who declines; MediaPipe's own files
// under the page's policy. No picture leaves the page: every request is looked at.
//
// What measures is what the study brings. The stand-in below takes the place of the npm package: its scores are those of
// the time at which a picture was taken, so that what is stored can be held against it.

import assert from "node:assert/strict";
import { cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { looker } from "./lib/access.mjs";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { taken } from "./lib/guide_picture.mjs";
import { answer, go, leave, phase, place, storedEvents } from "./lib/participant.mjs";
import { mimique, root, serve } from "./lib/server.mjs";
import { small, stimuli, text, trials } from "./lib/small_study.mjs";

const mediapipe = join(root, "tests/browser/node_modules/@mediapipe/tasks-vision");
const unable = skip(!executable ? "Chromium not found" : !existsSync(mediapipe) && "npm ci was not run in tests/browser");
const camera = { more: ["--use-fake-device-for-media-stream"], permissions: ["camera"] };

// The score of a shape at a time of the page's clock, in thousandths; every seventh picture has no face.
const score = (atMs) => Math.round(500 + 450 * Math.sin(atMs / 300));
const GAP = 7;

const STAND_IN = `
const score = ${score};
export class FaceLandmarker {
  static async createFromOptions({ wasmLoaderPath, wasmBinaryPath }, { baseOptions, runningMode, numFaces }) {
    await import(wasmLoaderPath);
    const { headers } = await fetch(wasmBinaryPath);
    const model = new TextDecoder().decode(baseOptions.modelAssetBuffer);
    if (model !== "a model" || globalThis.loaded !== true || headers.get("content-type") !== "application/wasm" || runningMode !== "VIDEO" || numFaces !== 1) throw new Error("not as asked for");
    return new FaceLandmarker();
  }
  #last = -Infinity;
  #pictures = 0;
  detectForVideo(picture, atMs) {
    if (!(picture instanceof ImageBitmap) || picture.width === 0 || atMs <= this.#last) throw new Error("no picture in order");
    this.#last = atMs;
    this.#pictures += 1;
    if (this.#pictures % ${GAP} === 0) return { faceBlendshapes: [] };
    const categories = [{ categoryName: "_neutral", score: 0.001 }, { categoryName: "jawOpen", score: score(atMs) / 1000 }, { categoryName: "unheardOf", score: 1 }];
    return { faceBlendshapes: [{ categories }] };
  }
}`;

const consent = {
  version: "3",
  heading: { en: "May we measure your face?", fr: "Pouvons-nous mesurer votre visage ?" },
  text: { en: "We study whether people smile back at avatars.\n\nThe numbers are kept for five years.", fr: "Nous étudions si les gens répondent au sourire des avatars.\n\nLes nombres sont conservés cinq ans." },
};

/** A study of two clips in a new folder, with the stand-in or with files of `runtime`. */
function written({ runtime, more = {} } = {}) {
  const folder = mkdtempSync(join(tmpdir(), "mimique-mimicry-"));
  if (runtime) {
    cpSync(runtime, join(folder, "tasks-vision"), { recursive: true });
  } else {
    mkdirSync(join(folder, "tasks-vision/wasm"), { recursive: true });
    writeFileSync(join(folder, "tasks-vision/vision_bundle.mjs"), STAND_IN);
    writeFileSync(join(folder, "tasks-vision/wasm/vision_wasm_module_internal.js"), "globalThis.loaded = true;\n");
    writeFileSync(join(folder, "tasks-vision/wasm/vision_wasm_module_internal.wasm"), Buffer.from([0, 97, 115, 109, 1, 0, 0, 0]));
  }
  writeFileSync(join(folder, "face_landmarker.task"), "a model");
  const study = small("mimicry", {
    mimicry: { consent, model: "face_landmarker.task", runtime: "tasks-vision", rateHz: 20, ...more },
    questions: [{ id: "good", type: "likert", prompt: text("Good?"), numItems: 7, start: 1, leftLabel: text("no"), rightLabel: text("yes") }],
    components: { faces: trials(["joy2.box", "joy2.real"], ["good"]) },
    sequence: { order: "fixed", components: ["faces"] },
    stimuli: stimuli({ head: { builtin: { seed: 1 } } }, { box: { method: "box" }, real: { method: "recorded" } }, [["head", "box"], ["head", "real"]]),
  });
  writeFileSync(join(folder, "mimicry.json"), JSON.stringify(study));
  return join(folder, "mimicry.json");
}

/** Notes what the page does with cameras. */
const watchCameras = () => {
  globalThis.asked = 0;
  globalThis.tracks = [];
  const own = navigator.mediaDevices.getUserMedia.bind(navigator.mediaDevices);
  navigator.mediaDevices.getUserMedia = async (wanted) => {
    globalThis.asked += 1;
    const stream = await own(wanted);
    globalThis.tracks.push(...stream.getTracks());
    return stream;
  };
};
const cameras = (page) => page.evaluate(() => ({ asked: globalThis.asked, live: globalThis.tracks.filter(({ readyState }) => readyState === "live").length, kinds: globalThis.tracks.map(({ kind }) => kind) }));

/** Gathers what is sent: every request's body. */
function watchRequests(context) {
  const sent = [];
  context.on("request", (request) => sent.push({ url: request.url(), body: request.postData() ?? "", method: request.method() }));
  return sent;
}

/** Sees that nothing of what was sent can be a picture: to this server alone, JSON of known events, numbers in tracks. */
function assertNoPicture(sent, url) {
  for (const { url: to, body, method } of sent) {
    assert.ok(to.startsWith(url) || to.startsWith("data:") || to.startsWith(`blob:${url}`), `a request to ${to}`);
    if (method === "GET" || body === "") continue;
    assert.ok(/^[\x20-\x7e\u00a0-\u{10ffff}]*$/u.test(body), `${to}: more than text`);
    assert.ok(!/data:|base64|blob:/.test(body), `${to}: ${body.slice(0, 200)}`);
    for (const { body: event } of [JSON.parse(body).events ?? []].flat().filter((each) => each.body)) {
      const { frames = [] } = event.log?.mimicry ?? {};
      assert.ok(frames.flat().every((each) => typeof each === "number"), "tracks are numbers");
      assert.ok(frames.every((frame) => frame.length === 1 || frame.length === 53), "a time and 52 scores each");
      assert.ok(!("mimicry" in (event.log ?? {})) || Object.keys(event.log.mimicry).sort().join() === "clock,frames,model,status", "and nothing else");
      assert.ok(Object.values(event).filter((value) => typeof value === "string").every((value) => value.length < 500), "no long text");
    }
  }
}

async function toConsent(page, address) {
  await page.addInitScript(watchCameras);
  await page.goto(address);
  await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
  await go(page, "mouse");
  await page.waitForSelector("main[data-view=mimicry] [data-action=mimicry-agree]", { timeout: 60_000 });
  return place(page);
}

const press = (page, action) => page.locator(`[data-action=${action}]`).click();

/** Plays the clip on the screen; stands at its questions. */
async function played(page) {
  await phase(page, "ready", 120_000);
  await press(page, "play");
  await phase(page, "answering", 120_000);
}

async function rated(page) {
  const here = await place(page);
  await answer(page, "mouse", here.step);
  await go(page, "mouse");
  return leave(page, here, 60_000);
}

const rowsOf = (server) => parse(mimique(["export", "--database", server.database, "--format", "csv"])).filter((row) => row.trial_type === "trial");

test("mimicry: numbers on the clock of the clip, gaps, a reload, the button that switches off; no picture leaves", { skip: unable, timeout: 300_000 }, async () => {
  const study = written();
  const server = await serve([study]);
  const browser = await open("undrawn", camera);
  const { page, context, errors } = browser;
  const sent = watchRequests(context);
  const { look } = looker(page, screenshotFolder("mimicry"));
  try {
    let here = await toConsent(page, `${server.url}/s/mimicry/?backend=webgl2`);
    assert.deepEqual(await cameras(page), { asked: 0, live: 0, kinds: [] }, "nothing before the agreement");
    assert.ok(!sent.some(({ url }) => /\.(js|wasm)$/.test(url) && url.includes("/packs/")), "and nothing is loaded");
    assert.match(await page.locator("main").innerText(), /up to 20 times per second/);
    await look("mimicry-consent");
    await page.setViewportSize({ width: 960, height: 760 });
    await taken(page, "mimicry-consent.jpg");
    await press(page, "mimicry-agree");
    await page.getByText("Your face is seen.").waitFor({ timeout: 30_000 });
    assert.deepEqual(await cameras(page), { asked: 1, live: 1, kinds: ["video"] });
    await look("mimicry-camera");
    await press(page, "mimicry-next");
    here = await leave(page, here);
    assert.equal(here.view, "trial");
    await played(page);
    await look("mimicry-trial");
    const origin = await page.evaluate(() => performance.timeOrigin);
    await rated(page);

    // After a reload the camera goes on by itself.
    await page.reload();
    await page.waitForSelector("main[data-view=trial]", { timeout: 30_000 });
    await page.locator("[data-action=mimicry-stop]").waitFor({ timeout: 30_000 });
    assert.equal((await cameras(page)).live, 1);
    await phase(page, "ready", 120_000);
    await press(page, "mimicry-stop");
    assert.equal((await cameras(page)).live, 0, "the camera's light is off");
    await page.getByText("The camera is off.").waitFor();
    await look("mimicry-stopped");
    // Nor does another reload switch it on again.
    await page.reload();
    await played(page);
    assert.equal((await cameras(page)).asked, 0);
    await rated(page);
    await page.waitForSelector("main[data-view=end]", { timeout: 60_000 });
    assertNoPicture(sent, server.url);

    const events = await storedEvents(page, server, "mimicry");
    const [first, second] = events.filter(({ type }) => type === "trial_played").map(({ log }) => log);
    const { status, clock, frames, model } = first.mimicry;
    assert.equal(status, "tracked");
    assert.match(clock, /^(capture|presented)$/);
    assert.match(model, /^[0-9a-f]{64}$/);
    const lasts = first.end_ms - first.onset_ms;
    // Pictures come with the display's frames: a machine that draws few of these measures few.
    const least = Math.min(20, Math.floor(first.frames.length / 3));
    assert.ok(least >= 2 && frames.length >= least && frames.length <= (20 * lasts) / 900 + 2, `${frames.length} pictures at 20 Hz in ${lasts} ms of ${first.frames.length} frames`);
    assert.ok(frames.every(([at], k) => at >= 0 && at <= lasts + 100 && (k === 0 || at > frames[k - 1][0])), "on the clock of the play, in order");
    const gaps = frames.filter((frame) => frame.length === 1);
    assert.ok(gaps.length >= Math.floor(frames.length / GAP) && gaps.length <= Math.ceil(frames.length / GAP), `${gaps.length} gaps in ${frames.length}`);
    for (const [at, ...scores] of frames) {
      // The page's clock of the picture, from the play's onset.
      const taken = first.onset_ms - origin + at;
      if (scores.length === 0) continue;
      assert.ok(Math.abs(scores[25] - score(taken)) <= 2, `jawOpen ${scores[25]} at ${taken}: ${score(taken)}`);
      assert.ok(scores[0] === 1 && scores.every((own, k) => k === 0 || k === 25 || own === 0), "by name, what has none is left out");
    }
    assert.deepEqual([second.mimicry.status, second.mimicry.frames], ["stopped", []]);

    const rows = rowsOf(server);
    assert.deepEqual(rows.map((row) => [row.mimicry_consent, row.mimicry_version, row.mimicry_camera, row.mimicry_status]), [["agreed", "3", "seen", "tracked"], ["agreed", "3", "seen", "stopped"]]);
    assert.deepEqual([Number(rows[0].mimicry_pictures), Number(rows[0].mimicry_faces)], [frames.length, frames.length - gaps.length]);
    const folder = mkdtempSync(join(tmpdir(), "mimique-tracks-"));
    const courses = join(folder, "courses.csv");
    const tracks = parse(mimique(["export", "--database", server.database, "--format", "tracks", "--courses", courses]));
    assert.equal(tracks.length, frames.length);
    assert.deepEqual([...new Set(tracks.map((row) => row.stimulus))], ["joy2.box"]);
    assert.equal(tracks.filter((row) => row.face === "false" && row.jawOpen === "").length, gaps.length);
    // The report takes both.
    const csv = join(folder, "answers.csv");
    writeFileSync(join(folder, "tracks.csv"), mimique(["export", "--database", server.database, "--format", "tracks"]));
    mimique(["export", "--database", server.database, "--format", "csv", "--out", csv]);
    const report = join(folder, "report");
    mimique(["analyze", csv, "--study", study, "--tracks", join(folder, "tracks.csv"), "--courses", courses, "--out", report]);
    assert.match(readFileSync(join(report, "report.md"), "utf8"), /Mimicry[^]*(of 1 person[^]*in 1 plays?|No play can be used: 1 in which a face was seen)/);
    assert.deepEqual(errors, []);
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("mimicry: who declines is asked for no camera and loads nothing; who may not use it is told and goes on", { skip: unable, timeout: 300_000 }, async () => {
  const server = await serve([written({ more: { needsFace: true } })]);
  try {
    for (const [locale, permissions, consented, found] of [["en-GB", ["camera"], "declined", "off"], ["fr-FR", [], "agreed", "refused"]]) {
      const browser = await open("undrawn", { ...camera, locale, permissions, viewport: { width: 390, height: 844 }, colorScheme: "dark" });
      const { page, context } = browser;
      const sent = watchRequests(context);
      const { look } = looker(page, screenshotFolder("mimicry"));
      try {
        let here = await toConsent(page, `${server.url}/s/mimicry/?backend=webgl2`);
        if (consented === "declined") {
          await look("mimicry-consent-phone");
          await press(page, "mimicry-decline");
        } else {
          await press(page, "mimicry-agree");
          await page.getByText("La caméra ne peut pas être utilisée.").waitFor();
          await look("mimicry-refused-phone");
          await press(page, "mimicry-again");
          await page.getByText("La caméra ne peut pas être utilisée.").waitFor();
          await press(page, "mimicry-without");
        }
        here = await leave(page, here);
        assert.equal(here.view, "trial");
        assert.equal((await cameras(page)).live, 0);
        assert.equal((await cameras(page)).asked, consented === "declined" ? 0 : 2);
        for (let trial = 0; trial < 2; trial++) {
          await played(page);
          await rated(page);
        }
        await page.waitForSelector("main[data-view=end]", { timeout: 60_000 });
        assert.ok(!sent.some(({ url }) => /\/packs\/.*\.(js|wasm)$/.test(url)), "what measures is not loaded");
        assertNoPicture(sent, server.url);
        const own = rowsOf(server).slice(-2);
        assert.deepEqual(own.map((row) => [row.mimicry_consent, row.mimicry_camera, row.mimicry_status]), Array(2).fill([consented, found, ""]));
      } finally {
        await browser.close();
      }
    }
  } finally {
    await server.stop();
  }
});

test("mimicry: MediaPipe's own scripts and module run under the page's policy; a file that is no model is told", { skip: unable, timeout: 300_000 }, async () => {
  const server = await serve([written({ runtime: mediapipe })]);
  const browser = await open("undrawn", camera);
  const { page, context, errors } = browser;
  const sent = watchRequests(context);
  const said = [];
  page.on("console", (message) => said.push(message.text()));
  try {
    await toConsent(page, `${server.url}/s/mimicry/?backend=webgl2`);
    await press(page, "mimicry-agree");
    await page.getByText("What measures the face does not work in this browser.").waitFor({ timeout: 120_000 });
    assert.equal((await cameras(page)).live, 0, "the camera is off again");
    for (const ending of [".js", ".wasm"]) assert.ok(sent.some(({ url }) => url.includes("/packs/") && url.endsWith(ending)), `${ending} is loaded`);
    const refused = said.filter((line) => line.startsWith("mimicry: "));
    assert.equal(refused.length, 1, said.join("\n"));
    // The module itself has looked at the file, and nothing was refused by the policy.
    assert.match(refused[0], /zip|model|asset|buffer/i, refused[0]);
    assert.ok(!errors.some((error) => /Content Security Policy/.test(error)), errors.join("\n"));
    assertNoPicture(sent, server.url);
  } finally {
    await browser.close();
    await server.stop();
  }
});
