//! Studies that come through the page: taken in, unpacked, checked, prepared, hosted as pilots.
//!
//! An upload's files lie in the data folder under the hash of what was uploaded, its packs among the
//! others; the study itself is in the database, so that every server on the same database and the
//! same (shared) data folder hosts it.

mod archive;
mod checked;
pub(crate) mod handlers;
mod pages;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use mimique_locale::Language;
use mimique_stimulus::{Places, Progress};
use mimique_storage::{Role, UploadedStudy, durable_file};
use mimique_study::{CheckedStudy, Issue};
use sha2::{Digest, Sha256};
use tokio::io::AsyncWriteExt;
use tokio::sync::Semaphore;

use archive::unpack;
pub use archive::{ZIP_START, is_archive};
use checked::{Checked, check_upload};

use crate::accounts::audit::audit;
use crate::accounts::identity::Researcher;
use crate::clock::now_ms;
use crate::error::Error;
use crate::files::packs::PackStore;
use crate::hosting::prepare_hosting;
use crate::secret;
use crate::state::App;
use crate::state::hosted_study::{HostedStudy, Stage};
use crate::state::preparations::{Noted, Preparation, Preparing};

/// Bytes of an upload.
pub(crate) const LARGEST_UPLOAD: u64 = archive::LARGEST_UPLOAD;

/// How far preparing is, is noted so often.
const TOLD_EVERY: Duration = Duration::from_secs(1);

/// Preparing takes a core and much memory: one study at a time.
static TURN: Semaphore = Semaphore::const_new(1);

/// An upload while it comes in: written to a file, counted and hashed.
pub(crate) struct Incoming {
    path: PathBuf,
    file: tokio::fs::File,
    hasher: Sha256,
    bytes: u64,
}

/// An upload on disk; deleted when dropped.
pub(crate) struct Arrived {
    path: PathBuf,
    hash: String,
}

impl Drop for Arrived {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.path);
    }
}

impl Incoming {
    pub async fn open(app: &App) -> Result<Self, Error> {
        let folder = uploads_folder(app)?;
        durable_file::private_folder(&folder)?;
        let random = secret::random::<8>().map_err(Error::internal)?;
        let path = folder.join(format!(".incoming-{random}"));
        let mut options = tokio::fs::File::options();
        options.write(true).create_new(true);
        #[cfg(unix)]
        options.mode(0o600);
        let file = options.open(&path).await?;
        Ok(Self { path, file, hasher: Sha256::new(), bytes: 0 })
    }

    pub async fn add(&mut self, chunk: &[u8]) -> Result<(), Error> {
        self.bytes += chunk.len() as u64;
        if self.bytes > LARGEST_UPLOAD {
            return Err(Error::UploadTooLarge);
        }
        self.hasher.update(chunk);
        Ok(self.file.write_all(chunk).await?)
    }

    pub async fn finish(mut self) -> Result<Arrived, Error> {
        self.file.flush().await?;
        let hash = hex::encode(self.hasher.clone().finalize());
        Ok(Arrived { path: std::mem::take(&mut self.path), hash })
    }
}

impl Drop for Incoming {
    fn drop(&mut self) {
        if !self.path.as_os_str().is_empty() {
            let _ = std::fs::remove_file(&self.path);
        }
    }
}

/// What became of an upload.
pub(crate) enum Taken {
    /// It cannot be hosted; why.
    Refused(Vec<Issue>),
    /// It is being prepared.
    Accepted { study_id: String },
}

/// Unpacks and checks what has arrived; if it has no errors, preparing it begins.
/// Nobody is known where the studio stands alone.
pub(crate) async fn take(
    app: &App,
    who: Option<&Researcher>,
    arrived: Arrived,
) -> Result<Taken, Error> {
    let place = uploads_folder(app)?.join(&arrived.hash);
    let hash = arrived.hash.clone();
    let beside = place.clone();
    // What was unpacked is gone again unless it is taken.
    let work = move || -> Result<(Checked, _, PathBuf), Error> {
        let fresh = durable_file::folder_beside(&beside)?;
        let study_file = unpack(&arrived.path, fresh.path())?;
        let checked = check_upload(&study_file);
        let inside = study_file.strip_prefix(fresh.path()).unwrap_or(&study_file).to_owned();
        Ok((checked, fresh, inside))
    };
    let done = tokio::task::spawn_blocking(work).await;
    let (checked, fresh, inside) = done.map_err(Error::internal)??;
    let Some(study) = checked.study.clone() else { return Ok(Taken::Refused(checked.issues)) };
    let study_id = study.study().id.clone();
    if who.is_some_and(|who| who.role_in(&study_id) < Role::Owner) {
        return Err(Error::NotAllowed);
    }
    if app.study(&study_id).is_ok() && !is_uploaded(app, &study_id).await? {
        return Err(Error::OwnStudy { study: study_id });
    }
    let issues = checked.issues.iter().map(Noted::from).collect();
    let mut preparation = Preparation { state: Preparing::Under { done: 0, of: 0 }, issues };
    if !preparation.begin(&app.storage, &study_id).await? {
        return Err(Error::BeingPrepared { study: study_id });
    }
    let moved = if place.exists() { Ok(()) } else { std::fs::rename(fresh.path(), &place) };
    if let Err(error) = moved {
        preparation.state = Preparing::Failed { problem: error.to_string() };
        preparation.note(&app.storage, &study_id).await?;
        return Err(error.into());
    }
    let study_file = place.join(inside);
    if let Some(who) = who {
        audit(app, who, "upload a study", &study_id, &study.config_hash()[..12]).await?;
    }
    tokio::spawn(host(app.clone(), study_file, study, hash, preparation));
    Ok(Taken::Accepted { study_id })
}

/// Prepares the stimuli and hosts the study as a pilot.
async fn host(
    app: App,
    study_file: PathBuf,
    study: CheckedStudy,
    archive_hash: String,
    mut preparation: Preparation,
) {
    let id = study.study().id.clone();
    let told = preparation.clone();
    let outcome = prepare_and_host(&app, &study_file, study, archive_hash.clone(), told).await;
    let folders = [study_file.parent(), app.data_folder.as_deref()];
    let named = |text: String| {
        folders.into_iter().flatten().fold(text, |text, folder| below(&text, folder))
    };
    let outcome = outcome.map(|warnings| warnings.into_iter().map(named).collect()).map_err(named);
    preparation.state = match outcome {
        Ok(warnings) => Preparing::Ready { warnings },
        Err(problem) => {
            remove_failed(&app, &archive_hash).await;
            Preparing::Failed { problem }
        }
    };
    if let Err(error) = preparation.note(&app.storage, &id).await {
        tracing::error!("what became of an uploaded study cannot be noted: {error}");
    }
}

/// A text that names files by their paths below a folder: where the server's folders are is nothing for a page.
fn below(text: &str, folder: &Path) -> String {
    match folder.to_str().map(|folder| folder.trim_end_matches('/')) {
        None | Some("" | ".") => text.to_owned(),
        Some(folder) => text.replace(&format!("{folder}/"), ""),
    }
}

/// Takes away what was unpacked of an upload that cannot be hosted, unless a study is hosted from it.
async fn remove_failed(app: &App, archive_hash: &str) {
    let Ok(folder) = uploads_folder(app) else { return };
    let Ok(uploads) = app.storage.uploads().await else { return };
    if uploads.iter().any(|upload| upload.archive_hash == archive_hash) {
        return;
    }
    if let Err(error) = tokio::fs::remove_dir_all(folder.join(archive_hash)).await {
        tracing::warn!("what a failed upload left cannot be removed: {error}");
    }
}

async fn prepare_and_host(
    app: &App,
    study_file: &Path,
    study: CheckedStudy,
    archive_hash: String,
    mut told: Preparation,
) -> Result<Vec<String>, String> {
    let folder = app.data_folder.as_deref().ok_or("the server has no data folder")?;
    let packs_folder = folder.join("packs");
    let places = Places {
        study: study_file.parent().unwrap_or(Path::new(".")).to_owned(),
        data: None,
        packs: packs_folder.clone(),
    };
    let _turn = TURN.acquire().await.map_err(|error| error.to_string())?;
    let id = study.study().id.clone();
    let (storage, runtime) = (app.storage.clone(), tokio::runtime::Handle::current());
    let work = move || {
        let mut last: Option<Instant> = None;
        let mut said = |progress: Progress<'_>| {
            if last.is_some_and(|last| last.elapsed() < TOLD_EVERY) {
                return;
            }
            last = Some(Instant::now());
            told.state = Preparing::Under { done: progress.done, of: progress.total };
            // Not to know how far it is, is no reason to give up.
            let _ = runtime.block_on(told.note(&storage, &id));
        };
        let prepared = prepare_hosting(study.study(), &places, &mut said)
            .map_err(|faults| faults.join("\n"))?;
        let warnings =
            prepared.warnings.iter().map(|(pointer, text)| format!("{pointer}: {text}")).collect();
        let mut packs = PackStore::default();
        for hash in prepared.clips.values().flat_map(|clip| clip.packs()) {
            packs.load(&packs_folder, hash).map_err(|error| error.to_string())?;
        }
        let hosted = HostedStudy::new(study.value().clone(), prepared.clips, Stage::Pilot)
            .map_err(|error| error.to_string())?
            .with_measures(prepared.measures)
            .with_places(places);
        Ok::<_, String>((hosted, packs, warnings))
    };
    let (hosted, packs, warnings): (_, _, Vec<String>) =
        tokio::task::spawn_blocking(work).await.map_err(|error| error.to_string())??;
    let stored = async {
        app.register(&hosted).await?;
        app.storage
            .put_upload(&UploadedStudy {
                study_id: hosted.id().to_owned(),
                config_hash: hosted.config_hash().to_owned(),
                archive_hash,
                stage: hosted.stage().word().to_owned(),
                changed_ms: now_ms(),
            })
            .await?;
        let versions = app.storage.study_versions().await?;
        app.catalogue.put(hosted, &versions, packs)
    };
    stored.await.map_err(|error| {
        tracing::error!("an uploaded study cannot be hosted: {error}");
        "the database failed; upload the study again".to_owned()
    })?;
    Ok(warnings)
}

/// Changes whether an uploaded study's answers count.
pub(crate) async fn set_stage(app: &App, study_id: &str, stage: Stage) -> Result<(), Error> {
    let mut upload = find(app, study_id).await?;
    upload.stage = stage.word().to_owned();
    upload.changed_ms = now_ms();
    app.storage.put_upload(&upload).await?;
    app.host_uploads().await?;
    Ok(())
}

/// Hosts an uploaded study no more; its answers stay.
pub(crate) async fn remove(app: &App, study_id: &str) -> Result<(), Error> {
    let upload = find(app, study_id).await?;
    app.storage.remove_upload(&upload.study_id, now_ms()).await?;
    app.host_uploads().await?;
    Ok(())
}

/// Whether a study came through the page.
pub(crate) async fn is_uploaded(app: &App, study_id: &str) -> Result<bool, Error> {
    let uploads = app.storage.uploads().await?;
    Ok(uploads.iter().any(|upload| upload.study_id == study_id))
}

async fn find(app: &App, study_id: &str) -> Result<UploadedStudy, Error> {
    let uploads = app.storage.uploads().await?;
    let found = uploads.into_iter().find(|upload| upload.study_id == study_id);
    found.ok_or(Error::NotUploaded)
}

impl App {
    /// The same server with a folder for uploaded studies and their packs; without one nothing can
    /// be uploaded.
    pub fn with_data_folder(mut self, folder: PathBuf) -> Self {
        self.data_folder = Some(folder.into());
        self
    }

    /// Hosts every uploaded study in the database as it is now, and none that was removed. Studies
    /// of the server's own files are left as they are.
    ///
    /// # Errors
    /// Storage failed. A study whose packs are not in the data folder is left out, and that is logged.
    pub async fn host_uploads(&self) -> Result<(), mimique_storage::StorageError> {
        let Some(folder) = &self.data_folder else { return Ok(()) };
        let uploads = self.storage.uploads().await?;
        let mut hosted = self.uploaded.lock().await;
        for gone in hosted.keys().filter(|id| !uploads.iter().any(|up| up.study_id == **id)) {
            self.catalogue.take(gone);
        }
        hosted.retain(|id, _| uploads.iter().any(|upload| upload.study_id == *id));
        let mut versions = None;
        for upload in uploads {
            let state = (upload.config_hash.clone(), upload.stage.clone());
            if hosted.get(&upload.study_id) == Some(&state) {
                continue;
            }
            if !hosted.contains_key(&upload.study_id)
                && let Ok(own) = self.catalogue.study(&upload.study_id)
                && own.config_hash() != upload.config_hash
            {
                tracing::warn!(
                    "study {}: the server's own file stands before the uploaded one",
                    upload.study_id
                );
                continue;
            }
            let versions = match &versions {
                Some(versions) => versions,
                None => versions.insert(self.storage.study_versions().await?),
            };
            let Some(version) = versions.iter().find(|version| {
                version.study_id == upload.study_id && version.config_hash == upload.config_hash
            }) else {
                continue;
            };
            let stage = if upload.stage == "live" { Stage::Live } else { Stage::Pilot };
            let study = HostedStudy::from_version(version, stage)?;
            let mut packs = PackStore::default();
            let folder = folder.join("packs");
            let failed = {
                let mut hashes = study.bundle().clips.values().flat_map(|clip| clip.packs());
                hashes.find_map(|hash| packs.load(&folder, hash).err())
            };
            if let Some(error) = failed {
                tracing::error!("study {}: {error}", upload.study_id);
                continue;
            }
            self.catalogue.put(study, versions, packs)?;
            hosted.insert(upload.study_id, state);
        }
        Ok(())
    }
}

/// Unpacks a ZIP archive of a study into an empty folder; gives its study file.
///
/// # Errors
/// The archive is damaged, leads out of the folder or holds no study file; in words.
pub fn unpack_study(archive: &Path, folder: &Path) -> Result<PathBuf, String> {
    unpack(archive, folder).map_err(|error| error.sentence(Language::English))
}

fn uploads_folder(app: &App) -> Result<PathBuf, Error> {
    let folder = app.data_folder.as_ref().ok_or(Error::NoDataFolder)?;
    Ok(folder.join("uploads"))
}
