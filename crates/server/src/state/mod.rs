//! What every request can reach: studies, packs, pages, storage and the server's keys.

pub(crate) mod access;
pub(crate) mod admissions;
pub(crate) mod catalogue;
pub(crate) mod hosted_study;
pub(crate) mod metrics;
pub(crate) mod network;
pub(crate) mod panic_reports;
pub(crate) mod preparations;
pub(crate) mod rate_limit;
pub(crate) mod settings;
pub(crate) mod start_error;
pub(crate) mod starts;
pub(crate) mod web_address;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use access::Access;
use admissions::Admissions;
use catalogue::Catalogue;
use hosted_study::HostedStudy;
use metrics::Metrics;
use mimique_storage::{Registered, Storage, StorageError, StudyVersion};
use panic_reports::PanicReports;
use rate_limit::Limits;
use settings::Settings;
use start_error::AppError;
use starts::Starts;

use crate::error::Error;
use crate::files::assets::Assets;
use crate::files::packs::PackStore;
use crate::researcher::dashboard::kept::Sums;
use crate::researcher::dashboard::pulse::Pulse;
use crate::researcher::reports::Reports;
use crate::studio::StudioFiles;
use crate::{clock, secret};

/// What every request can reach; cheap to clone.
#[derive(Clone)]
pub struct App {
    pub(crate) catalogue: Arc<Catalogue>,
    pub(crate) registered: Arc<BTreeMap<String, Registered>>,
    pub(crate) settings: Arc<Settings>,
    pub(crate) limits: Arc<Limits>,
    /// Attempts to log in.
    pub(crate) login_limits: Arc<Limits>,
    /// Sessions begun.
    pub(crate) starts: Arc<Starts>,
    /// Wrong withdrawal codes.
    pub(crate) code_limits: Arc<Limits>,
    /// Reports of panics in browsers.
    pub(crate) panic_reports: Arc<PanicReports>,
    /// What the sessions' plans admit.
    pub(crate) admissions: Arc<Admissions>,
    pub(crate) metrics: Arc<Metrics>,
    /// When the database last took what was written, for those who ask whether it does.
    pub(crate) last_ready: Arc<tokio::sync::Mutex<Option<Instant>>>,
    /// Set when the server has been told to stop.
    pub(crate) stopping: Arc<AtomicBool>,
    pub(crate) assets: Arc<Assets>,
    pub(crate) storage: Storage,
    /// What the dashboard counts of each session.
    pub(crate) sums: Arc<Sums>,
    pub(crate) access: Arc<Access>,
    pub(crate) pulse: Pulse,
    pub(crate) reports: Arc<Reports>,
    /// What the studio opens by itself.
    pub(crate) studio_files: Arc<StudioFiles>,
    /// Where uploaded studies and their packs lie.
    pub(crate) data_folder: Option<Arc<Path>>,
    /// Version and stage of each uploaded study as it is hosted.
    pub(crate) uploaded: Arc<tokio::sync::Mutex<BTreeMap<String, (String, String)>>>,
    pub(crate) token_key: Arc<[u8]>,
    pub(crate) receipt_key: Arc<[u8]>,
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
        let mut registered = BTreeMap::new();
        for study in &studies {
            registered.insert(study.id().to_owned(), register(&storage, study).await?);
        }
        let versions = storage.study_versions().await?;
        let catalogue = Catalogue::new(studies, &versions, packs)?;
        Ok(Self {
            catalogue: Arc::new(catalogue),
            registered: Arc::new(registered),
            settings: Arc::default(),
            limits: Arc::default(),
            login_limits: Arc::default(),
            starts: Arc::default(),
            code_limits: Arc::default(),
            panic_reports: Arc::default(),
            admissions: Arc::default(),
            metrics: Arc::default(),
            last_ready: Arc::default(),
            stopping: Arc::default(),
            assets: Arc::new(assets),
            sums: Arc::default(),
            access: Arc::default(),
            pulse: Pulse::new(storage.clone()),
            reports: Arc::default(),
            studio_files: Arc::default(),
            data_folder: None,
            uploaded: Arc::default(),
            token_key: key(&storage, "tokens").await?,
            receipt_key: key(&storage, "receipts").await?,
            storage,
        })
    }

    /// The same server, reached and open as said.
    pub fn with_access(mut self, access: Access) -> Self {
        self.access = Arc::new(access);
        self
    }

    /// The same server, whose studio opens these files by itself.
    pub fn with_studio_files(mut self, files: StudioFiles) -> Self {
        self.studio_files = Arc::new(files);
        self
    }

    /// Makes this version of a study the current one.
    pub(crate) async fn register(&self, study: &HostedStudy) -> Result<(), StorageError> {
        register(&self.storage, study).await?;
        Ok(())
    }

    /// The same with other settings.
    pub fn with_settings(self, settings: Settings) -> Self {
        Self { settings: Arc::new(settings), ..self }
    }

    /// Whether people reach the server by encrypted connections: as the operator says, by the setting
    /// or by an `https` address. It alone decides on HSTS, `Secure` cookies and links.
    pub(crate) fn is_encrypted(&self) -> bool {
        let public = self.access.public_url.as_deref();
        self.settings.behind_tls || public.is_some_and(|url| url.starts_with("https://"))
    }

    /// What links to this server begin with, where it listens at this address: the address that people type, or this
    /// one, encrypted where [`Settings::behind_tls`] says so.
    pub fn base_address(&self, listening: std::net::SocketAddr) -> String {
        if let Some(url) = &self.access.public_url {
            return url.trim_end_matches('/').to_owned();
        }
        let scheme = if self.is_encrypted() { "https" } else { "http" };
        format!("{scheme}://{listening}")
    }

    /// How the version came to be that was served of a study at the start.
    pub fn registered(&self, study_id: &str) -> Option<&Registered> {
        self.registered.get(study_id)
    }

    pub(crate) fn study(&self, id: &str) -> Result<Arc<HostedStudy>, Error> {
        self.catalogue.study(id)
    }
}

/// Makes this version of a study the current one, and says so where it replaces another.
async fn register(storage: &Storage, study: &HostedStudy) -> Result<Registered, StorageError> {
    let version = study.version();
    let facts = storage.register_study(&version, clock::now_ms()).await?;
    say_what_changed(&version, &facts);
    Ok(facts)
}

/// A live study is frozen by its hash: what is not the same is a version of its own, and said.
fn say_what_changed(version: &StudyVersion, facts: &Registered) {
    let (study, hash) = (&version.study_id, &version.config_hash[..12]);
    if let Some(before) = &facts.replaces {
        tracing::warn!(
            "study {study}: the file has changed (was {}, is {hash}): version {} is served; {} live \
             sessions of other versions go on with theirs",
            &before[..before.len().min(12)],
            facts.version,
            facts.running_elsewhere,
        );
    }
    if facts.stimuli_changed {
        tracing::warn!(
            "study {study}: the file is the same ({hash}), but its stimuli are not; rows tell them \
             apart by their provenance"
        );
    }
}

async fn key(storage: &Storage, name: &str) -> Result<Arc<[u8]>, AppError> {
    let fresh = secret::random::<32>()?;
    Ok(storage.server_key(name, || fresh).await?.into_bytes().into())
}
