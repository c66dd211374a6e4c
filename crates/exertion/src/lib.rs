//! A face that shows what the body does: from motion to mechanical work, heart, breath and oxygen, and from
//! these to the mouth, the eyes and the brows (Boukhalfi 2012, chapters 3 and 4).
//!
//! ```text
//! Capture, BodyJoints --Body--> energies --BodyWork--> Accumulated --+
//! power, speed, heart rate of a watch ------------> w of a second ---+--Plan
//!                                                                        |
//!                                Series (a value a second) <-- heart, metabolism
//!                                        |
//!                                Clip (a row a frame) <-- expression, breathing, controls, shapes
//! ```
//!
//! Numbers only: no file, clock, thread or network. Exponentials, sines and logarithms are `libm`'s (those of
//! support vectors the solver's), sums are added in one order, what is random comes from ChaCha streams of a
//! seed, so that the bits are the same natively and in the browser. Errors are codes with values
//! ([`ExertionError`]), each with the place of what is wrong.
//!
//! | equation | source | here |
//! |---|---|---|
//! | E1 share of the heart's reserve | thesis 3.3.1 | [`Person::heart_share`] |
//! | E2 heart at rest and at most, E9 VO2max | "standard" formulas; Jackson 1990 | [`Person::new`] |
//! | E3 energies of segments | thesis 3.2, Winter's masses | [`Body::energies`] |
//! | E4 metres per unit | Winter's leg | [`Scale::ByStature`] |
//! | E5 work and power | "variation of energy", "derivative of work" | [`BodyWork`], [`Accumulated`] |
//! | E6 the heart's law | thesis 3.3.1, as printed | [`HeartModel::Thesis`] |
//! | E7 the heart that settles | ours | [`HeartModel::Steady`] |
//! | E8 oxygen, E10 breaths, E12 energy | thesis 3.3.1 | [`Metabolism`] |
//! | E11 EPOC and fatigue | a stand-in: the formula is not published | [`Metabolism`] |
//! | E13 no skeleton | ACSM | [`w_of_power`], [`w_on_foot`], [`w_of_heart`] |
//! | E14 curves | thesis 3.3.2 (support vectors); ours (rules) | [`ExpressionModel`], [`rules`] |
//! | E15 expressivity | thesis, table 3.2 | [`Controls`] |
//! | E16 shapes | ours | [`ShapeTable`] |
//!
//! No curve was learnt from people: the rules are written by us, and a model is as good as its teacher.
//!
//! # Example
//!
//! Five minutes of a run after one of rest, and the face of its last ten seconds:
//!
//! ```
//! use mimique_exertion::{
//!     Accumulated, Clip, Face, Heart, Part, Person, PersonSpec, Plan, Series, Start, Window,
//! };
//!
//! let person = Person::new(PersonSpec { level: 5.0, ..PersonSpec::default() })?;
//! let run = Part { work: Accumulated::of_phases(&[(15.5, 300.0)])?, seconds: 300.0, rcn: None };
//! let plan = Plan::new(vec![Part::rest(60.0), run])?;
//!
//! let series = Series::of(&person, &plan, Heart::default(), Start::default())?;
//! assert!((series.rcn[360] - 0.87).abs() < 0.005 && series.metabolism.epoc[360] > 10.0);
//!
//! let window = Window { seconds: [350.0, 360.0], rate_hz: 60.0 };
//! let face = Face { breathing: true, ..Face::default() };
//! let weights = Clip::of(&person, &plan, &series, &window, &face)?.table();
//! assert_eq!((weights.frames.len(), weights.frames[0]), (601, 21_000));
//! let jaw = weights.shape_names.iter().position(|name| name == "jawOpen").ok_or("no jaw")?;
//! assert!(weights.row(600)[jaw] > 0.2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "`!(x > y)` says what becomes of NaN")]

/// What the numbers of a series and of weights follow from, for provenance: it changes when the same input
/// gives other bits.
pub const VERSION: &str = "1";

mod activity;
mod body;
mod breathing;
mod chain;
mod controls;
mod courses;
mod energy;
mod error;
mod expression;
mod expressivity;
mod figure;
mod finding;
mod heart;
mod json;
mod loads;
mod metabolism;
mod model;
mod motion_work;
mod person;
mod plan;
mod rules;
mod samples;
mod segments;
mod shapes;
mod support_vectors;
mod work;

pub use activity::{
    ActivityWork, vo2_cycling, vo2_on_foot, w_of_heart, w_of_power, w_of_vo2, w_on_foot,
};
pub use body::{Body, BodyOptions, LOWPASS_HZ, Scale, Up};
pub use breathing::{Breathing, BreathingInput};
pub use chain::{Clip, FRAMES_PER_SECOND, Face, Heart, Series, Start, Window};
pub use controls::{Control, Controls};
pub use courses::Course;
pub use energy::PartEnergy;
pub use error::ExertionError;
pub use expression::Expression;
pub use expressivity::Expressivity;
pub use figure::Figure;
pub use finding::Finding;
pub use heart::{HeartLaw, HeartModel, RecordedHeart, WORK_LIMIT, heart, heart_with};
pub use loads::Loads;
pub use metabolism::{Metabolism, breaths_per_minute, fatigue, vo2};
pub use model::{ExpressionModel, Feature, MODEL_VERSION, model_json};
pub use motion_work::MotionWork;
pub use person::{LEVELS, Person, PersonSpec, Sex};
pub use plan::{Part, Plan};
pub use rules::{Curves, Features, rules};
pub use samples::{LONGEST_GAP_S, at_whole_seconds, whole_seconds, with_gaps_at_whole_seconds};
pub use shapes::ShapeTable;
pub use support_vectors::{SupportVectorParts, SupportVectors, gaussian_kernels};
pub use work::{Accumulated, BodyWork, Convention};
