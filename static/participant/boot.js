// Starts the participant's pages, and watches until the first of them stands: whatever goes wrong before
// that, or does not come, is said here, in the participant's language. It asks for nothing but this file.

const LATE_MS = 20_000;

const wanted = new URLSearchParams(location.search).get("lang") ?? document.documentElement.lang;
const french = wanted.toLowerCase().startsWith("fr");
const words = french
  ? {
      failed: "Cette page ne peut pas démarrer",
      late: "Cette page met du temps à démarrer",
      remedy: "Essayez un navigateur récent (Chrome, Edge, Firefox ou Safari), autorisez les cookies de ce site ou rechargez la page.",
      wait: "Vérifiez la connexion, ou rechargez la page.",
      reload: "Recharger la page",
    }
  : {
      failed: "This page cannot start",
      late: "This page takes long to start",
      remedy: "Please try a recent browser (Chrome, Edge, Firefox or Safari), allow cookies of this site, or reload the page.",
      wait: "Please check the connection, or reload the page.",
      reload: "Reload the page",
    };

const app = document.getElementById("app");
const notice = document.createElement("div");
notice.lang = french ? "fr" : "en";

// The pages say themselves what they know; what they draw goes before what is said here.
const stands = () => app.querySelector("main[data-view]:not([data-view=opening])") !== null;

function tell(heading, remedy, detail) {
  if (stands()) return;
  const part = (tag, content, name = "") => Object.assign(document.createElement(tag), { textContent: content, className: name });
  const box = part("main", "", "page");
  box.dataset.view = "stuck";
  const card = part("div", "", "card");
  const reload = part("button", words.reload, "primary");
  reload.type = "button";
  reload.onclick = () => location.reload();
  const actions = part("div", "", "actions");
  actions.append(reload);
  card.append(part("h1", heading), part("p", remedy));
  if (detail) card.append(Object.assign(part("p", detail, "soft"), { lang: "en" }));
  card.append(actions);
  box.append(card);
  notice.replaceChildren(box);
  app.hidden = true;
  app.after(notice);
}

const fail = (reason) => tell(words.failed, words.remedy, String(reason?.message ?? reason ?? ""));
const onError = ({ error, message }) => fail(error ?? message);
const onRejection = ({ reason }) => fail(reason);
const late = setTimeout(() => notice.isConnected || tell(words.late, words.wait), LATE_MS);
const watch = new MutationObserver(() => stands() && done());
addEventListener("error", onError);
addEventListener("unhandledrejection", onRejection);
watch.observe(app, { subtree: true, childList: true, attributes: true, attributeFilter: ["data-view"] });

function done() {
  watch.disconnect();
  clearTimeout(late);
  removeEventListener("error", onError);
  removeEventListener("unhandledrejection", onRejection);
  notice.remove();
  app.hidden = false;
}

import("../app.js").then(({ default: init }) => init()).catch(fail);
