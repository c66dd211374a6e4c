//! Guesses a vertex's value from its neighbours', so that only the small error need be stored.
//!
//! The order in which vertices are visited, and the guess, follow from the triangles alone, so the
//! decoder repeats them. Parallelogram rule: over the edge (a, b) of a visited triangle (a, b, c),
//! the new vertex is guessed at a + b - c (Touma and Gotsman 1998), averaged over every such
//! triangle.

/// The visiting order of a mesh, and what each visit guesses from.
pub(super) struct Prediction {
    /// Vertices in visiting order.
    pub order: Vec<u32>,
    /// For each visit, its end in `terms`.
    ends: Vec<u32>,
    /// a, b, c of each guess a + b - c.
    terms: Vec<[u32; 3]>,
}

impl Prediction {
    /// Walks over a mesh whose triangles name vertices below `vertices`.
    pub fn new(vertices: usize, triangles: &[[u32; 3]]) -> Self {
        let around = Incidence::new(vertices, triangles);
        let mut known = vec![false; vertices];
        let mut this = Self { order: Vec::with_capacity(vertices), ends: vec![], terms: vec![] };
        for seed in 0..vertices as u32 {
            if known[seed as usize] {
                continue;
            }
            // A new island starts from where the last visit was.
            let last = this.order.last().copied();
            this.terms.extend(last.map(|v| [v, v, v]));
            let mut next = this.order.len();
            this.visit(seed, &mut known);
            while let Some(&v) = this.order.get(next) {
                next += 1;
                this.ring(v, triangles, &around, &mut known);
            }
        }
        this
    }

    /// The guess of the visit, rounded to the nearest integers.
    pub fn at(&self, visit: usize, values: &[[i32; 3]]) -> [i32; 3] {
        let start = if visit == 0 { 0 } else { self.ends[visit - 1] as usize };
        let terms = &self.terms[start..self.ends[visit] as usize];
        if terms.is_empty() {
            return [0; 3];
        }
        let n = terms.len() as i64;
        std::array::from_fn(|axis| {
            let value = |v: u32| i64::from(values[v as usize][axis]);
            let sum: i64 = terms.iter().map(|&[a, b, c]| value(a) + value(b) - value(c)).sum();
            // Damaged packs reach any sum; wrapping keeps both sides alike and never panics.
            (2 * sum + n).div_euclid(2 * n) as i32
        })
    }

    /// Visits the unknown neighbours of `v`: first those whose triangle is otherwise known, since
    /// they have a parallelogram; one of the others only when there is none.
    fn ring(&mut self, v: u32, triangles: &[[u32; 3]], around: &Incidence, known: &mut [bool]) {
        loop {
            let mut next = None;
            for &t in around.of(v) {
                let mut unknown = triangles[t as usize].into_iter().filter(|w| !known[*w as usize]);
                match (unknown.next(), unknown.next()) {
                    (Some(w), None) => {
                        self.guess(w, triangles, around, known);
                        self.visit(w, known);
                    }
                    (Some(w), Some(_)) => next = next.or(Some(w)),
                    _ => {}
                }
            }
            let Some(w) = next else { return };
            if !known[w as usize] {
                self.guess(w, triangles, around, known);
                self.visit(w, known);
            }
        }
    }

    fn visit(&mut self, v: u32, known: &mut [bool]) {
        known[v as usize] = true;
        self.order.push(v);
        self.ends.push(self.terms.len() as u32);
    }

    /// Collects the guesses for `w`: parallelograms, or else its known neighbours.
    fn guess(&mut self, w: u32, triangles: &[[u32; 3]], around: &Incidence, known: &[bool]) {
        let start = self.terms.len();
        let mut neighbours = Vec::new();
        for &t in around.of(w) {
            let [a, b] = others(triangles[t as usize], w);
            neighbours.extend([a, b].into_iter().filter(|&v| known[v as usize]));
            if !(known[a as usize] && known[b as usize]) {
                continue;
            }
            for &u in around.of(a) {
                let across = triangles[u as usize];
                if u != t && across.contains(&b) && !across.contains(&w) {
                    let c = across.into_iter().find(|&v| v != a && v != b).unwrap_or(a);
                    if known[c as usize] {
                        self.terms.push([a, b, c]);
                    }
                }
            }
        }
        if self.terms.len() == start {
            self.terms.extend(neighbours.into_iter().map(|v| [v, v, v]));
        }
    }
}

fn others(triangle: [u32; 3], w: u32) -> [u32; 2] {
    match triangle {
        [a, b, c] if a == w => [b, c],
        [a, b, c] if b == w => [c, a],
        [a, b, _] => [a, b],
    }
}

/// The triangles at each vertex.
struct Incidence {
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl Incidence {
    fn new(vertices: usize, triangles: &[[u32; 3]]) -> Self {
        let mut starts = vec![0u32; vertices + 1];
        for &v in triangles.iter().flatten() {
            starts[v as usize + 1] += 1;
        }
        for v in 0..vertices {
            starts[v + 1] += starts[v];
        }
        let mut next = starts.clone();
        let mut list = vec![0u32; 3 * triangles.len()];
        for (t, triangle) in triangles.iter().enumerate() {
            for &v in triangle {
                list[next[v as usize] as usize] = t as u32;
                next[v as usize] += 1;
            }
        }
        Self { starts, triangles: list }
    }

    fn of(&self, v: u32) -> &[u32] {
        &self.triangles[self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_vertex_is_visited_once_and_a_plane_is_guessed_exactly() {
        let (w, h) = (9u32, 7u32);
        let mut triangles = Vec::new();
        for y in 0..h - 1 {
            for x in 0..w - 1 {
                let v = y * w + x;
                triangles.extend([[v, v + 1, v + w + 1], [v, v + w + 1, v + w]]);
            }
        }
        // Two more vertices that no triangle knows.
        let n = (w * h) as usize + 2;
        let prediction = Prediction::new(n, &triangles);
        let mut sorted = prediction.order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..n as u32).collect::<Vec<_>>());

        let value = |v: i32| 40 * (v % w as i32) - 7 * (v / w as i32);
        let values: Vec<[i32; 3]> = (0..n as i32).map(|v| [value(v), -value(v), v % 5]).collect();
        let wrong = (0..n)
            .filter(|&i| {
                prediction.at(i, &values)[..2] != values[prediction.order[i] as usize][..2]
            })
            .count();
        // Only the first vertices of the sheet and the two loose ones have no parallelogram.
        assert!(wrong <= 8, "{wrong}");
    }
}
