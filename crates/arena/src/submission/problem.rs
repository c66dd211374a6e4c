//! What can be wrong with a submission.

/// Something that is wrong with a submission.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SubmissionProblem {
    /// A detail of it.
    #[error("{what} {value:?}: {remedy}")]
    Detail {
        /// Which.
        what: &'static str,
        /// What was given.
        value: String,
        /// What to do.
        remedy: &'static str,
    },
    /// A file that cannot be read.
    #[error("{file}: {why}")]
    Unreadable {
        /// The file.
        file: String,
        /// What its reader says, with the remedy.
        why: String,
    },
    /// A file of which is not known what it is for.
    #[error("{file}: the arena has neither a capture nor a segment {id:?}; write ID={file} with one of {}", known.join(", "))]
    NoSuchPart {
        /// The file.
        file: String,
        /// What it would be for.
        id: String,
        /// Captures and segments.
        known: Vec<String>,
    },
    /// Two files for one segment.
    #[error("{file}: segment {segment} is in another file, too; give each segment once")]
    Twice {
        /// The second file.
        file: String,
        /// The segment.
        segment: String,
    },
    /// No file for a segment.
    #[error("segment {segment}: no file has it; give one for every capture, or for every segment")]
    Missing {
        /// The segment.
        segment: String,
    },
    /// Other frames than the segment has.
    #[error("{file}: {found} frames; {id} has {wanted}: give a row for each frame of it")]
    Frames {
        /// The file.
        file: String,
        /// Capture or segment.
        id: String,
        /// Frames of the file.
        found: usize,
        /// Frames that it is to have.
        wanted: usize,
    },
    /// Another rate than the capture has.
    #[error(
        "{file}: {found} frames per second; {id} has {wanted}: solve every frame, or resample (the arena brings all methods to one rate)"
    )]
    Rate {
        /// The file.
        file: String,
        /// Capture or segment.
        id: String,
        /// Of the file.
        found: f64,
        /// Of the capture.
        wanted: f64,
    },
    /// A shape that the head does not have.
    #[error("{file}: column {shape:?}: the head has no such shape{}; name its shapes (`mimique inspect head.glb`)", maybe(nearest.as_deref()))]
    Shape {
        /// The file.
        file: String,
        /// The name.
        shape: String,
        /// The name that is probably meant.
        nearest: Option<String>,
    },
    /// Weights beyond the bounds.
    #[error("{file}: {shape} in frame {frame}: {value}{}; keep weights within {low} and {high}", more(*count))]
    Beyond {
        /// The file.
        file: String,
        /// The shape of the first of them.
        shape: String,
        /// Its frame.
        frame: u64,
        /// Its value.
        value: f64,
        /// How many there are.
        count: usize,
        /// Least weight.
        low: f64,
        /// Largest weight.
        high: f64,
    },
    /// A sequence of another mesh.
    #[error(
        "{file}: {found} vertices in each frame; the skin of the arena's head has {wanted}: write all of them in its order (`mimique solve --vertices` does)"
    )]
    Vertices {
        /// The file.
        file: String,
        /// In the file.
        found: usize,
        /// In the head.
        wanted: usize,
    },
    /// A coordinate that is none.
    #[error(
        "{file}: frame {frame}, vertex {vertex}: {value}; write a finite number for every coordinate"
    )]
    NotFinite {
        /// The file.
        file: String,
        /// Frame, from 0.
        frame: usize,
        /// Vertex, from 0.
        vertex: usize,
        /// What stands there.
        value: f32,
    },
    /// A vertex that is not at the head.
    #[error("{file}: frame {frame}, vertex {vertex}: {distance_mm:.0} mm from its place at rest{}; give {most_mm:.0} mm at most, in the unit of the head, the head held still", more(*count))]
    Far {
        /// The file.
        file: String,
        /// Frame of the first of them, from 0.
        frame: usize,
        /// Its vertex, from 0.
        vertex: usize,
        /// Its distance.
        distance_mm: f64,
        /// How many there are.
        count: usize,
        /// The largest distance that is taken.
        most_mm: f64,
    },
    /// A sequence that its principal shapes do not give again.
    #[error(
        "vertices: {shapes} principal shapes leave {error_mm:.3} mm (frame {frame}, vertex {vertex}); {tolerance_mm} mm at most: take out noise from frame to frame, or submit shorter segments"
    )]
    NotCompressed {
        /// Shapes that are taken at most.
        shapes: usize,
        /// The largest error.
        error_mm: f64,
        /// Its frame, of all segments one after the other.
        frame: usize,
        /// Its vertex.
        vertex: usize,
        /// The largest error that is taken.
        tolerance_mm: f64,
    },
    /// The head cannot be moved by a sequence of vertices.
    #[error("vertices: {why}")]
    NoSurface {
        /// Why, with the remedy.
        why: String,
    },
}

fn maybe(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |nearest| format!(" (it has {nearest:?})"))
}

fn more(count: usize) -> String {
    if count > 1 { format!(" (the first of {count})") } else { String::new() }
}
