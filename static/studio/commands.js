// Every command of the studio in one table: its words, its keys, what it does, whether it can be done now. The
// palette, the keyboard and the help of its keys are made of it.
import { say } from "./texts.js";

const $ = (id) => document.getElementById(id);
const press = (id) => ({ can: () => !$(id).disabled && !$(id).closest("[hidden]"), run: () => $(id).click() });

/// [{id, words, keys: ["Ctrl+Z", ...], can(), run()}]; `page` as studio.js has it.
export function commandsOf(page) {
  const { player, tabs, history, camera, faces, sources } = page;
  const there = () => player.durationMs() > 0;
  const show = (id) => ({ can: () => !$(`tab-${id}`).disabled, run: () => tabs.show(id) });
  const step = (way) => () => (player.pause(), player.seek(player.timeMs + way * player.frameMs()));
  const slot = () => faces.chosen?.slot;
  const cycle = (id) => () => {
    const select = $(id);
    select.selectedIndex = (select.selectedIndex + 1) % select.options.length;
    select.dispatchEvent(new Event("change"));
  };
  const choose = (number) => ({ id: `face-${number}`, words: say("command.face", { number }), keys: [String(number)], can: () => faces.panels.length >= number, run: () => faces.choose(faces.panels[number - 1].slot) });
  const named = (id, keys, act) => ({ id, words: say(`command.${id}`), keys, can: () => true, ...act });
  return [
    named("palette", ["Ctrl+K", "?"], { run: () => page.openPalette() }),
    named("undo", ["Ctrl+Z"], { can: () => history.next.undo !== null, run: () => history.undo() }),
    named("redo", ["Ctrl+Shift+Z", "Ctrl+Y"], { can: () => history.next.redo !== null, run: () => history.redo() }),
    named("dismiss", ["Escape"], { can: () => !$("problem").hidden, run: () => ($("problem").hidden = true) }),
    named("play", ["Space"], { can: there, run: () => player.toggle() }),
    named("back", [","], { can: there, run: step(-1) }),
    named("on", ["."], { can: there, run: step(1) }),
    named("first", ["Home"], { can: there, run: () => (player.pause(), player.seek(page.part()[0])) }),
    named("last", ["End"], { can: there, run: () => (player.pause(), player.seek(page.part()[1])) }),
    named("loop", ["L"], { run: () => $("loop").click() }),
    named("speed", ["S"], { run: cycle("speed") }),
    named("view", ["V"], { run: cycle("view") }),
    named("view-reset", ["0"], { run: () => camera.reset(slot()) }),
    named("view-fit", ["F"], { run: () => page.fit() }),
    named("view-linked", ["Shift+L"], press("view-linked")),
    named("markers", ["M"], press("show-markers")),
    ...[1, 2, 3, 4].map(choose),
    named("add", ["N"], { can: () => faces.canAdd(), run: () => faces.add() }),
    named("remove", ["Shift+N"], { can: () => faces.panels.length > 1 && slot() !== faces.panels[0].slot, run: () => faces.remove(slot()) }),
    named("show-faces", ["Alt+1"], show("faces")),
    named("show-matching", ["Alt+2"], show("matching")),
    named("show-layouts", ["Alt+3"], show("layouts")),
    named("show-exertion", ["Alt+4"], show("exertion")),
    named("show-method", ["Alt+5"], show("method")),
    named("show-exports", ["Alt+6"], show("exports")),
    named("show-study", ["Alt+0"], show("study")),
    named("save-study", [], { can: () => !$("tab-study").disabled, run: () => (tabs.show("study"), $("study-save").click()) }),
    named("show-curves", ["Alt+7"], show("curves")),
    named("show-expressions", ["Alt+8"], show("expressions")),
    named("show-labelling", ["Alt+9"], show("labelling")),
    named("files", ["O"], { run: () => (($("sources").open = !$("sources").open), $("sources").querySelector("summary").focus()) }),
    named("built-in", [], { run: () => sources.builtIn() }),
    named("suggest-map", [], press("map-suggest")),
    named("save-map", [], press("map-save")),
    named("suggest-expressions", [], { can: () => !$("tab-expressions").disabled, run: () => (tabs.show("expressions"), $("expressions-suggest").click()) }),
    ...["weights", "glb", "png", "webm", "mp4", "sheet"].map((what) => ({
      id: `export-${what}`, words: say("command.export", { what: say(`export.${what}`) }), keys: [], can: () => !$("tab-exports").disabled && !$(`export-${what}`).hidden,
      run: () => (tabs.show("exports"), $(`export-${what}`).click()),
    })),
  ];
}

/// A key as the table writes it: modifiers in one order, a letter large.
function keyOf(event) {
  const name = event.key === " " ? "Space" : event.key.length === 1 ? event.key.toUpperCase() : event.key;
  // A sign that Shift makes, such as "?", is its own key.
  const shift = event.shiftKey && (event.key.length > 1 || /[a-z]/i.test(event.key));
  // On some keyboards Alt makes another sign of a digit.
  const digit = event.altKey && /^Digit\d$/.test(event.code) ? event.code.at(-1) : name;
  return [(event.ctrlKey || event.metaKey) && "Ctrl", event.altKey && "Alt", shift && "Shift", digit].filter(Boolean).join("+");
}

/// Does what the keys ask for. A control keeps its own keys: typing writes and chooses in a list, Space presses a button.
export function wireKeys(commands) {
  const byKey = new Map(commands.flatMap((command) => command.keys.map((key) => [key, command])));
  addEventListener("keydown", (event) => {
    const key = keyOf(event);
    const command = byKey.get(key);
    if (!command || event.defaultPrevented || document.querySelector("dialog[open]")) return;
    const control = event.target.closest("select, button, input, textarea, a, summary, [role=tab], [role=separator]");
    if (key.startsWith("Ctrl+")) {
      // A text takes back its own letters.
      if (/^Ctrl\+(Shift\+)?[ZY]$/.test(key) && control?.matches("textarea, input[type=text], input[type=search]")) return;
    } else if (!key.startsWith("Alt+")) {
      if (control?.matches("select, textarea, input:not([type=range]):not([type=checkbox])")) return;
      if (control && ["Space", "Home", "End"].includes(key)) return;
    }
    if (!command.can()) return;
    event.preventDefault();
    command.run();
  });
}
