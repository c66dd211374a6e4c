// How people come from a recruiting service and go back: with the examples of docs/guide/recruitment.md, every way
// a session can end, each with its code and its address, or without.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { go, leave, phase, place } from "./lib/participant.mjs";
import { mimique, root, serve } from "./lib/server.mjs";
import { small, stimuli, text, trials } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");

/** The section `recruitment` that the documentation gives under a heading. */
function documented(heading) {
  const page = readFileSync(join(root, "docs/guide/recruitment.md"), "utf8");
  const [, part] = page.split(`\n## ${heading}\n`);
  return JSON.parse(`{${part.match(/```json\n([^]*?)```/)[1]}}`).recruitment;
}

const colours = ["red", "blue"].map((value) => ({ value, label: text(value) }));
const check = (id) => ({ id, type: "singleChoice", prompt: { en: "Please choose blue.", fr: "Choisissez blue (fr)." }, options: colours, attentionCheck: { expected: "blue" } });
const study = (id, recruitment) =>
  small(id, {
    recruitment,
    demographics: {
      title: text("About you"),
      questions: [{ id: "age", type: "number", prompt: text("How old are you?"), minimum: 0, maximum: 120, integer: true }, check("first"), check("second")],
    },
    screening: [{ if: { question: "age", atMost: 17 }, reason: text("This study is for adults.") }],
    attentionChecks: { allowedFailures: 1, when: "immediately" },
    questions: [{ id: "rating", type: "likert", prompt: text("How strong?"), numItems: 7, leftLabel: text("weak"), rightLabel: text("strong") }],
    components: { faces: { ...trials(["joy2.box"], ["rating"]), timeLimit: { seconds: 5, extensions: 0, essential: text("It is short.") } } },
    sequence: { order: "fixed", components: ["faces"] },
    stimuli: stimuli({ head: { builtin: { seed: 1, vertices: 2000 } } }, { box: { method: "box" } }, [["head", "box"]]),
  });

/** How each person behaves, and how the session then ends. */
const people = {
  completed: { age: "30", colour: "blue" },
  slow: { age: "30", colour: "blue", slow: true },
  screened_out: { age: "16", colour: "blue" },
  failed_checks: { age: "30", colour: "red" },
  declined: {},
};

/** Takes part in a browser of one's own; what stands on the last page. */
async function takePart(address, { age, colour, slow }) {
  const browser = await open("undrawn", { viewport: { width: 900, height: 900 } });
  const { page } = browser;
  const end = () =>
    page.evaluate(() => {
      const one = (selector) => document.querySelector(selector);
      const { view, outcome = null } = one("main").dataset;
      const code = one("[data-code=completion]")?.textContent ?? null;
      const back = one("a.button.primary")?.getAttribute("href") ?? null;
      return { view, outcome, code, back, again: document.querySelectorAll("[data-action=another-person]").length };
    });
  try {
    await page.goto(address);
    await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
    if (age === undefined) {
      await page.locator("[data-action=decline]").click();
      await page.waitForSelector("main[data-view=declined]");
      return await end();
    }
    let here = await place(page);
    await go(page, "mouse");
    here = await leave(page, here);
    await page.locator("fieldset[data-question=age] input").fill(age);
    for (const id of ["first", "second"]) await page.locator(`fieldset[data-question=${id}] label:has(input[value=${colour}])`).click();
    await go(page, "mouse");
    here = await leave(page, here, 60_000);
    if (here.view === "trial") {
      await phase(page, "ready", 120_000);
      await go(page, "mouse");
      await phase(page, "answering", 120_000);
      if (!slow) {
        await page.locator("fieldset[data-question=rating] label").first().click();
        await go(page, "mouse");
      }
    }
    await page.waitForSelector("main[data-view=end]", { timeout: 60_000 });
    return await end();
  } finally {
    await browser.close();
  }
}

async function host(id, recruitment) {
  const folder = mkdtempSync(join(tmpdir(), "mimique-recruitment-"));
  writeFileSync(join(folder, `${id}.json`), JSON.stringify(study(id, recruitment)));
  return serve([join(folder, `${id}.json`)]);
}

test("recruitment: Prolific, every way out with its code", { skip: unable, timeout: 300_000 }, async () => {
  const prolific = documented("Prolific");
  const server = await host("prolific", prolific);
  try {
    const wanted = { completed: "completionCode", slow: "completionCode", screened_out: "screenedOutCode", failed_checks: "failedChecksCode" };
    for (const [name, person] of Object.entries(people)) {
      const end = await takePart(`${server.url}/s/prolific/?backend=webgl2&PROLIFIC_PID=${name}%2B1&STUDY_ID=s&SESSION_ID=x`, person);
      if (name === "declined") {
        assert.deepEqual(end, { view: "declined", outcome: "declined", code: null, back: null, again: 0 });
        continue;
      }
      const code = prolific[wanted[name]];
      assert.match(code, /^[0-9A-Z]{8}$/);
      const outcome = name === "slow" ? "completed" : name;
      assert.deepEqual(end, { view: "end", outcome, code, back: `https://app.prolific.com/submissions/complete?cc=${code}`, again: 0 });
    }
    // The page cannot know a code before its end.
    const bundle = await (await fetch(`${server.url}/api/studies/prolific`)).text();
    for (const code of Object.values(wanted)) assert.ok(!bundle.includes(prolific[code]), code);

    // Identifiers stand in an export that asks for them, and nowhere else.
    const rows = (...options) => parse(mimique(["export", "--database", server.database, ...options]));
    const ends = (rows) => Object.fromEntries(rows.map((row) => [row.PROLIFIC_PID, row.status]));
    const named = ends(rows("--with-identifiers"));
    assert.deepEqual(named, { "completed+1": "completed", "slow+1": "completed", "screened_out+1": "screened_out", "failed_checks+1": "failed_checks" });
    assert.ok(rows().every((row) => row.PROLIFIC_PID === undefined && !JSON.stringify(row).includes("+1")));
    const slow = rows("--with-identifiers").find((row) => row.PROLIFIC_PID === "slow+1" && row.response_id === "rating");
    assert.deepEqual([slow.timed_out, slow.answer], ["true", ""]);
  } finally {
    await server.stop();
  }
});

test("recruitment: SONA, credit for those who completed alone", { skip: unable, timeout: 300_000 }, async () => {
  const sona = documented("SONA");
  // Where anybody may take part again, another person is offered the page only if nobody was sent there.
  const server = await host("sona", { ...sona, repeatPrevention: "none" });
  try {
    const address = `${server.url}/s/sona/?backend=webgl2`;
    const came = `${address}&survey_code=12345`;
    const back = "https://SCHOOL.sona-systems.com/webstudy_credit.aspx?experiment_id=123&credit_token=4e48f9b638a&survey_code=12345";
    assert.deepEqual(await takePart(came, people.completed), { view: "end", outcome: "completed", code: null, back, again: 0 });
    for (const outcome of ["screened_out", "failed_checks"])
      assert.deepEqual(await takePart(came, people[outcome]), { view: "end", outcome, code: null, back: null, again: 0 });
    assert.deepEqual(await takePart(came, people.declined), { view: "declined", outcome: "declined", code: null, back: null, again: 0 });
  } finally {
    await server.stop();
  }
});
