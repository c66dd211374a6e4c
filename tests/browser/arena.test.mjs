// An arena: a person votes in its study, the vote is pooled by its hashes; the ranking's page for everybody (axe, 360 px,
// dark), and the picture of docs/guide/arena.md, made by the page's own commands. MIMIQUE_UPDATE_GOLDEN=1 writes the picture
// anew; look at it before you keep it.

import assert from "node:assert/strict";
import { cpSync, mkdirSync, mkdtempSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { violations } from "./lib/access.mjs";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { answer, go, phase, settled, through } from "./lib/participant.mjs";
import { mimique, root, serve } from "./lib/server.mjs";

const unable = skip(!executable && "Chromium not found");
const picture = join(root, "docs/guide/pictures/arena-ranking.jpg");
const MOST_BYTES = 150_000;

/** The words of a command, in quotes or not. */
const words = (line) => [...line.matchAll(/"([^"]*)"|(\S+)/g)].map(([, quoted, plain]) => quoted ?? plain);

/** A folder in which the page's commands were run, those of `wanted`. */
function guideFolder(wanted) {
  const folder = mkdtempSync(join(tmpdir(), "mimique-arena-"));
  mkdirSync(join(folder, "docs/guide"), { recursive: true });
  cpSync(join(root, "docs/guide/data/arena"), join(folder, "docs/guide/data/arena"), { recursive: true });
  const page = readFileSync(join(root, "docs/guide/arena.md"), "utf8");
  const commands = [...page.matchAll(/^\$ mimique (.*)\n(\? 2)?/gm)].filter(([, , refused]) => !refused).map(([, command]) => command);
  for (const command of commands.filter(wanted)) mimique(words(command), { cwd: folder });
  return folder;
}

test("arena: the page of a ranking, and the guide's picture of it", { skip: unable, timeout: 400_000 }, async () => {
  const folder = guideFolder((command) => !command.startsWith("check"));
  const browser = await open("webgl2", { viewport: { width: 1280, height: 900 } });
  const { page } = browser;
  const shots = screenshotFolder("arena");
  try {
    await page.goto(pathToFileURL(join(folder, "ranking/report.html")).href);
    for (const [width, colorScheme] of [[1280, "light"], [360, "light"], [1280, "dark"], [360, "dark"]]) {
      await page.setViewportSize({ width, height: 900 });
      await page.emulateMedia({ colorScheme });
      await page.screenshot({ path: join(shots, `ranking-${width}-${colorScheme}.png`), fullPage: true });
      const sideways = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
      assert.ok(sideways <= 0, `${width} px: it scrolls sideways by ${sideways} px`);
      assert.deepEqual(await violations(page), [], `${width} px, ${colorScheme}: axe`);
      assert.equal(await page.locator("h1:visible").count(), 1);
    }
    await page.emulateMedia({ colorScheme: "light" });
    await page.setViewportSize({ width: 1000, height: 900 });
    const update = process.env.MIMIQUE_UPDATE_GOLDEN === "1";
    await page.screenshot({ path: update ? picture : join(shots, "arena-ranking.jpg"), type: "jpeg", quality: 80 });
    assert.ok(statSync(picture).size < MOST_BYTES, `${statSync(picture).size} bytes`);
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
  }
});

test("arena: a person's votes are pooled by the hashes of what was shown", { skip: unable, timeout: 400_000 }, async () => {
  const folder = guideFolder((command) => /^(sample|solve|segment) /.test(command) && !command.includes("box"));
  // Two methods, half a second: so that taking part is quick.
  writeFileSync(join(folder, "short.csv"), "label,first_frame,last_frame\njoy,300,399\nfear,1200,1299\n");
  const run = (line) => mimique(words(line), { cwd: folder });
  run("arena new short --avatar sample/head.glb --capture sample/take.c3d --segments short.csv --reference sample/weights.csv --shown 50 --per-participant 2");
  run("arena submit short --method lsts --weights lsts.csv --author A --licence CC0-1.0");
  run("arena study short --out study");
  const server = await serve([join(folder, "study/study.json")]);
  const browser = await open("undrawn", { viewport: { width: 412, height: 900 } });
  const { page } = browser;
  const shots = screenshotFolder("arena");
  try {
    const trials = await through(page, `${server.url}/s/short/?backend=webgl2`, async (here, trials) => {
      await go(page, "keyboard");
      await phase(page, "answering", 120_000);
      await settled(page);
      if (trials === 1) await page.screenshot({ path: join(shots, "trial.png") });
      await answer(page, "keyboard", here.step);
    }, { questions: true });
    assert.ok(trials >= 1, "there are pairs");
    assert.deepEqual(browser.errors, [], "the console is clean");
    const out = join(folder, "answers.csv");
    mimique(["export", "--database", server.database, "--format", "csv", "--out", out]);
    const rows = parse(readFileSync(out, "utf8")).filter((row) => row.response_id === "better");
    assert.equal(rows.length, trials);
    assert.ok(rows.every((row) => row.provenance.length === 64 && row.beside_provenance.length === 64));
    run("arena merge short here=answers.csv --out votes");
    const { laboratories: [own] } = JSON.parse(readFileSync(join(folder, "votes/pooled.json"), "utf8"));
    const others = own.leftOut.filter(({ reason }) => reason === "stimulus" || reason === "no-hash");
    assert.deepEqual(others, [], "what the browser drew is the arena's");
    const late = own.leftOut.reduce((sum, { votes }) => sum + votes, 0);
    assert.equal(own.votes + late, trials);
  } finally {
    await browser.close();
    await server.stop();
  }
});
