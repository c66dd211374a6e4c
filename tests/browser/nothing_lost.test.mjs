// Sessions in a real browser over a network that drops, delays, doubles and reorders, with reloads and
// killed tabs: every answer that was clicked is exported once. Three sessions, or MIMIQUE_SESSIONS.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { badProxy } from "./lib/bad_proxy.mjs";
import { executable, open, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { go, phase, place } from "./lib/participant.mjs";
import { mimique, serve } from "./lib/server.mjs";
import { small, stimuli, text, trials } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");
const sessions = Number(process.env.MIMIQUE_SESSIONS ?? 3);

const scale = { type: "likert", numItems: 7, leftLabel: text("weak"), rightLabel: text("strong") };
const page_of = (id) => ({ type: "questionnaire", title: text(id), questions: [{ id, prompt: text("How?"), ...scale }, { id: `${id}_more`, prompt: text("And?"), ...scale }] });
const study = small("storm", {
  questions: [{ id: "rating", prompt: text("How strong?"), ...scale }],
  components: { first: page_of("first"), faces: trials(["joy2.box"], ["rating"]), last: page_of("last") },
  sequence: { order: "fixed", components: ["first", "faces", "last"] },
  stimuli: stimuli({ head: { builtin: { seed: 1, vertices: 2000 } } }, { box: { method: "box" } }, [["head", "box"]]),
});

test(`nothing lost: ${sessions} sessions over a bad network`, { skip: unable, timeout: 120_000 + sessions * 90_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "mimique-storm-"));
  writeFileSync(join(folder, "storm.json"), JSON.stringify(study));
  const server = await serve([join(folder, "storm.json")]);
  const clicked = [];
  const totals = {};
  let reloads = 0;
  let kills = 0;
  try {
    for (let session = 1; session <= sessions; session++) {
      const proxy = await badProxy(server.url, session * 2654435761);
      const browser = await open("undrawn", { viewport: { width: 480, height: 480 } });
      let { page } = browser;
      const address = `${proxy.url}/s/storm/?backend=webgl2`;
      const given = new Map();
      try {
        await page.goto(address);
        await page.waitForSelector("main[data-view]:not([data-view=opening])", { timeout: 60_000 });
        const trouble = new Set();
        for (let guard = 0; guard < 60; guard++) {
          const here = await place(page);
          if (here.view === "end") break;
          if (["receipt", "opening", "stuck"].includes(here.view)) {
            proxy.calm();
            // A request that was swallowed before is given up only after the page's patience.
            await page.waitForFunction((view) => [...document.querySelectorAll("main[data-view]")].find((main) => main.checkVisibility())?.dataset.view !== view, here.view, { timeout: 200_000 });
            continue;
          }
          if (here.view === "failure") {
            // The page could not begin: a person tries again.
            await page.locator("button.primary").click();
            await page.waitForTimeout(1000);
            continue;
          }
          if (here.view === "trial") {
            await phase(page, ["ready", "answering", "failed"], 120_000);
            if ((await place(page)).phase === "ready") await go(page, "mouse");
            await phase(page, "answering", 120_000);
          }
          if (here.view !== "consent") {
            for (const { question } of await page.locator("fieldset[data-question]").evaluateAll((all) => all.map((each) => ({ question: each.dataset.question })))) {
              const value = String(1 + ((session * 7 + question.length * 3) % 7));
              await page.locator(`fieldset[data-question="${question}"] label:has(input[value="${value}"])`).click();
              given.set(question, value);
            }
          }
          // In the middle of a page with answers: the tab is reloaded, or killed and opened again.
          const mark = `${here.step}`;
          if (!trouble.has(mark) && (session + trouble.size) % 2 === 0 && here.view !== "consent") {
            trouble.add(mark);
            if ((session + trouble.size) % 3 === 0) {
              kills++;
              const next = await browser.context.newPage();
              await page.close({ runBeforeUnload: false });
              page = next;
              await page.goto(address);
            } else {
              reloads++;
              await page.reload();
            }
            await page.waitForSelector("main[data-view]:not([data-view=opening])", { timeout: 60_000 });
            continue;
          }
          trouble.add(mark);
          await go(page, "mouse");
          await page
            .waitForFunction(([step, view]) => {
              const main = document.querySelector("main[data-view]");
              return main && (main.dataset.step !== step || main.dataset.view !== view);
            }, [here.step, here.view], { timeout: 60_000 });
        }
        assert.equal((await place(page)).view, "end", `session ${session}`);
        assert.match(await page.locator("[data-code=receipt]").textContent(), /^[0-9a-f]{32,}$/);
        // What is left in IndexedDB after the receipt: nothing.
        const left = await page.evaluate(
          () =>
            new Promise((done, fail) => {
              const opening = indexedDB.open("mimique");
              opening.onerror = () => fail(opening.error);
              opening.onsuccess = () => {
                const count = opening.result.transaction("outbox").objectStore("outbox").count();
                count.onsuccess = () => done(count.result);
              };
            }),
        );
        assert.equal(left, 0, `session ${session}: nothing waits`);
        for (const [question, value] of given) clicked.push(`${question} = ${value}`);
      } finally {
        for (const [what, count] of Object.entries(proxy.counts)) totals[what] = (totals[what] ?? 0) + count;
        await browser.close();
        await proxy.close();
      }
    }
    const csv = join(server.folder, "export.csv");
    mimique(["export", "--database", server.database, "--out", csv]);
    const rows = parse(readFileSync(csv, "utf8"));
    assert.deepEqual(rows.map((row) => `${row.response_id} = ${row.answer}`).sort(), clicked.sort(), "0 lost, 0 doubled");
    assert.equal(new Set(rows.map((row) => row.participant_id)).size, sessions, "one session per participant");
    assert.ok(rows.every((row) => row.status === "completed"));
    console.log(`${sessions} sessions, ${rows.length} answers, ${reloads} reloads, ${kills} killed tabs, requests ${JSON.stringify(totals)}: 0 lost, 0 doubled`);
    assert.ok(totals.lost + totals.unanswered + totals.held + totals.silent > 0, "there was a storm");
  } finally {
    await server.stop();
  }
});
