//! Which of two clips was chosen: how often each, against which, and whether that is more than chance.

use std::collections::{BTreeMap, HashMap};

use mimique_report::document::{Block, DataTable, slug};
use mimique_stats::PairedComparisons;
use mimique_study::Clip;
use serde::Serialize;

use crate::choices::answers::by_factor;
use crate::choices::tested::ChoiceTests;
use crate::report::section::{MOST_LEVELS, Writer};
use crate::trials::asked_question::AskedQuestion;
use crate::trials::export::Answer;

/// How often each of two clips was chosen, for every two that were shown together.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Choices {
    /// The question.
    pub response: String,
    /// The factor whose levels are counted; none for single clips.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by: Option<String>,
    pub pairs: Vec<ChoicesOfPair>,
    /// Tests of the choices between the levels; none for single clips.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tests: Option<ChoiceTests>,
}

/// How often each of two was chosen where both were shown.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct ChoicesOfPair {
    pub first: String,
    pub second: String,
    pub first_chosen: u64,
    pub second_chosen: u64,
    /// Answers that there is no difference.
    pub no_difference: u64,
}

/// One answer: the trial's clip, the one beside it, and which was chosen.
struct Choice<'e> {
    clip: &'e str,
    beside: &'e str,
    chosen: Chosen,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Chosen {
    Clip,
    Beside,
    Neither,
}

impl<'a> Writer<'a> {
    /// The counts of a question about which of two clips.
    pub(crate) fn choices(&mut self, asked: &AskedQuestion<'_>) {
        let language = self.language();
        let answers = self.export.answers_to(&asked.id);
        let choices: Vec<Choice<'_>> =
            answers.iter().filter_map(|answer| self.choice(answer)).collect();
        if choices.is_empty() {
            return;
        }
        let label = asked.label(language.code());
        let title = language.pick(format!("Choice: {label}"), format!("Choix : {label}"));
        self.blocks.push(Block::Heading(2, title));
        let said = |word: &str| answers.iter().filter(|answer| &*answer.text == word).count();
        let [left, right, same] = ["left", "right", "same"].map(said);
        let left = language.counted(left, ["answer", "answers"], ["réponse a", "réponses ont"]);
        self.blocks.push(Block::Paragraph(language.pick(
            format!("{left} chose the clip on the left, {right} the one on the right, {same} neither. The tables of counts count trials; the recommended tests know that the choices of one person belong together."),
            format!("{left} choisi l’extrait de gauche, {right} celui de droite, {same} aucun des deux. Les tableaux d’effectifs comptent des essais ; les tests recommandés savent que les choix d’une personne vont ensemble."),
        )));
        let clips = self.study.clips();
        let clips: HashMap<&str, &Clip> =
            clips.iter().map(|clip| (clip.id.as_str(), clip)).collect();
        let mut factors = self.study.factor_names();
        factors.push("avatar".to_owned());
        factors.sort_by_key(|factor| factor != "method");
        let mut patterns: Vec<Vec<usize>> = Vec::new();
        for factor in factors {
            let level = |clip: &str| clips.get(clip).and_then(|clip| clip.factor_text(&factor));
            let pairs = counted(&choices, level, &self.naming.level_order(&factor));
            let name = |level: &str| self.naming.level(&factor, level);
            let shown = self.naming.factor(&factor);
            let caption = language.pick(
                format!("{label}: choices by {shown}"),
                format!("{label} : choix par {shown}"),
            );
            let id = format!("{}-choices-by-{}", slug(&asked.id), slug(&factor));
            let table = self.table_of_choices(id, &caption, &pairs, name);
            if pairs.is_empty() {
                continue;
            }
            self.blocks.push(Block::Table(table));
            let order = self.naming.level_order(&factor);
            let data = by_factor(self.export, &asked.id, &factor, &order, &[]);
            // Of two factors that part the clips alike the first is tested.
            let data = data.filter(|data| {
                let pattern = pattern(data);
                let is_new = !patterns.contains(&pattern);
                patterns.push(pattern);
                is_new && data.items.len() <= MOST_LEVELS
            });
            let tests = data.map(|data| {
                let tests = self.choice_tests(asked, &factor, &data);
                self.consistency(&tests);
                tests
            });
            let by = Some(factor);
            self.results.choices.push(Choices { response: asked.id.clone(), by, pairs, tests });
        }
        self.reasons(asked);
        let pairs = counted(&choices, |clip| Some(clip.to_owned()), &[]);
        let caption = language
            .pick(format!("{label}: choices by clip"), format!("{label} : choix par extrait"));
        let id = format!("{}-choices-by-clip", slug(&asked.id));
        let table = self.table_of_choices(id, &caption, &pairs, str::to_owned);
        if !pairs.is_empty() {
            self.blocks.push(Block::Table(table));
            let response = asked.id.clone();
            self.results.choices.push(Choices { response, by: None, pairs, tests: None });
        }
    }

    fn choice(&self, answer: &Answer) -> Option<Choice<'a>> {
        let trial = &self.export.trials[answer.trial];
        let beside = trial.beside.as_ref()?;
        let chosen = match (&*answer.text, beside.left) {
            ("left", true) | ("right", false) => Chosen::Beside,
            ("left", false) | ("right", true) => Chosen::Clip,
            ("same", _) => Chosen::Neither,
            _ => return None,
        };
        Some(Choice { clip: &trial.stimulus, beside: &beside.clip, chosen })
    }

    fn table_of_choices(
        &self,
        id: String,
        caption: &str,
        pairs: &[ChoicesOfPair],
        name: impl Fn(&str) -> String,
    ) -> DataTable {
        let columns = self.language().pick(
            ["first", "second", "first chosen", "second chosen", "no difference", "trials"],
            ["premier", "second", "premier choisi", "second choisi", "sans différence", "essais"],
        );
        let mut table = DataTable::new(id, caption, columns);
        for pair in pairs {
            let trials = pair.first_chosen + pair.second_chosen + pair.no_difference;
            table.row([
                name(&pair.first),
                name(&pair.second),
                pair.first_chosen.to_string(),
                pair.second_chosen.to_string(),
                pair.no_difference.to_string(),
                trials.to_string(),
            ]);
        }
        table
    }
}

/// Both items of each answer, numbered as they are met: alike for factors that part the clips alike.
fn pattern(data: &PairedComparisons) -> Vec<usize> {
    let mut met: Vec<usize> = Vec::new();
    let items = data.answers.iter().flat_map(|answer| [answer.left, answer.right]);
    items
        .map(|item| {
            met.iter().position(|own| *own == item).unwrap_or_else(|| {
                met.push(item);
                met.len() - 1
            })
        })
        .collect()
}

/// The choices between any two levels that differ, each two once, in the given order or else by name.
fn counted(
    choices: &[Choice<'_>],
    level: impl Fn(&str) -> Option<String>,
    order: &[String],
) -> Vec<ChoicesOfPair> {
    let place = |level: &String| {
        (order.iter().position(|each| each == level).unwrap_or(order.len()), level.clone())
    };
    let mut counts: BTreeMap<_, ChoicesOfPair> = BTreeMap::new();
    for choice in choices {
        let (Some(clip), Some(beside)) = (level(choice.clip), level(choice.beside)) else {
            continue;
        };
        if clip == beside {
            continue;
        }
        let clip_is_first = place(&clip) < place(&beside);
        let (first, second) = if clip_is_first { (clip, beside) } else { (beside, clip) };
        let key = (place(&first), place(&second));
        let pair = counts.entry(key).or_insert_with(|| ChoicesOfPair {
            first,
            second,
            first_chosen: 0,
            second_chosen: 0,
            no_difference: 0,
        });
        match (choice.chosen, clip_is_first) {
            (Chosen::Clip, true) | (Chosen::Beside, false) => pair.first_chosen += 1,
            (Chosen::Clip, false) | (Chosen::Beside, true) => pair.second_chosen += 1,
            (Chosen::Neither, _) => pair.no_difference += 1,
        }
    }
    counts.into_values().collect()
}
