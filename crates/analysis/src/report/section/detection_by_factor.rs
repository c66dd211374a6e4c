//! d' and criterion at each level of the factors of the clips, and the levels compared within people.

use std::collections::{BTreeMap, HashSet};

use mimique_report::document::{Block, DataTable, slug};
use mimique_stats::{
    Blocks, DetectedCategory, Detection, Labelled, PersonSensitivity, Sensitivity,
};
use serde::Serialize;

use crate::hypothesis::call::Call;
use crate::hypothesis::person_level::{self, PersonLevel, WithinDesigns};
use crate::hypothesis::reading;
use crate::report::figure::{DetectionPanel, detection_planes};
use crate::report::section::Writer;
use crate::report::section::detection::CategoryDetection;
use crate::report::tables;
use crate::trials::asked_question::AskedQuestion;
use crate::trials::measure::{Measure, MeasureKind};

/// What answers are matched by, and detection at each level.
type DetectedByLevel = (Vec<String>, Vec<(String, Detection)>);

/// Detection at the levels of a factor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct DetectionByFactor {
    pub factor: String,
    pub levels: Vec<String>,
    /// What is equal within the matched sets of answers that are compared.
    pub matched_by: Vec<String>,
    pub categories: Vec<CategoryByFactor>,
}

/// A category against all others, at each level of a factor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct CategoryByFactor {
    pub category: String,
    pub at: Labelled<DetectionAtLevel>,
    /// None where somebody was shown fewer than five signals at some level.
    pub compared: Option<ComparedDetection>,
}

/// A category at one level.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct DetectionAtLevel {
    #[serde(flatten)]
    pub detection: CategoryDetection,
    /// d' and criterion of each person with answers at this level; none where no signal or no noise was shown.
    pub each: Labelled<Option<[f64; 2]>>,
}

/// The levels compared within people.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct ComparedDetection {
    pub d_prime: PersonLevel,
    pub criterion: PersonLevel,
}

/// A number of a person's detection that is compared.
#[derive(Debug, Clone, Copy)]
struct Compared {
    /// As the scripts call it.
    name: &'static str,
    of: fn(&Sensitivity) -> f64,
}

const D_PRIME: Compared = Compared { name: "d_prime", of: |own| own.d_prime };
const CRITERION: Compared = Compared { name: "criterion", of: |own| own.criterion };

impl Writer<'_> {
    /// d' and criterion by each factor but what was shown itself. Factors at a level of which fewer than two
    /// categories were shown are left out.
    pub(crate) fn detection_by_factors(
        &mut self,
        asked: &AskedQuestion<'_>,
        truth: &str,
        factors: &[String],
    ) -> Vec<DetectionByFactor> {
        let mut results = Vec::new();
        for factor in factors.iter().filter(|factor| *factor != truth) {
            let Some((matched_by, found)) = self.detected_by(asked, factor) else { continue };
            let result = of_factor(&asked.id, factor, matched_by, &found);
            let shown = self.naming.factor(factor);
            self.heading(3, &format!("d′ by {shown}"), &format!("d′ par {shown}"));
            let tests = self.compared_table(asked, truth, &result);
            if tests.rows.is_empty() {
                self.blocks.push(Block::Paragraph(self.language().pick(
                    format!("By {shown} somebody was shown fewer than five of each category at some level: d′ and c are told of all answers together, and the levels are not compared."),
                    format!("Par {shown}, quelqu’un a vu moins de cinq extraits de chaque catégorie à un niveau : d′ et c sont donnés pour toutes les réponses ensemble, et les niveaux ne sont pas comparés."),
                )));
            }
            let compared = result.categories.iter().filter_map(|own| {
                let tests = &own.compared.as_ref()?.d_prime;
                Some((self.naming.level(truth, &own.category), tests))
            });
            let compared: Vec<(String, &PersonLevel)> = compared.collect();
            if !compared.is_empty() {
                let words = reading::d_prime_by(&self.naming, factor, &compared);
                self.blocks.push(Block::Reading(words));
            }
            self.levels_figure(asked, truth, factor, &found);
            let table = self.levels_table(asked, truth, &result);
            self.folded_table(table);
            if !tests.rows.is_empty() {
                self.folded_table(tests);
            }
            results.push(result);
        }
        results
    }

    /// Detection among the matched answers of each level, and what they are matched by; none where a level has too few
    /// categories.
    fn detected_by(&self, asked: &AskedQuestion<'_>, factor: &str) -> Option<DetectedByLevel> {
        let measure = Measure::of_question(self.export, asked, self.language())?;
        let of_measure = measure.factor(self.export, factor, &[]);
        let matching = measure.matching(self.export, &of_measure);
        let matched: HashSet<usize> =
            matching.rows().into_iter().map(|row| measure.trial[row]).collect();
        let answers = self.export.answers_to(&asked.id);
        let factor = self.factor_of_answers(asked, factor);
        let detected = |(code, level): (usize, &String)| {
            let is_at = |place: usize| factor.codes[place] as usize == code;
            let is_counted = |place: usize| is_at(place) && matched.contains(&answers[place].trial);
            Some((level.clone(), self.detected(asked, is_counted)?))
        };
        let levels = &factor.levels;
        let found: Option<Vec<(String, Detection)>> =
            (levels.len() > 1).then(|| levels.iter().enumerate().map(detected).collect()).flatten();
        Some((matching.by, found?))
    }

    fn levels_table(
        &self,
        asked: &AskedQuestion<'_>,
        truth: &str,
        result: &DetectionByFactor,
    ) -> DataTable {
        let shown = self.naming.factor(&result.factor);
        let caption = self.language().pick(
            format!("Detection of each category at each level of {shown}"),
            format!("Détection de chaque catégorie à chaque niveau du facteur {shown}"),
        );
        let id = format!("{}-detection-by-{}", slug(&asked.id), slug(&result.factor));
        let rows = result.categories.iter().flat_map(|own| {
            let category = self.naming.level(truth, &own.category);
            own.at.iter().map(move |(level, at)| {
                let level = self.naming.level(&result.factor, level);
                (format!("{category}, {level}"), &at.detection)
            })
        });
        self.detection_rows(id, caption, rows)
    }

    /// The levels beside each other, with common axes.
    fn levels_figure(
        &mut self,
        asked: &AskedQuestion<'_>,
        truth: &str,
        factor: &str,
        found: &[(String, Detection)],
    ) {
        let language = self.language();
        let panels: Vec<DetectionPanel> = found
            .iter()
            .map(|(level, found)| DetectionPanel {
                title: self.naming.level(factor, level),
                categories: self.detection_points(truth, found),
            })
            .collect();
        let shown = self.naming.factor(factor);
        let caption = language.pick(
            format!("d′ against the criterion c, by {shown}"),
            format!("d′ selon le critère c, par {shown}"),
        );
        let id = format!("{}-d-prime-by-{}", slug(&asked.id), slug(factor));
        self.figure(detection_planes(language, &id, &caption, &panels));
    }

    /// The recommended tests of d' and of c, category by category.
    fn compared_table(
        &self,
        asked: &AskedQuestion<'_>,
        truth: &str,
        result: &DetectionByFactor,
    ) -> DataTable {
        let language = self.language();
        let shown = self.naming.factor(&result.factor);
        let caption = language.pick(
            format!("d′ and c compared between the levels of {shown}, one value a person"),
            format!(
                "d′ et c comparés entre les niveaux du facteur {shown}, une valeur par personne"
            ),
        );
        let heading = language.pick(
            ["category", "", "", "test", "p", "p (Holm)", "effect", "difference [95 %]"],
            ["catégorie", "", "", "test", "p", "p (Holm)", "effet", "différence [95 %]"],
        );
        let id = format!("{}-detection-by-{}-tests", slug(&asked.id), slug(&result.factor));
        let mut table = DataTable::new(id, caption, heading);
        for own in &result.categories {
            let Some(compared) = &own.compared else { continue };
            for (name, tests) in [("d′", &compared.d_prime), ("c", &compared.criterion)] {
                let lines = tables::recommended_lines(
                    &self.naming,
                    &result.factor,
                    MeasureKind::Rating,
                    tests,
                    usize::MAX,
                );
                for (label, outcome, difference) in lines {
                    let [test, p, effect] = tables::cells(language, outcome);
                    let category = self.naming.level(truth, &own.category);
                    let corrected = tables::corrected_cell(language, outcome);
                    let cells = [category, name.to_owned(), label, test, p, corrected, effect];
                    table.row(cells.into_iter().chain([difference]));
                }
            }
        }
        table
    }
}

/// Every category that was shown at each level.
fn of_factor(
    response: &str,
    factor: &str,
    matched_by: Vec<String>,
    found: &[(String, Detection)],
) -> DetectionByFactor {
    let levels: Vec<String> = found.iter().map(|(level, _)| level.clone()).collect();
    let of_category = |category: &str| -> Option<CategoryByFactor> {
        let at: Vec<&DetectedCategory> = found
            .iter()
            .map(|(_, level)| level.categories.iter().find(|own| own.category == category))
            .collect::<Option<_>>()?;
        let compared = at.iter().all(|own| !own.few_signals).then(|| {
            let compared = |what: Compared| {
                let blocks = blocks(&levels, &at, what.of);
                let call = |design, test| {
                    let call = Call::new(design, test).list(&matched_by);
                    let call = call.text(what.name).text(response);
                    call.text(category).text(factor).list(&levels)
                };
                person_level::of_blocks(&blocks, WithinDesigns::DETECTION, call)
            };
            ComparedDetection { d_prime: compared(D_PRIME), criterion: compared(CRITERION) }
        });
        let at = at.into_iter().map(|own| DetectionAtLevel {
            detection: CategoryDetection::of(own),
            each: Labelled(own.people.iter().map(of_person).collect()),
        });
        let at = Labelled::zip(&levels, at);
        Some(CategoryByFactor { category: category.to_owned(), at, compared })
    };
    let categories = found.first().into_iter().flat_map(|(_, level)| &level.categories);
    DetectionByFactor {
        factor: factor.to_owned(),
        categories: categories.filter_map(|own| of_category(&own.category)).collect(),
        matched_by: matched_by.clone(),
        levels,
    }
}

fn of_person(person: &PersonSensitivity) -> (String, Option<[f64; 2]>) {
    let found = person.sensitivity.map(|own| [own.d_prime, own.criterion]);
    (person.participant.clone(), found)
}

/// A number of each person at each level, of the people who have all of them.
fn blocks(levels: &[String], at: &[&DetectedCategory], of: fn(&Sensitivity) -> f64) -> Blocks {
    let mut numbers: BTreeMap<&str, Vec<Option<f64>>> = BTreeMap::new();
    for (level, own) in at.iter().enumerate() {
        for person in &own.people {
            let own = numbers.entry(&person.participant).or_insert_with(|| vec![None; at.len()]);
            own[level] = person.sensitivity.as_ref().map(of);
        }
    }
    let all = numbers.len();
    let complete = numbers.into_iter().filter_map(|(person, values)| {
        Some((person.to_owned(), values.into_iter().collect::<Option<Vec<f64>>>()?))
    });
    let (blocks, responses): (Vec<String>, Vec<Vec<f64>>) = complete.unzip();
    let incomplete = all - blocks.len();
    Blocks { groups: levels.to_vec(), blocks, responses, incomplete, dropped: 0 }
}
