//! Best-worst scaling: how often each option was picked as the best and as the worst of those shown.

use std::collections::HashMap;

use mimique_report::document::{Block, DataTable, slug};
use mimique_study::columns::ASSIGNED_CONDITION;
use mimique_study::{KindOfQuestion as _, Measure as What, Question};
use serde::Serialize;

use crate::report::section::Writer;
use crate::trials::asked_question::AskedQuestion;

/// How often the options of a question were picked.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct BestWorstCounts {
    /// The question.
    pub response: String,
    /// The factor, or the condition that people are in; none for all trials.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by: Option<String>,
    /// Its level.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    pub options: Vec<OptionCounts>,
}

/// How often an option was picked.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct OptionCounts {
    pub option: String,
    pub best: u64,
    pub worst: u64,
    /// Answers in which it could be picked.
    pub shown: u64,
    /// (best - worst) / shown, from -1 to 1.
    pub score: f64,
}

/// One answer: what was picked, by whom, and in which trial if it was asked in one.
struct Pick<'e> {
    best: &'e str,
    worst: &'e str,
    person: usize,
    trial: Option<usize>,
}

impl<'a> Writer<'a> {
    /// The counts of a question about the best and the worst, of all answers and by condition.
    pub(crate) fn best_worst(&mut self, question: &Question) {
        let language = self.language();
        let picks = self.picks(question);
        if picks.is_empty() {
            return;
        }
        let label = question.prompt.in_language(language.code());
        let title = language
            .pick(format!("Best and worst: {label}"), format!("Meilleur et pire : {label}"));
        self.blocks.push(Block::Heading(2, title));
        self.paragraph(
            "The score is the share of answers that picked an option as the best less the share that picked it as the worst: 1 is always the best, -1 always the worst. The counts are of answers; no test of them stands here.",
            "Le score est la part des réponses qui ont choisi une option comme la meilleure, moins la part qui l’a choisie comme la pire : 1 est toujours la meilleure, -1 toujours la pire. Les effectifs sont ceux des réponses ; aucun test n’en figure ici.",
        );
        let all = counted(question, picks.iter());
        let id = format!("{}-scores", slug(&question.id));
        let mut table = self.table_of_scores(question, id, None);
        self.score_rows(&mut table, question, None, &all);
        self.blocks.push(Block::Table(table));
        self.add_counts(question, None, None, all);
        for factor in self.factors_of_picks(question) {
            self.scores_by(question, &factor, &picks);
        }
    }

    /// The answers in trials, and those of the page about the participant.
    fn picks(&self, question: &Question) -> Vec<Pick<'a>> {
        let export = self.export;
        let [best, worst] = ["best", "worst"].map(|pick| format!("{}.{pick}", question.id));
        let of_trial: HashMap<(usize, usize), &str> = export
            .answers_to(&worst)
            .iter()
            .map(|answer| ((answer.person, answer.trial), &*answer.text))
            .collect();
        let in_trials = export.answers_to(&best).iter().filter_map(|answer| {
            let worst = of_trial.get(&(answer.person, answer.trial))?;
            let (person, trial) = (answer.person, Some(answer.trial));
            Some(Pick { best: &answer.text, worst, person, trial })
        });
        let cells = |name: &str| {
            let column = export.about.iter().find(|(column, _)| column == name);
            column.map_or(&[][..], |(_, cells)| cells.as_slice())
        };
        let of_people = cells(&best).iter().zip(cells(&worst)).enumerate();
        let of_people = of_people.filter_map(|(person, (best, worst))| {
            let is_used = export.people[person].excluded.is_none();
            let (best, worst) = (best.as_deref()?, worst.as_deref()?);
            is_used.then_some(Pick { best, worst, person, trial: None })
        });
        in_trials.chain(of_people).collect()
    }

    /// The factors in use that the answers can be told of, and the condition of people.
    fn factors_of_picks(&self, question: &Question) -> Vec<String> {
        let asked = AskedQuestion { id: question.id.clone(), question: Some(question) };
        let is_told = |factor: &&String| self.of_pair(&asked, What::Answer, factor).is_none();
        let of_clips = self.factors.iter().filter(is_told).cloned();
        let conditions = !self.study.conditions().is_empty();
        of_clips.chain(conditions.then(|| ASSIGNED_CONDITION.to_owned())).collect()
    }

    fn scores_by(&mut self, question: &Question, factor: &str, picks: &[Pick<'_>]) {
        let export = self.export;
        let place = export.factors.iter().position(|name| name == factor);
        let about = export.about.iter().find(|(column, _)| column == factor);
        let level_of = |pick: &Pick<'_>| match (about, place) {
            (Some((_, cells)), _) => cells[pick.person].as_deref(),
            (None, Some(place)) => export.trials[pick.trial?].levels[place].as_deref(),
            (None, None) => None,
        };
        let mut levels: Vec<&str> = picks.iter().filter_map(level_of).collect();
        let order = self.naming.level_order(factor);
        let rank = |level: &str| order.iter().position(|each| each == level);
        levels.sort_by_key(|level| (rank(level).unwrap_or(order.len()), *level));
        levels.dedup();
        if levels.len() < 2 {
            return;
        }
        let id = format!("{}-scores-by-{}", slug(&question.id), slug(factor));
        let mut table = self.table_of_scores(question, id, Some(factor));
        for level in levels {
            let own = picks.iter().filter(|pick| level_of(pick) == Some(level));
            let counts = counted(question, own);
            self.score_rows(&mut table, question, Some(self.naming.level(factor, level)), &counts);
            self.add_counts(question, Some(factor), Some(level), counts);
        }
        self.blocks.push(Block::Table(table));
    }

    fn table_of_scores(&self, question: &Question, id: String, by: Option<&str>) -> DataTable {
        let language = self.language();
        let label = question.prompt.in_language(language.code());
        let shown = by.map(|factor| self.naming.factor(factor));
        let caption = match &shown {
            None => language.pick(
                format!("{label}: best-minus-worst scores"),
                format!("{label} : scores du meilleur moins le pire"),
            ),
            Some(shown) => language.pick(
                format!("{label}: best-minus-worst scores by {shown}"),
                format!("{label} : scores du meilleur moins le pire par {shown}"),
            ),
        };
        let columns = language.pick(
            ["option", "best", "worst", "shown", "score"],
            ["option", "meilleur", "pire", "montrée", "score"],
        );
        let columns = shown.into_iter().chain(columns.map(str::to_owned));
        DataTable::new(id, caption, columns)
    }

    fn score_rows(
        &self,
        table: &mut DataTable,
        question: &Question,
        level: Option<String>,
        counts: &[OptionCounts],
    ) {
        let language = self.language();
        for count in counts {
            let option = question.kind.options().iter().find(|each| each.value == count.option);
            let option = option
                .map_or(count.option.as_str(), |option| option.label.in_language(language.code()));
            let numbers = [count.best, count.worst, count.shown].map(|count| count.to_string());
            let cells = level.iter().cloned().chain([option.to_owned()]).chain(numbers);
            table.row(cells.chain([language.fixed(count.score, 3)]));
        }
    }

    fn add_counts(
        &mut self,
        question: &Question,
        by: Option<&str>,
        of: Option<&str>,
        options: Vec<OptionCounts>,
    ) {
        self.results.best_worst.push(BestWorstCounts {
            response: question.id.clone(),
            by: by.map(str::to_owned),
            of: of.map(str::to_owned),
            options,
        });
    }
}

/// The options in the study's order. Every answer shows all of them.
fn counted<'p>(
    question: &Question,
    picks: impl Iterator<Item = &'p Pick<'p>> + Clone,
) -> Vec<OptionCounts> {
    let shown = picks.clone().count() as u64;
    let options = question.kind.options().iter();
    options
        .map(|option| {
            let best = picks.clone().filter(|pick| pick.best == option.value).count() as u64;
            let worst = picks.clone().filter(|pick| pick.worst == option.value).count() as u64;
            let score = if shown == 0 { 0.0 } else { (best as f64 - worst as f64) / shown as f64 };
            OptionCounts { option: option.value.clone(), best, worst, shown, score }
        })
        .collect()
}
