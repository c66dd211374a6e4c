//! `mimique preview`: the studio for one avatar and one capture, in the browser of this machine.

use std::io::Write as _;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use mimique_avatar_files::AvatarSettings;
use mimique_server::{
    Access, App, EmbeddedFile, PackStore, StudioFile, StudioFiles, StudioRole, serve,
};
use mimique_storage::Storage;
use serde_json::json;
use tokio::net::TcpListener;

use crate::serve::{reachable, stop_signal};

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Avatar: .glb, .gltf with its data inside, or an archive of OBJ poses; the built-in head if
    /// not given
    avatar: Option<PathBuf>,
    /// Capture, or recorded weights: C3D, TRC, CSV, Live Link Face...
    #[arg(long, value_name = "FILE")]
    mocap: Option<PathBuf>,
    /// Marker map; the studio suggests one if not given
    #[arg(long, value_name = "FILE", requires = "mocap")]
    markers: Option<PathBuf>,
    /// Address and port to listen on
    #[arg(long, default_value = "127.0.0.1:8090")]
    listen: SocketAddr,
    /// Folder of the pages, instead of those inside the binary
    #[arg(long)]
    web_dir: Option<PathBuf>,
}

/// Runs the command.
pub fn run(args: Args, pages: &[EmbeddedFile], json: bool) -> anyhow::Result<()> {
    let assets = crate::pages::assets(args.web_dir.as_deref(), pages)?;
    let files = given(&args)?;
    // Studies that the studio makes are hosted for as long as it is open.
    let folder = tempfile::tempdir().context("a folder for what the studio makes")?;
    let database = format!("sqlite:{}", folder.path().join("studio.sqlite").display());
    let runtime = tokio::runtime::Runtime::new().context("the server's threads")?;
    runtime.block_on(async {
        let listener = TcpListener::bind(args.listen).await.with_context(|| {
            format!("{}: cannot listen there; choose another address by --listen", args.listen)
        })?;
        let storage = Storage::open(&database).await?;
        let app = App::new(Vec::new(), PackStore::default(), assets, storage)
            .await?
            .with_access(Access { open_preview: true, public_url: None, studio_alone: true })
            .with_studio_files(files)
            .with_data_folder(folder.path().to_owned());
        let address = format!("http://{}/studio", reachable(listener.local_addr()?));
        {
            let mut out = std::io::stdout().lock();
            if json {
                writeln!(out, "{}", json!({ "url": address }))?;
            } else {
                writeln!(out, "studio  {address}")?;
                writeln!(out, "Nothing leaves this machine. Stop with Ctrl-C.")?;
            }
            out.flush()?;
        }
        serve(app, listener, stop_signal()).await?;
        Ok(())
    })
}

/// The files that the options name, and the settings beside the avatar.
fn given(args: &Args) -> anyhow::Result<StudioFiles> {
    let mut files = StudioFiles::new();
    if let Some(avatar) = &args.avatar {
        if avatar.is_dir() {
            bail!("{}: a folder; pack its OBJ files as a .zip for the studio", avatar.display());
        }
        put(&mut files, StudioRole::Avatar, avatar)?;
        let beside = AvatarSettings::path_beside(avatar);
        if beside.is_file() {
            put(&mut files, StudioRole::Settings, &beside)?;
        }
    }
    for (role, file) in [(StudioRole::Take, &args.mocap), (StudioRole::Map, &args.markers)] {
        if let Some(file) = file {
            put(&mut files, role, file)?;
        }
    }
    Ok(files)
}

fn put(files: &mut StudioFiles, role: StudioRole, path: &Path) -> anyhow::Result<()> {
    let bytes = std::fs::read(path).with_context(|| {
        format!("{}: cannot be read; check the path and its permissions", path.display())
    })?;
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    files.insert(role, StudioFile { name, bytes: bytes.into() });
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_beside_an_archive_of_two_endings_are_given_too() {
        let folder = tempfile::tempdir().unwrap();
        for (avatar, settings) in [
            ("bank.tar.xz", "bank.avatar.json"),
            ("other.tar.gz", "other.avatar.json"),
            ("head.glb", "head.avatar.json"),
        ] {
            std::fs::write(folder.path().join(avatar), b"avatar").unwrap();
            let args = Args {
                avatar: Some(folder.path().join(avatar)),
                mocap: None,
                markers: None,
                listen: SocketAddr::from(([127, 0, 0, 1], 0)),
                web_dir: None,
            };
            assert!(!given(&args).unwrap().contains_key(&StudioRole::Settings), "{avatar}");
            std::fs::write(folder.path().join(settings), b"{}").unwrap();
            let files = given(&args).unwrap();
            assert_eq!(files[&StudioRole::Settings].name, settings);
        }
    }
}
