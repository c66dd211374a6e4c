//! The words of an evaluation, in each language of reports.

use mimique_annotate::evaluate::{FEWEST, Score};
use mimique_annotate::{Decoding, Kernel, Lesson, Method};
use mimique_locale::Language;
use mimique_stimulus::BorderRule;

use crate::annotate::evaluate::{Column, ColumnKind, Split};

/// The name of a column.
pub fn column(language: Language, kind: ColumnKind) -> &'static str {
    match kind {
        ColumnKind::Thesis => language.pick("As in the thesis", "Comme dans la thèse"),
        ColumnKind::ShortPaper => {
            language.pick("As in the short paper", "Comme dans l’article court")
        }
        ColumnKind::Recommended => language.pick("Recommended", "Recommandé"),
        ColumnKind::Chosen => language.pick("As chosen", "Selon le choix"),
        ColumnKind::Model => language.pick("The model", "Le modèle"),
    }
}

/// The same beside a row of a figure.
pub fn column_in_short(language: Language, kind: ColumnKind) -> &'static str {
    match kind {
        ColumnKind::Thesis => language.pick("thesis", "thèse"),
        ColumnKind::ShortPaper => language.pick("short paper", "article court"),
        ColumnKind::Recommended => language.pick("recommended", "recommandé"),
        ColumnKind::Chosen => language.pick("chosen", "choisi"),
        ColumnKind::Model => language.pick("model", "modèle"),
    }
}

/// Without, and with a temperature.
pub fn temperature(language: Language) -> [&'static str; 2] {
    language
        .pick(["without temperature", "with temperature"], ["sans température", "avec température"])
}

/// The name of a score.
pub fn score(language: Language, score: Score) -> &'static str {
    match score {
        Score::Accuracy => language.pick("frames right", "images justes"),
        Score::BalancedAccuracy => language.pick("balanced accuracy", "exactitude équilibrée"),
        Score::MacroF1 => language.pick("macro F1", "F1 macro"),
        Score::Kappa => language.pick("Cohen’s kappa", "kappa de Cohen"),
        Score::SegmentsRight => language.pick("segments right", "segments justes"),
        Score::F1At10 => "F1@10",
        Score::F1At25 => "F1@25",
        Score::F1At50 => "F1@50",
        Score::WeightedIou => language.pick("IoU by length", "IoU par durée"),
        Score::Edit => language.pick("edit score", "score d’édition"),
        Score::Ratio => language.pick("segments per true one", "segments par segment vrai"),
        Score::BorderF1 => language.pick("borders, F1", "bornes, F1"),
    }
}

/// What each score is, for the notes.
pub fn scores_explained(language: Language) -> &'static str {
    language.pick(
        "Blank on a timeline of the annotator is the way from one label to another, or nothing that is marked. Frames right, balanced accuracy, macro F1 and kappa count frames that the annotator gave a label; transitions \
         count in none. Segments right: a suggested segment’s truth is the label it shares most frames with, as the \
         thesis scores. F1@10, 25 and 50 count true segments that a suggestion of the same label overlaps by an IoU \
         (common frames over all frames of both) of 0.10, 0.25 and 0.50, a transition shared at its middle; IoU by length is \
         their mean IoU weighted by length, which ELAN calls overlap/extent. The edit score compares the order of the labels. \
         Borders count within 150 ms.",
        "Un blanc sur la ligne de l’annotateur est le passage d’une étiquette à une autre, ou rien d’annoté. Images justes, exactitude équilibrée, F1 macro et kappa comptent les images auxquelles l’annotateur a donné une \
         étiquette ; les transitions n’y comptent pas. Segments justes : la vérité d’un segment suggéré est l’étiquette avec \
         laquelle il partage le plus d’images, comme dans la thèse. F1@10, 25 et 50 comptent les segments vrais qu’une \
         suggestion de même étiquette recouvre avec un IoU (images communes sur toutes les images des deux) de 0,10, 0,25 \
         et 0,50, une transition étant partagée en son milieu ; l’IoU par durée est leur moyenne pondérée par la durée, \
         qu’ELAN nomme overlap/extent. Le score d’édition compare l’ordre des étiquettes. Les bornes comptent à 150 ms près.",
    )
}

/// The name of a method.
pub fn method(language: Language, method: &Method) -> String {
    match method {
        Method::Knn { k: 1 } => language.pick("nearest neighbour", "plus proche voisin").to_owned(),
        Method::Knn { k } => {
            language.pick(format!("{k} nearest neighbours"), format!("{k} plus proches voisins"))
        }
        Method::Svm(own) => match own.kernel {
            Kernel::Linear => language.pick("linear SVM", "SVM linéaire").to_owned(),
            Kernel::Rbf { .. } => language.pick("RBF SVM", "SVM à noyau RBF").to_owned(),
        },
        Method::Logistic(_) => {
            language.pick("logistic regression", "régression logistique").to_owned()
        }
        Method::Forest(_) => language.pick("random forest", "forêt aléatoire").to_owned(),
        Method::Hmm(_) => {
            language.pick("hidden Markov models", "modèles de Markov cachés").to_owned()
        }
    }
}

/// What a method's settings are.
fn settings(language: Language, method: &Method) -> String {
    let number = |value: f64| language.number(value);
    match method {
        Method::Knn { k } => format!("k = {k}"),
        Method::Svm(own) => match own.kernel {
            Kernel::Linear => format!("C = {}", number(own.c)),
            Kernel::Rbf { gamma } => format!("C = {}, gamma = {}", number(own.c), number(gamma)),
        },
        Method::Logistic(own) => format!("C = {}", number(own.c)),
        Method::Forest(own) => language.pick(
            format!("{} trees, seed {}", own.trees, own.seed),
            format!("{} arbres, graine {}", own.trees, own.seed),
        ),
        Method::Hmm(own) => language.pick(
            format!(
                "{} states of {} Gaussians a label, variances of {} at least, stay {} s",
                own.states,
                own.components,
                number(own.learning.variance_floor),
                number(own.mean_stay_s)
            ),
            format!(
                "{} états de {} gaussiennes par étiquette, variances de {} au moins, durée {} s",
                own.states,
                own.components,
                number(own.learning.variance_floor),
                number(own.mean_stay_s)
            ),
        ),
    }
}

fn decoding(language: Language, decoding: &Decoding) -> String {
    match decoding {
        Decoding::Path(path) => {
            let stay = language.number(path.mean_stay_s);
            language.pick(
                format!("the most probable path of labels that stay {stay} s on average"),
                format!("le chemin le plus probable d’étiquettes qui durent {stay} s en moyenne"),
            )
        }
        Decoding::Frames => language.pick("each frame by itself", "chaque image seule").to_owned(),
        Decoding::Segments(own) => {
            let rule = match own.rule {
                BorderRule::Peaks => {
                    language.pick("one border a change", "une borne par changement")
                }
                BorderRule::Literal(_) => language
                    .pick("borders as the thesis words them", "bornes selon le texte de la thèse"),
            };
            let (unit, cutoff) = (
                language.number(own.activity.time_unit_s),
                language.number(own.activity.cutoff_hz),
            );
            language.pick(
                format!(
                    "segments of the energy, each by its mean ({rule}; unit of time {unit} s, low-pass {cutoff} Hz)"
                ),
                format!(
                    "segments de l’énergie, chacun par sa moyenne ({rule} ; unité de temps {unit} s, passe-bas {cutoff} Hz)"
                ),
            )
        }
    }
}

/// What a column is, in a sentence.
pub fn sentence(language: Language, of: &Column) -> String {
    let Lesson { method: own, thinned_to_hz, decoding: cut, .. } = &of.lesson;
    let sequential = matches!(own, Method::Hmm(_));
    let frames = match thinned_to_hz {
        _ if sequential => String::new(),
        Some(rate) => {
            let rate = language.number(*rate);
            language.pick(
                format!(", {rate} training frames per second"),
                format!(", {rate} images d’apprentissage par seconde"),
            )
        }
        None => {
            language.pick(", all training frames", ", toutes les images d’apprentissage").to_owned()
        }
    };
    let alone = match of.own_person {
        true => language.pick(", each person learnt alone", ", chaque personne apprise seule"),
        false => "",
    };
    format!(
        "{}{} {} ({}){frames}{alone}; {}.",
        column(language, of.kind),
        language.pick(":", " :"),
        method(language, own),
        settings(language, own),
        decoding(language, cut)
    )
}

/// What is held out together.
pub fn split(language: Language, split: Split) -> String {
    match split {
        Split::Take => {
            language.pick("takes held out one by one", "prises mises à part une à une").to_owned()
        }
        Split::Person => language
            .pick("persons held out one by one", "personnes mises à part une à une")
            .to_owned(),
        Split::Kind => language
            .pick("kinds of takes held out one by one", "genres de prises mis à part un à un")
            .to_owned(),
        Split::Folds(k) => language.pick(
            format!("takes held out in {k} folds"),
            format!("prises mises à part en {k} lots"),
        ),
    }
}

/// What a split does not tell.
pub fn split_caution(language: Language, split: Split) -> &'static str {
    match split {
        Split::Take | Split::Folds(_) => language.pick(
            "Takes of the same people were learnt from: how other people are labelled is told by --split person.",
            "D’autres prises des mêmes personnes ont été apprises : ce que donnent d’autres personnes, --split person le dit.",
        ),
        Split::Person => language.pick(
            "Nobody was learnt from who was tested.",
            "Aucune personne testée n’a été apprise.",
        ),
        Split::Kind => language.pick(
            "What was performed differs between learning and testing; people may be the same.",
            "Ce qui est joué diffère entre apprentissage et test ; les personnes peuvent être les mêmes.",
        ),
    }
}

/// That there is too little to resample.
pub fn no_intervals(language: Language, split: Split) -> String {
    let unit = match split {
        Split::Person => language.pick("people", "personnes"),
        _ => language.pick("takes", "prises"),
    };
    language.pick(
        format!("No intervals: there are fewer than {FEWEST} {unit} to resample."),
        format!("Pas d’intervalles : il y a moins de {FEWEST} {unit} à rééchantillonner."),
    )
}
