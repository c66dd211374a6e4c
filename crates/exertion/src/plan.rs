//! A plan: parts one after the other, each with its work and, where it was recorded, its heart.

use crate::error::{ExertionError, from_zero, within};
use crate::samples::between_seconds;
use crate::work::Accumulated;

/// The longest plan, s: a day.
const LONGEST_S: f64 = 86_400.0;

/// A part of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Its work from its own beginning on.
    pub work: Accumulated,
    /// How long it is, s. Work that ends before is followed by rest, work that goes on is cut.
    pub seconds: f64,
    /// The share of the heart's reserve at its whole seconds, where it was recorded.
    pub rcn: Option<Vec<f64>>,
}

impl Part {
    /// Rest.
    pub fn rest(seconds: f64) -> Self {
        Self { work: Accumulated::none(), seconds, rcn: None }
    }
}

/// Parts one after the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    parts: Vec<Part>,
    /// When each part begins, s, and what was done until then, J/kg; and the end of all.
    begins: Vec<(f64, f64)>,
}

impl Plan {
    /// Of its parts.
    ///
    /// # Errors
    /// [`ExertionError`]: no part (`parts`), a part of no time (`parts/i`), more than a day, a recorded heart
    /// outside 0 to 1 (`parts/i/rcn`).
    pub fn new(parts: Vec<Part>) -> Result<Self, ExertionError> {
        if parts.is_empty() {
            return Err(ExertionError::Few { place: "parts".to_owned(), found: 0, least: 1 });
        }
        let mut begins = vec![(0.0, 0.0)];
        let (mut time, mut work) = (0.0, 0.0);
        for (i, part) in parts.iter().enumerate() {
            let place = format!("parts/{i}");
            from_zero(&place, part.seconds)?;
            if part.seconds <= 0.0 {
                let (value, above) = (part.seconds, 0.0);
                let (below, unit) = (Some(LONGEST_S), Some("s"));
                return Err(ExertionError::NotBetween { place, value, above, below, unit });
            }
            if let Some(rcn) = &part.rcn {
                let place = format!("{place}/rcn");
                if rcn.is_empty() {
                    return Err(ExertionError::Few { place, found: 0, least: 1 });
                }
                rcn.iter()
                    .try_for_each(|own| within(&place, *own, [0.0, 1.0], None).map(|_| ()))?;
            }
            time += part.seconds;
            work += part.work.at(part.seconds);
            begins.push((time, work));
        }
        within("parts", time, [0.0, LONGEST_S], Some("s"))?;
        Ok(Self { parts, begins })
    }

    /// One part alone.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of(part: Part) -> Result<Self, ExertionError> {
        Self::new(vec![part])
    }

    /// The parts.
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// When a part begins, s.
    pub fn begin_s(&self, part: usize) -> f64 {
        self.begins[part].0
    }

    /// How long all of it is, s.
    pub fn span_s(&self) -> f64 {
        self.begins[self.parts.len()].0
    }

    /// C(t), J/kg.
    pub fn at(&self, t: f64) -> f64 {
        let part = self.part_at(t);
        let (begin, work) = self.begins[part];
        let own = (t - begin).clamp(0.0, self.parts[part].seconds);
        work + self.parts[part].work.at(own)
    }

    /// The part in which a time lies; a border belongs to what ends there.
    fn part_at(&self, t: f64) -> usize {
        let ended = self.begins[1..].partition_point(|(end, _)| *end < t);
        ended.min(self.parts.len() - 1)
    }

    /// E5: w, the work of the last second, J/kg.
    pub fn w(&self, t: f64) -> f64 {
        crate::work::w(|t| self.at(t), t)
    }

    /// E5: p, W/kg.
    pub fn p(&self, t: f64) -> f64 {
        crate::work::p(|t| self.at(t), t, Some(self.span_s()))
    }

    /// The recorded share of the heart's reserve at a time, where that part has one.
    pub fn recorded_rcn(&self, t: f64) -> Option<f64> {
        let part = self.part_at(t);
        let rcn = self.parts[part].rcn.as_ref()?;
        Some(between_seconds(rcn, t - self.begins[part].0))
    }
}
