//! Where a layout goes, looked at before anything is computed.

use std::path::Path;

use anyhow::{anyhow, bail};

use super::args::Make;
use super::given;
use crate::report_folder;

/// The form of a placement sheet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SheetFormat {
    Pdf,
    Svg,
}

/// The files of a layout.
pub(super) struct Targets<'a> {
    pub(super) map: &'a Path,
    pub(super) sheet: Option<(&'a Path, SheetFormat)>,
    /// A folder, made where it is not there.
    pub(super) report: Option<&'a Path>,
}

impl<'a> Targets<'a> {
    /// Of a command line: folders are there, endings are known.
    pub(super) fn of(args: &'a Make) -> anyhow::Result<Self> {
        let map = given(&args.out, "out")?.as_path();
        in_a_folder("--out", map)?;
        let sheet = args.sheet.as_deref().map(|path| {
            in_a_folder("--sheet", path)?;
            let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
            match ending.as_deref() {
                Some("pdf") => Ok((path, SheetFormat::Pdf)),
                Some("svg") => Ok((path, SheetFormat::Svg)),
                _ => {
                    bail!("--sheet: {}: is neither .pdf nor .svg; name one of them", path.display())
                }
            }
        });
        let report = args.report.as_deref();
        if let Some(path) = report {
            report_folder::check(path).map_err(|e| anyhow!("--report: {}: {e}", path.display()))?;
        }
        Ok(Self { map, sheet: sheet.transpose()?, report })
    }
}

/// A file's folder is there.
fn in_a_folder(option: &str, path: &Path) -> anyhow::Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    match folder {
        Some(folder) if !folder.is_dir() => {
            bail!("{option}: {}: {} is no folder; make it", path.display(), folder.display())
        }
        _ => Ok(()),
    }
}
