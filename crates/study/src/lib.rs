#![doc = include_str!("../README.md")]

mod answer;
mod canonical;
mod check;
mod clip_source;
mod closed_loop;
pub mod columns;
mod device;
mod drawn_face;
mod instant;
mod order;
mod pair_drawing;
mod pairs;
mod practice;
mod projection;
mod published;
mod question;
mod study_file;
pub mod text;
mod web_address;

pub use answer::{AnswerProblem, Answers, alike};
pub use canonical::{canonical, config_hash};
pub use check::{
    CheckedStudy, Count, Counted, FileLookup, Issue, Issues, JsonType, Known, Names, Nearest,
    Problem, Report, SCHEMA_ADDRESS, Severity, Shown, Wanted, check, check_opened, json_schema,
};
pub use clip_source::{ClipSound, ClipSource};
pub use closed_loop::{ChosenLevel, ClosedLoop, NoLevels, grid, staircase};
pub use device::{Display, Unmet};
pub use drawn_face::{DrawnFace, ShownCourse, UnitShapes};
pub use instant::{instant_ms, iso_time};
pub use order::{
    Draw, NoOrder, OrderError, OrderedItem, Sides, Stream, drawn_condition, option_order, order,
};
pub use pair_drawing::{DrawnPairs, OwnChoice, PairCount, PairCounts, PairRequest};
pub use pairs::AnswerOfPair;
pub use practice::right_answers;
pub use projection::StudyProjection;
pub use published::{answer_hashes, published};
pub use question::{
    AttentionCheck, BestWorst, Chance, Choice, ChoiceView, Comparison, Condition, Grid,
    KindOfQuestion, LONG_TEXT, Likert, LongText, Matrix, MultipleChoice, NumberField, OptionOrder,
    Question, QuestionKind, QuestionKindView, Ranking, SHORT_TEXT, SPACE_KEY, Scale, ShortText,
    Showing, Simulated, SingleChoice, Slider, Summary, TRACE_HZ, Told,
};
pub use study_file::*;
pub use web_address::percent_encoded;
