// A study in a frame of another origin's page: the page that is named embeds it and hears height, views and the end, nothing
// else; another may not; without the option nobody may.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { taken } from "./lib/guide_picture.mjs";
import { answer, go, leave, place, until } from "./lib/participant.mjs";
import { serve } from "./lib/server.mjs";
import { small, stimuli, text } from "./lib/small_study.mjs";

const noBrowser = skip(!executable && "Chromium not found");

/** A page with the study in a frame, that stores what it hears. */
async function survey(address, host = "127.0.0.1") {
  const page = () => `<!doctype html><html lang="en"><title>Survey</title>
    <style>body { font: 16px sans-serif; max-width: 860px; margin: 16px auto; background: #eef1f6 } label { margin-right: 24px }</style>
    <h1>Survey of a laboratory</h1>
    <p><strong>7.</strong> Have you seen animated faces before? <label><input type="radio"> Yes</label> <label><input type="radio"> No</label></p>
    <p><strong>8.</strong> Now watch the face, and say what you think of it.</p>
    <iframe id="faces" title="Faces" src="${address}" style="width: 100%; height: 300px; border: 0" allow="autoplay; fullscreen"></iframe>
    <script>
      window.heard = [];
      addEventListener("message", ({ origin, data }) => {
        heard.push({ origin, ...data });
        if (data.event === "height") document.getElementById("faces").style.height = data.height + "px";
      });
    </script>`;
  const server = createServer((_, response) => response.writeHead(200, { "content-type": "text/html" }).end(page()));
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  const close = () => {
    server.closeAllConnections();
    return new Promise((done) => server.close(done));
  };
  return { origin: `http://${host}:${server.address().port}`, show: (other) => (address = other), close };
}

/** The parts of a study of one clip. */
const faces = {
  demographics: { title: text("You"), questions: [{ id: "age", type: "number", prompt: text("Age?"), minimum: 0, maximum: 120 }] },
  stimuli: stimuli({ head: { builtin: { seed: 1 } } }, { lsts: { method: "lsts" } }, [["head", "lsts"]]),
  questions: [{ id: "believable", type: "likert", prompt: text("Believable?"), numItems: 5, leftLabel: text("no"), rightLabel: text("yes") }],
  components: { faces: { type: "trials", questions: ["believable"] } },
  sequence: { order: "fixed", components: ["faces"] },
};

/** A study file of these parts. */
function file(id, parts) {
  const path = join(mkdtempSync(join(tmpdir(), "mimique-")), `${id}.json`);
  writeFileSync(path, JSON.stringify(small(id, parts)));
  return path;
}

test("embedding: a study in a frame of a page that is named, and of no other", { skip: noBrowser, timeout: 240_000 }, async () => {
  // The survey's origin is known before the server starts; what it shows is told by its address.
  const named = await survey("about:blank");
  const server = await serve([file("framed", faces)], { more: ["--allow-embedding", named.origin] });
  const other = await survey(`${server.url}/s/framed/`);
  const browser = await open("webgl2", { viewport: { width: 900, height: 900 } });
  const { page } = browser;
  const shots = screenshotFolder("embedding");
  try {
    named.show(`${server.url}/s/framed/`);
    await page.goto(named.origin);
    const frame = page.frames().find((each) => each.url().includes("/s/framed/")) ?? (await page.waitForEvent("frameattached"));
    await frame.waitForSelector("main[data-view]", { timeout: 60_000 });
    const keyboardless = Object.assign(frame, { keyboard: page.keyboard });
    for (let here = await place(keyboardless), steps = 0; here.view !== "end"; steps++) {
      assert.ok(steps < 20, JSON.stringify(here));
      if (here.view === "trial") {
        await page.screenshot({ path: join(shots, "trial.png") });
        const { height } = await page.locator("iframe").boundingBox();
        assert.ok(height >= 760, `${height}`);
        await frame.waitForFunction(() => document.querySelector("main").dataset.phase === "ready", null, { timeout: 90_000 });
        await taken(page, "embedding-survey.jpg");
        await go(keyboardless, "mouse");
        await frame.waitForSelector("fieldset[data-question]", { timeout: 90_000 });
      }
      for (const box of await frame.locator("input[type=checkbox]").all()) if (!(await box.isChecked())) await box.check();
      await answer(keyboardless, "mouse", here.step);
      // The receipt comes by itself.
      if (here.view !== "receipt") await go(keyboardless, "mouse");
      here = await leave(keyboardless, here);
    }
    const heard = await page.evaluate(() => globalThis.heard);
    assert.ok(heard.every(({ origin, source, study }) => origin === server.url && source === "mimique" && study === "framed"), JSON.stringify(heard));
    const of = (event) => heard.filter((each) => each.event === event);
    assert.ok(of("view").some(({ view }) => view === "trial") && of("height").length > 1, JSON.stringify(heard));
    assert.deepEqual(of("ended").map(({ outcome }) => outcome), ["completed"]);
    // Events and nothing else.
    const known = ["origin", "source", "study", "event", "height", "view", "outcome"];
    assert.ok(heard.every((each) => Object.keys(each).every((key) => known.includes(key))), JSON.stringify(heard));

    // A page that is not named sees nothing of the study.
    await page.goto(other.origin);
    const shown = () => page.frames().filter((each) => each !== page.mainFrame());
    // The browser puts a page of its own in the place of the one that it refuses.
    await until("the frame is refused", () => shown().length === 1 && shown()[0].url().startsWith("chrome-error:"), 30_000);
    assert.deepEqual(await page.evaluate(() => globalThis.heard), []);
    for (const each of shown()) assert.equal(await each.locator("main[data-view]").count().catch(() => 0), 0);
  } finally {
    await browser.close();
    await Promise.all([named.close(), other.close(), server.stop()]);
  }
});

test("embedding: a page of another site hears how it ended, whatever the end", { skip: noBrowser, timeout: 240_000 }, async () => {
  const files = [
    file("open", faces),
    file("closed", { ...faces, recruitment: { closes: "2020-01-01T00:00:00Z" } }),
  ];
  const page = await survey("about:blank", "localhost");
  const [server, browser] = await Promise.all([serve(files, { more: ["--allow-embedding", page.origin] }), open("undrawn")]);
  const outcomes = () => browser.page.evaluate(() => globalThis.heard.filter(({ event }) => event === "ended").map(({ outcome }) => outcome));
  const hears = (...wanted) => until(`it hears ${wanted}`, async () => (await outcomes()).join() === wanted.join(), 60_000);
  try {
    page.show(`${server.url}/s/open/`);
    await browser.page.goto(page.origin);
    const frame = browser.page.frameLocator("#faces");
    const press = (action) => frame.locator(`[data-action=${action}]`).click();
    await press("decline");
    await hears("declined");
    // Whoever has pressed the wrong button goes back, and the last outcome counts.
    await press("back-to-consent");
    await frame.locator("main[data-view=consent] button.primary:not([disabled])").click();
    await frame.locator("main[data-view=questions]").waitFor();
    await press("withdraw");
    await press("withdraw-confirm");
    await hears("declined", "withdrawn");
    page.show(`${server.url}/s/closed/`);
    await browser.page.reload();
    await hears("study_closed");
  } finally {
    await browser.close();
    await Promise.all([page.close(), server.stop()]);
  }
});
