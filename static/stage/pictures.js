// The pictures on an avatar's surfaces: JPEG files at the end of its pack, decoded by the browser.
// `crates/avatar/src/pack/mod.rs` describes the pack.

import { StageFailure } from "./failure.js";

const AS_STORED = { colorSpaceConversion: "none", premultiplyAlpha: "none" };
const kept = new WeakMap();

/// {widths: Uint32Array, pixels: [Uint8Array]} of an avatar pack, RGBA rows from the top.
export function picturesOf(pack) {
  let pictures = kept.get(pack);
  if (!pictures) {
    pictures = decodeAll(pack);
    kept.set(pack, pictures);
    pictures.catch(() => kept.delete(pack));
  }
  return pictures;
}

async function decodeAll(pack) {
  const widths = [];
  const pixels = [];
  for (const [jpeg, mask] of files(pack)) {
    const picture = await decode(jpeg);
    if (mask.length > 0) {
      const open = await decode(mask);
      if (open.width !== picture.width || open.height !== picture.height) {
        throw new StageFailure("picture", "avatar: a mask of another size than its picture; prepare the avatar again");
      }
      for (let at = 0; at < picture.data.length; at += 4) picture.data[at + 3] = open.data[at];
    }
    widths.push(picture.width);
    pixels.push(new Uint8Array(picture.data.buffer));
  }
  return { widths: Uint32Array.from(widths), pixels };
}

// Pairs of a JPEG file and its mask: the files, then their lengths, then the number of pairs. A
// damaged pack has none here; the canvas module says what is wrong with it.
function files(pack) {
  const view = new DataView(pack.buffer, pack.byteOffset, pack.byteLength);
  const count = pack.length < 4 ? 0 : view.getUint32(pack.length - 4, true);
  const table = pack.length - 4 - 8 * count;
  if (table < 0) return [];
  const lengths = Array.from({ length: 2 * count }, (_, i) => view.getUint32(table + 4 * i, true));
  let at = table - lengths.reduce((sum, length) => sum + length, 0);
  if (at < 0) return [];
  const parts = lengths.map((length) => pack.subarray(at, (at += length)));
  return Array.from({ length: count }, (_, i) => [parts[2 * i], parts[2 * i + 1]]);
}

async function decode(file) {
  const bitmap = await createImageBitmap(new Blob([file], { type: "image/jpeg" }), AS_STORED).catch(() => {
    throw new StageFailure("picture", "avatar: a picture that this browser cannot decode; export it again");
  });
  try {
    const context = surface(bitmap.width, bitmap.height);
    context.drawImage(bitmap, 0, 0);
    const image = context.getImageData(0, 0, bitmap.width, bitmap.height);
    // Browsers that guard against fingerprinting answer other pixels than were drawn.
    probe();
    return image;
  } finally {
    bitmap.close();
  }
}

function surface(width, height) {
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width, height });
  const context = canvas.getContext("2d", { willReadFrequently: true });
  if (!context) throw new StageFailure("memory", `avatar: no room for a picture of ${width} x ${height}; close other pages`);
  return context;
}

function probe() {
  const context = surface(16, 16);
  context.fillStyle = "rgb(40, 120, 200)";
  context.fillRect(0, 0, 16, 16);
  const { data } = context.getImageData(0, 0, 16, 16);
  for (let at = 0; at < data.length; at += 4) {
    const off = Math.max(Math.abs(data[at] - 40), Math.abs(data[at + 1] - 120), Math.abs(data[at + 2] - 200));
    if (off > 4) {
      throw new StageFailure(
        "picture_hidden",
        "avatar: this browser hides pictures from pages (its protection against fingerprinting); " +
          "allow this page to read canvases, or use another browser",
      );
    }
  }
}
