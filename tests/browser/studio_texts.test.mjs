// The studio's table of texts: every text in English and in French, with the same words to fill in; every text that
// the page or its scripts ask for is in it, and none that nothing asks for; no words stand in the page itself.

import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { root } from "./lib/server.mjs";

const folder = join(root, "static/studio");
const { WORDS } = await import(pathToFileURL(join(folder, "words.js")));
const html = readFileSync(join(folder, "studio.html"), "utf8");
const scripts = readdirSync(folder).filter((name) => name.endsWith(".js") && !name.startsWith("words")).map((name) => [name, readFileSync(join(folder, name), "utf8")]);

test("studio: every text is in both languages, with the same words to fill in", () => {
  const filled = (text) => [...text.matchAll(/\{(\w+)\}/g)].map(([, name]) => name).sort();
  for (const [key, texts] of Object.entries(WORDS)) {
    assert.equal(texts.length, 2, key);
    assert.ok(texts.every((text) => typeof text === "string" && text.trim() !== ""), `${key}: a text is empty`);
    assert.deepEqual(filled(texts[1]), filled(texts[0]), `${key}: other words are filled in`);
  }
});

test("studio: the page and its scripts ask for texts that there are, and for all of them", () => {
  const asked = new Set([...html.matchAll(/data-say(?:-label|-placeholder)?="([^"]+)"/g)].map(([, key]) => key));
  // A text is asked for by its key, a key that is chosen among some, or the beginning of a key.
  const begun = new Set();
  for (const [, text] of scripts) {
    for (const [, key] of text.matchAll(/"([a-z][\w.-]*)"/g)) if (key in WORDS) asked.add(key);
    for (const [, start] of text.matchAll(/say\(`([\w.-]+\.)\$\{/g)) begun.add(start);
    for (const [, key] of text.matchAll(/say\("([^"]+)"/g)) assert.ok(key in WORDS, `${key}: no such text`);
    for (const [, id] of text.matchAll(/named\("([\w-]+)"/g)) {
      assert.ok(`command.${id}` in WORDS, `command.${id}: no such text`);
      asked.add(`command.${id}`);
    }
  }
  for (const key of asked) assert.ok(key in WORDS, `${key}: no such text`);
  const idle = Object.keys(WORDS).filter((key) => !asked.has(key) && ![...begun].some((start) => key.startsWith(start)));
  const whatOf = idle.filter((key) => !/^(undo|redo)\.what$/.test(key));
  assert.deepEqual(whatOf, [], "texts that nothing asks for");
});

test("studio: the page's own HTML has no words in one language", () => {
  const body = html.slice(html.indexOf("<body"), html.indexOf("<noscript>")).replaceAll(/<!--.*?-->/gs, "");
  const words = [...body.matchAll(/>([^<]+)</g)].map(([, text]) => text.trim()).filter(Boolean);
  // Units, sizes, keys, the languages' own names and what is not yet counted say the same in both.
  const neutral = /^(mm|cm|m|\d+ × \d+.*|[½¼¹⁄₁₀1]+ ×|Ctrl K|English|Français|0\.00 s)$/;
  assert.deepEqual(words.filter((text) => !neutral.test(text)), []);
  assert.ok(!/\s(?:aria-label|placeholder|title)="/.test(body), "labels come from the table");
});

test("studio: every parameter of a method has French words, and no other has", async () => {
  const { TRANSLATED } = await import(pathToFileURL(join(folder, "words-methods.js")));
  const schema = JSON.parse(readFileSync(join(root, "study-config/schema/study.schema.json"), "utf8"));
  // What a study file says of a method beside the solver's parameters.
  const others = ["method", "label", "factors", "training"];
  const parameters = Object.keys(schema.$defs.Method.properties).filter((key) => !others.includes(key));
  assert.deepEqual([...TRANSLATED].sort(), parameters.sort());
});

// The variants of an enum of the engine, as its JSON names them: code and names of its values.
function variantsOf(file, name, rename = (field) => field.replaceAll(/_(\w)/g, (_, letter) => letter.toUpperCase())) {
  const text = readFileSync(join(root, file), "utf8");
  const start = text.indexOf(`enum ${name} {`);
  assert.ok(start >= 0, `${file}: no enum ${name}`);
  const body = text.slice(start, text.indexOf("\n}\n", start)).replaceAll(/\/\/\/.*/g, "");
  return [...body.matchAll(/^ {4}(\w+)(?: \{([^}]*)\}|\([^)]*\))?,/gm)].map(([, variant, fields]) => ({
    code: variant.replaceAll(/(?!^)[A-Z]/g, (letter) => `-${letter}`).toLowerCase(),
    fields: fields ? [...fields.matchAll(/(\w+):/g)].map(([, field]) => rename(field)) : null,
  }));
}

/// What an enum in a variant is like in JSON, and numbers, names and lists for all else.
const VALUES = {
  labels: ["a", "b"], shapes: ["a"], columns: ["a"], combinations: [["a", ["b"]]], value: [1, 0], frames: 2, of: 3,
  markers: [{ label: "a", residual_mm: 1, worst_mm: 2 }], why: { what: "crosses", degrees: 31 },
  text: "words", range: { low: 0, lowIncluded: true, high: 1 }, expected: { kind: "word", words: ["a"] }, headHeld: true,
};

// The values of a variant; a name that the engine does not send is an error.
const valuesOf = ({ code, fields }, more = {}) =>
  new Proxy({ ...more, ...Object.fromEntries((fields ?? []).map((field) => [field, VALUES[field] ?? 1])) }, {
    get: (values, key) => (key in values ? values[key] : assert.fail(`${code}: the engine sends no ${String(key)}`)),
  });

test("studio: whatever the engine warns of or refuses has French words", async () => {
  const { FRENCH } = await import(pathToFileURL(join(folder, "words-engine.js")));
  const said = (table, variants, second) => {
    assert.deepEqual(Object.keys(table).sort(), variants.map(({ code }) => code).sort());
    for (const variant of variants) {
      const words = table[variant.code](variant.values ?? valuesOf(variant), second);
      assert.ok(words.length > 0 && !/undefined|NaN|\[object/.test(words), `${variant.code}: ${words}`);
    }
  };
  // Values that are structs of their own, which the engine writes with the names of their fields.
  const own = {
    labels: { fault: "swapped", labels: ["a", "b"], frames: [1, 2], residual_mm: 2, residual_if_mended_mm: 1 },
    smoothing: { why: "other-face", distance_mm: 3, residual_mm: 2, smoothed_mm: 1 },
  };
  const ofTake = variantsOf("crates/stimulus/src/warning.rs", "TakeWarning").filter(({ code }) => code !== "frames");
  const ofFrames = variantsOf("crates/clip/src/frame_statistics.rs", "FramesWarning");
  said(FRENCH.WARNINGS, [...ofTake, ...ofFrames].map((variant) => ({ ...variant, values: own[variant.code] })));
  const problem = { field: "sigma", alternatives: ["a"] };
  said(FRENCH.FAULTS, variantsOf("crates/solver/src/parameters/problem.rs", "SpecFault"), problem);
  said(FRENCH.PROBLEMS, variantsOf("web/studio/src/problem.rs", "Trouble"));
  said(FRENCH.FINDINGS, variantsOf("crates/exertion/src/finding.rs", "Finding"));
  // What the solver's table says by parameter.
  const rows = readFileSync(join(root, "crates/solver/src/parameters/table.rs"), "utf8");
  assert.equal(Object.keys(FRENCH.ZERO).length, [...rows.matchAll(/ zero: Some\(/g)].length);
  assert.equal(Object.keys(FRENCH.NO_EFFECT).length, [...rows.matchAll(/ because: "/g)].length);
});
