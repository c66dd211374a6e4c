// The studio: joins the parts of the window. Files in, markers matched, methods side by side, expressions cut,
// exports out.
import { Player } from "../stage/player.js";
import { Camera, fitted } from "./camera.js";
import { commandsOf, wireKeys } from "./commands.js";
import { Curves } from "./curves.js";
import { Exertion } from "./exertion.js";
import { save, wireExports } from "./export.js";
import { Faces } from "./faces.js";
import { GivenGaze } from "./gaze.js";
import { History } from "./history.js";
import { Labels } from "./labels.js";
import { Layouts } from "./layouts.js";
import { Matching } from "./matching.js";
import { Palette } from "./palette.js";
import { Ruler } from "./ruler.js";
import { Shapes } from "./shapes.js";
import { Sources } from "./sources.js";
import { StudyPane } from "./study.js";
import { wireSplits } from "./splits.js";
import { Tabs } from "./tabs.js";
import { fill, language, numeral, say } from "./texts.js";
import { Timeline } from "./timeline.js";
import { TrainingFiles } from "./training.js";
import { problemWords } from "./words-engine.js";
import { Forgotten, sayProblems } from "./worker-calls.js";

const $ = (id) => document.getElementById(id);

fill();
sayProblems({
  problem: problemWords,
  broke: (reason) => say("worker.broke", { reason }),
  unloaded: (reason) => say("worker.unloaded", { reason: reason || say("worker.absent") }),
});
const player = new Player();
player.written = (seconds) => numeral(seconds, 2);
player.words = { play: say("play"), pause: say("pause") };
const tabs = new Tabs();
let segments = [];
let training = null;

function report(error) {
  // The face that the call was about is gone: there is nothing to correct.
  if (error instanceof Forgotten) return;
  $("problem").textContent = String(error?.message ?? error);
  $("problem").hidden = false;
}

async function busy(words, work) {
  $("problem").hidden = true;
  $("busy").textContent = words;
  $("busy").hidden = false;
  try {
    return await work();
  } catch (error) {
    report(error);
    return null;
  } finally {
    $("busy").hidden = true;
  }
}

const history = new History(() => {
  const { undo, redo } = history.next;
  for (const [id, what] of [["undo", undo], ["redo", redo]]) {
    $(id).disabled = what === null;
    $(id).title = what === null ? "" : say(`${id}.what`, { what });
  }
}, report);

// A face is seen from elsewhere; drawn with the display's next frame.
let asked = false;
const camera = new Camera(() => {
  for (const panel of player.panels) panel.turn();
  if (asked || player.playing) return;
  asked = true;
  requestAnimationFrame(() => ((asked = false), player.playing || player.draw()));
});

const page = {
  player,
  tabs,
  history,
  camera,
  report,
  busy,
  save,
  get methods() {
    return faces.methods;
  },
  avatarKey: () => sources.avatarKey,
  avatar: () => sources.avatar,
  avatarShapes: () => sources.avatar.shapes.length,
  faceMarkers: () => (sources.map?.markers ?? []).filter(({ vertex }) => vertex !== null).map(({ label }) => label),
  mapIsThere: () => (sources.map?.markers ?? []).some(({ vertex }) => vertex !== null),
  trainingMissing: () => (training ? training.missing && problemWords(training.missing) : say("training.missing")),
  showMarkers: () => $("show-markers").checked,
  takeIsMotion: () => sources.take?.kind === "markers",
  captureOptions: () => sources.captureOptions(),
  first: () => faces.panels[0],
  panels: () => faces.panels,
  chosen: () => faces.chosen,
  panel: (slot) => player.panels.find((each) => each.slot === slot),
  slot: () => faces.panels.find((panel) => panel.facts)?.slot ?? "",
  choose: (slot) => faces.choose(slot),
  remove: (slot) => faces.remove(slot),
  durationMs: () => player.durationMs(),
  seek: (ms) => (player.pause(), player.seek(ms)),
  seekFrame: (slot, frame) => page.seek((1000 * frame) / page.panel(slot).facts.rate_hz),
  timeMs: () => player.timeMs,
  pause: () => player.pause(),
  part: () => player.part ?? [0, player.durationMs()],
  name: () => (sources.take?.file ?? "take").replace(/\.[^.]*$/, "").replace(/[^\w-]+/g, "-"),
  mapPut: (state) => matching.put(state),
  mapChanged(state) {
    sources.putMap(state);
    layouts.mapChanged();
    for (const panel of faces.panels) {
      panel.sourcesChanged();
      panel.solveSoon();
    }
  },
  gazeChanged() {
    for (const panel of faces.panels) panel.solveSoon();
  },
  trainingChanged(state) {
    training = state;
    for (const panel of faces.panels) panel.trainingChanged();
    layouts.sourcesChanged().catch(report);
  },
  changed() {
    faces.rename();
    faces.keep();
    const solved = player.panels.filter((panel) => panel.facts);
    $("transport").hidden = player.durationMs() === 0;
    tabs.can("exports", solved.length > 0);
    tabs.can("study", faces.panels.some((panel) => panel.facts));
    const chosen = $("export-slot").value;
    $("export-slot").replaceChildren(...solved.map((panel) => new Option(panel.title(), panel.slot)));
    if (solved.some((panel) => panel.slot === chosen)) $("export-slot").value = chosen;
    fillRange();
    shapes.put(faces.chosen);
    curves.update().catch(report);
  },
  /// Shows the whole head, as far as its skin goes, in the chosen face.
  fit() {
    const panel = faces.chosen;
    const portrait = panel?.portrait();
    const { bounds } = sources.avatar ?? {};
    if (portrait && bounds) camera.set(panel.slot, fitted(portrait, bounds));
  },
};

const faces = new Faces(page, () => {
  player.panels = [...faces.panels, exertion];
  page.changed();
});
const exertion = new Exertion(page);
player.panels = [exertion];
const shapes = new Shapes(() => curves.weights());
const curves = new Curves(page, shapes);
const ruler = new Ruler(page);
const matching = new Matching(page);
const layouts = new Layouts(page);
const timeline = new Timeline({
  ...page,
  changed(others) {
    segments = others;
    fillRange();
  },
});
const labels = new Labels({ ...page, expressions: (others) => timeline.take(others) });
wireExports({ ...page, panels: () => player.panels });
const trainingFiles = new TrainingFiles(page);
const gaze = new GivenGaze(page);
const sources = new Sources({
  ...page,
  async takeChanged(frames, rate) {
    studyPane.takeChanged();
    await gaze.takeChanged();
    timeline.reset(frames, rate);
    await labels.reset(frames, rate);
  },
  // A new avatar or take: methods anew.
  async changed() {
    exertion.sourcesChanged();
    tabs.can("matching", Boolean(sources.avatar) && sources.take?.kind === "markers");
    tabs.can("expressions", Boolean(sources.take));
    tabs.can("labelling", Boolean(sources.take));
    layouts.mapChanged();
    if (!sources.avatar) return;
    await matching.show();
    await layouts.sourcesChanged();
    if (sources.take) await faces.sourcesChanged(sources.take.kind === "weights");
  },
});

const studyPane = new StudyPane({
  ...page,
  gaze: () => gaze.ofStudy(),
  files: () => ({ ...sources.files, ...trainingFiles.files, gaze: gaze.file }),
});

// What can be played: all, a segment, and, where a take is longer, the window of the exertion.
function fillRange() {
  const range = $("range");
  const before = range.value;
  const window = faces.panels.length > 0 && exertion.clip() ? [new Option(say("range.exertion"), "exertion")] : [];
  range.replaceChildren(new Option(say("range.all"), ""), ...window, ...segments.map((segment, i) => new Option(segment.label, String(i))));
  range.value = before;
  if (range.selectedIndex < 0) range.value = "";
  choosePart();
  ruler.put(segments);
}

function choosePart() {
  if ($("range").value === "exertion") return void (player.part = [0, exertion.clip().duration_ms]);
  const segment = segments[Number($("range").value)];
  player.part = $("range").value !== "" && segment ? segment.clip_s.map((s) => 1000 * s) : null;
}

function wire() {
  const click = (id, act) => $(id).addEventListener("click", act);
  click("add-panel", () => faces.add());
  click("undo", () => history.undo());
  click("redo", () => history.redo());
  click("view-reset", () => camera.reset(faces.chosen?.slot));
  click("view-fit", () => page.fit());
  click("problem-away", () => ($("problem").hidden = true));
  $("view-linked").checked = camera.linked;
  $("view-linked").addEventListener("change", ({ target }) => camera.link(target.checked, faces.panels.map(({ slot }) => slot), faces.chosen?.slot));
  $("show-markers").addEventListener("change", () => player.draw());
  $("range").addEventListener("change", () => (choosePart(), player.seek(player.part?.[0] ?? 0)));
  $("view").addEventListener("change", ({ target }) => {
    const [yaw, pitch] = target.value.split(",").map(Number);
    camera.set(faces.chosen?.slot, { yaw, pitch });
  });
  $("language").value = language;
  $("language").addEventListener("change", ({ target }) => {
    const address = new URL(location);
    address.searchParams.set("lang", target.value);
    location.assign(address);
  });
  player.wireControls();
  player.onDraw = (ms) => (ruler.at(ms), shapes.at(ms));
  const commands = commandsOf({ ...page, faces, sources, openPalette: () => palette.open() });
  const palette = new Palette(commands);
  wireKeys(commands);
  click("commands", () => palette.open());
  wireSplits();
  tabs.restore();
}

async function start() {
  wire();
  await faces.ready;
  await sources.given();
}

start().catch(report);
