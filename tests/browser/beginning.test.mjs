// The first page stands, or says why not: with all cookies blocked, and with whatever throws or hangs before it.

import assert from "node:assert/strict";
import { mkdirSync, mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { badProxy } from "./lib/bad_proxy.mjs";
import { executable, open, skip } from "./lib/browser.mjs";
import { firefox, openFirefox } from "./lib/firefox.mjs";
import { go, leave, place, until } from "./lib/participant.mjs";
import { serve } from "./lib/server.mjs";
import { small, stimuli, text, trials } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");
const noFirefox = skip(!firefox && "Firefox not found");

const study = small("beginning", {
  demographics: {
    title: text("About you"),
    questions: [{ id: "age", type: "number", prompt: text("How old are you?"), minimum: 18, maximum: 99, integer: true }],
  },
  questions: [{ id: "rating", prompt: text("How strong?"), type: "likert", numItems: 7, leftLabel: text("weak"), rightLabel: text("strong") }],
  components: { faces: trials(["joy2.box"], ["rating"]) },
  sequence: { order: "fixed", components: ["faces"] },
  stimuli: stimuli({ head: { builtin: { seed: 1, vertices: 2000 } } }, { box: { method: "box" } }, [["head", "box"]]),
});

function written() {
  const folder = mkdtempSync(join(tmpdir(), "mimique-beginning-"));
  writeFileSync(join(folder, "beginning.json"), JSON.stringify(study));
  return join(folder, "beginning.json");
}

/** A profile in which sites may keep nothing. */
function blockedProfile() {
  const profile = mkdtempSync(join(tmpdir(), "mimique-blocked-"));
  mkdirSync(join(profile, "Default"));
  const preferences = { profile: { default_content_setting_values: { cookies: 2 } } };
  writeFileSync(join(profile, "Default/Preferences"), JSON.stringify(preferences));
  return profile;
}

test("beginning: all cookies blocked in Chromium, the study goes on and says that nothing is kept", { skip: unable, timeout: 240_000 }, async () => {
  const server = await serve([written()]);
  const browser = await open("undrawn", { profile: blockedProfile() });
  const { page } = browser;
  try {
    await page.goto(`${server.url}/s/beginning/?backend=webgl2`);
    assert.equal(await page.evaluate(() => { try { return typeof localStorage; } catch (error) { return error.name; } }), "SecurityError", "cookies are blocked");
    await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
    const here = await place(page);
    await go(page, "mouse");
    await leave(page, here);
    await page.waitForSelector(".site-notices .notice.warn", { timeout: 30_000 });
    assert.match(await page.locator(".site-notices").innerText(), /keeps nothing on this device/);
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("beginning: all cookies blocked in Firefox", { skip: noFirefox, timeout: 240_000 }, async () => {
  const server = await serve([written()]);
  const browser = await openFirefox({ preferences: { "network.cookie.cookieBehavior": 2 } });
  try {
    await browser.goto(`${server.url}/s/beginning/?backend=webgl2`);
    const view = () => browser.evaluate("document.querySelector('main[data-view]')?.dataset.view");
    await until("consent", async () => (await view()) === "consent", 30_000);
    await browser.evaluate("document.querySelector('[data-action=agree]').click()");
    await until("the notice", async () => /keeps nothing/.test(await browser.evaluate("document.querySelector('.site-notices')?.textContent ?? ''")), 30_000);
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("beginning: whatever throws before the first page is told in the participant's language, and taken back when the page comes", { skip: unable, timeout: 240_000 }, async () => {
  const server = await serve([written()]);
  const browser = await open("undrawn", { locale: "fr-FR" });
  const { page } = browser;
  const address = `${server.url}/s/beginning/?backend=webgl2`;
  try {
    // Its own part of the browser throws where nobody looks.
    await page.addInitScript(() => {
      const languages = Object.getOwnPropertyDescriptor(Navigator.prototype, "languages");
      Object.defineProperty(Navigator.prototype, "languages", { get: () => { if (globalThis.whole) return languages.get.call(navigator); throw new Error("no languages here"); } });
    });
    await page.goto(address);
    await page.waitForSelector("main[data-view=stuck]", { timeout: 30_000 });
    assert.match(await page.locator("main[data-view=stuck]").innerText(), /Cette page ne peut pas démarrer/);
    assert.equal(await page.locator("main[data-view=stuck] button").innerText(), "Recharger la page");

    // A script of somebody else throws, and the page comes all the same.
    await page.addInitScript(() => (globalThis.whole = true));
    await page.addInitScript(() => addEventListener("DOMContentLoaded", () => setTimeout(() => { throw new Error("an extension's"); })));
    await page.goto(address);
    await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
    assert.equal(await page.locator("main[data-view=stuck]").count(), 0);
    assert.ok(await page.locator("main[data-view=consent]").isVisible());
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("beginning: a page whose script never comes says so", { skip: unable, timeout: 240_000 }, async () => {
  const server = await serve([written()]);
  const browser = await open("undrawn");
  const { page } = browser;
  try {
    await page.route("**/app_bg.wasm", () => {});
    await page.goto(`${server.url}/s/beginning/?backend=webgl2`, { waitUntil: "commit" });
    await page.waitForSelector("main[data-view=stuck]", { timeout: 40_000 });
    assert.match(await page.locator("main[data-view=stuck]").innerText(), /takes long to start/);
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("beginning: a click after an error on a number field is not lost", { skip: unable, timeout: 240_000 }, async () => {
  const server = await serve([written()]);
  const browser = await open("undrawn");
  const { page } = browser;
  try {
    await page.goto(`${server.url}/s/beginning/?backend=webgl2`);
    await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
    await go(page, "mouse");
    await page.waitForSelector("main[data-view=questions]", { timeout: 30_000 });
    const next = page.locator("[data-action=next]");
    await next.click();
    await page.waitForSelector(".problem");
    await page.locator("fieldset[data-question=age] input").click();
    await page.keyboard.type("30");
    // As a hand presses: at the lower edge of the button, and not at once let go.
    const box = await next.boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height - 6);
    await page.mouse.down();
    await page.waitForTimeout(150);
    assert.deepEqual(await next.boundingBox(), box, "what is pressed stays where it is");
    await page.mouse.up();
    await page.waitForFunction(() => document.querySelector("main[data-view]").dataset.view !== "questions", undefined, { timeout: 10_000 });
  } finally {
    await browser.close();
    await server.stop();
  }
});

test("beginning: title and agreement can be read before the page's module is there, in the language it will have", { skip: unable, timeout: 240_000 }, async () => {
  const server = await serve([written()]);
  const proxy = await badProxy(server.url);
  const address = `${proxy.url}/s/beginning/?backend=webgl2`;
  const asked = async (path, languages) => (await fetch(path, { headers: { "accept-language": languages } })).text();
  assert.match(await asked(address, "de, fr-CA;q=0.8, en;q=0.5"), /<html lang="fr">[^]*<main[^>]*>[^]*<h1>/);
  assert.match(await asked(`${address}&lang=en`, "fr"), /<html lang="en">/);
  const browser = await open("undrawn", { locale: "fr-FR" });
  const { page } = browser;
  try {
    proxy.rule((_, path) => (path.includes("app_bg.wasm") ? "silent" : undefined));
    await page.goto(address, { waitUntil: "domcontentloaded" });
    const words = () => page.evaluate(() => [...document.querySelectorAll("main :is(h1, h2, section p, .languages button)")].map((part) => part.innerText));
    const places = () => page.evaluate(() => [...document.querySelectorAll("main :is(h1, h2, section p)")].map((part) => Math.round(part.getBoundingClientRect().top)));
    await page.waitForSelector("main[data-view=opening] h1");
    const [before, stood] = [await words(), await places()];
    assert.ok(before.length >= 4, before.join(" | "));
    assert.equal(await page.locator("main :is(a, button:not(:disabled))").count(), 2, "the contacts' addresses, and nothing that does nothing");
    proxy.rule(() => undefined);
    await page.reload();
    await page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
    assert.deepEqual(await words(), before, "the same page");
    assert.deepEqual(await places(), stood, "nothing has moved");
    // In the middle of a session somebody else's first page is not shown again.
    const here = await place(page);
    await go(page, "mouse");
    await leave(page, here);
    proxy.rule((_, path) => (path.includes("/api/") ? "silent" : undefined));
    await page.reload();
    await page.waitForFunction(() => document.querySelector("main[data-view=opening]")?.innerText.trim() === "…", null, { timeout: 30_000 });
  } finally {
    await browser.close();
    await proxy.close();
    await server.stop();
  }
});
