// Calls of the studio's worker as promises. JSON answers come parsed.

import { moduleWorker } from "../module-worker.js";
import { sendPanic } from "../panics.js";
import { say } from "./texts.js";
import { problemWords } from "./words-engine.js";

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
      const words = data.problem ? problemWords(JSON.parse(data.problem)) : data.error;
      job.reject(new Error(data.panicked ? say("worker.broke", { reason: words }) : words));
    }
  };
  started.onerror = (event) => {
    const reason = new Error(say("worker.unloaded", { reason: event.message || say("worker.absent") }));
    for (const { reject } of jobs.values()) reject(reason);
    jobs.clear();
  };
  return started;
}
