//! A series as people read it: courses with their units for figures, a row a second as CSV.

use std::fmt::Write as _;

use serde::Serialize;

use crate::chain::Series;
use crate::expression::Expression;
use crate::person::Person;
use crate::rules::{Curves, Features};

/// Something that is drawn over the seconds of a series.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Course {
    /// The heart rate.
    HeartRate,
    /// Breaths.
    Breaths,
    /// Work of the last second, and power.
    Work,
    /// Oxygen that will be owed after exercise.
    Epoc,
    /// The four curves.
    Face,
}

impl Course {
    /// All of them, in the order in which they are drawn.
    pub const ALL: [Self; 5] = [Self::HeartRate, Self::Breaths, Self::Work, Self::Epoc, Self::Face];
    /// Those of a figure that stands alone.
    pub const PLOTTED: [Self; 3] = [Self::HeartRate, Self::Epoc, Self::Face];

    /// What it is, with its unit.
    pub fn label(self) -> &'static str {
        match self {
            Self::HeartRate => "beats per minute",
            Self::Breaths => "breaths per minute",
            Self::Work => "work, J/kg in a second",
            Self::Epoc => "EPOC, ml/kg",
            Self::Face => "face, %",
        }
    }
}

impl Series {
    /// The curves of every second.
    pub fn curves(&self, person: &Person, expression: &Expression) -> Vec<Curves> {
        let states: Vec<Features> = (0..self.seconds())
            .map(|second| Features {
                w: self.w[second],
                p: self.p[second],
                rcn: self.rcn[second],
                epoc: self.metabolism.epoc[second],
            })
            .collect();
        expression.curves(&states, person.spec().level)
    }

    /// The lines of a course, a value a second: the name of each, empty where there is one alone.
    pub fn lines(&self, course: Course, curves: &[Curves]) -> Vec<(&'static str, Vec<f64>)> {
        let alone = |values: &[f64]| vec![("", values.to_vec())];
        match course {
            Course::HeartRate => alone(&self.heart_rate),
            Course::Breaths => alone(&self.metabolism.breaths),
            Course::Work => vec![("work", self.w.clone()), ("power, W/kg", self.p.clone())],
            Course::Epoc => alone(&self.metabolism.epoc),
            Course::Face => {
                let words = ["open", "stretched", "eyes", "brows"];
                let line = |k: usize| curves.iter().map(|own| own.to_array()[k]).collect();
                (0..words.len()).map(|k| (words[k], line(k))).collect()
            }
        }
    }

    /// As CSV, a row a second: `t,w,p,rcn,hr,vo2,breaths,kcal,epoc,fatigue,flush,sweat,borg`.
    pub fn to_csv(&self) -> String {
        let of = &self.metabolism;
        let mut text =
            String::from("t,w,p,rcn,hr,vo2,breaths,kcal,epoc,fatigue,flush,sweat,borg\n");
        for second in 0..self.seconds() {
            let _ = write!(text, "{second}");
            for column in [
                &self.w,
                &self.p,
                &self.rcn,
                &self.heart_rate,
                &of.vo2,
                &of.breaths,
                &of.kcal_min,
                &of.epoc,
                &of.fatigue,
                &of.flush,
                &of.sweat,
                &of.borg,
            ] {
                let _ = write!(text, ",{}", column[second]);
            }
            text.push('\n');
        }
        text
    }
}
