// What leaves the studio: tables, animations, pictures, videos. All of it is made in the browser.
import { callWorker } from "./worker-calls.js";
import { encodedVideo } from "./webm.js";
import { Zip } from "./zip.js";

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

/// An export that was asked to stop.
class Stopped extends Error {}
let isStopped = false;

/// `page`: {panel(slot), panels(), part() -> [ms, ms], pause(), name(), report(error)}
export function wireExports(page) {
  const on = (id, act) => {
    $(id).addEventListener("click", async () => {
      const panel = page.panel($("export-slot").value);
      if (!panel?.facts) return page.report(new Error("export: nothing is solved yet"));
      page.pause();
      const buttons = [...$("exports").querySelectorAll("button:not(#export-stop)")];
      for (const button of buttons) button.disabled = true;
      isStopped = false;
      try {
        await act(panel);
      } catch (error) {
        if (!(error instanceof Stopped)) page.report(error);
      } finally {
        $("export-running").hidden = true;
        for (const button of buttons) button.disabled = false;
        $(id).focus();
      }
    });
  };
  $("export-stop").addEventListener("click", () => (isStopped = true));
  const frames = (panel) => {
    const [from, to] = page.part();
    return [panel.frameAt(from), panel.frameAt(to) + 1];
  };
  on("export-weights", async (panel) => save(`${page.name()}-${panel.slot}.csv`, await callWorker("weightsCsv", panel.slot)));
  on("export-glb", async (panel) => save(`${page.name()}-${panel.slot}.glb`, await callWorker("animatedGlb", panel.slot, ...frames(panel))));
  on("export-png", (panel) => pictures(panel, page));
  on("export-webm", (panel) => saveVideo(panel, page));
  on("export-sheet", () => sheet(page));
}

// Tells how much is done, and ends the work if somebody wants it to end.
function progress(part) {
  if (isStopped) throw new Stopped();
  $("export-running").hidden = false;
  $("export-progress").value = part;
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

async function png(bitmaps, columns, size, captions = []) {
  const [width, height] = size;
  const canvas = new OffscreenCanvas(width * columns, height * Math.ceil(bitmaps.length / columns));
  const context = canvas.getContext("2d");
  bitmaps.forEach((bitmap, i) => context.drawImage(bitmap, (i % columns) * width, Math.floor(i / columns) * height, width, height));
  context.font = "13px system-ui, sans-serif";
  context.lineWidth = 3;
  context.strokeStyle = "rgb(0 0 0 / 70%)";
  context.fillStyle = "#ffffff";
  captions.forEach((words, i) => {
    const at = [(i % columns) * width + 6, Math.floor(i / columns) * height + 17];
    context.strokeText(words, ...at);
    context.fillText(words, ...at);
  });
  const blob = await canvas.convertToBlob({ type: "image/png" });
  return new Uint8Array(await blob.arrayBuffer());
}

async function pictures(panel, page) {
  const at = times(page);
  const zip = new Zip();
  for (const [i, timeMs] of at.entries()) {
    const bitmap = await picture(panel, timeMs);
    zip.add(`${page.name()}-${panel.slot}-${String(i).padStart(5, "0")}.png`, await png([bitmap], 1, [bitmap.width, bitmap.height]));
    bitmap.close();
    progress((i + 1) / at.length);
  }
  save(`${page.name()}-${panel.slot}.zip`, zip.finish());
}

async function sheet(page) {
  const [from, to] = page.part();
  const panels = page.panels().filter((panel) => panel.facts);
  const [bitmaps, captions] = [[], []];
  for (const panel of panels) {
    for (let i = 0; i < SHEET_FRAMES; i++) {
      const timeMs = from + ((to - from) * i) / (SHEET_FRAMES - 1);
      bitmaps.push(await picture(panel, timeMs));
      captions.push(`${i === 0 ? `${panel.title()}, ` : ""}${(timeMs / 1000).toFixed(2)} s`);
      progress(bitmaps.length / (panels.length * SHEET_FRAMES));
    }
  }
  save(`${page.name()}-sheet.png`, await png(bitmaps, SHEET_FRAMES, [240, 240], captions));
  for (const bitmap of bitmaps) bitmap.close();
}

async function saveVideo(panel, page) {
  const at = times(page);
  const bytes = await encodedVideo({
    count: at.length,
    rate: Number($("export-rate").value),
    picture: (i) => picture(panel, at[i]),
    done: (i) => progress((i + 1) / at.length),
  });
  save(`${page.name()}-${panel.slot}.webm`, bytes);
}
