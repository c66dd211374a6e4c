// Reports of panics of the wasm modules (web/panics): the console has the whole message, the server's log
// has it without values. A worker hands its report to the page, which knows the study.

/** Called by a module that panics; `message` is free of values. */
export function reportPanic(whole, module, backend, message, place) {
  console.error(whole);
  const report = { module, backend, message: message.slice(0, 500), place: place.slice(0, 300) };
  if (globalThis.document) sendPanic(report);
  else globalThis.postMessage?.({ panic: report });
}

/** Sends a report to the server; pages that are hosted without it (`mimique export-site`) send none. */
export function sendPanic(report) {
  if (document.querySelector("meta[name=mimique-site]")) return;
  const study = /^\/(?:s|preview)\/([^/]+)/.exec(location.pathname)?.[1] ?? "";
  const headers = { "content-type": "application/json" };
  const body = JSON.stringify({ ...report, study });
  // What does not arrive is lost: the console has it.
  fetch("/api/panics", { method: "POST", headers, body, keepalive: true }).catch(() => {});
}
