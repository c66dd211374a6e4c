// The border between the participant's pages (app.js, wasm) and the stage. The stage and the solver
// are loaded when the first clip is asked for, so that the first page comes without them.

let host;
// What did not arrive is asked for again the next time.
const stageHost = () =>
  (host ??= import("../stage/host.js").catch((error) => {
    host = undefined;
    throw Object.assign(new Error(error.message), { code: "module", values: {} });
  }));

const held = new Set();
const media = {};

/** Takes a lock for as long as this page lives. False if another tab of this browser has it. */
export async function holdSession(name) {
  // Plain HTTP on another machine has no locks.
  if (!navigator.locks || held.has(name)) return true;
  return new Promise((answer) => {
    const request = navigator.locks.request(`mimique/${name}`, { ifAvailable: true }, (lock) => {
      if (lock !== null) held.add(name);
      answer(lock !== null);
      return lock === null ? undefined : new Promise(() => {});
    });
    // Where all cookies are blocked there are no locks either; nothing is kept that two tabs could share.
    request.catch(() => answer(true));
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

/** What browser and display can do, as the JSON of `study::Display`. An idle page says nothing of a slow device:
    where a clip is given, it is drawn as the study shows it while the frames are counted. */
export async function measure(clip, source, look) {
  const { backend, refreshPeriod } = await stageHost();
  const period = document.hidden ? null : await refreshPeriod(true);
  const found = await backend().catch(() => null);
  const drawn = clip && source && found && !document.hidden ? await drawnRate(clip, JSON.parse(source), JSON.parse(look)) : null;
  const rate = period === null ? null : Math.min(1000 / period, drawn ?? Infinity);
  return JSON.stringify({
    viewport: [innerWidth, innerHeight],
    device_pixel_ratio: devicePixelRatio,
    refresh_hz: rate === null ? null : thousandth(rate),
    backend: found,
    desktop: matchMedia("(any-pointer: fine)").matches && matchMedia("(any-hover: hover)").matches,
    fullscreen: document.fullscreenEnabled ?? false,
  });
}

// So long the head is drawn, and so many frames must come in that time; else it is drawn for as long as the clip lasts.
const LOAD_MS = 1500;
const ENOUGH_FRAMES = 8;

// Frames a second of the study's own head; null where a video is shown.
async function drawnRate(clip, source, look) {
  if (source.video) return null;
  const { prepareClip, openStage } = await stageHost();
  await prepareClip(clip, source);
  const canvas = document.createElement("canvas");
  canvas.className = "measured";
  canvas.setAttribute("aria-hidden", "true");
  document.body.append(canvas);
  const stage = await openStage(canvas, look);
  try {
    await stage.show(clip, 0);
    const timer = setTimeout(() => stage.stop(), LOAD_MS);
    let { frames } = await stage.play(clip);
    clearTimeout(timer);
    if (frames.length < ENOUGH_FRAMES) ({ frames } = await stage.play(clip));
    const [first, last] = [frames[0], frames[frames.length - 1]];
    return frames.length > 1 ? ((frames.length - 1) * 1000) / (last[0] - first[0]) : 0;
  } finally {
    stage.close();
    canvas.remove();
  }
}

/** The address of a picture or a sign-language video of the study, fetched by its hash. */
export async function mediaAddress(hash, type) {
  const { fetchPack } = await stageHost();
  const bytes = await fetchPack(hash);
  media[hash] ??= URL.createObjectURL(new Blob([bytes], { type }));
  return media[hash];
}

/** Copies a text; resolves with whether that was possible. */
export async function copy(text) {
  if (navigator.clipboard) return navigator.clipboard.writeText(text).then(() => true, () => false);
  // Plain HTTP has no clipboard but by hand.
  const field = Object.assign(document.createElement("textarea"), { value: text, className: "visually-hidden" });
  document.body.append(field);
  field.select();
  const copied = document.execCommand("copy");
  field.remove();
  return copied;
}

/** Gives the participant a text as a file. */
export function download(name, text) {
  const address = URL.createObjectURL(new Blob([text], { type: "application/x-ndjson" }));
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

/** Lets the page fill the screen; the browser allows it after a press alone. */
export function requestFullscreen() {
  document.documentElement.requestFullscreen?.({ navigationUI: "hide" }).catch(() => {});
}

/** Gives the screen back. */
export function leaveFullscreen() {
  if (isFullscreen()) document.exitFullscreen().catch(() => {});
}

/** Whether the page fills the screen. */
export function isFullscreen() {
  return document.fullscreenElement != null;
}

/** Fetches packs and solves. Resolves with the solved clip's facts as JSON. */
export async function prepareClip(clip, source, progress) {
  const { prepareClip } = await stageHost();
  return JSON.stringify(await prepareClip(clip, JSON.parse(source), progress));
}

// The canvases on which clips are shown, by name.
const canvases = new Map();

/** Puts a stage on a canvas; it opens while the clip is loaded. Should it fail, it is opened again, and says
    why, when a clip is shown. */
export function attachStage(name, canvas, look) {
  detach(name);
  canvases.set(name, { canvas, look: JSON.parse(look), opening: null });
  stage(name).catch(() => {});
}

/** Takes the stages off the canvases that have gone. */
export function detachStages() {
  for (const [name, { canvas }] of [...canvases]) if (!canvas.isConnected) detach(name);
}

function detach(name) {
  const old = canvases.get(name)?.opening;
  canvases.delete(name);
  old?.then((stage) => stage.close(), () => {});
}

async function stage(name) {
  const here = canvases.get(name);
  if (!here) throw new Error("there is no canvas on this page");
  if (!here.opening) {
    const mine = stageHost().then(({ openStage }) => openStage(here.canvas, here.look));
    here.opening = mine;
    // A stage that could not open is tried anew at the next call.
    mine.catch(() => {
      if (here.opening === mine) here.opening = null;
    });
  }
  return here.opening;
}

/** Shows the first frame of clips, [{canvas, clip}] as JSON, before they are played. */
export async function showClips(clips) {
  for (const { canvas, clip } of JSON.parse(clips)) await (await stage(canvas)).show(clip, 0);
}

// The stage of the play in progress.
let playing = null;

/** Plays clips once, [{canvas, clip}] as JSON, in step or in turn. Resolves with the log as JSON, its times as
    `study::PlayLog` has them. */
export async function playClips(clips, inTurn) {
  const placed = JSON.parse(clips);
  const [{ clip }, ...others] = placed;
  const stages = await Promise.all(placed.map(({ canvas }) => stage(canvas)));
  const here = (playing = stages[0]);
  const beside = others.map((other, k) => ({ stage: stages[k + 1], clipId: other.clip }));
  const seen = watchView(placed, () => here.stop("out of view"));
  try {
    const told = (await triggers)?.play({ clip, beside: others[0]?.clip ?? null, ...(others.length > 1 && { panel: placed.map((each) => each.clip) }) });
    const lines = followed();
    const own = (await face)?.play();
    const each = { frame: (now, ms) => (told?.frame(now, ms), lines?.frame(now), own?.frame(now)), end: (now) => told?.end(now) };
    const log = onPageClock(await here.play(clip, { beside, inTurn, heard: true, told: each }));
    return JSON.stringify({ ...log, triggers: told?.sent(), traces: lines?.courses(log.end_ms - log.onset_ms), mimicry: own?.log() });
  } finally {
    seen.disconnect();
  }
}

// study::TRACE_HZ
const TRACE_HZ = 60;

// Where the lines stand that are moved while a clip plays; null where the trial has none. The first one has the
// keyboard.
function followed() {
  const lines = [...document.querySelectorAll("input[data-trace]")];
  if (lines.length === 0) return null;
  lines[0].focus();
  const notes = [];
  return {
    frame: (now) => notes.push([now, ...lines.map((line) => Number(line.value))]),
    // At each instant where the line stood at the last frame before.
    courses: (lastsMs) => {
      const courses = Object.fromEntries(lines.map((line) => [line.dataset.trace, []]));
      let at = 0;
      for (let k = 0; notes.length > 0 && (k * 1000) / TRACE_HZ <= lastsMs + 1e-6; k++) {
        while (at + 1 < notes.length && notes[at + 1][0] - notes[0][0] <= (k * 1000) / TRACE_HZ + 1e-6) at += 1;
        lines.forEach((line, n) => courses[line.dataset.trace].push(notes[at][n + 1]));
      }
      return courses;
    },
  };
}

// Tells another program on this machine what is shown when, in studies that ask for it.
let triggers;

/** Opens the way to that program; `settings`: JSON of the study's triggers. */
export function openTriggers(settings) {
  triggers ??= import("../devices/triggers.js").then(({ Triggers }) => new Triggers(JSON.parse(settings)), () => null);
}

/** Tells events of the log, JSON. */
export function tellTriggers(events) {
  triggers?.then((open) => open?.tell(JSON.parse(events)));
}

// The share of a picture that is in view when all of it is: layouts round to parts of a pixel.
const WHOLE = 0.98;

// Brings the pictures of a play into view, and calls back once a part of one is not.
function watchView(placed, left) {
  const shown = placed.map((each) => canvases.get(each.canvas).canvas);
  const pictures = shown.map((canvas) => canvas.closest(".stage") ?? canvas);
  pictures[0]?.closest(".stage-frame")?.scrollIntoView({ block: "nearest" });
  const parts = new IntersectionObserver((seen) => {
    if (seen.some(({ intersectionRatio }) => intersectionRatio < WHOLE)) left();
  }, { threshold: [0, 0.25, 0.5, 0.75, 0.9, WHOLE, 1] });
  for (const picture of pictures) parts.observe(picture);
  return parts;
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
    drift_ms: thousandth(log.drift_ms),
    frames: frames.map(([shown, clip, late]) => [thousandth(shown - onset), thousandth(clip), late]),
  };
}

// Microseconds: browsers tell no finer.
function thousandth(ms) {
  return Math.round(ms * 1000) / 1000;
}

/** Gives a page whose controls are a script's, the sound check or the consent to measuring the face, or the captions
    below a clip, their place: scripts that only studies load that have such pages. */
export function attachSound(node) {
  const { script } = node.dataset;
  import(script ? `../${script}/check.js` : "../sound/sound.js").then(
    ({ begin, attachCaptions }) => (script === "mimicry" ? (face = begin(node)) : (begin ?? attachCaptions)(node)),
    // What did not arrive is asked for again.
    () => setTimeout(() => node.isConnected && attachSound(node), 2000),
  );
}

// What measures the participant's face: a promise of the tracker of those who have agreed.
let face;

/** Goes on measuring after a reload where the camera was on; `pages`: JSON of study::MimicryPages, `camera`: what became of
    it, as the consent's page found it. */
export function openMimicry(pages, camera) {
  if (camera.endsWith("seen")) face ??= import("../mimicry/tracker.js").then(({ resumed }) => resumed(JSON.parse(pages)), () => null);
}

/** The next level of an adaptive block: scripts of studies with such a block alone. What did not arrive is asked for
    again. */
export function nextLevel(request) {
  return import("../adaptive/levels.js").then(
    ({ nextLevel }) => nextLevel(request),
    () => new Promise((again) => setTimeout(() => again(nextLevel(request)), 2000)),
  );
}

/** The clips that may come after the level that was chosen last. */
export async function levelsAhead() {
  const { levelsAhead } = await import("../adaptive/levels.js");
  return JSON.stringify(levelsAhead());
}

/** The next batch of pairs of an active schedule: scripts of studies with such a schedule alone. What did not arrive is
    asked for again. */
export function drawPairs(request) {
  return import("../adaptive/pairs.js").then(
    ({ nextPairs }) => nextPairs(request),
    () => new Promise((again) => setTimeout(() => again(drawPairs(request)), 2000)),
  );
}

/** Aborts the play in progress. */
export function stopClip() {
  playing?.stop();
}
