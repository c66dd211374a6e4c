//! One gaze of both eyes, and the shapes of a bank that turn them.

use crate::shape_names::arkit_shapes;

/// Angles of ARKit's four eye-look shapes at weight 1, degrees. ARKit publishes none; these are the
/// usual ranges of rigs that carry its names, within the eye's own 25 to 35 degrees of easy gaze.
pub const LOOK_DEGREES: [(&str, f64); 4] =
    [("eyeLookUp", 25.0), ("eyeLookDown", 30.0), ("eyeLookIn", 30.0), ("eyeLookOut", 30.0)];

/// What vergence healthy eyes have, degrees: parallel ones diverge by some 4 prism dioptres before what they see
/// doubles (Morgan's norms, after Scheiman and Wick, Clinical Management of Binocular Vision, base-in at distance: break
/// 7, recovery 4), and meet at 25 degrees on what is 14 cm from the eyes.
pub const VERGENCE_DEGREES: [f64; 2] = [-2.0, 25.0];

/// How much one eye looks higher than the other before what they see doubles, degrees (the same norms, vertical
/// vergence: break 3 to 4 prism dioptres).
pub const VERTICAL_DISPARITY_DEGREES: f64 = 2.0;

/// Where both eyes look together, in degrees, as seen by the person.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct GazeAngles {
    /// Mean turn of both eyes about the vertical: to the person's left above 0.
    pub azimuth: f64,
    /// Mean turn of both eyes upwards.
    pub elevation: f64,
    /// Angle between both eyes' lines of sight: 0 in the distance, above 0 for what is near; below 0 the eyes
    /// are turned outwards from each other, which eyes do not do.
    pub vergence: f64,
}

/// Where each eye looks: azimuth to the person's left and elevation, degrees; none for an eye that the bank
/// does not turn.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EyeAngles {
    /// The person's left eye.
    pub left: Option<[f64; 2]>,
    /// The person's right eye.
    pub right: Option<[f64; 2]>,
}

/// The shapes of a bank that turn the eyes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct GazeShapes {
    /// A shape, and what it does at weight 1: the eye (0 the left one), azimuth or elevation (0 or 1), degrees.
    turns: Vec<(usize, [usize; 2], f64)>,
}

impl GazeShapes {
    /// Finds them by their names ([`arkit_shapes`]).
    pub fn of(shape_names: &[String]) -> Self {
        let mut turns = Vec::new();
        for (shape, name) in shape_names.iter().enumerate() {
            for meant in arkit_shapes(name) {
                let (eye, feature) = match (meant.strip_suffix("Left"), meant.strip_suffix("Right"))
                {
                    (Some(feature), _) => (0, feature),
                    (_, Some(feature)) => (1, feature),
                    _ => continue,
                };
                let Some((_, degrees)) = LOOK_DEGREES.iter().find(|(word, _)| *word == feature)
                else {
                    continue;
                };
                // Outwards is to the person's left for the left eye, to the right for the right one.
                let outwards = if eye == 0 { *degrees } else { -degrees };
                let (axis, turn) = match feature {
                    "eyeLookUp" => (1, *degrees),
                    "eyeLookDown" => (1, -degrees),
                    "eyeLookOut" => (0, outwards),
                    _ => (0, -outwards),
                };
                turns.push((shape, [eye, axis], turn));
            }
        }
        Self { turns }
    }

    /// Whether the bank turns no eye.
    pub fn is_empty(&self) -> bool {
        self.turns.is_empty()
    }

    /// Indices of the shapes, ascending.
    pub fn shapes(&self) -> Vec<usize> {
        let mut shapes: Vec<usize> = self.turns.iter().map(|&(shape, ..)| shape).collect();
        shapes.dedup();
        shapes
    }

    /// Where each eye looks at some weights of the bank.
    pub fn eyes(&self, weights: &[f64]) -> EyeAngles {
        let mut eyes = [None; 2];
        for &(shape, [eye, axis], degrees) in &self.turns {
            let angles = eyes[eye].get_or_insert([0.0; 2]);
            angles[axis] += weights.get(shape).copied().unwrap_or(0.0) * degrees;
        }
        EyeAngles { left: eyes[0], right: eyes[1] }
    }

    /// The weights of the shapes that turn both eyes to a gaze, in the order of [`GazeShapes::shapes`]: 0 to 1,
    /// so that each eye stays within [`LOOK_DEGREES`].
    ///
    /// A shape that stands for several looks (`AU61` turns both eyes) has the mean of theirs.
    pub fn weights(&self, gaze: GazeAngles) -> Vec<f64> {
        let half = gaze.vergence / 2.0;
        let wanted = [[gaze.azimuth - half, gaze.elevation], [gaze.azimuth + half, gaze.elevation]];
        // A look that is none weighs 0, and not -0, which packs do not keep.
        let look = |wanted: f64, degrees: f64| (wanted / degrees).clamp(0.0, 1.0) + 0.0;
        let weight = |shape: usize| {
            let own = self.turns.iter().filter(|turn| turn.0 == shape);
            let (sum, count) = own.fold((0.0, 0.0), |(sum, count), &(_, [eye, axis], degrees)| {
                (sum + look(wanted[eye][axis], degrees), count + 1.0)
            });
            sum / count
        };
        self.shapes().into_iter().map(weight).collect()
    }
}

impl EyeAngles {
    /// Both eyes as one gaze; of one eye alone its own, without vergence; none of no eye.
    pub fn gaze(&self) -> Option<GazeAngles> {
        match (self.left, self.right) {
            (Some(left), Some(right)) => Some(GazeAngles {
                azimuth: f64::midpoint(left[0], right[0]),
                elevation: f64::midpoint(left[1], right[1]),
                vergence: right[0] - left[0],
            }),
            (Some([azimuth, elevation]), None) | (None, Some([azimuth, elevation])) => {
                Some(GazeAngles { azimuth, elevation, vergence: 0.0 })
            }
            (None, None) => None,
        }
    }

    /// How much higher the left eye looks than the right one, degrees; 0 unless both are turned.
    pub fn vertical_disparity(&self) -> f64 {
        match (self.left, self.right) {
            (Some(left), Some(right)) => left[1] - right[1],
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ARKIT_SHAPES;

    fn arkit() -> (Vec<String>, GazeShapes) {
        let names = ARKIT_SHAPES.map(str::to_owned).to_vec();
        let shapes = GazeShapes::of(&names);
        (names, shapes)
    }

    fn set(shapes: &GazeShapes, count: usize, gaze: GazeAngles) -> Vec<f64> {
        let mut row = vec![0.0; count];
        for (shape, weight) in shapes.shapes().into_iter().zip(shapes.weights(gaze)) {
            row[shape] = weight;
        }
        row
    }

    #[test]
    fn a_gaze_comes_back_from_its_weights() {
        let (names, shapes) = arkit();
        assert_eq!(shapes.shapes().len(), 8);
        for gaze in [
            GazeAngles { azimuth: 12.0, elevation: 9.0, vergence: 0.0 },
            GazeAngles { azimuth: -21.0, elevation: -25.0, vergence: 6.0 },
            GazeAngles { azimuth: 1.0, elevation: 0.0, vergence: 14.0 },
        ] {
            let row = set(&shapes, names.len(), gaze);
            let back = shapes.eyes(&row).gaze().unwrap();
            for (a, b) in [
                (gaze.azimuth, back.azimuth),
                (gaze.elevation, back.elevation),
                (gaze.vergence, back.vergence),
            ] {
                assert!((a - b).abs() < 1e-12, "{gaze:?} {back:?}");
            }
            assert_eq!(shapes.eyes(&row).vertical_disparity(), 0.0);
        }
    }

    #[test]
    fn signs_and_limits() {
        let (names, shapes) = arkit();
        let at = |name: &str| names.iter().position(|n| n == name).unwrap();
        // To the person's left: the left eye outwards, the right one inwards.
        let row = set(&shapes, names.len(), GazeAngles { azimuth: 15.0, ..GazeAngles::default() });
        assert_eq!([row[at("eyeLookOutLeft")], row[at("eyeLookInRight")]], [0.5, 0.5]);
        assert_eq!([row[at("eyeLookInLeft")], row[at("eyeLookOutRight")]], [0.0, 0.0]);
        // Convergence turns both inwards.
        let row = set(&shapes, names.len(), GazeAngles { vergence: 12.0, ..GazeAngles::default() });
        assert_eq!([row[at("eyeLookInLeft")], row[at("eyeLookInRight")]], [0.2, 0.2]);
        // No eye goes beyond what its shapes turn it by.
        let row =
            set(&shapes, names.len(), GazeAngles { elevation: 80.0, ..GazeAngles::default() });
        assert_eq!([row[at("eyeLookUpLeft")], row[at("eyeLookUpRight")]], [1.0, 1.0]);
        // Two eyes that are turned outwards diverge.
        let mut row = vec![0.0; names.len()];
        row[at("eyeLookOutLeft")] = 0.1;
        row[at("eyeLookOutRight")] = 0.1;
        assert!((shapes.eyes(&row).gaze().unwrap().vergence + 6.0).abs() < 1e-12);
    }

    #[test]
    fn action_units_turn_both_eyes_and_a_bank_may_turn_none() {
        let names = ["AU61", "AU62", "AU63", "AU64"].map(str::to_owned).to_vec();
        let shapes = GazeShapes::of(&names);
        let weights = shapes.weights(GazeAngles { azimuth: 15.0, elevation: -6.0, vergence: 0.0 });
        assert_eq!(weights, [0.5, 0.0, 0.0, 0.2]);
        let gaze = shapes.eyes(&weights).gaze().unwrap();
        assert!((gaze.azimuth - 15.0).abs() < 1e-12 && (gaze.elevation + 6.0).abs() < 1e-12);
        let none = GazeShapes::of(&["jawOpen".to_owned()]);
        assert!(none.is_empty() && none.eyes(&[1.0]).gaze().is_none());
    }
}
