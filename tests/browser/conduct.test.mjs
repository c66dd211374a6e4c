// Who may take part, and how: the device gate that looks again when the window grows, the card held
// to the screen, practice with feedback, a time limit that can be extended, screening by an answer;
// by keyboard alone on a narrow dark screen too. Every page is looked at by axe.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { looker } from "./lib/access.mjs";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { go, leave, phase, place, tabTo } from "./lib/participant.mjs";
import { mimique, serve } from "./lib/server.mjs";
import { small, stimuli, text, trials } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");

const study = (parts) =>
  small("conduct", {
    recruitment: { completionCode: "DONE", screenedOutCode: "OUT", failedChecksCode: "FAILED" },
    device: { minimumWidth: 300, minimumHeight: 500, minimumRefreshHz: 1 },
    demographics: { title: text("About you"), questions: [{ id: "age", type: "number", prompt: text("How old are you?"), minimum: 0, maximum: 120, integer: true }] },
    screening: [{ if: { question: "age", atMost: 17 }, reason: text("This study is for adults.") }],
    calibration: { required: true, askDistance: true, distanceCm: 60 },
    training: { clips: ["joy2.box"], questions: ["emotion"], feedback: true, criterion: { correct: 1, maximumRounds: 2 } },
    questions: [
      { id: "emotion", type: "singleChoice", prompt: text("Which emotion?"), truth: "expression", options: ["fear", "joy"].map((value) => ({ value, label: text(value) })) },
      { id: "rating", type: "likert", prompt: text("How strong?"), numItems: 7, leftLabel: text("weak"), rightLabel: text("strong") },
    ],
    components: { faces: { ...trials(["joy2.box"], ["emotion", "rating"]), timeLimit: { seconds: 25 } } },
    sequence: { order: "fixed", components: ["faces"] },
    stimuli: { ...stimuli({ head: { builtin: { seed: 1 } } }, { box: { method: "box" } }, [["head", "box"]]), look: { widthMm: 60, heightMm: 60 } },
    ...parts,
  });

async function host(parts) {
  const folder = mkdtempSync(join(tmpdir(), "mimique-conduct-"));
  writeFileSync(join(folder, "conduct.json"), JSON.stringify(study(parts)));
  return serve([join(folder, "conduct.json")]);
}

function exported(server) {
  const csv = join(server.folder, "export.csv");
  mimique(["export", "--database", server.database, "--out", csv]);
  return parse(readFileSync(csv, "utf8"));
}

for (const [scheme, width, hands, locale] of [["light", 1280, "mouse", "en-GB"], ["dark", 320, "keyboard", "fr-FR"]]) {
  test(`conduct: gate, card, practice, clock by ${hands}, ${scheme}, ${width} px`, { skip: unable, timeout: 300_000 }, async () => {
    const server = await host({});
    const browser = await open("undrawn", { viewport: { width, height: 400 }, colorScheme: scheme, locale });
    const { page } = browser;
    const { look, seen } = looker(page, screenshotFolder(`conduct-${scheme}-${width}`));
    const press = async (selector) => {
      if (hands === "mouse") return page.locator(selector).first().click();
      await tabTo(page, selector);
      await page.keyboard.press("Enter");
    };
    try {
      await page.goto(`${server.url}/s/conduct/?backend=webgl2`);
      await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
      let here = await place(page);
      await go(page, hands);
      here = await leave(page, here);

      // The window is too low: the page says so, and looks again when it grows.
      assert.equal(here.view, "device");
      await page.waitForSelector(".notice.warn");
      assert.match(await page.locator(".notice.warn").innerText(), /400.*500/s);
      await look("device-refused");
      await page.setViewportSize({ width, height: 900 });
      await page.waitForSelector("main[data-fine=true]");
      await look("device-fine");
      await press("[data-action=next]");
      here = await leave(page, here);

      assert.equal(here.view, "questions");
      await tabTo(page, "fieldset[data-question=age] input");
      await page.keyboard.type("30");
      await go(page, hands);
      here = await leave(page, here);

      assert.equal(here.view, "calibration");
      await go(page, hands);
      await page.waitForSelector(".problem");
      await look("calibration-missing");
      await tabTo(page, "fieldset[data-question=card] input[type=range]");
      for (let i = 0; i < 60; i++) await page.keyboard.press("ArrowRight");
      await press("[data-action=larger]");
      await tabTo(page, "#distance");
      await page.keyboard.type("55");
      await page.keyboard.press("Tab");
      // What was typed is drawn when a picture has been taken.
      await look("calibration");
      const card = await page.locator(".bank-card").boundingBox();
      const [long, short] = [Math.max(card.width, card.height), Math.min(card.width, card.height)];
      assert.ok(Math.abs(long / short - 85.6 / 53.98) < 0.01, "the shape of a card");
      assert.equal(card.width > card.height, width > 600, "upright where the screen is narrow");
      await go(page, hands);
      here = await leave(page, here);

      // Practice: wrong, told so, again; then right.
      for (const choice of ["fear", "joy"]) {
        assert.match(here.heading, /^(Practice clip|Extrait d’entraînement) 1/);
        await phase(page, "ready", 120_000);
        const stage = await page.locator(".stage").boundingBox();
        assert.ok(Math.abs(stage.width - (60 * long) / 85.6) < 1 || stage.width >= width - 80, `60 mm wide: ${stage.width}`);
        await go(page, hands);
        await phase(page, "answering", 120_000);
        await page.locator(`label:has(input[value=${choice}])`).click();
        await go(page, hands);
        here = await leave(page, here, 60_000);
        assert.equal(here.view, "feedback");
        assert.equal(await page.locator("main").getAttribute("data-correct"), String(choice === "joy"));
        await look(`feedback-${choice}`);
        await go(page, hands);
        here = await leave(page, here);
      }

      // The clock: seen, extended once, then over.
      assert.match(here.heading, /^(Clip|Extrait) 1/);
      await phase(page, "ready", 120_000);
      await look("clock-announced");
      await go(page, hands);
      await phase(page, "answering", 120_000);
      await page.locator("label:has(input[value=joy])").click();
      await page.waitForSelector(".clock.near", { timeout: 20_000 });
      await look("clock-near");
      assert.notEqual(await page.locator(".clock [role=status]").innerText(), "");
      await press("[data-action=more-time]");
      await page.waitForSelector(".clock:not(.near)");
      here = await leave(page, here, 60_000);
      if (here.view === "receipt") here = await leave(page, here, 60_000);
      assert.equal(here.view, "end");
      assert.equal(await page.locator("[data-code=completion]").textContent(), "DONE");
      await look("end");

      const rows = exported(server);
      const rating = rows.find((row) => row.trial_type === "trial" && row.response_id === "rating");
      assert.equal(rating.timed_out, "true");
      assert.equal(rating.answer, "", "what was not answered is empty");
      assert.equal(rating.viewing_distance_cm, "55");
      assert.ok(Math.abs(Number(rating.px_per_mm) - long / 85.6) < 0.01);
      assert.equal(rows.filter((row) => row.trial_type === "training").length, 2, "two rounds");
      assert.ok(rows.every((row) => row.status === "completed"));
      assert.ok(seen.length >= 9);
      assert.deepEqual(browser.errors, [], "the console is clean");
    } finally {
      await browser.close();
      await server.stop();
    }
  });
}

test("conduct: who cannot put the device right, and who is too young, is told why and goes back with a code", { skip: unable, timeout: 120_000 }, async () => {
  const server = await host({ device: { minimumWidth: 4000 } });
  const browser = await open("undrawn", { viewport: { width: 800, height: 900 } });
  const { page } = browser;
  const { look } = looker(page, screenshotFolder("conduct-out"));
  try {
    await page.goto(`${server.url}/s/conduct/?backend=webgl2`);
    await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
    await go(page, "mouse");
    await page.waitForSelector("[data-action=give-up]");
    await page.locator("[data-action=give-up]").click();
    await page.waitForSelector("main[data-view=end]", { timeout: 30_000 });
    assert.equal(await page.locator("main").getAttribute("data-outcome"), "screened_out");
    assert.equal(await page.locator("[data-code=completion]").textContent(), "OUT");
    assert.match(await page.locator("main").innerText(), /800 pixels wide; the study needs 4000/);
    await look("screened-out");
    const row = exported(server).find((row) => row.trial_type === "screening");
    assert.deepEqual([row.status, row.answer], ["screened_out", "device: minimumWidth"]);
  } finally {
    await browser.close();
    await server.stop();
  }

  const young = await host({ device: undefined });
  const second = await open("undrawn", {});
  try {
    await second.page.goto(`${young.url}/s/conduct/?backend=webgl2`);
    await second.page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
    await go(second.page, "keyboard");
    await second.page.waitForSelector("main[data-view=questions]");
    await second.page.locator("fieldset[data-question=age] input").fill("16");
    await go(second.page, "keyboard");
    await second.page.waitForSelector("main[data-view=end]", { timeout: 30_000 });
    assert.match(await second.page.locator("main").innerText(), /This study is for adults/);
    assert.equal(await second.page.locator("[data-code=completion]").textContent(), "OUT");
  } finally {
    await second.close();
    await young.stop();
  }
});
