// The French words of what the engine says: warnings of a solve, faults of a method's parameters, problems of a call. Each
// comes as a code with its values and as a sentence in English (`text`), which the English page shows.
import { language, numeral } from "./texts.js";

const counted = (count, one, many) => `${count} ${count < 2 ? one : many}`;
const few = (names) => (names.length > 6 ? `${names.slice(0, 6).join(", ")} et ${counted(names.length - 6, "autre", "autres")}` : names.join(", "));
const images = (count) => counted(count, "image", "images");

/// What eyes do not do (crates/stimulus/src/checks/gaze.rs, GazeFault).
const GAZE = {
  diverges: (degrees) => `les yeux divergent de ${numeral(degrees, 1)} degrés`,
  crosses: (degrees) => `les yeux convergent de ${numeral(degrees, 1)} degrés (ils louchent)`,
  oneHigher: (degrees) => `un œil regarde ${numeral(degrees, 1)} degrés plus haut que l’autre`,
};

/// Why a smoothed adaptation was tried (crates/stimulus/src/checks/smoothing.rs, SmoothingReason).
const REASONS = {
  "map-suggested": () => "la carte des marqueurs est une suggestion",
  "map-of-a-layout": () => "des marqueurs sont posés à la main là où une disposition le dit",
  "other-face": ({ distance_mm }) => `les marqueurs de l’acteur sont à ${numeral(distance_mm, 1)} mm (eff.) de ceux de l’avatar sur le visage neutre`,
};

/// Warnings of a take (crates/stimulus/src/warning.rs; of frames: crates/clip/src/frame_statistics.rs).
const WARNINGS = {
  "markers-absent": ({ labels }) => `${counted(labels.length, "marqueur de la carte n’est", "marqueurs de la carte ne sont")} pas dans la capture : ${few(labels)}`,
  "no-head-markers": () => "aucun marqueur de la tête n’est nommé : la capture passe pour libre des mouvements de la tête",
  "head-shown-still": () => "aucun marqueur de la tête n’est nommé : la tête est montrée immobile",
  "neutral-found": ({ first, end, deviationMm, headHeld }) =>
    `aucun neutre n’est nommé : les images ${first}:${end} sont prises, la seconde la plus calme (${numeral(deviationMm, 2)} mm eff.${headHeld ? "" : ", la tête non tenue"}) ; voyez si le visage y est neutre, ou nommez-le`,
  "neutral-unseen": () => "aucun neutre n’est nommé et aucun marqueur n’est vu : les premières images sont prises",
  "few-neutral-frames": ({ frames, better }) => `le neutre est la moyenne de ${images(frames)} : ${better} ou plus sont plus stables`,
  "lid-marker-absent": ({ marker }) => `le marqueur de paupière ${marker} n’est pas dans la capture`,
  "lid-shape-absent": ({ marker, shape }) => `marqueur de paupière ${marker} : l’avatar n’a pas de forme ${shape} ; nommez la forme qui ferme la paupière`,
  "gaze-beyond-avatar": ({ frames, of }) =>
    `le regard donné dépasse ce dont les yeux de l’avatar tournent dans ${frames} images sur ${of} : il y est tenu à leur limite ; regardez les angles, en degrés vers la gauche de la personne et vers le haut`,
  "gaze-beyond-eyes": ({ frames, worst, why }) =>
    `${images(frames)} avec un regard que des yeux n’ont pas ; au pire, à l’image ${worst}, ${GAZE[why.what](why.degrees)} ; laissez les yeux au repos, donnez leur regard, ou corrigez les poids eyeLook`,
  "head-unfiltered": ({ rateHz, lowpassHz, leastRateHz }) =>
    `la tête n’est pas filtrée : ${rateHz} images par seconde ne laissent pas de place à un passe-bas de ${lowpassHz} Hz, qui en demande ${leastRateHz} ; donnez headLowpassHz pour choisir une autre coupure, 0 pour aucune`,
  "head-markers-move": ({ markers }) =>
    `des marqueurs de la tête bougent sur la tête : ${markers.map((m) => `${m.label} (${numeral(m.residual_mm, 1)} mm eff., ${numeral(m.worst_mm, 1)} au pire)`).join(", ")} ; ils semblent posés sur la peau, et le visage est mal stabilisé d’autant : nommez des marqueurs du crâne, ou les plus calmes, comme tête`,
  labels: ({ fault, labels: [a, b], frames, residual_mm: before, residual_if_mended_mm: after }) => {
    const when = frames ? `aux images ${frames[0]}:${frames[1]}` : "d’un bout à l’autre";
    const [from, to] = [numeral(before, 2), numeral(after, 2)];
    return fault === "swapped"
      ? `les étiquettes ${a} et ${b} semblent échangées ${when} : rétablies, le résidu passe de ${from} à ${to} mm ; échangez-les dans la capture`
      : `les étiquettes ${a} et ${b} sont au même endroit ${when}, où ${b} n’a pas sa place : sans elle le résidu est de ${to} au lieu de ${from} mm ; corrigez-la dans la capture`;
  },
  smoothing: (advice) => {
    const { residual_mm: from, smoothed_mm: to } = advice;
    return `${REASONS[advice.why](advice)} : rbfSmoothing 0,1 fait passer le résidu de cette prise de ${numeral(from, 3)} à ${numeral(to, 3)} mm (${numeral(100 * (1 - to / from), 0)} %) ; réglez rbfSmoothing à 0,1, ou à 0 pour garder l’adaptation exacte`;
  },
  "shapes-held": ({ shapes }) =>
    `${counted(shapes.length, "forme reste", "formes restent")} à 0, puisque les marqueurs ne renseignent pas ${shapes.length === 1 ? "son poids" : "leurs poids"} : ${shapes.join(", ")} ; posez des marqueurs là où elles bougent, menez les paupières par des marqueurs de paupière, ou choisissez de résoudre les formes qu’aucun marqueur ne renseigne`,
  "shapes-untold": ({ shapes }) =>
    `les marqueurs ne renseignent pas les poids de ${counted(shapes.length, "forme", "formes")}, qu’un bruit de 1 mm déplace sur toute leur étendue : ${shapes.join(", ")} ; ce qu’elles reçoivent est l’a priori de la méthode : verrouillez-les, ou posez des marqueurs là où elles bougent`,
  "shapes-dependent": ({ combinations }) =>
    `les marqueurs ne distinguent pas ces formes de combinaisons d’autres : ${combinations.map(([shape, of]) => `${shape} (de ${of.join(", ")})`).join(" ; ") || "des formes qui dépendent presque les unes des autres"} ; des poids qui conviennent également, les moindres sont pris ; verrouillez les formes dont la prise n’a pas besoin`,
  "vertices-adrift": ({ vertices }) => `${vertices} sommets sont dans des morceaux de la peau sans marqueur : ils restent au repos`,
  "training-unused": ({ shapes }) => `apprentissage : l’avatar n’a pas de forme ${shapes.join(", ")} : laissé de côté`,
  "training-unlearnt": ({ shapes }) => `apprentissage : pas de poids de ${shapes.join(", ")} : ils sont appris comme 0`,
  "no-column-is-a-shape": () => "aucune colonne du fichier n’est une forme de l’avatar : le visage reste neutre",
  "columns-unused": ({ columns }) => `l’avatar n’a pas de forme ${columns.join(", ")} : laissé de côté`,
  "shapes-not-driven": ({ shapes }) => `aucune colonne ne mène ${shapes.join(", ")} : tenu à 0`,
  held: ({ frames, first }) => `${counted(frames, "image n’est pas résolue", "images ne sont pas résolues")} (la première est ${first}) : reprises des images résolues autour`,
  "residual-outliers": ({ frames, worst, worstMm }) =>
    `${images(frames)} d’un résidu plus de 5 fois au-dessus de la médiane de la prise (la pire est ${worst}, ${numeral(worstMm, 1)} mm) : un marqueur y saute ou y change peut-être d’étiquette ; regardez, ou réparez la capture`,
  "without-markers": ({ frames, first }) => `${images(frames)} sans aucun marqueur (la première est ${first}) : leurs poids ne viennent que des a priori`,
  "far-from-training": ({ frames, first }) =>
    `${images(frames)} loin des données d’apprentissage (la première est ${first}) : leurs poids tendent vers le visage neutre ; enregistrez de telles expressions dans l’amplitude de mouvement`,
  smoothed: ({ frames }) => `${counted(frames, "image atteint", "images atteignent")} exactement les marqueurs : la norme a été lissée avec eps = 1e-4 l`,
};

/// What 0 stands for, and why a parameter has no effect, by the parameter's key (crates/solver/src/parameters/table.rs).
const ZERO = {
  mu: "chaque image pour elle-même",
  temporal: "chaque image pour elle-même",
  stiffness: "les marqueurs sont atteints exactement",
  headLowpassHz: "pas de filtre",
  rbfSmoothing: "chaque marqueur est atteint",
  lowpassHz: "pas de filtre",
};
const NO_EFFECT = {
  sigma: "seules les zones ont un rayon",
  basisVectors: "le processus exact a chaque image pour vecteur de base",
  blend: "aucune seconde méthode n’est nommée (blendWith)",
};
const KINDS = {
  number: "un nombre",
  "whole-number": "un nombre entier, 0 ou plus",
  interval: "deux nombres [bas, haut]",
  word: "un des mots",
  names: "une liste de noms",
  "number-by-name": "un objet avec un nombre par nom",
  "interval-by-name": "un objet avec [bas, haut] par nom",
};
const span = ({ low, lowIncluded, high }) => {
  if (low !== null && high !== null) return lowIncluded ? `entre ${low} et ${high}` : `au-dessus de ${low} et d’au plus ${high}`;
  if (low !== null) return lowIncluded ? `de ${low} ou plus` : `au-dessus de ${low}`;
  return high === null ? "" : `d’au plus ${high}`;
};

/// Faults of a parameter (crates/solver/src/parameters/problem.rs, SpecFault).
const FAULTS = {
  "not-an-object": () => "n’est pas un objet {...} ; écrivez {\"method\": \"lsts\"}",
  "method-missing": () => "manque ; nommez une méthode, par exemple lsts",
  "unknown-method": ({ found }, { alternatives }) => `méthode inconnue « ${found} » ; prenez une de ${alternatives.join(", ")}`,
  "unknown-parameter": () => "paramètre inconnu ; corrigez son nom ou retirez-le",
  "wrong-kind": ({ found, expected }) => `vaut ${found} ; donnez ${KINDS[expected.kind]}${expected.words ? ` ${expected.words.join(", ")}` : ""}`,
  "unknown-word": ({ found }, { alternatives }) => `vaut « ${found} » ; prenez ${alternatives.join(", ")}`,
  "out-of-range": ({ value, range }, { field }) => `vaut ${value} ; donnez un nombre ${span(range)}${ZERO[field] ? ` (0 : ${ZERO[field]})` : ""}`,
  "no-interval": ({ value: [low, high] }) => `vaut [${low}, ${high}] ; donnez deux nombres, le plus petit d’abord`,
  "not-used": ({ method }, { alternatives }) =>
    `« ${method} » ne l’emploie pas ; retirez-le (${alternatives.length > 0 ? `elle prend ${alternatives.join(", ")}` : "elle n’en prend aucun"})`,
  "not-blended": ({ method, second }, { alternatives }) => `« ${method} » ne se mêle pas à « ${second} » ; nommez une de ${alternatives.join(", ")}`,
  "no-effect": ({ value }, { field }) => `vaut ${value}, mais ${NO_EFFECT[field]} ; retirez-le`,
  "no-thin-shell": () => "kS et kB valent tous deux 0, ce qui ne laisse pas de coque mince ; rendez l’un d’eux positif",
  "met-exactly": ({ importance }) =>
    `vaut ${importance}, mais les marqueurs sont atteints exactement là où la raideur vaut 0 ; donnez une raideur au-dessus de 0, ou l’importance 0 pour laisser le marqueur de côté`,
  "locked-twice": ({ shape }) => `« ${shape} » est nommée deux fois ; nommez-la une fois`,
  "locked-and-bounded": ({ shape }) => `« ${shape} » a aussi des bornes ; verrouillez-la ou bornez-la, pas les deux`,
  "unknown-name": ({ of, found }, { alternatives }) => `pas de ${of === "shapes" ? "forme" : "marqueur"} « ${found} » ; prenez des noms de ${alternatives.join(", ")}`,
  "nothing-moves": () => "aucun marqueur d’importance au-dessus de 0 n’est déplacé par une forme ; donnez de l’importance à l’un d’eux",
};

/// Problems of a call (web/studio/src/problem.rs, Trouble), and the parts that they are about.
const PROBLEMS = {
  "no-avatar": () => "pas encore d’avatar ; ouvrez-en un d’abord",
  "no-capture": () => "pas encore de capture ; ouvrez-en une d’abord",
  "holds-weights": () => "contient des poids, pas de marqueurs ; ouvrez une capture, ou prenez la méthode recorded",
  "needs-weights": () => "recorded a besoin de poids ; ouvrez un fichier de Live Link Face, ou un CSV de poids",
  "empty-map": () => "vide ; suggérez-en une, ou ouvrez-en une",
  "nothing-solved": () => "rien n’est encore résolu ici",
  "no-face-solved": () => "aucun visage n’est encore résolu ; résolvez-en un d’abord",
  "no-training": () => "ouvrez une amplitude de mouvement et ses poids",
  "no-training-take": () => "ouvrez la capture à laquelle ces poids appartiennent",
  "no-training-weights": () => "ouvrez les poids qui y ont été joués",
  "training-rows": ({ take, frames, weights, rows }) => `${take} a ${frames} images, ${weights} ${rows} ; donnez une ligne de poids par image`,
  said: ({ text }) => text,
};
const PLACES = { method: "méthode", "marker map": "carte des marqueurs", training: "apprentissage", avatar: "avatar", solve: "résolution", "neutral frames": "images neutres", gaze: "regard", head: "tête" };

/// Findings of an exertion (crates/exertion/src/finding.rs), with the page's own remedies (web/studio/src/exertion).
const FINDINGS = {
  "near-maximum": ({ second }) =>
    `le cœur passe les neuf dixièmes de sa réserve à ${second} s ; la loi de la thèse n’a pas d’état stable, un travail constant le mène à son maximum (le cœur par états stables se pose)`,
  "over-limit": ({ seconds, first }) =>
    `${counted(seconds, "seconde, à partir de", "secondes, à partir de")} ${first} s, demandent plus de travail qu’un corps n’en fait, et comptent pour la limite ; cherchez une faute du mouvement, ou de sa cadence (images par seconde, là où la capture s’ouvre)`,
  "cut-frames": ({ cut, frames }) => `${cut} images sur ${frames} ont une courbe coupée au bout de son étendue (expressivité)`,
  repeated: ({ times }) => `répété ${numeral(times, 1)} fois : le travail est répété, non le mouvement, dont le saut en arrière serait du travail`,
  "other-unit": ({ unit, statureM, byUnitM }) =>
    `les jambes sont faites celles d’une personne de ${numeral(statureM, 2)} m ; dans l’unité du fichier (${unit}) la personne aurait ${numeral(byUnitM, 2)} m (unité, là où la capture s’ouvre)`,
  jitter: ({ ratio }) => `le mouvement tremble : sans le passe-bas son travail serait ${numeral(ratio, 1)} fois aussi grand`,
};

/// The French words of each table, for those who hold them to the engine's codes.
export const FRENCH = { WARNINGS, FAULTS, PROBLEMS, FINDINGS, ZERO, NO_EFFECT };

/// A warning of a solve in the page's language.
export const warningWords = (warning) => (language === "fr" ? WARNINGS[warning.code](warning) : warning.text);

/// A finding of an exertion in the page's language.
export const findingWords = (finding) => (language === "fr" ? FINDINGS[finding.code](finding) : finding.text);

/// What is wrong with a parameter, and the remedy, in the page's language.
export const faultWords = (problem) => (language === "fr" ? FAULTS[problem.is.fault](problem.is, problem) : problem.text);

/// Why a call failed, in the page's language.
export function problemWords({ place, text, is }) {
  const words = language === "fr" ? PROBLEMS[is.code](is) : text;
  if (place === null) return words;
  return language === "fr" ? `${PLACES[place] ?? place} : ${words}` : `${place}: ${words}`;
}
