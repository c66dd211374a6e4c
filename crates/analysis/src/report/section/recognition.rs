//! Recognition: confusion matrices, shares of right answers, comparisons.

use mimique_report::document::{Block, slug};
use mimique_stats::{Factor, confusion};
use mimique_study::KindOfQuestion as _;

use crate::report::figure;
use crate::report::results::NamedConfusion;
use crate::report::section::Writer;
use crate::trials::asked_question::AskedQuestion;
use crate::trials::measure::Measure;

impl Writer<'_> {
    /// Forced choice against the right answer.
    pub(crate) fn recognition(&mut self, asked: &AskedQuestion<'_>, measure: &Measure) {
        let language = self.language();
        let title = language.pick(
            format!("Recognition: {}", measure.label),
            format!("Reconnaissance : {}", measure.label),
        );
        self.blocks.push(Block::Heading(2, title));
        let truth = asked.truth();
        let names = self.factors_told(asked);
        self.confusion_matrices(asked, &truth, &names);
        self.detection(asked, &truth, &names);

        let chance = match asked.question.map(|question| question.kind.options().len()) {
            Some(options) if options > 1 => Some(1.0 / options as f64),
            _ => None,
        };
        let method = names.iter().find(|name| **name != truth);
        let mut groups = Vec::new();
        let first = method.map(|name| measure.factor(self.export, name, &[]));
        if let (Some(first), true) = (&first, names.contains(&truth)) {
            let second = measure.factor(self.export, &truth, &[]);
            for (b, shown) in second.levels.iter().enumerate() {
                let rows = (0..first.levels.len())
                    .map(|a| {
                        let share = self.shares_by(measure, |i| {
                            first.codes[i] as usize == a && second.codes[i] as usize == b
                        });
                        (self.naming.level(&first.name, &first.levels[a]), share)
                    })
                    .collect();
                groups.push((self.naming.level(&truth, shown), rows));
            }
        }
        if let Some(first) = &first {
            let rows = (0..first.levels.len())
                .map(|a| {
                    let share = self.shares_by(measure, |i| first.codes[i] as usize == a);
                    (self.naming.level(&first.name, &first.levels[a]), share)
                })
                .collect();
            groups.insert(0, (language.pick("all", "toutes").to_owned(), rows));
        }
        if !groups.is_empty() {
            let caption = language.pick(
                "Share of right answers over all trials, with Wilson’s 95 % interval",
                "Part de réponses justes sur tous les essais, avec l’intervalle de Wilson à 95 %",
            );
            let id = format!("{}-shares", slug(&measure.id));
            self.figure(figure::shares(language, &id, caption, chance, &groups));
            self.person_shares(measure, chance);
            self.paragraph(
                "These intervals describe the trials; comparisons follow below on one value a person.",
                "Ces intervalles décrivent les essais ; les comparaisons suivent, sur une valeur par personne.",
            );
        }
        self.comparisons(measure, &names);
    }

    /// A factor of the clips, a code for each answer to a question.
    pub(crate) fn factor_of_answers(&self, asked: &AskedQuestion<'_>, name: &str) -> Factor {
        let answers = self.export.answers_to(&asked.id).iter();
        let cells = answers.map(|answer| self.export.level(answer, name));
        Factor::from_cells(name, cells, |level| level.parse().ok())
    }

    fn confusion_matrices(&mut self, asked: &AskedQuestion<'_>, truth: &str, names: &[String]) {
        let language = self.language();
        let answers = self.export.answers_to(&asked.id);
        let group = names.iter().find(|name| *name != truth).cloned();
        let levels: Vec<Option<String>> = match &group {
            None => vec![None],
            Some(name) => {
                let all = self.factor_of_answers(asked, name);
                all.levels.into_iter().map(Some).chain([None]).collect()
            }
        };
        for level in levels {
            let chosen: Vec<_> = answers
                .iter()
                .filter(|answer| match (&group, &level) {
                    (Some(name), Some(level)) => {
                        self.export.level(answer, name) == Some(level.as_str())
                    }
                    _ => true,
                })
                .collect();
            let shown = Factor::from_cells(
                "truth",
                chosen.iter().map(|answer| answer.truth.as_deref()),
                |_| None,
            );
            let answered =
                Factor::from_cells(&asked.id, chosen.iter().map(|a| Some(&*a.text)), |_| None);
            let Ok(result) = confusion(&shown, &answered) else { continue };
            let of = match (&group, &level) {
                (Some(name), Some(level)) => self.naming.level(name, level),
                _ => language.pick("All trials", "Tous les essais").to_owned(),
            };
            let id = format!(
                "{}-confusion-{}",
                slug(&asked.id),
                slug(level.as_deref().unwrap_or("all"))
            );
            let drawing = figure::confusion(language, &id, &of, &result, |label| {
                self.naming.level(truth, label)
            });
            self.figure(drawing);
            let by = group.clone().filter(|_| level.is_some());
            let of = level.unwrap_or_else(|| "all".to_owned());
            self.results.confusion.push(NamedConfusion {
                response: asked.id.clone(),
                by,
                of,
                result,
            });
        }
    }
}
