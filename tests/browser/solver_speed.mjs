// 54 clips of a study solved in Chromium by the page's own worker, for `cargo xtask bench --browser`:
// how much faster than they play, and how long the page was ever blocked.
//
//   node tests/browser/solver_speed.mjs WEB_DIST PROBLEM_FOLDER
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { basename, join, normalize, resolve } from "node:path";
import { open } from "./lib/browser.mjs";

const [modules, folder] = process.argv.slice(2).map((path) => resolve(path));
const types = { js: "text/javascript", wasm: "application/wasm", html: "text/html", json: "application/json" };
const page404 = { status: 404, type: "text/plain", body: "" };

function answer(path) {
  if (path === "/") return { status: 200, type: types.html, body: "<!doctype html><title>54 clips</title>" };
  const name = path.startsWith("/problem/") ? basename(path) : normalize(path);
  try {
    const body = readFileSync(join(path.startsWith("/problem/") ? folder : modules, name));
    return { status: 200, type: types[name.split(".").pop()] ?? "application/octet-stream", body };
  } catch {
    return page404;
  }
}

const server = createServer((request, response) => {
  const { status, type, body } = answer(new URL(request.url, "http://localhost").pathname);
  response.writeHead(status, { "content-type": type }).end(body);
});
await new Promise((done) => server.listen(0, "127.0.0.1", done));
const browser = await open("webgl2");
try {
  await browser.page.goto(`http://127.0.0.1:${server.address().port}/`);
  const figures = await browser.page.evaluate(async () => {
    const bytes = async (name) => new Uint8Array(await (await fetch(`/problem/${name}`)).arrayBuffer());
    const operators = await bytes("operators.mmop");
    const takes = await Promise.all(Array.from({ length: 54 }, (_, clip) => bytes(`clip${clip}.mmtk`)));
    const method = await (await fetch("/problem/lsts.json")).json();
    const worker = new Worker("/stage/solver-worker.js", { type: "module" });
    const solve = (id, take) =>
      new Promise((done, fail) => {
        worker.onmessage = ({ data }) => (data.error ? fail(new Error(data.error)) : done(data));
        worker.onerror = (event) => fail(new Error(event.message));
        worker.postMessage({ id, operators, take, method });
      });
    const blocked = [];
    new PerformanceObserver((list) => blocked.push(...list.getEntries().map((e) => e.duration))).observe({
      entryTypes: ["longtask"],
    });
    // Also the longest gap between two turns of the page.
    let last = performance.now();
    let gap = 0;
    const timer = setInterval(() => {
      const now = performance.now();
      gap = Math.max(gap, now - last);
      last = now;
    }, 4);
    const start = performance.now();
    let frames = 0;
    for (const [id, take] of takes.entries()) frames += (await solve(id, take)).frames;
    const seconds = (performance.now() - start) / 1000;
    await new Promise((done) => setTimeout(done, 200));
    clearInterval(timer);
    worker.terminate();
    return { clips: takes.length, frames, seconds, played: frames / 200, longTasks: blocked, longestGapMs: gap };
  });
  console.log(JSON.stringify(figures));
} finally {
  await browser.close();
  server.close();
}
