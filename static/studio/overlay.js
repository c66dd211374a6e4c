// Markers drawn over a picture of the head, with the picture's own camera.
import { fitted } from "../drawing/lines.js";

/// Where a point (metres) lies on a canvas: [x, y, depth 0..1].
export function project(camera, [x, y, z], width, height) {
  const row = (r) => camera[r] * x + camera[4 + r] * y + camera[8 + r] * z + camera[12 + r];
  const w = row(3);
  return [(row(0) / w / 2 + 0.5) * width, (0.5 - row(1) / w / 2) * height, row(2) / w];
}

/// What the markers ask (open circles), where the skin is (dots), and the way between: `points` holds
/// six numbers per marker.
export function drawMatch(canvas, camera, points) {
  const { context, width, height } = fitted(canvas);
  for (let i = 0; i + 5 < points.length; i += 6) {
    const is = project(camera, points.subarray(i + 3, i + 6), width, height);
    dot(context, is, 2.2, "#ffd34d");
    if (!Number.isFinite(points[i])) continue;
    const asked = project(camera, points.subarray(i, i + 3), width, height);
    context.strokeStyle = "#ffffff";
    context.lineWidth = 1.4;
    context.beginPath();
    context.moveTo(asked[0], asked[1]);
    context.lineTo(is[0], is[1]);
    context.stroke();
    ring(context, asked, 4, "#ffffff");
  }
}

/// The colour of how sure a suggested place is, 0 to 1.
export const sureColour = (sure) => (sure >= 0.7 ? "#57c785" : sure >= 0.4 ? "#ffd34d" : "#ff8f4d");

/// The markers of a map on the neutral head, suggested ones in the colour of how sure they are; the chosen one stands out.
export function drawMap(canvas, camera, markers, chosen, confidences) {
  const { context, width, height } = fitted(canvas);
  for (const { label, position, head } of markers) {
    if (!position) continue;
    const at = project(camera, position, width, height);
    const own = label === chosen;
    dot(context, at, own ? 6 : 3.5, own ? "#ff5a5f" : head ? "#6fd3ff" : confidences.has(label) ? sureColour(confidences.get(label)) : "#ffd34d");
    ring(context, at, own ? 9 : 4.5, "rgb(0 0 0 / 55%)");
    if (own) {
      context.font = "600 14px system-ui, sans-serif";
      context.lineWidth = 3;
      context.strokeStyle = "rgb(0 0 0 / 75%)";
      context.strokeText(label, at[0] + 12, at[1] + 5);
      context.fillStyle = "#ffffff";
      context.fillText(label, at[0] + 12, at[1] + 5);
    }
  }
}

/// Whether skin with this normal faces the picture's camera.
export function facesCamera(camera, [x, y, z]) {
  // The fourth row grows along the line of sight.
  return camera[3] * x + camera[7] * y + camera[11] * z < 0;
}

/// A layout: numbered dots, those on the far side faint, head markers as dark ones without a number.
export function drawLayout(canvas, camera, { markers, head }, chosen) {
  const { context, width, height } = fitted(canvas);
  const at = (position) => project(camera, position, width, height);
  for (const { position } of head) {
    dot(context, at(position), 5, "#1d3557");
    ring(context, at(position), 5, "#ffffff");
  }
  context.textAlign = "center";
  context.textBaseline = "middle";
  const size = Math.min(1, width / 420);
  const each = markers.map((marker, index) => ({ ...marker, index }));
  // Those in front are drawn last, the chosen one on top.
  each.sort((a, b) => (a.index === chosen) - (b.index === chosen) || at(b.position)[2] - at(a.position)[2]);
  for (const { position, normal, allowed, index } of each) {
    const place = at(position);
    const own = index === chosen;
    context.globalAlpha = own || !normal || facesCamera(camera, normal) ? 1 : 0.25;
    const radius = size * (own ? 11 : 9);
    dot(context, place, radius, own ? "#b3001b" : "#ffd34d");
    ring(context, place, radius, allowed ? "rgb(0 0 0 / 70%)" : "#b3001b");
    context.font = `600 ${size * (own ? 12.5 : 11)}px system-ui, sans-serif`;
    context.fillStyle = own ? "#ffffff" : "#000000";
    context.fillText(String(index + 1), place[0], place[1] + 0.5);
  }
  context.globalAlpha = 1;
}

function dot(context, [x, y], radius, colour) {
  context.fillStyle = colour;
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fill();
}

function ring(context, [x, y], radius, colour) {
  context.strokeStyle = colour;
  context.lineWidth = 1.4;
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.stroke();
}
