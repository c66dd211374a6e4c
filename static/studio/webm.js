// A WebM file of encoded pictures, each at its exact time.

/// The file (https://www.webmproject.org/docs/container/): header, length, track, where its key pictures
/// are, then the pictures. `chunks`: {us: its time, isKey, bytes} in order of time.
export function webm({ width, height, rate, codec, durationMs }, encoded) {
  const chunks = encoded.map(({ us, ...chunk }) => ({ ms: Math.round(us / 1000), ...chunk }));
  const header = element("1a45dfa3", [
    element("4286", uint(1)), element("42f7", uint(1)), element("42f2", uint(4)), element("42f3", uint(8)),
    element("4282", ascii("webm")), element("4287", uint(4)), element("4285", uint(2)),
  ]);
  const info = element("1549a966", [
    element("2ad7b1", uint(1_000_000)), element("4489", float(durationMs)), element("4d80", ascii("Mimique")), element("5741", ascii("Mimique")),
  ]);
  const video = element("e0", [element("b0", uint(width)), element("ba", uint(height))]);
  const tracks = element("1654ae6b", [
    element("ae", [
      element("d7", uint(1)), element("73c5", uint(1)), element("83", uint(1)), element("86", ascii(codec)),
      element("23e383", uint(Math.round(1e9 / rate))), video,
    ]),
  ]);
  const groups = [];
  for (const chunk of chunks) {
    if (chunk.isKey || groups.length === 0) groups.push([]);
    groups.at(-1).push(chunk);
  }
  const clusters = groups.map((group) => element("1f43b675", [element("e7", uint(group[0].ms)), ...group.map((chunk) => block(chunk, group[0].ms))]));
  // Places are written in eight bytes, so that the list of them is as long whatever they are.
  const cues = (places) =>
    element("1c53bb6b", groups.map((group, i) => element("bb", [element("b3", uint(group[0].ms)), element("b7", [element("f7", uint(1)), element("f1", uint(places[i], 8))])])));
  const places = [];
  let at = length(info) + length(tracks) + length(cues(groups.map(() => 0)));
  for (const cluster of clusters) {
    places.push(at);
    at += length(cluster);
  }
  return joined([header, element("18538067", [info, tracks, cues(places), ...clusters])]);
}

// One picture: track, time after its cluster's, whether it stands alone.
function block({ ms, isKey, bytes }, from) {
  const head = new Uint8Array(4);
  const view = new DataView(head.buffer);
  view.setUint8(0, 0x81);
  view.setInt16(1, ms - from);
  view.setUint8(3, isKey ? 0x80 : 0);
  return element("a3", [head, bytes]);
}

// An element is a list of bytes: its name, its length in eight bytes, what it holds.
function element(name, parts) {
  const content = Array.isArray(parts) ? parts.flat() : [parts];
  const size = uint(length(content), 8);
  size[0] = 0x01;
  return [Uint8Array.from(name.match(/../g), (byte) => Number.parseInt(byte, 16)), size, ...content];
}

function uint(value, bytes = 4) {
  const out = new Uint8Array(bytes);
  for (let i = bytes - 1, rest = value; i >= 0; i--, rest = Math.floor(rest / 256)) out[i] = rest % 256;
  return out;
}

function float(value) {
  const out = new Uint8Array(8);
  new DataView(out.buffer).setFloat64(0, value);
  return out;
}

const ascii = (text) => Uint8Array.from(text, (letter) => letter.charCodeAt(0));

function length(parts) {
  return parts.reduce((sum, part) => sum + part.length, 0);
}

function joined(parts) {
  const flat = parts.flat();
  const out = new Uint8Array(length(flat));
  let at = 0;
  for (const part of flat) {
    out.set(part, at);
    at += part.length;
  }
  return out;
}
