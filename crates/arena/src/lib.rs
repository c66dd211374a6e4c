//! An arena: methods are submitted as weights or vertices for the same captures, people choose between two of them on the
//! same head, and the votes of several laboratories are pooled and ranked.
//!
//! ```text
//! avatar, capture, segments -> Arena -+-> arena study -> votes of a laboratory -+-> pool -> rank -> page
//!        weights, vertices -> check --+        (hash of every clip) ------------+
//! ```
//!
//! What is shown is known by its hash: the provenance of each clip, which an export has in every row. Votes are pooled
//! where the hashes of both clips are those of the arena; others are named and left out. Nothing here prints, reads the
//! network or asks the time.

mod arena_file;
mod data_set;
mod folder;
mod new_arena;
mod pool;
mod ranking;
mod stimuli;
mod study;
mod submission;
mod votes;

pub use arena_file::{
    ARENA_FILE, Arena, ArenaCapture, ArenaFileError, ArenaProblem, ArenaSegment, arena_schema,
    arena_schema_text,
};
pub use data_set::{DataSetFile, data_set};
pub use folder::{ArenaFolder, FolderError};
pub use new_arena::{MadeArena, NewArena, NoArena, new_arena};
pub use pool::{Laboratory, LeftOutVotes, Pooled, pool};
pub use ranking::{
    Agreement, Band, Difference, FEWEST_PEOPLE, FEWEST_VOTES, Heterogeneity, LaboratoryWorths,
    NotRanked, Placed, RankOptions, Ranking, RankingRow, Standing, rank, ranking_document,
    ranking_rows,
};
pub use stimuli::{ArenaClip, ArenaStimuli};
pub use study::{ArenaStudy, FACTOR, NoStudy, QUESTION, TAKE, arena_study};
pub use submission::{
    Given, GivenWeights, Submission, SubmissionDetails, SubmissionProblem, SubmittedAvatar,
    SubmittedFile, SubmittedKind, TOLERANCE_MM, VertexSubmission, WeightSubmission, check_details,
    check_vertices, check_weights, submission_files,
};
pub use votes::{
    ExportProblem, ExportedVotes, LeftOut, Vote, VoteFileError, read_export, read_votes, votes_csv,
};
