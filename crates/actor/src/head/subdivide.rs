//! Catmull-Clark subdivision (Catmull & Clark 1978) of quads with boundary. Topology is refined once;
//! then any number of channels (neutral, each blendshape) is refined by the same linear rule, which
//! keeps blendshapes exactly as smooth as the surface.

use super::vec3::Vec3;
use std::collections::BTreeMap;

/// One step of subdivision: where every finer vertex comes from.
pub(crate) struct Step {
    /// Finer quads; quad `f` of the input becomes quads `4f .. 4f + 4`.
    pub quads: Vec<[u32; 4]>,
    input_quads: Vec<[u32; 4]>,
    vertices: usize,
    /// Edges as (v0, v1, face or NONE, face or NONE).
    edges: Vec<(u32, u32, u32, u32)>,
    /// An input vertex: its faces and its edges.
    vertex_faces: Vec<Vec<u32>>,
    vertex_edges: Vec<Vec<u32>>,
}

const NONE: u32 = u32::MAX;

impl Step {
    pub(crate) fn new(vertices: usize, quads: &[[u32; 4]]) -> Step {
        let mut index = BTreeMap::new();
        let mut edges: Vec<(u32, u32, u32, u32)> = Vec::new();
        let mut face_edges = Vec::with_capacity(quads.len());
        let mut vertex_faces = vec![Vec::new(); vertices];
        let mut vertex_edges = vec![Vec::new(); vertices];
        for (f, quad) in quads.iter().enumerate() {
            let mut of_face = [0u32; 4];
            for k in 0..4 {
                let (a, b) = (quad[k], quad[(k + 1) % 4]);
                let e = *index.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    edges.push((a, b, NONE, NONE));
                    let e = (edges.len() - 1) as u32;
                    vertex_edges[a as usize].push(e);
                    vertex_edges[b as usize].push(e);
                    e
                });
                let edge = &mut edges[e as usize];
                if edge.2 == NONE {
                    edge.2 = f as u32;
                } else {
                    edge.3 = f as u32;
                }
                of_face[k] = e;
                vertex_faces[a as usize].push(f as u32);
            }
            face_edges.push(of_face);
        }
        let edge_base = vertices as u32;
        let face_base = edge_base + edges.len() as u32;
        let mut finer = Vec::with_capacity(quads.len() * 4);
        for (f, quad) in quads.iter().enumerate() {
            for k in 0..4 {
                let after = edge_base + face_edges[f][k];
                let before = edge_base + face_edges[f][(k + 3) % 4];
                finer.push([quad[k], after, face_base + f as u32, before]);
            }
        }
        Step {
            quads: finer,
            input_quads: quads.to_vec(),
            vertices,
            edges,
            vertex_faces,
            vertex_edges,
        }
    }

    /// Number of finer vertices.
    pub(crate) fn len(&self) -> usize {
        self.vertices + self.edges.len() + self.input_quads.len()
    }

    /// One channel of values on the finer vertices: input vertices, then edges, then faces.
    pub(crate) fn refine(&self, values: &[Vec3]) -> Vec<Vec3> {
        let at = |v: u32| values[v as usize];
        let faces: Vec<Vec3> = self
            .input_quads
            .iter()
            .map(|q| ((at(q[0]) + at(q[2])) + (at(q[1]) + at(q[3]))) * 0.25)
            .collect();
        let mut out = Vec::with_capacity(self.len());
        for (v, &p) in values.iter().enumerate().take(self.vertices) {
            let edges = &self.vertex_edges[v];
            let rim: Vec<u32> =
                edges.iter().copied().filter(|&e| self.edges[e as usize].3 == NONE).collect();
            let far = |e: u32| {
                let (a, b, _, _) = self.edges[e as usize];
                at(if a as usize == v { b } else { a })
            };
            if rim.len() == 2 {
                out.push(p * 0.75 + (far(rim[0]) + far(rim[1])) * 0.125);
                continue;
            }
            let n = edges.len() as f64;
            let mut around = Vec3::default();
            for &f in &self.vertex_faces[v] {
                around += faces[f as usize];
            }
            for &e in edges {
                around += far(e);
            }
            // (F + 2R + (n-3)P)/n with F the mean of face points and R the mean of edge midpoints.
            out.push(p * ((n - 2.0) / n) + around * (1.0 / (n * n)));
        }
        for &(a, b, f, g) in &self.edges {
            if g == NONE {
                out.push((at(a) + at(b)) * 0.5);
            } else {
                out.push(((at(a) + at(b)) + (faces[f as usize] + faces[g as usize])) * 0.25);
            }
        }
        out.extend_from_slice(&faces);
        out
    }

    /// Where the surface's limit passes for each input vertex.
    pub(crate) fn limit(&self, values: &[Vec3]) -> Vec<Vec3> {
        let at = |v: u32| values[v as usize];
        (0..self.vertices)
            .map(|v| {
                let p = values[v];
                let edges = &self.vertex_edges[v];
                let far = |e: u32| {
                    let (a, b, _, _) = self.edges[e as usize];
                    at(if a as usize == v { b } else { a })
                };
                let rim: Vec<u32> =
                    edges.iter().copied().filter(|&e| self.edges[e as usize].3 == NONE).collect();
                if rim.len() == 2 {
                    return p * (2.0 / 3.0) + (far(rim[0]) + far(rim[1])) * (1.0 / 6.0);
                }
                let n = edges.len() as f64;
                // Halstead, Kass & DeRose 1993: weights n^2, 4 on edge neighbours, 1 on diagonals.
                let mut sum = p * (n * n);
                for &e in edges {
                    sum += far(e) * 4.0;
                }
                for &f in &self.vertex_faces[v] {
                    let q = self.input_quads[f as usize];
                    if let Some(k) = (0..4).find(|&k| q[k] as usize == v) {
                        sum += at(q[(k + 2) % 4]);
                    }
                }
                sum * (1.0 / (n * (n + 5.0)))
            })
            .collect()
    }
}
