// Calls of the studio's worker as promises. JSON answers come parsed.

import { moduleWorker } from "../module-worker.js";
import { sendPanic } from "../panics.js";

const JSON_CALLS = new Set([
  "avatarFile", "builtInAvatar", "takeFile", "builtInTake", "mapFile", "suggestMap", "place", "setNeutral",
  "mapState", "capturePoints", "solve", "difference", "differenceOver", "suggestExpressions", "setExpressions", "expressionsFile", "methods",
  "trainingTake", "trainingWeights", "builtInTraining", "setTrainingNeutral", "trainingState",
  "restGaze", "holdGaze", "gazeAtMarker", "gazeFile",
  "labelModel", "suggestLabels", "learnLabels", "confirmLabel", "releaseLabel", "relabel", "moveLabel", "labelsState", "restoreLabels",
  "labelsFromExpressions", "labelsToExpressions",
  "makeLayout", "layoutFile", "layoutFromMap", "moveLayoutMarker", "dropLayoutMarker", "undoLayout", "rehearseLayout",
  "layoutState", "exertion", "exertionFile", "exertionModel", "studyLibrary", "study",
]);

// Calls after which the worker has forgotten what was solved: for the avatar or take before, or for a face that was removed.
const FORGETTING = new Set(["avatarFile", "builtInAvatar", "takeFile", "builtInTake", "forget"]);

/// Why a call about a solved face failed: the face was forgotten after the call was made.
export class Forgotten extends Error {}

// How problems are said: in English, until a page says that it has words of its own.
let words = {
  problem: ({ place, text }) => (place === null ? text : `${place}: ${text}`),
  broke: (reason) => `${reason}; the studio's worker broke: reload the page`,
  unloaded: (reason) => `${reason || "the studio's worker could not be loaded"}; reload the page`,
};

/// Has problems said by others' words: {problem({place, text, is}), broke(reason), unloaded(reason)}.
export function sayProblems(others) {
  words = others;
}

let worker = null;
let next = 1;
const jobs = new Map();
// How often the worker has forgotten solved faces.
let forgotten = 0;

/// Calls a method of the worker's `Studio`.
export function callWorker(call, ...args) {
  worker ??= start();
  const id = next++;
  return new Promise((resolve, reject) => {
    jobs.set(id, { call, forgotten, resolve, reject });
    worker.postMessage({ id, call, args });
  });
}

function start() {
  const started = moduleWorker(new URL("./worker.js", import.meta.url));
  started.onmessage = ({ data }) => {
    if (data.panic) return sendPanic(data.panic);
    const job = jobs.get(data.id);
    jobs.delete(data.id);
    if (data.error === undefined) {
      if (FORGETTING.has(job.call)) forgotten += 1;
      job.resolve(JSON_CALLS.has(job.call) ? JSON.parse(data.result) : data.result);
    } else {
      const problem = data.problem ? JSON.parse(data.problem) : null;
      const reason = problem ? words.problem(problem) : data.error;
      const isForgotten = problem?.is.code === "nothing-solved" && job.forgotten < forgotten;
      job.reject(isForgotten ? new Forgotten(reason) : new Error(data.panicked ? words.broke(reason) : reason));
    }
  };
  started.onerror = (event) => {
    const reason = new Error(words.unloaded(event.message));
    for (const { reject } of jobs.values()) reject(reason);
    jobs.clear();
  };
  return started;
}
