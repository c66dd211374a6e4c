//! The columns that every export has, by the names that people's scripts expect.

use serde::Serialize;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ColumnKind {
    /// Words.
    Text,
    /// Whole numbers.
    Integer,
    /// Numbers.
    Number,
    /// `true`, `false`.
    Boolean,
    /// `YYYY-MM-DDThh:mm:ss.sssZ`.
    Time,
    /// A word or a number, by the row's response.
    Any,
}

/// What the researcher decides on, at the end of every row: whether the participant is excluded, why.
pub const EXCLUSION_COLUMNS: [&str; 2] = ["excluded", "exclusion_reason"];

/// Which condition the participant is in; in exports of studies with conditions, after `condition`.
pub const ASSIGNED_CONDITION: &str = "assigned_condition";

/// What was heard, in exports of studies whose clips have sound, after `beside_drift_ms`: name, kind, unit, what it
/// means.
pub const SOUND_COLUMNS: [(&str, ColumnKind, &str, &str); 11] = {
    use ColumnKind::{Boolean, Integer, Number, Text};
    [
        (
            "sound_check",
            Text,
            "",
            "Whether the participant heard the tones of the sound check: heard, miscounted, or not_heard, as they say",
        ),
        ("sound_check_correct", Integer, "", "Rounds of its last attempt that were right"),
        ("sound_check_attempts", Integer, "", "How often the rounds were gone through"),
        (
            "sound_status",
            Text,
            "",
            "Of a clip with sound: played, or why not: suspended, undecodable, no_audio, interrupted, not_started",
        ),
        (
            "sound_offset_ms",
            Number,
            "ms",
            "When the sound of the segment's first frame was heard, after the first drawn frame; a delay that the study asks for is part of it",
        ),
        ("sound_delay_ms", Number, "ms", "The delay that the study asks for"),
        (
            "sound_drift_ms",
            Number,
            "ms",
            "How much later the sound was, beside the face, at the last frame than at the first",
        ),
        (
            "sound_latency_ms",
            Number,
            "ms",
            "From the audio clock to the loudspeaker, as assumed in the offset",
        ),
        (
            "sound_latency_source",
            Text,
            "",
            "What gave that latency: timestamp (the browser's output timestamp), outputLatency, baseLatency, none",
        ),
        ("captions_shown", Boolean, "", "Whether captions were shown when the clip was played"),
        ("sound_file", Text, "", "SHA-256 of the file of sound that was played"),
    ]
};

/// Of studies that measure participants' faces, after `beside_drift_ms`: name, kind, unit, what it means.
pub const MIMICRY_COLUMNS: [(&str, ColumnKind, &str, &str); 8] = {
    use ColumnKind::{Integer, Text};
    [
        (
            "mimicry_consent",
            Text,
            "",
            "Whether the participant agreed that the face is measured: agreed, declined",
        ),
        ("mimicry_version", Text, "", "Version of the text that this is the answer to"),
        (
            "mimicry_camera",
            Text,
            "",
            "What became of it: seen, a face was in the picture; not_seen; refused, no_camera, failed, insecure: why there is no picture; off of those who declined or went on without",
        ),
        (
            "mimicry_status",
            Text,
            "",
            "Of the play: tracked, or why nothing was measured: stopped by the participant, lost (no camera any more), failed, starting; empty of those who take part without",
        ),
        ("mimicry_pictures", Integer, "", "Pictures of the camera that were measured in the play"),
        ("mimicry_faces", Integer, "", "Pictures of these in which a face was found"),
        (
            "mimicry_clock",
            Text,
            "",
            "What their times are of: capture, when the camera took the picture; presented, when the browser had it",
        ),
        ("mimicry_model", Text, "", "SHA-256 of the model that measured"),
    ]
};

/// Of studies with triggers, after `beside_drift_ms`: name, kind, unit, what it means.
pub const TRIGGER_COLUMN: (&str, ColumnKind, &str, &str) = (
    "triggers_sent",
    ColumnKind::Integer,
    "",
    "Messages of the play that were sent to another program on the machine; empty where it was not there at the onset",
);

/// Of trials of adaptive blocks, in exports of studies that have such a block, after `chosen`: name, kind, unit, what
/// it means.
pub const LEVEL_COLUMNS: [(&str, ColumnKind, &str, &str); 6] = {
    use ColumnKind::{Boolean, Integer, Number};
    [
        ("track", Integer, "", "Of a trial of an adaptive block: its track, from 1"),
        ("level", Number, "", "The level that was shown, in the unit of the varied parameter"),
        (
            "level_catch",
            Boolean,
            "",
            "Whether it is a catch trial: at the easiest level, and no track counts it",
        ),
        (
            "posterior_mean",
            Number,
            "",
            "QUEST+: mean of the track's threshold after this answer, in the unit of the level",
        ),
        ("posterior_sd", Number, "", "QUEST+: its standard deviation"),
        (
            "level_replayed",
            Boolean,
            "",
            "Whether seed and answers give this level again; false is an error of the session",
        ),
    ]
};

/// Of trials whose weights are known without the browser, in exports of studies with adaptive blocks, blocks of
/// difference scaling or reverse correlation, after `chosen`: name, kind, unit, what it means.
pub const WEIGHTS_EXPECTED_COLUMN: (&str, ColumnKind, &str, &str) = (
    "weights_expected",
    ColumnKind::Boolean,
    "",
    "Whether the weights that the browser showed are those that were solved beforehand, or that the seed gives again",
);

/// Of trials of blocks of difference scaling, in exports of studies that have such a block, after `chosen`: name, kind,
/// unit, what it means.
pub const SCALING_COLUMNS: [(&str, ColumnKind, &str, &str); 2] = [
    (
        "scaled_levels",
        ColumnKind::Text,
        "",
        "Of a judgement of differences: the levels of the clips as they stand, a list in JSON",
    ),
    (
        "second_differs_more",
        ColumnKind::Boolean,
        "",
        "Whether the second pair was said to differ more: of three clips the second and the third, of four the last two",
    ),
];

/// Of trials of blocks of reverse correlation, in exports of studies that have such a block, after `chosen`: name, kind,
/// unit, what it means.
pub const TRAJECTORIES_COLUMN: (&str, ColumnKind, &str, &str) = (
    "trajectories",
    ColumnKind::Text,
    "",
    "Of a face that was drawn at random: the course of each of its action units, a list in JSON (unit, onset_s, peak_s, offset_s, amplitude, acceleration, deceleration)",
);

/// Of ratings that follow the clip, in exports of studies that have such a question, after `answer`: name, kind, unit,
/// what it means.
pub const TRACE_COLUMN: (&str, ColumnKind, &str, &str) = (
    "trace",
    ColumnKind::Text,
    "",
    "Of a rating that follows the clip: where the line stood, 60 times a second from the first frame to the last, a list in JSON; answer is its mean",
);

/// Of trials of panels, in exports of studies that have such a block, after `chosen`: name, kind, unit, what it means.
pub const PANEL_COLUMNS: [(&str, ColumnKind, &str, &str); 4] = {
    use ColumnKind::{Integer, Text};
    [
        (
            "panel_condition",
            Text,
            "",
            "Of a clip of a panel: its condition, the level of the compared factor",
        ),
        ("panel_role", Text, "", "reference (the hidden one), anchor, or condition"),
        ("panel_place", Integer, "", "Its place on the page, from 1, which stands for A"),
        (
            "panel_replays",
            Integer,
            "",
            "Whole plays of this clip alone, after the first play of all",
        ),
    ]
};

/// Of trials of blocks of pairs, in exports of studies that have such a block, after `chosen`: name, kind, unit, what
/// it means.
pub const PAIR_COLUMNS: [(&str, ColumnKind, &str, &str); 5] = {
    use ColumnKind::{Integer, Text};
    [
        (
            "item_left",
            Text,
            "",
            "Of a pair: the level of the clip on the left (of clips in turn, the first)",
        ),
        (
            "item_right",
            Text,
            "",
            "The level of the clip on the right (of clips in turn, the second)",
        ),
        ("item_chosen", Text, "", "The level that was chosen; empty for no difference"),
        ("cell", Text, "", "What the two clips are alike in: the levels of `within`, joined by |"),
        (
            "batch",
            Integer,
            "",
            "Of a pair that was chosen by the answers so far: its batch, from 1; empty of pairs that were dealt",
        ),
    ]
};

/// Columns of the table of stimuli that are no measures; the factors of the clips stand behind them.
pub const STIMULI_COLUMNS: [&str; 7] =
    ["stimulus", "segment", "avatar", "method", "duration_ms", "provenance", "weights_hash"];

/// Columns of the table of participants' faces (`mimique export --format tracks`); the 52 scores from 0 to 1
/// ([`crate::TRACKED_SHAPES`]) stand behind them.
pub const TRACK_COLUMNS: [&str; 10] = [
    "participant_id",
    "stage",
    "trial_id",
    "stimulus",
    "beside",
    "provenance",
    "play",
    "whole",
    "time_ms",
    "face",
];

/// Columns of the table of the clips' courses (`mimique export --courses`); the 51 shapes of [`crate::TRACKED_SHAPES`]
/// stand behind them.
pub const COURSE_COLUMNS: [&str; 3] = ["stimulus", "provenance", "time_ms"];

/// Whether a column of exports is called so: nothing of a study may be. Columns of blocks ([`LEVEL_COLUMNS`] and the like) are only
/// taken where there are such blocks.
pub fn is_reserved_column(name: &str) -> bool {
    name == ASSIGNED_CONDITION
        || EXCLUSION_COLUMNS.contains(&name)
        || name == TRIGGER_COLUMN.0
        || name == TRACE_COLUMN.0
        || MIMICRY_COLUMNS.iter().any(|(column, ..)| *column == name)
        || SOUND_COLUMNS.iter().any(|(column, ..)| *column == name)
        || FIXED_COLUMNS.iter().any(|(column, ..)| *column == name)
}

/// Columns that every study has, in order; the factors stand after `stimulus`, the answers about
/// the participant at the end.
pub const FIXED_COLUMNS: [(&str, ColumnKind, &str, &str); 53] = {
    use ColumnKind::{Any, Boolean, Integer, Number, Text, Time};
    [
        ("participant_id", Text, "", "Public identifier of the participant"),
        ("participant", Integer, "", "Participant number, given once"),
        (
            "slot",
            Integer,
            "",
            "Place in the balance of conditions; with seed and config_hash it decides the order",
        ),
        ("trial_id", Text, "", "Identifier of the trial or page"),
        ("trial_index", Integer, "", "Place among all pages and trials of the session, from 0"),
        (
            "trial_order",
            Integer,
            "",
            "Place among the trials (or among the practice trials), from 1",
        ),
        (
            "trial_type",
            Text,
            "",
            "trial, training, demographics, questionnaire, or screening: why a session ended early",
        ),
        ("condition", Text, "", "Sequence or block that the trial belongs to"),
        ("stage", Text, "", "pilot or live"),
        (
            "status",
            Text,
            "",
            "How the session stands: completed, active, withdrawn, declined, screened_out, failed_checks",
        ),
        ("stimulus", Text, "", "Identifier of the clip"),
        ("beside", Text, "", "Clip shown in step beside it"),
        ("beside_side", Text, "", "Side of that clip: left or right"),
        ("response_id", Text, "", "Identifier of the question"),
        ("answer", Any, "", "The answer; scales are coded as shown, several choices joined by |"),
        ("response", Any, "", "The same as answer"),
        ("truth", Any, "", "The right answer, where the clip has one"),
        ("correct", Boolean, "", "Whether the answer is the right one"),
        ("chosen", Text, "", "Of a comparison: the clip that was chosen"),
        ("attention_passed", Boolean, "", "Whether an attention check was passed"),
        (
            "rt",
            Number,
            "ms",
            "From the first frame of the first whole play (of a page: from its showing) to the last change of this answer",
        ),
        (
            "rt_open",
            Number,
            "ms",
            "From when answers could first be given (a trial's clip was seen whole) to the last change of this answer",
        ),
        ("duration", Number, "ms", "From the start of the trial or page to its end"),
        (
            "time_elapsed",
            Number,
            "ms",
            "From the opening of the session to the end of the trial or page",
        ),
        ("replays", Integer, "", "Whole plays beside the first; those before a reload count"),
        (
            "interruptions",
            Integer,
            "",
            "Plays cut short, and reloads of the page, of a trial before its clip was seen whole",
        ),
        ("focus_losses", Integer, "", "Times the page lost the focus or was hidden"),
        ("timed_out", Boolean, "", "Whether the time limit ended it"),
        ("fullscreen", Boolean, "", "Whether the page filled the screen"),
        (
            "onset_ms",
            Number,
            "ms",
            "First frame of the first whole play, after the opening of the session",
        ),
        ("frames", Integer, "", "Frames shown in that play"),
        ("frames_late", Integer, "", "Frames of it that came late"),
        ("frame_longest_ms", Number, "ms", "Longest time between two of its frames"),
        ("refresh_hz", Number, "Hz", "Rate of the display as measured"),
        ("backend", Text, "", "What drew the clip: webgpu or webgl2"),
        (
            "beside_drift_ms",
            Number,
            "ms",
            "Side by side: largest time between what the two clips showed in one frame",
        ),
        ("clip_width", Number, "px", "Width of the clip as shown, CSS pixels"),
        ("clip_height", Number, "px", "Height of the clip as shown, CSS pixels"),
        ("viewport", Text, "px", "Width x height of the window, CSS pixels"),
        ("px_per_mm", Number, "px/mm", "CSS pixels per millimetre, by the card held to the screen"),
        (
            "viewing_distance_cm",
            Number,
            "cm",
            "Distance from eyes to screen, as the participant says",
        ),
        ("device_pixel_ratio", Number, "", "Device pixels per CSS pixel"),
        ("weights_hash", Text, "", "SHA-256 of the weights as the browser solved them"),
        (
            "provenance",
            Text,
            "",
            "SHA-256 over avatar, capture, marker map, method, parameters and solver",
        ),
        ("beside_provenance", Text, "", "The same of the clip beside it"),
        ("renderer", Text, "", "Hash of the modules and shaders that drew the clip"),
        ("start_time", Time, "", "Start of the trial or page, UTC, the participant's clock"),
        ("end_time", Time, "", "Its end"),
        ("language", Text, "", "Language of the pages"),
        ("consent_version", Text, "", "Version of the agreement"),
        ("seed", Integer, "", "Seed of the study's random streams"),
        ("config_hash", Text, "", "SHA-256 of the canonical study file"),
        ("browser", Text, "", "Browser name, major version and platform class"),
    ]
};
