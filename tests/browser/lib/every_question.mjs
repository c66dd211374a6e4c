// A study with every type of question, a sign-language video, a picture, and a clip beside another.

import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { recordVideo } from "./record_video.mjs";
import { small, stimuli, text, trials } from "./small_study.mjs";

const option = (value) => ({ value, label: text(value) });
const video = { en: "sign.webm", fr: "sign.webm" };
const signed = (value) => ({ ...option(value), video });
const scale = { numItems: 7, leftLabel: text("weak"), rightLabel: text("strong") };
export const questions = [
  { id: "single", type: "singleChoice", prompt: text("One of these?"), video, options: [signed("a"), { ...option("b"), image: "dot.svg" }, option("c")] },
  { id: "several", type: "multipleChoice", prompt: text("Any of these?"), help: text("Choose some."), options: ["a", "b", "c"].map(option) },
  { id: "likert", type: "likert", prompt: text("How strong?"), ...scale, signs: [signed("weak"), signed("strong")] },
  { id: "slider", type: "slider", prompt: text("How tired?"), minimum: 0, maximum: 100, leftLabel: text("not"), rightLabel: text("very"), signs: [signed("not"), { ...option("very"), image: "dot.svg" }] },
  { id: "matrix", type: "matrix", prompt: text("How often?"), rows: [signed("play"), option("call")], options: [signed("never"), option("sometimes"), option("often")] },
  { id: "number", type: "number", prompt: text("How old?"), minimum: 0, maximum: 120, integer: true, unit: text("years") },
  { id: "short", type: "shortText", prompt: text("In a word?") },
  { id: "long", type: "longText", prompt: text("In some words?"), required: false },
  { id: "ranking", type: "ranking", prompt: text("In which order?"), options: [signed("eyes"), option("mouth"), option("skin")] },
  { id: "grid", type: "valenceArousal", prompt: text("How do you feel?"), leftLabel: text("bad"), rightLabel: text("good"), bottomLabel: text("calm"), topLabel: text("excited"), signs: [signed("bad")] },
  { id: "extremes", type: "bestWorst", prompt: text("Which are the extremes?"), bestLabel: text("most lifelike"), worstLabel: text("least lifelike"), options: [signed("eyes"), option("mouth"), option("skin")] },
];
export const study = small("access", {
  demographics: { title: text("About you"), questions },
  instructions: [{ heading: text("Before you begin"), text: text("Watch.") }],
  questions: [{ id: "nearer", type: "comparison", prompt: text("Which is nearer?"), allowSame: true, signs: [signed("left"), signed("right")] }, { id: "rating", type: "likert", prompt: text("How strong is it?"), ...scale }],
  components: { pairs: { ...trials(["joy2.box.head"], ["nearer", "rating"]), beside: { avatar: "actor", method: "real", caption: text("The person") } } },
  sequence: { order: "fixed", components: ["pairs"] },
  debriefing: [{ heading: text("What it was about"), text: text("Faces.") }],
  stimuli: stimuli(
    { head: { builtin: { seed: 1 } }, actor: { builtin: { actor: 7 }, look: "reference" } },
    { box: { method: "box" }, real: { method: "recorded" } },
    [["head", "box"], ["actor", "real"]],
  ),
});

/** Writes a study and the files that it shows into a new folder; its path. `page` makes the video. */
export async function written(page, study) {
  const folder = mkdtempSync(join(tmpdir(), "mimique-access-"));
  writeFileSync(join(folder, "access.json"), JSON.stringify(study));
  writeFileSync(join(folder, "dot.svg"), '<svg xmlns="http://www.w3.org/2000/svg" width="40" height="40"><circle cx="20" cy="20" r="15"/></svg>');
  writeFileSync(join(folder, "sign.webm"), (await recordVideo(page)).bytes);
  return join(folder, "access.json");
}
