// Two clips in step: a drawn clip beside the actor's own head, and beside a video; screenshots kept.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { recordVideo } from "./lib/record_video.mjs";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { answer, go, leave, phase, place } from "./lib/participant.mjs";
import { mimique, serve } from "./lib/server.mjs";
import { SMALL_LOOK, small, stimuli, text, trials } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");

const pair = (avatar, side) => ({
  ...trials(["joy2.box.head"], ["nearer"]),
  beside: { avatar, method: "real", side, caption: text("The person"), clipCaption: text("The animated face") },
});
const study = (video) => small("pairs", {
  questions: [{ id: "nearer", type: "comparison", prompt: text("Which is more natural?"), allowSame: true }],
  components: {
    heads: pair("actor", "right"),
    videos: pair("person", "left"),
    turns: { type: "pairs", compare: "avatar", levels: ["actor", "person"], within: ["segment"], show: "inTurn", question: "nearer" },
  },
  sequence: { order: "fixed", components: ["heads", "videos", "turns"] },
  stimuli: {
    ...stimuli(
      {
        head: { builtin: { seed: 1 } },
        actor: { builtin: { actor: 7 }, look: "reference" },
        person: { videos: { joy2: video } },
      },
      { box: { method: "box" }, real: { method: "recorded" } },
      [["head", "box"], ["actor", "real"], ["person", "real"]],
    ),
    look: SMALL_LOOK,
  },
});

for (const [backend, width] of [["webgl2", 1280], ["webgpu", 412]]) {
  test(`pairs: in step beside a head and beside a video, ${backend}`, { skip: unable, timeout: 400_000 }, async () => {
    const folder = mkdtempSync(join(tmpdir(), "mimique-pairs-"));
    const browser = await open(backend, { viewport: { width, height: 900 } });
    const shots = screenshotFolder(`pairs-${backend}`);
    const { page } = browser;
    let server;
    try {
      const video = await recordVideo(page);
      assert.ok(video.durationMs > 1000 && video.durationMs < 2500, `a video of ${video.durationMs} ms`);
      writeFileSync(join(folder, "joy2.webm"), video.bytes);
      writeFileSync(join(folder, "pairs.json"), JSON.stringify(study("joy2.webm")));
      server = await serve([join(folder, "pairs.json")]);
      await page.goto(`${server.url}/s/pairs/?backend=${backend}`);
      await page.waitForSelector("main[data-view]", { timeout: 30_000 });
      let here = await place(page);
      let trials = 0;
      while (here.view !== "end") {
        if (here.view === "trial") {
          trials += 1;
          await phase(page, "ready", 120_000);
          assert.equal(await page.locator(".stage-frame.pair figure").count(), 2);
          const captions = trials < 3 ? ["The animated face", "The person"] : [];
          assert.deepEqual((await page.locator("figcaption").allTextContents()).sort(), captions);
          const sideways = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
          assert.ok(sideways <= 0, `scrolls sideways by ${sideways} px`);
          const companionFirst = await page.evaluate(() => {
            const at = (selector) => document.querySelector(selector).getBoundingClientRect();
            const [beside, own] = [at("figure[data-beside]"), at("figure:not([data-beside])")];
            return beside.left < own.left || beside.top < own.top;
          });
          if (trials < 3) assert.equal(companionFirst, trials === 2, "the side is the study's");
          await page.screenshot({ path: join(shots, `${trials}-ready.png`), fullPage: true });
          await go(page, "mouse");
          await phase(page, "playing");
          await page.waitForTimeout(1500);
          await page.locator(".stage-frame").screenshot({ path: join(shots, `${trials}-playing.png`) });
          await phase(page, "answering", 120_000);
        }
        if (here.view === "receipt") {
          here = await leave(page, here, 60_000);
          continue;
        }
        if (here.view === "trial") await answer(page, "mouse", here.step);
        await go(page, "mouse");
        here = await leave(page, here, 60_000);
      }
      assert.equal(trials, 3);
      assert.deepEqual(browser.errors, [], "the console is clean");
      const rows = parse(mimique(["export", "--database", server.database, "--format", "csv"])).filter((row) => row.trial_type === "trial");
      const inTurn = rows.pop();
      assert.deepEqual([inTurn.item_left, inTurn.item_right].sort(), ["actor", "person"]);
      // The drawn face lasts 4 s.
      const played = 4000 + video.durationMs;
      assert.ok(Number(inTurn.rt) > played - 200, `both were played whole before the answer: ${played} of ${inTurn.rt} ms`);
      assert.deepEqual(rows.map((row) => [row.beside, row.beside_side]), [["joy2.real.actor", "right"], ["joy2.real.person", "left"]]);
      for (const row of rows) {
        assert.ok(Number(row.frames) >= 2, `${row.frames} frames`);
        assert.match(row.beside_provenance, /^[0-9a-f]{64}$/);
        const side = row.answer === "same" ? "" : row.answer === row.beside_side ? row.beside : row.stimulus;
        assert.equal(row.chosen, side);
      }
      const [drift, longest] = [Number(rows[0].beside_drift_ms), Number(rows[0].frame_longest_ms)];
      assert.ok(drift <= longest, `two drawn clips ${drift} ms apart, with frames of at most ${longest} ms`);
      // The face is drawn with the display's frames, the video comes with its own: 40 ms each.
      const [besideVideo, display] = [Number(rows[1].beside_drift_ms), Number(rows[1].frame_longest_ms)];
      assert.ok(besideVideo < Math.max(40, display), `face and video ${besideVideo} ms apart, with frames of at most ${display} ms`);
    } finally {
      await browser.close();
      await server?.stop();
    }
  });
}
