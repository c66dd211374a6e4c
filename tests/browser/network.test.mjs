// A network that is worse than slow: requests that nobody ever answers, and pages of somebody else where
// the server's answers should be. The session goes on where it was, and nothing that waits is given up.

import assert from "node:assert/strict";
import { test } from "node:test";
import { badProxy } from "./lib/bad_proxy.mjs";
import { executable, open, skip } from "./lib/browser.mjs";
import { go, leave, place, until } from "./lib/participant.mjs";
import { serve } from "./lib/server.mjs";

const unable = skip(!executable && "Chromium not found");
const age = "fieldset[data-question=age] input";

/** The server, a proxy before it, and a page that opens the demo through both. */
async function network() {
  const server = await serve(["study-config/demo.json"]);
  const proxy = await badProxy(server.url);
  const browser = await open("undrawn", { viewport: { width: 600, height: 700 } });
  const { page } = browser;
  const close = async () => {
    await browser.close();
    await proxy.close();
    await server.stop();
  };
  const session = () => page.evaluate(() => JSON.parse(localStorage.getItem("mimique/demo"))?.started);
  /** Status and answer of the server itself. */
  const stored = async () => {
    const answer = await fetch(`${server.url}/api/sessions/${(await session()).session}`);
    return { status: answer.status, events: (await answer.json()).events };
  };
  return { server, proxy, page, close, session, stored };
}

const answered = (events) => events.filter(({ body }) => body.type === "answered").map(({ body }) => body.value);

/** From the agreement to the first questions. */
async function agree(page) {
  await page.waitForSelector("main[data-view=consent]", { timeout: 60_000 });
  const here = await place(page);
  await go(page, "mouse");
  return leave(page, here, 60_000);
}

test("network: a start and an append that nobody answers are asked again", { skip: unable, timeout: 240_000 }, async () => {
  const { proxy, page, close, session, stored } = await network();
  const silentOnce = (path) => {
    const before = proxy.counts.silent;
    proxy.rule((method, url) => (method === "POST" && url.endsWith(path) && proxy.counts.silent === before ? "silent" : undefined));
  };
  try {
    silentOnce("/sessions");
    await page.goto(`${proxy.url}/s/demo/?backend=webgl2`);
    const agreed = agree(page);
    await until("the start is swallowed", () => proxy.counts.silent === 1);
    assert.equal((await place(page)).view, "opening");
    await agreed;
    assert.equal((await session()).participant, 1, "the same session, asked for twice");
    await until("the agreement is stored", async () => (await stored()).events.some(({ body }) => body.type === "consented"));

    silentOnce("/events");
    await page.locator(age).fill("41");
    await page.locator(age).blur();
    await until("the append is swallowed", () => proxy.counts.silent === 2);
    assert.deepEqual(answered((await stored()).events), []);
    await until("it is sent again", async () => answered((await stored()).events).length === 1);
    assert.deepEqual(answered((await stored()).events), [41], "once");
  } finally {
    await close();
  }
});

test("network: what somebody else answers ends and deletes nothing", { skip: unable, timeout: 240_000 }, async () => {
  const { proxy, page, close, session, stored } = await network();
  const filter = () => proxy.rule((_, url) => (url.startsWith("/api/") ? "foreign" : undefined));
  const open = () => proxy.rule(() => undefined);
  try {
    await page.goto(`${proxy.url}/s/demo/?backend=webgl2`);
    await agree(page);
    const begun = await session();
    await until("the agreement is stored", async () => (await stored()).events.some(({ body }) => body.type === "consented"));

    filter();
    await page.locator(age).fill("41");
    await page.locator(age).blur();
    await page.waitForSelector(".site-notices .notice.warn", { timeout: 60_000 });
    assert.match(await page.locator(".site-notices").innerText(), /The connection is lost/);

    // A reload: the study cannot be reached, and nobody is forgotten for that.
    await page.reload();
    await page.waitForSelector("main[data-view=failure]", { timeout: 120_000 });
    assert.match(await page.locator("h1").innerText(), /cannot be reached/);
    assert.deepEqual(await session(), begun);
    // The same where the study is had and the session is not.
    proxy.rule((_, url) => (url.startsWith("/api/sessions/") ? "foreign" : undefined));
    await page.locator("button.primary").click();
    await page.waitForSelector("main[data-view=opening]");
    await page.waitForSelector("main[data-view=failure]", { timeout: 120_000 });
    assert.deepEqual(await session(), begun);

    open();
    await page.locator("button.primary").click();
    await page.waitForSelector("main[data-view=questions]", { timeout: 60_000 });
    assert.equal(await page.locator(age).inputValue(), "41");
    await until("the answer is stored", async () => answered((await stored()).events).length === 1);
    assert.deepEqual(await session(), begun, "the same session");

    // Nobody is told that answers are deleted while they are not.
    filter();
    await page.locator("[data-action=withdraw]").click();
    await page.locator("[data-action=withdraw-confirm]").click();
    await page.waitForSelector("main[data-view=withdrawn]");
    const refused = proxy.counts.foreign;
    await until("the withdrawal is tried again", () => proxy.counts.foreign >= refused + 2);
    assert.equal(await page.locator("main").getAttribute("data-confirmed"), "false");
    open();
    await page.waitForSelector("main[data-confirmed=true]", { timeout: 60_000 });
    await page.waitForFunction(() => localStorage.getItem("mimique/demo") === null);
  } finally {
    await close();
  }
});

test("network: a proxy that forwards small bodies only is sent fewer events at a time", { skip: unable, timeout: 240_000 }, async () => {
  const { proxy, page, close, stored } = await network();
  const atMost = (events) => proxy.rule((method, url, body) => (method === "POST" && url.endsWith("/events") && JSON.parse(body).events.length > events ? "foreign 413" : undefined));
  const notices = page.locator(".site-notices");
  const fill = async (value) => {
    await page.locator(age).fill(value);
    await page.locator(age).blur();
  };
  try {
    await page.goto(`${proxy.url}/s/demo/?backend=webgl2`);
    await agree(page);
    // What waits in the meantime is more than one event.
    proxy.rule((_, url) => (url.endsWith("/events") ? "foreign" : undefined));
    await fill("41");
    await page.waitForSelector(".site-notices .notice.warn", { timeout: 60_000 });
    await fill("42");
    atMost(1);
    await until("everything is stored", async () => answered((await stored()).events).at(-1) === 42);
    assert.deepEqual(answered((await stored()).events), [41, 42]);
    assert.ok(proxy.counts.foreign > 1);
    // Not even one passes: the page says so, and does not speak of the connection.
    atMost(0);
    await fill("43");
    await page.waitForFunction(() => /too long/.test(document.querySelector(".site-notices")?.innerText), null, { timeout: 60_000 });
    assert.doesNotMatch(await notices.innerText(), /connection is lost/);
    atMost(50);
    await page.reload();
    await until("it is stored after all", async () => answered((await stored()).events).at(-1) === 43);
  } finally {
    await close();
  }
});
