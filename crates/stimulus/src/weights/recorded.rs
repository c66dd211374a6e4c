//! `recorded`: weights of a file under an avatar's own shapes, and what of both finds no partner.

use std::collections::BTreeSet;

use mimique_avatar::{BREATH, Expression, shows_body};
use mimique_mocap::WeightsTable;
use mimique_solver::LARGEST_WEIGHT;
use serde::Serialize;

use crate::TakeWarning;

/// Recorded weights under an avatar's shapes.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedWeights {
    /// A row per frame, the avatar's shapes in its own order.
    pub table: WeightsTable,
    /// Which column went where.
    pub names: RecordedNames,
}

/// Which columns of a file drive which shapes of an avatar.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct RecordedNames {
    /// Shapes that are driven, each by one column or shares of several (a `browInnerUp` by half of
    /// each side's column).
    pub driven: Vec<Driven>,
    /// Columns that the avatar has no shape for: left out.
    pub unused: Vec<String>,
    /// Shapes that no column drives: held at 0.
    pub held: Vec<String>,
}

/// A shape and the columns that drive it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Driven {
    /// The avatar's shape.
    pub shape: String,
    /// Column and share.
    pub columns: Vec<(String, f64)>,
}

/// A weight of a file that no face has a use for: in percent, or damaged.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "frame {frame}, column {column}: {value}, where 1 is the whole shape and no face has a use for more than \
     {LARGEST_WEIGHT}; divide percentages by 100, or correct the cell"
)]
pub struct WeightBeyondSense {
    /// Number of the frame, as the file has it.
    pub frame: u64,
    /// The column.
    pub column: String,
    /// What stands there.
    pub value: f64,
}

impl RecordedWeights {
    /// Joins the columns of `recorded` to the avatar's shapes by [`mimique_avatar::map_shapes`]:
    /// ARKit's names, Left and Right as `_L` and `_R`, shapes split by side or merged.
    ///
    /// # Errors
    /// [`WeightBeyondSense`] for the first weight over [`LARGEST_WEIGHT`] in a column that drives a shape.
    pub fn of(recorded: &WeightsTable, shape_names: &[String]) -> Result<Self, WeightBeyondSense> {
        Self::with_expressions(recorded, shape_names, &[])
    }

    /// The same where columns may also be called as expressions that the avatar's file defines (VRM's `happy`): such a
    /// column drives the expression's shapes by their shares. A column that means a shape drives that one.
    ///
    /// # Errors
    /// As [`RecordedWeights::of`].
    pub fn with_expressions(
        recorded: &WeightsTable,
        shape_names: &[String],
        expressions: &[Expression],
    ) -> Result<Self, WeightBeyondSense> {
        let mut map = mimique_avatar::map_shapes(shape_names, &recorded.shape_names);
        map.unused.retain(|&column| {
            let called =
                |own: &&Expression| own.name.eq_ignore_ascii_case(&recorded.shape_names[column]);
            let Some(expression) = expressions.iter().find(called) else { return true };
            for (shape, share) in &expression.shares {
                if let Some(k) = shape_names.iter().position(|name| name == shape) {
                    map.terms[k].push((column, *share));
                }
            }
            false
        });
        let name = |c: usize| recorded.shape_names[c].clone();
        let driving: BTreeSet<usize> = map.terms.iter().flatten().map(|&(c, _)| c).collect();
        for (row, &frame) in recorded.frames.iter().enumerate() {
            let values = recorded.row(row);
            let beyond = driving.iter().find(|&&c| values[c].abs() > LARGEST_WEIGHT);
            if let Some(&column) = beyond {
                let (column, value) = (name(column), values[column]);
                return Err(WeightBeyondSense { frame, column, value });
            }
        }
        let weights = (0..recorded.frames.len())
            .flat_map(|row| {
                let row = recorded.row(row);
                // An empty sum would be -0, which packs keep as 0: another hash.
                map.terms.iter().map(move |terms| {
                    terms.iter().fold(0.0, |sum, &(c, share)| sum + share * row[c])
                })
            })
            .collect();
        let with_terms = || shape_names.iter().zip(&map.terms);
        let driven = with_terms().filter(|(_, terms)| !terms.is_empty()).map(|(shape, terms)| {
            let columns = terms.iter().map(|&(c, share)| (name(c), share)).collect();
            Driven { shape: shape.clone(), columns }
        });
        let held = with_terms().filter(|(_, terms)| terms.is_empty());
        let names = RecordedNames {
            driven: driven.collect(),
            unused: map.unused.iter().map(|&c| name(c)).collect(),
            held: held.map(|(shape, _)| shape.clone()).collect(),
        };
        let table = WeightsTable { shape_names: shape_names.to_vec(), weights, ..recorded.clone() };
        Ok(Self { table, names })
    }
}

impl RecordedNames {
    /// What should be said; of shapes that no column drives, too, unless what was recorded is meant to leave
    /// them still.
    pub fn warnings(&self, of_held: bool) -> Vec<TakeWarning> {
        let mut out = Vec::new();
        if self.driven.is_empty() {
            out.push(TakeWarning::NoColumnIsAShape);
        }
        // Few avatars have a chest, and a face is whole without it.
        let columns: Vec<String> =
            self.unused.iter().filter(|name| *name != BREATH).cloned().collect();
        if !columns.is_empty() {
            out.push(TakeWarning::ColumnsUnused { columns });
        }
        // What shows the body is there for what computes it; nobody misses it elsewhere.
        let shapes: Vec<String> =
            self.held.iter().filter(|name| !shows_body(name)).cloned().collect();
        if of_held && !shapes.is_empty() {
            out.push(TakeWarning::ShapesNotDriven { shapes });
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(names: &[&str]) -> Vec<String> {
        names.iter().map(|name| (*name).to_owned()).collect()
    }

    #[test]
    fn split_and_merged_shapes_and_what_has_no_partner() {
        let columns =
            texts(&["JawOpen", "BrowInnerUp", "CheekPuff", "MouthSmileLeft", "JawLeft", "HeadYaw"]);
        let phone = WeightsTable::at_rate(
            columns,
            vec![0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 1.0, 0.0, 0.5, 0.0, 0.0, 0.0],
            7,
            60.0,
        );
        let avatar = texts(&[
            "browInnerUp_L",
            "browInnerUp_R",
            "cheekPuff_L",
            "cheekPuff_R",
            "jawLeft",
            "jawOpen",
            "mouthSmile_L",
            "mouthSmile_R",
        ]);
        let split = RecordedWeights::of(&phone, &avatar).unwrap();
        assert_eq!(split.table.row(0), [0.2, 0.2, 0.3, 0.3, 0.5, 0.1, 0.4, 0.0]);
        assert_eq!(split.table.frames, [7, 8]);
        assert_eq!(split.names.unused, ["HeadYaw"]);
        assert_eq!(split.names.held, ["mouthSmile_R"]);
        assert_eq!(split.names.driven.len(), 7);
        let said: Vec<String> =
            split.names.warnings(true).iter().map(ToString::to_string).collect();
        assert!(said[0].contains("HeadYaw") && said[1].contains("mouthSmile_R"), "{said:?}");

        // The other way round: halves of both sides.
        let back =
            RecordedWeights::of(&split.table, &texts(&["browInnerUp", "cheekPuff", "jawOpen"]))
                .unwrap();
        for (found, expected) in back.table.row(0).iter().zip([0.2, 0.3, 0.1]) {
            assert!((found - expected).abs() < 1e-15);
        }
        assert_eq!(
            back.names.driven[0].columns,
            [("browInnerUp_L".into(), 0.5), ("browInnerUp_R".into(), 0.5)]
        );
        assert!(back.names.held.is_empty());
        let nothing = RecordedWeights::of(&phone, &texts(&["smirk"])).unwrap();
        assert_eq!(nothing.names.warnings(true)[0], TakeWarning::NoColumnIsAShape);
    }

    #[test]
    fn expressions_of_a_file_drive_their_shapes_by_shares() {
        let columns = texts(&["happy", "Blink", "jawOpen", "wink"]);
        let weights = WeightsTable::at_rate(columns, vec![0.5, 1.0, 0.25, 1.0], 0, 60.0);
        let shares = |shares: &[(&str, f64)]| {
            shares.iter().map(|(shape, share)| ((*shape).to_owned(), *share)).collect()
        };
        let expressions = [
            Expression {
                name: "happy".into(),
                shares: shares(&[("Fcl_MTH_Joy", 1.0), ("jawOpen", 0.4)]),
            },
            Expression { name: "blink".into(), shares: shares(&[("Fcl_EYE_Close", 1.0)]) },
        ];
        let shapes = texts(&["Fcl_MTH_Joy", "Fcl_EYE_Close", "jawOpen"]);
        let found = RecordedWeights::with_expressions(&weights, &shapes, &expressions).unwrap();
        assert_eq!(found.table.row(0), [0.5, 1.0, 0.25 + 0.4 * 0.5]);
        assert_eq!(found.names.unused, ["wink"]);
        // Without them nobody knows what the columns are.
        assert_eq!(RecordedWeights::of(&weights, &shapes).unwrap().names.unused.len(), 3);
    }

    #[test]
    fn percentages_and_nonsense_are_refused_where_they_drive_a_shape() {
        let shapes = texts(&["jawOpen", "headYawDegrees"]);
        let weights = vec![0.5, 45.0, 1.2, -90.0, 37.5, 0.0];
        let percent = WeightsTable::at_rate(shapes, weights, 0, 60.0);
        let found = RecordedWeights::of(&percent, &texts(&["jawOpen"])).unwrap_err();
        let expected = WeightBeyondSense { frame: 2, column: "jawOpen".into(), value: 37.5 };
        assert_eq!(found, expected);
        assert!(found.to_string().contains("divide percentages by 100"), "{found}");
        // A column that drives no shape may be in any unit.
        assert!(RecordedWeights::of(&percent, &texts(&["mouthClose"])).is_ok());
    }
}
