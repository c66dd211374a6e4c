//! The study of an arena: every two methods on the same segment, the same head, light and sound.
//!
//! Each segment of a submission is a capture of recorded weights of its own, so that one clip is one file and its
//! provenance does not change when another method comes in.

use mimique_new_study::{Composed, Design, NotComposed, Parts, Stimuli, Wishes, compose};
use mimique_study::{Study, StudyFileError};
use serde_json::{Map, Value, json};

use crate::folder::ArenaFolder;
use crate::submission::Submission;

/// The factor of the clips whose levels are the methods.
pub const FACTOR: &str = "submission";
/// The factor of the clips whose levels are the arena's segments.
pub const TAKE: &str = "take";
/// The question that is a vote.
pub const QUESTION: &str = "better";

/// What makes a study one of an arena.
const DESIGN: &str = include_str!("../../../study-config/arena/design.json");

/// A study of an arena.
#[derive(Debug, Clone)]
pub struct ArenaStudy {
    /// The study as composed: its file, its comments.
    pub composed: Composed,
    /// What was wished, for its README.
    pub wishes: Wishes,
    /// The same read.
    pub study: Study,
    /// Pairs that each participant is shown: those that the arena asks for, or as many as there are.
    pub pairs: usize,
    /// The files that it names, paths in the arena's folder and in the study's alike.
    pub files: Vec<String>,
}

/// Why an arena has no study.
#[derive(Debug, thiserror::Error)]
pub enum NoStudy {
    /// Too few methods.
    #[error("submissions: {count}; a study compares two at least: `mimique arena submit` adds one")]
    Methods {
        /// How many there are.
        count: usize,
    },
    /// A submission that was made for other segments than the arena has now.
    #[error(
        "submissions/{name}: it has no segment {segment}, which arena.json has; submit the method again"
    )]
    Segment {
        /// The submission.
        name: String,
        /// The segment.
        segment: String,
    },
    /// The study cannot be put together: a mistake of this version.
    #[error("the study of the arena: {0}")]
    NotComposed(#[from] NotComposed),
    /// What was composed is no study: a mistake of this version.
    #[error("the study of the arena: {0}")]
    NoStudyFile(#[from] StudyFileError),
    /// The design is not as it should be: a mistake of this version.
    #[error("study-config/arena/design.json: {0}")]
    Design(#[from] serde_json::Error),
}

/// The study of an arena.
///
/// # Errors
/// [`NoStudy`]: fewer than two methods, or a segment that a method does not have.
pub fn arena_study(folder: &ArenaFolder) -> Result<ArenaStudy, NoStudy> {
    let ArenaFolder { arena, submissions, .. } = folder;
    if submissions.len() < 2 {
        return Err(NoStudy::Methods { count: submissions.len() });
    }
    let mut parts: Parts = serde_json::from_str(DESIGN)?;
    parts.title = json!({ "en": arena.title, "fr": arena.title });
    // The first half is dealt, no pair of clips twice.
    let clips = submissions.len() * (submissions.len() - 1) / 2 * arena.segments.len();
    let pairs = arena.per_participant.min(2 * clips);
    parts.components["duels"]["schedule"]["perParticipant"] = json!(pairs);
    let mut stimuli = ArenaParts::default();
    stimuli.avatars.insert("head".to_owned(), json!({ "file": arena.avatar }));
    stimuli.files.push(arena.avatar.clone());
    stimuli.files.extend(arena.sounds().into_iter().map(str::to_owned));
    for submission in submissions.values() {
        stimuli.add(folder, submission)?;
    }
    let ArenaParts { avatars, captures, segments, clips, files } = stimuli;
    let shown = json!({
        "avatars": avatars, "captures": captures, "segments": segments, "clips": { "list": clips },
    });
    let shown = Stimuli {
        parts: shown.as_object().cloned().unwrap_or_default(),
        // Segments may follow themselves where there is one.
        expressions: (arena.segments.iter())
            .map(|segment| [(); 3].map(|()| segment.id.clone()))
            .collect(),
    };
    let wishes = Wishes {
        id: arena.id.clone(),
        title: Some(arena.title.clone()),
        languages: ["en", "fr"].map(str::to_owned).to_vec(),
        methods: Map::new(),
    };
    // `compose` takes hypotheses for those about its methods, of which there is one: the factor here is another.
    let hypotheses = json!(parts.hypotheses);
    let design = Design::Parts(Box::new(parts));
    let mut composed = compose(&wishes, &design, &[], Some(&shown))?;
    composed.study["hypotheses"] = hypotheses;
    let rules = json!({ "failedAttentionChecks": 0, "incomplete": true, "shortestRtMs": 300, "lateFrameShare": 0.2 });
    composed.study["exclusions"] = rules;
    let study = Study::from_value(&composed.study)?;
    Ok(ArenaStudy { composed, wishes, study, pairs, files })
}

/// What the submissions bring.
#[derive(Default)]
struct ArenaParts {
    avatars: Map<String, Value>,
    captures: Map<String, Value>,
    segments: Vec<Value>,
    clips: Vec<Value>,
    files: Vec<String>,
}

impl ArenaParts {
    fn add(&mut self, folder: &ArenaFolder, submission: &Submission) -> Result<(), NoStudy> {
        let name = &submission.details.name;
        let place = ArenaFolder::place_of(name);
        let avatar = match &submission.avatar {
            None => "head".to_owned(),
            Some(own) => {
                let (id, file) = (format!("head_{name}"), format!("{place}/{}", own.file));
                self.avatars.insert(id.clone(), json!({ "file": file }));
                self.files.push(file);
                id
            }
        };
        for segment in &folder.arena.segments {
            let own =
                submission.segments.get(&segment.id).filter(|own| own.frames == segment.frames());
            let own = own.ok_or_else(|| NoStudy::Segment {
                name: name.clone(),
                segment: segment.id.clone(),
            })?;
            let (id, file) = (format!("{}_{name}", segment.id), format!("{place}/{}", own.file));
            let mut capture = json!({ "file": file });
            if let Some(hz) = folder.arena.shown_hz {
                capture["rateHz"] = json!(hz);
            }
            self.captures.insert(id.clone(), capture);
            let mut cut = json!({
                "id": id, "capture": id, "first": 0, "end": own.frames,
                "factors": { FACTOR: name, TAKE: segment.id },
            });
            if let Some(sound) = &segment.sound {
                cut["sound"] = json!(sound);
            }
            self.segments.push(cut);
            self.clips.push(json!({ "avatar": avatar, "segment": id, "method": "shown" }));
            self.files.push(file);
        }
        Ok(())
    }
}
