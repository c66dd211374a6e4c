// The command palette: every command with its keys, found by a few letters, done by Enter. It is the help of the
// keyboard, too.
import { made } from "../stage/player.js";
import { say } from "./texts.js";

const $ = (id) => document.getElementById(id);
const plain = (text) => text.normalize("NFD").replaceAll(/\p{Diacritic}/gu, "").toLowerCase();

export class Palette {
  #commands;
  #dialog = $("palette");
  #wanted;
  #list = made("ul", { id: "palette-list", role: "listbox", ariaLabel: say("commands") });
  #found = [];
  #at = 0;

  constructor(commands) {
    this.#commands = commands;
    this.#wanted = made("input", { type: "text", role: "combobox", ariaLabel: say("palette.search"), placeholder: say("palette.search"), autocomplete: "off" });
    this.#wanted.setAttribute("aria-controls", "palette-list");
    this.#wanted.setAttribute("aria-expanded", "true");
    this.#wanted.addEventListener("input", () => this.#fill());
    this.#wanted.addEventListener("keydown", (event) => this.#keyed(event));
    this.#dialog.setAttribute("aria-label", say("commands"));
    this.#dialog.replaceChildren(this.#wanted, this.#list, made("p", { className: "soft" }, say("palette.faces")));
    this.#dialog.addEventListener("click", ({ target }) => target === this.#dialog && this.#dialog.close());
  }

  open() {
    this.#wanted.value = "";
    this.#fill();
    this.#dialog.showModal();
    this.#wanted.focus();
  }

  // What can be done now, by its words; every word that is typed must be in them.
  #fill() {
    const parts = plain(this.#wanted.value).split(/\s+/).filter(Boolean);
    this.#found = this.#commands.filter(({ id, words, can }) => id !== "palette" && can() && parts.every((part) => plain(words).includes(part)));
    this.#list.replaceChildren(...this.#found.map((command, i) => this.#row(command, i)));
    this.#go(0);
  }

  #row({ words, keys }, index) {
    const signs = keys.map((key) => made("kbd", {}, key.replaceAll("+", " ")));
    const row = made("li", { role: "option", id: `palette-${index}` }, made("span", {}, words), made("span", {}, ...signs));
    row.addEventListener("click", () => this.#run(index));
    return row;
  }

  #go(index) {
    this.#at = Math.min(Math.max(index, 0), this.#found.length - 1);
    for (const [i, row] of [...this.#list.children].entries()) row.setAttribute("aria-selected", String(i === this.#at));
    const row = this.#list.children[this.#at];
    row?.scrollIntoView({ block: "nearest" });
    if (row) this.#wanted.setAttribute("aria-activedescendant", row.id);
    else this.#wanted.removeAttribute("aria-activedescendant");
  }

  #keyed(event) {
    const way = { ArrowDown: 1, ArrowUp: -1, PageDown: 8, PageUp: -8 }[event.key];
    if (way) this.#go(this.#at + way);
    else if (event.key === "Enter") this.#run(this.#at);
    else return;
    event.preventDefault();
  }

  #run(index) {
    const command = this.#found[index];
    if (!command) return;
    this.#dialog.close();
    command.run();
  }
}
