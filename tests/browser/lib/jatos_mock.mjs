// A mock of JATOS, as far as a study of one component meets it: what an import checks of an archive, the addresses of a
// run (conf/publix.routes of JATOS 3.10), and where its script stands. It knows of a run what JATOS' own pages would show.

import assert from "node:assert/strict";
import { createServer } from "node:http";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { unzipSync } from "fflate";

const types = { html: "text/html; charset=utf-8", js: "text/javascript", css: "text/css", json: "application/json", svg: "image/svg+xml" };

// What the page uses of jatos.js, in the place of which a folder of the real scripts may be given.
const SCRIPT = `
var jatos = { waiting: [] };
jatos.onLoad = (callback) => (jatos.waiting ? jatos.waiting.push(callback) : callback());
jatos.endStudyWithoutRedirect = (successful, message) =>
  fetch(new URL("../end?" + new URLSearchParams({ successful, message }), location.href));
fetch("initData").then((answer) => answer.json()).then((data) => {
  jatos.studyResultUuid = location.pathname.split("/").reverse()[2];
  jatos.urlQueryParameters = data.urlQueryParameters;
  // The real one brings in what it needs this way.
  document.head.append(Object.assign(document.createElement("script"), { textContent: "jatos.inline = true" }));
  if (!jatos.inline) throw new Error("the page's policy forbids the scripts of JATOS");
  const waiting = jatos.waiting;
  jatos.waiting = null;
  for (const callback of waiting) callback();
});
`;

/** What an import does with an archive: one description, one folder, names and paths as its validation wants them. */
export function imported(bytes) {
  const files = unzipSync(new Uint8Array(bytes));
  const described = Object.keys(files).filter((name) => !name.includes("/"));
  assert.equal(described.length, 1, "one *.jas, and nothing else beside the folder");
  assert.match(described[0], /\.jas$/);
  const folders = new Set(Object.keys(files).filter((name) => name.includes("/")).map((name) => name.split("/")[0]));
  assert.equal(folders.size, 1, "one folder");
  const { version, data } = JSON.parse(new TextDecoder().decode(files[described[0]]));
  assert.equal(version, "3");
  const uuid = /^[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}$/;
  for (const part of [data, ...data.componentList, ...data.batchList]) {
    assert.match(part.uuid, uuid);
    assert.ok(part.title.trim() !== "" && part.title.length <= 255 && !/[<>&]/.test(part.title));
  }
  assert.match(data.dirName, /^[\w-]{1,255}$/);
  for (const { htmlFilePath } of data.componentList) {
    assert.match(htmlFilePath, /^[\w\d_-][\w\d/_-]*\.[\w\d_-]+$/);
    assert.ok(files[`${data.dirName}/${htmlFilePath}`], `${htmlFilePath} is in the folder`);
  }
  assert.deepEqual([...folders], [data.dirName]);
  return { study: data, files };
}

/** Serves an imported study. `runs`: by their name, {query, result, successful, message}; `scripts`: a folder with JATOS'
    own scripts, or none. `failing` answers of a result are refused first. */
export async function jatos({ study, files }, { scripts, failing = 0 } = {}) {
  const runs = new Map();
  const component = study.componentList[0];
  const server = createServer((request, answer) => {
    const url = new URL(request.url, "http://x");
    const [, publix, name, , ...rest] = url.pathname.split("/");
    const path = rest.join("/");
    const run = runs.get(name);
    const give = (bytes, type = "application/octet-stream", status = 200) => answer.writeHead(status, { "content-type": type }).end(bytes);
    let body = "";
    request.on("data", (part) => (body += part));
    request.on("end", () => {
      if (publix !== "publix" || !run) return give("no such run", "text/plain", 404);
      if (/\/publix\/[^/]+\/end$/.test(url.pathname)) {
        run.successful = url.searchParams.get("successful") === "true";
        run.message = url.searchParams.get("message");
        return give("");
      }
      if (run.successful !== undefined && path === "start") return give("this run is finished", "text/plain", 403);
      if (path === "start") return give(files[`${study.dirName}/${component.htmlFilePath}`], types.html);
      if (path === "initData") {
        const data = { urlQueryParameters: run.query, studyProperties: {}, batchProperties: {}, componentProperties: {}, componentList: [component], studySessionData: "{}", studyCode: name };
        return give(JSON.stringify(data), types.json);
      }
      if (path === "resultData") {
        if (failing > 0) return (failing -= 1), give("", "text/plain", 503);
        if (request.method === "PUT") run.result = [];
        run.result.push(body);
        return give("");
      }
      if (path === "jatos.js") return give(scripts ? readFileSync(join(scripts, "jatos.js")) : SCRIPT, types.js);
      const script = /^jatos-publix\/javascripts\/([\w.-]+)$/.exec(path)?.[1];
      if (script && scripts && existsSync(join(scripts, script))) return give(readFileSync(join(scripts, script)), types.js);
      const file = files[`${study.dirName}/${path}`];
      // It knows no type for modules of WebAssembly.
      return file ? give(file, types[path.split(".").pop()]) : give("", "text/plain", 404);
    });
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  const base = `http://127.0.0.1:${server.address().port}`;
  return {
    base,
    runs,
    /** The address of a new run. */
    begin(name, query = {}) {
      runs.set(name, { query, result: [] });
      return `${base}/publix/${name}/${component.uuid}/start`;
    },
    close() {
      server.closeAllConnections();
      server.close();
    },
  };
}
