// Which back end this browser can run, and the module built for it.
import { failureOf, StageFailure } from "./failure.js";

const MODULES = { webgpu: "../stage_webgpu.js", webgl2: "../stage_webgl.js" };

let found = null;
let restarts = 0;
const modules = new Map();

/// "webgpu" or "webgl2"; a thrown Error says why neither. `?backend=` in the address decides for tests.
export function backend() {
  found ??= detect();
  return found;
}

/// The canvas module of the back end, loaded once. After a crash of the module ask for a fresh one.
export function loadModule(name, fresh = false) {
  if (fresh) restarts += 1;
  const url = new URL(MODULES[name], import.meta.url);
  if (restarts > 0) url.searchParams.set("restart", restarts);
  let module = modules.get(url.href);
  if (!module) {
    module = open(url.href).catch((error) => {
      throw failureOf(error, "module", `${name}: `);
    });
    modules.set(url.href, module);
    // What did not arrive is asked for again the next time.
    module.catch(() => modules.delete(url.href));
  }
  return module;
}

/// Loads the canvas module ahead, so that the first clip need not wait for it. What fails is said when a
/// clip is shown.
export function loadAhead() {
  backend().then((name) => loadModule(name)).catch(() => {});
}

async function open(address) {
  const module = await import(address);
  await module.default();
  return module;
}

async function detect() {
  const wish = new URLSearchParams(globalThis.location?.search ?? "").get("backend");
  // What the solver needs beside the canvas (inflated.js): Chrome 80, Firefox 113, Safari 16.4 and later.
  const inflates = "DecompressionStream" in globalThis;
  const wanted = !inflates ? [] : wish === null ? ["webgpu", "webgl2"] : [wish];
  const reasons = inflates ? [] : ["too old: no DecompressionStream"];
  for (const name of wanted) {
    const reason = name === "webgpu" ? await webgpuLacks() : name === "webgl2" ? webgl2Lacks() : "unknown back end";
    if (reason === null) return name;
    reasons.push(`${name}: ${reason}`);
  }
  throw new StageFailure(
    "no_graphics",
    `This browser cannot draw the stimuli (${reasons.join("; ")}). ` +
      "Use a current Chrome, Edge, Firefox or Safari with hardware acceleration switched on.",
  );
}

async function webgpuLacks() {
  if (!navigator.gpu) return "not offered";
  try {
    const adapter = await navigator.gpu.requestAdapter();
    if (!adapter) return "no graphics adapter";
    const device = await adapter.requestDevice();
    device.destroy();
    return null;
  } catch (error) {
    return String(error.message ?? error);
  }
}

function webgl2Lacks() {
  const context = document.createElement("canvas").getContext("webgl2");
  if (!context) return "not offered";
  // The stage keeps positions in float textures that it renders into.
  const renderable = context.getExtension("EXT_color_buffer_float");
  context.getExtension("WEBGL_lose_context")?.loseContext();
  return renderable ? null : "cannot render to float textures";
}
