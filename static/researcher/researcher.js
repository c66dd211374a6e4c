// Keeps a study's dashboard up to date while somebody looks at it, and writes times in the reader's own.
//
// The pages are complete without this script. The server tells by an event stream that something has
// changed; the same page is then fetched and the part marked `data-live` is exchanged, unless the
// reader is using something inside it: then it waits.

function localTimes(root) {
  for (const element of root.querySelectorAll("time[datetime]")) {
    const at = new Date(element.dateTime);
    if (!Number.isNaN(at.getTime())) {
      const style = element.dataset.day === undefined ? { dateStyle: "short", timeStyle: "medium" } : { dateStyle: "medium" };
      element.textContent = at.toLocaleString(document.documentElement.lang, style);
      element.title = element.dateTime;
    }
  }
}

function follow(live) {
  const state = document.querySelector("[data-live-state]");
  let due = false;
  let busy = false;

  // Only what holds the keyboard for writing or choosing: a region that can be scrolled may be exchanged.
  const inUse = () => document.activeElement?.matches("input, select, textarea") && live.contains(document.activeElement);

  async function refresh() {
    if (!due || busy || document.hidden || inUse()) return;
    due = false;
    busy = true;
    try {
      const response = await fetch(location.pathname + location.search, { credentials: "same-origin", cache: "no-store", headers: { accept: "text/html" } });
      // Logged out meanwhile: the page to log in says so.
      if (response.redirected) return location.reload();
      if (!response.ok) throw new Error(String(response.status));
      const fresh = new DOMParser().parseFromString(await response.text(), "text/html").querySelector("[data-live]");
      if (!fresh) return;
      localTimes(fresh);
      if (fresh.innerHTML === live.innerHTML) return;
      const boxes = [...live.querySelectorAll(".table-scroll")].map((box) => [box.scrollLeft, box.scrollTop]);
      const focused = document.activeElement?.getAttribute?.("href") ?? document.activeElement?.getAttribute?.("aria-label");
      const held = live.contains(document.activeElement) ? focused : null;
      live.replaceChildren(...fresh.childNodes);
      live.querySelectorAll(".table-scroll").forEach((box, index) => {
        [box.scrollLeft, box.scrollTop] = boxes[index] ?? [0, 0];
      });
      if (held) live.querySelector(`[href="${CSS.escape(held)}"], [aria-label="${CSS.escape(held)}"]`)?.focus({ preventScroll: true });
    } catch {
      due = true;
    } finally {
      busy = false;
    }
  }

  const stream = new EventSource(live.dataset.live);
  stream.addEventListener("changed", () => {
    due = true;
    refresh();
  });
  stream.addEventListener("open", () => { state.textContent = state.dataset.on; });
  stream.addEventListener("error", () => { state.textContent = state.dataset.off; });
  live.addEventListener("focusout", () => setTimeout(refresh));
  document.addEventListener("visibilitychange", refresh);
  // What could not be fetched is tried again.
  setInterval(refresh, 5000);
}

localTimes(document);
const live = document.querySelector("[data-live]");
if (live) follow(live);
// A page that waits for the server to finish something.
const waiting = document.querySelector("[data-reload-s]");
if (waiting) setTimeout(() => location.reload(), Number(waiting.dataset.reloadS) * 1000);
