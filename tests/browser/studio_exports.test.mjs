// What the studio exports, opened again: pictures, recording and contact sheet show the face of their moment;
// the animation holds the weights of the table, and its head can be opened and solved.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { mimique, preview } from "./lib/server.mjs";
import { builtIn, download, fact, unfold } from "./lib/studio.mjs";

const noBrowser = skip(!executable && "Chromium not found");
const RATE = 25;
const CELL = 240;

/** The files of an archive that is not compressed, by the list at its end: [[name, bytes]]. */
function unzipped(zip) {
  const end = zip.length - 22;
  assert.equal(zip.readUInt32LE(end), 0x06054b50);
  const files = [];
  let at = zip.readUInt32LE(end + 16);
  for (let i = 0; i < zip.readUInt16LE(end + 10); i++) {
    assert.equal(zip.readUInt32LE(at), 0x02014b50);
    const [size, length, start] = [zip.readUInt32LE(at + 24), zip.readUInt16LE(at + 28), zip.readUInt32LE(at + 42)];
    const name = String(zip.subarray(at + 46, at + 46 + length));
    // The same stands before the file itself.
    assert.equal(zip.readUInt32LE(start), 0x04034b50);
    assert.deepEqual(zip.subarray(start + 4, start + 28), zip.subarray(at + 6, at + 30), name);
    const bytes = zip.subarray(start + 30 + length, start + 30 + length + size);
    assert.equal(zip.readUInt32LE(at + 16), checksum(bytes), name);
    files.push([name, bytes]);
    at += 46 + length;
  }
  assert.equal(at, end);
  return files;
}

// CRC-32, bit by bit.
function checksum(bytes) {
  let value = -1;
  for (const byte of bytes) {
    value ^= byte;
    for (let bit = 0; bit < 8; bit++) value = (value >>> 1) ^ (value & 1 ? 0xedb88320 : 0);
  }
  return ~value >>> 0;
}

/** The animation of a binary glTF file: times, and for each mesh its targets' names and weights. */
function animation(glb) {
  assert.equal(String(glb.subarray(0, 4)), "glTF");
  assert.equal(glb.readUInt32LE(8), glb.length);
  const length = glb.readUInt32LE(12);
  const gltf = JSON.parse(String(glb.subarray(20, 20 + length)));
  const binary = glb.subarray(28 + length);
  const numbers = (index) => {
    const { bufferView, byteOffset = 0, componentType, count } = gltf.accessors[index];
    assert.equal(componentType, 5126);
    const at = (gltf.bufferViews[bufferView].byteOffset ?? 0) + byteOffset;
    return Array.from({ length: count }, (_, i) => binary.readFloatLE(at + 4 * i));
  };
  assert.equal(gltf.animations.length, 1);
  const [{ channels, samplers }] = gltf.animations;
  // Gaze turns the eyeballs beside.
  return channels.filter(({ target }) => target.path === "weights").map(({ sampler, target }) => {
    const mesh = gltf.meshes[gltf.nodes[target.node].mesh];
    return { names: mesh.extras.targetNames, times: numbers(samplers[sampler].input), weights: numbers(samplers[sampler].output) };
  });
}

/** A table's rows by column name. */
function table(csv) {
  const [header, ...lines] = csv.trim().split("\n").map((line) => line.split(","));
  return lines.map((line) => Object.fromEntries(line.map((value, i) => [header[i], Number(value)])));
}

/** Pictures decoded and compared in a page of their own. Differences are means of 0..255 over all pixels. */
async function looked(context, { pictures, recording, sheet, cell, rows }) {
  const page = await context.newPage();
  const base64 = (bytes) => Buffer.from(bytes).toString("base64");
  const found = await page.evaluate(
    async ({ pictures, recording, sheet, cell, rows }) => {
      const SIZE = 120;
      const blob = (text, type) => new Blob([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], { type });
      const pixels = (source, [x, y, w, h]) => {
        const context = new OffscreenCanvas(SIZE, SIZE).getContext("2d");
        context.drawImage(source, x, y, w, h, 0, 0, SIZE, SIZE);
        return context.getImageData(0, 0, SIZE, SIZE).data;
      };
      const apart = (a, b) => a.reduce((sum, value, i) => sum + Math.abs(value - b[i]), 0) / a.length;
      const colours = (data) => new Set(Array.from({ length: data.length / 4 }, (_, i) => `${data[4 * i] >> 4},${data[4 * i + 1] >> 4},${data[4 * i + 2] >> 4}`)).size;
      const sizes = new Set();
      const shots = [];
      for (const text of pictures) {
        const bitmap = await createImageBitmap(blob(text, "image/png"));
        sizes.add(`${bitmap.width}x${bitmap.height}`);
        shots.push(pixels(bitmap, [0, 0, bitmap.width, bitmap.height]));
      }
      const differences = (data) => shots.map((shot) => apart(shot, data));
      const video = document.createElement("video");
      video.muted = true;
      video.src = URL.createObjectURL(blob(recording, "video/webm"));
      const until = (name) => new Promise((resolve, reject) => ((video[`on${name}`] = resolve), (video.onerror = () => reject(video.error))));
      await until("loadeddata");
      const { duration, videoWidth, videoHeight } = video;
      const moments = [];
      for (const part of [0.4, 0.45, 0.5]) {
        video.currentTime = part * duration;
        await until("seeked");
        moments.push({ part, from: differences(pixels(video, [0, 0, videoWidth, videoHeight])) });
      }
      const whole = await createImageBitmap(blob(sheet, "image/png"));
      const cells = [];
      for (let row = 0; row < rows; row++) {
        for (let i = 0; i * cell < whole.width; i++) cells.push(pixels(whole, [i * cell, row * cell, cell, cell]));
      }
      return {
        sizes: [...sizes],
        colours: shots.map(colours),
        fromFirst: shots.map((shot) => apart(shots[0], shot)),
        recording: { duration, size: `${videoWidth}x${videoHeight}`, moments },
        sheet: { size: `${whole.width}x${whole.height}`, cells: cells.map(differences), colours: cells.map(colours) },
      };
    },
    { pictures: pictures.map(base64), recording: base64(recording), sheet: base64(sheet), cell, rows },
  );
  await page.close();
  return found;
}

test("studio: exports are opened again and show what was solved", { skip: noBrowser, timeout: 900_000 }, async () => {
  const server = await preview([]);
  const browser = await open("webgl2");
  const { page, context } = browser;
  const folder = mkdtempSync(join(tmpdir(), "mimique-studio-"));
  const shots = screenshotFolder("studio");
  try {
    await builtIn(page, server);
    await page.click("#add-panel");
    await fact(page, "B", "Residual");
    // A strong anger comes up here.
    await unfold(page, "expressions");
    await page.locator("#scrub").fill("9000");
    await page.click("#expression-add");
    await page.waitForFunction(() => document.querySelectorAll("#segments tr").length === 1);
    await page.selectOption("#range", "0");
    const clip = await page.locator("#segments tr td").nth(3).textContent();
    const [from, to] = clip.split("–").map(Number);
    await unfold(page, "exports");
    await page.fill("#export-rate", String(RATE));
    await page.fill("#export-width", "500");
    await page.fill("#export-height", "500");
    await page.press("#export-height", "Enter");
    const saved = (id) => download(page, () => page.click(`#export-${id}`));
    const rows = table(String(await saved("weights")));
    const glb = await saved("glb");
    const pictures = unzipped(await saved("png"));
    const recording = await saved("webm");
    const sheet = await saved("sheet");
    writeFileSync(join(shots, "sheet.png"), sheet);

    // The animation: every frame of the part, the table's weights under the same names.
    const channels = animation(glb);
    const part = rows.filter(({ time }) => time >= from - 1e-9 && time <= to + 1e-9);
    assert.ok(part.length > 200, `${part.length} frames`);
    for (const { names, times, weights } of channels) {
      assert.equal(times.length, part.length);
      assert.ok(times.every((time, i) => Math.abs(time - (part[i].time - part[0].time)) < 1e-6), "the capture's times");
      const apart = part.flatMap((row, f) => names.map((name, k) => Math.abs(weights[f * names.length + k] - (row[name] ?? 0))));
      assert.equal(weights.length, apart.length);
      assert.ok(Math.max(...apart.slice(0, 50_000)) < 1e-6, "the table's weights");
    }
    assert.ok(channels.some(({ names }) => names.length === 57), "the skin has every shape");
    const brows = channels[0].names.indexOf("browDownLeft");
    const brow = channels[0].weights.filter((_, i) => i % channels[0].names.length === brows);
    assert.ok(Math.max(...brow) - Math.min(...brow) > 0.3, "the brow goes down");
    const file = join(folder, "animated.glb");
    writeFileSync(file, glb);
    const facts = JSON.parse(mimique(["inspect", "--json", file]));
    assert.equal(facts.shape_count, 57);

    // Pictures: one a twenty-fifth of a second, each a face, another one as the expression comes.
    const count = Math.floor((to - from) * RATE + 1e-6) + 1;
    assert.deepEqual(pictures.map(([name]) => name), Array.from({ length: count }, (_, i) => `built-in-actor-a-${String(i).padStart(5, "0")}.png`));
    const seen = await looked(context, { pictures: pictures.map(([, bytes]) => bytes), recording, sheet, cell: CELL, rows: 2 });
    assert.equal(seen.sizes.length, 1);
    const [width, height] = seen.sizes[0].split("x").map(Number);
    assert.deepEqual([width, height], [500, 500], "the size that was asked for");
    assert.ok(seen.colours.every((n) => n > 40), `no picture is blank: ${Math.min(...seen.colours)} colours at least`);
    const middle = Math.floor(count / 2);
    assert.ok(seen.fromFirst[middle] > 0.3, `the face changes: ${seen.fromFirst[middle]}`);

    // Recording: as long as its part; while the expression comes, each moment is like its own picture.
    const nearest = (from) => from.indexOf(Math.min(...from));
    assert.equal(seen.recording.size, seen.sizes[0]);
    assert.ok(Math.abs(seen.recording.duration - count / RATE) < 0.002, `${seen.recording.duration} s of ${count / RATE}`);
    for (const { part, from } of seen.recording.moments) {
      const at = Math.floor(part * seen.recording.duration * RATE);
      assert.ok(Math.abs(nearest(from) - at) <= 1 && from[at] < 4, `recording at ${part}: like picture ${nearest(from)}, ${from[at]} from its own, ${at}`);
    }

    // Contact sheet: a row of eight a method, from the start of the part to its end.
    assert.equal(seen.sheet.size, `${8 * CELL}x${2 * CELL}`);
    assert.ok(seen.sheet.colours.every((n) => n > 40));
    for (const [i, from] of seen.sheet.cells.slice(0, 8).entries()) {
      const at = ((count - 1) * i) / 7;
      const said = `cell ${i}: like picture ${nearest(from)} of ${count}, ${from[0]} from the first, ${from[count - 1]} from the last`;
      assert.ok(at < 13 ? from[0] < from[count - 1] : at > 17 ? from[count - 1] < from[0] : Math.abs(nearest(from) - at) <= 2, said);
    }

    // A long export stops when it is asked to.
    await page.selectOption("#range", "");
    await page.click("#export-png");
    await page.click("#export-stop");
    await page.waitForFunction(() => !document.querySelector("#export-png").disabled, null, { timeout: 60_000 });
    assert.ok(await page.locator("#export-running").isHidden());
    assert.equal(await page.locator("#problem").isVisible(), false);

    // The head of the animation opens again and is solved.
    await page.setInputFiles("#avatar-file", file);
    await page.waitForFunction(() => document.querySelector("#avatar-facts").textContent.startsWith("animated.glb: 9202 vertices, 57 shapes"), null, { timeout: 60_000 });
    assert.ok((await fact(page, "A", "Residual")) < 3);
    assert.deepEqual(browser.errors, [], "the console is clean");
  } finally {
    await browser.close();
    await server.stop();
  }
});
