// What the window keeps over reloads: sizes, open sections, chosen tabs, number of faces. One entry in the browser's
// own storage; where that may not be used the window is as it is made.

const KEY = "mimique-studio";

function read() {
  try {
    return JSON.parse(localStorage.getItem(KEY)) ?? {};
  } catch {
    return {};
  }
}

const kept = read();

/// What was kept under a name, else `fallback`.
export const recall = (name, fallback = null) => kept[name] ?? fallback;

/// Keeps a value under a name.
export function remember(name, value) {
  kept[name] = value;
  try {
    localStorage.setItem(KEY, JSON.stringify(kept));
  } catch {
    // A browser that stores nothing shows the window as it is made, every time.
  }
}
