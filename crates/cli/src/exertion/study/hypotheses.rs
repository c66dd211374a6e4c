//! What is tested of the design: of each factor that has several values, whether the effort that people see
//! differs with it, and whether it follows the exertion that was computed.

use std::collections::BTreeMap;

use mimique_study::{Hypothesis, LocalText, Measure, TestName};

use super::super::args::StudyOptions;

/// Factors, and that each makes no difference, in English and in French.
const FACTORS: [(&str, [&str; 2]); 5] = [
    (
        "activity",
        [
            "The effort that is seen is the same for every activity.",
            "L’effort perçu est le même quelle que soit l’activité.",
        ],
    ),
    (
        "level",
        [
            "The effort that is seen is the same for every level of training.",
            "L’effort perçu est le même quel que soit le niveau d’entraînement.",
        ],
    ),
    (
        "expressivity",
        [
            "The effort that is seen is the same for every expressivity.",
            "L’effort perçu est le même quelle que soit l’expressivité.",
        ],
    ),
    (
        "model",
        [
            "The effort that is seen is the same for every model of the face.",
            "L’effort perçu est le même quel que soit le modèle du visage.",
        ],
    ),
    (
        "breath",
        [
            "The effort that is seen is the same with and without breath.",
            "L’effort perçu est le même avec et sans respiration.",
        ],
    ),
];

/// The hypotheses of a design.
pub(super) fn of(args: &StudyOptions) -> Vec<Hypothesis> {
    let mut all = Vec::new();
    let mut add = |test: TestName, factors: &[&str], [en, fr]: [&str; 2]| {
        all.push(Hypothesis {
            id: format!("H{}", all.len() + 1),
            statement: LocalText::Languages(BTreeMap::from(
                [("en", en), ("fr", fr)].map(|(code, text)| (code.to_owned(), text.to_owned())),
            )),
            test,
            response: "effort".to_owned(),
            measure: Measure::Answer,
            factors: factors.iter().map(|factor| (*factor).to_owned()).collect(),
            levels: Vec::new(),
            generalise: None,
            smallest_effect: None,
            smallest_effect_reason: None,
        });
    };
    if args.activities.len() > 1 && args.levels.len() > 1 {
        add(
            TestName::AlignedRankTransform,
            &["activity", "level"],
            [
                "The effort that is seen depends neither on the activity nor on the level of training.",
                "L’effort perçu ne dépend ni de l’activité ni du niveau d’entraînement.",
            ],
        );
    }
    let values = [
        args.activities.len(),
        args.levels.len(),
        args.expressivities.len(),
        args.models.len(),
        args.breaths.len(),
    ];
    for ((factor, statement), values) in FACTORS.into_iter().zip(values) {
        match values {
            0 | 1 => {}
            2 => add(TestName::Wilcoxon, &[factor], statement),
            _ => add(TestName::Friedman, &[factor], statement),
        }
    }
    if !args.exertion_differs() {
        return all;
    }
    add(
        TestName::Spearman,
        &["borg"],
        [
            "The effort that is seen does not follow the exertion that was computed.",
            "L’effort perçu ne suit pas l’effort calculé.",
        ],
    );
    all
}
