//! Stored optima: weights of the stored displacements by every variant.

use std::collections::BTreeMap;
use std::path::Path;

use mimique_solver::{Fit, MethodSpec, OperatorOptions};
use serde_json::{Value, json};

use super::FRAMES;
use super::head::Head;
use super::variants;
use crate::case::{Tolerance, number, numbers, rows};
use crate::document::Table;
use crate::{Case, VerifyError};

/// The displacements of the face markers, metres: a frame a row.
pub(super) const DISPLACEMENTS: &str = "frames/_Dm_metres.csv";
/// How far an optimum may be from its own conditions.
const KKT: f64 = 1e-9;

/// The optima of a variant.
pub(super) struct Optima {
    pub name: String,
    /// The method, or why there is none of that name.
    pub spec: Result<MethodSpec, String>,
    /// A frame a row, a shape a column.
    pub weights: Value,
    frames: Vec<usize>,
}

/// The stored displacements, and what each variant makes of them.
pub(super) struct Stored {
    /// Numbers of the frames in the take, from 0.
    pub frames: Vec<usize>,
    /// A frame a row.
    pub displacements: Vec<Vec<f64>>,
    pub optima: Vec<Optima>,
}

impl Stored {
    /// Reads `frames/`: the displacements, and all other tables as optima, by name.
    pub fn read(folder: &Path) -> Result<Self, VerifyError> {
        let displacements = folder.join(DISPLACEMENTS);
        let (frames, rows) = table(&displacements)?;
        let unread = |error: std::io::Error| VerifyError::read(&folder.join(FRAMES), &error);
        let mut files = BTreeMap::new();
        for entry in std::fs::read_dir(folder.join(FRAMES)).map_err(unread)? {
            let path = entry.map_err(unread)?.path();
            if path.extension().is_some_and(|e| e == "csv") && path != displacements {
                let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                files.insert(name.trim_end_matches(".csv").to_owned(), path);
            }
        }
        let mut optima = Vec::new();
        for (name, file) in files {
            let (frames, weights) = table(&file)?;
            let weights = weights.iter().map(numbers).collect();
            optima.push(Optima { spec: variants::spec(&name), name, weights, frames });
        }
        Ok(Self { frames, displacements: rows, optima })
    }
}

/// Frame numbers and the numbers of each.
fn table(file: &Path) -> Result<(Vec<usize>, Vec<Vec<f64>>), VerifyError> {
    let table = Table::read(file)?;
    let first = table.column("frame")? + 1;
    let rows = 0..table.rows.len();
    let frames = rows.clone().map(|row| table.index(row, first - 1)).collect::<Result<_, _>>()?;
    Ok((frames, rows.map(|row| table.numbers(row, first)).collect::<Result<_, _>>()?))
}

/// A case for each variant: frame after frame, and each alone.
pub(super) fn cases(
    head: &mut Head,
    stored: &Stored,
    each: &mut dyn FnMut(Case),
) -> Result<(), VerifyError> {
    for optima in &stored.optima {
        let mut case = Case::new(format!("{FRAMES}/{}", optima.name));
        case.compare("frame", &json!(stored.frames), &json!(optima.frames), Tolerance::Exact);
        match solved(head, stored, optima) {
            Ok(found) => {
                let by = Tolerance::Absolute(found.tolerance);
                case.compare("weights", &optima.weights, &found.in_order, by);
                case.compare("alone", &optima.weights, &found.alone, by);
                let (none, kkt) = (json!(0.0), Tolerance::Absolute(KKT));
                case.compare("kkt_error", &none, &number(found.kkt_error), kkt);
                case.compare("warnings", &json!(0), &json!(found.warnings), Tolerance::Exact);
            }
            Err(why) => case.refused("weights", &why),
        }
        each(case);
    }
    Ok(())
}

/// What a variant makes of the stored displacements.
struct Solved {
    tolerance: f64,
    /// Each frame begins from the weights of the one before.
    in_order: Value,
    /// Each frame begins from nothing.
    alone: Value,
    /// The largest.
    kkt_error: f64,
    /// Frames with a warning.
    warnings: usize,
}

fn solved(head: &mut Head, stored: &Stored, optima: &Optima) -> Result<Solved, String> {
    let spec = optima.spec.as_ref().map_err(Clone::clone)?;
    let options = OperatorOptions::of(spec);
    let operators = head.operators(&options).map_err(|why| why.to_string())?;
    let fit = Fit::new(operators, spec).map_err(|why| why.to_string())?;
    let take = fit.solve_take(&stored.displacements.concat()).map_err(|why| why.to_string())?;
    let alone = stored.displacements.iter().map(|d| fit.solve_frame(d));
    let alone = alone.collect::<Result<Vec<_>, _>>().map_err(|why| why.to_string())?;
    let reports = || take.reports.iter().chain(alone.iter().map(|frame| &frame.report));
    Ok(Solved {
        tolerance: variants::tolerance(spec),
        in_order: rows(&take.weights, fit.shape_count()),
        alone: alone.iter().map(|frame| numbers(&frame.weights)).collect(),
        kkt_error: reports().fold(0.0, |most, report| report.kkt_error.max(most)),
        warnings: reports().filter(|report| report.warning.is_some()).count(),
    })
}
