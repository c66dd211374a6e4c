//! Which of two clips was chosen: how often each, against which. Counts of trials, no test: the choices of
//! one person are not independent of each other.

use std::collections::{BTreeMap, HashMap};

use mimique_study::Clip;
use serde::Serialize;

use crate::report::document::{Block, DataTable, slug};
use crate::report::section::Writer;
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
        self.blocks.push(Block::Paragraph(language.pick(
            format!("{left} answers chose the clip on the left, {right} the one on the right, {same} neither. The tables count trials; the choices of one person are not independent, so no test of these counts stands here."),
            format!("{left} réponses ont choisi l’extrait de gauche, {right} celui de droite, {same} aucun des deux. Les tables comptent des essais ; les choix d’une personne ne sont pas indépendants, aucun test de ces effectifs ne figure donc ici."),
        )));
        let clips = self.study.clips();
        let clips: HashMap<&str, &Clip> =
            clips.iter().map(|clip| (clip.id.as_str(), clip)).collect();
        let mut factors = self.study.factor_names();
        factors.push("avatar".to_owned());
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
            self.add_choices(asked, Some(factor), pairs, table);
        }
        let pairs = counted(&choices, |clip| Some(clip.to_owned()), &[]);
        let caption = language
            .pick(format!("{label}: choices by clip"), format!("{label} : choix par extrait"));
        let id = format!("{}-choices-by-clip", slug(&asked.id));
        let table = self.table_of_choices(id, &caption, &pairs, str::to_owned);
        self.add_choices(asked, None, pairs, table);
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

    /// Adds counts, unless there are none: no two clips that were shown together differ.
    fn add_choices(
        &mut self,
        asked: &AskedQuestion<'_>,
        by: Option<String>,
        pairs: Vec<ChoicesOfPair>,
        table: DataTable,
    ) {
        if !pairs.is_empty() {
            self.blocks.push(Block::Table(table));
            self.results.choices.push(Choices { response: asked.id.clone(), by, pairs });
        }
    }
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
