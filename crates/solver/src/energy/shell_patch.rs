//! A run of consecutive vertices with the two rings around it: what its rows of AB depend on.
//!
//! AB = -k_s L B + k_b L (L B) (eq. 5.29): a row needs B two rings around its vertex. Patches are
//! made one at a time and forgotten, so that memory does not grow with the mesh.

use std::ops::Range;

use mimique_geometry::Displacement;

use crate::linear_algebra::dense::widest;
use crate::mesh::laplacian::Laplacian;
use crate::mesh::skin_mesh::SkinMesh;

/// For each vertex where its deltas are: entries (shape, index in the shape's list), shapes
/// ascending.
pub(crate) struct DeltasByVertex {
    starts: Vec<usize>,
    entries: Vec<(u32, u32)>,
}

/// The patch's part of B and L B, in columns of its own: the shapes that move any of it.
///
/// A row has three axes of `padded` numbers each; columns beyond the shapes are 0.
pub(crate) struct ShellPatch<'a> {
    laplacian: &'a Laplacian,
    vertices: Range<usize>,
    /// The vertices outside that the patch touches, ascending.
    ring: Vec<u32>,
    /// The shapes of the columns, ascending.
    pub(crate) shapes: Vec<usize>,
    /// Numbers of an axis: the columns, filled up to a multiple of four.
    pub(crate) padded: usize,
    /// L B of the vertices, then of the ring.
    first: Vec<f64>,
}

impl DeltasByVertex {
    pub(crate) fn new(mesh: &SkinMesh) -> DeltasByVertex {
        let count = mesh.positions.len();
        let mut starts = vec![0_usize; count + 1];
        for &v in mesh.shapes.iter().flat_map(|s| &s.vertices) {
            starts[v as usize + 1] += 1;
        }
        for i in 0..count {
            starts[i + 1] += starts[i];
        }
        let mut entries = vec![(0, 0); starts[count]];
        let mut next = starts.clone();
        for (shape, deltas) in mesh.shapes.iter().enumerate() {
            for (at, &v) in deltas.vertices.iter().enumerate() {
                entries[next[v as usize]] = (shape as u32, at as u32);
                next[v as usize] += 1;
            }
        }
        DeltasByVertex { starts, entries }
    }

    fn row(&self, vertex: usize) -> &[(u32, u32)] {
        &self.entries[self.starts[vertex]..self.starts[vertex + 1]]
    }
}

impl<'a> ShellPatch<'a> {
    /// None where no shape moves anything near.
    pub(crate) fn new(
        mesh: &SkinMesh,
        deltas: &DeltasByVertex,
        laplacian: &'a Laplacian,
        vertices: Range<usize>,
    ) -> Option<ShellPatch<'a>> {
        let ring = outside(laplacian, vertices.clone(), &vertices, &[]);
        let far = outside(laplacian, ring.iter().map(|&v| v as usize), &vertices, &ring);
        let around = || ring.iter().chain(&far).map(|&v| v as usize);

        // The entries of each shape at the patch's own vertices stand side by side in its list.
        let own: Vec<Range<usize>> = (mesh.shapes.iter())
            .map(|s| {
                let first_from = |end: usize| s.vertices.partition_point(|&v| (v as usize) < end);
                first_from(vertices.start)..first_from(vertices.end)
            })
            .collect();
        let mut moves: Vec<bool> = own.iter().map(|entries| !entries.is_empty()).collect();
        for &(shape, _) in around().flat_map(|v| deltas.row(v)) {
            moves[shape as usize] = true;
        }
        let shapes: Vec<usize> = (0..mesh.shapes.len()).filter(|&k| moves[k]).collect();
        if shapes.is_empty() {
            return None;
        }
        let mut column_of = vec![0; mesh.shapes.len()];
        for (column, &shape) in shapes.iter().enumerate() {
            column_of[shape] = column;
        }
        let padded = shapes.len().next_multiple_of(4);
        let width = 3 * padded;

        let mut b = vec![0.0; (vertices.len() + ring.len() + far.len()) * width];
        let (b_own, b_around) = b.split_at_mut(vertices.len() * width);
        for (column, &shape) in shapes.iter().enumerate() {
            let list = &mesh.shapes[shape];
            let entries = own[shape].clone();
            for (&v, &delta) in list.vertices[entries.clone()].iter().zip(&list.deltas[entries]) {
                put(delta, column, padded, &mut b_own[(v as usize - vertices.start) * width..]);
            }
        }
        for (v, row) in around().zip(b_around.chunks_exact_mut(width)) {
            for &(shape, at) in deltas.row(v) {
                let delta = mesh.shapes[shape as usize].deltas[at as usize];
                put(delta, column_of[shape as usize], padded, row);
            }
        }

        let mut first = vec![0.0; (vertices.len() + ring.len()) * width];
        let rows = vertices.clone().chain(ring.iter().map(|&v| v as usize));
        for ((i, out), here) in rows.zip(first.chunks_exact_mut(width)).zip(b.chunks_exact(width)) {
            let mut neighbours = laplacian.row(i).map(|(j, w)| {
                let at = place(j, &vertices, &ring, &far);
                (w, &b[at * width..(at + 1) * width])
            });
            while let Some(one) = neighbours.next() {
                match neighbours.next() {
                    Some(two) => add_two_differences(one, two, here, out),
                    None => add_difference(one, here, out),
                }
            }
        }
        Some(ShellPatch { laplacian, vertices, ring, shapes, padded, first })
    }

    /// The row of AB of one vertex of the patch: 3 `padded` numbers.
    pub(crate) fn ab_row(&self, vertex: usize, k_s: f64, k_b: f64, out: &mut [f64]) {
        let width = 3 * self.padded;
        let first = |at: usize| &self.first[at * width..(at + 1) * width];
        let here = first(vertex - self.vertices.start);
        for (o, h) in out.iter_mut().zip(here) {
            *o = -k_s * h;
        }
        let mut neighbours = self
            .laplacian
            .row(vertex)
            .map(|(j, w)| (k_b * w, first(place(j, &self.vertices, &self.ring, &[]))));
        while let Some(one) = neighbours.next() {
            match neighbours.next() {
                Some(two) => add_two_changes(one, two, here, out),
                None => add_change(one, here, out),
            }
        }
    }
}

/// A displacement into its column of a row.
fn put(delta: Displacement, column: usize, padded: usize, row: &mut [f64]) {
    for (axis, x) in delta.to_array().into_iter().enumerate() {
        row[axis * padded + column] = x;
    }
}

/// The neighbours of `of` that are neither in `vertices` nor in `known`, ascending.
fn outside(
    laplacian: &Laplacian,
    of: impl Iterator<Item = usize>,
    vertices: &Range<usize>,
    known: &[u32],
) -> Vec<u32> {
    let mut found: Vec<u32> = of
        .flat_map(|v| laplacian.row(v))
        .filter(|(j, _)| !vertices.contains(j))
        .map(|(j, _)| j as u32)
        .filter(|j| known.binary_search(j).is_err())
        .collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// Where a vertex of the patch or its rings has its row.
fn place(vertex: usize, vertices: &Range<usize>, ring: &[u32], far: &[u32]) -> usize {
    if vertices.contains(&vertex) {
        return vertex - vertices.start;
    }
    let v = vertex as u32;
    vertices.len()
        + ring.binary_search(&v).unwrap_or_else(|_| ring.len() + far.partition_point(|&f| f < v))
}

widest! {
    /// out = (out + w there) - w here.
    fn add_difference(one: (f64, &[f64]), here: &[f64], out: &mut [f64]) {
        let (w, there) = one;
        for ((out, there), here) in out.iter_mut().zip(there).zip(here) {
            *out = (*out + w * there) - w * here;
        }
    }
}

widest! {
    /// [`add_difference`] of the one, then of the two.
    fn add_two_differences(one: (f64, &[f64]), two: (f64, &[f64]), here: &[f64], out: &mut [f64]) {
        let ((w, there), (v, yonder)) = (one, two);
        for (((out, there), yonder), here) in out.iter_mut().zip(there).zip(yonder).zip(here) {
            *out = (((*out + w * there) - w * here) + v * yonder) - v * here;
        }
    }
}

widest! {
    /// out += w (there - here).
    fn add_change(one: (f64, &[f64]), here: &[f64], out: &mut [f64]) {
        let (w, there) = one;
        for ((out, there), here) in out.iter_mut().zip(there).zip(here) {
            *out += w * (there - here);
        }
    }
}

widest! {
    /// [`add_change`] of the one, then of the two.
    fn add_two_changes(one: (f64, &[f64]), two: (f64, &[f64]), here: &[f64], out: &mut [f64]) {
        let ((w, there), (v, yonder)) = (one, two);
        for (((out, there), yonder), here) in out.iter_mut().zip(there).zip(yonder).zip(here) {
            *out = (*out + w * (there - here)) + v * (yonder - here);
        }
    }
}
