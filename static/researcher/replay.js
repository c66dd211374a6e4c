// The replay of a session: the pages that a participant saw, one after the other, with the clips drawn again on the
// frames of their logs (replayed.js).
//
// The page is complete without this script but for the drawings; its words stand in the page.
import { Replay } from "./replayed.js";

const $ = (id) => document.getElementById(id);
const root = $("replay");
const replay = root && new Replay(JSON.parse(root.dataset.words));
let bundle = null;

/// All that a page needs of the version of the study that was shown.
function study(configHash) {
  bundle ??= fetched(`/api/studies/${encodeURIComponent(root.dataset.study)}?${new URLSearchParams({ config_hash: configHash })}`);
  return bundle;
}

async function fetched(address) {
  const answer = await fetch(address, { headers: { accept: "application/json" } });
  const told = await answer.json();
  if (!answer.ok) throw new Error([told.message, told.remedy].filter(Boolean).join("; "));
  return told;
}

/// Shows the page at a place, from 1.
async function showPage(place) {
  const isMine = replay.begin();
  const pages = [...root.querySelectorAll(".seen")];
  pages.forEach((page, at) => (page.hidden = at !== place - 1));
  $("page").value = place;
  $("before").disabled = place === 1;
  $("after").disabled = place === pages.length;
  history.replaceState(null, "", `#page-${place}`);
  const page = pages[place - 1];
  const list = page.querySelector(".replay-plays");
  $("player").hidden = !list;
  if (!list) return;
  list.after($("player"));
  try {
    const plays = await fetched(`${root.dataset.plays}/${place}`);
    if (isMine()) await replay.showPlays(plays, study, isMine);
  } catch (error) {
    if (isMine()) replay.problem(error);
  }
}

function start() {
  const pages = root.querySelectorAll(".seen").length;
  const turn = (by) => showPage(Math.min(Math.max(Number($("page").value) + by, 1), pages));
  $("pages").hidden = false;
  $("before").addEventListener("click", () => turn(-1));
  $("after").addEventListener("click", () => turn(1));
  $("page").addEventListener("change", () => showPage(Number($("page").value)));
  replay.wire({ p: () => turn(-1), n: () => turn(1) });
  const wanted = Number(/^#page-(\d+)$/.exec(location.hash)?.[1] ?? 1);
  showPage(Math.min(Math.max(wanted, 1), pages));
}

if (root) start();
