//! The expected error over the markers of a layout in their order, followed while one of them is moved: what a
//! page draws beside a face.

use mimique_solver::{Criterion, Greedy, MarkerUnit, SkinGradients};

use crate::motion::FaceMotion;

/// sqrt(tr(G S)) after each marker of a layout, without any take: some microseconds per marker.
///
/// It keeps what is known after each marker, so that moving marker k costs the markers from k on.
#[derive(Debug, Clone)]
pub struct ExpectedCurve {
    noise: f64,
    slip: f64,
    gram: Vec<f64>,
    moment: Vec<f64>,
    /// What is known before any marker, after the first, and so on: N x N each.
    known: Vec<Vec<f64>>,
    vertices: Vec<usize>,
    units: Vec<MarkerUnit>,
}

impl ExpectedCurve {
    /// Of no marker yet; `noise` and `slip` are standard deviations, metres.
    pub fn new(motion: &FaceMotion, noise: f64, slip: f64) -> Self {
        Self {
            noise,
            slip,
            gram: motion.basis.gram.clone(),
            moment: motion.second_moment(),
            known: vec![motion.prior()],
            vertices: Vec::new(),
            units: Vec::new(),
        }
    }

    /// The curve of these vertices of a skin: expected root mean square error of a vertex before any marker, after the
    /// first, and so on, metres. Vertices that are the same as at the last call cost nothing.
    pub fn of(
        &mut self,
        gradients: &SkinGradients,
        motion: &FaceMotion,
        vertices: &[usize],
    ) -> Vec<f64> {
        let same = self.vertices.iter().zip(vertices).take_while(|(a, b)| a == b).count();
        self.known.truncate(same + 1);
        self.vertices.truncate(same);
        self.units.truncate(same);
        for &v in &vertices[same..] {
            let unit = MarkerUnit {
                deltas: motion.basis.of(v).to_vec(),
                covariances: vec![gradients.measurement_covariance(
                    v,
                    &motion.basis.deltas,
                    &self.moment,
                    [self.noise, self.slip],
                )],
            };
            let before = &self.known[self.known.len() - 1];
            let mut greedy =
                Greedy::new(std::slice::from_ref(&unit), before, Criterion::Information);
            greedy.take(0);
            self.known.push(greedy.covariance().to_vec());
            self.vertices.push(v);
            self.units.push(unit);
        }
        self.known.iter().map(|known| self.square(known).max(0.0).sqrt()).collect()
    }

    /// The expected error without each marker, all others there, metres: in the order of the markers.
    pub fn without_each(&self) -> Vec<f64> {
        let criterion = Criterion::ExpectedError(self.gram.clone());
        let greedy = Greedy::new(&self.units, self.covariance(), criterion);
        let square = self.square(self.covariance());
        (0..self.units.len()).map(|unit| (square + greedy.loss(unit)).max(0.0).sqrt()).collect()
    }

    /// tr(G S).
    fn square(&self, known: &[f64]) -> f64 {
        self.gram.iter().zip(known).map(|(g, s)| g * s).sum()
    }

    /// What is known of the weights with all markers, N x N.
    pub fn covariance(&self) -> &[f64] {
        &self.known[self.known.len() - 1]
    }
}
