// A study as JATOS hosts it, by a mock of JATOS (lib/jatos_mock.mjs); with MIMIQUE_JATOS_SCRIPTS, a folder, by its own
// scripts. The archive is imported; answers are appended as they come; whoever leaves has left them; a second person at the
// same browser begins anew; what JATOS exports is imported, and is what was clicked.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { strToU8, zipSync } from "fflate";
import { executable, open, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { taken } from "./lib/guide_picture.mjs";
import { imported, jatos } from "./lib/jatos_mock.mjs";
import { answer, go, leave, phase, place } from "./lib/participant.mjs";
import { mimique } from "./lib/server.mjs";
import { small, stimuli, text, trials } from "./lib/small_study.mjs";

const unable = skip(executable ? false : "Chromium not found");
const rating = { id: "rating", type: "likert", prompt: text("How strong?"), numItems: 7, leftLabel: text("weak"), rightLabel: text("strong") };

test("jatos: a study is imported, answers go by its API as they come, what it exports is imported", { skip: unable, timeout: 300_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "mimique-jatos-"));
  const study = small("two-faces", {
    recruitment: { completionCode: "DONE", urlParameters: ["PROLIFIC_PID"], redirect: "https://example.org/?cc={code}&who={PROLIFIC_PID}" },
    questions: [rating],
    components: { faces: trials(["joy2.box", "joy2.lsts"], ["rating"]) },
    sequence: { order: "fixed", components: ["faces"] },
    stimuli: stimuli({ head: { builtin: { seed: 1 } } }, { box: { method: "box" }, lsts: { method: "lsts" } }, [["head", "box"], ["head", "lsts"]]),
  });
  const file = join(folder, "two-faces.json");
  writeFileSync(file, JSON.stringify(study));
  const archive = join(folder, "two-faces.jzip");
  const pages = process.env.MIMIQUE_WEB_DIR ? ["--web-dir", process.env.MIMIQUE_WEB_DIR] : [];
  const made = (out) => mimique(["export-site", file, "--jatos", "--out", out, "--packs", join(folder, "packs"), ...pages]);
  made(archive);
  made(join(folder, "again.jzip"));
  assert.ok(readFileSync(archive).equals(readFileSync(join(folder, "again.jzip"))), "the same bytes each time");
  assert.throws(() => mimique(["export-site", file, "--jatos", "--out", join(folder, "site")], { stdio: "pipe" }), /write --out NAME\.jzip/);

  const host = await jatos(imported(readFileSync(archive)), { scripts: process.env.MIMIQUE_JATOS_SCRIPTS, failing: 1 });
  const browser = await open("undrawn", { viewport: { width: 800, height: 900 } });
  const { page } = browser;
  page.on("dialog", (dialog) => dialog.accept());
  const clicked = { first: [], left: [] };
  /** Takes part until the last page, or until so many trials are answered. */
  const takePart = async (given, most = Infinity) => {
    await page.waitForSelector("main[data-view=consent]", { timeout: 60_000 });
    let here = await place(page);
    for (let guard = 0; here.view !== "end" && guard < 12; guard++) {
      if (here.view === "trial") {
        await phase(page, "ready", 120_000);
        await go(page, "mouse");
        await phase(page, "answering", 120_000);
        here = await place(page);
        for (const one of await answer(page, "mouse", here.step)) given.push(`${one.question} = ${one.value}`);
      }
      if (here.view !== "receipt") await go(page, "mouse");
      here = await leave(page, here, 60_000);
      if (given.length >= most) return;
    }
  };
  /** Waits for what the host was told. */
  const until = async (holds, what) => {
    for (let tries = 0; tries < 200 && !holds(); tries++) await page.waitForTimeout(100);
    assert.ok(holds(), what);
  };
  try {
    await page.goto(`${host.begin("run-one", { PROLIFIC_PID: "a b", batchId: "1" })}`);
    await takePart(clicked.first);
    assert.equal(await page.locator("[data-code=completion]").textContent(), "DONE");
    await taken(page, "jatos-end.jpg");
    assert.equal(await page.locator("a.button.primary").getAttribute("href"), "https://example.org/?cc=DONE&who=a%20b");
    const one = host.runs.get("run-one");
    await until(() => one.successful !== undefined, "the run is ended");
    assert.deepEqual([one.successful, one.message], [true, "completed"]);
    assert.ok(one.result.length > 2, `${one.result.length} parts`);
    // Nothing of the person is left in the browser.
    const kept = await page.evaluate(() => Object.keys(localStorage).filter((key) => key.startsWith("mimique/")));
    assert.deepEqual(kept, []);

    // A second person at the same browser, who leaves after the first trial, and whose answer is there all the same.
    await page.goto(host.begin("run-two"));
    await takePart(clicked.left, 1);
    const two = host.runs.get("run-two");
    await until(() => two.result.join("").includes('"answer'), "the answer has arrived");
    // A reload goes on where it was.
    await page.reload();
    await page.waitForSelector("main[data-view=trial]", { timeout: 60_000 });
    await page.goto("about:blank");
    assert.equal(two.successful, undefined);

    // What JATOS exports: data alone, one result after the other; or an archive.
    const results = [...host.runs.values()].map(({ result }) => result.join(""));
    const data = join(folder, "jatos_results_data.txt");
    writeFileSync(data, results.join("\n"));
    const whole = join(folder, "jatos_results.jrzip");
    const entries = results.map((result, k) => [`study_result_${k}/comp-result_${k}/data.txt`, strToU8(result)]);
    writeFileSync(whole, zipSync(Object.fromEntries([["metadata.json", strToU8("{}")], ...entries])));
    const read = (from, out) => {
      mimique(["import", file, from, "--out", join(folder, out)]);
      return parse(readFileSync(join(folder, out), "utf8"));
    };
    const rows = read(data, "data.csv");
    assert.deepEqual(read(whole, "whole.csv"), rows);
    const answers = (status) => rows.filter((row) => row.status === status && row.response_id === "rating").map((row) => `rating = ${row.answer}`).sort();
    assert.deepEqual(answers("completed"), clicked.first.sort());
    const others = rows.filter((row) => row.status !== "completed");
    assert.deepEqual(others.filter((row) => row.response_id === "rating" && row.answer !== "").map((row) => `rating = ${row.answer}`), clicked.left);

    // A part that is missing in the middle is said.
    const holed = [one.result[0], ...one.result.slice(2)].join("");
    writeFileSync(data, holed);
    assert.throws(() => mimique(["import", file, data, "--out", join(folder, "x.csv")], { stdio: "pipe" }), (error) => {
      assert.equal(error.status, 2);
      assert.match(error.stderr, /event \d+ of session s[0-9a-f]{8} is missing; give all/);
      return true;
    });
  } finally {
    await browser.close();
    host.close();
  }
});
