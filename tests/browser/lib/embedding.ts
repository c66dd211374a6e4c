// A program that embeds the npm packages: `cargo xtask package --check` compiles it against their types.
import { openStage, prepareClip, type ClipSource, type PlayLog } from "@mimique/stage";
import { MimiqueStage, StageProblem, type StageLog } from "@mimique/stage/element.js";
import Mimique from "@mimique/jspsych-plugin";
import type { MimiqueData, MimiqueParameters } from "@mimique/jspsych-plugin";
import { initJsPsych } from "jspsych";

export async function shown(canvas: HTMLCanvasElement, source: ClipSource): Promise<PlayLog> {
  const { frames } = await prepareClip("clip", source, (part: number) => console.log(part));
  const stage = await openStage(canvas, { width: 320, height: 320 });
  stage.setView({ yaw: 0.1 * frames });
  return stage.play("clip", { heard: false });
}

export async function elements(capture: File, source: ClipSource): Promise<StageLog> {
  const left: MimiqueStage = document.createElement("mimique-stage");
  Object.assign(left, { avatar: "head.glb", capture, method: { method: "lsts", alpha: 0.3 } });
  const right = document.body.appendChild(document.createElement("mimique-stage"));
  right.source = source;
  right.addEventListener("stage-onset", ({ detail }) => console.log(detail.onset_ms.toFixed(1)));
  right.addEventListener("stage-error", ({ detail }) => console.log(detail instanceof StageProblem ? detail.code : ""));
  await MimiqueStage.prepare({ src: "site/site.json", clip: "joy" });
  right.view({ yaw: 0.5 });
  await right.seek(right.duration / 2);
  // @ts-expect-error: a play has no speed
  await right.play({ speed: 2 });
  return left.play({ beside: [right], told: { frame: (now: number, ms: number) => console.log(now, ms) } });
}

export async function timeline(): Promise<void> {
  const jsPsych = initJsPsych({ on_trial_finish: (data: MimiqueData) => console.log(data.rt, data.provenance[0]) });
  const pair: MimiqueParameters = { clips: [{ src: "site/site.json", clip: "a" }, { avatar: "built-in", capture: "built-in" }], keys: ["f", "j"] };
  await Mimique.preload(pair.clips);
  await jsPsych.run([{ type: Mimique, ...pair, prompt: "<p>Which?</p>" }]);
}
