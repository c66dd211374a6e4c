// A web host that knows nothing but files, for pages that embed the npm packages: the packages lie in its node_modules as npm
// installs them, beside them what the tests have from npm.

import { readFileSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { root } from "./server.mjs";

const types = {
  ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript", ".css": "text/css", ".json": "application/json",
  ".wasm": "application/wasm", ".map": "application/json",
};
const pages = process.env.MIMIQUE_WEB_DIR ?? join(root, "target/web-dist");

/** The packages as the repository has them, before they are packed. */
export const unpacked = {
  "/node_modules/@mimique/stage/modules/": pages,
  "/node_modules/@mimique/stage/": join(root, "xtask/package/npm"),
  "/node_modules/@mimique/jspsych-plugin/": join(root, "xtask/package/jspsych"),
  "/node_modules/": join(root, "tests/browser/node_modules"),
};

/**
 * Serves folders by the beginning of their addresses (the first that fits) and `texts` by their whole address; what else is
 * asked is 404. Other hosts' pages may read it. `{url, requests, close()}`.
 */
export async function packageHost(folders, texts = {}) {
  const requests = [];
  const host = createServer((request, answer) => {
    const path = normalize(decodeURIComponent(new URL(request.url, "http://x").pathname));
    requests.push(path);
    answer.setHeader("access-control-allow-origin", "*");
    if (path === "/favicon.ico") return answer.writeHead(204).end();
    const found = texts[path] ?? file(folders, path);
    if (found === null) return answer.writeHead(404).end();
    answer.writeHead(200, { "content-type": types[extname(path)] ?? (path in texts ? "text/html" : "application/octet-stream") }).end(found);
  });
  await new Promise((done) => host.listen(0, "127.0.0.1", done));
  return { url: `http://127.0.0.1:${host.address().port}`, requests, close: () => new Promise((done) => (host.close(done), host.closeAllConnections())) };
}

function file(folders, path) {
  const start = Object.keys(folders).find((start) => path.startsWith(start));
  const place = start && join(folders[start], path.slice(start.length), path.endsWith("/") ? "index.html" : "");
  return place && statSync(place, { throwIfNoEntry: false })?.isFile() ? readFileSync(place) : null;
}
