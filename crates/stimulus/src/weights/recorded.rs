//! `recorded`: weights of a file under an avatar's own shapes, and what of both finds no partner.

use mimique_mocap::WeightsTable;
use serde::Serialize;

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

impl RecordedWeights {
    /// Joins the columns of `recorded` to the avatar's shapes by [`mimique_avatar::map_shapes`]:
    /// ARKit's names, Left and Right as `_L` and `_R`, shapes split by side or merged.
    pub fn of(recorded: &WeightsTable, shape_names: &[String]) -> Self {
        let map = mimique_avatar::map_shapes(shape_names, &recorded.shape_names);
        let name = |c: usize| recorded.shape_names[c].clone();
        let weights = (0..recorded.frames.len())
            .flat_map(|row| {
                let row = recorded.row(row);
                map.terms
                    .iter()
                    .map(move |terms| terms.iter().map(|&(c, share)| share * row[c]).sum())
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
        Self { table, names }
    }
}

impl RecordedNames {
    /// What should be said, a sentence each.
    pub fn warnings(&self) -> Vec<String> {
        let mut out = Vec::new();
        if self.driven.is_empty() {
            out.push(
                "no column of the file is a shape of the avatar: the face stays neutral".into(),
            );
        }
        if !self.unused.is_empty() {
            out.push(format!("the avatar has no shape {}: left out", self.unused.join(", ")));
        }
        if !self.held.is_empty() {
            out.push(format!("no column drives {}: held at 0", self.held.join(", ")));
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
        let split = RecordedWeights::of(&phone, &avatar);
        assert_eq!(split.table.row(0), [0.2, 0.2, 0.3, 0.3, 0.5, 0.1, 0.4, 0.0]);
        assert_eq!(split.table.frames, [7, 8]);
        assert_eq!(split.names.unused, ["HeadYaw"]);
        assert_eq!(split.names.held, ["mouthSmile_R"]);
        assert_eq!(split.names.driven.len(), 7);
        let said = split.names.warnings();
        assert!(said[0].contains("HeadYaw") && said[1].contains("mouthSmile_R"), "{said:?}");

        // The other way round: halves of both sides.
        let back =
            RecordedWeights::of(&split.table, &texts(&["browInnerUp", "cheekPuff", "jawOpen"]));
        for (found, expected) in back.table.row(0).iter().zip([0.2, 0.3, 0.1]) {
            assert!((found - expected).abs() < 1e-15);
        }
        assert_eq!(
            back.names.driven[0].columns,
            [("browInnerUp_L".into(), 0.5), ("browInnerUp_R".into(), 0.5)]
        );
        assert!(back.names.held.is_empty());
        let nothing = RecordedWeights::of(&phone, &texts(&["smirk"]));
        assert!(nothing.names.warnings()[0].contains("stays neutral"));
    }
}
