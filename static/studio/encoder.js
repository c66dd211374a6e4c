// A video of pictures with the browser's encoder (WebCodecs): how long drawing takes, and how busy the machine is,
// leaves no trace in it. The file is WebM, or MP4 where the browser has H.264.
import { mp4 } from "./mp4.js";
import { say } from "./texts.js";
import { webm } from "./webm.js";

/// Kinds of files: their name, codecs in the order of preference with the file's own name for each, and who writes the file.
const FORMATS = {
  webm: { name: "WebM", codecs: [["vp09.00.51.08", "V_VP9"], ["vp8", "V_VP8"]], write: webm },
  mp4: { name: "MP4", codecs: [["avc1.640028", "avc1"], ["avc1.640033", "avc1"], ["avc1.640034", "avc1"]], write: mp4, more: { avc: { format: "avc" } } },
};
/// Bits for each pixel, and for small pictures at least.
const BITS_PER_PIXEL = 0.12;
const LEAST_BITS_PER_SECOND = 8_000_000;
/// A player can jump to every so many pictures.
const KEY_EVERY = 30;
/// So many pictures may wait for the encoder.
const WAITING = 4;

/// Whether the browser writes a kind of file in this size.
export async function canEncode(format, width, height, rate) {
  return Boolean(globalThis.VideoEncoder) && (await supported(FORMATS[format], configOf(width, height, rate))) !== null;
}

const configOf = (width, height, rate) => ({
  width, height, framerate: rate, latencyMode: "quality", bitrate: Math.max(LEAST_BITS_PER_SECOND, Math.round(BITS_PER_PIXEL * width * height * rate)),
});

/// Videos what `picture(i)` (an ImageBitmap) shows for i in 0..count, `rate` pictures a second, as a `format`; the file's
/// bytes. `done(i)` is told of each picture.
export async function encodedVideo({ format, count, rate, picture, done }) {
  if (!globalThis.VideoEncoder) throw new Error(say("video.no-encoder"));
  const kind = FORMATS[format];
  const first = await picture(0);
  const { width, height } = first;
  const config = { ...configOf(width, height, rate), ...kind.more };
  const codec = await supported(kind, config);
  if (!codec) throw new Error(say("video.no-size", { format: kind.name, width, height }));
  const chunks = [];
  let failed = null;
  let description = null;
  const encoder = new VideoEncoder({
    output: (chunk, told) => {
      const bytes = new Uint8Array(chunk.byteLength);
      chunk.copyTo(bytes);
      description ??= told?.decoderConfig?.description ?? null;
      chunks.push({ us: chunk.timestamp, isKey: chunk.type === "key", bytes });
    },
    error: (error) => (failed = new Error(say("video.failed", { why: error.message }))),
  });
  try {
    encoder.configure({ ...config, codec: codec[0] });
    await encodeAll(encoder, { count, rate, first, picture, done, failed: () => failed });
  } finally {
    if (encoder.state !== "closed") encoder.close();
  }
  return kind.write({ width, height, rate, codec: codec[1], description: bytesOf(description), durationMs: (1000 * count) / rate }, chunks);
}

// A buffer, or a view of one.
const bytesOf = (source) => (source === null ? null : ArrayBuffer.isView(source) ? new Uint8Array(source.buffer, source.byteOffset, source.byteLength) : new Uint8Array(source));

async function encodeAll(encoder, { count, rate, first, picture, done, failed }) {
  for (let i = 0; i < count && !failed(); i++) {
    const bitmap = i === 0 ? first : await picture(i);
    const frame = new VideoFrame(bitmap, { timestamp: Math.round((1e6 * i) / rate), duration: Math.round(1e6 / rate) });
    encoder.encode(frame, { keyFrame: i % KEY_EVERY === 0 });
    frame.close();
    bitmap.close();
    done(i);
    while (encoder.encodeQueueSize > WAITING && !failed()) await new Promise((resolve) => setTimeout(resolve, 1));
  }
  if (!failed()) {
    await encoder.flush().catch((error) => {
      throw failed() ?? error;
    });
  }
  if (failed()) throw failed();
}

async function supported({ codecs, more }, config) {
  for (const codec of codecs) {
    const answer = await VideoEncoder.isConfigSupported({ ...config, ...more, codec: codec[0] }).catch(() => null);
    if (answer?.supported) return codec;
  }
  return null;
}

