//! Where nodes put their meshes: 4 x 4 matrices in f64, column-major like glTF's.

use gltf_json::Node;

/// An affine map, as columns x, y, z and translation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Transform {
    columns: [[f64; 3]; 4],
}

impl Transform {
    /// Leaves everything in place.
    pub const IDENTITY: Self =
        Self { columns: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]] };

    /// The map of a 4 x 4 matrix whose last row is 0 0 0 1.
    pub fn of_matrix(m: &[f32; 16]) -> Self {
        let columns = std::array::from_fn(|c| std::array::from_fn(|r| f64::from(m[4 * c + r])));
        Self { columns }
    }

    /// The weighted sum of maps, as linear blend skinning takes it.
    pub fn blend<'a>(parts: impl Iterator<Item = (f64, &'a Self)>) -> Self {
        let mut columns = [[0.0; 3]; 4];
        for (weight, part) in parts {
            for (sum, column) in columns.iter_mut().flatten().zip(part.columns.iter().flatten()) {
                *sum += weight * column;
            }
        }
        Self { columns }
    }

    /// Parent-from-node; `None` when an entry is not finite.
    pub fn of_node(node: &Node) -> Option<Self> {
        let columns = match &node.matrix {
            Some(m) => std::array::from_fn(|c| std::array::from_fn(|r| f64::from(m[4 * c + r]))),
            None => {
                let [x, y, z, w] =
                    node.rotation.map_or([0.0, 0.0, 0.0, 1.0], |q| q.0.map(f64::from));
                let s = node.scale.map_or([1.0; 3], |s| s.map(f64::from));
                let t = node.translation.map_or([0.0; 3], |t| t.map(f64::from));
                let rotation = [
                    [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)],
                    [2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)],
                    [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)],
                ];
                let scaled = |c: usize| rotation[c].map(|r| r * s[c]);
                [scaled(0), scaled(1), scaled(2), t]
            }
        };
        let finite = columns.iter().flatten().all(|x: &f64| x.is_finite());
        finite.then_some(Self { columns })
    }

    /// World-from-inner, for `self` = world-from-outer and `inner` = outer-from-inner.
    pub fn then(&self, inner: &Self) -> Self {
        let c = &inner.columns;
        let origin = self.direction(c[3]);
        Self {
            columns: [
                self.direction(c[0]),
                self.direction(c[1]),
                self.direction(c[2]),
                std::array::from_fn(|a| origin[a] + self.columns[3][a]),
            ],
        }
    }

    /// The linear part alone, as displacements need it.
    pub fn direction(&self, v: [f64; 3]) -> [f64; 3] {
        let c = &self.columns;
        std::array::from_fn(|a| c[0][a] * v[0] + c[1][a] * v[1] + c[2][a] * v[2])
    }

    /// A position.
    pub fn point(&self, p: [f64; 3]) -> [f64; 3] {
        let d = self.direction(p);
        std::array::from_fn(|a| d[a] + self.columns[3][a])
    }

    /// Whether it turns the inside out, so that triangles change their winding.
    pub fn mirrors(&self) -> bool {
        let [x, y, z, _] = self.columns;
        let det = x[0] * (y[1] * z[2] - y[2] * z[1]) - x[1] * (y[0] * z[2] - y[2] * z[0])
            + x[2] * (y[0] * z[1] - y[1] * z[0]);
        det < 0.0
    }
}
