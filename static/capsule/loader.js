// The files of a capsule for its own pages, from the disk as from a web host. Browsers let no page on the disk fetch a
// file, import a module or start a worker from one; a classic script may come from anywhere. So every file that scripts
// need stands in a script of its own, files/NAME.js, which hands it over here; modules and workers are made of blobs.
//
// Pages and scripts name such a file by an address below https://capsule.invalid/, where nobody answers: fetch, import and
// Worker find it here. The host scripts are the same as on a server; where they say import, it is changed on the way.
// `data-module` of this script's element names the module to begin with.

/// What page and worker have in common; it refers to nothing outside, since the worker is given its text. `read(name)`
/// gives a file: {type, body: text or bytes}.
const makeCapsule = (scope, read) => {
  const BASE = "https://capsule.invalid/";
  // The three forms in which our own scripts name another: written by esbuild or by hand, never within a text.
  const STATIC = /(\bfrom\s*|\bimport\s*)(["'])(\.{1,2}\/[^"']+)\2/g;
  const DYNAMIC = /\bimport\s*\(/g;
  const ADDRESS = /\bimport\.meta\.url\b/g;
  const NEIGHBOUR = /new URL\((["'`])([^"'`]+)\1,\s*import\.meta\.url\)/g;
  const fetched = scope.fetch.bind(scope);
  const blobs = new Map();

  const isOwn = (address) => String(address).startsWith(BASE);
  const nameOf = (address) => decodeURI(new URL(address).pathname.slice(1));

  // The blob of a module, what it imports made into blobs before it. Modules that import each other in a circle would
  // wait for ever; ours do not.
  const blobOf = (address) => {
    let blob = blobs.get(address);
    if (!blob) {
      blob = rewritten(address).then((text) => URL.createObjectURL(new Blob([text], { type: "text/javascript" })));
      blobs.set(address, blob);
    }
    return blob;
  };

  const rewritten = async (address) => {
    const { body } = await read(nameOf(address));
    const wanted = [...body.matchAll(STATIC)].map(([, , , specifier]) => blobOf(new URL(specifier, address).href));
    const imported = (await Promise.all(wanted)).values();
    const own = JSON.stringify(address);
    return body
      .replace(STATIC, (_, word, quote) => `${word}${quote}${imported.next().value}${quote}`)
      .replace(DYNAMIC, () => `capsule.imported(${own},`)
      .replace(ADDRESS, () => own);
  };

  scope.fetch = async (resource, options) => {
    const address = resource?.url ?? String(resource);
    if (!isOwn(address)) return fetched(resource, options);
    const { type, body } = await read(nameOf(address));
    return new Response(body, { headers: { "content-type": type } });
  };

  return {
    BASE,
    isOwn,
    /// A module, by its address or as another one names it.
    imported: async (from, specifier = "") => import(await blobOf(new URL(specifier, from).href)),
    /// The files that a module needs, statically, by name.
    async needs(address, files = new Map()) {
      const name = nameOf(address);
      if (files.has(name)) return files;
      const file = await read(name);
      files.set(name, file);
      if (file.type !== "text/javascript") return files;
      const named = [...file.body.matchAll(STATIC)].map((found) => found[3]);
      named.push(...[...file.body.matchAll(NEIGHBOUR)].map((found) => found[2]));
      for (const specifier of named) await this.needs(new URL(specifier, address).href, files);
      return files;
    },
  };
};

/// A worker: it is told its files and its module, and says when it can be spoken to.
const beginWorker = (scope, makeCapsule) => {
  let files;
  const read = async (name) => {
    const file = files.get(name);
    if (!file) throw new Error(`${name}: the worker was not given this file`);
    return file;
  };
  scope.capsule = makeCapsule(scope, read);
  const begin = async ({ data, ports: [port] }) => {
    files = data.files;
    try {
      await scope.capsule.imported(data.module);
      port.postMessage(null);
    } catch (error) {
      port.postMessage(String(error?.message ?? error));
    }
  };
  scope.addEventListener("message", begin, { once: true });
};

(() => {
  const files = new Map();
  const waiting = new Map();
  const root = document.baseURI.replace(/[^/]*([?#].*)?$/, "");

  /// A file, by the script that holds it.
  const read = (name) => {
    let file = files.get(name);
    if (file) return file;
    file = new Promise((resolve, reject) => {
      const missing = () => reject(new Error(`${name}: is not in this capsule; unpack all of it, and open its index.html`));
      waiting.set(name, resolve);
      const script = document.createElement("script");
      script.onerror = missing;
      script.onload = missing;
      script.src = `${root}files/${encodeURI(name)}.js`;
      document.head.append(script);
    });
    files.set(name, file);
    // What could not be had is asked for again the next time.
    file.catch(() => files.delete(name));
    return file;
  };

  const inflated = async (base64) => {
    const packed = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  };

  const capsule = makeCapsule(globalThis, read);
  const body = (name) => read(name).then((file) => file.body);
  globalThis.capsule = {
    ...capsule,
    /// Called by files/NAME.js: a text, or bytes in gzip and base64.
    text: (name, type, body) => waiting.get(name)?.({ type, body }),
    bytes: (name, type, base64) => waiting.get(name)?.(inflated(base64).then((body) => ({ type, body }))),
    body,
    json: (name) => body(name).then(JSON.parse),
  };

  const NativeWorker = globalThis.Worker;
  const text = `(${beginWorker})(self, ${makeCapsule})`;
  globalThis.Worker = class extends NativeWorker {
    /// Addresses of other hosts too: it finds them here (module-worker.js asks).
    static anyHost = true;
    #ready = null;

    constructor(address, options) {
      const isOwn = capsule.isOwn(address);
      super(isOwn ? URL.createObjectURL(new Blob([text], { type: "text/javascript" })) : address, isOwn ? {} : options);
      if (isOwn) this.#ready = this.#begin(String(address));
    }

    async #begin(module) {
      try {
        const needed = await capsule.needs(module);
        const { port1, port2 } = new MessageChannel();
        const begun = new Promise((resolve) => (port1.onmessage = ({ data }) => resolve(data)));
        super.postMessage({ files: needed, module }, [port2]);
        const problem = await begun;
        if (problem !== null) throw new Error(problem);
      } catch (error) {
        this.dispatchEvent(new ErrorEvent("error", { message: String(error?.message ?? error) }));
      }
    }

    postMessage(message, more) {
      if (!this.#ready) return super.postMessage(message, more);
      this.#ready.then(() => super.postMessage(message, more));
    }
  };

  const { module } = document.currentScript.dataset;
  if (module) capsule.imported(`${capsule.BASE}${module}`);
})();
