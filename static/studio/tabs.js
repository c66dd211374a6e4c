// Tabs of a part of the window: of the panes that a list of tabs controls one is shown. The chosen tab is kept
// over reloads; a pane says that it is shown by an event.
import { recall, remember } from "./memory.js";

const $ = (id) => document.getElementById(id);

/// Whether a pane is the one that is shown.
export const isShown = (id) => !$(id).hidden;

/// Calls `act` whenever a pane is shown.
export const whenShown = (id, act) => $(id).addEventListener("shown", act);

export class Tabs {
  #lists = [...document.querySelectorAll('[role="tablist"]')];

  constructor() {
    for (const list of this.#lists) {
      list.addEventListener("click", ({ target }) => this.#clicked(target.closest('[role="tab"]')));
      list.addEventListener("keydown", (event) => this.#keyed(event, list));
      this.#roving(list);
    }
  }

  /// Shows the panes that were chosen in an earlier visit, as far as they can be now.
  restore() {
    for (const [i, list] of this.#lists.entries()) {
      const tab = $(`tab-${recall(`tab-${i}`)}`);
      if (tab && list.contains(tab)) this.show(tab.getAttribute("aria-controls"), false);
    }
  }

  /// Whether a pane can be chosen. A pane that was chosen in an earlier visit is shown as soon as it can be.
  can(id, may) {
    const tab = $(`tab-${id}`);
    if (tab.disabled === !may) return;
    tab.disabled = !may;
    const list = tab.closest('[role="tablist"]');
    if (may && recall(`tab-${this.#lists.indexOf(list)}`) === id) this.show(id, false);
    if (!may && isShown(id)) this.show(list.querySelector('[role="tab"]:not(:disabled)').getAttribute("aria-controls"), false);
  }

  /// Shows a pane in the place of its neighbours; `chosen` by a person, it is kept.
  show(id, chosen = true) {
    const own = $(`tab-${id}`);
    if (own.disabled) return;
    const list = own.closest('[role="tablist"]');
    if (chosen) remember(`tab-${this.#lists.indexOf(list)}`, id);
    if (isShown(id)) return;
    for (const tab of list.querySelectorAll('[role="tab"]')) {
      tab.setAttribute("aria-selected", String(tab === own));
      $(tab.getAttribute("aria-controls")).hidden = tab !== own;
    }
    this.#roving(list);
    $(id).dispatchEvent(new Event("shown"));
  }

  // The chosen tab is the one that Tab comes to.
  #roving(list) {
    for (const tab of list.querySelectorAll('[role="tab"]')) tab.tabIndex = tab.getAttribute("aria-selected") === "true" ? 0 : -1;
  }

  #clicked(tab) {
    if (tab) this.show(tab.getAttribute("aria-controls"));
  }

  #keyed(event, list) {
    const way = { ArrowLeft: -1, ArrowRight: 1, Home: -Infinity, End: Infinity }[event.key];
    if (!way) return;
    event.preventDefault();
    event.stopPropagation();
    const tabs = [...list.querySelectorAll('[role="tab"]:not(:disabled)')];
    const at = tabs.indexOf(document.activeElement);
    const next = Number.isFinite(way) ? (at + way + tabs.length) % tabs.length : way < 0 ? 0 : tabs.length - 1;
    tabs[next].focus();
    this.#clicked(tabs[next]);
  }
}
