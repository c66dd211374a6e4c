// Takes part in the whole built-in study as a person does, on both graphics back ends, by mouse and
// by keyboard, in both languages, with a reload in the middle; then exports, analyses, and compares
// what was clicked with what was exported.

import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { answer, clipOf, go, leave, phase, place } from "./lib/participant.mjs";
import { mimique, serve } from "./lib/server.mjs";
import { withSmallClips } from "./lib/small_study.mjs";

const study = withSmallClips("study-config/demo.json");
const unable = skip(executable ? false : "Chromium not found");

const people = [
  { backend: "webgl2", hands: "mouse", locale: "en-GB", colorScheme: "light", viewport: { width: 1280, height: 900 } },
  { backend: "webgpu", hands: "keyboard", locale: "fr-FR", colorScheme: "dark", viewport: { width: 412, height: 860 } },
];

for (const person of people) {
  test(`study: whole demo by ${person.hands}, ${person.backend}, ${person.locale}`, { skip: unable, timeout: 600_000 }, async () => {
    const server = await serve([study]);
    try {
      const given = await takePart(server, person);
      const bundle = await (await fetch(`${server.url}/api/studies/demo`)).json();
      compare(server, person, given, bundle);
    } finally {
      await server.stop();
    }
  });
}

/** Goes through the study; what was answered, by step. */
async function takePart(server, { backend, hands, locale, colorScheme, viewport }) {
  const shots = screenshotFolder(`study-${backend}`);
  const browser = await open(backend, { locale, colorScheme, viewport });
  const { page } = browser;
  const given = [];
  let trials = 0;
  let reloaded = false;
  try {
    await page.goto(`${server.url}/s/demo/?backend=${backend}`);
    await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
    assert.equal(await page.locator("html").getAttribute("lang"), locale.slice(0, 2));
    let here = await place(page);
    for (let guard = 0; here.view !== "end" && guard < 60; guard++) {
      await page.screenshot({ path: join(shots, `${String(guard).padStart(2, "0")}-${here.view}.png`) });
      if (here.view === "trial") {
        trials += 1;
        await phase(page, "ready");
        // Every answer is in the database before the next trial can start.
        const stored = await page.evaluate(async () => {
          const kept = JSON.parse(localStorage.getItem("mimique/demo"));
          const resume = await (await fetch(`/api/sessions/${kept.started.session}`)).json();
          return resume.events.filter((event) => event.body.type === "trial_finished").length;
        });
        assert.equal(stored, trials - 1, "the trials before this one are stored");
        await go(page, hands);
        await phase(page, "playing");
        if (trials === 3 && !reloaded) {
          // In the middle of a clip: the trial starts anew and nothing before it is lost.
          reloaded = true;
          await page.waitForTimeout(700);
          await page.reload();
          await page.waitForSelector("main[data-step]", { timeout: 30_000 });
          const again = await place(page);
          assert.equal(again.step, here.step, "after a reload the study goes on at the same trial");
          await phase(page, "ready");
          await go(page, hands);
        }
        await page.waitForTimeout(1_500);
        if (trials <= 2) await page.screenshot({ path: join(shots, `clip-${trials}.png`) });
        await phase(page, "answering");
        here = await place(page);
      }
      if (here.view === "trial" || here.view === "questions") {
        const clip = here.view === "trial" ? await clipOf(page, server, "demo", trials) : undefined;
        if (clip) assert.ok(!(await page.content()).includes(clip), `the page does not say that it is ${clip}`);
        for (const one of await answer(page, hands, here.step)) given.push({ ...one, step: here.step, clip });
        if (trials === 1) await page.screenshot({ path: join(shots, "answered.png"), fullPage: true });
      }
      if (["consent", "questions", "page", "trial"].includes(here.view)) await go(page, hands);
      here = await leave(page, here);
      if (here.view === "receipt") here = await leave(page, here, 60_000);
      const wide = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
      assert.ok(!wide, `${here.view}: nothing scrolls sideways at ${viewport.width} px`);
    }
    assert.equal(here.view, "end");
    await page.screenshot({ path: join(shots, "end.png"), fullPage: true });
    assert.equal(await page.locator("[data-code=completion]").textContent(), "MIMIQUE-DEMO");
    assert.match(await page.locator("[data-code=receipt]").textContent(), /^[0-9a-f]{32,}$/);
    assert.equal(trials, 12);
    const elsewhere = browser.requests.filter((url) => !url.startsWith(server.url) && !/^(data|blob):/.test(url));
    assert.deepEqual(elsewhere, [], "no request leaves the study's own server");
    const unused = browser.requests.filter((url) => /\/(sound|adaptive)\//.test(url));
    assert.deepEqual(unused, [], "nothing of sound, nor of levels that follow the answers: the study has neither");
    assert.deepEqual(browser.errors, [], "the console is clean");
    return given;
  } finally {
    await browser.close();
  }
}

/** Exports and analyses; the export is what was clicked. */
function compare(server, { backend }, given, bundle) {
  const csv = join(server.folder, "export.csv");
  mimique(["export", "--database", server.database, "--format", "csv", "--out", csv]);
  const rows = parse(readFileSync(csv, "utf8"));
  const answers = rows.filter((row) => row.response_id !== "");
  const clicked = given.map((one) => `${one.clip ?? ""} ${one.question} = ${one.value}`).sort();
  const exported = answers.map((row) => `${row.stimulus} ${row.response_id} = ${row.answer}`).sort();
  assert.deepEqual(exported, clicked);

  const trials = answers.filter((row) => row.stimulus !== "");
  assert.equal(trials.length, 36, "12 clips, three questions each");
  for (const row of trials) {
    assert.equal(row.status, "completed");
    assert.equal(row.backend, backend);
    assert.ok(["lsts30", "box"].includes(row.method), row.method);
    assert.ok(Number(row.frames) > 1, "frames are logged");
    assert.ok(Number(row.rt) > 0, "response time from the frame shown");
    assert.equal(row.provenance, bundle.clips[row.stimulus].provenance, "of the clip as it was shown");
    assert.match(row.renderer, /^[0-9a-f]{16,64}$/);
    assert.equal(row.weights_hash, bundle.clips[row.stimulus].weights_hash, "the browser solved the server's bits");
    if (row.response_id === "emotion") {
      assert.equal(row.correct, String(row.answer === row.expression));
    }
  }
  const orders = new Map(trials.map((row) => [Number(row.trial_order), row.stimulus]));
  const order = JSON.parse(mimique(["order", study, "--participant", trials[0].participant_id.replace(/^\D+0*(?=\d)/, ""), "--json"]));
  assert.deepEqual([...orders].sort((a, b) => a[0] - b[0]).map(([, clip]) => clip), clipsOf(order), "the order is the one that `mimique order` prints");

  const report = join(server.folder, "report");
  mimique(["analyze", csv, "--study", study, "--out", report]);
  for (const file of ["report.html", "report.md", "results.json"]) assert.ok(existsSync(join(report, file)), file);
  const results = readFileSync(join(report, "results.json"), "utf8");
  assert.ok(JSON.parse(results), "the results are JSON");
}

function clipsOf(order) {
  const list = Array.isArray(order) ? order : order.trials ?? order.order;
  return list.map((each) => (typeof each === "string" ? each : each.clip)).filter(Boolean);
}
