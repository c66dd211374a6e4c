//! How far apart two methods move the skin.

use serde::Serialize;

use crate::workspace::{Problem, Workspace};

/// The difference of two solved takes in one frame.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Difference {
    /// Of each vertex of the welded skin, millimetres.
    #[serde(skip)]
    pub vertices_mm: Vec<f32>,
    /// Root mean square over the vertices, millimetres.
    pub rms_mm: f64,
    /// The largest, millimetres.
    pub worst_mm: f64,
}

impl Workspace {
    /// How far the skin of two slots is apart in a frame.
    ///
    /// # Errors
    /// [`Problem`]: nothing is solved under a slot, no such frame.
    pub fn difference(&self, a: &str, b: &str, frame: usize) -> Result<Difference, Problem> {
        let (a, b) = (self.moved_skin(a, frame)?, self.moved_skin(b, frame)?);
        let squares: Vec<f64> = (a.iter().zip(&b))
            .map(|(p, q)| (0..3).map(|x| (1e3 * (p[x] - q[x])).powi(2)).sum())
            .collect();
        let worst = squares.iter().fold(0.0, |m: f64, s| m.max(*s));
        let mean = squares.iter().sum::<f64>() / squares.len().max(1) as f64;
        Ok(Difference {
            vertices_mm: squares.iter().map(|s| s.sqrt() as f32).collect(),
            rms_mm: mean.sqrt(),
            worst_mm: worst.sqrt(),
        })
    }
}
