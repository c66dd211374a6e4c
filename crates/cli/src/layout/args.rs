//! The options of `mimique layout`.

use std::path::PathBuf;

use mimique_layout::{Excluded, Method};

use super::values::{CameraValue, Counts};
use crate::solve::{Length, Named};

const MOTION: &str = "Motion";
const PLACES: &str = "Where markers may be";
const JUDGING: &str = "How layouts are judged";
const SHEET: &str = "Placement sheet";

/// Options.
#[derive(clap::Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct Args {
    #[command(subcommand)]
    pub(super) command: Option<Command>,
    #[command(flatten)]
    pub(super) make: Make,
}

/// What else there is to do with layouts.
#[derive(clap::Subcommand)]
pub(super) enum Command {
    /// Tell what a marker map cannot see: shapes, parts of the face, millimetres
    Check(super::check::Args),
}

/// Options of a layout that is made.
#[derive(clap::Args)]
pub(super) struct Make {
    /// Avatar with blendshapes: .glb or .gltf
    #[arg(long, value_name = "FILE", required = true)]
    pub(super) avatar: Option<PathBuf>,
    /// How many face markers: a number, or a range of which the least number is taken that is enough
    /// (steps of its own, or FIRST..LAST:STEP)
    #[arg(long, value_name = "40 or 10..100", required = true)]
    pub(super) markers: Option<Counts>,
    /// Where the layout goes: a marker map that solve reads
    #[arg(long, value_name = "FILE.json", required = true)]
    pub(super) out: Option<PathBuf>,
    /// How places are chosen: rehearse (tried in simulated takes), kmeans (thesis 3.6), greedy (expected
    /// error), qr (pivoted QR), shell (thin-shell surface), farthest (distance alone), reduce (thin the map of
    /// --keep, else MPEG-4's and Face Robot's points)
    #[arg(long, value_name = "NAME", default_value = "rehearse")]
    pub(super) method: Method,
    /// K-means as printed: any place of the face, single markers, no distance
    #[arg(long, conflicts_with_all = ["method", "symmetric", "exclude", "min_distance", "diameter", "keep"])]
    pub(super) as_thesis: bool,
    /// Seed of everything that is drawn
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub(super) seed: u64,
    /// Mirrored pairs and markers in the middle (the default)
    #[arg(long, conflicts_with = "free")]
    pub(super) symmetric: bool,
    /// Single markers, whatever is on the other side
    #[arg(long)]
    pub(super) free: bool,

    /// Range of motion as weights: CSV, Live Link Face, NumPy, or a GLB with an animation; may be given again,
    /// once a person. Without --rom and --take every shape counts by itself
    #[arg(long, value_name = "FILE", help_heading = MOTION)]
    pub(super) rom: Vec<PathBuf>,
    /// Dense take: NumPy, frames x vertices x 3, metres, as solve --vertices writes; may be given again
    #[arg(long, value_name = "FILE.npy", help_heading = MOTION)]
    pub(super) take: Vec<PathBuf>,
    /// Frames a second of takes whose files do not say
    #[arg(long, value_name = "HZ", help_heading = MOTION)]
    pub(super) rate: Option<f64>,

    /// Least distance of two markers, on the neutral face and in motion [default: 8mm]
    #[arg(long, value_name = "LENGTH", conflicts_with = "diameter", help_heading = PLACES)]
    pub(super) min_distance: Option<Length>,
    /// Diameter of the markers: they keep two of it, and three pixels between them
    #[arg(long, value_name = "LENGTH", help_heading = PLACES)]
    pub(super) diameter: Option<Length>,
    /// Camera: distance, focal length, size of a pixel
    #[arg(long, value_name = "1.5m,16mm,5.5um", requires = "diameter", help_heading = PLACES)]
    pub(super) camera: Option<CameraValue>,
    /// Frames a second of the capture, to warn where a marker could jump to its neighbour's place
    #[arg(long, value_name = "HZ", help_heading = PLACES)]
    pub(super) capture_rate: Option<f64>,
    /// Parts that stay free of markers, or none
    #[arg(long, value_name = "PART,PART", value_delimiter = ',', help_heading = PLACES,
        default_value = "lids,lips-inner,nostrils,ears,neck,hair")]
    pub(super) exclude: Vec<ExcludedOrNone>,
    /// Region: JSON {"vertices": [...]} of the avatar file's vertices that may have markers, {"without": [...]}
    /// of those that may not
    #[arg(long, value_name = "FILE.json", help_heading = PLACES)]
    pub(super) region: Option<PathBuf>,
    /// Marker map whose markers stay; with --method reduce the map that is thinned
    #[arg(long, value_name = "MAP", help_heading = PLACES)]
    pub(super) keep: Option<PathBuf>,
    /// Head markers, on skin that moves less than 0.2 mm; 0 for none
    #[arg(long, value_name = "NUMBER", default_value_t = 6, help_heading = PLACES)]
    pub(super) head: usize,

    /// Sensor noise of a marker, standard deviation
    #[arg(long, value_name = "LENGTH", default_value = "0.1mm", help_heading = JUDGING)]
    pub(super) noise: Length,
    /// How far beside its place a marker is put, standard deviation along each direction of the skin
    #[arg(long, value_name = "LENGTH", default_value = "1.5mm", help_heading = JUDGING)]
    pub(super) slip: Length,
    /// Methods that layouts are solved by; the first one is rehearsed with
    #[arg(long, value_name = "NAME,NAME", value_delimiter = ',', default_value = "lsts", help_heading = JUDGING)]
    pub(super) solve: Vec<String>,
    /// rbfSmoothing that layouts are rehearsed with
    #[arg(long, value_name = "NUMBER", default_value_t = 0.1, help_heading = JUDGING)]
    pub(super) smoothing: f64,
    /// Marker map to compare with; may be given again
    #[arg(long, value_name = "NAME=MAP", help_heading = JUDGING)]
    pub(super) compare: Vec<Named<PathBuf>>,
    /// Error of a vertex that is good enough: of a range the least number of markers that reaches it is taken
    #[arg(long, value_name = "LENGTH", help_heading = JUDGING)]
    pub(super) wanted_error: Option<Length>,
    /// Folder for report.html with the curves, figures, tables as CSV, and results.json
    #[arg(long, value_name = "FOLDER", help_heading = JUDGING)]
    pub(super) report: Option<PathBuf>,

    /// Sheet to lay beside the actor: .pdf or .svg, at the head's own size
    #[arg(long, value_name = "FILE.pdf", help_heading = SHEET)]
    pub(super) sheet: Option<PathBuf>,
    /// Breadth of the actor's face between the cheekbones (by default the avatar's)
    #[arg(long, value_name = "LENGTH", help_heading = SHEET)]
    pub(super) face_width: Option<Length>,
    /// Height of the actor's face from nasion to chin
    #[arg(long, value_name = "LENGTH", help_heading = SHEET)]
    pub(super) face_height: Option<Length>,
}

/// A part of the face, or `none`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ExcludedOrNone(pub(super) Option<Excluded>);

impl std::str::FromStr for ExcludedOrNone {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        match word {
            "none" => Ok(Self(None)),
            other => other.parse().map(|region| Self(Some(region))),
        }
    }
}
