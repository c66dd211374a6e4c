//! The sessions of a study that was hosted as files, out of what was posted or downloaded: a session a file, several one
//! after the other (what JATOS exports as data), parts of sessions, archives of such files (what JATOS exports whole).

use std::collections::BTreeMap;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use mimique_server::ZIP_START;
use mimique_session::SessionFile;
use zip::ZipArchive;

/// Sessions by their identifier, each with the place that it was first read from.
#[derive(Default)]
pub(super) struct Sessions {
    known: BTreeMap<String, (String, SessionFile)>,
    /// Files read.
    pub(super) read: usize,
}

impl Sessions {
    /// The sessions of the files named, all of one version of the study.
    pub(super) fn read(
        named: &[PathBuf],
        study: &str,
        study_file: &Path,
        config_hash: &str,
    ) -> anyhow::Result<Self> {
        let mut sessions = Sessions::default();
        for path in session_files(named)? {
            for (at, text) in texts(&path)? {
                sessions.read += 1;
                for session in SessionFile::read_all(&text).with_context(|| at.clone())? {
                    anyhow::ensure!(
                        session.study == study,
                        "{at}: a session of study {}, not of {study}; leave it out, or name its study file",
                        session.study
                    );
                    let there = &session.started.config_hash;
                    anyhow::ensure!(
                        there == config_hash,
                        "{at}: a session of version {}, and {} is version {}; give the file that the site was made from",
                        short(there),
                        study_file.display(),
                        short(config_hash)
                    );
                    sessions.add(&at, session)?;
                }
            }
        }
        sessions.are_whole()?;
        Ok(sessions)
    }

    /// Adds what a file holds: a session, or more or less of one that is known.
    fn add(&mut self, at: &str, session: SessionFile) -> anyhow::Result<()> {
        let id = &session.started.session;
        let Some((first, known)) = self.known.get_mut(id) else {
            self.known.insert(id.clone(), (at.to_owned(), session));
            return Ok(());
        };
        anyhow::ensure!(
            known.started == session.started && known.join(session).is_ok(),
            "{at}: the same session as {first}, with other answers; leave one of them out"
        );
        Ok(())
    }

    /// Whether no part is missing before another one.
    fn are_whole(&self) -> anyhow::Result<()> {
        for (at, session) in self.known.values() {
            if let Some(missing) = session.first_missing() {
                let id = &session.started.participant_id;
                anyhow::bail!(
                    "{at}: event {missing} of session {id} is missing; give all that was posted of it, or its file as it was downloaded"
                );
            }
        }
        Ok(())
    }

    /// The sessions, the first to begin first.
    pub(super) fn in_order_of_time(&self) -> Vec<&SessionFile> {
        let begun = |session: &SessionFile| session.events.first().map_or(0.0, |event| event.at_ms);
        let mut sessions: Vec<_> = self.known.values().map(|(_, session)| session).collect();
        sessions.sort_by(|left, right| begun(left).total_cmp(&begun(right)));
        sessions
    }
}

/// The texts of a file, each with its place: its own, or those of the archive that it is.
fn texts(path: &Path) -> anyhow::Result<Vec<(String, String)>> {
    let at = path.display().to_string();
    let bytes = std::fs::read(path)
        .map_err(|error| anyhow::anyhow!("cannot be read ({error}); check the path"))
        .with_context(|| at.clone())?;
    if bytes.starts_with(ZIP_START) {
        return archived(&bytes).with_context(|| at);
    }
    let text = String::from_utf8(bytes)
        .map_err(|error| {
            anyhow::anyhow!("is not text ({error}); give what was posted or downloaded")
        })
        .with_context(|| at.clone())?;
    Ok(vec![(at, text)])
}

/// The texts of an archive that are results: JATOS puts those of a run into a `data.txt`, beside files about it.
fn archived(archive: &[u8]) -> anyhow::Result<Vec<(String, String)>> {
    let mut archive = ZipArchive::new(std::io::Cursor::new(archive))?;
    let mut texts = Vec::new();
    for index in 0..archive.len() {
        let mut entry = archive.by_index(index)?;
        let name = entry.name()?.into_owned();
        if !name.ends_with(".txt") && !name.ends_with(".jsonl") {
            continue;
        }
        let mut text = String::new();
        entry.read_to_string(&mut text).with_context(|| name.clone())?;
        // A run that nobody began has no result.
        if !text.trim().is_empty() {
            texts.push((name, text));
        }
    }
    anyhow::ensure!(
        !texts.is_empty(),
        "no result is in the archive (*.txt or *.jsonl); export the results with their data"
    );
    Ok(texts)
}

fn short(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}

/// The files named, and those of folders that end in `.jsonl`.
fn session_files(named: &[PathBuf]) -> anyhow::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for path in named {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        let entries = std::fs::read_dir(path).with_context(|| path.display().to_string())?;
        let mut found: Vec<PathBuf> = entries
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| path.extension().is_some_and(|end| end == "jsonl"))
            .collect();
        anyhow::ensure!(
            !found.is_empty(),
            "{}: no file ends in .jsonl; name the files",
            path.display()
        );
        found.sort();
        files.extend(found);
    }
    Ok(files)
}
