//! What every request can reach: studies, packs, pages, storage and the server's keys.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::assets::Assets;
use crate::catalogue::Catalogue;
use crate::error::Error;
use crate::hosted::HostedStudy;
use crate::packs::PackStore;
use crate::researcher::SessionViews;
use crate::storage::{Access, Storage, StorageError};
use crate::{clock, secret};

/// How long the printed researcher's address works.
const LINK_LIFETIME_MS: i64 = 7 * 24 * 3600 * 1000;

/// What every request can reach; cheap to clone.
#[derive(Clone)]
pub struct App {
    pub(crate) catalogue: Arc<Catalogue>,
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
        let mut known = BTreeSet::new();
        for study in &studies {
            if !known.insert(study.id()) {
                return Err(AppError::StudyTwice { id: study.id().to_owned() });
            }
        }
        for study in &studies {
            register(&storage, study).await?;
        }
        let versions = storage.study_versions().await?;
        let catalogue = Catalogue::new(studies, &versions, packs)?;
        Ok(Self {
            catalogue: Arc::new(catalogue),
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

    pub(crate) fn study(&self, id: &str) -> Result<Arc<HostedStudy>, Error> {
        self.catalogue.study(id)
    }
}

/// Makes this version of a study the current one, and says so where it replaces another.
async fn register(storage: &Storage, study: &HostedStudy) -> Result<(), StorageError> {
    let version = study.version();
    if let Some(before) = storage.register_study(&version, clock::now_ms()).await? {
        tracing::warn!(
            "study {}: the file has changed (was {}, is {}): a new version starts",
            version.study_id,
            &before[..before.len().min(12)],
            &version.config_hash[..12],
        );
    }
    Ok(())
}

async fn key(storage: &Storage, name: &str) -> Result<Arc<[u8]>, AppError> {
    let fresh = secret::random::<32>()?;
    Ok(storage.server_key(name, || fresh).await?.into_bytes().into())
}
