//! What is personal in an export: recruitment identifiers, texts that people wrote, times of the clock, and values that
//! look like addresses or numbers of persons. Nothing of it is deposited before somebody has said so.

mod answers;
mod pattern;
mod rare;

use std::collections::{BTreeMap, BTreeSet, HashMap};

use mimique_session::rows::Column;
use mimique_study::columns::{ColumnKind, EXCLUSION_COLUMNS};
use mimique_study::{KindOfQuestion as _, Study};
use serde_json::Value;

pub use self::answers::{Answers, Judged, NotAnswered, Texts};
pub use self::pattern::{Pattern, patterns};
pub use self::rare::{Rare, rare};
use crate::responses::Responses;

/// Names that recruiting services give to their identifiers, in small letters, beside those that the study names.
const RECRUITMENT: [&str; 10] = [
    "prolific_pid",
    "study_id",
    "session_id",
    "workerid",
    "worker_id",
    "assignmentid",
    "hitid",
    "survey_code",
    "sona_id",
    "participantid_external",
];

/// Why something is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// The identifier of a recruiting service; it is never deposited.
    RecruitmentIdentifier,
    /// A text that somebody wrote.
    FreeText,
    /// A column that is none of the study's.
    AddedColumn,
    /// A time of the clock: with a list of who took part when, it says who answered.
    ClockTime,
    /// A value that looks like something of a person's.
    Looks(Pattern),
}

impl Kind {
    /// What it is called.
    pub fn words(self) -> &'static str {
        match self {
            Self::RecruitmentIdentifier => "identifier of a recruiting service",
            Self::FreeText => "text that somebody wrote",
            Self::AddedColumn => "column that is none of the study's",
            Self::ClockTime => "time of the clock",
            Self::Looks(pattern) => pattern.words(),
        }
    }
}

/// Something personal in a file.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Finding {
    /// The file, by its path in the deposit.
    pub file: String,
    /// What it is answered by: the name of the column, or of the question whose answers these are.
    pub key: String,
    /// Whether the key is a question, whose answers stand in `answer` and `response`.
    pub is_question: bool,
    /// Why it is looked at.
    pub kind: Kind,
    /// How many values there are: cells, or answers.
    pub values: usize,
    /// Of how many people; none of tables without people.
    pub people: usize,
    /// Line of the file where the first stands, from 1 (of rows that break no line).
    pub first_line: usize,
}

/// The cells of an answer: what is left empty where a text is left out.
pub(crate) const ANSWER_CELLS: [&str; 2] = ["answer", "response"];

/// Columns whose text is the machine's own, in digits that mean nobody: hashes.
const HASHES: [&str; 6] =
    ["config_hash", "weights_hash", "provenance", "beside_provenance", "renderer", "sound_file"];

/// Everything personal in an export, by file, key and kind.
pub fn personal(
    responses: &Responses,
    file: &str,
    versions: &[&Study],
    known: &BTreeMap<String, Column>,
) -> Vec<Finding> {
    let written = written_texts(versions);
    let named = recruitment_names(versions);
    let mut found = Found::new(file, responses);
    let asked = responses.column("response_id");
    let answers: Vec<usize> =
        ["answer", "response"].iter().filter_map(|name| responses.column(name)).collect();
    for (place, name) in responses.columns().iter().enumerate() {
        let of_whole = kind_of_column(name, &written, &named, known);
        // Most values stand in many rows.
        let mut seen: HashMap<&str, Vec<Pattern>> = HashMap::new();
        for (row, cells) in responses.rows().iter().enumerate() {
            let cell = cells[place].as_str();
            if cell.is_empty() {
                continue;
            }
            let is_answer = answers.contains(&place);
            // `response` says what `answer` says, but where somebody has changed one of them.
            let is_repeated = is_answer && answers[0] != place && cells[answers[0]] == cell;
            if is_repeated {
                continue;
            }
            let question = asked.filter(|_| is_answer).map(|asked| cells[asked].as_str());
            let key = question.unwrap_or(name);
            let of_text = question.filter(|asked| written.contains(*asked));
            if let Some(kind) = of_text.map(|_| Kind::FreeText).or(of_whole.filter(|_| !is_answer))
            {
                found.add(row, key, is_answer, kind);
            }
            let is_left_out = of_whole == Some(Kind::RecruitmentIdentifier);
            if is_left_out || !(is_answer || is_searched(name, known, cell)) {
                continue;
            }
            for pattern in seen.entry(cell).or_insert_with(|| patterns(cell)) {
                found.add(row, key, is_answer, Kind::Looks(*pattern));
            }
        }
    }
    found.into_findings()
}

/// What in a study file looks like an address or a number of somebody's, by JSON pointer: participants were shown it.
pub fn addresses_in_study(file: &Value) -> Vec<(String, Pattern)> {
    let mut found = Vec::new();
    walk(file, &mut String::new(), &mut found);
    // The addresses of web pages are no persons'.
    found.retain(|(_, pattern)| *pattern != Pattern::WebAddress);
    found
}

fn walk(value: &Value, pointer: &mut String, found: &mut Vec<(String, Pattern)>) {
    let length = pointer.len();
    match value {
        Value::String(text) => {
            found.extend(patterns(text).into_iter().map(|pattern| (pointer.clone(), pattern)));
        }
        Value::Array(values) => {
            for (place, value) in values.iter().enumerate() {
                pointer.push_str(&format!("/{place}"));
                walk(value, pointer, found);
                pointer.truncate(length);
            }
        }
        Value::Object(values) => {
            for (key, value) in values {
                pointer.push_str(&format!("/{}", key.replace('~', "~0").replace('/', "~1")));
                walk(value, pointer, found);
                pointer.truncate(length);
            }
        }
        _ => {}
    }
}

/// The questions whose answers are texts, in any version of the study.
fn written_texts(versions: &[&Study]) -> BTreeSet<String> {
    let questions = versions.iter().copied().flat_map(Study::all_questions);
    let written = questions.filter(|question| question.kind.is_free_text());
    written.flat_map(|question| question.response_ids()).collect()
}

/// The identifiers that the study's addresses carry, in small letters.
fn recruitment_names(versions: &[&Study]) -> BTreeSet<String> {
    let of = |study: &&Study| study.recruitment.url_parameters.clone();
    let own = versions.iter().flat_map(of).map(|name| name.to_lowercase());
    own.chain(RECRUITMENT.map(str::to_owned)).collect()
}

/// Why every value of a column is looked at.
fn kind_of_column(
    name: &str,
    written: &BTreeSet<String>,
    named: &BTreeSet<String>,
    known: &BTreeMap<String, Column>,
) -> Option<Kind> {
    let Some(column) = known.get(name) else {
        let is_identifier = named.contains(&name.to_lowercase());
        return Some(if is_identifier { Kind::RecruitmentIdentifier } else { Kind::AddedColumn });
    };
    if written.contains(name) || name == EXCLUSION_COLUMNS[1] {
        return Some(Kind::FreeText);
    }
    (column.kind == ColumnKind::Time).then_some(Kind::ClockTime)
}

/// Whether a cell is searched: all but hashes, and what its column says that it is.
fn is_searched(name: &str, known: &BTreeMap<String, Column>, cell: &str) -> bool {
    if HASHES.contains(&name) {
        return !cell.bytes().all(|byte| byte.is_ascii_hexdigit());
    }
    match known.get(name).map(|column| column.kind) {
        Some(ColumnKind::Integer | ColumnKind::Number) => cell.parse::<f64>().is_err(),
        Some(ColumnKind::Boolean) => !matches!(cell, "true" | "false"),
        Some(ColumnKind::Time) => mimique_study::instant_ms(cell).is_none(),
        Some(ColumnKind::Text | ColumnKind::Any) | None => true,
    }
}

/// Findings on their way.
struct Found<'a> {
    file: &'a str,
    responses: &'a Responses,
    person: Option<usize>,
    by_key: BTreeMap<(String, bool, Kind), Gathered>,
}

#[derive(Default)]
struct Gathered {
    values: usize,
    people: BTreeSet<String>,
    first_row: Option<usize>,
}

impl<'a> Found<'a> {
    fn new(file: &'a str, responses: &'a Responses) -> Self {
        let person = responses.column("participant_id");
        Self { file, responses, person, by_key: BTreeMap::new() }
    }

    fn add(&mut self, row: usize, key: &str, is_question: bool, kind: Kind) {
        let gathered = self.by_key.entry((key.to_owned(), is_question, kind)).or_default();
        gathered.values += 1;
        gathered.first_row.get_or_insert(row);
        if let Some(person) = self.person {
            let person = &self.responses.rows()[row][person];
            if !gathered.people.contains(person) {
                gathered.people.insert(person.clone());
            }
        }
    }

    fn into_findings(self) -> Vec<Finding> {
        let file = self.file;
        let finding = |((key, is_question, kind), gathered): (_, Gathered)| Finding {
            file: file.to_owned(),
            key,
            is_question,
            kind,
            values: gathered.values,
            people: gathered.people.len(),
            first_line: gathered.first_row.unwrap_or_default() + 2,
        };
        self.by_key.into_iter().map(finding).collect()
    }
}
