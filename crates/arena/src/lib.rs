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
//!
//! ```
//! use mimique_arena::{NotRanked, RankOptions, rank, read_votes};
//!
//! let table = "laboratory,session,place,take,left,right,chosen,left_hash,right_hash,day,rt_ms,batch\n\
//!              lyon,4f2a,1,joy,lsts,box,left,aa,bb,2026-11-27,1840.5,\n";
//! let votes = read_votes(table.as_bytes())?;
//! let ranking = rank(&votes, &["box", "lsts"].map(str::to_owned), &RankOptions::default());
//! // One vote ranks nothing.
//! assert_eq!(ranking.not_ranked, Some(NotRanked::TooFewVotes));
//! assert_eq!(ranking.waiting[1].chosen, 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod arena_file;
mod arena_problem;
mod data_set;
mod folder;
mod left_out;
mod new_arena;
mod pool;
mod ranking;
mod stimuli;
mod study;
mod submission;
mod votes;

pub use arena_file::{
    ARENA_FILE, Arena, ArenaCapture, ArenaSegment, arena_schema, arena_schema_text,
};
pub use arena_problem::{ArenaFileError, ArenaProblem};
pub use data_set::{DataSetFile, data_set};
pub use folder::{ArenaFolder, FolderError};
pub use left_out::LeftOut;
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
    ExportProblem, ExportedVotes, Vote, VoteFileError, read_export, read_votes, votes_csv,
};
