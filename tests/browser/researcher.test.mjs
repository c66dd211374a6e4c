// A researcher's first day: makes the owner's account by the printed link, watches somebody take part
// without touching the page, excludes with a reason, exports, reads the report, uploads a study; every
// page for everybody (axe, 360 px, dark, French).

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { violations } from "./lib/access.mjs";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { savedBytes } from "./lib/saved.mjs";
import { root, serve } from "./lib/server.mjs";
import { small, stimuli, text, trials } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");
const password = "four words are good";
/** Where the researcher sits: neither the server's zone nor a whole number of hours from it. */
const ZONE = "Asia/Kolkata";

const study = (id) =>
  small(id, {
    components: {
      how: {
        type: "questionnaire",
        questions: [
          { id: "mood", type: "likert", prompt: text("How are you?"), numItems: 7, leftLabel: text("bad"), rightLabel: text("good") },
          { id: "remark", type: "longText", prompt: text("Anything else?"), required: false },
        ],
      },
      faces: trials(["joy2.box"], ["real"]),
    },
    questions: [{ id: "real", type: "likert", prompt: text("How real?"), numItems: 7, leftLabel: text("not"), rightLabel: text("very") }],
    sequence: { order: "fixed", components: ["how", "faces"] },
    stimuli: stimuli({ head: { builtin: { seed: 1, vertices: 2000 } } }, { box: { method: "box" } }, [["head", "box"]]),
  });

/** Takes part as the pages do, by the interface alone; the trial is left to the tests that play it. */
async function takePart(server, id, nonce, mood, whole = true) {
  const post = async (path, body) => {
    const answer = await fetch(`${server.url}${path}`, { method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(body) });
    assert.ok(answer.ok, `${path}: ${answer.status} ${await answer.clone().text()}`);
    return answer.json();
  };
  const client = { browser: "Firefox", version: "140", platform: "Linux" };
  const started = await post(`/api/studies/${id}/sessions`, { nonce: nonce.repeat(32), language: "en", client });
  const display = { viewport: [1280, 900], device_pixel_ratio: 1, about: client };
  const bodies = [
    { type: "opened", client: display, language: "en" },
    { type: "consented", version: "1", language: "en" },
    { type: "page_shown", step: "how" },
  ];
  if (whole) {
    bodies.push({ type: "answered", step: "how", question: "mood", value: mood });
    bodies.push({ type: "page_finished", step: "how", answers: { mood, remark: "=SUM(1)" } });
    bodies.push({ type: "finished" });
  }
  const events = bodies.map((body, sequence) => ({ sequence, at_ms: Date.now() + sequence, body }));
  await post(`/api/sessions/${started.session}/events`, { events });
  if (whole) await post(`/api/sessions/${started.session}/complete`, { events: events.length });
  return started;
}

test("researcher: account, live dashboard, exclusion, export, upload", { skip: unable, timeout: 300_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "mimique-researcher-"));
  writeFileSync(join(folder, "moods.json"), JSON.stringify(study("moods")));
  writeFileSync(join(folder, "second.json"), JSON.stringify(study("second")));
  const broken = { ...study("broken"), languges: ["en"] };
  writeFileSync(join(folder, "broken.json"), JSON.stringify(broken));
  const server = await serve([join(folder, "moods.json")]);
  const browser = await open("undrawn", { viewport: { width: 1280, height: 900 }, timezone: ZONE });
  const { page } = browser;
  const shots = screenshotFolder("researcher");
  let count = 0;
  /** Nothing for axe to find, nothing wider than the window, and pictures for people to look at. */
  const look = async (name, sizes = [[1280, "light"], [768, "dark"], [360, "light"]]) => {
    count += 1;
    for (const [width, colorScheme] of sizes) {
      await page.setViewportSize({ width, height: 900 });
      await page.emulateMedia({ colorScheme });
      await page.screenshot({ path: join(shots, `${String(count).padStart(2, "0")}-${name}-${width}.png`), fullPage: true });
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
      assert.ok(wide <= 0, `${name} scrolls sideways by ${wide} px at ${width} px`);
      assert.deepEqual(await violations(page), [], `${name}, ${width} px: axe`);
      assert.equal(await page.locator("h1").count(), 1, `${name}: one main heading`);
    }
    await page.setViewportSize({ width: 1280, height: 900 });
    await page.emulateMedia({ colorScheme: "light" });
  };
  try {
    // The link makes the account and logs in; used once, it is dead.
    const link = server.researcher();
    assert.match(link, /\/researcher\/link\/[0-9a-f]{32}$/);
    await page.goto(link);
    await look("first-account");
    await page.getByLabel("E-mail").fill("ada@example.org");
    await page.getByLabel("Password").fill(password);
    await page.keyboard.press("Enter");
    await page.waitForURL("**/researcher");
    await look("studies");
    assert.equal((await fetch(link)).status, 410);
    await page.getByRole("button", { name: "Log out" }).click();
    await page.waitForURL("**/researcher/login");
    await look("login");
    await page.goto(`${server.url}/researcher/studies/moods`);
    await page.getByLabel("E-mail").fill("ada@example.org");
    await page.getByLabel("Password").fill("not the password");
    await page.keyboard.press("Enter");
    await page.waitForSelector("[role=alert]");
    await look("wrong-password", [[1280, "light"]]);
    await page.getByLabel("E-mail").fill("ada@example.org");
    await page.getByLabel("Password").fill(password);
    await page.keyboard.press("Enter");
    // Back to where one wanted to be.
    await page.waitForURL("**/researcher/studies/moods");

    // Somebody arrives and is seen without a touch.
    await page.waitForSelector("text=Nobody yet.");
    await page.waitForSelector("text=Live: the page follows");
    const first = await takePart(server, "moods", "a", 6);
    await page.waitForSelector(`a:has-text("${first.participant_id}")`, { timeout: 10_000 });
    await takePart(server, "moods", "b", 2);
    await takePart(server, "moods", "c", 4, false);
    await page.waitForFunction(() => document.querySelectorAll("[data-live] td.browser").length === 3, undefined, { timeout: 10_000 });
    const counts = await page.locator("dl.counts").innerText();
    // Every standing has its number, those that nobody has included.
    const none = ["abandoned", "declined", "device refused", "screened out", "practice failed", "attention checks failed", "withdrawn"];
    const expected = `under way 1 ${none.map((standing) => `${standing} 0`).join(" ")} completed 2`;
    assert.ok(counts.replace(/\s+/g, " ").includes(expected), `${counts} has: ${expected}`);
    await look("dashboard");

    // Times are those of the reader's zone.
    const times = await page.locator("time[datetime]").evaluateAll((all) => all.map(({ dateTime, textContent, dataset }) => [dateTime, textContent, dataset.day === undefined]));
    assert.ok(times.some(([, , withClock]) => withClock), "times of the day are told");
    const plain = (text) => text.replace(/\s/g, " ");
    for (const [at, shown, withClock] of times) {
      const style = withClock ? { dateStyle: "short", timeStyle: "medium" } : { dateStyle: "medium" };
      assert.equal(plain(shown), plain(new Date(at).toLocaleString("en", { ...style, timeZone: ZONE })));
    }

    // Those of one standing are listed alone, and the page goes on following.
    await page.getByRole("link", { name: "completed" }).click();
    await page.waitForURL("**/researcher/studies/moods?standing=completed");
    const listed = () => page.locator("[data-live] td.browser").count();
    assert.equal(await listed(), 2);
    await look("completed", [[1280, "light"], [360, "dark"]]);
    await page.waitForSelector("text=Live: the page follows");
    await takePart(server, "moods", "e", 5, false);
    await page.waitForFunction(() => /under way\s*2/.test(document.querySelector("dl.counts").innerText), undefined, { timeout: 10_000 });
    assert.equal(await listed(), 2, "who is under way is counted, and not listed here");
    await page.getByRole("link", { name: "all", exact: true }).click();
    await page.waitForURL("**/researcher/studies/moods");
    assert.equal(await listed(), 4);

    // One is excluded with a reason.
    await page.getByRole("link", { name: "p0002" }).click();
    await page.waitForURL("**/participants/2");
    await look("participant");
    await page.getByLabel("Reason").fill("watched with a friend");
    await page.getByRole("button", { name: "Exclude" }).click();
    await page.waitForSelector("text=Take the exclusion back");
    await look("excluded", [[1280, "dark"], [360, "light"]]);
    await page.goto(`${server.url}/researcher/studies/moods`);
    assert.match((await page.locator("dl.counts").innerText()).replace(/\s+/g, " "), /excluded 1/);

    // Exports are one click each; the one excluded is in them, marked.
    const saved = async (name) => {
      const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("link", { name, exact: true }).click()]);
      return String(await savedBytes(download));
    };
    const rows = parse(await saved("Tidy CSV"));
    const second = rows.filter((row) => row.participant_id === "p0002");
    assert.ok(second.length > 0 && second.every((row) => row.excluded === "true" && row.exclusion_reason === "watched with a friend"));
    assert.ok(rows.some((row) => row.participant_id === "p0001" && row.excluded === "false"));
    assert.ok(rows.some((row) => row.answer === "=SUM(1)"), "texts are as they were written");
    const spreadsheet = parse(await saved("tidy"));
    assert.ok(spreadsheet.some((row) => row.answer === "'=SUM(1)"), "for a spreadsheet they are neutralised");
    assert.equal(JSON.parse(await saved("Study file")).id, "moods");
    assert.match(await saved("Data dictionary"), /^name,kind,unit,levels,description/);

    // A study with errors is refused with the whole report, a good one is prepared and hosted.
    await page.goto(`${server.url}/researcher/upload`);
    await page.getByLabel("Archive or study file").setInputFiles(join(folder, "broken.json"));
    await page.getByRole("button", { name: "Upload and check" }).click();
    await page.waitForSelector("text=unknown key");
    await look("upload-refused");
    await page.getByLabel("Archive or study file").setInputFiles(join(folder, "second.json"));
    await page.getByRole("button", { name: "Upload and check" }).click();
    await page.waitForSelector("text=hosted as a pilot", { timeout: 30_000 });
    await look("upload-ready", [[1280, "light"]]);
    await page.getByRole("link", { name: "To the study" }).click();
    await page.getByRole("button", { name: "End the pilot" }).waitFor();
    const there = await takePart(server, "second", "d", 5);
    assert.equal(there.stage, "pilot");

    // Accounts, tokens, log; in French.
    await page.goto(`${server.url}/researcher/people`);
    await page.getByLabel("E-mail").fill("bo@example.org");
    await page.getByLabel(/^analyst/).check();
    await page.getByRole("button", { name: "Make a link" }).click();
    await page.waitForSelector("[data-secret]");
    await look("people");
    await page.goto(`${server.url}/researcher/account`);
    await look("account");
    await page.getByRole("link", { name: "Français" }).click();
    await page.waitForSelector("html[lang=fr]");
    await look("account-french", [[360, "dark"]]);
    await page.goto(`${server.url}/researcher/studies/moods`);
    await look("dashboard-french", [[1280, "dark"], [360, "dark"]]);
    await page.goto(`${server.url}/researcher/studies/moods/participants/2`);
    await look("participant-french", [[1280, "light"], [360, "dark"]]);
    await page.goto(`${server.url}/researcher/upload`);
    await look("upload-french", [[1280, "dark"], [360, "light"]]);
    await page.goto(`${server.url}/researcher/people`);
    await look("people-french", [[360, "dark"]]);
    await page.goto(`${server.url}/researcher/log`);
    await look("log-french", [[1280, "light"], [360, "light"]]);
    // What the refusals above did to the console is what they should.
    const errors = browser.errors.filter((error) => !/status of (403|410|422)/.test(error));
    assert.deepEqual(errors, [], "the console is clean");
    const elsewhere = browser.requests.filter((url) => !url.startsWith(server.url) && !/^(data|blob|about):/.test(url));
    assert.deepEqual(elsewhere, [], "no request leaves the study's own server");
  } finally {
    await browser.close();
    await server.stop();
  }
});

/** The answers to every clip of the demonstration study, by the interface alone. */
async function answersToDemo(server, number) {
  const post = async (path, body) => {
    const answer = await fetch(`${server.url}${path}`, { method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(body) });
    assert.ok(answer.ok, `${path}: ${answer.status} ${await answer.clone().text()}`);
    return answer.json();
  };
  const { study, clips } = await (await fetch(`${server.url}/api/studies/demo`)).json();
  const started = await post("/api/studies/demo/sessions", { nonce: String(number).repeat(32), language: "en", client: {} });
  const [block, component] = Object.entries(study.components).find(([, { type }]) => type === "trials");
  const bodies = [
    { type: "opened", client: { viewport: [1280, 900], device_pixel_ratio: 1 }, language: "en" },
    { type: "consented", version: study.consent.version, language: "en" },
  ];
  for (const [place, clip] of Object.keys(clips).entries()) {
    const step = `${block}/${clip}`;
    const answers = {};
    for (const id of component.questions) {
      const asked = study.questions.find((each) => each.id === id);
      answers[id] = asked.options?.[place % asked.options.length].value ?? 1 + ((place * number) % 5);
    }
    const log = { backend: "webgl2", onset_ms: Date.now(), frames: [[0, 0, 0]], refresh_hz: 60 };
    bodies.push({ type: "trial_started", step, clip }, { type: "trial_played", step, log }, { type: "trial_finished", step, clip, answers, rt_ms: 2000, replays: 0 });
  }
  bodies.push({ type: "finished" });
  const events = bodies.map((body, sequence) => ({ sequence, at_ms: Date.now() + sequence, body }));
  await post(`/api/sessions/${started.session}/events`, { events });
}

test("report: a point that stands for a clip leads to that clip in the preview", { skip: unable, timeout: 300_000 }, async () => {
  const server = await serve([join(root, "study-config/demo.json")]);
  const browser = await open("undrawn", { viewport: { width: 1280, height: 900 } });
  const { page } = browser;
  try {
    for (const number of [1, 2, 3, 4, 5, 6]) await answersToDemo(server, number);
    await page.goto(server.researcher());
    await page.getByLabel("E-mail").fill("ada@example.org");
    await page.getByLabel("Password").fill(password);
    await page.keyboard.press("Enter");
    await page.waitForURL("**/researcher");
    await page.goto(`${server.url}/researcher/studies/demo/report/en/report.html`);
    const points = page.locator("figure svg a.clip");
    assert.ok((await points.count()) >= 12, `${await points.count()} points lead to clips`);
    // The whole report, as a phone shows it too, in both languages.
    const shots = screenshotFolder("researcher");
    for (const [language, width, colorScheme] of [["fr", 1280, "light"], ["fr", 360, "dark"], ["en", 360, "light"], ["en", 1280, "dark"]]) {
      await page.setViewportSize({ width, height: 900 });
      await page.emulateMedia({ colorScheme });
      await page.goto(`${server.url}/researcher/studies/demo/report/${language}/report.html`);
      await page.screenshot({ path: join(shots, `report-${language}-${width}-${colorScheme}.png`), fullPage: true });
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
      assert.ok(wide <= 0, `the report scrolls sideways by ${wide} px at ${width} px`);
      assert.deepEqual(await violations(page), [], `the report, ${language}, ${width} px: axe`);
    }
    await page.setViewportSize({ width: 1280, height: 900 });

    // By the keyboard: the point says where it leads, and shows that it has the focus.
    const point = points.nth(5);
    await points.nth(4).focus();
    await page.keyboard.press("Tab");
    assert.ok(await point.evaluate((link) => link === document.activeElement && link.matches(":focus-visible")));
    const title = await point.locator("title").textContent();
    const clip = title.replace("Preview of ", "");
    assert.equal(await point.locator("circle").evaluate((dot) => getComputedStyle(dot).strokeWidth), "3px");
    await page.keyboard.press("Enter");
    await page.waitForURL(`**/preview/demo?clip=${encodeURIComponent(clip)}`);
    await page.waitForSelector("#clip-a");
    await page.waitForFunction((wanted) => document.activeElement?.id === "clip-a" && document.activeElement.value === wanted, clip, { timeout: 120_000 });
    assert.equal(await page.locator("#problem:visible").count(), 0);

    // The same with a clip beside it and a time; what the study does not have is said.
    const other = await page.locator("#clip-a option").nth(3).textContent();
    await page.goto(`${server.url}/preview/demo?clip=${clip}&beside=${other}&t=0.5`);
    await page.waitForFunction(() => document.getElementById("clock").textContent.startsWith("0.50 /"), undefined, { timeout: 120_000 });
    assert.equal(await page.locator("#clip-b").inputValue(), other);
    await page.goto(`${server.url}/preview/demo?clip=nobody`);
    await page.waitForSelector("#problem:not([hidden])");
    assert.match(await page.locator("#problem").textContent(), /^This study has no clip nobody .*choose one of the list/);
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});
