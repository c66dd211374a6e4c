// What two clips of a preview have not in common, and how far apart their faces are.
import { made } from "../stage/player.js";

const $ = (id) => document.getElementById(id);

export class ShownComparison {
  #told = null;
  #seek;

  /// `seek` shows a frame of the clips.
  constructor(seek) {
    this.#seek = seek;
  }

  async load(study) {
    const answer = await fetch(`/preview/${encodeURIComponent(study)}/comparison`);
    const told = await answer.json();
    if (!answer.ok) throw new Error(`${told.message}; ${told.remedy}`);
    this.#told = told;
  }

  /// The clips of both panels; null for none.
  put(a, b) {
    const of = ({ clips }) => clips.includes(a) && clips.includes(b) && a !== b;
    const difference = this.#told?.differences.find(of);
    const unlike = this.#told?.unlike.filter(of) ?? [];
    $("comparison").hidden = !difference && unlike.length === 0;
    $("comparison-unlike").replaceChildren(...unlike.map((each) => made("p", { className: "notice warn" }, words(each))));
    $("comparison-parts").replaceChildren(...(difference?.parts ?? []).map((part) => this.#row(part)));
    $("comparison-lips").textContent = difference ? lips(difference) : "";
  }

  #row({ part, rmsMm, largestMm, largestFrame }) {
    const number = (text) => made("td", { className: "number" }, text);
    const frame = made("button", { type: "button", className: "quiet", ariaLabel: `Show frame ${largestFrame}` }, String(largestFrame));
    frame.addEventListener("click", () => this.#seek(largestFrame));
    return made("tr", {}, made("th", { scope: "row" }, part), number(rmsMm.toFixed(2)), number(largestMm.toFixed(2)), number(frame));
  }
}

function lips({ clips: [first, second], lipVertexErrorMm: error, upperFaceDeviationMm2: upper, lipGapErrorMm: gap, lipClosures: closures }) {
  const said = [];
  if (error !== undefined) said.push(`Lip vertex error ${error.toFixed(2)} mm.`);
  if (gap !== undefined) said.push(`Error of the lips’ gap ${gap.toFixed(2)} mm.`);
  if (upper !== undefined) said.push(`Upper-face dynamics deviation ${upper.toFixed(2)} mm².`);
  if (closures?.shut > 0) said.push(`Of ${closures.shut} ${closures.shut === 1 ? "frame" : "frames"} in which the lips of ${first} are shut, those of ${second} are shut in ${closures.kept}.`);
  return said.join(" ");
}

function words({ what, milliseconds, ratesHz, degrees, shut, frame }) {
  if (what === "duration") return `They last ${milliseconds.map((ms) => ms.toFixed(0)).join(" and ")} ms: cut both to the same frames.`;
  if (what === "frameTimes") return `They show ${ratesHz.join(" and ")} frames per second: give the capture one "rateHz".`;
  if (what === "headPose") return `Their heads are turned ${degrees.toFixed(1)} degrees from each other in frame ${frame}: give all captures of the segment the same "headMotion".`;
  if (what === "gaze") return `Their eyes look ${degrees.toFixed(1)} degrees aside from each other in frame ${frame}: give the capture a "gaze".`;
  return `Their eyes are shut by ${shut.map((part) => part.toFixed(2)).join(" and ")} in frame ${frame}: one blinks and the other does not.`;
}
