//! `kmeans_plane.json`, `kmeans_face.json`, `kmeans_symmetric.json`: rows, clusters, markers.

use mimique_solver::{
    ClusterMarkers, KMeans, StandsFor, TrajectoryRows, VertexTrajectories, stands_for_pairs,
};
use serde_json::{Map, Value, json};

use super::{EXACT, Source, apart, matrix, member, points, relative};
use crate::case::{Tolerance, number, numbers, rows};
use crate::document::Part;
use crate::{Case, VerifyError};

/// Centres, rows, distances, inertia.
const NEAR: Tolerance = Tolerance::Absolute(1e-9);
/// Millimetres to metres.
const MILLIMETRE: f64 = 1e-3;

/// A clustering, and each of its steps as cases write it.
pub(super) fn clustered(table: &TrajectoryRows, start: &[f64]) -> (KMeans, Vec<Value>) {
    let mut steps = Vec::new();
    let found = KMeans::by_steps(table, start, &mut |step| {
        steps.push(json!({
            "labels": step.labels,
            "inertia": number(step.inertia),
            "centres": rows(step.centres, table.width),
        }));
    });
    (found, steps)
}

/// The steps beside those that are expected: labels exactly, numbers nearly.
fn compare_steps(case: &mut Case, expected: &Part<'_>, steps: &[Value]) -> Result<(), VerifyError> {
    let Some(part) = expected.find("steps") else { return Ok(()) };
    let list = part.list()?;
    case.compare("steps/length", &json!(list.len()), &json!(steps.len()), EXACT);
    for (place, (expected, got)) in list.iter().zip(steps).enumerate() {
        for (key, by) in [("labels", EXACT), ("inertia", NEAR), ("centres", NEAR)] {
            if let Some(expected) = expected.find(key) {
                case.compare(&format!("steps/{place}/{key}"), expected.value(), &got[key], by);
            }
        }
    }
    Ok(())
}

/// Lloyd on points of a plane.
pub(super) fn plane(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    let root = source.document.root();
    let width = root.get("rows")?.first()?.list()?.len();
    let count = root.get("rows")?.list()?.len();
    let table = TrajectoryRows { width, values: matrix(&root.get("rows")?, count, width)? };
    let clusters = root.get("start")?.list()?.len();
    let start = matrix(&root.get("start")?, clusters, width)?;
    let (found, steps) = clustered(&table, &start);
    let (mut case, expected) = (Case::new(source.name), root.get("expected")?);
    compare_steps(&mut case, &expected, &steps)?;
    member(&mut case, &expected, "iterations", EXACT, &json!(found.iterations));
    member(&mut case, &expected, "labels", EXACT, &json!(found.labels));
    member(&mut case, &expected, "centres", NEAR, &rows(&found.centres, width));
    member(&mut case, &expected, "inertia", NEAR, &number(found.inertia));
    each(case);
    Ok(())
}

/// The positions of a person (frames x vertices x 3), in metres.
fn positions(part: &Part<'_>, vertices: usize) -> Result<Vec<f64>, VerifyError> {
    let frames = part.list()?.len();
    let mut numbers = matrix(part, frames, 3 * vertices)?;
    numbers.iter_mut().for_each(|x| *x *= MILLIMETRE);
    Ok(numbers)
}

/// The rows of the vertices that a run starts from.
pub(super) fn start_rows(
    part: &Part<'_>,
    table: &TrajectoryRows,
    vertices: &[usize],
) -> Result<Vec<f64>, VerifyError> {
    let mut start = Vec::new();
    for entry in part.list()? {
        let vertex = entry.index()?;
        let place = vertices.iter().position(|&v| v == vertex);
        let place = place.ok_or_else(|| entry.wrong("a vertex that is clustered"))?;
        start.extend(table.row(place));
    }
    Ok(start)
}

/// Markers by cluster, and the clusters without one, as cases write them.
fn markers(found: &ClusterMarkers) -> Value {
    let by_cluster: Map<String, Value> =
        found.chosen.iter().map(|(k, vertices)| (k.to_string(), json!(vertices[0]))).collect();
    json!({"by_cluster": by_cluster, "without": found.without})
}

/// Compares the markers of clusters with those that are expected at this place of the case.
pub(super) fn compare_markers(
    case: &mut Case,
    place: usize,
    wanted: &Part<'_>,
    chosen: &ClusterMarkers,
) -> Result<(), VerifyError> {
    let got = markers(chosen);
    for key in ["by_cluster", "without"] {
        let field = format!("markers/{place}/{key}");
        case.compare(&field, wanted.get(key)?.value(), &got[key], EXACT);
    }
    Ok(())
}

/// Trajectories of two people.
pub(super) fn face(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    let root = source.document.root();
    let neutral = points(&root.get("vertices")?)?;
    let below = |part: &Part<'_>| part.indices_below(neutral.len(), "a vertex");
    let people: Vec<Vec<f64>> = (root.get("people")?.list()?.iter())
        .map(|person| positions(person, neutral.len()))
        .collect::<Result<_, _>>()?;
    let takes: Vec<VertexTrajectories<'_>> = (people.iter())
        .map(|positions| VertexTrajectories { vertices: neutral.len(), positions })
        .collect();
    let vertices = below(&root.get("clustered")?)?;
    let table = TrajectoryRows::of_trajectories(&takes, &vertices);
    let start = start_rows(&root.get("start")?, &table, &vertices)?;
    let (found, steps) = clustered(&table, &start);

    let (mut case, expected) = (Case::new(source.name), root.get("expected")?);
    let still = still_at(&people, neutral.len());
    member(&mut case, &expected, "still_coordinates_at", EXACT, &json!(still));
    member(&mut case, &expected, "first_row", NEAR, &numbers(table.row(0)));
    let whole: Vec<usize> = (0..neutral.len()).collect();
    let every = TrajectoryRows::of_trajectories(&takes, &whole);
    for (place, pair) in expected.get("squared_distances")?.list()?.iter().enumerate() {
        let of = |key: &str| below_one(&pair.get(key)?, neutral.len()).map(|v| every.row(v));
        let (a, b) = (of("a")?, of("b")?);
        let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
        let field = format!("squared_distances/{place}/value");
        case.compare(&field, pair.get("value")?.value(), &number(square), NEAR);
    }
    compare_steps(&mut case, &expected, &steps)?;
    member(&mut case, &expected, "iterations", EXACT, &json!(found.iterations));
    member(&mut case, &expected, "centres", NEAR, &rows(&found.centres, table.width));
    let allowed = below(&root.get("allowed")?)?;
    for (place, wanted) in expected.get("markers")?.list()?.iter().enumerate() {
        let all = wanted.get("allowed")?.text()? == "clustered";
        let stands_for = |&v: &usize| match all || allowed.contains(&v) {
            true => StandsFor::One(v),
            false => StandsFor::Nothing,
        };
        let stands_for: Vec<StandsFor> = vertices.iter().map(stands_for).collect();
        let minimum = wanted.get("minimum_distance_mm")?.number()?;
        let apart = apart(&neutral, minimum);
        let chosen = ClusterMarkers::choose(&table, &vertices, &found, &stands_for, &apart);
        compare_markers(&mut case, place, wanted, &chosen)?;
    }
    each(case);
    Ok(())
}

/// A whole number below a bound.
fn below_one(part: &Part<'_>, bound: usize) -> Result<usize, VerifyError> {
    let index = part.index()?;
    if index < bound { Ok(index) } else { Err(part.wrong("a vertex")) }
}

/// The vertices of which a coordinate rests for somebody.
fn still_at(people: &[Vec<f64>], vertices: usize) -> Vec<usize> {
    let rests = |vertex: &usize| {
        people.iter().any(|positions| {
            let take = [VertexTrajectories { vertices, positions }];
            let table = TrajectoryRows::of_trajectories(&take, &[*vertex]);
            let row = table.row(0);
            (0..3).any(|axis| row.iter().skip(axis).step_by(3).all(|x| *x == 0.0))
        })
    };
    (0..vertices).filter(rests).collect()
}

/// Rows of mirrored vertices, joined.
pub(super) fn symmetric(
    source: &Source<'_>,
    each: &mut dyn FnMut(Case),
) -> Result<(), VerifyError> {
    let root = source.document.root();
    let neutral = points(&root.get("vertices")?)?;
    let below = |part: &Part<'_>| part.indices_below(neutral.len(), "a vertex");
    let places = positions(&root.get("positions")?, neutral.len())?;
    let mirror = below(&root.get("mirror")?)?;
    let half = below(&root.get("clustered")?)?;
    let take = [VertexTrajectories { vertices: neutral.len(), positions: &places }];
    let whole: Vec<usize> = (0..neutral.len()).collect();
    let every = TrajectoryRows::of_trajectories(&take, &whole);
    let pairs: Vec<[usize; 2]> = half.iter().map(|&v| [v, mirror[v]]).collect();
    let table = every.joined(&pairs);
    let start = start_rows(&root.get("start")?, &table, &half)?;
    let (found, steps) = clustered(&table, &start);

    let (mut case, expected) = (Case::new(source.name), root.get("expected")?);
    compare_steps(&mut case, &expected, &steps)?;
    member(&mut case, &expected, "iterations", EXACT, &json!(found.iterations));
    member(&mut case, &expected, "labels", EXACT, &json!(found.labels));
    member(&mut case, &expected, "inertia", relative(1e-9), &number(found.inertia));
    let minimum = root.get("minimum_distance_mm")?.number()?;
    let from_middle: Vec<f64> = neutral.iter().map(|p| p.x.abs()).collect();
    let stands_for = stands_for_pairs(&half, &neutral, &from_middle, &mirror, minimum);
    let apart = apart(&neutral, minimum);
    let chosen = ClusterMarkers::choose(&table, &half, &found, &stands_for, &apart);
    member(&mut case, &expected, "markers", EXACT, &json!(chosen.vertices()));
    member(&mut case, &expected, "without", EXACT, &json!(chosen.without));
    each(case);
    Ok(())
}
