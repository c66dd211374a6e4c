// A study hosted as plain files, without the server: taken part in with a reload, downloaded and posted,
// imported; the import is what was clicked.

import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join, normalize } from "node:path";
import { test } from "node:test";
import { looker } from "./lib/access.mjs";
import { executable, open, screenshotFolder, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { answer, go, leave, phase, place } from "./lib/participant.mjs";
import { mimique } from "./lib/server.mjs";
import { small, stimuli, text, trials } from "./lib/small_study.mjs";

const unable = skip(executable ? false : "Chromium not found");
const types = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".json": "application/json", ".wasm": "application/wasm", ".svg": "image/svg+xml" };

/** A web host that knows nothing but files. */
function fileHost(folder, posts) {
  const host = createServer((request, answer) => {
    const path = normalize(decodeURIComponent(new URL(request.url, "http://x").pathname));
    if (request.method === "POST") {
      let body = "";
      request.on("data", (part) => (body += part));
      request.on("end", () => {
        posts.push({ path, body, type: request.headers["content-type"] });
        // The first time the other site is out of order.
        answer.writeHead(posts.length === 1 ? 503 : 204, { "access-control-allow-origin": "*" }).end();
      });
      return;
    }
    const file = join(folder, path.replace(/^\/study/, ""), path.endsWith("/") ? "index.html" : "");
    if (!path.startsWith("/study/") || !existsSync(file)) return answer.writeHead(404).end();
    answer.writeHead(200, { "content-type": types[extname(file)] ?? "application/octet-stream" }).end(readFileSync(file));
  });
  return new Promise((done) => host.listen(0, "127.0.0.1", () => done(host)));
}

test("site: a study on a plain web host, downloaded, posted and imported", { skip: unable, timeout: 240_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "mimique-site-"));
  const posts = [];
  const site = join(folder, "site");
  const host = await fileHost(site, posts);
  const base = `http://127.0.0.1:${host.address().port}`;
  const rating = { id: "rating", type: "likert", prompt: text("How strong?"), numItems: 7, leftLabel: text("weak"), rightLabel: text("strong") };
  const study = small("plain", {
    recruitment: { completionCode: "PLAIN", urlParameters: ["PROLIFIC_PID"], redirect: "https://example.org/?cc={code}&who={PROLIFIC_PID}" },
    demographics: { questions: [{ ...rating, id: "mood" }] },
    screening: [{ if: { question: "mood", atMost: 1 }, reason: text("Not today.") }],
    questions: [rating],
    components: { faces: trials(["joy2.box"], ["rating"]) },
    sequence: { order: "fixed", components: ["faces"] },
    staticHosting: { post: `${base}/take/{session}`, download: true },
    stimuli: stimuli({ head: { builtin: { seed: 1 } } }, { box: { method: "box" } }, [["head", "box"]]),
  });
  const file = join(folder, "plain.json");
  writeFileSync(file, JSON.stringify(study));
  const pages = process.env.MIMIQUE_WEB_DIR ? ["--web-dir", process.env.MIMIQUE_WEB_DIR] : [];
  mimique(["export-site", file, "--out", site, "--packs", join(folder, "packs"), ...pages]);
  const browser = await open("undrawn", { viewport: { width: 800, height: 900 } });
  const { page } = browser;
  const { look } = looker(page, screenshotFolder("site"));
  const given = [];
  try {
    await page.goto(`${base}/study/?backend=webgl2&PROLIFIC_PID=a%20b`);
    await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
    let here = await place(page);
    for (let guard = 0; here.view !== "end" && guard < 12; guard++) {
      if (here.view === "trial") {
        // Nothing is lost by a reload here either.
        await page.reload();
        await page.waitForSelector("main[data-view=trial]", { timeout: 30_000 });
        await phase(page, "ready", 120_000);
        await go(page, "mouse");
        await phase(page, "answering", 120_000);
        here = await place(page);
      }
      if (here.view === "trial" || here.view === "questions") {
        for (const one of await answer(page, "mouse", here.step)) given.push(`${one.question} = ${one.value}`);
      }
      if (here.view !== "receipt") await go(page, "mouse");
      here = await leave(page, here, 60_000);
    }
    assert.equal(await page.locator("[data-code=completion]").textContent(), "PLAIN");
    assert.equal(await page.locator("a.button.primary").getAttribute("href"), "https://example.org/?cc=PLAIN&who=a%20b");
    await look("end");
    const [download] = await Promise.all([page.waitForEvent("download"), page.locator("[data-action=download]").click()]);
    const saved = join(folder, download.suggestedFilename());
    await download.saveAs(saved);
    const elsewhere = browser.requests.filter((url) => !url.startsWith(base) && !/^(data|blob):/.test(url));
    assert.deepEqual(elsewhere, [], "no request but to the host and the study's own address");

    // Posted again after the other site was out of order, and the same as the file.
    assert.ok(posts.length >= 2, `${posts.length} posts`);
    assert.equal(posts.at(-1).body, readFileSync(saved, "utf8"));
    assert.match(posts.at(-1).path, /^\/take\/s[0-9a-f]{8}$/);
    const posted = join(folder, "posted.jsonl");
    writeFileSync(posted, posts.at(-1).body);
    const receipt = await page.locator("[data-code=receipt]").textContent();
    assert.ok(readFileSync(saved, "utf8").trimEnd().endsWith(`"sha256":"${receipt}"}`), "the receipt is the file's hash");

    const csv = join(folder, "answers.csv");
    mimique(["import", file, saved, posted, "--site", site, "--out", csv]);
    const rows = parse(readFileSync(csv, "utf8"));
    assert.deepEqual(rows.map((row) => `${row.response_id} = ${row.answer}`).sort(), given.sort(), "once each");
    assert.ok(rows.every((row) => row.status === "completed" && row.interruptions !== ""));
    assert.match(rows.find((row) => row.trial_type === "trial").provenance, /^[0-9a-f]{64}$/);

    // What was cut off or changed is refused by name.
    writeFileSync(posted, posts.at(-1).body.slice(0, -40));
    assert.throws(() => mimique(["import", file, posted, "--out", csv], { stdio: "pipe" }), (error) => {
      assert.equal(error.status, 2);
      assert.match(error.stderr, /posted\.jsonl: line \d+: .*; .*/);
      return true;
    });
    // Who is screened out has no code here, and so no way back as one who has finished.
    const second = await open("undrawn", {});
    try {
      await second.page.goto(`${base}/study/?backend=webgl2&PROLIFIC_PID=c`);
      await second.page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
      await go(second.page, "mouse");
      await second.page.locator("fieldset[data-question=mood] label:has(input[value='1'])").click();
      await go(second.page, "mouse");
      await second.page.waitForSelector("main[data-outcome=screened_out]", { timeout: 60_000 });
      assert.equal(await second.page.locator("[data-code=completion], a.button.primary").count(), 0);
    } finally {
      await second.close();
    }
    const unexpected = browser.errors.filter((text) => !/503/.test(text));
    assert.deepEqual(unexpected, [], "the console is clean");
  } finally {
    await browser.close();
    host.closeAllConnections();
    host.close();
  }
});
