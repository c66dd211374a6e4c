// The studio's page in tests: facts of a panel, sections, downloads, what axe finds.

import { WCAG, violations as found } from "./access.mjs";
import { savedBytes } from "./saved.mjs";

/** A row of facts of a panel. */
function row(page, panel, name) {
  return page.locator(`section[aria-label="Method ${panel}"] .preview-clip div`, { hasText: name }).first();
}

/** The number in a fact of a panel, such as its residual. */
export async function fact(page, panel, name) {
  await row(page, panel, name).waitFor({ state: "attached", timeout: 120_000 });
  return Number.parseFloat(await row(page, panel, name).locator("dd").textContent());
}

/** The hash of a panel's weights, once it is another than `old`. */
export async function weightsHash(page, panel, old = "") {
  const shown = await page.waitForFunction(
    ([panel, old]) => {
      const rows = [...document.querySelectorAll(`section[aria-label="Method ${panel}"] .preview-clip div`)];
      const text = rows.find((each) => each.textContent.startsWith("Weights"))?.lastChild.textContent;
      return text && text !== old ? text : null;
    },
    [panel, old],
    { timeout: 120_000 },
  );
  return shown.jsonValue();
}

/** The bytes of a file that `act` saves. */
export async function download(page, act) {
  const [file] = await Promise.all([page.waitForEvent("download", { timeout: 180_000 }), act()]);
  return savedBytes(file);
}

/** What axe finds against WCAG 2.2 AA. */
export async function violations(page) {
  // What follows the time scrolls below its ruler, which covers a part of some control wherever it stands: it is looked
  // at from its beginning.
  await page.locator(".studio-lanes").evaluate((lanes) => (lanes.scrollTop = 0));
  // On a narrow screen an expression's box is narrow; the table below it does the same (WCAG 2.5.8, exception "equivalent").
  return found(page, "html", { tags: WCAG, except: [["target-size", 'class="segment"']] });
}

/** Opens a section: by its tab, or one that is folded. */
export async function unfold(page, id) {
  const tab = page.locator(`#tab-${id}`);
  if ((await tab.count()) > 0) {
    await tab.click();
    await page.locator(`#${id}`).waitFor();
    return;
  }
  if (!(await page.locator(`#${id}`).evaluate((section) => section.open))) await page.locator(`#${id} > summary`).click();
}

/** Chooses a panel, whose method the right side then shows. */
export async function choose(page, panel) {
  await page.locator(`section[aria-label="View ${panel}"] .studio-choose`).click();
}

/** The built-in head and actor, solved. */
export async function builtIn(page, server) {
  await page.goto(`${server.url}?backend=webgl2`);
  await page.click("#avatar-built-in");
  await page.waitForFunction(() => document.querySelector("#avatar-facts").textContent.includes("57 shapes"));
  await page.click("#take-built-in");
  await fact(page, "A", "Residual");
}
