//! Whether an avatar's skin moves as the actor's markers do.

use mimique_solver::{MarkerSite, SkinMesh};
use serde::Serialize;

/// How the skin at a marker goes with the marker.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct MarkerCorrelation {
    /// The marker's label.
    pub label: String,
    /// Pearson's correlation of the displacements of skin and marker, the three coordinates one after the other,
    /// each about its own mean; none where one of them does not move, or fewer than three frames show the marker.
    pub r: Option<f64>,
}

/// The correlation of each marker's displacements with those of its place on the skin.
///
/// `displacements` are frames x 3P, metres, as the pipeline makes them of the capture, NaN where a marker is lost;
/// `weights` are frames x N.
///
/// # Panics
/// If the frames of displacements and weights are not the same.
pub fn marker_correlation(
    mesh: &SkinMesh,
    sites: &[MarkerSite],
    displacements: &[f64],
    weights: &[f64],
) -> Vec<MarkerCorrelation> {
    let n = mesh.shapes.len().max(1);
    let width = 3 * sites.len();
    assert_eq!(displacements.len() / width.max(1), weights.len() / n, "as many frames");
    sites
        .iter()
        .enumerate()
        .map(|(m, site)| {
            let deltas: Vec<_> = (0..mesh.shapes.len()).map(|k| site.delta(mesh, k)).collect();
            let mut sums = Sums::default();
            for axis in 0..3 {
                let own = displacements.chunks_exact(width).map(|row| row[3 * m + axis]);
                let skin = weights
                    .chunks_exact(n)
                    .map(|row| row.iter().zip(&deltas).map(|(w, d)| w * d[axis]).sum::<f64>());
                sums.add(own.zip(skin).filter(|(a, b)| a.is_finite() && b.is_finite()).collect());
            }
            MarkerCorrelation { label: site.label.clone(), r: sums.r() }
        })
        .collect()
}

/// Products of deviations from the mean, over the axes.
#[derive(Default)]
struct Sums {
    both: f64,
    marker: f64,
    skin: f64,
    frames: usize,
}

impl Sums {
    fn add(&mut self, pairs: Vec<(f64, f64)>) {
        let count = pairs.len().max(1) as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / count;
        let (a, b) = (mean(|pair| pair.0), mean(|pair| pair.1));
        for (marker, skin) in &pairs {
            self.both += (marker - a) * (skin - b);
            self.marker += (marker - a) * (marker - a);
            self.skin += (skin - b) * (skin - b);
        }
        self.frames = pairs.len();
    }

    fn r(&self) -> Option<f64> {
        let scale = (self.marker * self.skin).sqrt();
        (self.frames >= 3 && scale > 0.0).then(|| self.both / scale)
    }
}
