// Starts the participant's pages: the smallest thing that can say so when it fails.

import init from "../app.js";

init().catch((error) => {
  const box = document.createElement("main");
  box.className = "page";
  const card = document.createElement("div");
  card.className = "card";
  const title = document.createElement("h1");
  const french = document.documentElement.lang.startsWith("fr");
  title.textContent = french ? "Cette page ne peut pas démarrer" : "This page cannot start";
  const text = document.createElement("p");
  text.textContent = french
    ? "Essayez un navigateur récent (Chrome, Edge, Firefox ou Safari) ou rechargez la page."
    : "Please try a recent browser (Chrome, Edge, Firefox or Safari), or reload the page.";
  const detail = document.createElement("p");
  detail.className = "soft";
  detail.textContent = String(error);
  card.append(title, text, detail);
  box.append(card);
  document.getElementById("app").replaceChildren(box);
});
