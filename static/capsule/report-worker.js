// The statistics of a capsule: speaks with capsule/changes.js.
//   in   {csv, study, published, stimuli, preview, language}: texts; `published` is the study file of the capsule
//   out  {files: {path: text}, summary}, or {error}
import init, { analyze } from "../report.js";

const ready = init();

self.onmessage = async ({ data: { csv, study, published, stimuli, preview, language } }) => {
  try {
    await ready;
    const report = analyze(csv, study, published, stimuli, preview, language);
    const files = Object.fromEntries(report.files().map((path) => [path, report.file(path)]));
    self.postMessage({ files, summary: JSON.parse(report.summary()) });
    report.free();
  } catch (error) {
    self.postMessage({ error: String(error?.message ?? error) });
  }
};
