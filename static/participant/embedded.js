// Tells the page that a study is embedded in where it stands: the height that it wants, the view, its end. No answer and
// no code leaves it. The pages that may hear it are those that the server lets embed it.
//
//   {source: "mimique", study, event: "height", height}    CSS pixels, whenever it changes
//   {source: "mimique", study, event: "view", view}        "consent", "trial", "break", ...
//   {source: "mimique", study, event: "ended", outcome}    "completed", "declined", "withdrawn", "screened_out", "study_full", ...

const { study, origins } = document.querySelector("meta[name=mimique-embedding]").dataset;
// A clip takes what the window has: less than this is too little to see a face in.
const CLIP_HEIGHT = 760;

const tell = (event, values) => {
  // A browser gives it to the page whose origin it is, and to no other.
  for (const origin of origins.split(" ")) parent.postMessage({ source: "mimique", study, event, ...values }, origin);
};

let [height, view, outcome] = [];

function look() {
  const main = document.querySelector("main[data-view]");
  if (!main) return;
  const wanted = Math.max(Math.ceil(main.getBoundingClientRect().height), main.querySelector(".clip-card") ? CLIP_HEIGHT : 0);
  if (wanted !== height) tell("height", { height: (height = wanted) });
  if (main.dataset.view !== view) tell("view", { view: (view = main.dataset.view) });
  if (main.dataset.outcome && main.dataset.outcome !== outcome) tell("ended", { outcome: (outcome = main.dataset.outcome) });
}

if (parent !== window) {
  // The page is as high as what stands on it, not as the frame.
  document.body.style.minHeight = "auto";
  new MutationObserver(look).observe(document.body, { subtree: true, childList: true, attributes: true, attributeFilter: ["data-view", "data-outcome"] });
  new ResizeObserver(look).observe(document.body);
  look();
}
