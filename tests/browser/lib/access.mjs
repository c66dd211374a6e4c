// What everybody needs of a page: axe against WCAG 2.2 AA, one main heading, nothing sideways.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
/** WCAG 2.2 AA, as axe's tags. */
export const WCAG = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"];

/** What axe finds on the page as it stands, or in the part of it that a selector names. `except`: pairs of a rule and of what
    the HTML of an element has that need not keep it. */
export async function violations(page, part = "html", { tags = [...WCAG, "best-practice"], except = [] } = {}) {
  // Not by a script element: the pages allow none but their own.
  await page.evaluate(axe);
  return page.evaluate(async ([part, tags, except]) => {
    // A colour on its way to another is not what anybody reads.
    const changing = document.getAnimations().filter((animation) => animation instanceof CSSTransition);
    await Promise.allSettled(changing.map((animation) => animation.finished));
    const { violations } = await window.axe.run(part, { runOnly: { type: "tag", values: tags } });
    const meant = (id, node) => except.some(([rule, piece]) => id === rule && node.html.includes(piece));
    return violations
      .map(({ id, help, nodes }) => ({ id, help, nodes: nodes.filter((node) => !meant(id, node)) }))
      .filter(({ nodes }) => nodes.length > 0)
      .map(({ id, help, nodes }) => `${id}: ${help}: ${nodes.map((node) => node.html.slice(0, 160)).join(" | ")}`);
  }, [part, tags, except]);
}

/** What sticks out of the window or its card, is cut off, or stands letter below letter: a tag and its text each. */
export function lost(page) {
  return page.evaluate(() => {
    const wide = document.documentElement.clientWidth;
    const named = (element) => `${element.tagName.toLowerCase()}.${element.className}: ${(element.textContent || element.ariaLabel || "").trim().slice(0, 60)}`;
    const outside = (element) => {
      const { left, right, width } = element.getBoundingClientRect();
      const card = element.parentElement?.closest(".card")?.getBoundingClientRect() ?? { left: 0, right: wide };
      return width > 1 && (left < card.left - 1 || right > card.right + 1);
    };
    // Four lines and more of words for which there is no room.
    const squeezed = (element) => {
      const { width, height } = element.getBoundingClientRect();
      const size = parseFloat(getComputedStyle(element).fontSize);
      const words = [...element.childNodes].some((node) => node.nodeType === Node.TEXT_NODE && node.data.trim().length >= 4);
      return words && width < 2 * size && height > 4 * size;
    };
    const cut = (element) => {
      const { overflowX, overflowY } = getComputedStyle(element);
      const hides = (overflow) => overflow === "hidden" || overflow === "clip";
      return (hides(overflowX) && element.scrollWidth > element.clientWidth + 1) || (hides(overflowY) && element.scrollHeight > element.clientHeight + 1);
    };
    // What nobody sees, and the card that may be larger than the screen.
    const meant = (element) => element.closest(".visually-hidden, .skip-link, .bank-card-frame, dialog:not([open])");
    return [...document.body.querySelectorAll("*")].filter((element) => !meant(element) && (outside(element) || cut(element) || squeezed(element) || (element.localName === "video" && element.clientWidth < 100))).map(named);
  });
}

/** A function that looks at the page as it stands, keeps a picture of it, and names it in `seen`. */
export function looker(page, folder, zoom = 1) {
  const seen = [];
  const look = async (name) => {
    seen.push(name);
    if (zoom !== 1) await page.evaluate((factor) => (document.documentElement.style.fontSize = `${factor * 100}%`), zoom);
    await page.screenshot({ path: join(folder, `${seen.length}-${name}.png`), fullPage: true });
    assert.deepEqual(await violations(page), [], `${name}: axe`);
    const sideways = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
    assert.ok(sideways <= 0, `${name} scrolls sideways by ${sideways} px`);
    assert.deepEqual(await lost(page), [], `${name}: no room for it`);
    const headings = await page.locator("h1").count();
    assert.equal(headings, 1, `${name}: one main heading`);
  };
  return { seen, look };
}
