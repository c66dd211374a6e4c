// Before the participant's page of a capsule begins: what it would keep in the browser it keeps in memory, until the page
// is closed. It goes on as where a person has forbidden the browser to store anything.
(() => {
  const kept = new Map();
  const storage = {
    getItem: (key) => kept.get(key) ?? null,
    setItem: (key, value) => void kept.set(key, String(value)),
    removeItem: (key) => void kept.delete(key),
  };
  Object.defineProperty(globalThis, "localStorage", { get: () => storage });
  Object.defineProperty(globalThis, "sessionStorage", { get: () => storage });
  Object.defineProperty(globalThis, "indexedDB", { get: () => undefined });
})();
