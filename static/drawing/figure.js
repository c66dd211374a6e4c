// A body as a stick figure, from its right side and from the front, on a floor line.
import { fitted } from "./lines.js";

const BONES = [
  ["Hip", "Knee"], ["Knee", "Ankle"], ["Ankle", "Toe"], ["Shoulder", "Elbow"], ["Elbow", "Wrist"], ["Wrist", "HandEnd"],
];
/// What stands above the diaphragm rises with a breath.
const RISES = /Neck|headTop|neck|Shoulder|Elbow|Wrist|HandEnd/;
/// An illustration of the breath: how far a full breath lifts the shoulders and widens the chest, mm.
const RISE = 14;
const CHEST = { side: [95, 30], front: [140, 14], high: 190 };
const AROUND = 120;

/// The joints at a time of the window, s: by name, [to the body's left, up, forwards], mm.
function jointsAt({ joints, millimetres, rateHz, periodS }, seconds, lungs) {
  const width = 3 * joints.length;
  const last = millimetres.length / width - 1;
  const place = Math.min(Math.max((periodS === null ? seconds : seconds % periodS) * rateHz, 0), last);
  const low = Math.floor(place);
  const [before, after] = [low * width, Math.min(low + 1, last) * width];
  const part = place - low;
  return new Map(joints.map((name, j) => {
    const at = (axis) => millimetres[before + 3 * j + axis] * (1 - part) + millimetres[after + 3 * j + axis] * part;
    return [name, [at(0), at(1) + (RISES.test(name) ? RISE * lungs : 0), at(2)]];
  }));
}

const middle = (a, b) => a.map((value, axis) => (value + b[axis]) / 2);

/// Draws the body at a time of the window. `lungs`: what is in them of a breath, 0 to 1.
export function drawFigure(canvas, figure, seconds, lungs) {
  const { context, width, height } = fitted(canvas);
  const css = getComputedStyle(canvas);
  const [ink, soft, accent] = ["--ink", "--line-strong", "--accent"].map((name) => css.getPropertyValue(name));
  const joints = jointsAt(figure, seconds, lungs);
  const tall = highest(figure);
  const [top, bottom] = [24, 14];
  // A step is three quarters as long as the body is tall.
  const scale = Math.min((height - top - bottom) / (tall + AROUND), width / 2 / (0.76 * tall));
  // While the page is being laid out the canvas may have no room: nothing is drawn then.
  if (scale <= 0) return;
  const floor = height - bottom;
  context.lineCap = context.lineJoin = "round";
  context.strokeStyle = soft;
  context.lineWidth = 1;
  context.beginPath();
  context.moveTo(8, floor);
  context.lineTo(width - 8, floor);
  context.stroke();
  context.font = "12px system-ui, sans-serif";
  context.fillStyle = css.getPropertyValue("--ink-soft");
  context.textAlign = "center";
  for (const [view, axis, words] of [["side", 2, "from its right"], ["front", 0, "from the front"]]) {
    const centre = width * (view === "side" ? 0.25 : 0.75);
    context.fillText(words, centre, 14);
    body(context, { joints, view, lungs, scale, colours: { near: ink, far: soft, chest: accent }, to: (point) => [centre + point[axis] * scale, floor - point[1] * scale] });
  }
  context.textAlign = "start";
}

// The height of the body as it stands most upright.
function highest(figure) {
  figure.tall ??= figure.millimetres.reduce((most, value, i) => (i % 3 === 1 && value > most ? value : most), 1);
  return figure.tall;
}

function body(context, { joints, view, lungs, scale, colours, to }) {
  const line = (colour, thick, ...points) => {
    context.strokeStyle = colour;
    context.lineWidth = thick;
    context.beginPath();
    points.forEach((point, i) => context[i === 0 ? "moveTo" : "lineTo"](...to(point)));
    context.stroke();
  };
  const limbs = (side, colour) => {
    for (const bone of BONES) {
      const ends = bone.map((end) => joints.get(`${side}${end}`));
      if (ends.every(Boolean)) line(colour, 3, ...ends);
    }
  };
  const pelvis = middle(joints.get("leftHip"), joints.get("rightHip"));
  const neck = joints.get("neck");
  const head = joints.get("headTop");
  // What is on the far side is paler; from the front both are near.
  limbs("left", view === "side" ? colours.far : colours.near);
  line(colours.near, 3, joints.get("leftHip"), joints.get("rightHip"));
  line(colours.near, 3, joints.get("leftShoulder"), neck, joints.get("rightShoulder"));
  line(colours.near, 3, pelvis, neck);
  const [wide, wider] = CHEST[view];
  const chest = pelvis.map((value, axis) => value + 0.68 * (neck[axis] - value));
  const lean = Math.atan2(...[0, 1].map((i) => to(neck)[i] - to(pelvis)[i]));
  context.strokeStyle = colours.chest;
  context.lineWidth = 2;
  context.beginPath();
  context.ellipse(...to(chest), (wide + wider * lungs) * scale, CHEST.high * scale, Math.PI - lean, 0, 2 * Math.PI);
  context.stroke();
  const from = to(neck);
  const crown = to(head);
  const radius = 0.4 * Math.hypot(crown[0] - from[0], crown[1] - from[1]);
  context.strokeStyle = colours.near;
  context.lineWidth = 3;
  context.beginPath();
  context.arc(from[0] + 0.6 * (crown[0] - from[0]), from[1] + 0.6 * (crown[1] - from[1]), radius, 0, 2 * Math.PI);
  context.stroke();
  limbs("right", colours.near);
}
