// Clips of files: avatar, capture, marker map and method, solved by the studio's module in its worker.
import { putClip } from "./modules/stage/host.js";
import { callWorker } from "./modules/studio/worker-calls.js";
import { absolute, fetched } from "./clip.js";
import { StageProblem } from "./problem.js";

// The built-in head's person, its vertices, and the built-in performance, as the studio opens with them.
const BUILT_IN = { word: "built-in", seed: 1, vertices: 10_000, actor: 1 };

// The worker holds one avatar and one capture: clips are solved one after the other.
let last = Promise.resolve();
let made = 0;
// What was solved of addresses, by all of them: trials that show a clip again do not solve it again.
const solved = new Map();

/** Solves a clip of files; resolves as `prepared` does. */
export function solvedFromFiles(given, onProgress) {
  const key = keyOf(given);
  if (key !== null && solved.has(key)) return solved.get(key).then((clip) => (onProgress(1), clip));
  const clip = last.then(() => solve(given, onProgress));
  last = clip.catch(() => {});
  if (key !== null) {
    solved.set(key, clip);
    clip.catch(() => solved.delete(key));
  }
  return clip;
}

// Null where something of it is no text (a File), which may change.
function keyOf({ avatar, settings, capture, unit, rate, map, method, frames }) {
  const parts = [avatar, settings, capture, unit, rate, map, method, frames].map((part) => part ?? "");
  return parts.every((part) => typeof part !== "object" || part === method) ? JSON.stringify(parts) : null;
}

async function solve(given, onProgress) {
  if (!given.capture) {
    throw new StageProblem("attribute", `mimique-stage: avatar is given, capture is not; give the address of a capture, of recorded weights, or "${BUILT_IN.word}"`);
  }
  onProgress(0);
  const method = methodOf(given.method);
  const [avatar, settings, capture, map] = await Promise.all(
    ["avatar", "settings", "capture", "map"].map((attribute) => bytesOf(attribute, given[attribute])),
  );
  onProgress(0.3);
  const settingsText = settings && new TextDecoder().decode(settings.bytes);
  await (avatar ? callWorker("avatarFile", avatar.name, avatar.bytes, settingsText ?? undefined) : callWorker("builtInAvatar", BUILT_IN.seed, BUILT_IN.vertices));
  onProgress(0.5);
  const rate = !given.rate ? undefined : numberOf("rate", given.rate);
  const take = await (capture ? callWorker("takeFile", capture.name, capture.bytes, given.unit || undefined, rate) : callWorker("builtInTake", BUILT_IN.actor));
  if (take.kind === "markers") await placeMarkers(map);
  onProgress(0.6);
  if (take.kind === "weights" && !given.method) method.method = "recorded";
  const facts = await callWorker("solve", "a", JSON.stringify(method));
  if (facts.problems) {
    const words = facts.problems.map(({ place, text }) => `${place}: ${text}`).join("; ");
    throw new StageProblem("method", `mimique-stage: method: ${words}`);
  }
  const [all, avatarPack] = await Promise.all([callWorker("weights", "a"), callWorker("slotPack", "a")]);
  onProgress(0.9);
  const [first, end] = rangeOf(given.frames, facts.frames);
  const shapes = facts.shapes.length;
  const number = ++made;
  const id = `files-${number}`;
  const provenance = facts.provenance ?? "";
  const clip = {
    clip: id,
    avatarHash: `files-avatar-${number}`,
    avatarPack,
    weights: all.slice(first * shapes, end * shapes),
    frames: end - first,
    shapes,
    rate_hz: facts.rate_hz,
    // Of the whole capture; of a part of it no server has one to compare with.
    weights_hash: end - first === facts.frames ? facts.weights_hash : "",
    provenance,
  };
  await putClip(clip);
  onProgress(1);
  const name = `${capture?.name ?? "built-in actor"}${given.frames ? ` ${given.frames}` : ""}`;
  const summary = {
    clip: name,
    frames: clip.frames,
    rate_hz: clip.rate_hz,
    duration_ms: (1000 * Math.max(clip.frames - 1, 0)) / clip.rate_hz,
    weights_hash: clip.weights_hash,
    solve_ms: 0,
    warnings: facts.warnings ?? [],
  };
  return { id, name, summary };
}

// A map of a file; without one those of the built-in head, or a suggestion.
async function placeMarkers(map) {
  if (map) {
    await callWorker("mapFile", map.name, new TextDecoder().decode(map.bytes));
    return;
  }
  const { markers } = await callWorker("mapState");
  if (markers.every(({ vertex }) => vertex === null)) await callWorker("suggestMap");
}

// {name, bytes} of an address, a File or a Blob; null of what is built in, or not given.
async function bytesOf(attribute, value) {
  if (!value) return null;
  if (value === BUILT_IN.word && (attribute === "avatar" || attribute === "capture")) return null;
  if (value instanceof Blob) return { name: value.name ?? attribute, bytes: new Uint8Array(await value.arrayBuffer()) };
  if (typeof value !== "string") throw StageProblem.ofAttribute(attribute, String(value), "neither an address nor a file", "give an address, a File or a Blob");
  const address = absolute(attribute, value);
  const answer = await fetched(attribute, address);
  const name = decodeURIComponent(new URL(address).pathname.split("/").pop()) || attribute;
  return { name, bytes: new Uint8Array(await answer.arrayBuffer()) };
}

// A MethodSpec: its name alone, or JSON, or an object.
function methodOf(value) {
  if (!value) return { method: "lsts" };
  if (typeof value === "object") return { ...value };
  if (!value.trimStart().startsWith("{")) return { method: value.trim() };
  try {
    return JSON.parse(value);
  } catch (error) {
    throw StageProblem.ofAttribute("method", value, `no JSON (${error.message})`, 'write a name (lsts), or {"method": "lsts", "alpha": 0.3}');
  }
}

function numberOf(attribute, value) {
  const number = Number(value);
  if (!(number > 0)) throw StageProblem.ofAttribute(attribute, value, "no number above 0", "write the frames per second, such as 120");
  return number;
}

// "first:end" of so many frames.
function rangeOf(value, frames) {
  if (!value) return [0, frames];
  const [, first, end] = /^(\d+):(\d+)$/.exec(value) ?? [];
  if (end === undefined || Number(first) >= Number(end) || Number(end) > frames) {
    throw StageProblem.ofAttribute("frames", value, `no part of the ${frames} frames of the capture`, `write FIRST:END, such as 0:${frames}`);
  }
  return [Number(first), Number(end)];
}
