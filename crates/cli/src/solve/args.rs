//! The options of `mimique solve`.

use std::path::PathBuf;

use mimique_stimulus::Depth;

use super::values::{Factors, Length, Named, Pair, Span};

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Avatar with blendshapes: .glb or .gltf
    #[arg(long, value_name = "FILE")]
    pub(super) avatar: PathBuf,
    /// Capture: C3D, TRC, CSV...; for recorded the weights: Live Link Face, or CSV
    #[arg(long, value_name = "FILE")]
    pub(super) mocap: PathBuf,
    /// Marker map: JSON, or CSV with marker,role,vertex (not for recorded)
    #[arg(long, value_name = "FILE")]
    pub(super) markers: Option<PathBuf>,
    /// Where the weights go: CSV with frame,time and a column a shape; for thin-shell-surface the
    /// columns are LABEL.x, LABEL.y, LABEL.z, the way of each marker's vertex in centimetres
    #[arg(long, value_name = "FILE")]
    pub(super) out: PathBuf,
    /// Where the report goes: JSON with residual, iterations and KKT error of every frame
    #[arg(long, value_name = "FILE")]
    pub(super) report: Option<PathBuf>,
    /// Where the positions of the skin's vertices go: NumPy, frames x vertices x 3, metres, the
    /// vertices in the file's order
    #[arg(long, value_name = "FILE.npy")]
    pub(super) vertices: Option<PathBuf>,
    /// lsts, lsts-soft, lsts-norm, lsts-short, thesis-literal, short-literal, bounds-only,
    /// thin-shell-only, box, nnls, pseudo-inverse, kouadio, thin-shell-surface, regression or
    /// recorded
    #[arg(long, default_value = "lsts")]
    pub(super) method: String,
    /// Method and all its parameters as JSON, as the studio saves them, instead of the options below
    /// that say one parameter each
    #[arg(long, value_name = "FILE.json", conflicts_with_all = [
        "method", "alpha", "kappa", "k_s", "k_b", "s", "soft_bounds", "eps", "unit", "laplacian",
        "association", "sigma", "bounds_weight", "stiffness", "hold", "inference", "basis_vectors",
        "length_scale", "signal", "noise", "head_lowpass", "lock", "bounds", "importance",
    ])]
    pub(super) settings: Option<PathBuf>,
    /// Weight of the thin shell against the bounds, 0 to 1 (by default 0.3 for lsts, else 0.5)
    #[arg(long)]
    pub(super) alpha: Option<f64>,
    /// Weight of the priors against the data [default: 0.1]
    #[arg(long)]
    pub(super) kappa: Option<f64>,
    /// Resistance to stretching [default: 1]
    #[arg(long)]
    pub(super) k_s: Option<f64>,
    /// Resistance to bending [default: 1]
    #[arg(long)]
    pub(super) k_b: Option<f64>,
    /// Smoothing of the soft bounds [default: 0.1]
    #[arg(long)]
    pub(super) s: Option<f64>,
    /// Where the soft bounds begin, as LOW:HIGH [default: -0.1:1.1]
    #[arg(long, value_name = "LOW:HIGH", allow_hyphen_values = true)]
    pub(super) soft_bounds: Option<Pair>,
    /// Smoothing of the norms: in units of l, for literal forms in --unit
    #[arg(long)]
    pub(super) eps: Option<f64>,
    /// Unit of the literal forms: m, cm or mm [default: mm]
    #[arg(long)]
    pub(super) unit: Option<String>,
    /// uniform, umbrella, cotan-clamped or cotan-literal [default: uniform]
    #[arg(long)]
    pub(super) laplacian: Option<String>,
    /// Points of the face that a marker moves, in kouadio: points, zones or triangles
    /// [default: zones]
    #[arg(long)]
    pub(super) association: Option<String>,
    /// Radius of kouadio's zones, with its unit [default: 12mm]
    #[arg(long)]
    pub(super) sigma: Option<Length>,
    /// Weight of the bounds in bounds-only [default: 0.001]
    #[arg(long)]
    pub(super) bounds_weight: Option<f64>,
    /// How far the surface may leave its markers to be smoother (thin-shell-surface) [default: 0]
    #[arg(long)]
    pub(super) stiffness: Option<f64>,
    /// What of the surface rests: unmoved (by every shape) or nothing [default: unmoved]
    #[arg(long)]
    pub(super) hold: Option<String>,
    /// Range-of-motion take that regression learns from
    #[arg(long, value_name = "FILE", requires = "training_weights")]
    pub(super) training: Option<PathBuf>,
    /// Weights played in it: CSV or Live Link Face, a row a frame
    #[arg(long, value_name = "FILE", requires = "training")]
    pub(super) training_weights: Option<PathBuf>,
    /// Neutral frames of the training take [default: 0:60]
    #[arg(long, value_name = "FIRST:END", requires = "training")]
    pub(super) training_neutral: Option<Span>,
    /// How regression learns: sparse or exact [default: sparse]
    #[arg(long)]
    pub(super) inference: Option<String>,
    /// Most basis vectors of the sparse process [default: 200]
    #[arg(long)]
    pub(super) basis_vectors: Option<u32>,
    /// Length scale of the kernel [default: by the marginal likelihood]
    #[arg(long)]
    pub(super) length_scale: Option<f64>,
    /// Standard deviation of the process, in weights [default: by the marginal likelihood]
    #[arg(long)]
    pub(super) signal: Option<f64>,
    /// Standard deviation of the noise on the training weights [default: by the marginal likelihood]
    #[arg(long)]
    pub(super) noise: Option<f64>,
    /// Cut-off of the zero-phase low-pass of the head's pose, Hz [default: no filter]
    #[arg(long, value_name = "HZ")]
    pub(super) head_lowpass: Option<f64>,
    /// Shapes held at 0
    #[arg(long, value_name = "SHAPE,SHAPE", value_delimiter = ',')]
    pub(super) lock: Vec<String>,
    /// Bounds of one shape; may be given again
    #[arg(long, value_name = "SHAPE=LOW:HIGH", allow_hyphen_values = true)]
    pub(super) bounds: Vec<Named<Pair>>,
    /// Importance of one marker, 1 if not given; may be given again
    #[arg(long, value_name = "MARKER=NUMBER")]
    pub(super) importance: Vec<Named<f64>>,
    /// Frames of the neutral face, counted from 0, END not included (by default the map's, or 0:60)
    #[arg(long, value_name = "FIRST:END")]
    pub(super) neutral: Option<Span>,
    /// Markers that move rigidly with the head (by default the map's)
    #[arg(long, value_name = "LABEL,LABEL,LABEL", value_delimiter = ',')]
    pub(super) head: Option<Vec<String>>,
    /// Frames of the range of motion that automatic scale factors come from (Kouadio 5.3)
    #[arg(long, value_name = "FIRST:END")]
    pub(super) scale_automatic: Option<Span>,
    /// Scale factor of one marker's displacements; may be given again
    #[arg(long, value_name = "MARKER=S or MARKER=X,Y,Z")]
    pub(super) scale: Vec<Named<Factors>>,
    /// Scale factor of all markers' displacements
    #[arg(long, value_name = "S or X,Y,Z")]
    pub(super) scale_global: Option<Factors>,
    /// Third coordinate: measured, or surface for a two-dimensional capture (by default the map's)
    #[arg(long, value_name = "WORD")]
    pub(super) depth: Option<Depth>,
    /// Symmetric shapes to cut into NAME_L and NAME_R along the face's middle (Kouadio 4.5)
    #[arg(long, value_name = "SHAPE,SHAPE", value_delimiter = ',')]
    pub(super) split: Vec<String>,
    /// Unit of the capture where its file does not say: m, cm or mm
    #[arg(long, value_name = "UNIT")]
    pub(super) mocap_unit: Option<String>,
    /// Frames a second of the capture where its file does not say
    #[arg(long, value_name = "HZ")]
    pub(super) mocap_rate: Option<f64>,
}
