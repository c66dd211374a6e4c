//! From state to screen: device gate, calibration, practice, clocks, and how a session ended.

use serde_json::Value;

use super::clock;
use super::gate::{self, CARD_HEIGHT_MM, CARD_WIDTH_MM, DISTANCES_CM};
use super::render::Screen;
use super::view::{ClockView, StageSize};
use super::view_gate::{
    CalibrationView, CardView, DeviceView, DistanceView, FeedbackItem, FeedbackView, ScriptedView,
};
use crate::plan::Step;
use crate::record::EndReason;
use crate::standing::Standing;
use mimique_study::alike;
use mimique_study::{Calibration, FullscreenRule, KindOfQuestion as _, Question};

/// Width at which the picture of the card stands before it is adjusted: that of a card on a display
/// of 96 CSS pixels an inch.
const CARD_START_PX: f64 = 323.5;

impl Screen<'_> {
    pub(super) fn device(&self, step: &Step) -> DeviceView {
        let words = self.words;
        let unmet = gate::device_problems(self.plan, self.state);
        let measuring = unmet.is_none();
        let rule = gate::fullscreen_rule(&self.plan.study);
        let fullscreen = rule != FullscreenRule::No && !self.state.record.fullscreen;
        let problems: Vec<(String, String)> =
            unmet.unwrap_or_default().iter().map(|each| words.unmet(each)).collect();
        let fine = problems.is_empty() && !measuring;
        let text = match (measuring, fine) {
            (true, _) => words.device_measuring(),
            (_, false) => words.device_lacks(),
            _ if fullscreen => words.device_fullscreen(),
            _ => words.device_fine(),
        };
        let label = if fullscreen { words.enter_fullscreen() } else { words.next() };
        let lacking = |text: &str| (!measuring && !fine).then(|| text.to_owned());
        DeviceView {
            step: step.id.clone(),
            heading: words.device_heading().to_owned(),
            text: text.to_owned(),
            measuring,
            problems,
            button: self.button(label),
            without: (fine && fullscreen && rule == FullscreenRule::Asked)
                .then(|| words.without_fullscreen().to_owned()),
            again: lacking(words.device_again()),
            give_up: lacking(words.device_give_up()),
            progress: self.progress(),
        }
    }

    pub(super) fn calibration(&self, step: &Step, rules: &Calibration) -> CalibrationView {
        let (words, live) = (self.words, &self.state.live);
        let mut text = rules.text.as_ref().map_or_else(Vec::new, |text| self.paragraphs(text));
        text.extend(rules.distance_cm.map(|cm| words.distance_stated(cm)));
        let px_per_mm = live.calibration.px_per_mm;
        let card = rules.card.then(|| {
            let width_px = px_per_mm.map_or(CARD_START_PX, |px| px * CARD_WIDTH_MM);
            let missing = live.show_problems && px_per_mm.is_none() && !live.no_card;
            CardView {
                instruction: words.card_instruction().to_owned(),
                label: words.card_label().to_owned(),
                steps: (words.card_smaller().to_owned(), words.card_larger().to_owned()),
                width_px,
                height_px: width_px / CARD_WIDTH_MM * CARD_HEIGHT_MM,
                set: px_per_mm.is_some(),
                no_card: (!rules.required).then(|| (words.no_card().to_owned(), live.no_card)),
                problem: missing.then(|| words.card_missing().to_owned()),
            }
        });
        let distance = rules.ask_distance.then(|| {
            let value = live.calibration.distance_cm;
            let wrong = value.map_or(rules.required, |cm| !DISTANCES_CM.contains(&cm));
            DistanceView {
                label: words.distance_label().to_owned(),
                unit: "cm".to_owned(),
                value,
                problem: (live.show_problems && wrong).then(|| words.distance_problem().to_owned()),
            }
        });
        let set = card.as_ref().is_some_and(|card| card.set);
        CalibrationView {
            step: step.id.clone(),
            heading: words.calibration_heading().to_owned(),
            text,
            card,
            distance,
            button: self.button(if set { words.calibrated() } else { words.next() }),
            progress: self.progress(),
        }
    }

    pub(super) fn feedback(&self, step: &Step, of: usize) -> FeedbackView {
        let (words, record) = (self.words, &self.state.record);
        let trial = self.plan.step(of).and_then(Step::trial);
        let mut items = Vec::new();
        let mut correct = true;
        for question in trial.iter().flat_map(|trial| &trial.questions) {
            let Some(right) = trial.and_then(|trial| trial.right.get(&question.id)) else {
                continue;
            };
            let given = record.practised.get(&question.id);
            let is_right = given.is_some_and(|given| alike(given, right));
            correct &= is_right;
            let given = given.map(|given| self.answer_text(question, given));
            items.push(FeedbackItem {
                prompt: self.text(&question.prompt),
                given: words.feedback_given(given.as_deref()),
                right: (!is_right)
                    .then(|| words.feedback_answer(&self.answer_text(question, right))),
            });
        }
        let heading = if correct { words.feedback_right() } else { words.feedback_wrong() };
        FeedbackView {
            step: step.id.clone(),
            heading: heading.to_owned(),
            correct,
            items,
            text: self.after_round(),
            button: self.button(words.next()),
            progress: self.progress(),
        }
    }

    /// What follows, if this is the last page of a round of practice.
    fn after_round(&self) -> Option<String> {
        let (plan, record) = (self.plan, &self.state.record);
        let place = plan.rounds.iter().position(|end| *end == record.step + 1)?;
        let training = plan.study.training.as_ref()?;
        let criterion = training.criterion.as_ref();
        let enough = criterion.is_none_or(|rule| record.right >= rule.correct);
        Some(if enough || place + 1 == plan.rounds.len() {
            self.words.practice_over().to_owned()
        } else {
            self.words.practise_again(record.right, training.clips.len())
        })
    }

    /// An answer as a person reads it.
    fn answer_text(&self, question: &Question, answer: &Value) -> String {
        let label = |word: &str| {
            let options = question.kind.options().iter();
            let mut known = options.filter(|option| option.value == word);
            known.next().map_or_else(|| word.to_owned(), |option| self.text(&option.label))
        };
        // A comparison is never practised: practice shows one clip.
        match answer {
            Value::String(word) => label(word),
            Value::Array(items) => {
                let words = items.iter().map(|each| each.as_str().map_or(String::new(), label));
                words.collect::<Vec<_>>().join(", ")
            }
            // Which of the options was picked as best, and which as worst.
            Value::Object(picks)
                if question.kind.rows().is_empty() && picks.values().all(Value::is_string) =>
            {
                let words = picks.values().filter_map(Value::as_str).map(label);
                words.collect::<Vec<_>>().join(", ")
            }
            other => other.to_string(),
        }
    }

    /// What the pages say of sound.
    pub(super) fn sound_word(&self, name: &str) -> &str {
        self.plan.study.sound_word(&self.state.record.language, name)
    }

    pub(super) fn sound(&self, step: &Step) -> ScriptedView {
        let text = ["sound_note", "sound_text"].map(|name| self.sound_word(name).to_owned());
        ScriptedView {
            step: step.id.clone(),
            heading: self.sound_word("sound_heading").to_owned(),
            text: text.into_iter().filter(|text| !text.is_empty()).collect(),
            pages: self.plan.study.sound.to_string(),
            progress: self.progress(),
        }
    }

    pub(super) fn mimicry(&self, step: &Step) -> ScriptedView {
        let word = |name| self.plan.study.mimicry_word(&self.state.record.language, name);
        ScriptedView {
            step: step.id.clone(),
            heading: word("mimicry_heading").to_owned(),
            text: word("mimicry_text").split("\n\n").map(str::to_owned).collect(),
            pages: self.plan.study.mimicry.to_string(),
            progress: self.progress(),
        }
    }

    pub(super) fn clock(&self, step: &Step) -> Option<ClockView> {
        let limit = step.time_limit.as_ref()?;
        let words = self.words;
        let essential = limit.essential.as_ref().map(|text| self.text(text));
        if clock::begins_later(step, self.state) {
            let mut text = words.time_limit(limit.seconds);
            if let Some(why) = essential {
                text = format!("{text} {why}");
            }
            return Some(ClockView { text, warning: None, extend: None });
        }
        let clock = clock::clock(self.plan, self.state)?;
        let extendable = clock.extensions > 0;
        // A clock that counts from far away needs no button yet.
        let near = clock.warns();
        let mut text = words.seconds_left(clock.left.ceil().max(0.0) as u64);
        if let Some(why) = essential.filter(|_| step.trial().is_none()) {
            text = format!("{text}. {why}");
        }
        Some(ClockView {
            text,
            warning: near.then(|| words.time_warning(extendable).to_owned()),
            extend: extendable.then(|| words.more_time().to_owned()),
        })
    }

    /// How large clips are shown: in millimetres where the study says so and the participant has
    /// calibrated the screen.
    pub(super) fn stage_size(&self) -> StageSize {
        let look = &self.plan.study.look;
        let calibrated = self.state.record.calibrated.as_ref();
        let px_per_mm = calibrated.and_then(|it| it.px_per_mm);
        match (look.width_mm, look.height_mm, px_per_mm) {
            (Some(width), Some(height), Some(px)) => StageSize {
                width: width * px,
                height: height * px,
                device_pixel_ratio: calibrated.map(|it| it.device_pixel_ratio),
            },
            _ => StageSize {
                width: f64::from(look.width),
                height: f64::from(look.height),
                device_pixel_ratio: None,
            },
        }
    }

    /// How the session ended: word, heading, paragraphs.
    pub(super) fn outcome(&self) -> (&'static str, String, Vec<String>) {
        let (words, record) = (self.words, &self.state.record);
        let (heading, text) = match record.early_end.as_ref().map(|end| &end.reason) {
            Some(EndReason::ScreenedOut { .. }) => {
                let mut text = self.screened_out_reasons();
                text.push(words.screened_out_text().to_owned());
                (words.screened_out(), text)
            }
            Some(EndReason::ChecksFailed { failed }) => {
                (words.checks_failed(), vec![words.checks_failed_text(*failed)])
            }
            None => (words.thanks(), vec![words.thanks_text().to_owned()]),
        };
        (record.standing.export_word(), heading.to_owned(), text)
    }

    fn screened_out_reasons(&self) -> Vec<String> {
        let words = self.words;
        match self.state.record.standing {
            Standing::DeviceRefused if self.state.record.was_too_slow() => {
                vec![words.screened_out_frames().to_owned()]
            }
            Standing::DeviceRefused => gate::device_problems(self.plan, self.state)
                .unwrap_or_default()
                .iter()
                .map(|each| words.unmet(each).0)
                .collect(),
            Standing::ScreenedOut if self.state.record.did_not_hear() => {
                vec![self.sound_word("sound_screened_out").to_owned()]
            }
            Standing::ScreenedOut => gate::screening(&self.plan.study, self.state)
                .map_or_else(Vec::new, |rule| self.paragraphs(&rule.reason)),
            Standing::PracticeFailed => vec![words.screened_out_training().to_owned()],
            _ => Vec::new(),
        }
    }
}
