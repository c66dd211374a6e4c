//! Why one of two clips was chosen: how often each reason was given, by the level that was chosen.

use std::collections::HashMap;

use mimique_report::document::{Block, DataTable, slug};
use mimique_stats::Chosen;
use mimique_study::KindOfQuestion as _;

use crate::choices::answers;
use crate::report::section::Writer;
use crate::trials::asked_question::AskedQuestion;

impl Writer<'_> {
    /// Reasons of the blocks of pairs that ask this question, where they are options: an answer may have several.
    pub(crate) fn reasons(&mut self, asked: &AskedQuestion<'_>) {
        let language = self.language();
        let clips = self.study.clips();
        let blocks: Vec<_> =
            self.study.pair_blocks().filter(|(_, block)| block.question == asked.id).collect();
        for (name, block) in blocks {
            let Some(place) = self.export.factors.iter().position(|own| *own == block.compare)
            else {
                continue;
            };
            let wanted = block.reasons.as_ref();
            let question = self.study.questions.iter().find(|own| Some(&own.id) == wanted);
            let Some(question) = question.filter(|own| !own.kind.options().is_empty()) else {
                continue;
            };
            let given: HashMap<usize, &str> = self
                .export
                .answers_to(&question.id)
                .iter()
                .map(|answer| (answer.trial, &*answer.text))
                .collect();
            let levels = block.compared(&clips);
            let options = question.kind.options();
            // A row for each level, and one for no difference.
            let mut counts = vec![vec![0_u64; options.len() + 1]; levels.len() + 1];
            for answer in self.export.answers_to(&asked.id) {
                let trial = &self.export.trials[answer.trial];
                let (Some(beside), Some(chosen)) = (&trial.beside, answers::chosen(answer)) else {
                    continue;
                };
                let left_is_beside = beside.left;
                let level = match chosen {
                    Chosen::Same => None,
                    Chosen::Left if left_is_beside => beside.levels[place].as_deref(),
                    Chosen::Right if !left_is_beside => beside.levels[place].as_deref(),
                    Chosen::Left | Chosen::Right => trial.levels[place].as_deref(),
                };
                let row = levels.iter().position(|own| Some(own.as_str()) == level);
                let Some(reasons) = given.get(&answer.trial) else { continue };
                let row = &mut counts[row.unwrap_or(levels.len())];
                row[options.len()] += 1;
                // The export joins several choices by |.
                for reason in reasons.split('|') {
                    if let Some(column) = options.iter().position(|own| own.value == reason) {
                        row[column] += 1;
                    }
                }
            }
            let (label, code) = (asked.label(language.code()), language.code());
            let caption = language.pick(
                format!("{label}: reasons, by what was chosen (block {name}); an answer may have several"),
                format!("{label} : raisons selon ce qui a été choisi (bloc {name}) ; une réponse peut en avoir plusieurs"),
            );
            let mut columns = vec![language.pick("chosen", "choisi").to_owned()];
            columns.extend(options.iter().map(|own| own.label.in_language(code).to_owned()));
            columns.push(
                language.pick("answers with a reason", "réponses avec une raison").to_owned(),
            );
            let id = format!("{}-reasons-{}", slug(&asked.id), slug(name));
            let mut table = DataTable::new(id, &caption, columns);
            let none = language.pick("no difference", "sans différence").to_owned();
            let names = levels.iter().map(|level| self.naming.level(&block.compare, level));
            for (name, counts) in names.chain([none]).zip(counts) {
                table.row([name].into_iter().chain(counts.iter().map(u64::to_string)));
            }
            self.blocks.push(Block::Table(table));
        }
    }
}
