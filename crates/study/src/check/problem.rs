//! Every problem that the check can find, as values: a code, what the words name, and what to do about
//! it. The words are made here and nowhere else, in English, when somebody reads them.

use mimique_adaptive::DesignError;
use serde_json::Value;

use crate::order::NoOrder;
use crate::pairs::AnswerOfPair;
use crate::study_file::{NoCells, PathError, SyntaxError, WrongVariable};

use super::values::{Count, Counted, Known, Names, Nearest, Shown, Wanted};

/// Each row is a kind of problem: its name and values, its code, what is wrong, what to do about it.
macro_rules! problems {
    ($($name:ident $({ $($field:ident: $type:ty),* })?: $code:literal, $message:literal, $remedy:literal;)*) => {
        /// A problem of a study file.
        #[derive(Debug, Clone, PartialEq)]
        #[non_exhaustive]
        #[expect(missing_docs, reason = "a value stands in the words of its problem")]
        pub enum Problem {
            $(#[doc = concat!("`", $code, "`: ", $message)] $name $({ $($field: $type),* })?,)*
        }

        impl Problem {
            /// The codes that a problem can have.
            pub const CODES: &'static [&'static str] = &[$($code),*];

            /// Stable word for what kind of problem it is: `unknown-key`.
            pub fn code(&self) -> &'static str {
                match self { $(Self::$name { .. } => $code,)* }
            }

            /// What is wrong, with its values.
            #[allow(unused_variables, reason = "some values stand in the remedy alone")]
            pub fn message(&self) -> String {
                match self { $(Self::$name $({ $($field),* })? => format!($message),)* }
            }

            /// What to do about it.
            #[allow(unused_variables, reason = "some values stand in the message alone")]
            pub fn remedy(&self) -> String {
                match self { $(Self::$name $({ $($field),* })? => format!($remedy),)* }
            }
        }
    };
}

problems! {
// The text, its keys and its types.
Syntax { place: String, what: String, remedy: &'static str }: "syntax", "{place}: {what}", "{remedy}";
Shape { what: String }: "shape", "study file: {what}", "correct what the message names";
UnknownKey { key: String, known: Nearest }: "unknown-key", "unknown key \"{key}\"", "{known}";
MissingKey { key: String }: "missing-key", "\"{key}\" is missing", "add \"{key}\"";
MissingType { words: Names }: "missing-key", "\"type\" is missing", "add \"type\": {words}";
WrongType { found: Shown, wanted: Wanted }: "wrong-type",
    "{found} where {wanted} belongs", "write {wanted}";
UnknownWord { word: String, words: Names, known: Nearest }: "unknown-word",
    "\"{word}\" is not one of {words}", "{known}";
WholeNotInRange { found: Value, least: f64, most: f64 }: "out-of-range",
    "{found} is out of range", "write a whole number from {least} to {most}";
ItemCount { found: Counted, wanted: usize }: "wrong-length",
    "{found} where {wanted} belong", "write {wanted} items";

// Several parts of the file.
UnknownReference { what: &'static str, name: String, known: Nearest }: "unknown-reference",
    "there is no {what} \"{name}\"", "{known}";
NamedTwice { name: String }: "duplicate", "\"{name}\" twice", "name it once";
OutOfRange { value: f64, unit: &'static str, least: f64, most: f64 }: "out-of-range",
    "{value} {unit}", "take {least} to {most}";
EmptyText: "empty-text", "the text is empty", "write it";
NotSecure { address: String }: "bad-address",
    "\"{address}\" is not a secure address", "begin it with https://";
NoClipWith { factor: String, level: String, known: Nearest }: "unknown-reference",
    "no clip has {factor} \"{level}\"", "{known}";
NoFile { path: String }: "missing-file", "no file {path}", "put the file there, or correct the path";
Variable { path: String, why: WrongVariable, remedy: &'static str }: "missing-file",
    "{path:?}: {why}", "{remedy}";

// An uploaded archive.
NoFileInArchive { path: String }: "missing-file",
    "no file {path:?} in the archive", "put the file into the archive and name it from the study file's folder";
OutsideArchive { path: String }: "missing-file",
    "{path:?} is not in the archive", "put the file into the archive and name it from the study file's folder";
LeadsOut { path: String }: "upload",
    "{path:?} leads out of the archive", "put the file into the archive and correct the path";
NotUtf8 { byte: usize }: "upload", "byte {byte}: not UTF-8", "save the file as UTF-8";
Unreadable { reason: String }: "upload", "it cannot be read ({reason})", "pack it anew";

// Study, languages and texts.
StudyId { id: String }: "bad-id",
    "\"{id}\" cannot stand in an address", "use lower-case letters, digits and -";
Seed { seed: u64 }: "out-of-range", "{seed} is above 2^53 - 1", "take a smaller number";
Date { date: String }: "bad-date", "\"{date}\" is not a date", "write YYYY-MM-DD";
NoLanguage: "no-language", "no language", "add one: [\"en\"]";
UntranslatedButtons { language: String, complete: Names }: "untranslated-buttons",
    "buttons and messages are not translated to \"{language}\"",
    "they will be in English; complete are {complete}; `mimique check --words {language}` prints what to translate into /translations/{language}";
UndeclaredTranslation { language: String, declared: Names }: "undeclared-language",
    "\"{language}\" is not one of the study's languages", "add it to /languages; there is {declared}";
UndeclaredLanguage { language: String, declared: Names }: "undeclared-language",
    "\"{language}\" is not one of the study's languages",
    "add it to /languages, or remove it here; there is {declared}";
UnknownText { name: String, known: Nearest }: "unknown-text",
    "no button or message is called \"{name}\"", "{known}";
WrongPlaceholders { text: String, english: String }: "wrong-placeholders",
    "\"{text}\" has not the words in braces of \"{english}\"", "write each of them once, as it is in English";
IncompleteTranslation { language: String, count: Counted, some: Names }: "incomplete-translation",
    "no translation of {count}: {some}",
    "they will be in English; `mimique check --words {language}` prints all of them";
OneTextForAll { languages: usize }: "one-text-for-all",
    "the same text for {languages} languages", "write one text a language: {{\"en\": \"...\", \"fr\": \"...\"}}";
MissingTranslation { language: String }: "missing-translation",
    "no text in \"{language}\"", "add \"{language}\": \"...\"";

// Contact, recruitment, consent, exclusions.
NoContact: "no-contact", "no contact: participants cannot ask anybody",
    "add \"contact\": {{\"investigator\": {{\"name\": \"...\", \"email\": \"...\"}}, \"ethicsBoard\": {{...}}}}";
NoEthicsBoard: "no-ethics-board", "no contact of the ethics board",
    "add \"ethicsBoard\": {{\"name\": \"...\", \"email\": \"...\"}}";
Email { address: String }: "bad-email", "\"{address}\" is not an address", "write NAME@DOMAIN";
ParameterName { name: String }: "bad-id",
    "\"{name}\" is not a parameter's name", "use letters, digits, _ and -";
ParameterIsColumn { name: String }: "name-taken",
    "\"{name}\" is the name of another column of the export", "let the address name it otherwise";
NoRecruitmentIdentifier: "no-identifier",
    "repeats are to be recognised by the recruitment identifier, but none is kept",
    "add \"urlParameters\": [\"PROLIFIC_PID\"]";
NoCompletionCode: "no-code",
    "{{code}} stands for a completion code that is not given", "add \"completionCode\"";
NoScreenedOutCode: "no-code",
    "people who are screened out have no code to go back with", "add \"screenedOutCode\": \"...\"";
NoFailedChecksCode: "no-code",
    "people who fail the attention checks have no code to go back with", "add \"failedChecksCode\": \"...\"";
UnknownParameter { name: String }: "unknown-parameter",
    "{{{name}}} is not one of urlParameters", "add it to urlParameters";
NoWayBack: "no-way-back", "the last page is to go back by itself, and no address says where",
    "add \"redirect\": \"https://...\", or remove it";
NoParticipants: "out-of-range", "nobody could take part", "write how many, or leave it out for any number";
NoReservation: "out-of-range",
    "a place that is kept for 0 minutes is lost at once", "write the time that the study takes, in minutes";
NotATime { text: String }: "bad-date",
    "\"{text}\" is not a time", "write it with its offset: 2026-03-01T08:00:00+01:00";
ClosesBeforeOpening: "out-of-range", "the study closes before it opens", "write a later time";
NoConsent: "no-consent", "no consent: participants are not asked whether they agree",
    "add \"consent\": {{\"version\": \"1\", ...}}";
NoMinimumAge: "no-minimum-age", "no minimum age", "add \"minimumAge\": 18";
NoRetention: "no-retention", "no retention period: participants are not told how long answers are kept",
    "add \"retention\": \"...\"";
NoRetentionDays: "out-of-range", "answers that are kept for 0 days are deleted at once",
    "write how many days, or leave it out to keep them";
NoConsentVersion: "empty-text", "the version is empty", "write \"1\"";
NothingToAgreeTo: "empty",
    "nothing is said that a participant could agree to", "add a section: what they will do";
NotAShare { share: f64 }: "out-of-range", "{share} is not a share", "write 0 to 1";
ExcludesNothing { ms: f64 }: "out-of-range",
    "{ms} ms excludes nothing or everything", "write a time above 0";

ShortRun { run: u32 }: "out-of-range",
    "{run} equal answers in a row come about by chance", "write 3 or more";
NotClosed { question: String }: "not-closed",
    "\"{question}\" is answered neither on a scale nor by options: equal answers say nothing",
    "name questions with a scale or options";
NoSpeedRule: "no-speed-rule",
    "people are paid, and whoever answers at once, as scripts do, counts like the others",
    "add \"shortestRtMs\": 300, or what your pilot shows nobody can do in earnest";
NoStraightLiningRule: "no-straight-lining-rule",
    "people are paid, and whoever always gives the same answer counts like the others",
    "add \"straightLining\": {{\"longestRun\": 12}}, or what your pilot shows nobody does in earnest";

// Device, calibration, time limits, practice, screening, hosting.
CalibratesNothing: "empty", "the calibration asks nothing", "remove \"card\": false, or the section";
OneSideInMillimetres: "incomplete", "one side in millimetres", "give both widthMm and heightMm";
NoCalibration: "no-calibration", "a size in millimetres on screens that nobody measures",
    "add \"calibration\": {{\"card\": true, \"required\": true}}";
HardTimeLimit { extensions: Counted }: "hard-time-limit",
    "{extensions}: people who read or move slowly are shut out (WCAG 2.2, 2.2.1)",
    "allow ten, or say why the limit is essential: \"essential\": \"...\"";
NotAPracticeClip { clip: String, known: Nearest }: "unknown-reference",
    "\"{clip}\" is no practice clip", "{known}";
NotAskedInPractice { question: String, known: Nearest }: "unknown-reference",
    "\"{question}\" is not asked in practice", "{known}";
NoRightAnswer: "no-right-answer", "of no practice clip a right answer is known",
    "give a question \"truth\", or state them in \"answers\"";
Criterion { correct: u32, judged: usize }: "out-of-range",
    "{correct} right clips of {judged} that can be right are wanted",
    "take 1 to {judged}, or state more right answers in \"answers\"";
NoFeedback: "no-feedback",
    "practice is repeated, but nobody is told what was wrong", "add \"feedback\": true";
NoPageAsks { question: String, known: Nearest }: "unknown-reference",
    "no page asks \"{question}\"", "{known}";
NoAttentionCheck: "nothing-to-fail", "no question is an attention check",
    "give one \"attentionCheck\": {{\"expected\": ...}}, or remove the section";
OneFailureEnds: "unfair-check", "one failed check ends the session",
    "allow one failure: Prolific accepts that only of studies under five minutes";
AnswersGoNowhere: "empty",
    "answers go nowhere: neither posted nor downloaded", "add \"post\", or let them download";
ProgressGoesNowhere: "empty",
    "what is answered is posted as it comes, and no address takes it", "add \"post\", or leave it out";
PostNotSecure { address: String }: "bad-address",
    "\"{address}\" is not a secure address", "write https://HOST/PATH without blanks";

// Questions.
QuestionTwice { id: String, first: String }: "duplicate",
    "\"{id}\" is the identifier of {first} already", "give it another one";
NeverAsked { id: String }: "unused-question", "\"{id}\" is never asked",
    "name it in the questions of a trials component, or remove it";
ComparesOneClip { id: String }: "no-companion", "\"{id}\" compares two clips, and only one is shown",
    "ask it in components that have \"beside\", or in a block of pairs";
QuestionId { id: String }: "bad-id",
    "\"{id}\" cannot be the name of a column", "use letters, digits, _ and -";
NameTaken { id: String, by: &'static str }: "name-taken",
    "\"{id}\" is the name of {by} already", "call it \"perceived_{id}\", say";
ChoiceCount { least: usize, most: usize, options: usize }: "bad-range",
    "{least} to {most} of {options} options cannot be chosen", "correct minimum and maximum";
LabelCount { labels: Counted, points: u32 }: "wrong-length",
    "{labels} for {points} points", "write one label per point, or leave labels out";
Step { step: f64 }: "out-of-range", "a step of {step} leads nowhere",
    "take a step above 0 and no longer than the line";
NoTextAllowed: "out-of-range", "no text can be written", "take a maxLength above 0";
EmptySign { value: String }: "empty", "\"{value}\" has neither a sign-language video nor a picture",
    "add \"video\": \"FILE.mp4\", or remove it";
NoSide { value: String, known: Nearest }: "unknown-reference",
    "\"{value}\" is no option of this comparison", "{known}";
Points { points: Counted }: "out-of-range", "a scale of {points}", "take 2 to 101";
NoEnds { first: &'static str, missing: String }: "scale-without-ends",
    "a scale without ends: no {missing}", "say what its ends mean: \"{first}\": \"...\"";
EmptyRange { least: f64, most: f64 }: "bad-range", "from {least} to {most} there is nothing to choose",
    "make the maximum larger than the minimum";
TooFewOptions { options: usize, least: usize }: "too-few",
    "{options} of at least {least}", "add what can be chosen";
OptionValue { value: String }: "bad-id", "\"{value}\" cannot be a value", "write a word without |";
OptionTwice { value: String }: "duplicate", "\"{value}\" is the value of two", "give each its own value";
NoTruth { clip: String, factor: String }: "no-truth", "clip \"{clip}\" has no factor \"{factor}\"",
    "give its segment that factor, or leave the clip out of the block";
TruthNoOption { clip: String, truth: String, options: Names }: "no-truth",
    "the truth of clip \"{clip}\" is \"{truth}\", no option", "add that option; there is {options}";
BadImage { path: String }: "bad-file",
    "\"{path}\" is no image that every browser shows", "take a PNG, JPEG, WebP or SVG file";

// Attention checks and conditions on earlier answers.
NoAnswer { answer: Value }: "bad-answer",
    "{answer} is no answer to this question", "write an answer that can be given";
CheckAsksForText: "unfair-check", "an attention check that asks for free text",
    "take a choice or a scale; Prolific does not accept free text";
CheckIsOptional: "unfair-check",
    "an attention check that may be left out", "remove \"required\": false";
CheckUntold { language: String, answer: String }: "unfair-check",
    "the prompt in \"{language}\" does not say to answer \"{answer}\"",
    "tell which answer to give (\"Please choose {answer}\"), as Prolific asks";
AskedLater { question: String }: "too-late", "\"{question}\" is asked later", "put that question first";
PerhapsLater { question: String }: "perhaps-too-late",
    "\"{question}\" may be asked later: their order is drawn", "put its page first, in a sequence of fixed order";
OtherCondition { question: String }: "other-condition",
    "nobody who is asked this is asked \"{question}\"",
    "ask both in one condition, or that one outside of the conditions";
NotKept { question: String }: "not-kept",
    "\"{question}\" is asked in trials, whose answers are not kept",
    "ask it before this question in the same trials, or on a page before";
EmptyCondition: "empty", "a condition without a value", "add equals, oneOf, atLeast or atMost";
NoAnswerTo { answer: Value, question: String, known: Known }: "bad-answer",
    "{answer} is no answer to \"{question}\"", "{known}";
NotTheWholeAnswer { answer: Value, question: String }: "bad-answer",
    "{answer} is no answer to \"{question}\"",
    "write \"oneOf\": [{answer}] for whoever chooses it among others";
AnswersNoNumbers { question: String }: "bad-answer",
    "the answers to \"{question}\" are not numbers", "write equals or oneOf";
BoundsCross { least: f64, most: f64 }: "never-holds",
    "no number is at least {least} and at most {most}", "make atLeast the smaller one";
NeverReached { question: String, end: f64, bound: f64 }: "never-holds",
    "the answers to \"{question}\" end at {end}; {bound} never comes",
    "correct the bound, or the question's own";
NeverSaid { question: String, end: f64, bound: f64 }: "never-holds",
    "the answers to \"{question}\" end at {end}; {bound} never comes",
    "widen the question's minimum and maximum, so that people can say the truth";

// Avatars, captures, segments, methods, clips.
NoAvatarSource: "one-source", "neither builtin, file nor videos",
    "give one: \"builtin\": {{}}, \"file\": \"...\" or \"videos\": {{\"segment\": \"...\"}}";
AvatarSources { given: String }: "one-source", "several sources: {given}",
    "give one: \"builtin\": {{}}, \"file\": \"...\" or \"videos\": {{\"segment\": \"...\"}}";
BadVideo { path: String }: "bad-file",
    "\"{path}\" is no video that every browser plays", "take an MP4 (H.264) or a WebM file";
VideoHasNoLook: "not-needed", "a video is shown as it is", "remove look";
SeedAndActor: "one-source", "both seed and actor say who it is", "remove one of them";
MissingVideo { segment: String }: "missing-video", "no video of segment \"{segment}\", which a clip shows",
    "name its file, or leave the clip out in /stimuli/clips";
MethodOnVideo { method: String }: "bad-video", "method \"{method}\" cannot animate videos",
    "show them with a method {{\"method\": \"recorded\"}}: choose in /stimuli/clips";
PartOfClipId { name: String }: "bad-id",
    "\"{name}\" cannot be part of a clip's identifier", "use letters, digits, _ and -";
NoSource: "one-source",
    "neither builtin, file nor exertion",
    "give one: \"builtin\": {{}}, \"file\": \"...\" or \"exertion\": {{\"builtin\": \"run\", \"for\": 300}}";
SeveralSources: "one-source", "several of builtin, file and exertion",
    "give one: \"builtin\": {{}}, \"file\": \"...\" or \"exertion\": {{\"builtin\": \"run\", \"for\": 300}}";
NoMotion: "one-source", "none of builtin, motion, activity and plan",
    "give one: \"builtin\": \"run\", \"motion\": \"run.bvh\", \"activity\": \"ride.fit\" or \"plan\": [...]";
TwoMotions: "one-source", "several of builtin, motion, activity and plan",
    "give one: \"builtin\": \"run\", \"motion\": \"run.bvh\", \"activity\": \"ride.fit\" or \"plan\": [...]";
SeveralMotions: "one-source", "several of builtin, motion, activity and work in one part",
    "give one in each part of the plan, or none for rest";
PartWithoutLength: "wrong-length", "a part that nothing tells the length of",
    "add \"for\": 60, the seconds of rest or work";
PlanHasLength: "not-needed", "a plan is as long as its parts", "write \"for\" in the parts of the plan";
ConstantWork { work: f64 }: "out-of-range", "{work} J/kg in a second",
    "write 0 for rest, 5 for a walk, 15 for a run; at most 120";
PastExertion { end: usize, frames: usize }: "bad-range",
    "the segment ends at frame {end}, the exertion has {frames}",
    "write first and end within its frames, 60 per second, or let the body go on for longer (\"for\")";
LengthOfExertion { seconds: f64 }: "out-of-range", "{seconds} seconds",
    "write how long the body goes on, above 0 and at most 86400";
ExertionMarkers: "not-needed", "the face of an exertion is computed, without markers",
    "remove markers, head, unit, neutral, headLowpassHz and headMotion";
MethodOnExertion { method: String, capture: String }: "bad-exertion",
    "method \"{method}\" solves markers; the exertion \"{capture}\" has weights",
    "show it with a method {{\"method\": \"recorded\"}}: choose in /stimuli/clips";
Unit { unit: String }: "unknown-word", "\"{unit}\" is not a unit", "write m, cm or mm";
NeutralFrames { first: usize, end: usize }: "bad-range",
    "frames {first} to {end} are none", "write the first frame and the one after the last";
SegmentFrames { first: usize, end: usize }: "bad-range",
    "frames {first} to {end} are none", "end is the frame after the last one";
NothingPasses { hertz: f64 }: "out-of-range",
    "{hertz} Hz lets nothing pass", "take a frequency above 0, or leave it out";
FrameRate { hertz: f64 }: "out-of-range", "{hertz} frames a second show no face as it moves",
    "take 60 (what most displays show), another rate from 15 to 1000, or leave it out";
ClipsUnlike { what: String, remedy: &'static str }: "clips-unlike", "{what}", "{remedy}";
NotPrepared { message: String }: "not-prepared", "{message}", "correct it, or the study cannot be served";
GazeSources: "bad-gaze", "not exactly one of held, file, target and performed gives the gaze",
    "give one of them, as \"gaze\": {{ \"held\": {{ \"azimuth\": 0 }} }}";
GazeAngle { degrees: f64, least: f64, most: f64 }: "out-of-range",
    "eyes do not turn by {degrees} degrees", "write degrees from {least} to {most}";
GazeTarget: "bad-gaze", "only a capture of a file has a marker that the eyes look at",
    "give the gaze by held or file";
NoKnownMotion: "no-known-motion", "every clip is a video: nothing is known of how its face moves",
    "faces are measured, and the report has nothing to hold them against; add clips that are drawn, or remove this";
MimicryNeedsServer: "mimicry-needs-server", "pages hosted as files do not measure participants' faces",
    "serve the study by `mimique serve`: `mimique export-site` refuses it";
NoSound: "no-sound", "no clip of this study has sound",
    "name the sound of a segment, \"sound\": {{ \"file\": \"joy.wav\" }}, or remove this";
NoSoundFile: "bad-sound", "neither the segment nor its capture names a file of sound",
    "add \"file\": \"joy.wav\", or the sound of the capture";
SoundFromOfCapture: "bad-sound", "fromS belongs to a file, and the segment names none",
    "add \"file\", or write fromS in the sound of the capture";
SoundOfActor: "bad-sound", "a built-in actor performs every segment anew: no file goes with all of them",
    "name the sound of each segment";
SoundTime { seconds: f64 }: "out-of-range", "{seconds} s is no time in a file", "write seconds from 0 on";
CaptionTimes { from_s: f64, to_s: f64 }: "bad-range", "a caption from {from_s} to {to_s} s is never shown",
    "write when it begins and, later, when it ends, in seconds";
CaptionOverlaps { from_s: f64, before_s: f64 }: "bad-range",
    "the caption begins at {from_s} s, and the one before ends at {before_s} s",
    "write captions in the order of their times, one after the other";
NoCaptions: "no-captions", "captions are to be shown, and no sound has any",
    "add \"captions\" to the sound of a segment, or take \"off\"";
CaptionsNotShown: "captions-not-shown", "the segment has captions, which the study does not show",
    "add \"sound\": {{ \"captions\": \"offered\" }} to the study";
SilentAndMore: "bad-sound", "silence has no other segment and no delay",
    "remove silent, or from and delayMs";
SoundWithoutFile { segment: String }: "bad-sound", "segment \"{segment}\" has no sound",
    "name a segment that has one, or give it one";
HeardAsSilent { segment: String, sound: String }: "silent-segment",
    "segment \"{segment}\" has no sound: its clips of the sound \"{sound}\" are silent",
    "give the segment a sound, or leave these clips out in /stimuli/clips";
SoundNotNamed: "bad-sound", "the study names sounds, and the clip none of them", "add \"sound\": \"...\"";
// Of files of sound, which only those who open them know.
SoundUnknown { path: String }: "bad-file", "{path}: neither WAV, MP3 nor Ogg Opus",
    "export the sound anew as one of them";
SoundDamaged { path: String, what: String }: "bad-file", "{path}: cannot be read ({what})",
    "see that the file is whole, or export the sound anew";
SoundBeginsLate { path: String, from_s: f64, duration_s: f64 }: "bad-sound",
    "{path}: the sound begins at {from_s:.3} s, and the file lasts {duration_s:.3} s", "correct fromS";
SoundEndsEarly { clip: String, audible_s: f64, clip_s: f64 }: "sound-ends-early",
    "the sound of \"{clip}\" ends after {audible_s:.3} s, the clip lasts {clip_s:.3} s",
    "see that fromS is right and the file whole; what is missing is silence";
HeadMotionShare { share: f64 }: "out-of-range", "{share} of the head's motion is no share of it",
    "write a number from 0 (a head that is held still) to 1";
HeadMotionUnknown: "bad-head-motion", "the capture names no head markers: its head is shown still, unless the marker map names them",
    "add \"head\": [three labels or more], or write \"headMotion\": 0";
GazePerformed: "bad-gaze", "only a built-in actor performs a gaze", "give the gaze by held, file or target";
NoMarkers: "no-markers", "no marker map: nothing says where the markers sit on the avatar",
    "add \"markers\": \"map.json\"";
NoNeutral: "no-neutral", "no frames of the neutral face",
    "add \"neutral\": [first, end], or make sure that the capture begins with it";
NoHead: "no-head", "no head markers: the head's own motion stays in the face's",
    "add \"head\": [three labels or more]";
FewHeadMarkers { markers: Counted }: "too-few",
    "{markers}, by which the head is not fixed", "name three or more";
BuiltinMarkers: "not-needed", "a built-in actor brings its markers along", "remove markers, head and unit";
SegmentTwice { id: String }: "duplicate", "two segments \"{id}\"", "give it another one";
Intensity { intensity: u8 }: "out-of-range", "intensity {intensity}", "write 1, 2 or 3";
CutOfActor: "bad-segment", "a cut of a built-in actor is a performance, not frames",
    "write \"performance\": {{\"expression\": \"joy\", \"intensity\": 2}} alone";
CutOfFile: "bad-segment",
    "a cut of a file or of an exertion is its frames", "write \"first\" and \"end\", and no performance";
Parameter { message: String, remedy: String }: "bad-parameter", "{message}", "{remedy}";
NoTraining: "no-training", "no training: a regression learns from a range of motion",
    "add \"training\": {{\"capture\": \"...\", \"weights\": \"weights.csv\"}}";
LearnsNothing { method: String }: "not-needed",
    "\"{method}\" learns nothing", "remove training, or take regression";
NoWeights: "no-weights",
    "no weights: nothing says what the take's frames are", "add \"weights\": \"weights.csv\"";
BuiltinWeights: "not-needed", "a built-in actor brings the weights along", "remove weights";
SmoothingAdvised { capture: String, why: String, residual_mm: f64, smoothed_mm: f64, smoothing: f64 }:
    "smoothing-advised",
    "{why}: rbfSmoothing {smoothing} lowers the residual of \"{capture}\" from {residual_mm:.3} to {smoothed_mm:.3} mm",
    "add \"rbfSmoothing\": {smoothing} to the method, or 0 to keep the adaptation exact";
FactorIsColumn { factor: String }: "name-taken",
    "\"{factor}\" is the name of a column of every export", "give the factor another name";
FactorTwice { factor: String, here: &'static str, there: &'static str }: "factor-twice",
    "\"{factor}\" is a factor of {here} and of {there}", "keep it in one place, so that a clip has one value";
UnusedFactor { factor: String }: "unused-factor", "factor \"{factor}\" is never used",
    "name it in a hypothesis, a constraint, a selection of clips or a truth; or remove it";
Colour { colour: String }: "bad-colour", "\"{colour}\" is not a colour", "write #rrggbb";
UnusedByClips { what: &'static str, name: String }: "unused",
    "no clip uses {what} \"{name}\"", "name it in /stimuli/clips, or remove it";

// Components and their order.
ComponentName { name: String }: "bad-id", "\"{name}\" cannot be the name of a component",
    "use letters, digits, _ and -, and none of the names of the file's sections";
BreakSeconds { seconds: f64 }: "out-of-range", "a break of {seconds} s", "take 0 to 3600";
NeverShown { component: String }: "unused",
    "component \"{component}\" is never shown", "name it in /sequence, or remove it";
OneLevel { level: f64 }: "bad-range", "all levels are {level}", "let \"from\" and \"to\" differ";
StopOfStaircase: "adaptive", "a staircase has no posterior whose standard deviation could stop it",
    "remove it, or take \"questPlus\"";
StopNotPositive { stop: f64 }: "out-of-range", "a standard deviation of {stop}", "write a number above 0";
LevelsOfVideos: "adaptive", "the avatar is shown by videos, of which no level can be solved",
    "name an avatar that is drawn";
LevelsWithSound: "adaptive", "the study has sounds, with which levels are not combined",
    "remove /stimuli/sounds, or this block";
LevelsRise { parameter: String }: "adaptive",
    "the higher \"{parameter}\", the less is seen of it, and levels go from the hardest to the easiest",
    "write the highest level as \"from\" and the lowest as \"to\"";
WeibullFalls: "adaptive", "a Weibull function rises from 0, and these levels fall",
    "take the function \"normal\" or \"logistic\"";
NotTwoSides { question: String }: "adaptive",
    "\"{question}\" does not say left or right in every trial",
    "name a question of type \"comparison\", required, without \"allowSame\", \"showIf\" and \"attentionCheck\"";
NotYesOrNo { question: String }: "adaptive",
    "\"{question}\" does not say yes or no in every trial",
    "name a question of type \"singleChoice\" with two options, required, without \"truth\", \"showIf\" and \"attentionCheck\"";
YesWithoutCatchTrials: "adaptive",
    "who always says yes is not found without catch trials",
    "write for instance \"catch\": 0.2";
LevelGrid { what: String }: "adaptive", "{what}", "correct the rule";
OneRule: "adaptive", "a block follows one rule", "write either \"questPlus\" or \"staircase\"";
BetweenLevels { length: f64, apart: f64 }: "adaptive",
    "a way of {length} ends between two levels, which are {apart} apart",
    "let steps and start be multiples of that, or take other \"levels\"";
LevelNotSolved { what: String, remedy: String }: "adaptive", "{what}", "{remedy}";
NothingAgainst { against: String }: "adaptive",
    "a segment has no clip by \"{against}\" of this avatar", "add it to /stimuli/clips, or name other \"segments\"";
TooManyLevels { clips: usize, most: usize }: "adaptive",
    "{clips} clips of levels would be solved beforehand, at most {most} are", "take fewer levels or segments";
ComparedWithin { factor: String }: "pairs", "\"{factor}\" is what is compared: two clips of a pair differ in it",
    "remove it from \"within\", or compare something else";
ChoosesNoClip { question: String }: "pairs", "\"{question}\" does not choose between two clips",
    "name a question of type \"comparison\"";
ReasonChooses { question: String }: "pairs", "\"{question}\" is a second choice between the clips, no reason",
    "name a question of another type, or ask it in a block of its own";
NothingToCompare { factor: String, levels: usize }: "pairs", "the clips have {levels} level of \"{factor}\"",
    "compare a factor of which the clips have two levels or more";
CellIncomplete { why: NoCells }: "cells", "{why}",
    "add that clip to /stimuli/clips, take other \"clips\", or leave the level out of \"levels\"";
CellAmbiguous { why: NoCells }: "cells", "{why}",
    "name the factor in which they differ in \"within\", or give each a level of its own by \"factors\"";
ShareOfAll: "pairs", "a share of the pairs is asked for, and all of them", "write \"rule\": \"incomplete\", or remove \"perParticipant\"";
NoDesign { why: DesignError }: "pairs", "{why}", "write another number";
UnevenPairs { least: Counted, most: Counted }: "pairs", "a pair is shown {least}, another one {most}",
    "ask for another number of pairs";
TwoSounds { clip: String, other: String }: "two-sounds",
    "\"{clip}\" and \"{other}\" are shown in step, and each has its own sound: which is whose nobody could tell",
    "show them \"inTurn\", or take clips with one sound (name \"sound\" in \"within\")";
BesideItself { clip: String }: "beside-itself", "\"{clip}\" is to stand beside itself", "name another clip";
BlockColumn { name: String }: "name-taken",
    "\"{name}\" is the name of a column that exports of such blocks have", "give the factor or the question another name";
Conditions { conditions: usize, fewest: usize, most: usize }: "panel",
    "a page would show {conditions} conditions, {fewest} to {most} can be", "name the conditions in \"levels\"";
NoScale { question: String }: "panel", "\"{question}\" is no scale from 0 to 100",
    "name a question of type \"slider\" with \"minimum\": 0 and \"maximum\": 100, without \"showIf\" and \"attentionCheck\"";
ReferenceIsAnchor { level: String }: "panel", "\"{level}\" is the reference, and the anchor", "name two conditions";
NoCondition { level: String, conditions: String }: "panel", "\"{level}\" is no condition of the panel",
    "name one of {conditions}";
ScreensByReference: "panel", "the rule of BS.1534 goes by the hidden reference, and the panel has none",
    "name it: \"reference\"";
LevelsNotAscending: "scaling", "the levels do not ascend", "write each once, from the lowest to the highest";
LevelCount { levels: Counted, fewest: usize, most: usize }: "scaling",
    "{levels}", "take {fewest} to {most}";
NoJudgement { question: String }: "scaling",
    "\"{question}\" does not say which of two pairs differ more",
    "name a question of type \"singleChoice\" with two options in the order of the file, required, without \"truth\", \"showIf\", \"keys\" and \"attentionCheck\"";
FacesOfVideos: "reverse-correlation", "the avatar is shown by videos, of which no face can be drawn",
    "name an avatar that is drawn";
NoActionUnit { unit: String }: "reverse-correlation", "\"{unit}\" is no action unit",
    "write its number in FACS with two digits: \"AU04\", of one side \"AU04_L\" or \"AU04_R\"";
NoTrajectories { what: String }: "reverse-correlation", "{what}", "correct what it names";
NoCategories { question: String }: "reverse-correlation",
    "\"{question}\" does not say one of several categories in every trial",
    "name a question of type \"singleChoice\", required, without \"truth\", \"showIf\" and \"attentionCheck\"";
NoIntensity { question: String }: "reverse-correlation", "\"{question}\" does not say how intense a face is",
    "name a question of type \"likert\" or \"slider\", answered after the face has moved";
AskedOfClipsToo { question: String, component: String }: "several-blocks",
    "\"{question}\" is asked in \"{component}\" too: answers of blocks of different types would be mixed",
    "give the block a question of its own";
SampledPairs { component: String }: "pairs", "\"{component}\" deals its pairs itself, evenly",
    "remove \"numSamples\", and write \"schedule\": {{\"rule\": \"incomplete\", \"perParticipant\": …}}";
SureOfNoTruth { question: String }: "confidence", "\"{question}\" has no right answer, and how sure it is tells nothing of any",
    "add \"truth\", the factor of the clip that holds the right answer, or remove \"confidence\"";
NoConfidence { question: String }: "confidence", "\"{question}\" does not say how sure an answer is in every trial",
    "name a question of type \"likert\", or \"slider\" without \"whilePlaying\", without \"showIf\" and \"attentionCheck\"";
SureElsewhere { rating: String, question: String, component: String }: "confidence",
    "\"{component}\" asks \"{question}\" without \"{rating}\"",
    "add \"{rating}\" to the component's \"questions\", behind \"{question}\"";
NoKey { key: String }: "keys", "\"{key}\" is no key that every keyboard has", "write a letter, a digit, or \"Space\"";
KeyTwice { key: String }: "keys", "\"{key}\" stands for two options", "give each a key of its own";
SeveralWithoutKey: "keys", "several options have no key", "give all of them a key, or all but the one that stands for no press";
WithoutClip { question: String }: "while-playing", "\"{question}\" is answered while a clip plays, and here none does",
    "ask it in a block of type \"trials\", or remove what makes it so";
NoTrials: "empty", "no trial is shown", "name a component of type \"trials\"";
NoTrialsIn { condition: String }: "empty",
    "no trial is shown in the condition \"{condition}\"", "name a component of type \"trials\"";
TooManyTrials { trials: usize, most: usize }: "too-many", "{trials} trials", "show at most {most}";
AskedTwice { question: String }: "duplicate", "\"{question}\" is asked twice", "name it once";
AsksNothing: "empty", "trials that ask nothing", "name questions of /questions";
NoRepetition: "out-of-range", "each clip is shown 0 times", "write 1 or more";
NoClip: "empty", "no clip is chosen", "loosen the choice";
NoCompanion { clip: String, segment: String, method: String, avatar: String }: "no-companion",
    "clip \"{clip}\" has no other clip of segment \"{segment}\" by \"{method}\" on \"{avatar}\" to stand beside it",
    "make such clips in /stimuli/clips, or leave this clip out of the block";
EmptySequence: "empty", "an empty sequence", "name a component";
ShownAlready { component: String, first: String }: "duplicate",
    "\"{component}\" is shown at {first} already",
    "give its trials \"repetitions\", or write a second component";
InterruptedByTrials { component: String }: "bad-interruption",
    "\"{component}\" is a block of trials", "interrupt by a break, a page or a questionnaire";
NoSpacing: "out-of-range", "after every 0 trials", "write 1 or more";
ConstraintOnSequence { part: usize }: "constraint-on-sequence",
    "constraints order single trials, and part {part} of this sequence is a sequence that stays together",
    "write constraints in the nested sequences, or name their components here";
ConstraintOnNothing { factor: String }: "constraint-on-nothing",
    "no trial of this sequence has the factor \"{factor}\"",
    "move the constraint to the sequence with these trials, or remove it";
NoSamples: "out-of-range", "0 of the parts are shown", "write 1 or more";
OrderNotRandom: "not-needed", "constraints on an order that is not random",
    "write \"order\": \"random\", or remove the constraints";
EmptyConstraint: "empty", "a constraint that asks for nothing", "add atMostAlike or minimumDistance";
ConstraintOfZero: "out-of-range", "0 in a row, or at a distance of 0", "write 1 or more";
NoOrder { why: NoOrder, remedy: &'static str }: "unsatisfiable-order", "{why}", "{remedy}";
TooManySamples { parts: usize, samples: usize }: "too-many",
    "{samples} of {parts} parts under constraints are too many samples to try each",
    "take a numSamples that divides {parts}, or drop the constraints";
UnevenSamples { rounds: u64, anew: u64, first: u64 }: "uneven-samples",
    "of {rounds} rounds of samples after the first, {anew} had to be drawn anew to meet the constraints and {first} repeat the first: some parts will be shown together more often than others",
    "loosen the constraints or take a larger numSamples; each part is still shown equally often";

// Conditions between participants.
WholeStudyConditional: "bad-condition",
    "the whole study is conditional: nobody outside of the condition is shown anything",
    "write \"conditional\" in nested sequences, one for each condition";
OnlyCondition { name: String }: "one-condition", "\"{name}\" is the only condition: everybody is in it",
    "write a second conditional sequence; \"components\": [] for a condition with nothing of its own";
NamelessCondition: "bad-condition", "a condition without a name",
    "add \"id\": the name that addresses say (?condition=...)";
ConditionName { name: String, longest: usize }: "bad-id",
    "\"{name}\" cannot be the name of a condition: it stands in addresses",
    "use letters, digits, _ and -, {longest} at most";
ConditionInside { around: String }: "never-shown",
    "no condition shows it: it stands inside the condition \"{around}\"",
    "move it beside that sequence, or remove \"conditional\"";
ConditionSampled { name: String }: "bad-condition",
    "somebody in the condition \"{name}\" may not be shown it: a sequence around it shows only some of its parts",
    "remove numSamples there, or move the condition out";
ConditionTwice { name: String, first: String }: "duplicate", "the condition \"{name}\" is at {first} already",
    "give it another name, or put all that the condition shows into one sequence; two conditions may name the same component";

// Hypotheses and tables.
HypothesisTwice { id: String }: "duplicate", "two hypotheses \"{id}\"", "give it another name";
NoTruthOf { question: String }: "no-truth", "\"{question}\" has no right answer",
    "give the question \"truth\", or test another measure";
NotTested { question: String }: "not-a-number", "the answers to \"{question}\" are not numbers",
    "test \"measure\": \"correct\" or \"rt\", or take chi-square";
FactorCount { factors: Counted, wanted: Count }: "wrong-length",
    "{factors} for this test", "name {wanted}";
LevelTwice { level: String }: "duplicate",
    "the level \"{level}\" stands here twice", "name each level once";
NotTwoLevels { levels: Counted, factor: String }: "wrong-length",
    "{levels} of \"{factor}\" to compare", "name two in \"levels\"";
TooFewLevels { levels: Counted, factor: String }: "wrong-length",
    "{levels} of \"{factor}\" to compare", "compare at least two";
SeveralAnswers { response: String, answers: String }: "several-answers",
    "\"{response}\" gives several answers", "name one of them: {answers}";
AskedInNoTrial { question: String }: "not-asked",
    "no trial asks \"{question}\": its answers belong to no clip",
    "ask it in the trials of the sequence, or test a question that is asked there";
ChoiceOfPair { question: String, factor: String }: "of-two-clips",
    "\"{question}\" says which of two clips: its answers are of no level of \"{factor}\"",
    "take the test \"sign\" of two levels or \"bradley-terry\" of more, or test a question about one clip";
NoChoice { question: String, test: &'static str }: "no-choice",
    "\"{test}\" is a test of choices between two clips, which \"{question}\" is not",
    "name a question of type \"comparison\" and its answer, or take another test";
NoPairsOf { question: String, factor: String }: "no-pairs",
    "no two clips between which \"{question}\" chooses differ in the levels of \"{factor}\" that are compared",
    "name levels that stand beside each other in its trials, or leave out \"levels\"";
PairsInParts { question: String, parts: String }: "pairs-in-parts",
    "no answer to \"{question}\" chooses between the levels of different parts: {parts}",
    "show pairs between them, or name levels of one part";
RatingOfPair { question: String, factor: String, clip: String, beside: String }: "of-two-clips",
    "\"{question}\" rates two clips together that differ in \"{factor}\", such as \"{clip}\" beside \"{beside}\": which of them is meant nobody knows",
    "ask it in trials of one clip, or beside one and the same {factor} that is not compared; or ask which is better by a question of type \"comparison\"";
NotOfOtherClips { hypothesis: String }: "not-a-number",
    "\"{hypothesis}\" tests a correlation, which is decided for these clips alone",
    "take a test such as \"wilcoxon\" or \"friedman\", or leave out \"generalise\"";
TooFewSegments { segments: Counted, needed: usize }: "wrong-length",
    "{segments}, of which a mixed model cannot tell how far others would differ",
    "show at least {needed} segments, or leave out \"generalise\"";
FewSegments { hypothesis: String, segments: Counted, needed: usize }: "few-segments",
    "\"{hypothesis}\" is decided for other clips too, of which {segments} tell little",
    "show at least {needed} segments, or add \"generalise\": \"these clips\"";
OneSegmentPerLevel { hypothesis: String }: "few-segments",
    "\"{hypothesis}\" is decided for other clips too, but each level that it compares has one segment, so that nothing tells them apart and there will be no decision",
    "show several segments of each level, or add \"generalise\": \"these clips\"";
NoSmallestEffect { hypothesis: String }: "missing-key",
    "\"{hypothesis}\" tests equivalence without the smallest difference that matters",
    "add \"smallestEffect\" in points of the scale, such as 0.5, chosen before there are answers";
SmallestEffectOfOtherTest { test: &'static str }: "unknown-key",
    "\"{test}\" has no smallest difference that matters", "take \"test\": \"equivalence\", or leave it out";
NotASmallestEffect { value: f64 }: "out-of-range",
    "{value} is no smallest difference that matters", "write a number above 0";
SmallestEffectAsWide { value: f64, widest: f64 }: "out-of-range",
    "{value} is no smallest difference that matters: no two answers differ by more than {widest}",
    "write a difference that matters, below {widest}";
NoReasonOfSmallestEffect { hypothesis: String }: "no-reason",
    "nothing says why a smaller difference of \"{hypothesis}\" does not matter",
    "add \"smallestEffectReason\", which the preregistration prints";
TooFewItems { items: Counted, needed: usize }: "wrong-length",
    "a scale of {items}", "name at least {needed}";
ItemWithoutNumber { question: String }: "not-a-number",
    "\"{question}\" is not answered by a number, so that it cannot be added up",
    "name a rating, a typed number, or a row of a matrix whose options are numbers";
ItemsAskedApart { question: String }: "not-asked",
    "\"{question}\" is asked about the participant and others of the scale in trials, or the other way round",
    "name questions of pages, or questions of trials";
ItemWithoutRange { question: String }: "out-of-range",
    "answers to \"{question}\" have no lowest and highest, so that they cannot be turned round",
    "give the question a minimum and a maximum, or leave it out of \"reversed\"";
NoConditions { factor: String }: "no-conditions", "\"{factor}\" of a study that assigns no condition",
    "write nested sequences with \"conditional\": true, one for each condition; or name another factor";
DependentSamples { test: &'static str, instead: &'static str }: "dependent-samples",
    "\"{test}\" compares answers of one person at several levels; everybody is in one condition",
    "take \"{instead}\"";
DependentTwoWay { test: &'static str }: "dependent-samples",
    "\"{test}\" compares answers of one person at several levels; everybody is in one condition",
    "take \"scheirer-ray-hare\": its interaction with a factor of the clips is tested on each person's differences";
ConditionsUnordered { instead: &'static str }: "no-order",
    "\"spearman\" of conditions: their names have no order", "take \"{instead}\"";
ConditionNotAsked { condition: String, response: String }: "not-asked",
    "nobody in the condition \"{condition}\" is asked \"{response}\" in a trial",
    "ask it in trials of every condition that is compared, or compare others by \"levels\"";
DependentPairs: "dependent-samples",
    "the layout \"pairs\" compares answers of one person at two levels; everybody is in one condition",
    "take \"influences\" or \"means\"; a pair of conditions is a hypothesis of \"mann-whitney\"";
TableTwice { id: String }: "duplicate", "two tables \"{id}\"", "give it another name";
NoneTaken { found: usize, key: &'static str, layout: &'static str }: "wrong-length",
    "{found} {key} in the layout \"{layout}\"", "leave them out";
TakenCount { found: usize, key: &'static str, layout: &'static str, wanted: Count }: "wrong-length",
    "{found} {key} in the layout \"{layout}\"", "name {wanted}";
NoHypotheses: "unknown-reference", "the study has no hypotheses", "state hypotheses";
LevelsFollowAnswers { question: String }: "adaptive",
    "\"{question}\" is asked in an adaptive block, whose levels follow its answers: they are of no level alone",
    "leave it out here; the report has the threshold of each person and their mean";
JudgesDifferences { question: String }: "scaling",
    "\"{question}\" says which of two differences is larger: its answers are of no clip",
    "leave it out here; the report has the scale of the levels";
DrawnAtRandom { question: String }: "reverse-correlation",
    "\"{question}\" is asked of faces that are drawn at random: its answers are of no clip",
    "leave it out here; the report has the image of each category";
NoTruthInTable { response: String }: "no-truth",
    "\"{response}\" has no right answer", "give the question \"truth\"";
}

impl Problem {
    /// There is no `what` (`clip`) of this name; `known` are those that there are.
    pub(crate) fn unknown<T: AsRef<str>>(
        what: &'static str,
        name: &str,
        known: impl IntoIterator<Item = T>,
    ) -> Self {
        Self::UnknownReference { what, name: name.to_owned(), known: Nearest::to(name, known) }
    }
}

impl From<AnswerOfPair> for Problem {
    fn from(of: AnswerOfPair) -> Self {
        match of {
            AnswerOfPair::Choice { question, factor } => Self::ChoiceOfPair { question, factor },
            AnswerOfPair::Rating { question, factor, clip, beside } => {
                Self::RatingOfPair { question, factor, clip, beside }
            }
        }
    }
}

impl From<PathError> for Problem {
    fn from(PathError { path, why }: PathError) -> Self {
        Self::Variable { path, remedy: why.remedy(), why }
    }
}

impl From<SyntaxError> for Problem {
    fn from(SyntaxError { place, what, remedy }: SyntaxError) -> Self {
        Self::Syntax { place, what, remedy }
    }
}
