// Starts the participant's pages as a component of a study in JATOS. Its own script, jatos.js, knows the run, the parameters
// with which the participant arrived, and how a run ends; answers are posted beside the page, as to any other address.

const site = document.querySelector("meta[name=mimique-site]");
const app = document.getElementById("app");
const french = (new URLSearchParams(location.search).get("lang") ?? document.documentElement.lang).toLowerCase().startsWith("fr");

/** Loads JATOS' script, which stands beside every page that it serves. */
function jatosScript() {
  return new Promise((done, failed) => {
    const script = Object.assign(document.createElement("script"), { src: "jatos.js", onload: done, onerror: failed });
    document.head.append(script);
  });
}

/** The run's page is its own: what another run left in this browser is not its. The address of the page has the
    parameters of the study's address. */
function begin() {
  site.dataset.run = jatos.studyResultUuid;
  const query = new URLSearchParams(location.search);
  for (const [name, value] of Object.entries(jatos.urlQueryParameters ?? {})) if (!query.has(name)) query.set(name, value);
  const asked = query.toString();
  history.replaceState(history.state, "", location.pathname + (asked && `?${asked}`));
  new MutationObserver(end).observe(app, { subtree: true, childList: true, attributes: true, attributeFilter: ["data-outcome"] });
  import("./boot.js");
}

let ended = false;

/** The last page is shown once every answer has arrived: now the run ends, with the outcome as its message. Whoever has
    declined may still go back, so that the run goes on. */
function end() {
  const outcome = app.querySelector("main[data-outcome]:not([data-view=declined])")?.dataset.outcome;
  if (!outcome || ended) return;
  ended = true;
  jatos.endStudyWithoutRedirect(outcome === "completed", outcome);
}

jatosScript().then(
  () => jatos.onLoad(begin),
  () => {
    app.textContent = french
      ? "Cette page appartient à JATOS : ouvrez l’étude par le lien que JATOS donne."
      : "This page belongs to JATOS: open the study by the link that JATOS gives.";
  },
);
