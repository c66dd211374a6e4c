//! Captured markers as the front end takes them: frames of positions, and which columns are what.

use mimique_geometry::Point;

use crate::front_end::error::FrontEndError;

/// Frames of marker positions: x, y, z of column 0, then of column 1...; NaN = not seen.
///
/// The caller has converted to metres: the front end knows no unit.
#[derive(Debug, Clone, Copy)]
pub struct MarkerFrames<'a> {
    /// frames x 3 columns.
    pub positions: &'a [f64],
    /// Markers per frame.
    pub columns: usize,
}

/// Which columns of a frame are what.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MarkerColumns {
    /// The column of each face marker, in the order of the operators' marker labels.
    pub face: Vec<usize>,
    /// The columns that move rigidly with the head: markers on a headband, or the face markers
    /// that move least. None = the capture is already free of head motion.
    pub head: Option<Vec<usize>>,
}

impl<'a> MarkerFrames<'a> {
    /// Number of frames.
    pub fn len(&self) -> usize {
        self.positions.len() / (3 * self.columns).max(1)
    }

    /// Whether there is no frame.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The numbers of one frame.
    ///
    /// # Panics
    /// If the frame is not in the take.
    pub fn frame(&self, frame: usize) -> &'a [f64] {
        &self.positions[3 * self.columns * frame..3 * self.columns * (frame + 1)]
    }
}

pub(crate) fn check_columns(
    take: MarkerFrames<'_>,
    columns: &MarkerColumns,
) -> Result<(), FrontEndError> {
    let width = 3 * take.columns;
    if width == 0 || !take.positions.len().is_multiple_of(width) {
        let found = take.positions.len();
        let expected = found.div_ceil(width.max(1)) * width;
        return Err(FrontEndError::Size { what: "numbers of the take", found, expected });
    }
    let head = columns.head.as_deref().unwrap_or_default();
    match columns.face.iter().chain(head).find(|&&c| c >= take.columns) {
        Some(&c) => Err(FrontEndError::Size {
            what: "columns of the take",
            found: take.columns,
            expected: c + 1,
        }),
        None => Ok(()),
    }
}

pub(crate) fn point(frame: &[f64], column: usize) -> Point {
    Point::new(frame[3 * column], frame[3 * column + 1], frame[3 * column + 2])
}
