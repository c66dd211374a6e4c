// Clips: packs fetched, weights solved in the worker, kept in memory.
import { moduleWorker } from "../module-worker.js";
import { sendPanic } from "../panics.js";
import { loadAhead } from "./backend.js";
import { failureOf, StageFailure } from "./failure.js";
import { videoDuration } from "./video.js";
import { fetchPack } from "./packs.js";
import { picturesOf } from "./pictures.js";

// A solve takes seconds, a minute on the slowest phones: a worker that is silent for longer, or was never
// loaded, is given up.
const SOLVE_MS = 180_000;

const clips = new Map();
let worker = null;
let nextJob = 1;
const jobs = new Map();

/// See "The host scripts" in ARCHITECTURE.md.
export function prepareClip(clipId, source, onProgress = () => {}) {
  const known = clips.get(clipId);
  if (known && known.provenance === source.provenance) {
    known.summary.then(() => onProgress(1), () => {});
    return known.summary;
  }
  const entry = { provenance: source.provenance, clip: null };
  entry.summary = prepare(clipId, source, onProgress).then(
    (clip) => {
      entry.clip = clip;
      return summary(clip);
    },
    (error) => {
      // The next call tries again.
      if (clips.get(clipId) === entry) clips.delete(clipId);
      throw error;
    },
  );
  clips.set(clipId, entry);
  return entry.summary;
}

/// A prepared clip with its weights (Float32Array, frames x shapes) or its video (an address), or a
/// thrown Error.
export function preparedClip(clipId) {
  const clip = clips.get(clipId)?.clip;
  if (!clip) throw new Error(`clip ${clipId}: not prepared; await prepareClip first`);
  return clip;
}

/// Keeps a clip that was solved elsewhere: {clip, avatarHash, avatarPack, weights, frames, shapes,
/// rate_hz}. Resolves when it can be shown.
export async function putClip(clip) {
  const pictures = await picturesOf(clip.avatarPack);
  const whole = {
    video: null,
    look: "stimulus",
    duration_ms: (1000 * Math.max(clip.frames - 1, 0)) / clip.rate_hz,
    weights_hash: "",
    provenance: "",
    solve_ms: 0,
    report: null,
    warnings: [],
    pictures,
    ...clip,
  };
  clips.set(clip.clip, { provenance: whole.provenance, clip: whole, summary: Promise.resolve(summary(whole)) });
}

/// Writes the weights at clip time `ms` into `out`: linear between capture frames, held at the ends.
export function weightsAt(clip, ms, out) {
  const { weights, shapes, frames, rate_hz } = clip;
  const at = Math.min(Math.max((ms * rate_hz) / 1000, 0), frames - 1);
  const before = Math.floor(at);
  const after = Math.min(before + 1, frames - 1);
  const part = at - before;
  for (let k = 0; k < shapes; k++) {
    const w = weights[before * shapes + k];
    out[k] = w + part * (weights[after * shapes + k] - w);
  }
}

// Loading is nine tenths of the bar, solving the last.
async function prepare(clipId, source, onProgress) {
  let received = 0;
  let reported = 0;
  const report = (part) => {
    reported = Math.max(reported, Math.min(part, 1));
    onProgress(reported);
  };
  const count = (bytes) => {
    received += bytes;
    if (source.bytes > 0) report(0.9 * Math.min(received / source.bytes, 1));
  };
  report(0);
  const sound = source.sound && soundOf(source.sound, count, source.packs);
  // What goes wrong with it is said below, once the rest is there.
  sound?.catch(() => {});
  if (source.video) {
    const bytes = await fetchPack(source.avatar, count, source.packs);
    const video = URL.createObjectURL(new Blob([bytes], { type: source.video }));
    const duration_ms = await videoDuration(video).catch((error) => {
      URL.revokeObjectURL(video);
      throw error;
    });
    report(1);
    const nothing = { weights: new Float32Array(0), frames: 0, shapes: 0, rate_hz: 0, weights_hash: "", solve_ms: 0 };
    return { clip: clipId, video, duration_ms, ...nothing, sound: await sound, provenance: source.provenance, report: null, warnings: [] };
  }
  if (source.units) {
    const [face, avatar] = await Promise.all([faceOf(source), fetchPack(source.avatar, count, source.packs)]);
    loadAhead();
    const pictures = await picturesOf(avatar);
    report(1);
    const { look = "stimulus", avatar: avatarHash, provenance, duration_ms } = source;
    return { clip: clipId, video: null, look, avatarHash, avatarPack: avatar, pictures, duration_ms, provenance, solve_ms: 0, report: null, warnings: [], ...face };
  }
  // The solver and the canvas come beside the packs.
  worker ??= startWorker();
  loadAhead();
  const [avatar, operators, take] = await Promise.all(
    [source.avatar, source.operators, source.take].map((hash) => fetchPack(hash, count, source.packs)),
  );
  report(0.9);
  const [solved, pictures] = await Promise.all([
    solve(operators, take, source.method),
    picturesOf(avatar),
  ]);
  const clip = {
    clip: clipId,
    video: null,
    look: source.look ?? "stimulus",
    avatarHash: source.avatar,
    avatarPack: avatar,
    pictures,
    weights: solved.weights,
    frames: solved.frames,
    shapes: solved.shapes,
    rate_hz: solved.rate_hz,
    duration_ms: source.duration_ms,
    weights_hash: solved.weights_hash,
    provenance: source.provenance,
    solve_ms: solved.solve_ms,
    report: solved.report,
    sound: await sound,
    warnings: [],
  };
  clip.warnings = warnings(clip, source);
  report(1);
  return clip;
}

// The weights of a face that is drawn for one trial; without a trial the avatar rests. Studies without such faces load
// nothing for them.
async function faceOf(source) {
  const { shapes } = source.units;
  if (!source.face) {
    return { weights: new Float32Array(2 * shapes), frames: 2, shapes, rate_hz: 1000 / source.duration_ms, weights_hash: "" };
  }
  const { drawFace } = await import("../adaptive/faces.js").catch((error) => {
    throw failureOf(error, "module");
  });
  return { shapes, ...(await drawFace({ ...source.face, units: source.units })) };
}

// Studies without sound load nothing for it.
async function soundOf(source, count, packs) {
  const load = import("../sound/sound.js").catch((error) => {
    throw failureOf(error, "module");
  });
  const [{ loadSound }, bytes] = await Promise.all([load, fetchPack(source.file, count, packs)]);
  return loadSound(source, bytes);
}

function warnings(clip, source) {
  const found = [];
  if (source.weights_hash && source.weights_hash !== clip.weights_hash) {
    found.push(
      `weights differ from the server's: ${clip.weights_hash.slice(0, 12)} here, ` +
        `${source.weights_hash.slice(0, 12)} there`,
    );
  }
  if (clip.frames < 1 || clip.weights.length !== clip.frames * clip.shapes) {
    found.push(`${clip.weights.length} weights for ${clip.frames} frames of ${clip.shapes} blendshapes`);
  }
  const captured = (1000 * clip.frames) / clip.rate_hz;
  if (clip.duration_ms > captured + 1500 / clip.rate_hz) {
    found.push(`lasts ${clip.duration_ms.toFixed(0)} ms, captured are ${captured.toFixed(0)} ms; its end is held`);
  }
  if (Array.isArray(clip.report?.warnings)) found.push(...clip.report.warnings.map(String));
  return found;
}

function summary({ clip, frames, rate_hz, duration_ms, weights_hash, solve_ms, warnings }) {
  return { clip, frames, rate_hz, duration_ms, weights_hash, solve_ms, warnings: [...warnings] };
}

function solve(operators, take, method) {
  worker ??= startWorker();
  const asked = worker;
  const id = nextJob++;
  let timer;
  return new Promise((resolve, reject) => {
    jobs.set(id, { resolve, reject });
    asked.postMessage({ id, operators, take, method });
    const silent = { seconds: String(SOLVE_MS / 1000) };
    timer = setTimeout(() => discard(asked, "solver_silent", `solver: no answer for ${silent.seconds} s`, silent), SOLVE_MS);
  }).finally(() => clearTimeout(timer));
}

function startWorker() {
  const started = moduleWorker(new URL("./solver-worker.js", import.meta.url));
  started.onmessage = ({ data }) => {
    if (data.panic) return sendPanic(data.panic);
    const job = jobs.get(data.id);
    jobs.delete(data.id);
    if (data.error !== undefined) {
      // A module that panicked cannot go on: the next solve gets a fresh worker.
      if (data.panicked) discard(started, "solver", `solver: ${data.error}`);
      job?.reject(new StageFailure("solver", `solver: ${data.error}`));
    } else {
      job?.resolve(data);
    }
  };
  started.onerror = (event) => {
    discard(started, "module", `solver: ${event.message || "its worker could not be loaded"}`);
  };
  return started;
}

function discard(broken, code, why, values) {
  broken.terminate();
  if (worker === broken) worker = null;
  for (const { reject } of jobs.values()) reject(new StageFailure(code, why, values));
  jobs.clear();
}
