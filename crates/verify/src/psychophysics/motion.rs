//! Cases of measures of motion: vertices of several methods against those that were recorded.

use std::collections::BTreeMap;

use mimique_comparison::{ComparedFace, FaceMotion, LipClosures, LipPair, difference, measures};
use mimique_stats::Table;
use serde_json::{Map, Value, json};

use super::{Given, Stop};

/// Millimetres in a metre.
const MM: f64 = 1e3;

/// The measures of each method.
pub(super) fn motion(given: &Given<'_>) -> Result<Value, Stop> {
    let (table, rest) = (given.table(0)?, given.table(1)?);
    let option = |name: &str| given.options.get(name);
    if option("unit")?.text()? != "mm" {
        return Err(option("unit")?.wrong("mm").into());
    }
    let vertices: BTreeMap<String, usize> = labels(&rest, "vertex")?
        .into_iter()
        .enumerate()
        .map(|(place, name)| (name, place))
        .collect();
    let places = |name: &str| -> Result<Vec<usize>, Stop> {
        let of = |vertex: &String| {
            vertices.get(vertex).copied().ok_or_else(|| {
                Stop::Refused(format!("{name}: {vertex} is no vertex of the shape at rest"))
            })
        };
        given.texts(name)?.iter().map(of).collect()
    };
    let pair = places("lip_pair")?;
    let [upper, lower] = pair[..] else {
        return Err(option("lip_pair")?.wrong("two vertices").into());
    };
    let face = ComparedFace {
        vertices: (0..vertices.len()).collect(),
        parts: Vec::new(),
        lips: places("lip")?,
        upper: places("upper")?,
        lip_pairs: vec![LipPair { upper, lower }],
    };
    let rest: Vec<f64> = coordinates(&rest)?.into_iter().flatten().collect();
    let apart = |axis: usize| rest[3 * upper + axis] - rest[3 * lower + axis];
    let rest_gap = (0..3).map(|axis| apart(axis).powi(2)).sum::<f64>().sqrt();
    let shut = option("closed_below_mm")?.number()? / MM - rest_gap;
    let rate_hz = option("rate_hz")?.number()?;
    let motions: BTreeMap<String, FaceMotion> = of_methods(&table, &vertices)?
        .into_iter()
        .map(|(method, places)| {
            (method, FaceMotion::of_places(&face, places, rest.clone(), rate_hz))
        })
        .collect();
    let recorded = motions
        .get(option("reference")?.text()?)
        .ok_or_else(|| Stop::Refused("no rows of the reference".to_owned()))?;
    let mut told = Map::new();
    for (method, motion) in &motions {
        let own = measures(&face, motion);
        let apart = difference(&face, recorded, motion).map_err(|why| Stop::refused(&why))?;
        let closures = LipClosures::of(recorded, motion, shut);
        let whole = apart.parts.last();
        told.insert(
            method.clone(),
            json!({
                "vertex_rmse_mm": whole.map(|part| part.rms_mm),
                "worst_mm": whole.map(|part| part.largest_mm),
                "lve_mm": apart.lip_vertex_error_mm,
                "lve_squared_mm2": apart.lip_vertex_error_mm2,
                "fdd_mm2": apart.upper_face_deviation_mm2,
                "jerk_rms_mm_s3": MM * own.jerk,
                "range_mm": own.range_mm.last().map(|(_, range)| range),
                "lip_gap_error_mm": apart.lip_gap_error_mm,
                "closures_recorded": closures.map(|own| own.shut),
                "closures_kept": closures.map(|own| own.kept),
            }),
        );
    }
    Ok(json!({ "methods": told }))
}

/// Places of each method, frames x vertices x 3, metres.
fn of_methods(
    table: &Table,
    vertices: &BTreeMap<String, usize>,
) -> Result<BTreeMap<String, Vec<f64>>, Stop> {
    let (methods, names) = (labels(table, "method")?, labels(table, "vertex")?);
    let (frames, rows) = (table.numbers("frame")?.values, coordinates(table)?);
    let mut places: BTreeMap<String, BTreeMap<usize, [f64; 3]>> = BTreeMap::new();
    for (row, place) in rows.into_iter().enumerate() {
        let vertex = vertices.get(&names[row]).ok_or_else(|| {
            Stop::Refused(format!("{} is no vertex of the shape at rest", names[row]))
        })?;
        let at = frames[row] as usize * vertices.len() + vertex;
        places.entry(methods[row].clone()).or_default().insert(at, place);
    }
    Ok(places.into_iter().map(|(m, own)| (m, own.into_values().flatten().collect())).collect())
}

/// The cells of a column.
fn labels(table: &Table, column: &str) -> Result<Vec<String>, Stop> {
    let factor = table.factor(column)?;
    let mut names = Vec::new();
    for &code in &factor.codes {
        let name = factor.levels.get(code as usize);
        names.push(name.ok_or_else(|| Stop::Refused(format!("{column}: a blank cell")))?.clone());
    }
    Ok(names)
}

/// x, y and z of each row, metres.
fn coordinates(table: &Table) -> Result<Vec<[f64; 3]>, Stop> {
    let [x, y, z] = ["x", "y", "z"].map(|axis| table.numbers(axis));
    let (x, y, z) = (x?.values, y?.values, z?.values);
    Ok((0..x.len()).map(|row| [x[row], y[row], z[row]].map(|own| own / MM)).collect())
}
