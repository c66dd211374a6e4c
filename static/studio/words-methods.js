// The French words of the methods' parameters, by key: label, help, what stands in an empty field. The English ones are the
// solver's own table (crates/solver/src/parameters/table.rs), which comes with the methods.
import { language } from "./texts.js";

const FRENCH = {
  alpha: ["α, coque mince contre bornes", "Poids de la coque mince face aux bornes : à 0 il n’y a pas de coque, à 1 pas de bornes souples."],
  kappa: ["κ, a priori contre données", "Poids des a priori face aux données."],
  kS: ["k_s, étirement", "Résistance à l’étirement, k_s de l’éq. 5.16."],
  kB: ["k_b, flexion", "Résistance à la flexion, k_b de l’éq. 5.16."],
  laplacian: ["Laplacien", "Poids du laplacien discret."],
  softBounds: ["Début des bornes souples", "Là où commencent les bornes souples, l_inf et l_sup de l’éq. 5.24."],
  s: ["s, souplesse des bornes", "Lissage des bornes souples, s de l’éq. 5.24."],
  eps: ["ε, lissage des normes", "Lissage des normes, sqrt(x² + ε²) : en unités de l, pour les formes littérales dans leur unité."],
  association: ["Association", "Quels points du visage un marqueur déplace."],
  sigma: ["σ, zones", "Rayon de la zone gaussienne d’un marqueur."],
  boundsWeight: ["Poids des bornes", "Poids des bornes souples là où elles sont le seul a priori."],
  lambda: ["λ, somme des poids", "Poids de la somme des poids face aux données : plus il est grand, moins de formes servent."],
  mu: ["μ, différences secondes", "Poids des carrés des différences secondes des poids d’une image à l’autre. 0 : chaque image pour elle-même."],
  l1: ["L1, carré de la somme des poids", "Force du carré de la somme des poids (L1 d’Audio2Face-3D, qui l’élève au carré)."],
  l2: ["L2, carrés des poids", "Force des carrés des poids (L2 d’Audio2Face-3D)."],
  symmetry: ["Y, symétrie", "Force des carrés des différences entre les deux côtés d’un mouvement."],
  temporal: ["T, image précédente", "Force du terme temporel, vers les poids de l’image précédente. 0 : chaque image pour elle-même."],
  unit: ["Unité", "Unité dans laquelle l’équation de l’article est prise à la lettre."],
  stiffness: ["Raideur", "De combien la surface peut quitter ses marqueurs pour être plus lisse : poids de son énergie, normalisée, face aux distances au carré. 0 : les marqueurs sont atteints exactement."],
  hold: ["Au repos", "Quels sommets restent au repos : ceux qu’aucune forme ne déplace, ou aucun."],
  inference: ["Apprentissage", "Comment le processus gaussien apprend : sur des vecteurs de base, ou sur toutes les images."],
  basisVectors: ["Vecteurs de base, au plus", "Nombre maximal de vecteurs de base du processus parcimonieux."],
  lengthScale: ["Longueur caractéristique", "Longueur caractéristique du noyau sur les déplacements centrés et réduits.", "par la vraisemblance marginale"],
  signal: ["Signal", "Écart type du processus, en poids.", "par la vraisemblance marginale"],
  noise: ["Bruit", "Écart type du bruit sur les poids d’apprentissage.", "par la vraisemblance marginale"],
  bounds: ["Bornes", "Bornes de certaines formes, à la place de celles de toutes les autres."],
  locked: ["Verrouillées", "Formes tenues à 0."],
  gaze: ["Regard", "Ce qui renseigne les formes qui tournent les yeux : rien, et elles restent au repos sauf là où les bornes les nomment, ou les marqueurs."],
  untold: ["Formes qu’aucun marqueur ne renseigne", "Ce que deviennent les formes que les marqueurs ne renseignent pas : elles restent à 0, sauf celles que les bornes nomment, ou sont résolues comme les autres."],
  gain: ["Gain des poids", "Facteur des poids résolus, dans leurs bornes : au-dessus de 1 il exagère, en dessous il atténue."],
  importance: ["Importance", "Importance de certains marqueurs ; 1 si elle n’est pas donnée, 0 met le marqueur de côté."],
  headLowpassHz: ["Passe-bas de la tête", "Fréquence de coupure du passe-bas à phase nulle de la pose de la tête. 0 : pas de filtre.", "10 à partir de 25 images par seconde, sinon aucun"],
  rbfSmoothing: ["Lissage de l’adaptation", "Lissage de l’adaptation de forme (éq. 5.18), sur la diagonale de son système, pour des marqueurs neutres centrés et ramenés à un rayon quadratique moyen de 1. Des marqueurs posés à 1 ou 2 mm de leur place demandent 0,1. 0 : chaque marqueur est atteint, comme dans la thèse."],
  unsolved: ["Images non résolues", "Ce que devient une prise dont des images ne sont pas résolues : elle est refusée, ou leurs poids sont interpolés entre les images résolues qui les entourent et signalés dans le rapport.", "refusée"],
  lowpassHz: ["Passe-bas des poids", "Fréquence de coupure du passe-bas à phase nulle de tous les poids : les mouvements lents restent. D’un mouvement doux, 2 Hz laissent peu, ce qu’on attend d’une ancre. 0 : pas de filtre.", "aucun"],
  delayMs: ["Retard du visage", "De combien le visage bouge après ses marqueurs ; au-dessous de 0 il est en avance.", "0"],
  blendWith: ["Mêlée avec", "Une seconde méthode qui résout les mêmes marqueurs ; les paramètres qu’elle seule emploie sont les siens.", "pas de seconde méthode"],
  blend: ["Part de la seconde méthode", "Part de la seconde méthode dans les poids : 0 est la première méthode, 1 la seconde.", "0"],
};

/// Label, help and what an empty field says of a row of the solver's table, in the page's language.
export function wordsOf({ key, label, help, foundBy }) {
  if (language === "en") return { label, help, foundBy };
  const [itsLabel, itsHelp, itsFoundBy] = FRENCH[key] ?? [label, help];
  return { label: itsLabel, help: itsHelp, foundBy: foundBy === null ? null : (itsFoundBy ?? foundBy) };
}

/// The keys that have French words.
export const TRANSLATED = Object.keys(FRENCH);
