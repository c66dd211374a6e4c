//! Which answers may be shared: rows and columns of the tidy export that go into a capsule, and what stays out.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use anyhow::{Context as _, anyhow, ensure};
use mimique_session::Standing;
use mimique_study::columns::EXCLUSION_COLUMNS;
use mimique_study::{KindOfQuestion as _, Study};

use super::logs::Logs;

/// The answers of a capsule.
pub struct Answers {
    names: Vec<String>,
    rows: Vec<Vec<String>>,
    /// What stayed out.
    pub left_out: LeftOut,
}

/// What stays out of a capsule.
#[derive(Debug, Default)]
pub struct LeftOut {
    /// People who withdrew.
    pub withdrawn: BTreeSet<String>,
    /// People who did not agree.
    pub declined: BTreeSet<String>,
    /// People who stand in one of the two exports alone: they may have been erased between them.
    pub in_one_alone: BTreeSet<String>,
    /// Columns with identifiers of recruitment.
    pub identifiers: Vec<String>,
    /// Questions answered in people's own words.
    pub texts: BTreeSet<String>,
}

impl Answers {
    /// Reads the tidy export; texts that people wrote stay out unless `keep_texts`.
    pub fn read(path: &Path, study: &Study, logs: &Logs, keep_texts: bool) -> anyhow::Result<Self> {
        let mut reader = csv::Reader::from_path(path)
            .map_err(|error| anyhow!("cannot be read ({error}); check the path"))?;
        let unreadable = |error: csv::Error| {
            anyhow!("{error}; give the tidy export, as `mimique export --format csv` writes it")
        };
        let names: Vec<String> =
            reader.headers().map_err(unreadable)?.iter().map(str::to_owned).collect();
        let place = |name: &str| {
            names.iter().position(|own| own == name).with_context(|| {
                format!(
                    "line 1: there is no column {name}; give the tidy export, as `mimique export --format csv` writes it"
                )
            })
        };
        let (person, status, response) =
            (place("participant_id")?, place("status")?, place("response_id")?);
        let texts = if keep_texts { BTreeSet::new() } else { texts_of(study) };
        // Identifiers stand behind the columns on exclusion, where there are any.
        let end = names.iter().position(|name| name == EXCLUSION_COLUMNS[1]);
        let kept = end.map_or(names.len(), |place| place + 1);
        let mut left_out = LeftOut { identifiers: names[kept..].to_vec(), ..LeftOut::default() };
        let mut found = BTreeSet::new();
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(unreadable)?;
            let mut row: Vec<String> = record.iter().take(kept).map(str::to_owned).collect();
            let id = row[person].clone();
            found.insert(id.clone());
            let is = |standing: Standing| row[status] == standing.export_word();
            if is(Standing::Withdrawn) || logs.withdrawn.contains(&id) {
                left_out.withdrawn.insert(id);
                continue;
            }
            if is(Standing::Declined) {
                left_out.declined.insert(id);
                continue;
            }
            if !logs.people.contains_key(&id) {
                left_out.in_one_alone.insert(id);
                continue;
            }
            blank(&mut row, &names, response, &texts);
            rows.push(row);
        }
        let alone = logs.people.keys().filter(|id| !found.contains(*id));
        left_out.in_one_alone.extend(alone.cloned());
        left_out.texts = texts;
        ensure!(
            !rows.is_empty(),
            "no row is left of people who are in both exports and have not withdrawn; give the two exports of one moment"
        );
        Ok(Self { names: names[..kept].to_vec(), rows, left_out })
    }

    /// As CSV.
    pub fn csv(&self) -> anyhow::Result<Vec<u8>> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(&self.names)?;
        for row in &self.rows {
            writer.write_record(row)?;
        }
        writer.into_inner().map_err(|error| anyhow!("{error}"))
    }

    /// The columns.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The rows, by the columns' names.
    pub fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(|cells| Row { names: &self.names, cells })
    }

    /// The first row of each person, by `participant_id`.
    pub fn people(&self) -> BTreeMap<&str, Row<'_>> {
        let mut people = BTreeMap::new();
        for row in self.rows() {
            people.entry(row.get("participant_id")).or_insert(row);
        }
        people
    }
}

/// A row of the export.
#[derive(Clone, Copy)]
pub struct Row<'a> {
    names: &'a [String],
    cells: &'a [String],
}

impl<'a> Row<'a> {
    /// A cell by the name of its column; empty where there is no such column.
    pub fn get(self, name: &str) -> &'a str {
        let place = self.names.iter().position(|own| own == name);
        place.and_then(|place| self.cells.get(place)).map_or("", String::as_str)
    }
}

/// Identifiers of the questions that people answer in their own words.
fn texts_of(study: &Study) -> BTreeSet<String> {
    let free = study.all_questions().filter(|question| question.kind.is_free_text());
    free.flat_map(|question| question.response_ids()).collect()
}

/// Takes texts out of a row: of its own response, and of what was answered about the person.
fn blank(row: &mut [String], names: &[String], response: usize, texts: &BTreeSet<String>) {
    let is_text = texts.contains(&row[response]);
    for (cell, name) in row.iter_mut().zip(names) {
        if texts.contains(name) || (is_text && ["answer", "response"].contains(&name.as_str())) {
            cell.clear();
        }
    }
}
