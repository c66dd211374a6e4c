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

/// Calls a method of the worker's `Studio`.
export function callWorker(call, ...args) {
  worker ??= start();
  const id = next++;
  return new Promise((resolve, reject) => {
    jobs.set(id, { call, resolve, reject });
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
      job.resolve(JSON_CALLS.has(job.call) ? JSON.parse(data.result) : data.result);
    } else {
      const reason = data.problem ? words.problem(JSON.parse(data.problem)) : data.error;
      job.reject(new Error(data.panicked ? words.broke(reason) : reason));
    }
  };
  started.onerror = (event) => {
    const reason = new Error(words.unloaded(event.message));
    for (const { reject } of jobs.values()) reject(reason);
    jobs.clear();
  };
  return started;
}
