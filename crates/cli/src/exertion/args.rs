//! The options of `mimique exertion`.

use std::path::PathBuf;

use mimique_exertion::FRAMES_PER_SECOND;
use mimique_study::BuiltinMotion;

use super::study::{Breath, activity};
use super::values::{Cutoff, Duration, Named, NamedExpressivity, Seconds};

/// The heading of what is known of the person.
const PERSON: &str = "Person";
/// The heading of what is known of the motion.
const MOTION: &str = "Motion";
/// The heading of the face.
const FACE: &str = "Face";

/// Options, or the command that trains.
#[derive(clap::Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct Args {
    #[command(subcommand)]
    pub(super) command: Option<Command>,
    #[command(flatten)]
    pub(super) options: Options,
}

/// What else there is.
#[derive(clap::Subcommand)]
pub(super) enum Command {
    /// Learn a model from recorded bodies, hearts and faces
    Train(Box<TrainOptions>),
    /// Write a study file: faces of walks, runs and sprints, of people of several levels and expressivities
    Study(Box<StudyOptions>),
}

/// Options of the face.
#[derive(clap::Args)]
pub struct Options {
    /// Motion (BVH, or any capture with a body's joints), or activity: FIT, TCX, GPX, CSV with time and
    /// power_w, work, speed, grade or heart_rate
    #[arg(required_unless_present = "plan")]
    pub(super) file: Option<PathBuf>,
    /// How long: a motion is repeated, an activity cut (300, 90s, 5min, 1h) [default: once]
    #[arg(long = "for", value_name = "DURATION", conflicts_with = "plan")]
    pub(super) duration: Option<Duration>,
    /// Parts one after the other instead: "rest 60, run.bvh 5min, work 12 60, ride.fit"; work is J/kg in a
    /// second
    #[arg(long, value_name = "PARTS", conflicts_with = "file")]
    pub(super) plan: Option<String>,
    /// Where the weights go: .csv with frame,time and a column per shape, or .npy
    #[arg(long, value_name = "FILE")]
    pub(super) out: Option<PathBuf>,
    /// Where the series goes: CSV, a row per second with work, heart, oxygen, breath, energy, EPOC, fatigue
    #[arg(long, value_name = "FILE")]
    pub(super) series: Option<PathBuf>,
    /// Where a figure of heart rate, EPOC and curves goes: SVG
    #[arg(long, value_name = "FILE")]
    pub(super) plot: Option<PathBuf>,
    /// Where the report goes: FILE.json, or a folder with pages, tables and figures
    #[arg(long, value_name = "FILE.json|FOLDER")]
    pub(super) report: Option<PathBuf>,
    /// The part of the plan that becomes weights, in seconds: 290:300 [default: all of it]
    #[arg(long, value_name = "FROM:TO")]
    pub(super) window: Option<Seconds>,
    /// Frames per second of the weights
    #[arg(long, value_name = "HZ", default_value_t = FRAMES_PER_SECOND)]
    pub(super) out_rate: f64,
    #[command(flatten)]
    pub(super) person: PersonOptions,
    /// Where the heart comes from: thesis or steady (laws), recorded [default: what was recorded, else thesis]
    #[arg(long, value_name = "MODEL", help_heading = PERSON)]
    pub(super) heart: Option<String>,
    #[command(flatten)]
    pub(super) motion: MotionOptions,
    /// What makes the curves: rules, linear (100 times the heart's share), or a model file
    #[arg(long, value_name = "MODEL", default_value = "rules", help_heading = FACE)]
    pub(super) model: String,
    /// Shapes of every control, as JSON, in the place of ARKit's
    #[arg(long, value_name = "FILE.json", help_heading = FACE)]
    pub(super) shapes: Option<PathBuf>,
    /// Leave the breath out of the face
    #[arg(long, help_heading = FACE)]
    pub(super) no_breath: bool,
    /// Let the skin redden and sweat: columns flush and sweat, which the built-in head has shapes for
    #[arg(long, help_heading = FACE)]
    pub(super) skin: bool,
    /// Breathe irregularly, by this seed
    #[arg(long, value_name = "NUMBER", conflicts_with = "no_breath", help_heading = FACE)]
    pub(super) seed: Option<u64>,
    /// Add the exertion to these weights: speech or an emotion
    #[arg(long, value_name = "WEIGHTS", help_heading = FACE)]
    pub(super) over: Option<PathBuf>,
}

/// What is known of the person.
#[derive(clap::Args)]
pub(super) struct PersonOptions {
    /// Who moves: JSON with any of age, heightM, massKg, sex, level, hrRest, hrMax, vo2Max, restingKcalDay,
    /// expressivity, loads
    #[arg(long, value_name = "FILE.json", help_heading = PERSON)]
    pub(super) person: Option<PathBuf>,
    /// Level of training, 0 to 10 [default: the person's, else 5]
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true, help_heading = PERSON)]
    pub(super) level: Option<f64>,
    /// What is carried, kg: back=8,leftHand=2,rightHand=2
    #[arg(long, value_name = "PLACE=KG", value_delimiter = ',', help_heading = PERSON)]
    pub(super) loads: Vec<Named>,
    /// Factors of the expressions: mouthOpen=1.1,mouthExhale=1,mouthStretch=1,eyes=0.9,brows=1
    #[arg(long, value_name = "NAME=FACTOR", value_delimiter = ',', help_heading = PERSON)]
    pub(super) expressivity: Vec<Named>,
}

/// What is known of a motion.
#[derive(clap::Args, Clone)]
pub(super) struct MotionOptions {
    /// How work follows from energies: segments, body, signed, positive, pseudo
    #[arg(long, value_name = "NAME", default_value = "segments", help_heading = MOTION)]
    pub(super) convention: String,
    /// Cut-off of the low-pass on every coordinate, or none
    #[arg(long, value_name = "HZ", default_value = "6", help_heading = MOTION)]
    pub(super) lowpass: Cutoff,
    /// Frames per second of the motion, where its file is wrong or does not say
    #[arg(long, value_name = "HZ", help_heading = MOTION)]
    pub(super) rate: Option<f64>,
    /// Which marker is which joint: JSON {"leftHip": "LABEL", ...} [default: by the names of CMU, Mixamo, Xsens]
    #[arg(long, value_name = "MAP", help_heading = MOTION)]
    pub(super) joints: Option<PathBuf>,
    /// Way up in the file: x, y or z [default: found]
    #[arg(long, value_name = "AXIS", help_heading = MOTION)]
    pub(super) up: Option<String>,
    /// Unit of the motion: m, cm or mm [default: so that the legs fit the person's stature]
    #[arg(long, value_name = "UNIT", help_heading = MOTION)]
    pub(super) unit: Option<String>,
}

/// Options of the training.
#[derive(clap::Args)]
pub(super) struct TrainOptions {
    /// Motion or activity of a recording; give it once for every recording, like the next three, in one order
    #[arg(long, value_name = "FILE", required = true)]
    pub(super) take: Vec<PathBuf>,
    /// Heart rate of the recording: CSV with time and heart_rate, FIT, TCX, GPX; "none" where the take has it,
    /// or where the law of the thesis is to stand for it
    #[arg(long, value_name = "FILE", required = true)]
    pub(super) heart_rate: Vec<PathBuf>,
    /// Weights of the face, from the same instant on: Live Link Face, or CSV
    #[arg(long, value_name = "FILE", required = true)]
    pub(super) weights: Vec<PathBuf>,
    /// Who it is: JSON as of mimique exertion; takes with the same file are of one person. One for every
    /// recording, or one for all
    #[arg(long, value_name = "FILE.json")]
    pub(super) person: Vec<PathBuf>,
    /// Where the model goes
    #[arg(long, value_name = "FILE.json")]
    pub(super) out: PathBuf,
    /// Seconds between two rows
    #[arg(long, value_name = "SECONDS", default_value_t = 1.0)]
    pub(super) every: f64,
    /// What curves follow from
    #[arg(long, value_name = "NAME,NAME", value_delimiter = ',', default_value = "w,p,rcn,epoc")]
    pub(super) features: Vec<String>,
    /// Least and largest exponent of C
    #[arg(long, value_name = "FROM:TO", default_value = "-10:10", allow_hyphen_values = true)]
    pub(super) c: Exponents,
    /// Least and largest exponent of gamma
    #[arg(long, value_name = "FROM:TO", default_value = "-10:10", allow_hyphen_values = true)]
    pub(super) gamma: Exponents,
    /// Half the width of the tube in which an error costs nothing, per cent
    #[arg(long, value_name = "PERCENT", allow_negative_numbers = true, default_value_t = 1.0)]
    pub(super) epsilon: f64,
    /// Contiguous blocks that are held out in turn
    #[arg(long, value_name = "NUMBER", default_value_t = 10)]
    pub(super) folds: usize,
    /// Shapes of every control, as JSON, in the place of ARKit's
    #[arg(long, value_name = "FILE.json")]
    pub(super) shapes: Option<PathBuf>,
    #[command(flatten)]
    pub(super) motion: MotionOptions,
}

/// Options of the study.
#[derive(clap::Args)]
pub(super) struct StudyOptions {
    /// Where the study file goes
    #[arg(long, value_name = "FILE.json")]
    pub(super) out: PathBuf,
    /// Motions of the built-in body: walk, run, sprint
    #[arg(long, value_name = "NAME,NAME", value_delimiter = ',', default_value = "walk,run,sprint", value_parser = activity)]
    pub(super) activities: Vec<BuiltinMotion>,
    /// Levels of training, 0 to 10
    #[arg(
        long,
        value_name = "NUMBER,NUMBER",
        value_delimiter = ',',
        default_value = "0,5,10",
        allow_hyphen_values = true
    )]
    pub(super) levels: Vec<f64>,
    /// Expressivities: names and what every expression is multiplied by, or letters of table 3.2 of the thesis
    /// (a,b,c,d,e)
    #[arg(
        long,
        value_name = "NAME=FACTOR",
        value_delimiter = ',',
        default_value = "reserved=0.6,expressive=1.2"
    )]
    pub(super) expressivities: Vec<NamedExpressivity>,
    /// What makes the face: rules, linear, a model file
    #[arg(long, value_name = "MODEL,MODEL", value_delimiter = ',', default_value = "rules")]
    pub(super) models: Vec<String>,
    /// Whether the mouth moves with the breath
    #[arg(long, value_name = "WORD,WORD", value_delimiter = ',', default_value = "with")]
    pub(super) breaths: Vec<Breath>,
    /// Let the skin redden and sweat
    #[arg(long)]
    pub(super) skin: bool,
    /// How long the body goes on before a clip ends [default: 5min of walk and run, 60 of sprint]
    #[arg(long = "for", value_name = "DURATION")]
    pub(super) duration: Option<Duration>,
    /// How long a clip is
    #[arg(long, value_name = "DURATION", default_value = "6")]
    pub(super) clip: Duration,
    /// Who it is, but for the level: JSON as of mimique exertion
    #[arg(long, value_name = "FILE.json")]
    pub(super) person: Option<PathBuf>,
}

impl StudyOptions {
    /// Whether clips differ in how hard the body works; expressivity, model and breath change the face alone.
    pub(super) fn exertion_differs(&self) -> bool {
        self.activities.len() > 1 || self.levels.len() > 1
    }
}

pub(super) use super::values::Exponents;
