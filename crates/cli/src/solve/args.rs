//! The options of `mimique solve`.

use std::path::PathBuf;

use mimique_solver::Method;
use mimique_stimulus::Depth;

use super::parameter_options::ParameterOptions;
use super::values::{Angles, Factors, Named, Span};

/// The heading of what regression learns from.
const TRAINING: &str = "Training of regression";
/// The heading of what is known of the capture.
const CAPTURE: &str = "Capture and avatar";

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Avatar with blendshapes: .glb or .gltf
    #[arg(long, value_name = "FILE")]
    pub(super) avatar: PathBuf,
    /// Capture: C3D, TRC, CSV...; for recorded the weights: Live Link Face, CSV, MediaPipe, OpenFace..., or a GLB
    /// with an animation
    #[arg(long, value_name = "FILE")]
    pub(super) mocap: PathBuf,
    /// Marker map: JSON, or CSV with marker,role,vertex (not for recorded)
    #[arg(long, value_name = "FILE")]
    pub(super) markers: Option<PathBuf>,
    /// Where the weights go: .csv with frame,time and a column per shape, .npy with names and rate in
    /// NAME.shapes.json beside it, .livelink.csv as Live Link Face writes it, or .json under ARKit's names;
    /// for thin-shell-surface the
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
    /// The method
    #[arg(long, value_name = "NAME", default_value = "lsts", help = method_help())]
    pub(super) method: String,
    /// Method and all its parameters as JSON, as the studio saves them, instead of the options below
    /// that say one parameter each
    #[arg(long, value_name = "FILE.json", conflicts_with = "method")]
    pub(super) settings: Option<PathBuf>,
    /// Range-of-motion take that regression learns from
    #[arg(long, value_name = "FILE", requires = "training_weights", help_heading = TRAINING)]
    pub(super) training: Option<PathBuf>,
    /// Weights played in it: CSV or Live Link Face, one row per frame
    #[arg(long, value_name = "FILE", requires = "training", help_heading = TRAINING)]
    pub(super) training_weights: Option<PathBuf>,
    /// Neutral frames of the training take [default: 0:60]
    #[arg(long, value_name = "FIRST:END", requires = "training", help_heading = TRAINING)]
    pub(super) training_neutral: Option<Span>,
    /// Frames of the neutral face, counted from 0, END not included (by default the map's, or the stillest second)
    #[arg(long, help_heading = CAPTURE, value_name = "FIRST:END")]
    pub(super) neutral: Option<Span>,
    /// Markers that move rigidly with the head (by default the map's)
    #[arg(long, help_heading = CAPTURE, value_name = "LABEL,LABEL,LABEL", value_delimiter = ',')]
    pub(super) head: Option<Vec<String>>,
    /// Frames of the range of motion that automatic scale factors come from (Kouadio 5.3)
    #[arg(long, help_heading = CAPTURE, value_name = "FIRST:END")]
    pub(super) scale_automatic: Option<Span>,
    /// Scale factor of one marker's displacements; may be given again
    #[arg(long, help_heading = CAPTURE, value_name = "MARKER=S or MARKER=X,Y,Z")]
    pub(super) scale: Vec<Named<Factors>>,
    /// Scale factor of all markers' displacements
    #[arg(long, help_heading = CAPTURE, value_name = "S or X,Y,Z")]
    pub(super) scale_global: Option<Factors>,
    /// Third coordinate: measured, or surface for a two-dimensional capture (by default the map's)
    #[arg(long, help_heading = CAPTURE, value_name = "WORD")]
    pub(super) depth: Option<Depth>,
    /// Where the eyes look: a table of time, azimuth, elevation and vergence in degrees, to the person's left,
    /// upwards and converging above 0, or recorded weights with eyeLook shapes (by default the eyes rest)
    #[arg(long, help_heading = CAPTURE, value_name = "FILE")]
    pub(super) gaze_track: Option<PathBuf>,
    /// How many seconds after the clock of --gaze-track the capture begins
    #[arg(long, help_heading = CAPTURE, value_name = "SECONDS", requires = "gaze_track", allow_negative_numbers = true)]
    pub(super) gaze_later: Option<f64>,
    /// Where the eyes look throughout, degrees: azimuth to the person's left, elevation, vergence
    #[arg(long, help_heading = CAPTURE, value_name = "AZIMUTH,ELEVATION[,VERGENCE]", conflicts_with = "gaze_track", allow_hyphen_values = true)]
    pub(super) gaze_held: Option<Angles>,
    /// Marker of the capture at what the eyes look at
    #[arg(long, help_heading = CAPTURE, value_name = "MARKER", conflicts_with_all = ["gaze_track", "gaze_held"])]
    pub(super) gaze_target: Option<String>,
    /// Symmetric shapes to cut into NAME_L and NAME_R along the face's middle (Kouadio 4.5)
    #[arg(long, help_heading = CAPTURE, value_name = "SHAPE,SHAPE", value_delimiter = ',')]
    pub(super) split: Vec<String>,
    /// Unit of the capture where its file does not say: m, cm or mm
    #[arg(long, help_heading = CAPTURE, value_name = "UNIT")]
    pub(super) mocap_unit: Option<String>,
    /// Frames a second of the capture where its file does not say
    #[arg(long, help_heading = CAPTURE, value_name = "HZ")]
    pub(super) mocap_rate: Option<f64>,
    /// Which animation of a GLB or glTF file of weights, by its name or its number counted from 1 (method recorded)
    #[arg(long, help_heading = CAPTURE, value_name = "NAME")]
    pub(super) animation: Option<String>,
    /// The parameters of the method
    #[command(flatten)]
    pub(super) parameters: ParameterOptions,
}

/// The methods with what they minimise.
fn method_help() -> String {
    let methods = Method::ALL.map(|method| format!("{method}: {}", method.summary()));
    format!("The method:\n  {}\n", methods.join("\n  "))
}
