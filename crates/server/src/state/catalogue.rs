//! What is hosted: the studies, the bundles of all their versions, and their packs. Requests read a
//! snapshot; an upload puts a new one in its place.

use mimique_storage::{StorageError, StudyVersion};
use std::collections::BTreeMap;
use std::sync::{Arc, PoisonError, RwLock};

use crate::error::Error;
use crate::files::packs::PackStore;
use crate::files::static_file::StaticFile;
use crate::state::hosted_study::HostedStudy;
use mimique_study::MIMICRY_FILES;

/// One state of what is hosted; cheap to clone.
#[derive(Clone, Default)]
struct Hosted {
    studies: BTreeMap<String, Arc<HostedStudy>>,
    /// The bundle of every version ever served of these studies, JSON text, by study and hash.
    bundles: BTreeMap<(String, String), Arc<str>>,
    packs: PackStore,
    /// Media type of what browsers take by it alone, by hash and ending.
    typed: BTreeMap<String, &'static str>,
}

/// What is hosted now.
pub(crate) struct Catalogue {
    now: RwLock<Arc<Hosted>>,
}

impl Catalogue {
    /// The studies and every version of them in the database.
    pub fn new(
        studies: Vec<HostedStudy>,
        versions: &[StudyVersion],
        packs: PackStore,
    ) -> Result<Self, StorageError> {
        let mut hosted = Hosted { packs, ..Hosted::default() };
        for study in studies {
            hosted.add(study, versions)?;
        }
        Ok(Self { now: RwLock::new(Arc::new(hosted)) })
    }

    /// Hosts a study, or another version of one, with what of its packs is not there yet.
    pub fn put(
        &self,
        study: HostedStudy,
        versions: &[StudyVersion],
        packs: PackStore,
    ) -> Result<(), StorageError> {
        let mut now = self.now.write().unwrap_or_else(PoisonError::into_inner);
        let mut next = Hosted::clone(&now);
        next.packs.join(packs);
        next.add(study, versions)?;
        *now = Arc::new(next);
        Ok(())
    }

    /// Hosts a study no more. Its packs stay: sessions under way may still need them.
    pub fn take(&self, id: &str) {
        let mut now = self.now.write().unwrap_or_else(PoisonError::into_inner);
        let mut next = Hosted::clone(&now);
        next.studies.remove(id);
        *now = Arc::new(next);
    }

    /// The study of this identifier.
    pub fn study(&self, id: &str) -> Result<Arc<HostedStudy>, Error> {
        self.now().studies.get(id).cloned().ok_or(Error::UnknownStudy)
    }

    /// Every study, by identifier.
    pub fn studies(&self) -> Vec<Arc<HostedStudy>> {
        self.now().studies.values().cloned().collect()
    }

    /// What the page needs of a version of a study; of the current one if none is named.
    pub fn bundle(&self, id: &str, config_hash: Option<&str>) -> Result<Arc<str>, Error> {
        let now = self.now();
        let study = now.studies.get(id).ok_or(Error::UnknownStudy)?;
        let hash = config_hash.unwrap_or(study.config_hash());
        let key = (id.to_owned(), hash.to_owned());
        now.bundles.get(&key).cloned().ok_or(Error::UnknownStudy)
    }

    /// A pack by its hash. What browsers take by its media type alone, the scripts and the module that measure faces, has
    /// that type under its hash with `.js` or `.wasm` behind it.
    pub fn pack(&self, name: &str) -> Option<StaticFile> {
        let now = self.now();
        let Some((hash, _)) = name.split_once('.') else { return now.packs.get(name).cloned() };
        let content_type = now.typed.get(name)?;
        now.packs.get(hash).map(|file| StaticFile { content_type, ..file.clone() })
    }

    fn now(&self) -> Arc<Hosted> {
        self.now.read().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Hosted {
    fn add(&mut self, study: HostedStudy, versions: &[StudyVersion]) -> Result<(), StorageError> {
        for version in versions.iter().filter(|version| version.study_id == study.id()) {
            let key = (version.study_id.clone(), version.config_hash.clone());
            let bundle = HostedStudy::from_version(version, study.stage())?;
            for file in MIMICRY_FILES {
                if let (Some(pack), Some(ending)) = (bundle.clips().get(&file.key()), file.ending) {
                    self.typed.insert(format!("{}.{ending}", pack.avatar), file.media_type);
                }
            }
            let text = serde_json::to_string(bundle.bundle()).map_err(damaged)?;
            self.bundles.insert(key, text.into());
        }
        self.studies.insert(study.id().to_owned(), Arc::new(study));
        Ok(())
    }
}

fn damaged(error: serde_json::Error) -> StorageError {
    StorageError::Damaged { table: "study_versions", problem: error.to_string() }
}
