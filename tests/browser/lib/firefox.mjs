// Debian's Firefox by WebDriver BiDi, spoken directly: no driver beside it is needed.

import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import WebSocket from "ws";

const candidates = [process.env.MIMIQUE_FIREFOX, "/usr/bin/firefox-esr", "/usr/bin/firefox"];
export const firefox = candidates.find((path) => path && existsSync(path));

/** A display in memory, `{DISPLAY, close()}`: without one Firefox draws no WebGL. None where there is
    no Xvfb. */
async function display() {
  if (!existsSync("/usr/bin/Xvfb")) return null;
  const server = spawn("/usr/bin/Xvfb", ["-displayfd", "3", "-screen", "0", "1280x1024x24", "-nolisten", "tcp"], {
    stdio: ["ignore", "ignore", "ignore", "pipe"],
  });
  const gone = new Promise((done) => server.once("exit", done));
  const number = await new Promise((found, fail) => {
    server.stdio[3].once("data", (text) => found(String(text).trim()));
    gone.then(() => fail(new Error("Xvfb ended")));
  });
  return { DISPLAY: `:${number}`, close: async () => (server.kill("SIGTERM"), gone) };
}

/** A Firefox with a fresh profile: `{evaluate(code), goto(url), screenshot(path), errors, close()}`. */
export async function openFirefox({ width = 1000, height = 900, preferences: own = {} } = {}) {
  const profile = mkdtempSync(join(tmpdir(), "mimique-firefox-"));
  // Graphics in software, as far as this machine has a driver for it.
  const preferences = { "webgl.force-enabled": true, "webgl.disable-fail-if-major-performance-caveat": true, "gfx.webrender.software": true, ...own };
  const lines = Object.entries(preferences).map(([name, value]) => `user_pref("${name}", ${value});`);
  writeFileSync(join(profile, "user.js"), lines.join("\n"));
  const screen = await display();
  const child = spawn(firefox, [...(screen ? [] : ["--headless"]), "--no-remote", "--profile", profile, "--remote-debugging-port", "0", `--width=${width}`, `--height=${height}`], {
    stdio: ["ignore", "pipe", "pipe"],
    env: { ...process.env, ...(screen && { DISPLAY: screen.DISPLAY }), MOZ_REMOTE_ALLOW_SYSTEM_ACCESS: "1" },
  });
  const gone = new Promise((done) => child.on("exit", done));
  let said = "";
  const address = await new Promise((found, fail) => {
    const timer = setTimeout(() => fail(new Error(`Firefox did not come up:\n${said}`)), 60_000);
    const listen = (text) => {
      said += text;
      const match = /WebDriver BiDi listening on (ws:\/\/\S+)/.exec(said);
      if (match) (clearTimeout(timer), found(match[1]));
    };
    child.stdout.on("data", listen);
    child.stderr.on("data", listen);
    gone.then(() => fail(new Error(`Firefox ended:\n${said}`)));
  });
  const socket = new WebSocket(`${address}/session`);
  await new Promise((done, fail) => ((socket.onopen = done), (socket.onerror = () => fail(new Error("no connection to Firefox")))));
  const waiting = new Map();
  const errors = [];
  let last = 0;
  socket.onmessage = ({ data }) => {
    const message = JSON.parse(data);
    const job = waiting.get(message.id);
    if (message.method === "log.entryAdded" && message.params.level === "error") errors.push(message.params.text);
    if (!job) return;
    waiting.delete(message.id);
    if (message.type === "error") job.fail(new Error(`${message.error}: ${message.message}`));
    else job.done(message.result);
  };
  const command = (method, params) =>
    new Promise((done, fail) => {
      waiting.set(++last, { done, fail });
      socket.send(JSON.stringify({ id: last, method, params }));
    });
  await command("session.new", { capabilities: {} });
  const { contexts } = await command("browsingContext.getTree", {});
  const context = contexts[0].context;
  await command("session.subscribe", { events: ["log.entryAdded"] });
  return {
    errors,
    goto: (url) => command("browsingContext.navigate", { context, url, wait: "interactive" }),
    /** The value of an expression, by way of JSON. */
    evaluate: async (code) => {
      const answer = await command("script.evaluate", { expression: `Promise.resolve(${code}).then((value) => JSON.stringify(value ?? null))`, target: { context }, awaitPromise: true });
      if (answer.type === "exception") throw new Error(answer.exceptionDetails.text);
      return JSON.parse(answer.result.value);
    },
    screenshot: async (path) => {
      const { data } = await command("browsingContext.captureScreenshot", { context });
      writeFileSync(path, Buffer.from(data, "base64"));
    },
    close: async () => {
      await command("browser.close", {}).catch(() => {});
      socket.close();
      const kill = setTimeout(() => child.kill("SIGKILL"), 10_000);
      await gone;
      clearTimeout(kill);
      await screen?.close();
    },
  };
}
