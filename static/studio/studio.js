// The studio: files in, markers matched, methods side by side, expressions cut, exports out.
import { Player } from "../stage/player.js";
import { Curves } from "./curves.js";
import { callWorker } from "./worker-calls.js";
import { Exertion } from "./exertion.js";
import { save, wireExports } from "./export.js";
import { Labels } from "./labels.js";
import { Layouts } from "./layouts.js";
import { Matching } from "./matching.js";
import { MethodPanel } from "./panel.js";
import { Timeline } from "./timeline.js";
import { GivenGaze } from "./gaze.js";
import { TrainingFiles } from "./training.js";

const $ = (id) => document.getElementById(id);
const SLOTS = ["a", "b", "c", "d"];
const SECOND_METHODS = ["box", "lsts-norm", "kouadio"];

const player = new Player();
const here = { panels: [], avatar: null, avatars: 0, take: null, map: null, methods: [], segments: [], training: null };

const methods = callWorker("methods").then((all) => (here.methods = all));

function report(error) {
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

const page = {
  get methods() {
    return here.methods;
  },
  player,
  report,
  save,
  avatarKey: () => (here.avatar ? `studio-avatar-${here.avatars}` : null),
  avatar: () => here.avatar,
  avatarShapes: () => here.avatar.shapes.length,
  faceMarkers: () => (here.map?.markers ?? []).filter(({ vertex }) => vertex !== null).map(({ label }) => label),
  mapIsThere: () => (here.map?.markers ?? []).some(({ vertex }) => vertex !== null),
  trainingMissing: () => (here.training ? here.training.missing : "open a range of motion and its weights"),
  showMarkers: () => $("show-markers").checked,
  first: () => here.panels[0],
  panels: () => here.panels,
  panel: (slot) => player.panels.find((each) => each.slot === slot),
  slot: () => here.panels.find((panel) => panel.facts)?.slot ?? "",
  seek: (ms) => (player.pause(), player.seek(ms)),
  timeMs: () => player.timeMs,
  pause: () => player.pause(),
  part: () => player.part ?? [0, player.durationMs()],
  name: () => (here.take?.file ?? "take").replace(/\.[^.]*$/, "").replace(/[^\w-]+/g, "-"),
  series: (slot, name) => callWorker("series", slot, name),
  mapChanged(state) {
    here.map = state;
    mapFacts();
    for (const panel of here.panels) {
      panel.sourcesChanged();
      panel.solveSoon();
    }
  },
  gazeChanged() {
    for (const panel of here.panels) panel.solveSoon();
  },
  trainingChanged(state) {
    here.training = state;
    for (const panel of here.panels) panel.trainingChanged();
    layouts.sourcesChanged().catch(report);
  },
  takeIsMotion: () => here.take?.kind === "markers",
  captureOptions: () => [$("take-unit").value || undefined, Number($("take-rate").value) || undefined],
  busy,
  changed() {
    const faces = player.panels.filter((panel) => panel.facts);
    $("transport").hidden = player.durationMs() === 0;
    $("curves").hidden = !here.panels.some((panel) => panel.facts);
    $("exports").hidden = faces.length === 0;
    const chosen = $("export-slot").value;
    $("export-slot").replaceChildren(...faces.map((panel) => new Option(panel.title(), panel.slot)));
    if (faces.some((panel) => panel.slot === chosen)) $("export-slot").value = chosen;
    fillRange();
    curves.update().catch(report);
  },
  remove(panel) {
    panel.close();
    putPanels(here.panels.filter((each) => each !== panel));
    $("add-panel").hidden = false;
    page.changed();
  },
};

// The panels of methods, and that of the exertion behind them.
function putPanels(panels) {
  here.panels = panels;
  player.panels = [...panels, exertion];
}

const exertion = new Exertion(page);
putPanels([]);
const curves = new Curves(page);
const matching = new Matching(page);
const layouts = new Layouts(page);
const timeline = new Timeline({
  ...page,
  changed(segments) {
    here.segments = segments;
    fillRange();
  },
});
const labels = new Labels({ ...page, expressions: (segments) => timeline.take(segments) });
wireExports({ ...page, panels: () => player.panels });
new TrainingFiles(page);
const gaze = new GivenGaze(page);

// What can be played: all, a segment, and, where a take is longer, the window of the exertion.
function fillRange() {
  const range = $("range");
  const before = range.value;
  const window = here.panels.length > 0 && exertion.clip() ? [new Option("the exertion's window", "exertion")] : [];
  range.replaceChildren(new Option("the whole take", ""), ...window, ...here.segments.map((segment, i) => new Option(segment.label, String(i))));
  range.value = before;
  if (range.selectedIndex < 0) range.value = "";
  choosePart();
}

function choosePart() {
  if ($("range").value === "exertion") return void (player.part = [0, exertion.clip().duration_ms]);
  const segment = here.segments[Number($("range").value)];
  player.part = $("range").value !== "" && segment ? segment.clip_s.map((s) => 1000 * s) : null;
}

function mapFacts() {
  const { markers = [], absent = [], suggestion } = here.map ?? {};
  const placed = markers.filter(({ vertex }) => vertex !== null).length;
  const words = [`${placed} markers on the face, ${markers.filter(({ head }) => head).length} for the head`];
  if (absent.length > 0) words.push(`not in the capture: ${absent.join(", ")}`);
  if (suggestion) {
    words.push(`suggested, ${suggestion.distance_rms_mm.toFixed(1)} mm from the skin: look at it below`);
    words.push(...suggestion.notes);
  }
  $("map-facts").textContent = placed === 0 ? "none" : words.join("; ");
  $("map-save").disabled = placed === 0;
  layouts.mapChanged();
}

async function avatarHere(facts) {
  if (!facts) return;
  here.avatar = facts;
  here.avatars += 1;
  const notes = facts.notes.length > 0 ? `; ${facts.notes.join("; ")}` : "";
  $("avatar-facts").textContent = `${facts.file}: ${facts.vertices} vertices, ${facts.shapes.length} shapes${notes}`;
  await sourcesChanged();
}

async function takeHere(facts) {
  if (!facts) return;
  here.take = facts;
  await gaze.takeChanged();
  if (facts.kind === "weights") {
    $("take-facts").textContent = `${facts.file}: recorded weights, ${facts.frames} frames, ${facts.columns.length} columns`;
    timeline.reset(facts.frames, facts.rate_hz ?? 1);
    await labels.reset(facts.frames, facts.rate_hz ?? 1);
  } else {
    const { frames, rate_hz, duration_s, markers, system, warnings, notes } = facts.facts;
    const words = [`${facts.file}: ${markers} markers, ${frames} frames at ${rate_hz} Hz (${duration_s.toFixed(1)} s)`];
    if (system) words.push(system);
    $("take-facts").textContent = [...words, ...notes, ...warnings].join("; ");
    timeline.reset(frames, rate_hz);
    await labels.reset(frames, rate_hz);
  }
  await sourcesChanged();
}

// A new avatar or take: the map as the worker has it, a suggestion where there is none, methods anew.
async function sourcesChanged() {
  exertion.sourcesChanged();
  $("matching").hidden = !here.avatar || here.take?.kind !== "markers";
  $("expressions").hidden = !here.take;
  $("next").textContent = here.avatar ? (here.take ? "" : "Now open a capture, or take the built-in actor.") : "Now open an avatar, or take the built-in head.";
  if (!here.avatar) return;
  if (here.take?.kind === "markers") {
    here.map = await callWorker("mapState");
    if (here.map.markers.every(({ vertex }) => vertex === null)) await suggest();
    matching.put(here.map);
    await matching.show();
  } else here.map = null;
  mapFacts();
  await layouts.sourcesChanged();
  if (!here.take) return;
  await methods;
  const recorded = here.take.kind === "weights";
  if (here.panels.length === 0) addPanel(recorded ? "recorded" : "lsts");
  for (const panel of here.panels) {
    if (recorded !== panel.isRecorded()) panel.choose(recorded ? "recorded" : "lsts");
    panel.sourcesChanged();
  }
  $("add-panel").hidden = here.panels.length >= SLOTS.length;
  await Promise.all(here.panels.map((panel) => panel.solve()));
}

async function suggest() {
  const state = await busy("Looking for the markers' places", () => callWorker("suggestMap"));
  if (!state) return;
  here.map = state;
  matching.put(state);
  mapFacts();
}

function addPanel(method) {
  const slot = SLOTS.find((each) => !page.panel(each));
  const panel = new MethodPanel(slot, page, method, here.panels.length > 0);
  putPanels([...here.panels, panel]);
  $("panels").append(panel.element);
  $("add-panel").hidden = here.panels.length >= SLOTS.length;
  return panel;
}

// Files by what they are: .json beside an avatar is its settings, else a map.
async function openFiles(files, as) {
  const bytes = async (file) => new Uint8Array(await file.arrayBuffer());
  const named = (pattern) => files.find((file) => pattern.test(file.name));
  const settings = named(/\.avatar\.json$/i);
  const avatar = as === "avatar" ? files.find((file) => file !== settings) : named(/\.(glb|gltf|zip|tar|gz|xz)$/i);
  if (avatar) {
    const facts = await busy(`Reading ${avatar.name}`, async () => callWorker("avatarFile", avatar.name, await bytes(avatar), await settings?.text()));
    await avatarHere(facts);
  }
  const rest = files.filter((file) => file !== avatar && file !== settings);
  for (const file of rest) {
    const isMap = as === "map" || (as !== "take" && (/\.json$/i.test(file.name) || (/\.csv$/i.test(file.name) && (await file.slice(0, 40).text()).startsWith("marker,role"))));
    if (isMap) await openMap(file);
    else if (/\.eaf$/i.test(file.name)) report(new Error(`${file.name}: open it under Expressions`));
    else {
      await takeHere(await busy(`Reading ${file.name}`, async () => callWorker("takeFile", file.name, await bytes(file), ...page.captureOptions())));
    }
  }
}

async function openMap(file) {
  const state = await busy(`Reading ${file.name}`, async () => callWorker("mapFile", file.name, await file.text()));
  if (!state) return;
  matching.put(state);
  page.mapChanged(state);
}

function wire() {
  const files = (id, as) =>
    $(id).addEventListener("change", async ({ target }) => {
      const chosen = [...target.files];
      target.value = "";
      await openFiles(chosen, as).catch(report);
    });
  files("avatar-file", "avatar");
  files("take-file", "take");
  files("map-file", "map");
  $("avatar-built-in").addEventListener("click", () => builtInAvatar().catch(report));
  $("take-built-in").addEventListener("click", () => builtInTake().catch(report));
  $("map-suggest").addEventListener("click", () => suggest().then(() => here.map && page.mapChanged(here.map)));
  $("map-save").addEventListener("click", async () => save("markers.json", await callWorker("mapJson")));
  $("add-panel").addEventListener("click", () => addPanel(SECOND_METHODS[here.panels.length - 1] ?? "lsts").solve());
  $("show-markers").addEventListener("change", () => player.draw());
  $("range").addEventListener("change", () => (choosePart(), player.seek(player.part?.[0] ?? 0)));
  player.wire({ m: () => $("show-markers").click() });
  player.onDraw = (ms) => (curves.at(ms), timeline.at(ms), labels.at(ms));
  const main = document.querySelector("main");
  addEventListener("dragover", (event) => (event.preventDefault(), main.classList.add("dropping")));
  addEventListener("dragleave", (event) => event.relatedTarget === null && main.classList.remove("dropping"));
  addEventListener("drop", (event) => {
    event.preventDefault();
    main.classList.remove("dropping");
    openFiles([...event.dataTransfer.files]).catch(report);
  });
}

const builtInAvatar = async () => avatarHere(await busy("Building the head", () => callWorker("builtInAvatar", 1, 10_000)));
const builtInTake = async () => takeHere(await busy("Playing the expressions", () => callWorker("builtInTake", 1)));

// What `mimique preview` was given.
async function givenFiles() {
  const names = JSON.parse(document.body.dataset.files || "{}");
  const given = async (role) => {
    if (!names[role]) return null;
    const answer = await fetch(`/studio/files/${role}`);
    if (!answer.ok) throw new Error(`${names[role]}: the server answered ${answer.status}; start it again`);
    return new File([await answer.blob()], names[role]);
  };
  const [avatar, settings, take, map] = await Promise.all(["avatar", "settings", "take", "map"].map(given));
  if (avatar) await openFiles([avatar, settings].filter(Boolean), "avatar");
  if (take && !avatar) await builtInAvatar();
  if (take) await openFiles([take], "take");
  if (map) await openMap(map);
}

async function start() {
  wire();
  await methods;
  await givenFiles();
}

start().catch(report);
