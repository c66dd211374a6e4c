//! Files that are whole or absent, and on disk when a call returns: written under a second name in the
//! same folder and brought to disk; then renamed, and the folder brought to disk too.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile, TempDir};

/// Writes the bytes to disk under `path`, replacing what was there.
///
/// # Errors
/// The folder is absent or cannot be written; then what was there is still there.
pub fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write_with(path, |file| file.write_all(bytes))
}

/// The same with what `fill` writes.
///
/// # Errors
/// Those of [`write()`] and of `fill`.
pub fn write_with(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut draft = Draft::begin(path)?;
    fill(&mut draft)?;
    draft.finish()
}

/// A file that is being written, and stands under its name when it is finished. One that is dropped before
/// is removed, and what was there is still there.
#[derive(Debug)]
pub struct Draft {
    buffer: BufWriter<NamedTempFile>,
    path: PathBuf,
}

impl Draft {
    /// Begins a file that is to stand at `path`.
    ///
    /// # Errors
    /// The folder is absent or cannot be written.
    pub fn begin(path: &Path) -> io::Result<Self> {
        let file = named(path, |builder, folder| {
            // Readable for others as far as the process lets new files be.
            #[cfg(unix)]
            builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
            builder.tempfile_in(folder)
        })?;
        Ok(Self { buffer: BufWriter::new(file), path: path.to_owned() })
    }

    /// Where it is to stand.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Brings it to disk under its name.
    ///
    /// # Errors
    /// It cannot be written; then what was there is still there.
    pub fn finish(self) -> io::Result<()> {
        finish(self.buffer.into_inner()?, &self.path)
    }
}

impl Write for Draft {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.buffer.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.buffer.flush()
    }
}

/// Makes a folder with what `fill` puts into it, in the place of what was there. Its files are not brought
/// to disk.
///
/// # Errors
/// The folder cannot be made, or `fill` fails; then what was there is still there.
pub fn write_folder<T, E: From<io::Error>>(
    path: &Path,
    fill: impl FnOnce(&Path) -> Result<T, E>,
) -> Result<T, E> {
    let beside = || {
        named(path, |builder, folder| {
            #[cfg(unix)]
            builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
            builder.tempdir_in(folder)
        })
    };
    let (fresh, old) = (beside()?, beside()?);
    let done = fill(fresh.path())?;
    let before = old.path().join("before");
    if path.exists() {
        std::fs::rename(path, &before)?;
    }
    if let Err(error) = std::fs::rename(fresh.path(), path) {
        if before.exists() {
            std::fs::rename(&before, path)?;
        }
        return Err(error.into());
    }
    Ok(done)
}

/// Sees that a file is there which others on the machine can neither read nor write: a new one is its
/// owner's alone; one of before keeps what its group may.
///
/// # Errors
/// The file cannot be made.
pub fn keep_private(path: &Path) -> io::Result<()> {
    let mut options = File::options();
    options.append(true).create(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    if !path.exists() {
        options.open(path)?;
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        let mode = std::fs::metadata(path)?.permissions().mode();
        if mode & 0o007 != 0 {
            // Whose it is not cannot close it: it stays as the owner has it.
            let _ = std::fs::set_permissions(path, std::fs::Permissions::from_mode(mode & 0o770));
        }
    }
    Ok(())
}

/// A folder that its owner alone can open, made with those around it.
///
/// # Errors
/// It cannot be made.
pub fn private_folder(path: &Path) -> io::Result<()> {
    let mut builder = std::fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(path)
}

/// Begins a file that is to stand at `path`, readable for its owner alone. Without [`finish`] it is
/// removed again.
pub(crate) fn begin(path: &Path) -> io::Result<NamedTempFile> {
    named(path, |builder, folder| builder.tempfile_in(folder))
}

/// A folder beside `path`, removed with what it holds when it is dropped. Its owner alone can read it.
///
/// # Errors
/// The folder around it is absent or cannot be written.
pub fn folder_beside(path: &Path) -> io::Result<TempDir> {
    named(path, |builder, folder| builder.tempdir_in(folder))
}

/// Brings a file to disk under its own name.
pub(crate) fn finish(file: NamedTempFile, path: &Path) -> io::Result<()> {
    file.as_file().sync_all()?;
    file.persist(path)?;
    sync_folder(path)
}

/// Brings a file of the same file system to disk under its own name.
pub(crate) fn rename(from: &Path, path: &Path) -> io::Result<()> {
    File::open(from)?.sync_all()?;
    std::fs::rename(from, path)?;
    sync_folder(path)
}

fn named<T>(
    path: &Path,
    make: impl FnOnce(&mut Builder<'_, '_>, &Path) -> io::Result<T>,
) -> io::Result<T> {
    let name = path.file_name().ok_or(io::ErrorKind::InvalidFilename)?.to_string_lossy();
    make(Builder::new().prefix(&format!(".{name}.")).suffix(".part"), folder_of(path))
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Brings a folder's names to disk. Windows has no such call: there the rename itself is durable.
fn sync_folder(path: &Path) -> io::Result<()> {
    if cfg!(unix) { File::open(folder_of(path))?.sync_all() } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_and_nothing_is_left_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        write(&path, b"one").unwrap();
        write(&path, b"two").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"two");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        assert!(write(&folder.path().join("absent/b.csv"), b"x").is_err());
    }

    #[test]
    fn a_folder_is_replaced_whole_or_stays_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("report");
        let fill = |name: &'static str| {
            move |folder: &Path| std::fs::write(folder.join(name), name).map(|()| name)
        };
        assert_eq!(write_folder(&path, fill("one")).unwrap(), "one");
        assert_eq!(write_folder(&path, fill("two")).unwrap(), "two");
        let fails = |folder: &Path| -> io::Result<()> {
            std::fs::write(folder.join("three"), "half")?;
            Err(io::ErrorKind::StorageFull.into())
        };
        assert!(write_folder(&path, fails).is_err());
        let names = |folder: &Path| -> Vec<_> {
            std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name()).collect()
        };
        assert_eq!(names(&path), ["two"]);
        assert_eq!(names(folder.path()), ["report"]);
    }

    #[cfg(unix)]
    #[test]
    fn private_files_are_their_owners_alone() {
        use std::os::unix::fs::PermissionsExt as _;
        let folder = tempfile::tempdir().unwrap();
        let mode = |path: &Path| std::fs::metadata(path).unwrap().permissions().mode() & 0o777;
        let (new, old) = (folder.path().join("new"), folder.path().join("old"));
        keep_private(&new).unwrap();
        assert_eq!(mode(&new), 0o600);
        std::fs::write(&old, "kept").unwrap();
        std::fs::set_permissions(&old, std::fs::Permissions::from_mode(0o664)).unwrap();
        keep_private(&old).unwrap();
        assert_eq!((mode(&old), std::fs::read(&old).unwrap()), (0o660, b"kept".to_vec()));
        let inside = folder.path().join("a/b");
        private_folder(&inside).unwrap();
        private_folder(&inside).unwrap();
        assert_eq!(mode(&inside), 0o700);
    }

    #[test]
    fn what_is_not_finished_is_not_there() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.gz");
        begin(&path).unwrap().write_all(b"half").unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
