//! What every request can reach: studies, packs, pages, storage and the server's keys.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::assets::Assets;
use crate::error::Error;
use crate::hosted::HostedStudy;
use crate::packs::PackStore;
use crate::storage::{Access, Storage, StorageError, StudyVersion};
use crate::{clock, secret};

/// How long the printed researcher's address works.
const LINK_LIFETIME_MS: i64 = 7 * 24 * 3600 * 1000;

/// What every request can reach; cheap to clone.
#[derive(Clone)]
pub struct App {
    pub(crate) studies: Arc<BTreeMap<String, HostedStudy>>,
    pub(crate) packs: Arc<PackStore>,
    pub(crate) assets: Arc<Assets>,
    pub(crate) storage: Storage,
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
        Ok(Self {
            studies: Arc::new(by_id),
            packs: Arc::new(packs),
            assets: Arc::new(assets),
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

    pub(crate) fn study(&self, id: &str) -> Result<&HostedStudy, Error> {
        self.studies.get(id).ok_or(Error::UnknownStudy)
    }
}

async fn key(storage: &Storage, name: &str) -> Result<Arc<[u8]>, AppError> {
    let fresh = secret::random::<32>()?;
    Ok(storage.server_key(name, || fresh).await?.into_bytes().into())
}
