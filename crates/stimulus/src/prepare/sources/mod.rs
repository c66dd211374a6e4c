//! The avatars, captures and marker maps that a study file names, each read once.

mod avatars;
mod captures;
mod performances;
mod recordings;

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use mimique_study::{Segment, Study, resolve_path};

use crate::Training;
use crate::prepare::exertion::ExertionWeights;
use crate::prepare::known::Asked;
use crate::prepare::source_files::{AvatarFile, CaptureFile};
use crate::prepare::{Places, PrepareError, pointer};

pub(super) use captures::unit_of;

/// Everything that a study file names.
pub(super) struct Sources<'a> {
    study: &'a Study,
    places: &'a Places,
    avatars: RefCell<BTreeMap<String, Result<Rc<AvatarFile>, PrepareError>>>,
    captures: RefCell<BTreeMap<String, Result<Rc<CaptureFile>, PrepareError>>>,
    trainings: RefCell<BTreeMap<String, Rc<Training>>>,
    asked: Asked,
    /// Weights of exertions, by their captures.
    exertions: RefCell<BTreeMap<String, Rc<ExertionWeights>>>,
}

impl<'a> Sources<'a> {
    pub fn new(study: &'a Study, places: &'a Places) -> Self {
        let (avatars, captures, trainings, exertions, asked) = Default::default();
        Self { study, places, avatars, captures, trainings, exertions, asked }
    }

    /// The files that were asked for.
    pub fn asked(&self) -> &Asked {
        &self.asked
    }

    fn segment(&self, id: &str) -> Result<(&'a Segment, String), PrepareError> {
        let segments = &self.study.stimuli.segments;
        let index = segments.iter().position(|s| s.id == id).ok_or_else(|| {
            PrepareError::new("/stimuli/segments", format!("no segment {id:?}; add it"))
        })?;
        Ok((&segments[index], pointer(&["stimuli", "segments", &index.to_string()])))
    }

    /// The path of a file that the study names.
    fn path(&self, file: &str, at: &str) -> Result<PathBuf, PrepareError> {
        let path = resolve_path(file, &self.places.study, self.places.data.as_deref())
            .map_err(|e| PrepareError::new(at, e))?;
        self.asked.note(&path);
        Ok(path)
    }

    /// The file that a path of the study names.
    pub fn read(&self, file: &str, at: &str) -> Result<(PathBuf, Vec<u8>), PrepareError> {
        let path = self.path(file, at)?;
        let bytes = std::fs::read(&path).map_err(|e| unread(&path, &e, at))?;
        Ok((path, bytes))
    }
}

/// A file that cannot be read.
fn unread(path: &Path, error: &std::io::Error, at: &str) -> PrepareError {
    PrepareError::new(at, format!("{}: {error}; check the path", path.display()))
}
