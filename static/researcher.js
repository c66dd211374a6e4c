// Keeps the researcher's page up to date while somebody looks at it.
//
// The page is complete without this script. Every few seconds the same page is fetched and the part
// marked `data-live` is exchanged, unless the reader is using something inside it.

const SECONDS = 5;

function localTimes(root) {
  for (const element of root.querySelectorAll("time[datetime]")) {
    const at = new Date(element.dateTime);
    if (!Number.isNaN(at.getTime())) {
      element.textContent = at.toLocaleString(undefined, { dateStyle: "short", timeStyle: "short" });
      element.title = element.dateTime;
    }
  }
}

async function refresh() {
  const live = document.querySelector("[data-live]");
  if (document.hidden || live.contains(document.activeElement)) return;
  const response = await fetch(location.pathname, { credentials: "same-origin", cache: "no-store" });
  if (!response.ok) return;
  const fresh = new DOMParser().parseFromString(await response.text(), "text/html").querySelector("[data-live]");
  if (!fresh) return;
  localTimes(fresh);
  if (fresh.innerHTML === live.innerHTML) return;
  const scrolled = [...live.querySelectorAll(".table-scroll")].map((box) => box.scrollLeft);
  live.replaceChildren(...fresh.childNodes);
  live.querySelectorAll(".table-scroll").forEach((box, index) => { box.scrollLeft = scrolled[index] ?? 0; });
}

localTimes(document);
// A failed refresh is tried again at the next turn.
setInterval(() => refresh().catch(() => {}), SECONDS * 1000);
