// The npm package as a page of somebody else embeds it: `node stage_package.mjs FOLDER` (`cargo xtask package --check`
// runs it). The page lies on a host of its own that hands packs on from `mimique serve`; a clip is solved and drawn.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { open, screenshotFolder } from "./lib/browser.mjs";
import { serve } from "./lib/server.mjs";

const folder = process.argv[2];
const types = { ".js": "text/javascript", ".wasm": "application/wasm" };
const page = `<!doctype html><meta charset="utf-8"><title>Embedding</title>
<script type="importmap">{ "imports": { "@mimique/stage": "/stage/index.js" } }</script>
<canvas id="face"></canvas>`;

/** The embedding page's host. */
function host(packs) {
  const answering = createServer(async (request, answer) => {
    const path = normalize(new URL(request.url, "http://x").pathname);
    try {
      if (path === "/") return answer.writeHead(200, { "content-type": "text/html" }).end(page);
      if (path.startsWith("/packs/")) {
        const pack = await fetch(`${packs}${path}`);
        return answer.writeHead(pack.status).end(Buffer.from(await pack.arrayBuffer()));
      }
      const type = types[extname(path)] ?? "application/octet-stream";
      const file = readFileSync(join(folder, path.replace(/^\/stage\//, "")));
      answer.writeHead(200, { "content-type": type }).end(file);
    } catch {
      answer.writeHead(404).end();
    }
  });
  return new Promise((done) => answering.listen(0, "127.0.0.1", () => done(answering)));
}

const server = await serve(["study-config/demo.json"]);
const embedding = await host(server.url);
const browser = await open("webgl2");
try {
  const { clips } = await (await fetch(`${server.url}/api/studies/demo`)).json();
  const [id, source] = Object.entries(clips)[0];
  await browser.page.goto(`http://127.0.0.1:${embedding.address().port}/`);
  const found = await browser.page.evaluate(
    async ([id, source]) => {
      const { openStage, prepareClip } = await import("@mimique/stage");
      const solved = await prepareClip(id, source);
      const stage = await openStage(document.getElementById("face"), { width: 320, height: 320, background: "#202020" });
      await stage.show(id, solved.duration_ms / 2);
      const log = await stage.play(id);
      return { solved, state: stage.state(), frames: log.frames.length, aborted: log.aborted };
    },
    [id, source],
  );
  assert.equal(found.solved.weights_hash, source.weights_hash, "the package's solver has other bits than the server");
  assert.deepEqual([found.state.backend, found.state.lost, found.aborted], ["webgl2", null, null]);
  assert.ok(found.frames > 3, `${found.frames} frames`);
  const file = join(screenshotFolder("package"), "embedding.png");
  await browser.page.locator("#face").screenshot({ path: file });
  console.log(`drawn in another page: clip ${id}, ${found.solved.frames} frames solved, ${found.frames} shown, ${found.solved.warnings.length} warnings`);
} finally {
  await browser.close();
  embedding.close();
  await server.stop();
}
