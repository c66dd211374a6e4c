// Labels in the studio: expressions named by hand are learnt from, suggestions confirmed, relabelled and
// moved by keys and by mouse, carried out; nothing that is confirmed changes.

import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { preview } from "./lib/server.mjs";
import { builtIn, download, unfold, violations } from "./lib/studio.mjs";

const noBrowser = skip(!executable && "Chromium not found");

const RATE_HZ = 25;
const FACES = [[0.02, 0, 0], [0.1, 1, 0], [0, 0, 1]];
const ORDER = [0, 1, 2, 1, 0, 2, 1, 0];

/// Two seconds each of neutral, smile, frown..., as a table of weights.
function weights() {
  const rows = ORDER.flatMap((face, i) =>
    Array.from({ length: 2 * RATE_HZ }, (_, f) => {
      const frame = 2 * RATE_HZ * i + f;
      const values = FACES[face].map((w, s) => w + 0.02 * Math.sin(frame * (s + 3) * 0.37));
      return [frame, frame / RATE_HZ, ...values].join(",");
    }),
  );
  return ["frame,time,jawOpen,mouthSmileLeft,browDownLeft", ...rows].join("\n");
}

const BY_HAND = "label,first_frame,last_frame\nrest,5,44\njoy1,55,94\nanger1,105,144\n";

test("studio: labels are learnt, suggested, confirmed, relabelled, moved and carried out", { skip: noBrowser, timeout: 600_000 }, async () => {
  const server = await preview([]);
  const browser = await open("undrawn");
  const { page } = browser;
  const boxes = () =>
    page.locator("#label-line .segment").evaluateAll((all) => all.map((box) => ({ label: box.textContent, state: box.dataset.state, title: box.title, left: box.style.insetInlineStart, width: box.style.width })));
  const note = () => page.locator("#labels-note").textContent();
  const settled = (words) => page.waitForFunction((words) => document.querySelector("#labels-note").textContent.includes(words), words, { timeout: 60_000 });
  try {
    await builtIn(page, server);
    const file = { name: "sentence.csv", mimeType: "text/csv", buffer: Buffer.from(weights()) };
    await page.setInputFiles("#take-file", file);
    await page.waitForFunction(() => document.querySelector("#take-facts").textContent.includes("sentence.csv"), null, { timeout: 60_000 });
    await unfold(page, "expressions");
    assert.ok(await page.locator("#labels-suggest").isDisabled(), "there is no model yet");

    // Three expressions by hand become truth; the rest is suggested.
    await page.setInputFiles("#expressions-file", { name: "by-hand.csv", mimeType: "text/csv", buffer: Buffer.from(BY_HAND) });
    await page.waitForFunction(() => document.querySelectorAll("#segments tr").length === 3);
    await unfold(page, "labelling");
    await page.click("#labels-take");
    await settled("3 of 3 confirmed");
    await page.click("#labels-learn");
    await page.waitForFunction(() => document.querySelectorAll("#label-line .segment").length > 6, null, { timeout: 60_000 });
    const learnt = await boxes();
    const truth = learnt.filter(({ state }) => state === "confirmed");
    assert.deepEqual(truth.map(({ label }) => label), ["rest", "joy", "anger"]);
    const long = learnt.filter(({ width }) => Number.parseFloat(width) > 8).map(({ label }) => label);
    assert.deepEqual(long, ["rest", "joy", "anger", "joy", "rest", "anger", "joy", "rest"]);
    assert.match(learnt.find(({ state }) => state !== "confirmed").title, /suggested, \d\.\d\d, then \w+ 0\.\d\d/);
    assert.ok(await page.locator("#label-plot").isVisible(), "probabilities under the line");

    // By keys: confirm, relabel, move; the focus goes on in order of time.
    const last = learnt.length - 1;
    await page.locator(`#label-line [data-box="${last - 1}"]`).focus();
    await page.keyboard.press("Enter");
    await settled("4 of");
    assert.equal(await page.evaluate(() => document.activeElement.dataset.box), String(last), "the next box has the focus");
    await page.keyboard.press("3");
    await settled("1 relabelled");
    assert.equal((await boxes())[last].label, "anger");
    await page.keyboard.press("Alt+ArrowRight");
    await settled("1 moved");
    const moved = (await boxes()).at(-1);
    assert.notEqual(moved.left, learnt[last].left);

    // By mouse: chosen, confirmed, given a new label, an edge dragged.
    const other = (await boxes()).findIndex(({ state, width }) => state !== "confirmed" && Number.parseFloat(width) > 8);
    await page.locator(`#label-line [data-box="${other}"]`).click();
    await page.locator("#label-new").fill("contempt");
    await page.click("#label-name");
    await settled("2 relabelled");
    const place = (await boxes()).findIndex(({ label }) => label === "contempt");
    const rect = await page.locator(`#label-line [data-box="${place}"]`).boundingBox();
    await page.mouse.move(rect.x + rect.width - 3, rect.y + 20);
    await page.mouse.down();
    await page.mouse.move(rect.x + rect.width - 30, rect.y + 20, { steps: 4 });
    await page.mouse.up();
    await settled("2 moved");
    // Taken back and done again.
    await page.keyboard.press("Control+z");
    await settled("1 moved");
    await page.keyboard.press("Control+Shift+z");
    await settled("2 moved");

    // What is confirmed stays as it is when the rest is learnt and suggested anew.
    const confirmed = async () => (await boxes()).filter(({ state }) => state === "confirmed").map(({ label, left, width }) => [label, left, width]);
    const before = await confirmed();
    await page.click("#labels-learn");
    await page.waitForFunction(() => document.querySelector("#busy").hidden);
    assert.deepEqual(await confirmed(), before);
    await page.click("#labels-suggest");
    await page.waitForFunction(() => document.querySelector("#busy").hidden);
    assert.deepEqual(await confirmed(), before);
    await page.check("#labels-unsure");
    const shown = await page.locator("#label-line .segment:not([hidden])").evaluateAll((all) => all.map((box) => box.dataset.state));
    assert.ok(shown.every((state) => state === "unsure"), shown.join());
    await page.uncheck("#labels-unsure");
    await page.locator("#labelling").screenshot({ path: join(screenshotFolder("studio"), "labels.png") });

    // Into CSV, ELAN, a model, the expressions, a study.
    const csv = String(await download(page, () => page.click("#labels-csv")));
    assert.ok(csv.split("\n")[0].endsWith("probability,second,second_probability,confirmed"), csv.slice(0, 200));
    assert.ok(csv.includes("contempt,"), csv);
    const eaf = String(await download(page, () => page.click("#labels-eaf")));
    for (const tier of ["labels", "labels (suggested)", "labels (confidence)"]) assert.ok(eaf.includes(`TIER_ID="${tier}"`), tier);
    const model = await download(page, () => page.click("#labels-model"));
    await page.click("#labels-put");
    await page.waitForFunction(() => document.querySelectorAll("#segments tr").length >= 7);
    await unfold(page, "expressions");
    const study = JSON.parse(String(await download(page, () => page.click("#save-study"))));
    await unfold(page, "labelling");
    assert.ok(study.segments.some(({ id }) => id === "contempt"), JSON.stringify(study));

    // The model that was saved suggests labels for another take.
    await page.setInputFiles("#take-file", { ...file, name: "other.csv" });
    await page.waitForFunction(() => document.querySelector("#take-facts").textContent.includes("other.csv"), null, { timeout: 60_000 });
    await page.waitForFunction(() => document.querySelectorAll("#label-line .segment").length === 0);
    await page.setInputFiles("#label-model", { name: "model.json", mimeType: "application/json", buffer: model });
    await settled("learnt from sentence.csv");
    await page.click("#labels-suggest");
    await page.waitForFunction(() => document.querySelectorAll("#label-line .segment").length > 6, null, { timeout: 60_000 });
    assert.match(await note(), /0 of \d+ confirmed/);

    await page.setInputFiles("#label-model", { name: "broken.json", mimeType: "application/json", buffer: Buffer.from("{") });
    await page.waitForFunction(() => document.querySelector("#problem").textContent.includes("broken.json: model: line 1"));
    assert.deepEqual(await violations(page), []);
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});
