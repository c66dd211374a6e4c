// Debian's Chromium under playwright, one graphics back end at a time, in software.

import { existsSync, mkdirSync, mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";
import { root } from "./server.mjs";

const candidates = [process.env.MIMIQUE_CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
export const executable = candidates.find((path) => path && existsSync(path));

const quiet = [
  "--headless", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync",
];
const backends = {
  webgl2: ["--enable-unsafe-swiftshader"],
  webgpu: [
    "--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader", "--enable-unsafe-swiftshader",
    "--use-angle=swiftshader", "--use-vulkan=swiftshader", "--enable-features=Vulkan",
  ],
};

/** A browser with a fresh profile: `{page, context, requests, errors, close()}`; `more`: options of Chromium, `permissions`:
    what pages may use unasked. */
export async function open(backend, { locale = "en-GB", viewport = { width: 1280, height: 900 }, colorScheme = "light", reducedMotion = "no-preference", forcedColors = "none", timezone, touch = false, profile, more = [], permissions = [] } = {}) {
  profile ??= mkdtempSync(join(tmpdir(), "mimique-profile-"));
  const context = await chromium.launchPersistentContext(profile, {
    executablePath: executable,
    args: [...quiet, ...backends[backend], ...more],
    permissions,
    headless: true,
    locale,
    viewport,
    colorScheme,
    reducedMotion,
    forcedColors,
    timezoneId: timezone,
    hasTouch: touch,
  });
  const requests = [];
  const errors = [];
  context.on("request", (request) => requests.push(request.url()));
  const watch = (page) => {
    page.on("pageerror", (error) => errors.push(String(error)));
    page.on("console", (message) => {
      if (message.type() === "error") errors.push(message.text());
    });
  };
  context.pages().forEach(watch);
  context.on("page", watch);
  const page = context.pages()[0] ?? (await context.newPage());
  return { page, context, requests, errors, profile, close: () => context.close() };
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
