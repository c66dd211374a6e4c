//! `avatar_kmeans.json`, `avatar_greedy.json`, `avatar_curve.json`: the same on the public avatar, whose file
//! lies in the folder of the shared data.

use std::path::PathBuf;

use mimique_solver::{
    ClusterMarkers, Criterion, Fit, MarkerSite, MarkerUnit, Method, MethodSpec, OperatorOptions,
    Operators, StandsFor, TrajectoryRows, WeightMotion,
};
use mimique_stimulus::AvatarSkin;
use serde_json::{Value, json};

use super::clusters::{clustered, compare_markers, start_rows};
use super::order::{Placed, compare, criterion, plain, run};
use super::{Deltas, EXACT, Source, apart, member, relative};
use crate::case::{Tolerance, number, numbers};
use crate::document::{Part, Table};
use crate::{Case, VerifyError};

/// The shared data's own folder, where nothing names another: as the tests of the repository have it.
const USUAL: &str = "../shared/data";

/// A file of the shared data: beside the cases or above them, else in the folder that `MIMIQUE_DATA` names.
fn shared(source: &Source<'_>, part: &Part<'_>) -> Result<PathBuf, VerifyError> {
    let name = part.text()?;
    let above = source.folder.ancestors().map(|folder| folder.join(name));
    let named = std::env::var_os("MIMIQUE_DATA").map(PathBuf::from);
    let elsewhere = named.into_iter().chain([PathBuf::from(USUAL)]).map(|folder| folder.join(name));
    let found = above.chain(elsewhere).find(|file| file.is_file());
    found.ok_or_else(|| {
        let why = "not found beside the cases; set MIMIQUE_DATA to the folder of the shared data";
        VerifyError::file(&PathBuf::from(name), &why)
    })
}

/// The avatar of a case, in millimetres.
struct Head {
    skin: AvatarSkin,
    /// Vertices of the file by their welded number.
    welded: Vec<usize>,
    deltas: Deltas,
}

impl Head {
    fn read(source: &Source<'_>) -> Result<Self, VerifyError> {
        let file = shared(source, &source.document.root().get("avatar")?)?;
        let read = mimique_avatar_files::read_avatar(&file);
        let avatar = read.map_err(|error| VerifyError::file(&file, &error))?.avatar;
        let skin = AvatarSkin::of(&avatar).map_err(|error| VerifyError::file(&file, &error))?;
        let n = skin.shape_names.len();
        let mut values = vec![0.0; skin.mesh.positions.len() * 3 * n];
        for (k, shape) in skin.mesh.shapes.iter().enumerate() {
            for (&v, delta) in shape.vertices.iter().zip(&shape.deltas) {
                for axis in 0..3 {
                    values[(3 * v as usize + axis) * n + k] = 1e3 * delta[axis];
                }
            }
        }
        let welded = skin.welded_from_file.iter().map(|&v| v as usize).collect();
        Ok(Self { skin, welded, deltas: Deltas { shapes: n, values } })
    }

    /// Vertices that a case names, as the welded skin has them.
    fn vertices(&self, part: &Part<'_>) -> Result<Vec<usize>, VerifyError> {
        let named = part.indices_below(self.welded.len(), "a vertex of the avatar")?;
        Ok(named.into_iter().map(|v| self.welded[v]).collect())
    }

    /// Whether vertices are not nearer than a distance, millimetres.
    fn apart(&self, minimum: f64) -> impl Fn(usize, usize) -> bool + '_ {
        apart(&self.skin.mesh.positions, 1e-3 * minimum)
    }

    /// The weights of some frames of a table, in the avatar's order.
    fn weights(&self, source: &Source<'_>, key: &str) -> Result<Vec<f64>, VerifyError> {
        let root = source.document.root();
        let file = shared(source, &root.get(key)?)?;
        let table = Table::read(&file)?;
        let column = |name: &String| {
            let found = table.header.iter().position(|own| own == name);
            found.ok_or_else(|| VerifyError::file(&file, &format!("no column {name}")))
        };
        let columns =
            self.skin.shape_names.iter().map(column).collect::<Result<Vec<usize>, _>>()?;
        let frames =
            root.get("frames")?.indices_below(table.rows.len(), "a frame of the weights")?;
        let mut weights = Vec::new();
        for frame in frames {
            let row = table.numbers(frame, 1)?;
            weights.extend(columns.iter().map(|&column| row[column - 1]));
        }
        Ok(weights)
    }
}

/// The covariance of weights (1/frames), shapes x shapes.
fn covariance(weights: &[f64], shapes: usize) -> Vec<f64> {
    let frames = (weights.len() / shapes) as f64;
    let mean = |k: usize| weights.iter().skip(k).step_by(shapes).sum::<f64>() / frames;
    let mean: Vec<f64> = (0..shapes).map(mean).collect();
    let mut out = vec![0.0; shapes * shapes];
    for row in weights.chunks_exact(shapes) {
        let off: Vec<f64> = row.iter().zip(&mean).map(|(w, m)| w - m).collect();
        for (i, a) in off.iter().enumerate() {
            let row = &mut out[i * shapes..(i + 1) * shapes];
            row.iter_mut().zip(&off).for_each(|(c, b)| *c += a * b / frames);
        }
    }
    out
}

/// K-means of the bank's own rows, which have the distances of the trajectories.
pub(super) fn kmeans(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    let root = source.document.root();
    let head = Head::read(source)?;
    let weights = head.weights(source, "weights")?;
    let vertices = head.vertices(&root.get("clustered")?)?;
    let metres: Vec<f64> = head.deltas.rows(&vertices).iter().map(|x| 1e-3 * x).collect();
    let n = head.deltas.shapes;
    let motion = WeightMotion { frames: weights.len() / n, covariance: covariance(&weights, n) };
    let table = TrajectoryRows::of_bank(&metres, n, &[motion]);
    let start = start_rows(&root.get("start")?, &table, &vertices)?;
    let (found, steps) = clustered(&table, &start);
    let (mut case, expected) = (Case::new(source.name), root.get("expected")?);
    member(&mut case, &expected, "iterations", EXACT, &json!(found.iterations));
    let inertia: Value = steps.iter().map(|step| step["inertia"].clone()).collect();
    member(&mut case, &expected, "inertia", relative(1e-8), &inertia);
    member(&mut case, &expected, "labels", EXACT, &json!(found.labels));
    let stands_for: Vec<StandsFor> = vertices.iter().map(|&v| StandsFor::One(v)).collect();
    for (place, wanted) in expected.get("markers")?.list()?.iter().enumerate() {
        let apart = head.apart(wanted.get("minimum_distance_mm")?.number()?);
        let chosen = ClusterMarkers::choose(&table, &vertices, &found, &stands_for, &apart);
        compare_markers(&mut case, place, wanted, &chosen)?;
    }
    each(case);
    Ok(())
}

/// Markers one after the other, by both criteria.
pub(super) fn greedy(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    let root = source.document.root();
    let head = Head::read(source)?;
    let n = head.deltas.shapes;
    let deviations = root.get("prior_standard_deviations")?;
    let mut prior = vec![0.0; n * n];
    for (k, deviation) in deviations.numbers()?.iter().enumerate() {
        *prior.get_mut(k * n + k).ok_or_else(|| deviations.wrong("one for each shape"))? =
            deviation * deviation;
    }
    let candidates = head.vertices(&root.get("candidates")?)?;
    let noise = root.get("noise_mm")?.number()?;
    let placed: Vec<Placed> = (candidates.iter())
        .map(|&v| Placed {
            vertices: vec![v],
            unit: MarkerUnit {
                deltas: head.deltas.of(v).to_vec(),
                covariances: vec![plain(noise)],
            },
        })
        .collect();
    for (place, expected) in root.get("expected")?.list()?.into_iter().enumerate() {
        let mut case = Case::new(format!("{}/{place}", source.name));
        let apart = head.apart(expected.get("minimum_distance_mm")?.number()?);
        let criterion: Criterion = criterion(&expected.get("criterion")?, || head.deltas.gram())?;
        let count = expected.get("order")?.list()?.len();
        let found = run(&placed, &prior, criterion, count, &apart);
        compare(&mut case, &expected, &found, "expected_rmse_mm", relative(1e-7));
        each(case);
    }
    Ok(())
}

/// The method of the file on given displacements of each layout's markers.
pub(super) fn curve(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    let root = source.document.root();
    let head = Head::read(source)?;
    let truth = head.weights(source, "truth")?;
    let named = root.get("method")?;
    let method = Method::ALL.into_iter().find(|m| Some(m.name()) == named.value().as_str());
    let mut spec = MethodSpec::new(method.ok_or_else(|| named.wrong("a method's name"))?);
    spec.kappa = Some(root.get("kappa")?.number()?);
    spec.alpha = Some(root.get("alpha")?.number()?);
    for (place, expected) in root.get("expected")?.list()?.into_iter().enumerate() {
        let mut case = Case::new(format!("{}/{place}", source.name));
        let markers = head.vertices(&expected.get("markers")?)?;
        let mut displacements = expected.get("displacements_mm")?.numbers()?;
        displacements.iter_mut().for_each(|x| *x *= 1e-3);
        match solved(&head, &spec, &markers, &displacements) {
            Err(why) => case.refused("weights", &why),
            Ok(weights) => {
                let first = numbers(&weights[..head.deltas.shapes]);
                let [as_printed, per_vertex] = head.deltas.errors(&weights, &truth);
                let near = Tolerance::Absolute(1e-8);
                member(&mut case, &expected, "weights_of_first_frame", near, &first);
                let by = relative(1e-6);
                member(&mut case, &expected, "rmse_3_5_mm", by, &number(as_printed));
                member(&mut case, &expected, "rmse_a_vertex_mm", by, &number(per_vertex));
            }
        }
        each(case);
    }
    Ok(())
}

/// The weights of each frame of displacements, metres.
fn solved(
    head: &Head,
    spec: &MethodSpec,
    markers: &[usize],
    displacements: &[f64],
) -> Result<Vec<f64>, String> {
    let sites: Vec<MarkerSite> =
        markers.iter().map(|&v| MarkerSite::at_vertex(v.to_string(), v)).collect();
    let (mesh, names) = (&head.skin.mesh, &head.skin.shape_names);
    let operators = Operators::build_at(mesh, names, &sites, &OperatorOptions::of(spec));
    let operators = operators.map_err(|why| why.to_string())?;
    let fit = Fit::new(&operators, spec).map_err(|why| why.to_string())?;
    let take = fit.solve_take(displacements).map_err(|why| why.to_string())?;
    Ok(take.weights)
}
