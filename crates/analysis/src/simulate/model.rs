//! The parameters made ready for drawing: every question with its way of being answered.

use std::collections::{BTreeMap, HashMap};

use mimique_stats::normal_quantile_upper;
use mimique_study::{Choice, Clip, KindOfQuestion as _, Question, Scale, Simulated, Study};

use super::latent::{ClipEffects, Latent, Spread};
use super::parameters::Parameters;
use super::scales::{segment_places, traits};

/// A study and its parameters, ready for drawing.
#[derive(Debug, Clone)]
pub(crate) struct Model<'s> {
    pub study: &'s Study,
    pub parameters: &'s Parameters,
    /// Every clip, in the study's order.
    pub clips: Vec<Clip>,
    /// Segment of each clip.
    pub segments: Vec<usize>,
    clip_places: HashMap<String, usize>,
    /// Every question of the file.
    pub questions: Vec<Asked<'s>>,
    question_places: HashMap<String, usize>,
    latents: Vec<Latent>,
}

/// A question and how it is answered.
#[derive(Debug, Clone)]
pub(crate) struct Asked<'s> {
    pub question: &'s Question,
    pub way: Way,
    /// Of a rating of confidence.
    pub confidence: Option<Confidence>,
}

/// What a rating of confidence follows.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Confidence {
    /// Place of the choice among the questions.
    pub choice: usize,
    /// How much higher it is after a right answer than after a wrong one, points.
    pub rise: f64,
}

/// How a question is answered.
#[derive(Debug, Clone)]
pub(crate) enum Way {
    /// One value of each scale: one, or two of a grid.
    Scales(Vec<Rated>),
    /// A choice that is right or wrong.
    Recognised(Recognised),
    /// One of several, by weights.
    One(Vec<f64>),
    /// Any of several, each with its own probability.
    Several { weights: Vec<f64>, fewest: usize, most: usize },
    /// A typed number.
    Number { mean: f64, sd: f64, low: f64, high: f64, whole: bool },
    /// Which of two clips, by their worths.
    Compared(Between),
    /// As the kind of question draws it; a weight for each option.
    Drawn { weights: Vec<f64> },
}

/// A scale and its latent value.
#[derive(Debug, Clone)]
pub(crate) struct Rated {
    /// Place among the latent values; none for a question that is not asked in trials.
    pub latent: usize,
    pub mean: f64,
    pub scale: Scale,
    pub borders: Vec<f64>,
    pub noise_sd: f64,
    pub per_trial: f64,
}

/// A choice that is right or wrong.
#[derive(Debug, Clone)]
pub(crate) struct Recognised {
    pub latent: usize,
    pub options: usize,
    /// A clip each: the right option, the latent value above which it is chosen, the weights of the
    /// wrong ones. None for a clip whose right answer is no option.
    pub clips: Vec<Option<Row>>,
}

/// How somebody chooses between two clips.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Between {
    /// Place of the worths among the latent values.
    pub latent: usize,
    pub side: f64,
    /// None where "no difference" is no answer.
    pub tie: Option<f64>,
    pub lapse: f64,
}

/// The answers to one clip.
#[derive(Debug, Clone)]
pub(crate) struct Row {
    pub right: usize,
    pub threshold: f64,
    pub wrong: Vec<f64>,
}

impl<'s> Model<'s> {
    /// Makes everything ready for these clips. The parameters must fit the study
    /// ([`Parameters::check`]).
    pub(crate) fn new(study: &'s Study, parameters: &'s Parameters, clips: Vec<Clip>) -> Self {
        let segments = segment_places(&clips);
        let clip_places =
            clips.iter().enumerate().map(|(place, clip)| (clip.id.clone(), place)).collect();
        let mut model = Self {
            study,
            parameters,
            segments,
            clip_places,
            questions: Vec::new(),
            question_places: HashMap::new(),
            latents: Vec::new(),
            clips,
        };
        for question in study.all_questions() {
            let way = model.way(question);
            model.question_places.insert(question.id.clone(), model.questions.len());
            model.questions.push(Asked { question, way, confidence: None });
        }
        for choice in 0..model.questions.len() {
            let question = model.questions[choice].question;
            let rating = question.kind.confidence().and_then(|rating| model.question(rating));
            let rise = parameters.recognition.get(&question.id).map(|own| own.confidence);
            let (Some(rating), Some(rise)) = (rating, rise) else { continue };
            if let Way::Scales(rated) = &model.questions[rating].way
                && let [one] = rated.as_slice()
            {
                let rise = rise * one.noise_sd;
                model.questions[rating].confidence = Some(Confidence { choice, rise });
            }
        }
        model
    }

    /// Place of a clip.
    pub(crate) fn clip(&self, id: &str) -> Option<usize> {
        self.clip_places.get(id).copied()
    }

    /// Place of a question.
    pub(crate) fn question(&self, id: &str) -> Option<usize> {
        self.question_places.get(id).copied()
    }

    /// The latent values.
    pub(crate) fn latents(&self) -> &[Latent] {
        &self.latents
    }

    /// What each clip adds in the study of this seed.
    pub(crate) fn clip_effects(&self, seed: u64) -> ClipEffects {
        self.latents.iter().map(|latent| latent.clip_effects(seed, &self.segments)).collect()
    }

    fn add(&mut self, latent: Latent) -> usize {
        self.latents.push(latent);
        self.latents.len() - 1
    }

    fn way(&mut self, question: &Question) -> Way {
        let about = traits(self.study);
        let is_trait = |factor: &str| about.contains_key(factor);
        let weights = |options: &[Choice]| -> Vec<f64> {
            let shares = self.parameters.choices.get(&question.id);
            options
                .iter()
                .map(|option| shares.map_or(1.0, |s| s.get(&option.value).copied().unwrap_or(0.0)))
                .collect()
        };
        match question.kind.simulated() {
            Simulated::Rated => Way::Scales(self.rated(question, &is_trait)),
            Simulated::OneOption => self
                .recognised(question, &is_trait)
                .map_or_else(|| Way::One(weights(question.kind.options())), Way::Recognised),
            Simulated::SeveralOptions { fewest, most } => Way::Several {
                weights: weights(question.kind.options()),
                fewest: fewest.unwrap_or(usize::from(question.required)),
                most,
            },
            Simulated::Number(field) => {
                let number = self.parameters.numbers.get(&question.id);
                Way::Number {
                    mean: number.map_or(0.0, |number| number.mean),
                    sd: number.map_or(0.0, |number| number.sd),
                    low: field.minimum.unwrap_or(f64::NEG_INFINITY),
                    high: field.maximum.unwrap_or(f64::INFINITY),
                    whole: field.integer,
                }
            }
            Simulated::Compared { same } => Way::Compared(self.between(question, same)),
            Simulated::Drawn { .. } => Way::Drawn { weights: weights(question.kind.options()) },
        }
    }

    /// A latent value for each scale of a question.
    fn rated(&mut self, question: &Question, is_trait: &dyn Fn(&str) -> bool) -> Vec<Rated> {
        let Some(scale) = question.kind.scale() else { return Vec::new() };
        let rated = question.response_ids().into_iter().filter_map(|response| {
            let rating = self.parameters.ratings.get(&response)?;
            let latent = Latent::new(&response, &rating.into(), &self.clips, is_trait);
            let borders = match rating.thresholds.as_slice() {
                [] => scale.borders(),
                given => given.to_vec(),
            };
            Some(Rated {
                latent: self.add(latent),
                mean: rating.mean,
                scale,
                borders,
                noise_sd: rating.noise_sd,
                per_trial: rating.per_trial,
            })
        });
        rated.collect()
    }

    /// The worths of a choice between two clips.
    fn between(&mut self, question: &Question, same: bool) -> Between {
        let Some(compared) = self.parameters.comparisons.get(&question.id) else {
            let latent =
                self.add(Latent::new(&question.id, &Spread::none(), &self.clips, |_| false));
            return Between { latent, side: 0.0, tie: same.then_some(0.0), lapse: 0.0 };
        };
        let effects = BTreeMap::from([(compared.factor.clone(), compared.worth.clone())]);
        let person_by_sd = BTreeMap::from([(compared.factor.clone(), compared.person_sd)]);
        let spread = Spread {
            person_by_sd: &person_by_sd,
            clip_sd: compared.segment_sd,
            effects: &effects,
            ..Spread::none()
        };
        let latent = self.add(Latent::new(&question.id, &spread, &self.clips, |_| false));
        let tie = same.then_some(compared.tie);
        Between { latent, side: compared.side, tie, lapse: compared.lapse }
    }

    /// What is recognised in each clip, where a question has a right answer.
    fn recognised(
        &mut self,
        question: &Question,
        is_trait: &dyn Fn(&str) -> bool,
    ) -> Option<Recognised> {
        let truth = question.kind.truth()?;
        let recognition = self.parameters.recognition.get(&question.id)?;
        let options = question.kind.options();
        let latent = Latent::new(&question.id, &recognition.into(), &self.clips, is_trait);
        let sd = (1.0 + latent.spread_sd().powi(2)).sqrt();
        let row = |clip: &Clip| {
            let right = clip.factor_text(truth)?;
            let place = options.iter().position(|option| option.value == right)?;
            let rows = recognition.confusion.get(&right)?;
            let level = clip.factor_text(&recognition.by).unwrap_or_default();
            let row = rows.get(&level).or_else(|| rows.get("*"))?;
            let share = |option: &Choice| row.get(&option.value).copied().unwrap_or(0.0);
            let mut wrong: Vec<f64> = options.iter().map(share).collect();
            let sum: f64 = wrong.iter().sum();
            // A share of 0 or 1 is a threshold that no value reaches.
            let hit = (wrong[place] / sum).clamp(1e-12, 1.0 - 1e-12);
            wrong[place] = 0.0;
            if wrong.iter().all(|weight| *weight == 0.0) {
                wrong.fill(1.0);
                wrong[place] = 0.0;
            }
            Some(Row { right: place, threshold: sd * normal_quantile_upper(hit), wrong })
        };
        let clips = self.clips.iter().map(row).collect();
        Some(Recognised { latent: self.add(latent), options: options.len(), clips })
    }
}
