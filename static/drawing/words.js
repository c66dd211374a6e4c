// What pictures of courses say, in the language of their page: its `lang`.

const french = () => (globalThis.document?.documentElement.lang ?? "").startsWith("fr");

/// Sentences and captions: English, French.
const WORDS = {
  "no-body": ["No motion is known: there is no body to draw.", "Aucun mouvement n’est connu : il n’y a pas de corps à dessiner."],
  "about-body": [
    "In place, in step with the face. How far chest and shoulders move is drawn, not computed; when they move is the breath below.",
    "Sur place, au pas du visage. L’ampleur de la poitrine et des épaules est dessinée, non calculée ; leurs instants sont ceux du souffle ci-dessous.",
  ],
  "body": [
    "The body as a stick figure, from its right and from the front, {seconds} s after the beginning",
    "Le corps en bâtons, vu de sa droite et de face, {seconds} s après le début",
  ],
  "breath": ["Breath in the window, share of a breath", "Souffle dans la fenêtre, part d’une respiration"],
  "weights": ["Weights in the window", "Poids dans la fenêtre"],
  "both-sides": ["{name}, both sides", "{name}, des deux côtés"],
  "highest": ["{name}: highest {value}", "{name} : {value} au plus haut"],
  "course.heart-rate": ["beats per minute", "battements par minute"],
  "course.breaths": ["breaths per minute", "respirations par minute"],
  "course.work": ["work, J/kg in a second", "travail, J/kg par seconde"],
  "course.epoc": ["EPOC, ml/kg", "EPOC, ml/kg"],
  "course.face": ["face, %", "visage, %"],
};

/// Names of lines that the engine gives (crates/exertion/src/courses.rs, crates/stimulus/src/exertion/drawing.rs).
const LINES = {
  work: "travail",
  "power, W/kg": "puissance, W/kg",
  open: "ouverture",
  stretched: "étirement",
  eyes: "yeux",
  brows: "sourcils",
  lungs: "poumons",
  flow: "débit",
};

/// The text of a key; `{name}` in it is filled in from `values`.
export const say = (key, values = {}) => WORDS[key][french() ? 1 : 0].replaceAll(/\{(\w+)\}/g, (_, name) => values[name]);

/// A line's name; names of shapes are what they are.
export const lineName = (name) => (french() ? (LINES[name] ?? name) : name);

const formats = new Map();

/// A number with a fixed count of decimals, or with `significant` digits at most.
export function numeral(value, digits, significant = null) {
  const key = `${french()} ${digits} ${significant}`;
  if (!formats.has(key)) {
    const options = significant === null ? { minimumFractionDigits: digits, maximumFractionDigits: digits } : { maximumSignificantDigits: significant };
    formats.set(key, new Intl.NumberFormat(french() ? "fr" : "en", { ...options, useGrouping: false }));
  }
  return formats.get(key).format(value);
}
