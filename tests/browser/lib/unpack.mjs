// Unpacks a ZIP archive, as people do before they open what is in it.

import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { inflateRawSync } from "node:zlib";

/** Writes the files of an archive below a folder; returns their paths. */
export function unpack(archive, folder) {
  const bytes = readFileSync(archive);
  // The end of the central directory has its number of entries and its place.
  const end = bytes.lastIndexOf(Buffer.from("PK\x05\x06"));
  const names = [];
  let at = bytes.readUInt32LE(end + 16);
  for (let count = bytes.readUInt16LE(end + 10); count > 0; count--) {
    const [method, packed] = [bytes.readUInt16LE(at + 10), bytes.readUInt32LE(at + 20)];
    const [name, extra, comment] = [28, 30, 32].map((place) => bytes.readUInt16LE(at + place));
    const path = bytes.toString("utf8", at + 46, at + 46 + name);
    const local = bytes.readUInt32LE(at + 42);
    const body = local + 30 + bytes.readUInt16LE(local + 26) + bytes.readUInt16LE(local + 28);
    const data = bytes.subarray(body, body + packed);
    mkdirSync(dirname(join(folder, path)), { recursive: true });
    writeFileSync(join(folder, path), method === 8 ? inflateRawSync(data) : data);
    names.push(path);
    at += 46 + name + extra + comment;
  }
  return names;
}
