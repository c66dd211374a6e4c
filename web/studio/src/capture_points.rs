//! The markers of a capture as the capture has them, to be looked at beside the head that they are placed on; and where
//! a place lies on the other side of the face.

use mimique_geometry::{Point, align_rigidly, centroid};
use serde_json::{Value, json};

use crate::problem::Problem;
use crate::workspace::Workspace;

impl Workspace {
    /// The mean place of each marker in the neutral frames (in all, where none are named), metres; null where it is
    /// never seen. Once three markers are placed the points are turned as the avatar stands.
    ///
    /// # Errors
    /// [`Problem`]: no capture, no avatar, a map that does not fit it.
    pub fn capture_points(&self) -> Result<Value, Problem> {
        let capture = self.capture()?;
        let skin = &self.face()?.skin;
        let metres = capture.unit.metres();
        let frames = self.map.neutral.clone().unwrap_or(0..capture.frames());
        let mean = |m: usize| {
            let seen = frames.clone().map(|frame| capture.frame(frame)[m]);
            centroid(seen.filter(|p| p.is_finite())).map(|x| x * metres)
        };
        let points: Vec<Point> = (0..capture.labels.len()).map(mean).collect();
        let sites = self.map.resolve(skin).map_err(|e| Problem::of("marker map", e))?;
        let (from, to): (Vec<Point>, Vec<Point>) = (sites.iter())
            .filter_map(|site| {
                let at = capture.marker_index(&site.label)?;
                Some((points[at], skin.mesh.positions[site.vertex()]))
            })
            .unzip();
        let motion = align_rigidly(&from, &to).ok();
        let turned = points.iter().map(|&p| motion.map_or(p, |motion| motion.apply(p)));
        Ok(json!(turned.map(|p| p.is_finite().then_some(p)).collect::<Vec<_>>()))
    }

    /// The vertex of the skin that is nearest to where `vertex` lies in the mirror.
    ///
    /// # Errors
    /// [`Problem`]: no avatar, no such vertex.
    pub fn mirrored_vertex(&self, vertex: usize) -> Result<usize, Problem> {
        let positions = &self.face()?.skin.mesh.positions;
        let Some(own) = positions.get(vertex) else {
            let what = format!("{vertex} of {}; choose one of the face", positions.len());
            return Err(Problem::of("vertex", what));
        };
        let apart =
            |p: &Point| (p[0] + own[0]).powi(2) + (p[1] - own[1]).powi(2) + (p[2] - own[2]).powi(2);
        let nearest = (0..positions.len())
            .min_by(|&a, &b| apart(&positions[a]).total_cmp(&apart(&positions[b])));
        Ok(nearest.unwrap_or(vertex))
    }
}
