// The reader of a capsule: the report, its figures' points that lead to clips, the trials, and each clip drawn again as
// that person saw it. The page's words stand in it; its files come by loader.js.
import { Replay } from "../researcher/replayed.js";
import { made } from "../stage/player.js";
import { openChanges } from "./changes.js";

const $ = (id) => document.getElementById(id);
const { capsule } = globalThis;
const root = $("capsule");
const words = JSON.parse(root.dataset.words);
const say = (word, values) => words[word].replace(/\{(\w+)\}/g, (_, name) => values[name]);
const replay = new Replay(JSON.parse(root.dataset.replay));
/// Most rows of trials that stand on the page.
const MOST_ROWS = 60;

const site = () => capsule.json("site.json");
const study = async (configHash) => {
  const { bundle } = await site();
  if (bundle.config_hash !== configHash) throw new Error(say("otherVersion", { hash: configHash.slice(0, 12) }));
  return bundle;
};

/// Shows a report in its frame. What it leads to is opened here.
function showReport(text) {
  const frame = $("report");
  frame.onload = () => {
    const inside = frame.contentDocument;
    inside.addEventListener("click", (event) => follow(event, inside));
  };
  frame.removeAttribute("src");
  frame.srcdoc = text;
}

function follow(event, inside) {
  const address = event.target.closest?.("a[href]")?.getAttribute("href");
  if (!address) return;
  event.preventDefault();
  if (address.startsWith("#")) return inside.getElementById(address.slice(1))?.scrollIntoView();
  const asked = new URL(address, capsule.BASE).searchParams;
  if (asked.has("clip")) openClip(asked.get("clip"));
}

/// The trials of a clip, the first of them drawn.
function openClip(clip) {
  $("person").value = "";
  $("clip").value = clip;
  const found = list();
  $("trials").scrollIntoView();
  const first = found.find((trial) => trial.plays > 0);
  if (first) draw(first);
}

let trials = [];
// What is listed, and which of it is drawn.
let listed = [];
let current = null;

/// The rows that fit what is chosen; the first of them are listed.
function list() {
  const [person, clip] = [$("person").value, $("clip").value];
  const found = trials.filter((trial) => (!person || trial.participant === person) && (!clip || trial.stimulus === clip || trial.beside === clip));
  const rows = found.slice(0, MOST_ROWS).map((trial) => {
    const button = made("button", { type: "button", className: "quiet", disabled: trial.plays === 0 }, words.draw);
    button.setAttribute("aria-label", say("drawTrial", trial));
    button.addEventListener("click", () => draw(trial));
    const answers = trial.answers.map(([question, value]) => `${question} ${value}`).join(", ");
    const clips = [trial.stimulus, trial.beside].filter(Boolean).join(" · ");
    const cells = [trial.participant, trial.order, clips, answers].map((text) => made("td", {}, String(text ?? "")));
    const late = made("td", { className: "number" }, trial.late);
    return made("tr", {}, ...cells, late, made("td", {}, button));
  });
  $("rows").replaceChildren(...rows);
  $("count").textContent = say(found.length > rows.length ? "someTrials" : "allTrials", { count: found.length, shown: rows.length });
  listed = found;
  return found;
}

/// The next trial of the list, or the one before.
function turn(by) {
  const next = listed[listed.indexOf(current) + by];
  if (current && next?.plays > 0) draw(next);
}

/// Draws a trial as its participant saw it.
async function draw(trial) {
  const isMine = replay.begin();
  current = trial;
  $("player").hidden = false;
  $("drawn").hidden = false;
  $("drawn").textContent = say("drawn", trial);
  $("drawn").scrollIntoView({ block: "start" });
  try {
    const { pages } = await capsule.json(`plays/${trial.participant}.json`);
    if (isMine()) await replay.showPlays(pages[trial.step], study, isMine);
  } catch (error) {
    if (isMine()) replay.problem(error);
  }
}

async function start() {
  showReport(await capsule.body("report.html"));
  const told = await capsule.json("trials.json");
  trials = told.trials;
  const options = (element, names) => element.append(...names.map((name) => new Option(name, name)));
  options($("person"), told.participants);
  options($("clip"), told.clips);
  for (const id of ["person", "clip"]) $(id).addEventListener("change", list);
  replay.wire({ p: () => turn(-1), n: () => turn(1) });
  list();
  openChanges({ words, say, showReport });
  // A figure of report/report.html leads here.
  const clip = new URLSearchParams(location.search).get("clip");
  if (clip) openClip(clip);
  root.dataset.ready = "true";
}

start().catch((error) => replay.problem(error));
