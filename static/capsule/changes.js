// What would the report say under other rules? Exclusions and tests of the study file are changed here, and the statistics
// computed anew in a worker, by the functions of `mimique analyze`.
import { made } from "../stage/player.js";

const $ = (id) => document.getElementById(id);
const { capsule } = globalThis;

let worker = null;

/// The report of a study file (text): {files, summary}.
async function computed(study) {
  const [csv, stimuli, published] = await Promise.all(["responses.csv", "stimuli.csv", "study.json"].map((name) => capsule.body(name)));
  worker ??= new Worker(new URL("./report-worker.js", import.meta.url), { type: "module" });
  return new Promise((resolve, reject) => {
    worker.onmessage = ({ data }) => (data.error === undefined ? resolve(data) : reject(new Error(data.error)));
    worker.onerror = ({ message }) => {
      worker = null;
      reject(new Error(message));
    };
    worker.postMessage({ csv, study, published, stimuli, preview: "../index.html", language: document.documentElement.lang });
  });
}

/// The study with the rules of the form.
function changed(study, form) {
  const own = structuredClone(study);
  const rules = { ...own.exclusions };
  for (const field of form.querySelectorAll("[data-rule]")) {
    const { rule } = field.dataset;
    if (field.type === "checkbox") {
      if (field.checked || rule in rules) rules[rule] = field.checked;
    }
    else if (field.value === "") delete rules[rule];
    else if (rule === "straightLining") rules[rule] = { ...rules[rule], longestRun: Number(field.value) };
    else rules[rule] = Number(field.value);
  }
  if (own.exclusions || Object.keys(rules).length > 0) own.exclusions = rules;
  for (const field of form.querySelectorAll("[data-hypothesis]")) {
    const hypothesis = own.hypotheses.find(({ id }) => id === field.dataset.hypothesis);
    hypothesis.test = field.value;
  }
  return own;
}

/// Fills the form with the rules of the study file.
function fill(form, study) {
  const rules = study.exclusions ?? {};
  for (const field of form.querySelectorAll("[data-rule]")) {
    const value = field.dataset.rule === "straightLining" ? rules.straightLining?.longestRun : rules[field.dataset.rule];
    if (field.type === "checkbox") field.checked = value === true;
    else field.value = value ?? "";
  }
  for (const field of form.querySelectorAll("[data-hypothesis]")) {
    field.value = study.hypotheses.find(({ id }) => id === field.dataset.hypothesis).test;
  }
}

/// What each hypothesis' reading is, as published and under the form's rules.
function compare(before, after, { words, say }) {
  const row = ([id, reading]) => {
    const then = before.readings.find(([own]) => own === id)?.[1] ?? "";
    const cells = [made("th", { scope: "row" }, id), made("td", {}, then), made("td", {}, reading === then ? words.unchanged : reading)];
    return made("tr", {}, ...cells);
  };
  const head = ["hypothesis", "published", "changed"].map((word) => made("th", { scope: "col" }, words[word]));
  const table = made("table", {}, made("thead", {}, made("tr", {}, ...head)), made("tbody", {}, ...after.readings.map(row)));
  const used = say("used", { people: after.people[0], all: after.people[1], trials: after.trials, peopleBefore: before.people[0], trialsBefore: before.trials });
  const scroll = made("div", { className: "scroll", role: "region", tabIndex: 0 }, table);
  scroll.setAttribute("aria-label", words.readings);
  return [made("p", {}, used), scroll];
}

function saved(name, text, type) {
  const link = made("a", { href: URL.createObjectURL(new Blob([text], { type })), download: name }, name);
  return link;
}

/// Wires the form. `showReport` shows a report's text.
export async function openChanges({ words, say, showReport }) {
  const form = $("changes");
  const [study, published] = await Promise.all([capsule.json("study.json"), capsule.json("summary.json")]);
  fill(form, study);
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    const own = changed(study, form);
    const text = JSON.stringify(own, null, 2);
    $("computing").textContent = words.computing;
    $("compared").replaceChildren();
    try {
      const { files, summary } = await computed(text);
      showReport(files["report.html"]);
      $("which-report").textContent = words.changedReport;
      const downloads = [saved("study-changed.json", text, "application/json"), saved("results-changed.json", files["results.json"], "application/json")];
      $("compared").replaceChildren(...compare(published, summary, { words, say }), made("p", { className: "row" }, words.save, " ", ...downloads));
      $("computing").textContent = words.computed;
    } catch (error) {
      $("computing").textContent = say("notComputed", { problem: error.message });
    }
  });
  form.addEventListener("reset", async (event) => {
    event.preventDefault();
    fill(form, study);
    $("computing").textContent = "";
    $("compared").replaceChildren();
    $("which-report").textContent = words.publishedReport;
    showReport(await capsule.body("report.html"));
  });
}
