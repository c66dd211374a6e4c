//! The skin drawn by the processor with the stage's own camera: a heat map of a difference, and the
//! vertex under a click. Both work without a graphics device.

use crate::problem::Problem;
use crate::workspace::Workspace;
use mimique_geometry::Point;

/// A picture of `width` x `height` pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// RGBA, 8 bits each, row by row from the top.
    pub rgba: Vec<u8>,
    /// Pixels a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

/// A vertex on the screen: pixels from the upper left, depth 0 (near) to 1.
#[derive(Debug, Clone, Copy)]
struct ScreenVertex {
    x: f32,
    y: f32,
    depth: f32,
}

impl Workspace {
    /// A heat map of the difference of two slots in a frame, on the skin of the first. `camera` is
    /// the stage's clip-from-world matrix, column by column; `full_mm` is the brightest colour.
    ///
    /// # Errors
    /// [`Problem`]: nothing is solved under a slot, no such frame, no camera.
    pub fn heat_map(
        &self,
        [a, b]: [&str; 2],
        frame: usize,
        camera: &[f32],
        [width, height]: [usize; 2],
        full_mm: f32,
    ) -> Result<Picture, Problem> {
        let camera = matrix(camera)?;
        let skin = self.moved_skin(a, frame)?;
        let difference = self.difference(a, b, frame)?.vertices_mm;
        let seen: Vec<ScreenVertex> =
            skin.iter().map(|&p| project(&camera, p, [width, height])).collect();
        let mut picture = Picture { rgba: vec![0; 4 * width * height], width, height };
        let mut depth = vec![f32::INFINITY; width * height];
        for t in &self.face()?.skin.mesh.triangles {
            let [i, j, k] = t.map(|v| v as usize);
            // Form: how much the triangle faces the camera, as the light does.
            let shade = 0.55 + 0.45 * facing(skin[i], skin[j], skin[k]);
            each_pixel([seen[i], seen[j], seen[k]], [width, height], |pixel, share, z| {
                if z < depth[pixel] {
                    depth[pixel] = z;
                    let value = share[0] * difference[i]
                        + share[1] * difference[j]
                        + share[2] * difference[k];
                    let colour = heat(value / full_mm.max(1e-6));
                    for (c, part) in colour.iter().enumerate() {
                        picture.rgba[4 * pixel + c] = (part * shade) as u8;
                    }
                    picture.rgba[4 * pixel + 3] = 255;
                }
            });
        }
        Ok(picture)
    }

    /// The vertex of the neutral skin under a point of the picture (pixels from the upper left);
    /// none beside the head.
    ///
    /// # Errors
    /// [`Problem`]: no avatar, no camera.
    pub fn pick(
        &self,
        camera: &[f32],
        size: [usize; 2],
        at: [f32; 2],
    ) -> Result<Option<usize>, Problem> {
        let mesh = &self.face()?.skin.mesh;
        Ok(pick(&mesh.positions, &mesh.triangles, &matrix(camera)?, size, at))
    }
}

/// The vertex under a point of the picture: of the nearest triangle there, the corner that is
/// nearest on the screen.
pub fn pick(
    positions: &[Point],
    triangles: &[[u32; 3]],
    camera: &[f32; 16],
    size: [usize; 2],
    [x, y]: [f32; 2],
) -> Option<usize> {
    let seen: Vec<ScreenVertex> = positions.iter().map(|&p| project(camera, p, size)).collect();
    let mut best: Option<(f32, usize)> = None;
    for t in triangles {
        let corners = t.map(|v| seen[v as usize]);
        let Some(share) = shares(corners, x, y) else { continue };
        let z: f32 = (0..3).map(|c| share[c] * corners[c].depth).sum();
        if best.is_none_or(|(nearest, _)| z < nearest) {
            let away = |c: usize| (corners[c].x - x).powi(2) + (corners[c].y - y).powi(2);
            let corner = (0..3).min_by(|&a, &b| away(a).total_cmp(&away(b))).unwrap_or(0);
            best = Some((z, t[corner] as usize));
        }
    }
    best.map(|(_, vertex)| vertex)
}

fn matrix(camera: &[f32]) -> Result<[f32; 16], Problem> {
    camera.try_into().map_err(|_| {
        Problem::of("camera", format!("{} numbers; give a matrix of 16", camera.len()))
    })
}

fn project(m: &[f32; 16], p: Point, [width, height]: [usize; 2]) -> ScreenVertex {
    let p = p.as_vec3();
    let row = |r: usize| m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r];
    let w = row(3);
    ScreenVertex {
        x: (row(0) / w * 0.5 + 0.5) * width as f32,
        y: (0.5 - row(1) / w * 0.5) * height as f32,
        depth: row(2) / w,
    }
}

/// Barycentric coordinates of a point in a triangle that faces the camera; none outside.
fn shares([a, b, c]: [ScreenVertex; 3], x: f32, y: f32) -> Option<[f32; 3]> {
    let cross = |p: ScreenVertex, q: ScreenVertex, x: f32, y: f32| {
        (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x)
    };
    // Counter-clockwise triangles are clockwise on a screen whose y goes down.
    let area = -cross(a, b, c.x, c.y);
    if area.is_nan() || area <= 0.0 {
        return None;
    }
    let share = [-cross(b, c, x, y) / area, -cross(c, a, x, y) / area, -cross(a, b, x, y) / area];
    share.iter().all(|s| *s >= 0.0).then_some(share)
}

fn each_pixel(
    corners: [ScreenVertex; 3],
    [width, height]: [usize; 2],
    mut paint: impl FnMut(usize, [f32; 3], f32),
) {
    let low = |of: fn(&ScreenVertex) -> f32| corners.iter().map(of).fold(f32::INFINITY, f32::min);
    let high =
        |of: fn(&ScreenVertex) -> f32| corners.iter().map(of).fold(f32::NEG_INFINITY, f32::max);
    let span = |low: f32, high: f32, most: usize| {
        (low.floor().max(0.0) as usize)..((high.ceil().max(0.0) as usize).min(most))
    };
    if corners.iter().any(|s| !(s.x.is_finite() && s.y.is_finite())) {
        return;
    }
    for row in span(low(|s| s.y), high(|s| s.y), height) {
        for column in span(low(|s| s.x), high(|s| s.x), width) {
            if let Some(share) = shares(corners, column as f32 + 0.5, row as f32 + 0.5) {
                let z = (0..3).map(|c| share[c] * corners[c].depth).sum();
                paint(row * width + column, share, z);
            }
        }
    }
}

/// Cosine between a triangle's normal and straight forward, 0 to 1.
fn facing(a: Point, b: Point, c: Point) -> f32 {
    (b - a).cross(c - a).normalize_or_zero().z.max(0.0) as f32
}

/// From dark blue (0) over green to yellow (1): lightness rises evenly, so that it reads in grey
/// and for colour-blind people.
fn heat(value: f32) -> [f32; 3] {
    const STEPS: [[f32; 3]; 6] = [
        [68.0, 40.0, 110.0],
        [62.0, 80.0, 138.0],
        [42.0, 120.0, 142.0],
        [36.0, 162.0, 134.0],
        [120.0, 202.0, 84.0],
        [250.0, 228.0, 52.0],
    ];
    let at = value.clamp(0.0, 1.0) * 5.0;
    let below = (at as usize).min(4);
    let part = at - below as f32;
    std::array::from_fn(|c| STEPS[below][c] + part * (STEPS[below + 1][c] - STEPS[below][c]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Looks along -z; x and y of -1 to 1 fill the picture.
    const STRAIGHT: [f32; 16] = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., -0.5, 0., 0., 0., 0.5, 1.];

    #[test]
    fn a_click_finds_the_nearest_corner_of_the_front_most_triangle() {
        let positions = [
            [-0.8, -0.8, 0.0],
            [0.8, -0.8, 0.0],
            [0.0, 0.8, 0.0],
            // The same farther off, and one that faces away in front.
            [-0.9, -0.9, -0.5],
            [0.9, -0.9, -0.5],
            [0.0, 0.9, -0.5],
            [-0.8, -0.8, 0.5],
            [0.8, -0.8, 0.5],
            [0.0, 0.8, 0.5],
        ]
        .map(Point::from);
        let triangles = [[3, 4, 5], [0, 1, 2], [6, 8, 7]];
        let at = |x, y| pick(&positions, &triangles, &STRAIGHT, [100, 100], [x, y]);
        assert_eq!(at(20.0, 85.0), Some(0));
        assert_eq!(at(80.0, 85.0), Some(1));
        assert_eq!(at(50.0, 20.0), Some(2));
        assert_eq!(at(2.0, 2.0), None);
    }

    #[test]
    fn heat_rises_in_lightness() {
        let light = |v: f32| {
            let [r, g, b] = heat(v);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        let steps: Vec<f32> = (0..=20).map(|i| light(i as f32 / 20.0)).collect();
        assert!(steps.windows(2).all(|p| p[1] > p[0]), "{steps:?}");
    }
}
