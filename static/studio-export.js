// What leaves the studio: tables, animations, pictures, films. All of it is made in the browser.
import { desk } from "./studio-desk.js";

const $ = (id) => document.getElementById(id);
const SHEET_FRAMES = 8;

/// Offers bytes or text as a file.
export function save(name, content) {
  const address = URL.createObjectURL(new Blob([content]));
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

/// `page`: {panel(slot), panels(), part() -> [ms, ms], pause(), name(), report(error)}
export function wireExports(page) {
  const on = (id, act) => {
    $(id).addEventListener("click", async () => {
      const panel = page.panel($("export-slot").value);
      if (!panel?.facts) return page.report(new Error("export: nothing is solved yet"));
      page.pause();
      const buttons = [...$("exports").querySelectorAll("button")];
      for (const button of buttons) button.disabled = true;
      try {
        await act(panel);
      } catch (error) {
        page.report(error);
      } finally {
        progress(null);
        for (const button of buttons) button.disabled = false;
      }
    });
  };
  const frames = (panel) => {
    const [from, to] = page.part();
    return [panel.frameAt(from), panel.frameAt(to) + 1];
  };
  on("export-weights", async (panel) => save(`${page.name()}-${panel.slot}.csv`, await desk("weightsCsv", panel.slot)));
  on("export-glb", async (panel) => save(`${page.name()}-${panel.slot}.glb`, await desk("animatedGlb", panel.slot, ...frames(panel))));
  on("export-png", (panel) => pictures(panel, page));
  on("export-webm", (panel) => film(panel, page));
  on("export-sheet", () => sheet(page));
}

function progress(part) {
  $("export-progress").hidden = part === null;
  $("export-progress").value = part ?? 0;
}

function times(page) {
  const [from, to] = page.part();
  const rate = Number($("export-rate").value);
  const count = Math.max(1, Math.floor(((to - from) / 1000) * rate) + 1);
  return Array.from({ length: count }, (_, i) => from + (1000 * i) / rate);
}

// The picture must be taken in the task that drew it.
async function picture(panel, timeMs) {
  await panel.show(timeMs);
  return await createImageBitmap(panel.canvas);
}

async function png(bitmaps, columns, size) {
  const [width, height] = size;
  const canvas = new OffscreenCanvas(width * columns, height * Math.ceil(bitmaps.length / columns));
  const context = canvas.getContext("2d");
  bitmaps.forEach((bitmap, i) => context.drawImage(bitmap, (i % columns) * width, Math.floor(i / columns) * height, width, height));
  const blob = await canvas.convertToBlob({ type: "image/png" });
  return new Uint8Array(await blob.arrayBuffer());
}

async function pictures(panel, page) {
  const at = times(page);
  const [names, files] = [[], []];
  for (const [i, timeMs] of at.entries()) {
    const bitmap = await picture(panel, timeMs);
    names.push(`${page.name()}-${panel.slot}-${String(i).padStart(5, "0")}.png`);
    files.push(await png([bitmap], 1, [bitmap.width, bitmap.height]));
    bitmap.close();
    progress((i + 1) / at.length);
  }
  save(`${page.name()}-${panel.slot}.zip`, await desk("zip", names, files));
}

async function sheet(page) {
  const [from, to] = page.part();
  const panels = page.panels().filter((panel) => panel.facts);
  const bitmaps = [];
  for (const panel of panels) {
    for (let i = 0; i < SHEET_FRAMES; i++) {
      bitmaps.push(await picture(panel, from + ((to - from) * i) / (SHEET_FRAMES - 1)));
      progress(bitmaps.length / (panels.length * SHEET_FRAMES));
    }
  }
  save(`${page.name()}-sheet.png`, await png(bitmaps, SHEET_FRAMES, [240, 240]));
  for (const bitmap of bitmaps) bitmap.close();
}

// The browser's own encoder, each picture for its time: the film keeps its rate however long a
// picture takes to draw.
async function film(panel, page) {
  if (!globalThis.MediaRecorder) throw new Error("film: this browser has no encoder; export pictures instead");
  const at = times(page);
  const bitmap = await picture(panel, at[0]);
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [bitmap.width, bitmap.height];
  const context = canvas.getContext("2d");
  context.drawImage(bitmap, 0, 0);
  const stream = canvas.captureStream(0);
  const [track] = stream.getVideoTracks();
  const type = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"].find((each) => MediaRecorder.isTypeSupported(each));
  if (!type) throw new Error("film: this browser encodes no WebM; export pictures instead");
  const recorder = new MediaRecorder(stream, { mimeType: type, videoBitsPerSecond: 8_000_000 });
  const parts = [];
  recorder.ondataavailable = ({ data }) => parts.push(data);
  const ended = new Promise((resolve, reject) => {
    recorder.onstop = resolve;
    recorder.onerror = ({ error }) => reject(new Error(`film: ${error?.message ?? "the encoder failed"}`));
  });
  // Drawn ahead, so that the recording runs at the film's own pace.
  const bitmaps = [bitmap];
  for (const [i, timeMs] of at.entries()) {
    if (i > 0) bitmaps.push(await picture(panel, timeMs));
    progress(0.7 * ((i + 1) / at.length));
  }
  recorder.start();
  const started = performance.now();
  for (const [i, each] of bitmaps.entries()) {
    const due = started + at[i] - at[0];
    while (performance.now() < due) await new Promise((resolve) => setTimeout(resolve, Math.max(0, due - performance.now())));
    context.drawImage(each, 0, 0);
    track.requestFrame();
    each.close();
    progress(0.7 + 0.3 * ((i + 1) / at.length));
  }
  await new Promise((resolve) => setTimeout(resolve, 1000 / Number($("export-rate").value)));
  recorder.stop();
  await ended;
  save(`${page.name()}-${panel.slot}.webm`, new Blob(parts, { type }));
}
