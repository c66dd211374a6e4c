//! The analysis of a study: its trials, its hypotheses, its report; simulated participants, power and
//! the preregistration that follows from them.
//!
//! From the tidy export and the study file, [`analyze`] makes every table, figure and sentence of the
//! [`Report`]. [`Simulation`] makes exports of simulated participants, [`power`] runs the study's own
//! analysis on many of them, [`preregistration`] writes down what will be done. The tests themselves
//! are those of `mimique-stats`.
//!
//! ```
//! use mimique_analysis::{Parameters, PowerOptions, power};
//! use mimique_study::Study;
//!
//! # let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../study-config/demo.json");
//! # let text = std::fs::read_to_string(file)?;
//! // The study file `study-config/demo.json`.
//! let study = Study::from_text(&text)?;
//! let options = PowerOptions {
//!     participants: vec![12],
//!     clips: Vec::new(),
//!     runs: 20,
//!     seed: 1,
//!     alpha: 0.05,
//!     false_positives: false,
//!     mixed: false,
//! };
//! let found = power(&study, "hash of the file", &Parameters::for_study(&study), &options, &|| {})?;
//! let hypotheses = &found.points[0].hypotheses;
//! assert_eq!(hypotheses.len(), study.hypotheses.len());
//! assert!(hypotheses.iter().all(|each| each.power.deciding.share <= 1.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod agreement;
mod choices;
mod faces;
mod hypothesis;
mod mimicry;
mod naming;
mod power;
mod preregistration;
mod report;
mod scaling;
mod sensitivity;
mod simulate;
mod thresholds;
mod trials;

pub use hypothesis::ClipScope;
pub use hypothesis::decision::EffectUnit;
pub use power::{
    BlockPrecision, Columns, Estimand, HypothesisPower, Power, PowerError, PowerOptions,
    PowerPoint, PrecisionPoint, Rate, SmallestDifference, in_scope, no_effect, power, power_csv,
    power_curve, power_markdown, power_runs, precision_csv, precision_markdown, smallest_cell,
};
pub use preregistration::{Preregistration, as_predicted, preregistration};
pub use report::{MeasuredFaces, Report, ReportOptions, analyze, analyze_with};
pub use simulate::{
    ByLevel, Careless, Compared, Discrimination, Display, Dropout, FacePart, FaceTemplates,
    Interaction, NumberAnswer, PairChoices, Parameters, ParametersError, PerceivedScale, Rating,
    Recognition, SimulatedSession, Simulation, Template, TemplatePart, TemplatePeople, Times,
};
pub use trials::error::{ExportError, MimicryError, StimuliError};
pub use trials::reason::Reason;
pub use trials::versions::{ServedVersion, StudyVersions};
