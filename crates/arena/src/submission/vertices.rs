//! Places of the head's vertices: a sequence for each capture or segment in; the head with the principal shapes of all of
//! them, and weights for each segment, out.
//!
//! One bank is made of the frames of all segments, so that a method has one head. It gives every vertex of every frame
//! again to within [`TOLERANCE_MM`], or the submission is refused.

use std::collections::BTreeMap;

use mimique_avatar::{Avatar, MOST_SHAPES};
use mimique_avatar_files::{Template, write_glb};
use mimique_mocap::{VertexArray, WeightsTable, read_vertex_array};
use mimique_stimulus::{VertexBank, VertexBankOptions, sequence_avatar};

use super::given::{Cover, Place};
use super::{Given, SubmissionProblem};
use crate::arena_file::Arena;

/// No vertex of any frame is farther than this from where it was submitted, millimetres: a tenth of a pixel at the
/// distance at which a head fills 480 of them.
pub const TOLERANCE_MM: f64 = 0.05;
/// A vertex farther than this from its place at rest is of another mesh, unit or place, millimetres: a jaw that opens
/// wide goes 60.
const FARTHEST_MM: f64 = 100.0;

/// Vertices that may take part.
#[derive(Debug, Clone, PartialEq)]
pub struct VertexSubmission {
    /// The weights of each segment, of the shapes of the head below.
    pub segments: BTreeMap<String, WeightsTable>,
    /// The arena's head with the principal shapes, as a GLB file.
    pub glb: Vec<u8>,
    /// Number of shapes.
    pub shapes: usize,
    /// How far a vertex is at most from where it was submitted, millimetres.
    pub largest_error_mm: f64,
    /// The root mean square of that distance, millimetres.
    pub rms_error_mm: f64,
}

/// Reads and checks sequences of vertices against the arena: `head` is its avatar, `template` the skin of that, in the
/// order and unit in which the sequences are.
///
/// # Errors
/// Everything that is wrong with them; or what the principal shapes leave.
pub fn check_vertices(
    arena: &Arena,
    head: &Avatar,
    template: &Template,
    given: &[Given],
    rate_hz: f64,
) -> Result<VertexSubmission, Vec<SubmissionProblem>> {
    let mut found = Vec::new();
    let mut cover = Cover::new(arena);
    let mut arrays = Vec::new();
    for (place, own) in given.iter().enumerate() {
        let array = match read_vertex_array(&own.path) {
            Ok(array) => array,
            Err(error) => {
                let why = error.to_string();
                found.push(SubmissionProblem::Unreadable { file: own.name(), why });
                VertexArray { vertices: 0, positions: Vec::new() }
            }
        };
        match cover.add(place, own, given.len() == 1) {
            Ok(part) if array.vertices > 0 => {
                found.extend(array_problems(&own.name(), &array, template, part, rate_hz));
            }
            Ok(_) => (),
            Err(problem) => found.push(problem),
        }
        arrays.push(array);
    }
    found.extend(cover.missing());
    if !found.is_empty() {
        return Err(found);
    }
    let width = 3 * template.positions.len();
    let all = cover.cuts.values().flat_map(|(place, frames)| {
        arrays[*place].positions[frames.start * width..frames.end * width].iter().copied()
    });
    let sequence = VertexArray { vertices: template.positions.len(), positions: all.collect() };
    let counts =
        cover.cuts.iter().map(|(segment, (_, frames))| ((*segment).to_owned(), frames.len()));
    compressed(head, template, &sequence, counts.collect(), rate_hz)
}

/// What is wrong with a sequence.
fn array_problems(
    file: &str,
    array: &VertexArray,
    template: &Template,
    Place { id, capture, frames }: Place<'_>,
    rate_hz: f64,
) -> Vec<SubmissionProblem> {
    let mut found = Vec::new();
    let (file, wanted) = (file.to_owned(), template.positions.len());
    if (rate_hz / capture.rate_hz - 1.0).abs() > 1e-3 {
        let (file, id, wanted) = (file.clone(), id.to_owned(), capture.rate_hz);
        found.push(SubmissionProblem::Rate { file, id, found: rate_hz, wanted });
    }
    if array.vertices != wanted {
        found.push(SubmissionProblem::Vertices { file, found: array.vertices, wanted });
        return found;
    }
    let has = array.positions.len() / (3 * wanted);
    if has != frames {
        let (file, id) = (file.clone(), id.to_owned());
        found.push(SubmissionProblem::Frames { file, id, found: has, wanted: frames });
    }
    found.extend(places(&file, array, template));
    found
}

/// A coordinate that is none, and vertices that are not at the head.
fn places(file: &str, array: &VertexArray, template: &Template) -> Vec<SubmissionProblem> {
    let mut found = Vec::new();
    let mut far: Option<(usize, usize, f64)> = None;
    let mut count = 0;
    let vertices = template.positions.len();
    for (place, own) in array.positions.as_chunks::<3>().0.iter().enumerate() {
        let (frame, vertex) = (place / vertices, place % vertices);
        if let Some(value) = own.iter().find(|x| !x.is_finite()) {
            let (file, value) = (file.to_owned(), *value);
            found.push(SubmissionProblem::NotFinite { file, frame, vertex, value });
            break;
        }
        let square = own
            .iter()
            .zip(&template.positions[vertex])
            .map(|(x, rest)| (f64::from(*x) * template.unit_metres - f64::from(*rest)).powi(2));
        let distance_mm = 1e3 * square.sum::<f64>().sqrt();
        if distance_mm > FARTHEST_MM {
            far.get_or_insert((frame, vertex, distance_mm));
            count += 1;
        }
    }
    found.extend(far.map(|(frame, vertex, distance_mm)| {
        let (file, most_mm) = (file.to_owned(), FARTHEST_MM);
        SubmissionProblem::Far { file, frame, vertex, distance_mm, count, most_mm }
    }));
    found
}

/// The head with the principal shapes of a sequence, and the weights of each segment, whose frames stand one after the
/// other.
fn compressed(
    head: &Avatar,
    template: &Template,
    sequence: &VertexArray,
    counts: Vec<(String, usize)>,
    rate_hz: f64,
) -> Result<VertexSubmission, Vec<SubmissionProblem>> {
    let options =
        VertexBankOptions { rate_hz, tolerance_m: TOLERANCE_MM / 1e3, most_shapes: MOST_SHAPES };
    let surface = |why: String| vec![SubmissionProblem::NoSurface { why }];
    let bank = VertexBank::of(&head.name, template, sequence, &options)
        .map_err(|error| surface(error.to_string()))?;
    let shapes = bank.avatar.shape_names.len();
    let error_mm = 1e3 * bank.largest_error_m;
    if error_mm > TOLERANCE_MM {
        let (frame, vertex) = bank.largest_at;
        let tolerance_mm = TOLERANCE_MM;
        let left =
            SubmissionProblem::NotCompressed { shapes, error_mm, frame, vertex, tolerance_mm };
        return Err(vec![left]);
    }
    let shown = sequence_avatar(head, &bank).map_err(|error| surface(error.to_string()))?;
    let glb = write_glb(&shown, &[], rate_hz).map_err(|error| surface(error.to_string()))?;
    let mut first = 0;
    let mut segments = BTreeMap::new();
    for (segment, frames) in counts {
        let rows = bank.weights.weights[first * shapes..(first + frames) * shapes].to_vec();
        let names = bank.weights.shape_names.clone();
        segments.insert(segment, WeightsTable::at_rate(names, rows, 0, rate_hz));
        first += frames;
    }
    let rms_error_mm = 1e3 * bank.rms_error_m;
    Ok(VertexSubmission { segments, glb, shapes, largest_error_mm: error_mm, rms_error_mm })
}
