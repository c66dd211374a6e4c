//! One simulated person: what is answered, when, and how far the person goes.

use mimique_stats::Chosen;
use mimique_study::columns::ASSIGNED_CONDITION;
use mimique_study::{Answers, KindOfQuestion as _};
use serde_json::Value;

use super::draws::{other_than, several, whole_number};
use super::latent::{ClipEffects, told};
use super::model::{Asked, Between, Model, Rated, Recognised, Way};
use super::random::Draws;

/// One simulated person. Answers, times and what happens to the display have streams of their own, so
/// that whoever needs answers alone draws the same ones.
pub(crate) struct Person<'m> {
    mind: Mind<'m>,
    /// Answers about the participant.
    pub about: Answers,
    /// How far the person goes.
    pub fate: Fate,
    answers: Draws,
    pages: Draws,
    chance: Draws,
    times: Draws,
    display: Draws,
    pace: f64,
    slow: bool,
    /// The last choice that is right or wrong: place of its question, and which it was.
    chosen: Option<(usize, bool)>,
}

/// What a person answers by.
struct Mind<'m> {
    model: &'m Model<'m>,
    /// Whether the person answers without looking.
    careless: bool,
    /// By latent value and clip.
    values: Vec<Vec<f64>>,
}

/// How far a person goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Fate {
    /// Does not agree.
    pub declines: bool,
    /// Leaves after so many trials.
    pub leaves_after: Option<usize>,
    /// Takes the answers back when leaving.
    pub withdraws: bool,
}

/// An answer before it is written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Raw {
    /// A point of a scale, or a typed number.
    Number(f64),
    /// Place of an option.
    Option(usize),
    /// Anything else, as JSON.
    Json(Value),
}

/// What a trial shows.
#[derive(Debug, Clone, Copy)]
struct Seen {
    clip: usize,
    beside: Option<Companion>,
    /// What a rating has in common with others of its page, points.
    shift: f64,
}

/// A clip that is played in step beside the trial's own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Companion {
    /// Its place among the clips.
    pub clip: usize,
    /// Whether it stands on the left.
    pub left: bool,
}

/// How a clip is shown in one trial.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Showing {
    /// The page is opened anew before the clip is played.
    pub reload: bool,
    /// A first play is cut short.
    pub cut_short: bool,
    /// Plays after the first whole one.
    pub replays: usize,
    /// The page loses the focus.
    pub focus_loss: bool,
    /// The first whole play: a frame each, milliseconds after the onset, and whether it was late.
    pub frames: Vec<(f64, bool)>,
}

impl Showing {
    /// Number of late frames.
    pub(crate) fn late(&self) -> usize {
        self.frames.iter().filter(|(_, late)| *late).count()
    }

    /// The longest time between two frames, milliseconds.
    pub(crate) fn longest_ms(&self) -> f64 {
        self.frames.windows(2).map(|pair| pair[1].0 - pair[0].0).fold(0.0, f64::max)
    }
}

/// Pause before a clip is played again, milliseconds.
pub(crate) const BEFORE_REPLAY_MS: f64 = 500.0;

impl<'m> Person<'m> {
    /// The person of a number, in a condition where the study has some.
    pub(crate) fn new(
        model: &'m Model<'m>,
        clips: &ClipEffects,
        seed: u64,
        number: u64,
        condition: Option<&str>,
    ) -> Self {
        let draws = |purpose| Draws::new(seed, Some(number), purpose);
        let parameters = model.parameters;
        let mut person = draws("person");
        let careless = person.happens(parameters.careless.share);
        let pace = libm::exp(parameters.times.person_sigma * person.normal());
        let slow = person.happens(parameters.display.slow_people);
        let dropout = parameters.dropout;
        let declines = person.happens(dropout.declined);
        // The number of trials before the one at which somebody leaves is geometric.
        let stays = libm::log(1.0 - person.unit());
        let leaves_after = (dropout.per_trial > 0.0).then(|| {
            let each = libm::log(1.0 - dropout.per_trial.min(1.0 - 1e-12));
            (stays / each).floor().min(1e9) as usize
        });
        let withdraws = person.happens(dropout.withdrawn);
        let mut new = Self {
            mind: Mind { model, careless, values: Vec::new() },
            about: Answers::new(),
            fate: Fate { declines, leaves_after, withdraws },
            answers: draws("answers"),
            pages: draws("about"),
            chance: draws("chance"),
            times: draws("times"),
            display: draws("display"),
            pace,
            slow,
            chosen: None,
        };
        for question in model.study.demographics.iter().flat_map(|page| &page.questions) {
            if question.is_shown(&new.about, &Answers::new())
                && let Some(answer) = new.eligible_answer(&question.id)
            {
                new.about.insert(question.id.clone(), answer);
            }
        }
        new.pages = draws("pages");
        let mut known = new.about.clone();
        if let Some(condition) = condition {
            known.insert(ASSIGNED_CONDITION.to_owned(), condition.into());
        }
        let shift = |(factor, shifts): (&String, &super::ByLevel)| {
            told(&known, factor).and_then(|level| shifts.get(&level)).copied()
        };
        let slower: f64 = parameters.times.effects.iter().filter_map(shift).sum();
        new.pace *= libm::exp(slower);
        new.mind.values = model
            .latents()
            .iter()
            .zip(clips)
            .map(|(latent, clips)| latent.of_person(&mut person, clips, &known))
            .collect();
        new
    }

    /// An answer about the participant that no screening rule turns away, as recruiters look for:
    /// drawn again while one does. A study that takes nobody gets the last draw.
    fn eligible_answer(&mut self, question: &str) -> Option<Value> {
        const DRAWS: usize = 1000;
        let rules = &self.mind.model.study.screening;
        let turned_away = |answer: Option<&Value>| {
            let mut own = rules.iter().filter(|rule| rule.condition.question == question);
            own.any(|rule| rule.condition.holds(answer))
        };
        let mut answer = self.page_answer(question);
        for _ in 1..DRAWS {
            if !turned_away(answer.as_ref()) {
                break;
            }
            answer = self.page_answer(question);
        }
        answer
    }

    /// An answer on a page without a clip; none where the question is left out.
    pub(crate) fn page_answer(&mut self, question: &str) -> Option<Value> {
        let place = self.mind.model.question(question)?;
        let raw = self.mind.answer(&mut self.pages, place, None, 0)?;
        Some(as_json(&self.mind.model.questions[place], raw))
    }

    /// An answer in the trial of this number (from 0); none where the question is left out.
    pub(crate) fn trial_answer(
        &mut self,
        question: usize,
        clip: usize,
        beside: Option<Companion>,
        trial: usize,
    ) -> Option<Raw> {
        let asked = &self.mind.model.questions[question];
        let shift = asked.confidence.map_or(0.0, |sure| match self.chosen {
            Some((choice, true)) if choice == sure.choice => sure.rise / 2.0,
            Some((choice, false)) if choice == sure.choice => -sure.rise / 2.0,
            _ => 0.0,
        });
        let seen = Some(Seen { clip, beside, shift });
        let raw = self.mind.answer(&mut self.answers, question, seen, trial);
        if let (Some(Raw::Option(option)), Way::Recognised(own)) = (&raw, &asked.way) {
            self.chosen = own.clips[clip].as_ref().map(|row| (question, row.right == *option));
        }
        raw
    }

    /// The rating of a clip of a panel, moved by what its page has in common.
    pub(crate) fn panel_answer(
        &mut self,
        question: usize,
        clip: usize,
        shift: f64,
        trial: usize,
    ) -> Option<Raw> {
        let seen = Some(Seen { clip, beside: None, shift });
        self.mind.answer(&mut self.answers, question, seen, trial)
    }

    /// Time from one answer to the next, milliseconds.
    pub(crate) fn answering_ms(&mut self, clip: Option<usize>) -> f64 {
        let times = &self.mind.model.parameters.times;
        let shift: f64 = clip.map_or(0.0, |clip| {
            let clip = &self.mind.model.clips[clip];
            let of = |(factor, shifts): (&String, &super::ByLevel)| {
                clip.factor_text(factor).and_then(|level| shifts.get(&level)).copied()
            };
            times.effects.iter().filter_map(of).sum()
        });
        let share =
            if self.mind.careless { self.mind.model.parameters.careless.time_share } else { 1.0 };
        let median = times.median_ms * share * self.pace * libm::exp(shift);
        self.times.log_normal(median, times.sigma)
    }

    /// How the clip of the next trial is shown.
    pub(crate) fn showing(&mut self, most_replays: Option<u32>) -> Showing {
        let display = &self.mind.model.parameters.display;
        let draws = &mut self.display;
        let [reload, cut_short, replay, focus_loss] =
            [display.reload, display.cut_short, display.replay, display.focus_loss]
                .map(|probability| draws.happens(probability));
        let replays = usize::from(replay && most_replays != Some(0));
        let period = 1000.0 / display.refresh_hz;
        let late_share = if self.slow { display.slow_late_share } else { display.late_share };
        let mut frames = Vec::new();
        let mut shown_ms = 0.0;
        while shown_ms <= self.mind.model.parameters.times.clip_ms {
            let late = !frames.is_empty() && draws.happens(late_share);
            // A late frame misses its place and takes the next one.
            shown_ms += if late { period } else { 0.0 };
            frames.push((shown_ms, late));
            shown_ms += period;
        }
        Showing { reload, cut_short, replays, focus_loss, frames }
    }

    /// Whether the person answers without looking.
    pub(crate) fn is_careless(&self) -> bool {
        self.mind.careless
    }

    /// A draw for what decides nothing: window, browser, reading times.
    pub(crate) fn chance(&mut self) -> &mut Draws {
        &mut self.chance
    }
}

impl Mind<'_> {
    fn answer(
        &self,
        draws: &mut Draws,
        question: usize,
        seen: Option<Seen>,
        trial: usize,
    ) -> Option<Raw> {
        let clip = seen.map(|seen| seen.clip);
        let asked = &self.model.questions[question];
        if let Some(check) = &asked.question.attention_check {
            return self.answer_to_check(draws, asked, &check.expected);
        }
        // Most people answer what they need not answer.
        if !asked.question.required && !draws.happens(0.8) {
            return None;
        }
        Some(match &asked.way {
            Way::Scales(rated) => match rated.as_slice() {
                [one] => Raw::Number(self.rate(draws, one, seen, trial)),
                several => {
                    let values: Vec<f64> =
                        several.iter().map(|one| self.rate(draws, one, seen, trial)).collect();
                    let parts = asked.question.kind.parts().unwrap_or_default();
                    let parts = parts.into_iter().map(str::to_owned);
                    let values = values.into_iter().map(|value| (value as i64).into());
                    Raw::Json(Value::Object(parts.zip(values).collect()))
                }
            },
            Way::Recognised(recognised) => Raw::Option(self.recognise(draws, recognised, clip)),
            Way::One(weights) => Raw::Option(draws.weighted(weights)),
            Way::Several { weights, fewest, most } => {
                let options = asked.question.kind.options();
                let chosen = several(draws, weights, *fewest, *most);
                Raw::Json(chosen.into_iter().map(|place| options[place].value.as_str()).collect())
            }
            Way::Number { mean, sd, low, high, whole } => {
                let value = (mean + sd * draws.normal()).clamp(*low, *high);
                Raw::Number(if *whole {
                    whole_number(value, *low, *high)
                } else {
                    (value * 100.0).round() / 100.0
                })
            }
            Way::Compared(between) => Raw::Json(self.choose(draws, between, seen).into()),
            Way::Drawn { weights } => Raw::Json(asked.question.kind.drawn(weights, draws)),
        })
    }

    fn answer_to_check(
        &self,
        draws: &mut Draws,
        asked: &Asked<'_>,
        expected: &Value,
    ) -> Option<Raw> {
        let parameters = self.model.parameters;
        let pass = match self.careless {
            true => parameters.careless.attention_pass,
            false => parameters.attention_pass,
        };
        if draws.happens(pass) {
            return Some(Raw::Json(expected.clone()));
        }
        other_than(asked, expected, draws)
    }

    /// Which of two clips: left, same or right.
    fn choose(&self, draws: &mut Draws, between: &Between, seen: Option<Seen>) -> &'static str {
        let beside = seen.and_then(|seen| Some((seen.clip, seen.beside?)));
        let looks = !draws.happens(between.lapse) && !self.careless;
        let [left, right] = match beside {
            Some((clip, beside)) if looks => {
                let worth = |clip: usize| self.values[between.latent][clip];
                let (own, other) = (worth(clip), worth(beside.clip));
                if beside.left { [other, own] } else { [own, other] }
            }
            _ => [0.0; 2],
        };
        let (side, tie) =
            if looks { (between.side, between.tie) } else { (0.0, between.tie.map(|_| 0.0)) };
        let same = tie.map_or(0.0, |tie| libm::exp(tie + (left + right) / 2.0));
        let weights = [libm::exp(left + side / 2.0), same, libm::exp(right - side / 2.0)];
        Chosen::ALL[draws.weighted(&weights)].word()
    }

    /// The place of the option that is taken for what a clip shows.
    fn recognise(&self, draws: &mut Draws, recognised: &Recognised, clip: Option<usize>) -> usize {
        let row = clip.and_then(|clip| Some((clip, recognised.clips[clip].as_ref()?)));
        match row {
            Some((clip, row)) if !self.careless => {
                let value = self.values[recognised.latent][clip] + draws.normal();
                if value > row.threshold { row.right } else { draws.weighted(&row.wrong) }
            }
            _ => draws.below(recognised.options),
        }
    }

    fn rate(&self, draws: &mut Draws, rated: &Rated, seen: Option<Seen>, trial: usize) -> f64 {
        if self.careless {
            return rated.scale.value(draws.below(rated.scale.points.max(1)));
        }
        let value = seen.map_or(rated.mean, |seen| {
            self.values[rated.latent][seen.clip] + seen.shift + rated.per_trial * trial as f64
        });
        let value = value + rated.noise_sd * draws.normal();
        rated.scale.value(rated.borders.partition_point(|border| *border <= value))
    }
}

/// An answer as the page sends it.
pub(crate) fn as_json(asked: &Asked<'_>, raw: Raw) -> Value {
    match raw {
        Raw::Json(value) => value,
        Raw::Option(place) => asked.question.kind.options()[place].value.as_str().into(),
        Raw::Number(value) if value.fract() == 0.0 && value.abs() < 9e15 => (value as i64).into(),
        Raw::Number(value) => value.into(),
    }
}
