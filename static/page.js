// What the participant's pages (app.js, wasm) ask of the browser: elements, requests, storage, time.
// Each is a line here and would be a binding of its own there.

// ---- elements

/** The place of the pages, emptied. */
export function root() {
  const place = document.getElementById("app") ?? document.body;
  place.replaceChildren();
  return place;
}

export const element = (tag) => document.createElement(tag);
export const text = (words) => document.createTextNode(words);
export const setText = (node, words) => void (node.data = words);

/** Puts a node before another, or last. */
export const insert = (parent, node, before) => void parent.insertBefore(node, before ?? null);
export const remove = (node) => node.remove();

/** An attribute; `.name` is a property, `--name` one of the style. */
export function set(node, name, value) {
  if (name.startsWith("--")) node.style.setProperty(name, value);
  else if (name === ".checked") node.checked = value !== "";
  else if (name === ".value") node.value = value;
  else node.setAttribute(name, value);
}

export function unset(node, name) {
  if (name.startsWith("--")) node.style.removeProperty(name);
  else if (name === ".checked") node.checked = false;
  else if (name === ".value") node.value = "";
  else node.removeAttribute(name);
}

/** Calls back with the value (of a key press: the key) and whether the field is checked. */
export function listen(node, name, call) {
  node.addEventListener(name, (event) => {
    if (name === "submit") event.preventDefault();
    const { value = "", checked = false } = event.target;
    const alone = !(event.ctrlKey || event.altKey || event.metaKey);
    call(name === "keydown" ? (alone ? event.key : "") : String(value), checked === true);
  });
}

/** Opens or closes the dialog of the page. */
export function dialog(open) {
  const found = document.querySelector("dialog");
  if (found?.open !== open) open ? found?.showModal() : found?.close();
}

/** Languages written from right to left, by their ISO 639 codes. */
const RIGHT_TO_LEFT = /^(ar|arc|ckb|dv|fa|he|iw|ks|ku-arab|nqo|ps|sd|syr|ug|ur|yi)(-|_|$)/i;

/** Language and title of the document. */
export function describe(language, title) {
  document.documentElement.lang = language;
  document.documentElement.dir = RIGHT_TO_LEFT.test(language) ? "rtl" : "ltr";
  if (title) document.title = title;
}

/** Writes what went wrong into the console. */
export const report = (words) => console.error(words);

export const language = () => document.documentElement.lang;

// ---- focus

/** On the first of the selectors (`a|b`) that finds something. */
export function focus(selectors) {
  for (const each of selectors.split("|")) {
    const found = document.querySelector(each);
    // What cannot take the focus leaves it where it is.
    if (found) return found.focus();
  }
}

/** After the next frame. */
export const focusLater = (selectors) => void requestAnimationFrame(() => focus(selectors));

/** The same, if the element that had the focus has gone. */
export const focusRescue = (selectors) =>
  void requestAnimationFrame(() => {
    if ([null, document.body].includes(document.activeElement)) focus(selectors);
  });

/** On the heading of a new page; not from somebody who was quicker and is on that page already. */
export const focusHeading = () =>
  void requestAnimationFrame(() => {
    if (document.activeElement?.closest("main")) return;
    scrollTo(0, 0);
    focus("main h1");
  });

// ---- window and time

/** Calls back with the name of what happens to the window, and once a second with `tick`. */
export function watch(call) {
  for (const name of ["blur", "focus", "resize", "online", "pagehide"]) addEventListener(name, () => call(name));
  document.addEventListener("fullscreenchange", () => call("fullscreenchange"));
  // A hidden page need not lose the focus; what it has is sent, as it may never come back.
  document.addEventListener("visibilitychange", () => {
    if (document.hidden) call("blur"), call("pagehide");
    else if (document.hasFocus()) call("focus");
  });
  setInterval(() => call("tick"), 1000);
}

export const now = () => performance.timeOrigin + performance.now();
export const sleep = (ms) => new Promise((done) => setTimeout(done, ms));

/** After the first paint of what stands there now. */
export const painted = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
export const pixelRatio = () => devicePixelRatio;
export const random = () => Math.random();

/** So many random bytes, hexadecimal. */
export function nonce(bytes) {
  const drawn = crypto.getRandomValues(new Uint8Array(bytes));
  return Array.from(drawn, (byte) => byte.toString(16).padStart(2, "0")).join("");
}

/** Path, query, the browser's languages, and where the study is if no server answers. */
export function place() {
  const site = document.querySelector("meta[name=mimique-site]");
  return [location.pathname, location.search, navigator.languages?.join(" ") ?? "", site?.content, site?.dataset.study];
}

/** The number that a text says; NaN if it says none. */
export const number = (words) => (words.trim() === "" ? NaN : Number(words));

export const reload = () => location.reload();
export const encode = (words) => encodeURIComponent(words);

/** Width and height of the window, device pixels per CSS pixel. */
export const viewport = () => [innerWidth, innerHeight, devicePixelRatio];

// ---- requests

/** Status and text of an answer; throws where none has come whole in `patience` ms. */
export async function request(method, address, type, body, patience) {
  const headers = type ? { "content-type": type } : {};
  const answer = await fetch(address, { method, headers, body, signal: AbortSignal.timeout?.(patience) });
  return [answer.status, await answer.text()];
}

// ---- what survives a reload

/** A value of the browser's storage; `undefined` where it is forbidden. */
export function load(key) {
  try {
    return localStorage.getItem(key) ?? undefined;
  } catch {
    return undefined;
  }
}

/** Keeps a value, or forgets it; false where the browser keeps nothing. */
export function save(key, value) {
  try {
    value === undefined ? localStorage.removeItem(key) : localStorage.setItem(key, value);
    return true;
  } catch {
    return false;
  }
}

let database;

const settled = (request) =>
  new Promise((done, failed) => {
    request.onsuccess = () => done(request.result);
    request.onerror = () => failed(request.error);
  });

/** Opens the database; throws where there is none (some private windows). */
export async function openDatabase() {
  database ??= (async () => {
    const request = indexedDB.open("mimique", 2);
    request.onupgradeneeded = () => {
      for (const store of ["outbox", "answers"]) {
        if (!request.result.objectStoreNames.contains(store)) request.result.createObjectStore(store);
      }
    };
    return settled(request);
  })();
  try {
    return await database;
  } catch (error) {
    // The next one who asks tries again.
    database = undefined;
    throw error;
  }
}

// Done when the database says that it is written.
async function write(store, act) {
  const transaction = (await database).transaction([store], "readwrite");
  const written = new Promise((done, failed) => {
    transaction.oncomplete = () => done();
    transaction.onerror = transaction.onabort = () => failed(transaction.error);
  });
  act(transaction.objectStore(store));
  transaction.commit?.();
  return written;
}

export const put = (store, key, value) => write(store, (all) => all.put(value, key));
export const forget = (store, keys) => write(store, (all) => keys.forEach((key) => all.delete(key)));
export const clear = (store, first, last) => write(store, (all) => all.delete(IDBKeyRange.bound(first, last)));

/** The values of a range of keys, in order. */
export async function all(store, first, last) {
  const transaction = (await database).transaction([store], "readonly");
  return settled(transaction.objectStore(store).getAll(IDBKeyRange.bound(first, last)));
}
