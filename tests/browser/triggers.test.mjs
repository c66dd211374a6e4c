// Triggers: a program on this machine is told of onset, frames, end and answers; it may come late, and be away.

import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { mkdtempSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { executable, open, skip } from "./lib/browser.mjs";
import { parse } from "./lib/csv.mjs";
import { answer, go, leave, phase, place } from "./lib/participant.mjs";
import { mimique, serve } from "./lib/server.mjs";
import { small, stimuli, text, trials } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");

/** A laboratory's program: accepts one WebSocket and keeps what it is told. */
async function laboratory(port) {
  const heard = [];
  const sockets = new Set();
  const server = createServer();
  server.on("upgrade", (request, socket) => {
    const key = `${request.headers["sec-websocket-key"]}258EAFA5-E914-47DA-95CA-C5AB0DC85B11`;
    const accept = createHash("sha1").update(key).digest("base64");
    socket.write(`HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: ${accept}\r\n\r\n`);
    sockets.add(socket);
    let waiting = Buffer.alloc(0);
    socket.on("data", (data) => {
      waiting = Buffer.concat([waiting, data]);
      for (;;) {
        if (waiting.length < 2) return;
        let [length, at] = [waiting[1] & 127, 2];
        if (length === 126) [length, at] = [waiting.readUInt16BE(2), 4];
        if (waiting.length < at + 4 + length) return;
        const mask = waiting.subarray(at, at + 4);
        const body = Buffer.from(waiting.subarray(at + 4, at + 4 + length).map((byte, k) => byte ^ mask[k % 4]));
        const opcode = waiting[0] & 15;
        waiting = waiting.subarray(at + 4 + length);
        if (opcode === 1) heard.push(JSON.parse(body.toString()));
      }
    });
    socket.on("error", () => {});
    // A frame of text, short enough for one byte of length.
    socket.write(Buffer.concat([Buffer.from([0x81, 5]), Buffer.from("hello")]));
  });
  await new Promise((resolve) => server.listen(port, "127.0.0.1", resolve));
  return {
    heard,
    port: server.address().port,
    stop: () => {
      for (const socket of sockets) socket.destroy();
      return new Promise((resolve) => server.close(resolve));
    },
  };
}

const study = (port) => small("triggers", {
  triggers: { port, frames: true },
  questions: [{ id: "good", type: "likert", prompt: text("Good?"), numItems: 7, start: 1, leftLabel: text("no"), rightLabel: text("yes") }],
  components: { faces: trials(["joy2.box", "joy2.real"], ["good"]) },
  sequence: { order: "fixed", components: ["faces"] },
  stimuli: stimuli(
    { head: { builtin: { seed: 1 } } },
    { box: { method: "box" }, real: { method: "recorded" } },
    [["head", "box"], ["head", "real"]],
  ),
});

test("triggers: onset, frames, end and answers, by the page's clock; without the program the study goes on", { skip: unable, timeout: 300_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), "mimique-triggers-"));
  let lab = await laboratory(0);
  writeFileSync(join(folder, "triggers.json"), JSON.stringify(study(lab.port)));
  const server = await serve([join(folder, "triggers.json")]);
  const browser = await open("undrawn");
  const { page } = browser;
  try {
    await page.goto(`${server.url}/s/triggers/?backend=webgl2`);
    await page.waitForSelector("main[data-view]", { timeout: 30_000 });
    let here = await place(page);
    let shown = 0;
    while (here.view !== "end") {
      if (here.view === "receipt") {
        here = await leave(page, here, 60_000);
        continue;
      }
      if (here.view === "trial") {
        shown += 1;
        await phase(page, "ready", 120_000);
        // Before the second trial the laboratory's program goes away.
        if (shown === 2) await lab.stop();
        await go(page, "mouse");
        await phase(page, "answering", 120_000);
        await answer(page, "mouse", here.step);
      }
      await go(page, "mouse");
      here = await leave(page, here, 60_000);
    }
    assert.equal(shown, 2);

    const rows = parse(mimique(["export", "--database", server.database, "--format", "csv"])).filter((row) => row.trial_type === "trial");
    const { heard } = lab;
    assert.deepEqual(heard.map(({ number }) => number), heard.map((_, k) => k), "numbered without a gap");
    assert.ok(heard.some(({ trigger, ping }) => trigger === "pong" && ping === "hello"), "a ping comes back");
    const onset = heard.find(({ trigger }) => trigger === "onset");
    assert.deepEqual([onset.clip, onset.beside], ["joy2.box", null]);
    const begun = heard.find(({ event }) => event?.type === "trial_started");
    assert.ok(begun.event.step === "faces/joy2.box" && begun.number < onset.number, "the trial is named before its onset");
    const end = heard.find(({ trigger }) => trigger === "end");
    assert.ok(end.timeMs - onset.timeMs >= 3_950, `a clip of 4 s: ${end.timeMs - onset.timeMs}`);
    const frames = heard.filter(({ trigger }) => trigger === "frame");
    assert.ok(frames.length >= 2 && frames.every((frame, k) => k === 0 || frame.clipMs > frames[k - 1].clipMs), "frames in order");
    const own = rows.find((row) => row.stimulus === "joy2.box");
    assert.equal(Number(own.frames), frames.length + 1, "every frame of the log is told, the first as the onset");
    assert.equal(Number(own.triggers_sent), frames.length + 2);
    const events = heard.filter(({ trigger }) => trigger === "event").map(({ event }) => event);
    assert.ok(events.some(({ type, question, value }) => type === "answered" && question === "good" && String(value) === own.answer));
    assert.ok(!events.some(({ type }) => type === "trial_played"), "a play is told by its frames");
    // Times are those of the log.
    const log = mimique(["export", "--database", server.database, "--format", "events"]).split("\n").filter(Boolean).map((line) => JSON.parse(line));
    const played = log.map(({ body }) => body).find((body) => body?.type === "trial_played" && body.step === "faces/joy2.box");
    assert.ok(Math.abs(played.log.onset_ms - onset.timeMs) < 0.01, `${played.log.onset_ms} ${onset.timeMs}`);
    const away = rows.find((row) => row.stimulus === "joy2.real");
    assert.equal(away.triggers_sent, "", "nothing was told while the program was away");
    assert.ok(Number(away.frames) >= 2, "and the clip was played");
  } finally {
    await browser.close();
    await server.stop();
    await lab.stop().catch(() => {});
  }
});
