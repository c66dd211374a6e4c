// A capsule of the demonstration study: unpacked, opened from the disk without a network and from a web host; a point of a
// figure leads to a clip that is drawn again as it was seen; other rules give the numbers that `mimique analyze` gives
// natively; the study can be taken, and nothing is kept.

import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join, normalize } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { lost, violations } from "./lib/access.mjs";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { taken } from "./lib/guide_picture.mjs";
import { answer, go, leave, phase, place, settled, until } from "./lib/participant.mjs";
import { mimique, root } from "./lib/server.mjs";
import { savedBytes } from "./lib/saved.mjs";
import { unpack } from "./lib/unpack.mjs";

const unable = skip(!executable && "Chromium not found");
const PEOPLE = 24;
const study = join(root, "study-config/demo.json");

/** Answers that were simulated, with the hashes that a browser would have noted; of the first trial of p0002 another. */
function simulated(folder) {
  for (const format of ["csv", "events"]) mimique(["simulate", study, "-n", String(PEOPLE), "--seed", "3", "--format", format, "--out", folder]);
  const site = join(folder, "site");
  mimique(["export-site", study, "--out", site, "--packs", join(folder, "packs")]);
  const { clips } = JSON.parse(readFileSync(join(site, "site.json"), "utf8")).bundle;
  const events = join(folder, "demo_events.jsonl");
  const clipOf = new Map();
  let wrong = false;
  const lines = readFileSync(events, "utf8").trimEnd().split("\n").map((text) => {
    const line = JSON.parse(text);
    const { type, step, clip, log } = line.body;
    if (type === "trial_started") clipOf.set(step, clip);
    if (type === "trial_played") {
      log.weights_hash = clips[clipOf.get(step)].weights_hash;
      log.provenance = clips[clipOf.get(step)].provenance;
      if (line.participant_id === "p0002" && !wrong && step.startsWith("faces")) {
        log.weights_hash = "0".repeat(64);
        wrong = true;
      }
    }
    return JSON.stringify(line);
  });
  assert.ok(wrong, "a hash was changed");
  writeFileSync(events, `${lines.join("\n")}\n`);
  return { csv: join(folder, "demo_responses.csv"), events };
}

const types = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".json": "application/json", ".svg": "image/svg+xml", ".md": "text/plain" };

/** A web host that knows nothing but files. */
function fileHost(folder) {
  const host = createServer((request, answer) => {
    const file = join(folder, normalize(decodeURIComponent(new URL(request.url, "http://x").pathname)));
    if (!existsSync(file) || file.endsWith("/")) return answer.writeHead(404).end();
    answer.writeHead(200, { "content-type": types[extname(file)] ?? "application/octet-stream" }).end(readFileSync(file));
  });
  return new Promise((done) => host.listen(0, "127.0.0.1", () => done(host)));
}

const folder = mkdtempSync(join(tmpdir(), "mimique-capsule-"));
let capsule;

/** The capsule's folder, made once. */
function made() {
  if (capsule) return capsule;
  const { csv, events } = simulated(folder);
  const archive = join(folder, "demo.capsule.zip");
  const pages = process.env.MIMIQUE_WEB_DIR ? ["--web-dir", process.env.MIMIQUE_WEB_DIR] : [];
  const args = ["capsule", study, csv, "--events", events, "--packs", join(folder, "packs"), ...pages];
  const told = JSON.parse(mimique([...args, "--out", archive, "--json"]));
  console.log(JSON.stringify(told.parts), told.bytes);
  assert.ok(told.trials_drawn > 200 && told.late_frames > 0, JSON.stringify(told));
  unpack(archive, folder);
  capsule = join(folder, "capsule-demo");
  return capsule;
}

// axe would read the styles once more, which the pages' policy refuses.
const axes = /\.css' violates the following Content Security Policy directive: "connect-src /;

/** A browser without a network; what it asks for beyond its own place is told. */
async function offline(own) {
  const browser = await open("webgl2", { viewport: { width: 1280, height: 900 } });
  const asked = [];
  await browser.context.route("**/*", (route) => {
    const url = route.request().url();
    if (url.startsWith(own) || /^(data|blob|about):/.test(url)) return route.continue();
    asked.push(url);
    return route.abort();
  });
  if (own.startsWith("file:")) await browser.context.setOffline(true);
  return { ...browser, asked };
}

async function look(page, name, width, colorScheme) {
  await page.setViewportSize({ width, height: 900 });
  await page.emulateMedia({ colorScheme });
  await settled(page);
  await page.screenshot({ path: join(screenshotFolder("capsule"), `${name}-${width}-${colorScheme}.png`), fullPage: true });
  const sideways = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  assert.ok(sideways <= 0, `${name} scrolls sideways by ${sideways} px at ${width} px`);
  assert.deepEqual(await violations(page), [], `${name}, ${width} px: axe`);
  assert.deepEqual(await lost(page), [], `${name}, ${width} px: no room for it`);
}

/** Opens the reader and waits for its scripts. */
async function opened(page, address) {
  await page.goto(address);
  await page.waitForSelector("#capsule[data-ready=true]", { timeout: 60_000 });
}

/** Waits until a clip is drawn and held against its log. */
const drawn = (page) => page.waitForFunction(() => document.getElementById("same").textContent && document.querySelector("#stages canvas[data-clip-ms]"), undefined, { timeout: 120_000 });

/** Whether the canvas shows something else than one colour. */
const colours = (page) => page.locator("#stages canvas").first().screenshot().then(async (png) => page.evaluate(async (base64) => {
  const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
  const picture = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
  const canvas = new OffscreenCanvas(picture.width, picture.height);
  const context = canvas.getContext("2d");
  context.drawImage(picture, 0, 0);
  const { data } = context.getImageData(0, 0, picture.width, picture.height);
  const seen = new Set();
  for (let at = 0; at < data.length; at += 4) seen.add((data[at] >> 4) * 256 + (data[at + 1] >> 4) * 16 + (data[at + 2] >> 4));
  return seen.size;
}, png.toString("base64")));

/** The first point of a figure that leads to a clip is clicked; the clip it names. */
async function clickPoint(page) {
  const frame = page.frameLocator("#report");
  const point = frame.locator("svg a[href*='clip=']").first();
  const href = await point.getAttribute("href", { timeout: 30_000 });
  await point.evaluate((link) => {
    for (let around = link.parentElement; around; around = around.parentElement) if (around.localName === "details") around.open = true;
  });
  await point.click();
  return new URL(href, "http://x/").searchParams.get("clip");
}

/** The same text, its unrounded numbers the same to 12 digits: the mathematical functions of a browser's module and of the
    machine's own library differ in the last bit. Digits of a hash can read as a number that is infinite. */
function alike(found, expected) {
  const number = /-?\d+(?:\.\d+)?(?:e[-+]?\d+)?/g;
  assert.equal(found.replace(number, "#"), expected.replace(number, "#"));
  const [numbers, others] = [found, expected].map((text) => text.match(number).map(Number));
  numbers.forEach((one, k) => assert.ok(one === others[k] || Math.abs(one - others[k]) <= 1e-12 * Math.max(Math.abs(one), Math.abs(others[k])), `${one} here, ${others[k]} natively`));
}

/** A text that a link of the page saves. */
async function saved(page, name) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("link", { name }).click()]);
  return String(await savedBytes(download));
}

test("capsule: from the disk, without a network", { skip: unable, timeout: 600_000 }, async () => {
  const place = made();
  const own = pathToFileURL(place).href;
  const browser = await offline(own);
  const { page } = browser;
  try {
    await opened(page, `${own}/index.html?backend=webgl2`);
    // The report stands there, and its points lead to clips.
    await page.frameLocator("#report").getByRole("heading", { level: 1 }).waitFor();
    const clip = await clickPoint(page);
    await drawn(page);
    assert.equal(await page.locator("#clip").inputValue(), clip);
    assert.match(await page.locator("#drawn").textContent(), new RegExp(`^p\\d+, trial \\d+: ${clip}, as it was seen$`));
    assert.match(await page.locator("#same").textContent(), /the weights are those that were shown then/);
    assert.ok((await colours(page)) > 20, "a face is drawn");

    // A trial with late frames: they are said, and drawn late.
    const plays = JSON.parse(await page.evaluate(() => capsule.body("plays/p0001.json")));
    const [step, { plays: [{ frames, late }] }] = Object.entries(plays.pages).find(([name, page]) => name.startsWith("faces") && page.plays[0].late > 0);
    await page.selectOption("#clip", "");
    await page.selectOption("#person", "p0001");
    const order = await page.evaluate(async (wanted) => (await capsule.json("trials.json")).trials.find((trial) => trial.participant === "p0001" && trial.step === wanted).order, step);
    await page.getByRole("button", { name: new RegExp(`^Draw trial ${order} of p0001:`) }).click();
    await drawn(page);
    await until("the strip is that of the log", async () => new RegExp(`^${frames.length} frames in .*, ${late} late`).test((await page.locator("#strip svg").getAttribute("aria-label")) ?? ""), 30_000);
    assert.equal((await page.locator("#strip path.late").getAttribute("d")).split("M").length - 1, late);
    const at = frames.findIndex((frame) => frame[2]);
    await page.locator("#late button").first().click();
    await until("the late frame is drawn", async () => Number(await page.locator("#stages canvas").getAttribute("data-clip-ms")) === frames[at][1], 5000);
    await page.setViewportSize({ width: 1000, height: 900 });
    await page.locator("#drawn").evaluate((heading) => heading.scrollIntoView({ block: "start" }));
    await settled(page);
    await taken(page, "capsule-reader.jpg");
    await look(page, "reader", 1280, "light");
    await look(page, "reader", 360, "dark");
    await page.setViewportSize({ width: 1280, height: 900 });

    // Weights that are not those of the log are said to differ.
    await page.selectOption("#person", "p0002");
    await page.getByRole("button", { name: /^Draw trial 1 of p0002:/ }).click();
    await page.waitForFunction(() => /differ/.test(document.getElementById("same").textContent), undefined, { timeout: 120_000 });
    assert.match(await page.locator("#same").textContent(), /the weights differ, 0{12} then/);

    // Without a change the numbers are those that were published.
    await page.getByRole("button", { name: "Compute" }).click();
    await page.locator("#computing", { hasText: "Computed in this browser." }).waitFor({ timeout: 120_000 });
    const published = readFileSync(join(place, "report/results.json"), "utf8");
    alike(await saved(page, "results-changed.json"), published);
    const shown = () => page.evaluate(() => document.getElementById("report").srcdoc);
    assert.equal(await shown(), readFileSync(join(place, "report/report.html"), "utf8"), "the report, byte for byte");

    // Another rule and another test: the numbers are those that the program gives natively for the same file.
    await page.fill("[data-rule=lateFrameShare]", "0.01");
    await page.fill("[data-rule=straightLining]", "3");
    await page.selectOption("[data-hypothesis=H3]", "mann-whitney");
    await page.getByRole("button", { name: "Compute" }).click();
    await page.locator("#compared table").waitFor({ timeout: 120_000 });
    const results = await saved(page, "results-changed.json");
    assert.notEqual(results, published);
    const file = join(folder, "changed.json");
    writeFileSync(file, await saved(page, "study-changed.json"));
    const changed = JSON.parse(readFileSync(file, "utf8"));
    assert.deepEqual([changed.exclusions.lateFrameShare, changed.exclusions.straightLining.longestRun, changed.hypotheses[2].test], [0.01, 3, "mann-whitney"]);
    const out = join(folder, "native");
    const preview = "http://127.0.0.1/preview/demo";
    mimique(["analyze", join(place, "data/responses.csv"), "--study", file, "--stimuli", join(place, "data/stimuli.csv"), "--preview-url", preview, "--versions", place, "--out", out]);
    alike(results, readFileSync(join(out, "results.json"), "utf8"));
    const native = readFileSync(join(out, "report.html"), "utf8").replaceAll(preview, "../index.html");
    assert.equal(await shown(), native, "the report, byte for byte");
    assert.match(await page.locator("#compared p").first().textContent(), /trials are used; as published/);
    await look(page, "changed", 1280, "dark");
    await page.getByRole("button", { name: "As published" }).click();
    assert.equal(await page.inputValue("[data-rule=lateFrameShare]"), "");

    assert.match(await page.locator("#formats pre").textContent(), /\| `frames_late` \| integer \|/);
    assert.deepEqual(browser.asked, [], "nothing outside the folder was asked for");
    assert.deepEqual(browser.errors.filter((text) => !axes.test(text)), [], "the console is clean");
  } finally {
    await browser.close();
  }
});

/** Takes the study's first trials; nothing is kept of them. */
async function takesPart(browser, own) {
  const { page } = browser;
  await page.goto(`${own}/take-part.html?backend=webgl2`);
  await page.waitForSelector("main[data-view=consent]", { timeout: 60_000 });
  assert.match(await page.locator("#stays").textContent(), /Nothing that you answer here is kept or sent/);
  await look(page, "take-part", 360, "light");
  await page.setViewportSize({ width: 1280, height: 900 });
  let here = await place(page);
  for (let trials = 0; trials < 2; ) {
    if (here.view === "trial") {
      await phase(page, "ready", 120_000);
      await go(page, "mouse");
      await phase(page, "answering", 120_000);
      if (trials === 0) await look(page, "trial", 1280, "light");
      trials += 1;
    }
    if (here.view === "trial" || here.view === "questions") await answer(page, "mouse", here.step);
    await go(page, "mouse");
    here = await leave(page, here, 60_000);
  }
  assert.ok(await page.locator("#stays").isVisible());
  // Opened again it begins anew: nothing was kept.
  await page.reload();
  await page.waitForSelector("main[data-view=consent]", { timeout: 60_000 });
  const kept = await browser.context.storageState({ indexedDB: true }).catch(() => ({ origins: [] }));
  assert.deepEqual(kept.origins, []);
}

test("capsule: the study is taken from the disk, and nothing is kept", { skip: unable, timeout: 600_000 }, async () => {
  const own = pathToFileURL(made()).href;
  const browser = await offline(own);
  try {
    await takesPart(browser, own);
    assert.deepEqual(browser.asked, []);
    assert.deepEqual(browser.errors.filter((text) => !axes.test(text)), [], "the console is clean");
  } finally {
    await browser.close();
  }
});

test("capsule: the same from a web host", { skip: unable, timeout: 600_000 }, async () => {
  const host = await fileHost(made());
  const own = `http://127.0.0.1:${host.address().port}`;
  const browser = await offline(own);
  const { page } = browser;
  try {
    await opened(page, `${own}/index.html?backend=webgl2`);
    const clip = await clickPoint(page);
    await drawn(page);
    assert.equal(await page.locator("#clip").inputValue(), clip);
    assert.match(await page.locator("#same").textContent(), /the weights are those that were shown then/);
    await page.fill("[data-rule=lateFrameShare]", "0.01");
    await page.getByRole("button", { name: "Compute" }).click();
    await page.locator("#compared table").waitFor({ timeout: 120_000 });
    // From the report's own page, too.
    await page.goto(`${own}/report/report.html`);
    const point = page.locator("svg a[href*='clip=']").first();
    assert.match(await point.getAttribute("href"), /^\.\.\/index\.html\?clip=/);
    await takesPart(browser, own);
    assert.deepEqual(browser.asked, []);
    assert.deepEqual(browser.errors.filter((text) => !axes.test(text)), [], "the console is clean");
  } finally {
    await browser.close();
    host.closeAllConnections();
    host.close();
  }
});
