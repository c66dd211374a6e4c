// What a participant downloads until the first clip plays: every request with the bytes of its body as they were
// transferred. Not a test: figures. The browser is on the server's machine, so that bodies come as brotli.
//
//   node page_download.mjs [study.json]        the demonstration study by default

import { join } from "node:path";
import { open } from "./lib/browser.mjs";
import { answer, go, leave, phase, place } from "./lib/participant.mjs";
import { root, serve } from "./lib/server.mjs";

const file = process.argv[2] ?? join(root, "study-config/demo.json");
const server = await serve([file]);
const browser = await open("webgl2");
const { page } = browser;
const finished = [];
browser.context.on("requestfinished", (request) => finished.push(request));

const address = JSON.parse(server.said()).studies?.[0]?.url ?? `${server.url}/s/demo/`;
await page.goto(`${address}?backend=webgl2`);
await page.waitForSelector("main[data-view]", { timeout: 30_000 });
for (let here = await place(page); here.view !== "trial"; here = await leave(page, here, 60_000)) {
  if (here.view === "questions") await answer(page, "mouse", here.step);
  await go(page, "mouse");
}
await phase(page, "ready", 120_000);
await page.locator("[data-action=play]").first().click();
await phase(page, "playing", 120_000);
await page.waitForTimeout(3000);

const rows = [];
for (const request of finished) {
  const response = await request.response();
  const { responseBodySize } = await request.sizes();
  const coding = response.headers()["content-encoding"] ?? "";
  const path = new URL(request.url()).pathname.replace(/^\/assets\/[0-9a-f]+\//, "");
  rows.push({ path: `${request.method()} ${path}`, bytes: responseBodySize, coding });
}
await browser.close();
await server.stop();
rows.sort((a, b) => b.bytes - a.bytes);
for (const { path, bytes, coding } of rows) console.log(`${String(bytes).padStart(8)}  ${coding.padEnd(4)}  ${path}`);
const gets = rows.filter(({ path }) => path.startsWith("GET"));
const sum = (list) => (list.reduce((total, { bytes }) => total + bytes, 0) / 1000).toFixed(0);
console.log(`${sum(gets)} KB in ${gets.length} requests for files and the study; ${rows.length - gets.length} posts of the session, ${sum(rows.filter((row) => !gets.includes(row)))} KB`);
