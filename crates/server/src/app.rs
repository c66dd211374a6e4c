//! What every request can reach: studies, packs, pages, storage and the server's keys.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::assets::Assets;
use crate::error::Error;
use crate::hosted::HostedStudy;
use crate::packs::PackStore;
use crate::researcher::SessionViews;
use crate::storage::{Access, Storage, StorageError, StudyVersion};
use crate::{clock, secret};

/// How long the printed researcher's address works.
const LINK_LIFETIME_MS: i64 = 7 * 24 * 3600 * 1000;

/// What every request can reach; cheap to clone.
#[derive(Clone)]
pub struct App {
    pub(crate) studies: Arc<BTreeMap<String, HostedStudy>>,
    /// The bundle of every version ever served of these studies, JSON text, by study and hash.
    pub(crate) bundles: Arc<BTreeMap<(String, String), String>>,
    pub(crate) packs: Arc<PackStore>,
    pub(crate) assets: Arc<Assets>,
    pub(crate) storage: Storage,
    pub(crate) session_views: Arc<SessionViews>,
    pub(crate) token_key: Arc<[u8]>,
    pub(crate) receipt_key: Arc<[u8]>,
}

/// The server cannot start.
#[derive(Debug, thiserror::Error)]
pub enum AppError {
    /// Two files have one identifier.
    #[error("study {id} is given twice; give each study file its own id")]
    StudyTwice {
        /// The identifier.
        id: String,
    },
    /// Storage failed.
    #[error(transparent)]
    Storage(#[from] StorageError),
    /// The operating system has no randomness to give.
    #[error("no random numbers: {0}; see the operating system's log")]
    Randomness(#[from] getrandom::Error),
}

impl App {
    /// Registers the studies and fetches the keys, made at the first start of a database.
    pub async fn new(
        studies: Vec<HostedStudy>,
        packs: PackStore,
        assets: Assets,
        storage: Storage,
    ) -> Result<Self, AppError> {
        let mut by_id = BTreeMap::new();
        for study in studies {
            let version = StudyVersion {
                study_id: study.id().to_owned(),
                config_hash: study.config_hash().to_owned(),
                file: study.file().to_string(),
                clips: serde_json::to_string(&study.bundle().clips).unwrap_or_default(),
            };
            if let Some(before) = storage.register_study(&version, clock::now_ms()).await? {
                tracing::warn!(
                    "study {}: the file has changed (was {}, is {}): a new version starts",
                    version.study_id,
                    &before[..before.len().min(12)],
                    &version.config_hash[..12],
                );
            }
            let id = study.id().to_owned();
            if by_id.insert(id.clone(), study).is_some() {
                return Err(AppError::StudyTwice { id });
            }
        }
        let mut bundles = BTreeMap::new();
        for version in storage.study_versions().await? {
            if let Some(current) = by_id.get(&version.study_id) {
                let bundle = HostedStudy::from_version(&version, current.stage())?;
                let text = serde_json::to_string(bundle.bundle()).map_err(damaged)?;
                bundles.insert((version.study_id, version.config_hash), text);
            }
        }
        Ok(Self {
            studies: Arc::new(by_id),
            bundles: Arc::new(bundles),
            packs: Arc::new(packs),
            assets: Arc::new(assets),
            session_views: Arc::default(),
            token_key: key(&storage, "tokens").await?,
            receipt_key: key(&storage, "receipts").await?,
            storage,
        })
    }

    /// Makes a new address `/researcher?key=…`; only its hash is kept.
    pub async fn researcher_link(&self) -> Result<String, AppError> {
        let key = secret::random::<16>()?;
        let now = clock::now_ms();
        self.storage
            .grant_access(Access::Link, &secret::hash(&key), now, now + LINK_LIFETIME_MS)
            .await?;
        Ok(format!("/researcher?key={key}"))
    }

    /// What the page needs of a version of a study; of the current one if none is named.
    pub(crate) fn bundle(&self, id: &str, config_hash: Option<&str>) -> Result<&str, Error> {
        let hash = config_hash.unwrap_or(self.study(id)?.config_hash());
        let key = (id.to_owned(), hash.to_owned());
        self.bundles.get(&key).map(String::as_str).ok_or(Error::UnknownStudy)
    }

    pub(crate) fn study(&self, id: &str) -> Result<&HostedStudy, Error> {
        self.studies.get(id).ok_or(Error::UnknownStudy)
    }
}

async fn key(storage: &Storage, name: &str) -> Result<Arc<[u8]>, AppError> {
    let fresh = secret::random::<32>()?;
    Ok(storage.server_key(name, || fresh).await?.into_bytes().into())
}

fn damaged(error: serde_json::Error) -> StorageError {
    StorageError::Damaged { table: "study_versions", problem: error.to_string() }
}
