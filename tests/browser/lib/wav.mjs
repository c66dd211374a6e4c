// Sound made by code: 16-bit PCM, one channel, 8000 Hz.

const RATE = 8000;

/** A WAV of so many seconds: a tone that sounds for the first half of each second. */
export function wav(seconds, hertz) {
  const samples = Math.round(seconds * RATE);
  const bytes = Buffer.alloc(44 + 2 * samples);
  bytes.write("RIFF", 0);
  bytes.writeUInt32LE(36 + 2 * samples, 4);
  bytes.write("WAVEfmt ", 8);
  for (const [at, value, size] of [[16, 16, 4], [20, 1, 2], [22, 1, 2], [24, RATE, 4], [28, 2 * RATE, 4], [32, 2, 2], [34, 16, 2]]) {
    bytes.writeUIntLE(value, at, size);
  }
  bytes.write("data", 36);
  bytes.writeUInt32LE(2 * samples, 40);
  for (let k = 0; k < samples; k++) {
    const on = (k / RATE) % 1 < 0.5;
    bytes.writeInt16LE(on ? Math.round(6000 * Math.sin((2 * Math.PI * hertz * k) / RATE)) : 0, 44 + 2 * k);
  }
  return bytes;
}
