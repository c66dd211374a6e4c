//! Response times and late frames.

use mimique_locale::Language;
use mimique_report::document::{Block, DataTable};
use mimique_stats::Factor;
use mimique_study::Measure as What;

use crate::hypothesis::comparison::within;
use crate::hypothesis::reading;
use crate::report::figure;
use crate::report::figure::people;
use crate::report::results::LateFrames;
use crate::report::section::Writer;
use crate::report::section::measures::values_by_level;
use crate::trials::export::Export;
use crate::trials::measure::{Measure, MeasureKind};

impl Writer<'_> {
    /// Response times and late frames.
    pub(crate) fn timing(&mut self) {
        let language = self.language();
        let asked = self.export.questions(self.study);
        let Some(first) = self.factors.first().cloned() else { return };
        self.heading(2, "Timing", "Temps");
        if let Some(asked) = asked.first()
            && let Some(measure) = Measure::response_time(self.export, asked, language)
            && self.of_pair(asked, What::Rt, &first).is_none()
        {
            let factor = measure.factor(self.export, &first, &[]);
            let (matched, codes) = measure.matched(self.export, &factor);
            let rows: Vec<(String, Vec<f64>)> = values_by_level(&matched, &codes)
                .into_iter()
                .map(|(level, values)| (self.naming.level(&first, &level), values))
                .collect();
            let caption = language.pick(
                format!("Time from the first frame to the last answer to “{}”: median, quartiles, 5th and 95th percentile", asked.label("en")),
                format!("Temps de la première image à la dernière réponse à « {} » : médiane, quartiles, 5e et 95e centiles", asked.label("fr")),
            );
            let unit = language.pick("seconds", "secondes");
            if factor.levels.len() > 1 && measure.kind == MeasureKind::ResponseTime {
                let result = within(self.export, &measure, &factor);
                let words = reading::comparison(&self.naming, &result, &measure.label);
                let unmatched = reading::unmatched(&self.naming, &result.matching);
                self.blocks.extend(unmatched.map(Block::Paragraph));
                self.blocks.push(Block::Reading(words));
                self.results.comparisons.push(result);
            }
            self.figure(figure::boxes(language, "response-times", &caption, unit, &rows));
        }
        self.late_frames(&first);
    }

    fn late_frames(&mut self, name: &str) {
        let language = self.language();
        let Some(place) = self.export.factors.iter().position(|factor| factor == name) else {
            return;
        };
        let cells = self.export.trials.iter().map(|trial| trial.levels[place].as_deref());
        let factor = Factor::from_cells(name, cells, |level| level.parse().ok());
        let caption = language.pick(
            format!("Frames that came late, by {}", self.naming.factor(name)),
            format!("Images en retard, par {}", self.naming.factor(name)),
        );
        let mut table = DataTable::new("late-frames", caption, late_frames_columns(language));
        for (code, level) in factor.levels.iter().enumerate() {
            let result = late_frames_of(self.export, &factor, code);
            let share = if result.frames > 0.0 {
                format!("{} %", language.fixed(result.late / result.frames * 100.0, 2))
            } else {
                "–".to_owned()
            };
            table.row([
                self.naming.level(name, level),
                result.trials.to_string(),
                format!("{:.0}", result.frames),
                format!("{:.0}", result.late),
                share,
                result.trials_with_late_frames.to_string(),
                result.longest_ms.map_or_else(|| "–".to_owned(), |ms| language.fixed(ms, 1)),
            ]);
            self.results.late_frames.push(result);
        }
        self.folded_table(table);
        self.late_shares(&factor);
    }

    /// Trials by their share of late frames.
    fn late_shares(&mut self, factor: &Factor) {
        let (language, name) = (self.language(), factor.name.as_str());
        let rows: Vec<(String, Vec<f64>)> = factor
            .levels
            .iter()
            .enumerate()
            .map(|(code, level)| {
                let own = self.export.trials.iter().zip(&factor.codes);
                let own = own.filter(|(_, own)| **own as usize == code).map(|(trial, _)| trial);
                let shares = own.filter_map(|trial| Some((trial.late?, trial.frames?)));
                let shares = shares.filter(|(_, frames)| *frames > 0.0);
                (self.naming.level(name, level), shares.map(|(late, all)| late / all).collect())
            })
            .filter(|(_, shares): &(String, Vec<f64>)| !shares.is_empty())
            .collect();
        if !rows.is_empty() {
            let caption = language.pick(
                format!("Trials by their share of late frames, by {}", self.naming.factor(name)),
                format!(
                    "Essais selon leur part d’images en retard, par {}",
                    self.naming.factor(name)
                ),
            );
            let drawing = people::late_frames(language, "late-frames-share", &caption, &rows);
            self.figure(drawing);
        }
    }
}

fn late_frames_columns(language: Language) -> [&'static str; 7] {
    language.pick(
        [
            "",
            "trials",
            "frames",
            "late frames",
            "share",
            "trials with late frames",
            "longest frame (ms)",
        ],
        [
            "",
            "essais",
            "images",
            "en retard",
            "part",
            "essais avec retard",
            "image la plus longue (ms)",
        ],
    )
}

/// Frames of the trials at a level.
fn late_frames_of(export: &Export, factor: &Factor, code: usize) -> LateFrames {
    let trials = || {
        let own = export.trials.iter().zip(&factor.codes);
        own.filter(|(trial, own)| **own as usize == code && trial.frames.is_some())
            .map(|(trial, _)| trial)
    };
    LateFrames {
        level: factor.levels[code].clone(),
        trials: trials().count(),
        frames: trials().filter_map(|trial| trial.frames).sum(),
        late: trials().filter_map(|trial| trial.late).sum(),
        trials_with_late_frames: trials().filter(|trial| trial.late > Some(0.0)).count(),
        longest_ms: trials().filter_map(|trial| trial.longest_ms).reduce(f64::max),
    }
}
