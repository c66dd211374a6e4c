//! A head seen from a side, in greys.

use jpeg_encoder::{ColorType, Encoder};
use mimique_geometry::DVec3;
use mimique_solver::SkinMesh;

use crate::view::{DepthPicture, View};

/// Metres of a point of the picture: some 100 points an inch at the head's own size.
const STEP_M: f64 = 0.00025;
/// Quality of the JPEG.
const QUALITY: u8 = 88;
/// Greys of skin that looks away and of skin that looks at the viewer.
const GREYS: [f64; 2] = [120.0, 240.0];
/// The paper.
const PAPER: u8 = 255;

/// A picture, and where points of space are in it.
pub(super) struct HeadPicture {
    pub(super) depth: DepthPicture,
    pub(super) jpeg: Vec<u8>,
    pub(super) points: [usize; 2],
}

impl HeadPicture {
    /// Of a skin within a frame, metres.
    pub(super) fn of(
        mesh: &SkinMesh,
        normals: &[DVec3],
        view: View,
        heights: [f64; 2],
        across: [f64; 2],
    ) -> Self {
        let depth = DepthPicture::within(mesh, view, heights, across, STEP_M);
        let [width, height] = depth.size;
        let mut greys = vec![PAPER; width * height];
        // From the viewer, a little from above and the left.
        let light = (view.towards() + 0.35 * DVec3::Y).normalize();
        for row in 0..height {
            for column in 0..width {
                let Some((triangle, weights)) = depth.front(mesh, column, row) else { continue };
                let corners = mesh.triangles[triangle].map(|v| normals[v as usize]);
                let normal: DVec3 = corners.iter().zip(weights).map(|(n, w)| *n * w).sum();
                let shade = normal.try_normalize().map_or(0.0, |n| n.dot(light)).clamp(0.0, 1.0);
                let grey = GREYS[0] + (GREYS[1] - GREYS[0]) * shade;
                greys[row * width + column] = grey.round() as u8;
            }
        }
        let mut jpeg = Vec::new();
        let size = [width, height].map(|n| u16::try_from(n).unwrap_or(u16::MAX));
        // A picture of a page is far below the format's 65,535 points; writing to memory does not fail.
        let _ = Encoder::new(&mut jpeg, QUALITY).encode(&greys, size[0], size[1], ColorType::Luma);
        Self { points: depth.size, depth, jpeg }
    }

    /// Width and height at the head's own size, millimetres.
    pub(super) fn size_mm(&self) -> [f64; 2] {
        self.points.map(|n| 1e3 * STEP_M * n as f64)
    }

    /// Where a point of space is, millimetres from the upper left corner.
    pub(super) fn at_mm(&self, p: mimique_geometry::Point) -> [f64; 2] {
        self.depth.at(p).map(|x| 1e3 * STEP_M * x)
    }
}
