// The border between the participant's pages (app.js, wasm) and the stage. The stage and the solver
// are loaded when the first clip is asked for, so that the first page comes without them.

let host;
const stageHost = () => (host ??= import("./stage-host.js"));

/** Takes a lock for as long as this page lives. False if another tab of this browser has it. */
export async function holdSession(name) {
  if (!navigator.locks) return true;
  return new Promise((answer) => {
    navigator.locks.request(`mimique/${name}`, { ifAvailable: true }, (lock) => {
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

/** Plays a clip once. Resolves with the log as JSON. */
export async function playClip(clip) {
  return JSON.stringify(await (await stage()).play(clip));
}

/** Aborts the play in progress. */
export function stopClip() {
  opening?.then((stage) => stage.stop(), () => {});
}
