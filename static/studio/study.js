// The workspace saved as a study: one archive with study file, avatar, capture, map and all that they need, which
// `mimique serve` and the researchers' upload take as it is; and its preview, where this server may host it.
import { made } from "../stage/player.js";
import { save } from "./export.js";
import { language, LANGUAGES, say } from "./texts.js";
import { callWorker } from "./worker-calls.js";
import { Zip } from "./zip.js";

const $ = (id) => document.getElementById(id);
/// How often the server is asked how far the preview is.
const ASKED_EVERY_MS = 700;

export class StudyPane {
  #page;

  /// `page`: {name(), panels(), files() -> {what: File}, gaze() -> as a study file has it, or null, busy(words, work), report(error)}
  constructor(page) {
    this.#page = page;
    $("study-preview").closest("label").hidden = this.#token === "";
    $("study-save").addEventListener("click", () => this.#save());
    this.#fill().catch(page.report);
  }

  // What the server wants to hear with a study; empty where it hosts none of this person.
  get #token() {
    return document.body.dataset.token ?? "";
  }

  async #fill() {
    const { designs, instruments } = await callWorker("studyLibrary");
    $("study-design").replaceChildren(...designs.map((name) => new Option(say(`design.${name}`), name)));
    const choice = (id, value, words, checked) =>
      made("label", { className: "preview-check" }, made("input", { type: "checkbox", id, value, checked }), ` ${words}`);
    $("study-languages").append(...LANGUAGES.map((code) => choice(`study-language-${code}`, code, say(`language.${code}`), true)));
    $("study-instruments").append(...instruments.map(({ id, name }) => choice(`study-instrument-${id}`, id, name, false)));
  }

  /// Another take, whose name the study has until somebody gives it another.
  takeChanged() {
    $("study-name").placeholder = this.#page.name();
  }

  #chosen(id) {
    return [...$(id).querySelectorAll("input:checked")].map(({ value }) => value);
  }

  async #save() {
    const { report, busy } = this.#page;
    const button = $("study-save");
    button.disabled = true;
    this.#tell("");
    // Browsers open a window at once or never; it waits for its address.
    const opens = this.#token !== "" && $("study-preview").checked;
    const tab = opens ? globalThis.open("", "_blank") : null;
    try {
      const done = await busy(say("study.saving"), () => this.#archive());
      if (!done) return void tab?.close();
      const { id, archive } = done;
      save(`${id}.zip`, archive);
      this.#tell(say("study.saved", { id }));
      if (!opens) return;
      const address = await this.#host(archive);
      this.#tell(say("study.hosted"), address);
      if (tab) tab.location = address;
    } catch (error) {
      tab?.close();
      report(error);
    } finally {
      button.disabled = false;
      button.focus();
    }
  }

  async #archive() {
    // The default language is the page's own.
    const languages = this.#chosen("study-languages").sort((a, b) => (b === language) - (a === language));
    if (languages.length === 0) throw new Error(say("study.no-language"));
    const solved = this.#page.panels().filter((panel) => panel.facts);
    const asked = {
      name: $("study-name").value.trim() || this.#page.name(),
      title: $("study-title").value.trim() || null,
      design: $("study-design").value,
      instruments: this.#chosen("study-instruments"),
      languages,
      faces: solved.map((panel) => ({ name: panel.title(), settings: panel.facts.settings })),
      gaze: this.#page.gaze(),
    };
    const { id, made: written, copied } = await callWorker("study", JSON.stringify(asked));
    const files = this.#page.files();
    const zip = new Zip();
    const text = new TextEncoder();
    for (const [path, content] of written) zip.add(`${id}/${path}`, text.encode(content));
    for (const [what, path] of copied) zip.add(`${id}/${path}`, new Uint8Array(await files[what].arrayBuffer()));
    return { id, archive: zip.finish() };
  }

  // Has the study hosted as a pilot; the address of its preview, once the clips are there.
  async #host(archive) {
    const answer = await fetch("/studio/study", {
      method: "POST", body: archive, headers: { "content-type": "application/zip", "x-mimique-form": this.#token },
    });
    const told = await answer.json();
    if (told.issues) throw new Error(told.issues.map(({ place, message, remedy }) => `${place}: ${message}; ${remedy}`).join("\n"));
    if (!answer.ok) throw new Error(`${told.message}; ${told.remedy}`);
    for (;;) {
      const state = await (await fetch(`/studio/study/${told.study}`)).json();
      if (state.state === "ready") return `/preview/${told.study}`;
      if (state.state === "failed") throw new Error(state.problem);
      if (state.state !== "under") throw new Error(`${state.message}; ${state.remedy}`);
      this.#tell(state.of > 0 ? say("study.preparing-of", { done: state.done, of: state.of }) : say("study.preparing"));
      await new Promise((resolve) => setTimeout(resolve, ASKED_EVERY_MS));
    }
  }

  #tell(words, address) {
    $("study-state").replaceChildren(words, ...(address ? [" ", made("a", { href: address, target: "_blank", rel: "noopener" }, say("study.open"))] : []));
  }
}
