//! A person who has faces in mind: a template for each category, which dynamic reverse correlation must recover.
//!
//! What is shown speaks for a category by the mean activation of its template's parts, each a unit at a time (or at
//! its peak). Normal noise is added to each, the largest sum is answered where it reaches the criterion, and what stands
//! for nothing else where none does. The intensity is in proportion to the largest sum. It is a model of decisions by signal
//! detection, with one normal channel per category.

use mimique_adaptive::Trajectory;

use super::Draws;

/// A part of a template.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TemplatePart {
    /// Place of the unit among those that are drawn from.
    pub unit: usize,
    /// When it counts, seconds; at its peak if not given.
    pub at_s: Option<f64>,
}

/// The face that people have in mind for a category.
#[derive(Debug, Clone, PartialEq)]
pub struct Template {
    /// The category.
    pub category: String,
    /// Its parts; each counts alike.
    pub parts: Vec<TemplatePart>,
}

/// People who answer by templates.
#[derive(Debug, Clone, PartialEq)]
pub struct TemplatePeople {
    /// A template for each category.
    pub templates: Vec<Template>,
    /// Standard deviation of the noise of each category.
    pub noise: f64,
    /// What the largest sum must reach.
    pub criterion: f64,
    /// What is answered where it does not; the category of the largest sum all the same, if there is nothing else.
    pub otherwise: Option<String>,
    /// Seed of their noise.
    pub seed: u64,
}

impl Template {
    /// Mean activation of the template's parts in what is shown, 0 to 1.
    fn met(&self, shown: &[Trajectory]) -> f64 {
        let part = |part: &TemplatePart| {
            let course = shown.iter().find(|course| course.unit == part.unit);
            course.map_or(0.0, |course| course.at(part.at_s.unwrap_or(course.peak_s)))
        };
        self.parts.iter().map(part).sum::<f64>() / self.parts.len().max(1) as f64
    }
}

impl TemplatePeople {
    /// What a person (from 1) answers to the trials: category, and intensity from 0 to 1.
    pub fn answers<'t>(&'t self, person: u64, trials: &[Vec<Trajectory>]) -> Vec<(&'t str, f64)> {
        let mut draws = Draws::new(self.seed, Some(person), "templates");
        let mut one = |shown: &Vec<Trajectory>| {
            let (category, sum) = self.answer(&mut draws, shown);
            (category.unwrap_or_default(), sum)
        };
        trials.iter().map(&mut one).collect()
    }

    /// What is answered to one trial: category, and intensity from 0 to 1. No category where nobody has a face in mind.
    pub(super) fn answer<'t>(
        &'t self,
        draws: &mut Draws,
        shown: &[Trajectory],
    ) -> (Option<&'t str>, f64) {
        let mut largest = (f64::NEG_INFINITY, None);
        for template in &self.templates {
            let sum = template.met(shown) + self.noise * draws.normal();
            if sum > largest.0 {
                largest = (sum, Some(template.category.as_str()));
            }
        }
        let (sum, category) = largest;
        let otherwise = self.otherwise.as_deref().filter(|_| sum < self.criterion);
        (otherwise.or(category), sum.clamp(0.0, 1.0))
    }
}
