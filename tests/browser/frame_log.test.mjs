// The log of a play, by a display of the test's own: `static/stage/playback.js` without a browser. The
// onset is the first frame that went to the display, the clip's time is the display's since then, and a
// frame is late that began more than 1.5 refresh periods after the one before.

import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";

let asked = [];
let hidden;
let clock = 0;
globalThis.performance = { now: () => clock };
globalThis.requestAnimationFrame = (call) => asked.push(call);
globalThis.cancelAnimationFrame = () => (asked = []);
globalThis.document = {
  hidden: false,
  addEventListener: (_, call) => (hidden = call),
  removeEventListener: () => (hidden = undefined),
};
const { Playback } = await import("../../static/stage/playback.js");
const { refreshPeriod } = await import("../../static/stage/clock.js");

/** What waits on promises goes on. */
const settle = () => new Promise(setImmediate);

/** The display begins a frame. */
async function frame(now) {
  clock = now;
  const calls = asked;
  asked = [];
  for (const call of calls) call(now);
  await settle();
}

let now = 5000;
beforeEach(async () => {
  asked = [];
  globalThis.document.hidden = false;
  // A display of 50 Hz, as found by 24 intervals of which a few are long.
  const period = refreshPeriod(true);
  for (let i = 0; i <= 24; i++) await frame((now += i % 9 === 4 ? 60 : 20));
  assert.equal(await period, 20);
  clock = 0;
});

/** Plays `durationMs` by frames at these times; the clip times drawn and the log. */
async function played(times, durationMs, draw = () => true) {
  clock = 0;
  const drawn = [];
  const play = new Playback([{ draw: (ms) => (drawn.push(ms), draw(drawn.length)) }]);
  const log = play.run(durationMs);
  await settle();
  for (const time of times) await frame(time);
  return { drawn, log: await log };
}

test("frame log: clip time is the display's since the onset", async () => {
  const { drawn, log } = await played([9000.5, 9020.5, 9040.5, 9060.5, 9080.5, 9100.5], 90);
  assert.deepEqual(drawn, [0, 20, 40, 60, 80, 90], "the end is held, not passed");
  assert.deepEqual(log.frames, drawn.map((ms, k) => [9000.5 + 20 * k, ms, 0]));
  assert.deepEqual([log.onset_ms, log.end_ms, log.refresh_hz], [9000.5, 9100.5, 50]);
  assert.deepEqual([log.late, log.longest_ms, log.drift_ms, log.aborted], [0, 20, 0, null]);
});

test("frame log: a frame is late beyond one and a half periods", async () => {
  const { log } = await played([1000, 1030, 1060.1, 1080, 1140], 120);
  assert.deepEqual(log.frames.map(([, , late]) => late), [0, 0, 1, 0, 1]);
  assert.deepEqual(log.frames.map(([, ms]) => ms), [0, 30, 1060.1 - 1000, 80, 120], "what is late is not caught up with");
  assert.deepEqual([log.late, log.longest_ms], [2, 60]);
});

test("frame log: the onset is the first frame that the display was given", async () => {
  // The adapter is busy with the first two, and once later.
  const { drawn, log } = await played([100, 120, 140, 160, 180, 200], 60, (count) => ![1, 2, 4].includes(count));
  assert.equal(log.onset_ms, 140);
  assert.deepEqual(drawn, [0, 0, 0, 20, 40, 60]);
  assert.deepEqual(log.frames, [[140, 0, 0], [180, 40, 1], [200, 60, 0]]);
});

test("frame log: a frame that the display began before the play is not the onset", async () => {
  const play = new Playback([{ draw: () => true }]);
  clock = 500;
  const log = play.run(40);
  await settle();
  // The page was busy while the display began these.
  for (const time of [100, 499, 510, 530, 550]) await frame(time);
  assert.deepEqual((await log).frames, [[510, 0, 0], [530, 20, 0], [550, 40, 0]]);
});

test("frame log: a busy adapter gets the last frame later, but is not waited for long", async () => {
  const later = await played([0, 20, 40, 60, 80], 40, (count) => ![3, 4].includes(count));
  assert.deepEqual(later.drawn, [0, 20, 40, 40, 40]);
  assert.deepEqual(later.log.frames, [[0, 0, 0], [20, 20, 0], [80, 40, 1]]);
  assert.equal(later.log.end_ms, 80);
  const never = await played([0, 20, 40, 539, 540], 40, (count) => count < 3);
  assert.deepEqual([never.log.frames.length, never.log.end_ms], [2, 540]);
});

test("frame log: a play that shows nothing for ten seconds is lost, before its first frame and after", async () => {
  for (const busyFrom of [0, 2]) {
    clock = 0;
    const play = new Playback([{ draw: (ms) => ms < busyFrom }]);
    const log = play.run(1000);
    await settle();
    for (const time of [0, 20, 40]) await frame(time);
    clock = 11_000;
    const { aborted, failure, frames } = await log;
    assert.deepEqual([aborted, failure], ["renderer lost: no frame for 10 s", "no frame for 10 s"]);
    assert.equal(frames.length, busyFrom === 0 ? 0 : 1);
  }
});

test("frame log: a hidden page ends the play, and what was shown stays", async () => {
  const play = new Playback([{ draw: () => true }]);
  const log = play.run(1000);
  await settle();
  for (const time of [10, 30]) await frame(time);
  globalThis.document.hidden = true;
  hidden();
  assert.deepEqual(await log, {
    onset_ms: 10,
    end_ms: 30,
    refresh_hz: 50,
    frames: [[10, 0, 0], [30, 20, 0]],
    late: 0,
    longest_ms: 20,
    drift_ms: 0,
    aborted: "page hidden",
    failure: null,
  });
  await frame(50);
  assert.equal(asked.length, 0, "nothing is drawn any more");
});

test("frame log: two in step are one frame when both are drawn", async () => {
  const drawn = [[], []];
  // The second adapter is busy in every other frame.
  let turn = 0;
  const parts = [
    { draw: (ms) => drawn[0].push(ms) > 0 },
    { draw: (ms) => turn++ % 2 === 1 && drawn[1].push(ms) > 0 },
  ];
  const log = new Playback(parts).run(40);
  await settle();
  for (const time of [0, 20, 40, 60]) await frame(time);
  const { frames, drift_ms, onset_ms } = await log;
  assert.equal(onset_ms, 20, "when both are there");
  assert.deepEqual(drawn, [[0, 20], [0, 40]]);
  assert.deepEqual(frames, [[20, 0, 0], [60, 40, 1]]);
  assert.equal(drift_ms, 20, "the one drawn first waits for the other");
});
