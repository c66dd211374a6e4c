//! Scale factors of the markers' displacements (Kouadio 5.3): by marker, axis and sign, from the
//! range of motion of actor and avatar; by hand; for all markers.

use mimique_geometry::{DVec3, Displacement};

use crate::energy::operators::OperatorParts;

/// How far something goes along each axis in either direction, metres.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Extent {
    /// Largest displacement along x, y, z, 0 or more.
    pub most: Displacement,
    /// Smallest, 0 or less.
    pub least: Displacement,
}

/// Factors for P markers: displacement times `positive` or `negative`, by the sign of each of its
/// coordinates (eq. 5.1: P' = P + \[global\]\[man\]\[auto\] TT').
#[derive(Debug, Clone, PartialEq)]
pub struct MarkerScales {
    /// Factors of positive x, y, z for each marker.
    pub positive: Vec<DVec3>,
    /// Factors of negative x, y, z.
    pub negative: Vec<DVec3>,
}

/// An actor's range of motion below this tells noise from noise: the factor is then 1. Metres.
pub const LEAST_RANGE_M: f64 = 1e-3;

impl Extent {
    /// Take a displacement in; what is not seen (NaN) changes nothing.
    fn hold(&mut self, d: Displacement) {
        for a in 0..3 {
            self.most[a] = self.most[a].max(d[a]);
            self.least[a] = self.least[a].min(d[a]);
        }
    }
}

/// The bank's range of motion at each of the P markers (5.3.1): over the shapes one at a time, each
/// between its least and greatest admissible weight (`bounds`, N pairs). Metres.
pub fn bank_extents(operators: &OperatorParts, bounds: &[[f64; 2]]) -> Vec<Extent> {
    let n = operators.shape_names.len();
    (operators.marker_deltas.chunks_exact(3 * n))
        .map(|rows| {
            let mut extent = Extent::default();
            for (k, bounds) in bounds.iter().enumerate() {
                for c in bounds {
                    extent.hold(*c * Displacement::new(rows[k], rows[n + k], rows[2 * n + k]));
                }
            }
            extent
        })
        .collect()
}

/// The actor's range of motion: displacements of `markers` over some frames (frames x 3P, metres,
/// NaN where a marker is not seen).
pub fn motion_extents(displacements: &[f64], markers: usize) -> Vec<Extent> {
    let mut extents = vec![Extent::default(); markers];
    for frame in displacements.chunks_exact(3 * markers.max(1)) {
        for (extent, d) in extents.iter_mut().zip(frame.chunks_exact(3)) {
            extent.hold(Displacement::new(d[0], d[1], d[2]));
        }
    }
    extents
}

impl MarkerScales {
    /// 1 everywhere.
    pub fn ones(markers: usize) -> MarkerScales {
        MarkerScales { positive: vec![DVec3::ONE; markers], negative: vec![DVec3::ONE; markers] }
    }

    /// The automatic factors (5.3.1): face / mask for each marker, axis and sign.
    ///
    /// Where the actor's range is below [`LEAST_RANGE_M`] the factor is 1: the ratio would be one
    /// of noise.
    pub fn automatic(face: &[Extent], mask: &[Extent]) -> MarkerScales {
        let ratios = |of: fn(&Extent) -> Displacement| {
            let ratio = |face: f64, mask: f64| {
                if mask.abs() < LEAST_RANGE_M { 1.0 } else { face / mask }
            };
            (face.iter().zip(mask))
                .map(|(face, mask)| {
                    let (face, mask) = (of(face), of(mask));
                    DVec3::new(ratio(face.x, mask.x), ratio(face.y, mask.y), ratio(face.z, mask.z))
                })
                .collect()
        };
        MarkerScales { positive: ratios(|e| e.most), negative: ratios(|e| e.least) }
    }

    /// The same times factors for both signs: one marker's by hand, or all markers'.
    ///
    /// # Panics
    /// If `marker` is not one of the P.
    pub fn times(&mut self, marker: usize, factors: DVec3) {
        self.positive[marker] *= factors;
        self.negative[marker] *= factors;
    }

    /// Scale the displacements of one frame (3P numbers) in place.
    pub fn apply(&self, d: &mut [f64]) {
        for ((d, positive), negative) in
            d.chunks_exact_mut(3).zip(&self.positive).zip(&self.negative)
        {
            for a in 0..3 {
                d[a] *= if d[a] < 0.0 { negative[a] } else { positive[a] };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn extent(most: [f64; 3], least: [f64; 3]) -> Extent {
        Extent { most: most.into(), least: least.into() }
    }

    #[test]
    fn factors_take_the_actor_s_range_to_the_bank_s_sign_by_sign() {
        // A marker that goes 4 mm up and 2 mm down, on a face whose bank has 6 mm and 1 mm there.
        let d = [0.0, 0.004, 0.0, 0.0, -0.002, f64::NAN, 0.0, 0.001, 0.0];
        let mask = motion_extents(&d, 1);
        assert_eq!(mask[0], extent([0.0, 0.004, 0.0], [0.0, -0.002, 0.0]));
        let face = [extent([0.0, 0.006, 0.003], [-0.001, -0.001, 0.0])];
        let mut scales = MarkerScales::automatic(&face, &mask);
        assert_eq!(scales.positive, [DVec3::new(1.0, 1.5, 1.0)]);
        assert_eq!(scales.negative, [DVec3::new(1.0, 0.5, 1.0)]);
        scales.times(0, DVec3::splat(2.0));
        let mut moved = [0.001, 0.004, -0.001];
        scales.apply(&mut moved);
        assert_eq!(moved, [0.002, 0.012, -0.002]);
        let mut down = [0.0, -0.002, f64::NAN];
        scales.apply(&mut down);
        assert_eq!(down[1], -0.002);
        assert!(down[2].is_nan());
    }
}
