//! What a take falls into: stretches between the borders where its energy peaks (thesis 4.4.2).
//!
//! | thesis | here |
//! |---|---|
//! | E_VelBS (4.4), E_AccBS (4.5), E_VelBS^2 + E_AccBS^2 | [`Segmentation::activity`] |
//! | peaks of E | [`BorderRule`]: of `mimique segment`, or the wording of the thesis |
//! | segments | [`Segmentation::stretches`] |
//!
//! The engine is that of `mimique segment` and of the studio (`mimique_stimulus`).

use std::ops::Range;

use mimique_stimulus::{Activity, ActivityOptions, BorderRule, Channels, Literal};
use serde::{Deserialize, Serialize};

use crate::{AnnotateError, Take};

/// How a take is cut.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Segmentation {
    /// How fast the face changes.
    pub activity: ActivityOptions,
    /// Which of its peaks are borders.
    pub rule: BorderRule,
}

impl Segmentation {
    /// All blendshapes, both energies, the rule as the thesis words it.
    pub fn as_in_the_thesis() -> Self {
        let activity = ActivityOptions::AS_IN_THE_THESIS;
        Self { activity, rule: BorderRule::Literal(Literal::default()) }
    }

    /// Velocity, acceleration and energy of a take, a number a frame. `shapes` names its columns;
    /// without names all of them count.
    ///
    /// # Errors
    /// [`AnnotateError::Filter`] when the cut-off does not fit the rate.
    pub fn activity(&self, take: &Take, shapes: &[String]) -> Result<Activity, AnnotateError> {
        let (values, count) = (take.weights.values(), take.weights.width());
        let channels = Channels { values, count, rate_hz: take.rate_hz, names: shapes };
        Ok(Activity::of(channels, &self.activity)?)
    }

    /// The stretches of a take, in order of time: together all of it.
    ///
    /// # Errors
    /// [`AnnotateError::Filter`] when the cut-off does not fit the rate.
    pub fn stretches(
        &self,
        take: &Take,
        shapes: &[String],
    ) -> Result<Vec<Range<usize>>, AnnotateError> {
        let activity = self.activity(take, shapes)?;
        let borders = self.rule.borders(&activity, take.rate_hz);
        Ok(mimique_stimulus::stretches(&borders, take.frames()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energy_and_stretches_do_not_depend_on_the_order_of_shapes() {
        let wave = |f: usize, c: usize| ((f * (c + 2)) as f64 * 0.01).sin();
        let take = |order: [usize; 3]| {
            let values = (0..300).flat_map(|f| order.map(|c| wave(f, c))).collect();
            Take::new(values, 3, 60.0).unwrap()
        };
        let (one, other) = (take([0, 1, 2]), take([2, 0, 1]));
        for of in [Segmentation::default(), Segmentation::as_in_the_thesis()] {
            let energy = |take: &Take| of.activity(take, &[]).unwrap().energy;
            for (a, b) in energy(&one).iter().zip(&energy(&other)) {
                assert!((a - b).abs() <= 1e-12 * a.abs().max(1.0));
            }
            let found = of.stretches(&one, &[]).unwrap();
            assert_eq!(found, of.stretches(&other, &[]).unwrap());
            assert!(found.len() > 1 && found[0].start == 0 && found[found.len() - 1].end == 300);
        }
    }

    #[test]
    fn a_change_between_two_faces_is_one_border_and_a_blink_none() {
        let names = ["mouthSmileLeft", "browDownLeft", "eyeBlinkLeft"].map(str::to_owned);
        let way = |f: usize, at: f64| ((f as f64 - at) / 12.0 + 0.5).clamp(0.0, 1.0);
        let values = (0..400).flat_map(|f| {
            let blink = 1.0 - ((f as f64 - 100.0) / 6.0).abs().min(1.0);
            [way(f, 200.0), 1.0 - way(f, 200.0), blink]
        });
        let take = Take::new(values.collect(), 3, 60.0).unwrap();
        let found = Segmentation::default().stretches(&take, &names).unwrap();
        let [first, second] = &found[..] else { panic!("{found:?}") };
        assert!(first.end.abs_diff(200) <= 2 && second.end == 400, "{found:?}");
    }
}
