// Small studies, made of parts: one performance, everything else as a test wants it.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { root } from "./server.mjs";

/** The look of clips whose size is not what a test is about: drawing in software takes time in proportion to its pixels. */
export const SMALL_LOOK = { width: 160, height: 160 };

/** A copy of a study file of the repository with clips of that size: its path. */
export function withSmallClips(file) {
  const text = readFileSync(join(root, file), "utf8").replace(/"look": \{[^}]*\},?/, "");
  const small = text.replace('"stimuli": {', `"stimuli": {\n    "look": ${JSON.stringify(SMALL_LOOK)},`);
  assert.notEqual(small, text, `${file} has stimuli`);
  const copy = join(mkdtempSync(join(tmpdir(), "mimique-small-")), basename(file));
  writeFileSync(copy, small);
  return copy;
}

/** A text in both languages. */
export const text = (words) => ({ en: words, fr: `${words} (fr)` });

/** A block of these clips. */
export const trials = (ids, questions) => ({ type: "trials", clips: { ids }, questions });

/** One performance of joy, by these avatars and methods; `clips`: [avatar, method] pairs. */
export const stimuli = (avatars, methods, clips) => ({
  avatars,
  captures: { actor: { builtin: { actor: 7 } } },
  segments: [{ id: "joy2", capture: "actor", performance: { expression: "joy", intensity: 2 } }],
  methods,
  clips: { list: clips.map(([avatar, method]) => ({ avatar, segment: "joy2", method })) },
});

/** A study with these parts. */
export const small = (id, parts) => ({
  id,
  studyMetadata: { title: text("Faces"), version: "1" },
  languages: ["en", "fr"],
  contact: { investigator: { name: "A", email: "a@example.org" }, ethicsBoard: { name: "B", email: "b@example.org" } },
  consent: { version: "1", minimumAge: 18, retention: text("One year."), sections: [{ heading: text("What"), text: text("Watch.") }] },
  ...parts,
});
