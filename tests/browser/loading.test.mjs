// What a trial is made of arrives late, damaged or not at all: the page shows how far it is, says what is
// wrong, tries again when asked to, and never starts half loaded.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { badProxy } from "./lib/bad_proxy.mjs";
import { executable, open, skip } from "./lib/browser.mjs";
import { go, leave, phase, place, steady } from "./lib/participant.mjs";
import { serve } from "./lib/server.mjs";
import { small, stimuli, text, trials } from "./lib/small_study.mjs";

const unable = skip(!executable && "Chromium not found");

const choice = (id, image) => ({
  id,
  type: "singleChoice",
  prompt: text("Which?"),
  options: [{ value: "a", label: text("a"), image }, { value: "b", label: text("b") }],
});
const study = small("loading", {
  demographics: { title: text("About you"), questions: [choice("who", "who.svg")] },
  questions: [choice("which", "which.svg")],
  components: { faces: trials(["joy2.box"], ["which"]) },
  sequence: { order: "fixed", components: ["faces"] },
  stimuli: stimuli({ head: { builtin: { seed: 1, vertices: 2000 } } }, { box: { method: "box" } }, [["head", "box"]]),
});
const dot = (radius) => `<svg xmlns="http://www.w3.org/2000/svg" width="40" height="40"><circle cx="20" cy="20" r="${radius}"/></svg>`;

/** Server, proxy and page of the study; the hashes of its packs. */
async function loading(locale = "en-GB") {
  const folder = mkdtempSync(join(tmpdir(), "mimique-loading-"));
  writeFileSync(join(folder, "loading.json"), JSON.stringify(study));
  writeFileSync(join(folder, "who.svg"), dot(9));
  writeFileSync(join(folder, "which.svg"), dot(15));
  const server = await serve([join(folder, "loading.json")]);
  const proxy = await badProxy(server.url);
  const browser = await open("undrawn", { viewport: { width: 600, height: 800 }, locale });
  const { clips } = await (await fetch(`${server.url}/api/studies/loading`)).json();
  const begin = async () => {
    await browser.page.goto(`${proxy.url}/s/loading/?backend=webgl2`);
    await browser.page.waitForSelector("main[data-view=consent]", { timeout: 30_000 });
    const here = await place(browser.page);
    await go(browser.page, "mouse");
    return leave(browser.page, here);
  };
  const close = async () => {
    await browser.close();
    await proxy.close();
    await server.stop();
  };
  return { proxy, page: browser.page, context: browser.context, clips, begin, close };
}

const choose = (page) => page.locator("fieldset[data-question] label").first().click();
const shown = (page) =>
  page.waitForFunction(() => document.querySelector(".choice img")?.naturalWidth === 40, undefined, { timeout: 30_000 });

test("loading: a damaged clip is asked for again by a press, and one that stalls arrives by itself", { skip: unable, timeout: 240_000 }, async () => {
  const { proxy, page, clips, begin, close } = await loading();
  const take = `/packs/${clips["joy2.box"].take}`;
  try {
    // Its take comes damaged, five times for every page that asks for it.
    proxy.rule((_, url) => (url === take ? "damaged" : undefined));
    let here = await begin();
    await choose(page);
    await go(page, "mouse");
    here = await leave(page, here);
    assert.equal(here.view, "trial");
    await phase(page, "failed", 60_000);
    // The longest pause between two tries is 4 s.
    await steady(() => proxy.counts.damaged, 5_000);
    assert.ok(proxy.counts.damaged >= 5 && proxy.counts.damaged % 5 === 0, `${proxy.counts.damaged} tries`);
    assert.match(await page.locator(".trial-message").innerText(), /could not be shown/);
    assert.match(await page.locator(".notice.bad").innerText(), /damaged.*try again/);
    assert.equal(await page.locator("[data-action=play]").count(), 0);

    // Then nothing at all comes, once.
    proxy.rule((_, url) => (url === take && proxy.counts.silent === 0 ? "silent" : undefined));
    await page.locator("[data-action=retry]").click();
    await phase(page, "loading");
    const bar = page.locator(".stage .veil progress");
    await page.waitForFunction(() => document.querySelector(".stage .veil progress")?.value > 0, undefined, { timeout: 10_000 });
    const part = Number(await bar.getAttribute("value"));
    assert.ok(part < 0.9, `${part} of the clip is there, its take is not`);
    assert.equal(await bar.getAttribute("aria-label"), await page.locator(".trial-message").innerText());
    assert.equal(await page.locator("[data-action=play]").getAttribute("aria-disabled"), "true");
    await phase(page, "ready", 60_000);
    assert.equal(proxy.counts.silent, 1);
    assert.equal(await bar.count(), 0);
    await go(page, "mouse");
    await phase(page, "answering", 60_000);
    await choose(page);
    await go(page, "mouse");
    here = await leave(page, here);
    assert.ok(["receipt", "end"].includes(here.view), here.view);
  } finally {
    await close();
  }
});

test("loading: what a proxy or a captive portal answers for a clip is no refusal: it is asked for again by itself", { skip: unable, timeout: 240_000 }, async () => {
  const { proxy, page, clips, begin, close } = await loading();
  const take = `/packs/${clips["joy2.box"].take}`;
  const pauses = [];
  let asked;
  try {
    // Forbidden, a page that says all is well, a gateway in trouble; then the way is free.
    const fates = ["foreign 403", "foreign 200", "foreign 502", "foreign 404"];
    proxy.rule((_, url) => {
      if (url !== take) return undefined;
      if (asked !== undefined) pauses.push(Date.now() - asked);
      asked = Date.now();
      return fates[proxy.counts.foreign];
    });
    await page.addInitScript(() => {
      globalThis.failures = 0;
      new MutationObserver(() => (globalThis.failures += document.querySelectorAll(".notice.bad, [data-phase=failed]").length)).observe(document, { subtree: true, childList: true, attributes: true });
    });
    let here = await begin();
    await choose(page);
    await go(page, "mouse");
    here = await leave(page, here);
    assert.equal(here.view, "trial");
    await phase(page, "ready", 60_000);
    assert.equal(proxy.counts.foreign, fates.length);
    assert.equal(pauses.length, fates.length, "asked for once more than it was refused");
    for (const [again, least] of [400, 900, 1900, 3900].entries()) assert.ok(pauses[again] >= least, `${pauses} ms between the tries`);
    assert.equal(await page.evaluate(() => globalThis.failures), 0, "nobody was asked to press a button");
  } finally {
    await close();
  }
});

test("loading: a pack that the server itself refuses is asked for once, until somebody asks again", { skip: unable, timeout: 240_000 }, async () => {
  const { proxy, page, clips, begin, close } = await loading();
  const take = `/packs/${clips["joy2.box"].take}`;
  try {
    let tries = 0;
    await page.route(`**${take}`, (route) => {
      tries++;
      return route.fulfill({ status: 404, contentType: "application/json", body: JSON.stringify({ code: "not-found", message: "gone", remedy: "reload" }) });
    });
    let here = await begin();
    await choose(page);
    await go(page, "mouse");
    here = await leave(page, here);
    await phase(page, "failed", 60_000);
    const once = tries;
    await page.waitForTimeout(1_500);
    assert.equal(tries, once, "no try by itself, of which the first would come after half a second");
    await page.unroute(`**${take}`);
    await page.locator("[data-action=retry]").click();
    await phase(page, "ready", 60_000);
    assert.equal(here.view, "trial");
  } finally {
    await close();
  }
});

test("loading: without a connection the reason is in the participant's language, and the clip comes by itself when it is back", { skip: unable, timeout: 240_000 }, async () => {
  const { page, context, clips, begin, close } = await loading("fr-FR");
  const take = `**/packs/${clips["joy2.box"].take}`;
  try {
    await page.route(take, (route) => route.abort("internetdisconnected"));
    let here = await begin();
    await choose(page);
    await go(page, "mouse");
    here = await leave(page, here);
    assert.equal(here.view, "trial");
    await phase(page, "failed", 60_000);
    const said = await page.locator(".notice.bad").innerText();
    assert.match(said, /La connexion s’est interrompue/);
    assert.doesNotMatch(said, /pack|fetch|[0-9a-f]{8}/);
    await page.unroute(take);
    await context.setOffline(true);
    await context.setOffline(false);
    // Nobody presses anything.
    await phase(page, "ready", 60_000);
  } finally {
    await close();
  }
});

test("loading: no trial starts without its pictures, and a page says which is missing", { skip: unable, timeout: 240_000 }, async () => {
  const { proxy, page, clips, begin, close } = await loading();
  const pack = (path) => `/packs/${clips[`media:${path}`].avatar}`;
  const failed = [pack("who.svg"), pack("which.svg")];
  try {
    proxy.rule((_, url) => (failed.includes(url) ? "damaged" : undefined));
    let here = await begin();
    await page.waitForSelector("main[data-view=questions] .notice.bad", { timeout: 60_000 });
    assert.match(await page.locator(".notice.bad").innerText(), /picture or a video.*could not be shown.*damaged/s);
    failed.shift();
    await page.locator("[data-action=retry]").click();
    await shown(page);
    assert.equal(await page.locator(".notice.bad").count(), 0);
    await choose(page);
    await go(page, "mouse");
    here = await leave(page, here);
    assert.equal(here.view, "trial");

    await phase(page, "failed", 60_000);
    assert.match(await page.locator(".trial-message").innerText(), /picture or a video/);
    failed.shift();
    await page.locator("[data-action=retry]").click();
    await phase(page, "ready", 60_000);
    await go(page, "mouse");
    await phase(page, "answering", 60_000);
    // It was there before the clip: it does not have to come now.
    assert.equal(await page.locator(".choice img").evaluate((image) => image.complete && image.naturalWidth), 40);
  } finally {
    await close();
  }
});
