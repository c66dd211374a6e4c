// What leaves the studio: tables, animations, pictures, videos. All of it is made in the browser.
import { numeral, say } from "./texts.js";
import { callWorker } from "./worker-calls.js";
import { canEncode, encodedVideo } from "./encoder.js";
import { openShots } from "./shots.js";
import { Zip } from "./zip.js";

const $ = (id) => document.getElementById(id);
/// Of a contact sheet: pictures in a row, and their size.
const SHEET_FRAMES = 8;
const SHEET_CELL = 240;

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

/// Most pixels across and down: 4K.
const MOST = 4096;

// The size that is chosen, in whole pairs of pixels, which encoders ask for.
function size() {
  return ["export-width", "export-height"].map((id) => {
    const own = Math.min(Math.max(Number($(id).value) || 0, 64), MOST);
    return 2 * Math.round(own / 2);
  });
}

function rate() {
  return Math.min(Math.max(Number($("export-rate").value) || 30, 1), 240);
}

/// `page`: {camera, panel(slot), panels(), part() -> [ms, ms], pause(), name(), report(error)}
export function wireExports(page) {
  const on = (id, act) => {
    $(id).addEventListener("click", async () => {
      const panel = page.panel($("export-slot").value);
      if (!panel?.facts) return page.report(new Error(say("export.none")));
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
  on("export-webm", (panel) => saveVideo(panel, page, "webm"));
  on("export-mp4", (panel) => saveVideo(panel, page, "mp4"));
  $("export-size").addEventListener("change", ({ target }) => {
    if (target.value === "") return;
    [$("export-width").value, $("export-height").value] = target.value.split("x");
    offer();
  });
  for (const id of ["export-width", "export-height"]) {
    $(id).addEventListener("change", () => {
      const own = size();
      [$("export-width").value, $("export-height").value] = own;
      $("export-size").value = own.join("x");
      if ($("export-size").selectedIndex < 0) $("export-size").value = "";
      offer();
    });
  }
  // MP4 where the browser writes it in this size.
  const offer = async () => ($("export-mp4").hidden = !(await canEncode("mp4", ...size(), rate())));
  offer();
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
  const each = 1000 / rate();
  const count = Math.max(1, Math.floor((to - from) / each + 1e-9) + 1);
  return Array.from({ length: count }, (_, i) => from + i * each);
}

// Does something with pictures of faces in the chosen size, or in a given one.
async function withShots(page, panel, work, own = size()) {
  const shots = await openShots(page.camera.of(panel.slot), own);
  try {
    return await work((face, timeMs) => shots.picture(face.clipId, timeMs));
  } finally {
    shots.close();
  }
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

const pictures = (panel, page) => withShots(page, panel, async (picture) => {
  const at = times(page);
  const zip = new Zip();
  for (const [i, timeMs] of at.entries()) {
    const bitmap = await picture(panel, timeMs);
    zip.add(`${page.name()}-${panel.slot}-${String(i).padStart(5, "0")}.png`, await png([bitmap], 1, [bitmap.width, bitmap.height]));
    bitmap.close();
    progress((i + 1) / at.length);
  }
  save(`${page.name()}-${panel.slot}.zip`, zip.finish());
});

async function sheet(page) {
  const [from, to] = page.part();
  const panels = page.panels().filter((panel) => panel.facts);
  const [bitmaps, captions] = [[], []];
  for (const panel of panels) {
    await withShots(page, panel, async (picture) => {
      for (let i = 0; i < SHEET_FRAMES; i++) {
        const timeMs = from + ((to - from) * i) / (SHEET_FRAMES - 1);
        bitmaps.push(await picture(panel, timeMs));
        captions.push(`${i === 0 ? `${panel.title()}, ` : ""}${numeral(timeMs / 1000, 2)} s`);
        progress(bitmaps.length / (panels.length * SHEET_FRAMES));
      }
    }, [SHEET_CELL, SHEET_CELL]);
  }
  save(`${page.name()}-sheet.png`, await png(bitmaps, SHEET_FRAMES, [SHEET_CELL, SHEET_CELL], captions));
  for (const bitmap of bitmaps) bitmap.close();
}

const saveVideo = (panel, page, format) => withShots(page, panel, async (picture) => {
  const at = times(page);
  const bytes = await encodedVideo({
    format, count: at.length, rate: rate(),
    picture: (i) => picture(panel, at[i]),
    done: (i) => progress((i + 1) / at.length),
  });
  save(`${page.name()}-${panel.slot}.${format}`, bytes);
});
