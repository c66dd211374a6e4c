//! How far apart two methods move the skin.

use mimique_comparison::{ComparedFace, PartDifference};
use serde::Serialize;

use crate::problem::Problem;
use crate::workspace::Workspace;

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

/// So many frames of a take are looked at for a table.
const FRAMES_LOOKED_AT: usize = 1200;

impl Workspace {
    /// How far two slots are apart over the whole take: each part of the face, from above to below, then `Face`. Of
    /// long takes every nth frame counts.
    ///
    /// # Errors
    /// [`Problem`]: nothing is solved under a slot, other numbers of frames.
    pub fn difference_over(&self, a: &str, b: &str) -> Result<Vec<PartDifference>, Problem> {
        let [frames, others] = [self.slot_frames(a)?, self.slot_frames(b)?];
        if frames != others {
            let what = format!("{frames} frames, {b} has {others}; solve both of one take");
            return Err(Problem::of(a, what));
        }
        let face = ComparedFace::of(&self.face()?.skin);
        let names = face.by_part().into_iter().map(|(part, places)| (format!("{part:?}"), places));
        let whole = ("Face".to_owned(), (0..face.vertices.len()).collect());
        let parts: Vec<(String, Vec<usize>)> = names.chain([whole]).collect();
        let step = frames.div_ceil(FRAMES_LOOKED_AT).max(1);
        let mut squares = vec![0.0; parts.len()];
        let mut largest = vec![(0.0_f64, 0); parts.len()];
        let looked_at: Vec<usize> = (0..frames).step_by(step).collect();
        for &frame in &looked_at {
            let apart = self.difference(a, b, frame)?.vertices_mm;
            for (i, (_, places)) in parts.iter().enumerate() {
                for &place in places {
                    let mm = f64::from(apart[face.vertices[place]]);
                    squares[i] += mm * mm;
                    if mm > largest[i].0 {
                        largest[i] = (mm, frame);
                    }
                }
            }
        }
        Ok((parts.iter().enumerate())
            .map(|(i, (part, places))| PartDifference {
                part: part.clone(),
                rms_mm: (squares[i] / (looked_at.len() * places.len()).max(1) as f64).sqrt(),
                largest_mm: largest[i].0,
                largest_frame: largest[i].1,
            })
            .collect())
    }

    fn slot_frames(&self, slot: &str) -> Result<usize, Problem> {
        Ok(self.slot(slot)?.table.frames.len())
    }

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
