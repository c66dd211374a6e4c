//! A skin seen from a side without perspective: what is in front, at each point of a picture.

use mimique_geometry::{DVec3, Point};
use mimique_solver::SkinMesh;

/// A direction to look from, turned about the vertical from the front.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    right: DVec3,
    towards: DVec3,
}

/// What is in front at each point of a picture.
#[derive(Debug, Clone)]
pub struct DepthPicture {
    view: View,
    /// Points across and down.
    pub size: [usize; 2],
    /// Metres of a point.
    pub step: f64,
    /// Right coordinate of the left edge and height of the upper edge, metres.
    corner: [f64; 2],
    /// Nearness to the viewer, metres; minus infinity where nothing is.
    depth: Vec<f64>,
    /// The triangle in front; `u32::MAX` where nothing is.
    triangle: Vec<u32>,
}

impl View {
    /// From the front, turned by some degrees towards the person's left.
    pub fn turned(degrees: f64) -> Self {
        let (sine, cosine) = libm::sincos(degrees.to_radians());
        Self { right: DVec3::new(cosine, 0.0, -sine), towards: DVec3::new(sine, 0.0, cosine) }
    }

    /// Across (to the viewer's right) and up, metres, and how near a point is to the viewer.
    pub fn project(&self, p: Point) -> [f64; 3] {
        [p.0.dot(self.right), p.y, p.0.dot(self.towards)]
    }

    /// The unit vector towards the viewer.
    pub fn towards(&self) -> DVec3 {
        self.towards
    }
}

impl DepthPicture {
    /// Of a skin within a frame of heights (metres), `step` metres a point.
    pub fn of(mesh: &SkinMesh, view: View, heights: [f64; 2], step: f64) -> Self {
        Self::within(mesh, view, heights, [f64::NEG_INFINITY, f64::INFINITY], step)
    }

    /// The same within a frame across, too.
    pub fn within(
        mesh: &SkinMesh,
        view: View,
        [low, high]: [f64; 2],
        [leftmost, rightmost]: [f64; 2],
        step: f64,
    ) -> Self {
        let seen: Vec<[f64; 3]> = mesh.positions.iter().map(|&p| view.project(p)).collect();
        let across = |x: f64| x >= leftmost && x <= rightmost;
        let inside = || seen.iter().filter(|p| p[1] >= low && p[1] <= high && across(p[0]));
        let left = inside().fold(f64::INFINITY, |least, p| least.min(p[0])) - 2.0 * step;
        let right = inside().fold(f64::NEG_INFINITY, |most, p| most.max(p[0])) + 2.0 * step;
        let top = inside().fold(f64::NEG_INFINITY, |most, p| most.max(p[1])) + 2.0 * step;
        let bottom = inside().fold(f64::INFINITY, |least, p| least.min(p[1])) - 2.0 * step;
        let count = |length: f64| (length / step).ceil().max(1.0) as usize;
        let size = [count(right - left), count(top - bottom)];
        let points = size[0] * size[1];
        let mut picture = Self {
            view,
            size,
            step,
            corner: [left, top],
            depth: vec![f64::NEG_INFINITY; points],
            triangle: vec![u32::MAX; points],
        };
        for (number, t) in mesh.triangles.iter().enumerate() {
            picture.draw(number as u32, t.map(|v| seen[v as usize]));
        }
        picture
    }

    /// Draws a triangle where it is in front.
    fn draw(&mut self, number: u32, corners: [[f64; 3]; 3]) {
        let at = corners.map(|[x, y, z]| {
            [(x - self.corner[0]) / self.step, (self.corner[1] - y) / self.step, z]
        });
        let [a, b, c] = at;
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area == 0.0 {
            return;
        }
        let span = |axis: usize| {
            let low = a[axis].min(b[axis]).min(c[axis]).floor().max(0.0);
            let high = a[axis].max(b[axis]).max(c[axis]).ceil().min(self.size[axis] as f64);
            low as usize..(high.max(0.0) as usize)
        };
        for row in span(1) {
            for column in span(0) {
                let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
                let edge = |p: [f64; 3], q: [f64; 3]| {
                    ((q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])) / area
                };
                let weights = [edge(b, c), edge(c, a), edge(a, b)];
                if weights.iter().all(|w| *w >= 0.0) {
                    let depth: f64 = weights.iter().zip(at).map(|(w, p)| w * p[2]).sum();
                    let place = row * self.size[0] + column;
                    if depth > self.depth[place] {
                        self.depth[place] = depth;
                        self.triangle[place] = number;
                    }
                }
            }
        }
    }

    /// Column and row of a point of space; none where it is outside the picture.
    fn place(&self, p: Point) -> Option<(usize, f64)> {
        let [x, y, z] = self.view.project(p);
        let column = ((x - self.corner[0]) / self.step).floor();
        let row = ((self.corner[1] - y) / self.step).floor();
        let inside = column >= 0.0
            && row >= 0.0
            && column < self.size[0] as f64
            && row < self.size[1] as f64;
        inside.then(|| (row as usize * self.size[0] + column as usize, z))
    }

    /// Whether nothing is in front of a point of the skin by more than a tolerance, metres.
    pub fn sees(&self, p: Point, tolerance: f64) -> bool {
        self.place(p).is_some_and(|(place, depth)| depth >= self.depth[place] - tolerance)
    }

    /// Where a point of space is in the picture, points across and down.
    pub fn at(&self, p: Point) -> [f64; 2] {
        let [x, y, _] = self.view.project(p);
        [(x - self.corner[0]) / self.step, (self.corner[1] - y) / self.step]
    }

    /// The triangle in front at a point of the picture, and its barycentric coordinates there.
    pub fn front(&self, mesh: &SkinMesh, column: usize, row: usize) -> Option<(usize, [f64; 3])> {
        let number = self.triangle[row * self.size[0] + column];
        if number == u32::MAX {
            return None;
        }
        let corners = mesh.triangles[number as usize].map(|v| self.at(mesh.positions[v as usize]));
        let [a, b, c] = corners;
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
        let edge = |p: [f64; 2], q: [f64; 2]| {
            ((q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])) / area
        };
        Some((number as usize, [edge(b, c), edge(c, a), edge(a, b)]))
    }

    /// Nearness to the viewer at a point of the picture, metres; minus infinity where nothing is.
    pub fn depth(&self, column: usize, row: usize) -> f64 {
        self.depth[row * self.size[0] + column]
    }
}
