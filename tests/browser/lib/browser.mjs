// Debian's Chromium under playwright, one graphics back end at a time, in software.

import { existsSync, mkdirSync, mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { root } from "./server.mjs";

const candidates = [process.env.MIMIQUE_CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
export const executable = candidates.find((path) => path && existsSync(path));

const quiet = [
  "--headless", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync",
];
const flags = {
  webgl2: ["--enable-unsafe-swiftshader"],
  webgpu: [
    "--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader", "--enable-unsafe-swiftshader",
    "--use-angle=swiftshader", "--use-vulkan=swiftshader", "--enable-features=Vulkan",
  ],
};
/** The back ends that a browser is started for. */
export const backends = Object.keys(flags);

/** How a browser of a back end is started, with further options of Chromium. */
export const launching = (backend, more = []) => ({ executablePath: executable, args: [...quiet, ...flags[backend], ...more], headless: true });

// run.mjs starts a browser for each back end, which all test files share: the addresses of these, by back end.
const shared = JSON.parse(process.env.MIMIQUE_BROWSERS ?? "{}");
const undrawnStage = fileURLToPath(new URL("undrawn_stage.js", import.meta.url));

/** A context of its own, and how it is closed. A profile or options of Chromium need a browser of their own. */
async function context(backend, profile, more, options) {
  if (profile !== undefined || more.length > 0) {
    const folder = profile ?? mkdtempSync(join(tmpdir(), "mimique-profile-"));
    const context = await chromium.launchPersistentContext(folder, { ...launching(backend, more), ...options });
    return { context, close: () => context.close() };
  }
  const browser = shared[backend] ? await chromium.connect(shared[backend]) : await chromium.launch(launching(backend));
  const context = await browser.newContext(options);
  return { context, close: async () => (await context.close(), browser.close()) };
}

/**
 * A browser in which nothing is stored: `{page, context, requests, errors, close()}`. `backend`: "webgl2" or "webgpu", or
 * "undrawn" for tests that are not about pictures: WebGL2 whose canvas module draws nothing (undrawn_stage.js). `more`:
 * options of Chromium, `permissions`: what pages may use without being asked.
 */
export async function open(backend, { locale = "en-GB", viewport = { width: 1280, height: 900 }, colorScheme = "light", reducedMotion = "no-preference", forcedColors = "none", timezone, touch = false, profile, more = [], permissions = [] } = {}) {
  const isDrawn = backend !== "undrawn";
  const options = { permissions, locale, viewport, colorScheme, reducedMotion, forcedColors, timezoneId: timezone, hasTouch: touch };
  const { context: own, close } = await context(isDrawn ? backend : "webgl2", profile, more, options);
  if (!isDrawn) {
    const headers = { "access-control-allow-origin": "*" };
    await own.route(/\/stage_webgl\.js(\?|$)/, (route) => route.fulfill({ path: undrawnStage, contentType: "text/javascript", headers }));
  }
  const requests = [];
  const errors = [];
  own.on("request", (request) => requests.push(request.url()));
  const watch = (page) => {
    page.on("pageerror", (error) => errors.push(String(error)));
    page.on("console", (message) => {
      if (message.type() === "error") errors.push(message.text());
    });
  };
  own.pages().forEach(watch);
  own.on("page", watch);
  const page = own.pages()[0] ?? (await own.newPage());
  return { page, context: own, requests, errors, close };
}

/** Where screenshots for people to look at are written. */
export function screenshotFolder(name) {
  const folder = join(process.env.MIMIQUE_SCREENSHOTS ?? join(root, "target/screenshots"), name);
  mkdirSync(folder, { recursive: true });
  return folder;
}

/** Why a test cannot run here, or false. With MIMIQUE_NO_SKIP=1 that is a failure. */
export function skip(reason) {
  if (!reason) return false;
  if (process.env.MIMIQUE_NO_SKIP === "1") throw new Error(`may not skip: ${reason}`);
  return reason;
}
