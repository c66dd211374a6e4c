// The desk: calls of the studio's worker as promises. JSON answers come parsed.

const JSON_CALLS = new Set([
  "avatarFile", "builtInAvatar", "takeFile", "builtInTake", "mapFile", "suggestMap", "place", "setNeutral",
  "mapState", "solve", "difference", "suggestExpressions", "setExpressions", "expressionsFile", "methods",
  "trainingTake", "trainingWeights", "builtInTraining", "setTrainingNeutral", "trainingState",
]);

let worker = null;
let next = 1;
const jobs = new Map();

/// Calls the desk; `transfer` are buffers that may go along.
export function desk(call, ...args) {
  worker ??= start();
  const id = next++;
  return new Promise((resolve, reject) => {
    jobs.set(id, { call, resolve, reject });
    worker.postMessage({ id, call, args });
  });
}

function start() {
  const started = new Worker(new URL("./studio-worker.js", import.meta.url), { type: "module" });
  started.onmessage = ({ data }) => {
    const job = jobs.get(data.id);
    jobs.delete(data.id);
    if (data.error === undefined) {
      job.resolve(JSON_CALLS.has(job.call) ? JSON.parse(data.result) : data.result);
    } else {
      const broken = /unreachable|RuntimeError|recursive use|memory access/.test(data.error);
      job.reject(new Error(broken ? `${data.error}; the studio's worker broke: reload the page` : data.error));
    }
  };
  started.onerror = (event) => {
    const reason = new Error(`${event.message || "the studio's worker could not be loaded"}; reload the page`);
    for (const { reject } of jobs.values()) reject(reason);
    jobs.clear();
  };
  return started;
}
