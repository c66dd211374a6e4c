// The words of the page in the language of the page: `say` finds them by key, `fill` puts them into the HTML.
// The language is the one of the address (`?lang=fr`), else what the server has written into the page.
import { WORDS } from "./words.js";

export const LANGUAGES = ["en", "fr"];

function chosen() {
  const asked = new URLSearchParams(globalThis.location?.search ?? "").get("lang");
  const told = globalThis.document?.documentElement.lang ?? "";
  return [asked, told].map((code) => (code ?? "").slice(0, 2)).find((code) => LANGUAGES.includes(code)) ?? LANGUAGES[0];
}

/// The code of the page's language.
export const language = chosen();

/// The text of a key; `{name}` in it is filled in from `values`.
export function say(key, values = {}) {
  const words = WORDS[key];
  if (!words) throw new Error(`${key}: words.js has no such text`);
  return words[LANGUAGES.indexOf(language)].replaceAll(/\{(\w+)\}/g, (whole, name) => (name in values ? String(values[name]) : whole));
}

export { numeral } from "../drawing/words.js";

/// Puts the words into what the page's HTML names by keys: text, labels and placeholders.
export function fill(root = document) {
  document.documentElement.lang = language;
  for (const element of root.querySelectorAll("[data-say]")) element.textContent = say(element.dataset.say);
  for (const element of root.querySelectorAll("[data-say-label]")) element.setAttribute("aria-label", say(element.dataset.sayLabel));
  for (const element of root.querySelectorAll("[data-say-placeholder]")) element.placeholder = say(element.dataset.sayPlaceholder);
}
