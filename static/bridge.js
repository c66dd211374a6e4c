// The border between the participant's pages (app.js, wasm) and the stage. The stage and the solver
// are loaded when the first clip is asked for, so that the first page comes without them.

let host;
const stageHost = () => (host ??= import("./stage-host.js"));

const held = new Set();

/** Takes a lock for as long as this page lives. False if another tab of this browser has it. */
export async function holdSession(name) {
  // Plain HTTP on another machine has no locks.
  if (!navigator.locks || held.has(name)) return true;
  return new Promise((answer) => {
    navigator.locks.request(`mimique/${name}`, { ifAvailable: true }, (lock) => {
      if (lock !== null) held.add(name);
      answer(lock !== null);
      return lock === null ? undefined : new Promise(() => {});
    });
  });
}

/** Browser, its major version and platform class: nothing finer. */
export function about() {
  const agent = navigator.userAgent;
  const families = [["Edge", /Edg\/(\d+)/], ["Opera", /OPR\/(\d+)/], ["Firefox", /Firefox\/(\d+)/], ["Chrome", /Chrome\/(\d+)/], ["Safari", /Version\/(\d+).*Safari/]];
  const [browser, pattern] = families.find(([, each]) => each.test(agent)) ?? ["other", /(?!)/];
  const version = pattern.exec(agent)?.[1] ?? "";
  const platforms = [["Android", /Android/], ["iOS", /iPhone|iPad/], ["Windows", /Windows/], ["macOS", /Mac OS/], ["ChromeOS", /CrOS/], ["Linux", /Linux/]];
  const platform = platforms.find(([, each]) => each.test(agent))?.[0] ?? "other";
  return JSON.stringify({ browser, version, platform });
}

/** Fetches packs and solves. Resolves with the solved clip's facts as JSON. */
export async function prepareClip(clip, source, progress) {
  const { prepareClip } = await stageHost();
  return JSON.stringify(await prepareClip(clip, JSON.parse(source), progress));
}

let canvasNow = null;
let lookNow = null;
let opening = null;

/** Puts the stage on a canvas; it opens when a clip is first shown there. */
export function attachStage(canvas, look) {
  detachStage();
  canvasNow = canvas;
  lookNow = JSON.parse(look);
}

/** Takes the stage off its canvas. */
export function detachStage() {
  const old = opening;
  opening = null;
  canvasNow = null;
  old?.then((stage) => stage.close(), () => {});
}

async function stage() {
  if (!canvasNow) throw new Error("there is no canvas on this page");
  if (!opening) {
    const canvas = canvasNow;
    const mine = stageHost().then(({ openStage }) => openStage(canvas, lookNow));
    opening = mine;
    // A stage that could not open is tried anew at the next call.
    mine.catch(() => {
      if (opening === mine) opening = null;
    });
  }
  return opening;
}

/** Shows the first frame of a clip, before it is played. */
export async function showClip(clip) {
  await (await stage()).show(clip, 0);
}

/** Plays a clip once. Resolves with the log as JSON, its times as `study::PlayLog` has them. */
export async function playClip(clip) {
  return JSON.stringify(onPageClock(await (await stage()).play(clip)));
}

// The stage's times are requestAnimationFrame's: ms since the page was opened. Onset and end become
// ms since 1970, as every event has them; frames become ms after the onset.
function onPageClock({ onset_ms: onset, end_ms: end, frames, ...log }) {
  const since1970 = (ms) => (ms === null ? 0 : thousandth(performance.timeOrigin + ms));
  return {
    ...log,
    onset_ms: since1970(onset),
    end_ms: since1970(end),
    longest_ms: thousandth(log.longest_ms),
    frames: frames.map(([shown, clip, late]) => [thousandth(shown - onset), thousandth(clip), late]),
  };
}

// Microseconds: browsers tell no finer.
function thousandth(ms) {
  return Math.round(ms * 1000) / 1000;
}

/** Aborts the play in progress. */
export function stopClip() {
  opening?.then((stage) => stage.stop(), () => {});
}
