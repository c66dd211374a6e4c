//! The folder of a deposit: whole, or left as it was. What was written is read again and held against its SHA-256.

use std::path::Path;

use anyhow::{Context as _, anyhow, bail};
use mimique_deposit::{Content, DepositFile};
use mimique_storage::durable_file;

use super::source_files::hash;
use crate::output;

/// Refuses a folder that holds something else than an earlier deposit.
pub(super) fn check(out: &Path) -> anyhow::Result<()> {
    out.file_name().context("this is no name of a folder; give one")?;
    if !out.exists() {
        return Ok(());
    }
    let is_empty = out.is_dir() && std::fs::read_dir(out)?.next().is_none();
    let is_deposit = ["manifest-sha256.txt", "ro-crate-metadata.json"]
        .iter()
        .all(|name| out.join(name).is_file());
    if !is_empty && !is_deposit {
        bail!("there is something else than a deposit; give an empty or a new folder by --out");
    }
    Ok(())
}

/// Writes the files into `out`, in the place of an earlier deposit.
pub(super) fn write(files: &[DepositFile], out: &Path) -> anyhow::Result<()> {
    if let Some(parent) = out.parent().filter(|parent| !parent.as_os_str().is_empty()) {
        output::make_folder(parent)?;
    }
    durable_file::write_folder(out, |folder| {
        files.iter().try_for_each(|file| write_file(file, folder))
    })
}

fn write_file(file: &DepositFile, folder: &Path) -> anyhow::Result<()> {
    let path = folder.join(&file.path);
    if let Some(parent) = path.parent() {
        output::make_folder(parent)?;
    }
    match &file.content {
        Content::Made(bytes) => {
            std::fs::write(&path, bytes).with_context(|| file.path.clone())?;
        }
        Content::Copied(from) => {
            // Not as a copy, which could not be written where the original cannot.
            let mut to = std::fs::File::create(&path).with_context(|| file.path.clone())?;
            std::fs::File::open(from)
                .and_then(|mut from| std::io::copy(&mut from, &mut to))
                .map_err(|error| {
                    anyhow!("{}: cannot be copied ({error}); check the file", from.display())
                })?;
        }
    }
    let (sha256, bytes) = hash(&path)?;
    if (&sha256, bytes) != (&file.sha256, file.bytes) {
        bail!(
            "{}: SHA-256 {sha256} where {} is expected; it has changed while it was copied, or is damaged: run the command \
             again, after removing the folder of packs if it is one of them",
            file.path,
            file.sha256
        );
    }
    Ok(())
}
