//! Blendshapes of controls: a table of shares, by default for ARKit's shapes (E16).

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;

use crate::controls::{Control, Controls};
use crate::error::ExertionError;
use crate::json::{Object, number, parse};

/// The shapes of every control, with the share of the control that each takes.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapeTable {
    /// Names of the shapes, in alphabetical order.
    names: Vec<String>,
    /// Place of the shape among the names, its control and its share.
    shares: Vec<(usize, Control, f64)>,
}

/// E16, ours: the shapes of Apple's ARKit. A name that ends in `*` is two shapes, left and right.
const ARKIT: [(Control, &[(&str, f64)]); Control::COUNT] = [
    (Control::MouthOpen, &[("jawOpen", 0.6), ("mouthLowerDown*", 0.25)]),
    (Control::MouthExhale, &[("mouthFunnel", 0.5), ("jawOpen", 0.15), ("cheekPuff", 0.2)]),
    (Control::MouthStretch, &[("mouthStretch*", 0.8), ("mouthUpperUp*", 0.3)]),
    (Control::Eyes, &[("eyeSquint*", 1.0), ("cheekSquint*", 0.5)]),
    (Control::BrowsDown, &[("browDown*", 1.0)]),
    (Control::BrowsUp, &[("browInnerUp", 1.0), ("browOuterUp*", 0.4)]),
    (Control::Swallow, &[("mouthPress*", 0.4), ("mouthShrugLower", 0.3)]),
    (Control::Nostrils, &[("noseSneer*", 0.25)]),
];

impl Default for ShapeTable {
    /// The table of ARKit's shapes.
    fn default() -> Self {
        let mut all = Vec::new();
        for (control, shapes) in ARKIT {
            for (shape, share) in shapes {
                match shape.strip_suffix('*') {
                    Some(stem) => {
                        for side in ["Left", "Right"] {
                            all.push((format!("{stem}{side}"), control, *share));
                        }
                    }
                    None => all.push(((*shape).to_owned(), control, *share)),
                }
            }
        }
        Self::of(all)
    }
}

impl ShapeTable {
    /// Of shapes, controls and shares.
    fn of(all: Vec<(String, Control, f64)>) -> Self {
        let names: BTreeSet<String> = all.iter().map(|(name, ..)| name.clone()).collect();
        let names: Vec<String> = names.into_iter().collect();
        let place = |name: &String| names.binary_search(name).unwrap_or_default();
        let shares =
            all.iter().map(|(name, control, share)| (place(name), *control, *share)).collect();
        Self { names, shares }
    }

    /// Of a JSON object: controls with objects of shapes and shares.
    ///
    /// # Errors
    /// [`ExertionError`] at a control that is not known, or a share that is none.
    pub fn of_json(value: &Value) -> Result<Self, ExertionError> {
        let mut all = Vec::new();
        for (place, key, shapes) in Object::of("", value)?.members() {
            let Some(control) = Control::by_name(key) else {
                let known = Control::ALL.map(|(_, name)| name).to_vec();
                return Err(ExertionError::Unknown { place, known });
            };
            for (place, shape, share) in Object::of(&place, shapes)?.members() {
                all.push((shape.to_owned(), control, number(&place, share)?));
            }
        }
        Ok(Self::of(all))
    }

    /// The same of a text.
    ///
    /// # Errors
    /// As [`Self::of_json`]; [`ExertionError::Json`].
    pub fn of_text(text: &str) -> Result<Self, ExertionError> {
        Self::of_json(&parse(text)?)
    }

    /// Names of the shapes, in alphabetical order.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The shapes of a control with their shares.
    pub fn shares(&self, control: Control) -> impl Iterator<Item = (&str, f64)> {
        let of = self.shares.iter().filter(move |(_, own, _)| *own == control);
        of.map(|(shape, _, share)| (self.names[*shape].as_str(), *share))
    }

    /// E16: a shape's weight is the sum of share times control, at most 1; frame after frame, the shapes in
    /// the order of [`Self::names`].
    pub fn weights(&self, controls: &Controls) -> Vec<f64> {
        let width = self.names.len();
        let mut weights = vec![0.0; controls.frames() * width];
        for (shape, control, share) in &self.shares {
            let own = controls.of_control(*control);
            for (frame, value) in own.iter().enumerate() {
                weights[frame * width + shape] += share * value;
            }
        }
        for weight in &mut weights {
            *weight = weight.min(1.0);
        }
        weights
    }

    /// The same with weights of shapes that no control moves, a list a frame each, in columns of their own
    /// behind the others; with the names of all columns. A shape that the table has is left to it.
    ///
    /// # Panics
    /// If a list is shorter than the controls.
    pub fn weights_with(
        &self,
        controls: &Controls,
        others: &[(&str, Vec<f64>)],
    ) -> (Vec<String>, Vec<f64>) {
        let own = self.weights(controls);
        let others: Vec<&(&str, Vec<f64>)> =
            others.iter().filter(|(name, _)| !self.names.iter().any(|own| own == name)).collect();
        let mut names = self.names.clone();
        names.extend(others.iter().map(|(name, _)| (*name).to_owned()));
        let mut all = Vec::with_capacity(controls.frames() * names.len());
        for frame in 0..controls.frames() {
            all.extend_from_slice(&own[frame * self.names.len()..(frame + 1) * self.names.len()]);
            all.extend(others.iter().map(|(_, values)| values[frame]));
        }
        (names, all)
    }

    /// What of a control stands in weights by name: the least-squares fit of the control's own shares, at
    /// least 0. The way back from a face's capture to its controls.
    pub fn control_of(&self, control: Control, weight: impl Fn(&str) -> f64) -> f64 {
        let (mut product, mut square) = (0.0, 0.0);
        for (shape, share) in self.shares(control) {
            product += share * weight(shape);
            square += share * share;
        }
        if square > 0.0 { (product / square).max(0.0) } else { 0.0 }
    }

    /// The table as JSON, to be written down or changed.
    pub fn to_json(&self) -> Value {
        let mut all: BTreeMap<&str, BTreeMap<&str, f64>> = BTreeMap::new();
        for (control, name) in Control::ALL {
            let shares: BTreeMap<&str, f64> = self.shares(control).collect();
            if !shares.is_empty() {
                all.insert(name, shares);
            }
        }
        serde_json::json!(all)
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::expressivity::Expressivity;
    use crate::rules::Curves;

    #[test]
    fn the_table_reads_back_as_it_is_written() {
        let table = ShapeTable::default();
        assert_eq!(ShapeTable::of_json(&table.to_json()).unwrap().to_json(), table.to_json());
        assert_eq!(table.names().len(), 23);
        assert!(table.names().is_sorted());
    }

    #[test]
    fn controls_come_back_from_their_weights() {
        let curves = [Curves { mouth_open: 40.0, mouth_stretch: 70.0, eyes: 20.0, brows: -55.0 }];
        let controls = Controls::of(&curves, &Expressivity::default(), None);
        let table = ShapeTable::default();
        let weights = table.weights(&controls);
        let weight = |name: &str| {
            table.names().iter().position(|own| own == name).map_or(0.0, |place| weights[place])
        };
        for (control, want) in [
            (Control::MouthOpen, 0.4),
            (Control::MouthStretch, 0.7),
            (Control::Eyes, 0.2),
            (Control::BrowsDown, 0.0),
            (Control::BrowsUp, 0.55),
        ] {
            let got = table.control_of(control, weight);
            assert!((got - want).abs() < 1e-12, "{control:?}: {got}");
        }
    }

    #[test]
    fn what_is_wrong_in_a_table_is_named() {
        let place = |value: Value| ShapeTable::of_json(&value).unwrap_err().place().to_owned();
        assert_eq!(place(json!({"nose": {}})), "nose");
        assert_eq!(place(json!({"eyes": {"a": "b"}})), "eyes/a");
        assert_eq!(place(json!({"eyes": 1})), "eyes");
    }
}
