//! How simulated people answer blocks of reverse correlation: by the faces that they have in mind. What a trial shows
//! is drawn as the page draws it.

use std::collections::{BTreeMap, HashMap};

use mimique_adaptive::Trajectory;
use mimique_session::wire::SessionStarted;
use mimique_study::{
    Draw, KindOfQuestion as _, Question, ReverseCorrelationComponent, Study, component_of,
};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::parameters::Parameters;
use super::random::Draws;
use super::template::{Template, TemplatePart, TemplatePeople};

/// The faces that people have in mind, for a block of reverse correlation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct FaceTemplates {
    /// Category -> the units of its face.
    pub categories: BTreeMap<String, Vec<FacePart>>,
    /// Standard deviation of the noise of each category, where a face that is met whole speaks with 1.
    pub noise: f64,
    /// What must speak for a category at least.
    pub criterion: f64,
    /// What is answered where nothing reaches the criterion; the category that most speaks for, if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub otherwise: Option<String>,
}

/// A unit of a face that people have in mind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct FacePart {
    /// The unit: `AU12`.
    pub unit: String,
    /// When it counts, seconds from the first frame; at its peak if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_seconds: Option<f64>,
}

/// Units of the six emotions (Ekman, Friesen and Hager, *FACS Investigator's Guide*, 2002, table 10-1: prototypes and
/// their most common variants), by the words that answers are called in studies.
const PROTOTYPES: [(&[&str], &[&str]); 6] = [
    (&["anger", "angry"], &["AU04", "AU05", "AU07", "AU23", "AU24"]),
    (&["disgust", "disgusted"], &["AU09", "AU15", "AU16"]),
    (&["fear", "afraid"], &["AU01", "AU02", "AU04", "AU05", "AU20", "AU26"]),
    (&["joy", "happiness", "happy"], &["AU06", "AU12"]),
    (&["sadness", "sad"], &["AU01", "AU04", "AU15"]),
    (&["surprise", "surprised"], &["AU01", "AU02", "AU05", "AU26"]),
];
/// What answers are called that stand for no category.
const OTHERWISE: [&str; 4] = ["other", "none", "neutral", "unsure"];

/// The faces that people have in mind, if nothing else is said: the prototypes of what the options are called, as far
/// as their units are drawn; where no option is called so, each has a unit of its own.
pub(super) fn defaults(study: &Study) -> BTreeMap<String, FaceTemplates> {
    let of = |(name, block): (&str, ReverseCorrelationComponent)| {
        let question = study.questions.iter().find(|each| each.id == block.question)?;
        Some((name.to_owned(), templates(question, &block.units)))
    };
    study.reverse_correlations().filter_map(of).collect()
}

fn templates(question: &Question, units: &[String]) -> FaceTemplates {
    let options = question.kind.options();
    let part = |unit: &str| FacePart { unit: unit.to_owned(), at_seconds: None };
    let prototype = |option: &str| {
        let (_, face) = PROTOTYPES.iter().find(|(words, _)| words.contains(&option))?;
        let drawn = face.iter().filter(|unit| units.iter().any(|own| own == *unit));
        let parts: Vec<FacePart> = drawn.map(|unit| part(unit)).collect();
        (!parts.is_empty()).then(|| (option.to_owned(), parts))
    };
    let values = || options.iter().map(|option| option.value.as_str());
    let otherwise = values().find(|value| OTHERWISE.contains(value));
    let mut categories: BTreeMap<String, Vec<FacePart>> = values().filter_map(prototype).collect();
    if categories.is_empty() {
        let named = values().filter(|value| Some(*value) != otherwise);
        let each = named.zip(units.iter().cycle());
        categories = each.map(|(value, unit)| (value.to_owned(), vec![part(unit)])).collect();
    }
    FaceTemplates {
        categories,
        noise: 0.15,
        criterion: 0.2,
        otherwise: otherwise.map(str::to_owned),
    }
}

impl FaceTemplates {
    /// What is wrong with it: the key, the value and what to do.
    pub(super) fn fault(
        &self,
        block: &ReverseCorrelationComponent,
        options: &[&str],
    ) -> Option<(String, String, String)> {
        let known = |category: &String| options.contains(&category.as_str());
        let named = self.categories.keys().map(|category| ("categories", category));
        let named = named.chain(self.otherwise.iter().map(|category| ("otherwise", category)));
        for (key, category) in named {
            if !known(category) {
                let remedy = format!("name one of {}", options.join(", "));
                return Some((key.to_owned(), format!("there is no option {category:?}"), remedy));
            }
        }
        if self.categories.is_empty() {
            let problem = "nobody has a face in mind".to_owned();
            return Some(("categories".to_owned(), problem, "name a category".to_owned()));
        }
        for (category, parts) in &self.categories {
            let key = format!("categories/{category}");
            if parts.is_empty() {
                let problem = "a face without units".to_owned();
                return Some((key, problem, "name its units".to_owned()));
            }
            for FacePart { unit, at_seconds } in parts {
                if !block.units.contains(unit) {
                    let remedy = format!("name one of {}", block.units.join(", "));
                    return Some((key, format!("{unit:?} is not drawn"), remedy));
                }
                let within = 0.0..=block.duration_seconds;
                if let Some(at) = at_seconds.filter(|at| !within.contains(at)) {
                    let remedy = format!("give 0 to {} s", block.duration_seconds);
                    return Some((key, format!("{at} s is no time of the clip"), remedy));
                }
            }
        }
        for (key, value) in [("noise", self.noise), ("criterion", self.criterion)] {
            if !(value >= 0.0 && value.is_finite()) {
                let problem = format!("{value} is not 0 or more");
                return Some((key.to_owned(), problem, "give a number from 0".to_owned()));
            }
        }
        None
    }
}

/// How one person sees the faces of each block.
pub(super) struct Viewer {
    blocks: HashMap<String, (ReverseCorrelationComponent, TemplatePeople)>,
    draws: Draws,
}

impl Viewer {
    /// The person of a number.
    pub(super) fn new(study: &Study, parameters: &Parameters, seed: u64, number: u64) -> Self {
        let of = |(name, block): (&str, ReverseCorrelationComponent)| {
            let given = parameters.templates.get(name)?;
            let unit = |part: &FacePart| {
                let unit = block.units.iter().position(|own| *own == part.unit)?;
                Some(TemplatePart { unit, at_s: part.at_seconds })
            };
            let template = |(category, parts): (&String, &Vec<FacePart>)| Template {
                category: category.clone(),
                parts: parts.iter().filter_map(unit).collect(),
            };
            let people = TemplatePeople {
                templates: given.categories.iter().map(template).collect(),
                noise: given.noise,
                criterion: given.criterion,
                otherwise: given.otherwise.clone(),
                seed,
            };
            Some((name.to_owned(), (block, people)))
        };
        let blocks = study.reverse_correlations().filter_map(of).collect();
        Self { blocks, draws: Draws::new(seed, Some(number), "faces") }
    }

    /// What the person answers to the trial of a step: each question with its answer, the category first. Somebody
    /// careless takes any. None of a step whose face is not drawn.
    pub(super) fn answers(
        &mut self,
        step: &str,
        questions: &[Question],
        started: &SessionStarted,
        careless: bool,
    ) -> Option<Vec<(String, Value)>> {
        let (block, people) = self.blocks.get(component_of(step))?;
        let draw = Draw {
            seed: started.seed,
            config_hash: &started.config_hash,
            participant: started.slot(),
            condition: started.condition.as_deref(),
        };
        let shown: Vec<Trajectory> = block.trajectories(step, draw).ok()?;
        let (seen, strength) = people.answer(&mut self.draws, &shown);
        let mut answers = Vec::new();
        for question in questions {
            let id = question.id.clone();
            if question.id == block.question {
                let options = question.kind.options();
                let any = options.get(self.draws.below(options.len()))?.value.as_str();
                answers.push((id, if careless { any } else { seen? }.into()));
            } else if let Some([Some(low), Some(high)]) = question.kind.bounds() {
                let share = if careless { self.draws.unit() } else { strength };
                let number = libm::round(low + (high - low) * share);
                answers.push((id, (number as i64).into()));
            }
        }
        Some(answers)
    }
}
