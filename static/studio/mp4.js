// An MP4 file of encoded pictures (ISO/IEC 14496-12 and -15): the tables first, so that it plays while it loads, then
// the pictures.

/// Ticks of the file's clock per picture.
const TICKS = 1000;

/// The file. `description` is the decoder's configuration record; `chunks`: {us: its time, isKey, bytes} as encoded.
export function mp4({ width, height, rate, codec, description }, chunks) {
  const clock = rate * TICKS;
  const length = chunks.length * TICKS;
  const head = box("ftyp", text("isom"), u32(512), text("isomiso2avc1mp41"));
  // Places are four bytes each: the tables are as long whatever they are.
  const tables = (from) => moov({ width, height, rate, clock, length, codec, description, from }, chunks);
  const from = size(head) + size(tables(0)) + 8;
  const bytes = chunks.map((chunk) => chunk.bytes);
  return joined([head, tables(from), [u32(8 + size(bytes)), text("mdat"), ...bytes]].flat());
}

function moov({ width, height, rate, clock, length, codec, description, from }, chunks) {
  const matrix = [0x10000, 0, 0, 0, 0x10000, 0, 0, 0, 0x40000000].map(u32);
  const mvhd = full("mvhd", 0, u32(0), u32(0), u32(clock), u32(length), u32(0x10000), u16(0x100), zeros(10), ...matrix, zeros(24), u32(2));
  const tkhd = full("tkhd", 3, u32(0), u32(0), u32(1), u32(0), u32(length), zeros(8), u16(0), u16(0), u16(0), u16(0), ...matrix, u32(width * 0x10000), u32(height * 0x10000));
  const mdhd = full("mdhd", 0, u32(0), u32(0), u32(clock), u32(length), u16(0x55c4), u16(0));
  const hdlr = full("hdlr", 0, u32(0), text("vide"), zeros(12), text("Mimique\0"));
  const dinf = box("dinf", full("dref", 0, u32(1), full("url ", 1)));
  const entry = box(codec, zeros(6), u16(1), zeros(16), u16(width), u16(height), u32(0x480000), u32(0x480000), u32(0), u16(1), zeros(32), u16(24), u16(0xffff), box("avcC", description ?? zeros(0)));
  // A picture that is shown later than its place among the encoded ones has the difference written beside it.
  const late = chunks.map(({ us }, i) => (Math.round((us * rate) / 1e6) - i) * TICKS);
  const keys = chunks.flatMap(({ isKey }, i) => (isKey ? [u32(i + 1)] : []));
  let at = from;
  const places = chunks.map(({ bytes }) => u32((at += bytes.length) - bytes.length));
  const stbl = box(
    "stbl",
    full("stsd", 0, u32(1), entry),
    full("stts", 0, u32(1), u32(chunks.length), u32(TICKS)),
    late.some((ticks) => ticks !== 0) ? full("ctts", 0x01000000, u32(chunks.length), ...late.flatMap((ticks) => [u32(1), u32(ticks >>> 0)])) : [],
    full("stss", 0, u32(keys.length), ...keys),
    full("stsc", 0, u32(1), u32(1), u32(1), u32(1)),
    full("stsz", 0, u32(0), u32(chunks.length), ...chunks.map(({ bytes }) => u32(bytes.length))),
    full("stco", 0, u32(chunks.length), ...places),
  );
  const minf = box("minf", full("vmhd", 1, zeros(8)), dinf, stbl);
  return box("moov", mvhd, box("trak", tkhd, box("mdia", mdhd, hdlr, minf)));
}

// A box is a list of bytes: its length, its name, what it holds.
function box(name, ...parts) {
  const content = parts.flat();
  return [u32(8 + size(content)), text(name), ...content];
}

// A box with a version and flags.
const full = (name, flags, ...parts) => box(name, u32(flags), ...parts);

function u32(value) {
  const out = new Uint8Array(4);
  new DataView(out.buffer).setUint32(0, value);
  return out;
}

function u16(value) {
  const out = new Uint8Array(2);
  new DataView(out.buffer).setUint16(0, value);
  return out;
}

const zeros = (count) => new Uint8Array(count);
const text = (words) => Uint8Array.from(words, (letter) => letter.charCodeAt(0));
const size = (parts) => parts.reduce((sum, part) => sum + part.length, 0);

function joined(parts) {
  const out = new Uint8Array(size(parts));
  let at = 0;
  for (const part of parts) {
    out.set(part, at);
    at += part.length;
  }
  return out;
}
