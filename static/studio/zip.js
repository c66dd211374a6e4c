// Files put into one archive as they are (pictures do not get smaller). Each goes into the browser's own
// store at once, so that a long sequence needs no more memory than a picture.
//
// It stands here and not in a library (client-zip) because the pages are built without node, too: a library
// would have to be copied into the repository, or the studio built without node would save no pictures.

const LIMIT = 0xffff_ffff;
const MOST_FILES = 0xffff;
// 1 January 1980: the same pictures give the same archive.
const DATE = 0x21;

const CRC = Uint32Array.from({ length: 256 }, (_, byte) => {
  let value = byte;
  for (let bit = 0; bit < 8; bit++) value = value & 1 ? 0xedb88320 ^ (value >>> 1) : value >>> 1;
  return value;
});

function checksum(bytes) {
  let value = -1;
  for (const byte of bytes) value = CRC[(value ^ byte) & 0xff] ^ (value >>> 8);
  return ~value >>> 0;
}

export class Zip {
  #parts = [];
  #entries = [];
  #size = 0;

  /// Adds a file; its name is in UTF-8. Throws where an archive can hold no more.
  add(name, bytes) {
    if (this.#size + bytes.length > LIMIT - 0x1000_0000 || this.#entries.length === MOST_FILES) {
      throw new Error(`${name}: the archive is full (4 GB, ${MOST_FILES} files); export a shorter part, or fewer frames per second`);
    }
    const entry = { name: new TextEncoder().encode(name), crc: checksum(bytes), size: bytes.length, at: this.#size };
    this.#entries.push(entry);
    this.#put(record(0x04034b50, entry, 30, 4), entry.name, bytes);
  }

  /// The archive.
  finish() {
    const start = this.#size;
    for (const entry of this.#entries) {
      const head = record(0x02014b50, entry, 46, 6);
      head.setUint16(4, 20, true);
      head.setUint32(42, entry.at, true);
      this.#put(head, entry.name);
    }
    const end = new DataView(new ArrayBuffer(22));
    end.setUint32(0, 0x06054b50, true);
    end.setUint16(8, this.#entries.length, true);
    end.setUint16(10, this.#entries.length, true);
    end.setUint32(12, this.#size - start, true);
    end.setUint32(16, start, true);
    this.#put(end);
    return new Blob(this.#parts);
  }

  #put(...pieces) {
    const blob = new Blob(pieces);
    this.#size += blob.size;
    this.#parts.push(blob);
  }
}

// What stands before a file, and again in the list at the end: from `at` on both are alike.
function record(mark, { name, crc, size }, length, at) {
  const view = new DataView(new ArrayBuffer(length));
  view.setUint32(0, mark, true);
  view.setUint16(at, 20, true);
  // Names are in UTF-8.
  view.setUint16(at + 2, 0x0800, true);
  view.setUint16(at + 8, DATE, true);
  view.setUint32(at + 10, crc, true);
  view.setUint32(at + 14, size, true);
  view.setUint32(at + 18, size, true);
  view.setUint16(at + 22, name.length, true);
  return view;
}
