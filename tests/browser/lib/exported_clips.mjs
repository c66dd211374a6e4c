// A small study exported as files: one performance by two methods, for pages that embed its clips.

import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { mimique } from "./server.mjs";
import { small, stimuli, text, trials } from "./small_study.mjs";

/** `{folder, clips}`: the folder of `mimique export-site`, and the descriptions in its site.json. */
export function exportedClips() {
  const folder = mkdtempSync(join(tmpdir(), "mimique-clips-"));
  const rating = { id: "rating", type: "likert", prompt: text("How strong?"), numItems: 7, leftLabel: text("weak"), rightLabel: text("strong") };
  const study = small("clips", {
    questions: [rating],
    components: { faces: trials(["joy2.box", "joy2.soft"], ["rating"]) },
    sequence: { order: "fixed", components: ["faces"] },
    staticHosting: { download: true },
    stimuli: stimuli({ head: { builtin: { seed: 1 } } }, { box: { method: "box" }, soft: { method: "lsts", alpha: 0.7 } }, [["head", "box"], ["head", "soft"]]),
  });
  const file = join(folder, "clips.json");
  writeFileSync(file, JSON.stringify(study));
  const pages = process.env.MIMIQUE_WEB_DIR ? ["--web-dir", process.env.MIMIQUE_WEB_DIR] : [];
  mimique(["export-site", file, "--out", join(folder, "site"), "--packs", join(folder, "packs"), ...pages]);
  const site = JSON.parse(readFileSync(join(folder, "site/site.json"), "utf8"));
  return { folder: join(folder, "site"), clips: site.bundle.clips };
}
