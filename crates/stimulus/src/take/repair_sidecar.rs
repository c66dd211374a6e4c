//! The file beside a repaired capture that says what was changed: `FILE.repair.json`.

use std::path::{Path, PathBuf};

use mimique_clip::sha256_hex;
use mimique_mocap::RepairRecord;
use serde::{Deserialize, Serialize};

use crate::provenance::{Provenance, sha256_of_file};

/// A file and its content's hash.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileHash {
    /// Name of the file, without its folder.
    pub file: String,
    /// SHA-256 of its bytes.
    pub sha256: String,
}

impl FileHash {
    /// Of a file and its bytes.
    pub fn of(path: &Path, bytes: &[u8]) -> Self {
        let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Self { file, sha256: sha256_hex(bytes) }
    }

    /// Of a file, read as a stream.
    ///
    /// # Errors
    /// What the system says.
    pub fn of_file(path: &Path) -> std::io::Result<Self> {
        let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Self { file, sha256: sha256_of_file(path)? })
    }
}

/// What was changed in a capture, and in which files it is found before and after.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RepairSidecar {
    /// Program that repaired it.
    pub program: String,
    /// The capture as it was recorded.
    pub source: FileHash,
    /// The capture as it is now.
    pub result: FileHash,
    /// What was done.
    pub repair: RepairRecord,
}

/// A sidecar that does not serve.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SidecarError {
    /// It is there but cannot be read.
    #[error("{file}: {what}; repair the capture again, or remove the file")]
    Unreadable {
        /// The sidecar.
        file: String,
        /// Why.
        what: String,
    },
    /// It is of other bytes.
    #[error(
        "{file}: of a capture with SHA-256 {expected}, this one has {found}; repair the capture again, or remove the file"
    )]
    OtherCapture {
        /// The sidecar.
        file: String,
        /// Hash that it names.
        expected: String,
        /// Hash of the capture.
        found: String,
    },
}

/// Where the sidecar of a capture is.
pub fn sidecar_path(capture: &Path) -> PathBuf {
    let mut name = capture.as_os_str().to_owned();
    name.push(".repair.json");
    PathBuf::from(name)
}

impl RepairSidecar {
    /// The sidecar beside a capture; `None` where there is none. The capture's SHA-256 is asked for
    /// only where there is one.
    ///
    /// # Errors
    /// [`SidecarError`]: not readable, or of other bytes than the capture's.
    pub fn beside(
        capture: &Path,
        sha256: impl FnOnce() -> std::io::Result<String>,
    ) -> Result<Option<Self>, SidecarError> {
        let path = sidecar_path(capture);
        let file = path.display().to_string();
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(e) => return Err(SidecarError::Unreadable { file, what: e.to_string() }),
        };
        let sidecar: Self = serde_json::from_str(&text)
            .map_err(|e| SidecarError::Unreadable { file: file.clone(), what: e.to_string() })?;
        let found = sha256()
            .map_err(|e| SidecarError::Unreadable { file: file.clone(), what: e.to_string() })?;
        if sidecar.result.sha256 != found {
            let expected = sidecar.result.sha256;
            return Err(SidecarError::OtherCapture { file, expected, found });
        }
        Ok(Some(sidecar))
    }

    /// The text of the file.
    pub fn to_json(&self) -> String {
        // Numbers, texts and lists only: it cannot fail.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// What the provenance of a stimulus holds of it: everything but the files' names.
    pub fn hash(&self) -> String {
        Provenance::default()
            .json("source", self.source.sha256.as_str())
            .json("result", self.result.sha256.as_str())
            .json("repair", serde_json::to_value(&self.repair).unwrap_or_default())
            .hash()
    }
}

#[cfg(test)]
mod tests {
    use mimique_geometry::Point;

    use super::*;
    use mimique_mocap::{Capture, LengthUnit, RepairPlan, repair, write_csv};

    /// A capture with a gap, repaired: folder, path of the result, sidecar.
    fn repaired() -> (tempfile::TempDir, PathBuf, RepairSidecar) {
        let positions = (0..40_u32)
            .flat_map(|t| {
                let x = f64::from(t);
                let gone = (10..13).contains(&t);
                let second = if gone { Point::UNSEEN } else { Point::new(x, 50.0, 1.0) };
                [Point::new(x, 0.0, 0.0), second]
            })
            .collect();
        let raw = Capture {
            labels: vec!["a".to_owned(), "b".to_owned()],
            rate_hz: 100.0,
            first_frame: 0,
            unit: LengthUnit::Millimetre,
            positions,
            notes: Vec::new(),
        };
        let folder = tempfile::tempdir().unwrap();
        let (source, result) = (folder.path().join("raw.csv"), folder.path().join("repaired.csv"));
        std::fs::write(&source, write_csv(&raw).unwrap()).unwrap();
        let done = repair(raw, &RepairPlan::default()).unwrap();
        assert_eq!(done.record.gaps.len(), 1, "the record is not empty");
        let bytes = write_csv(&done.capture).unwrap();
        std::fs::write(&result, &bytes).unwrap();
        let sidecar = RepairSidecar {
            program: "mimique test".to_owned(),
            source: FileHash::of_file(&source).unwrap(),
            result: FileHash::of(&result, bytes.as_bytes()),
            repair: done.record,
        };
        std::fs::write(sidecar_path(&result), sidecar.to_json()).unwrap();
        (folder, result, sidecar)
    }

    fn beside(capture: &Path) -> Result<Option<RepairSidecar>, SidecarError> {
        RepairSidecar::beside(capture, || sha256_of_file(capture))
    }

    #[test]
    fn what_is_written_beside_a_capture_is_read_again() {
        let (_folder, result, sidecar) = repaired();
        let name = sidecar_path(&result);
        assert_eq!(name.file_name().unwrap(), "repaired.csv.repair.json");
        let read = beside(&result).unwrap().unwrap();
        assert_eq!(read, sidecar);
        assert_eq!(read.hash(), sidecar.hash());
        assert_eq!(
            (read.source.file.as_str(), read.result.file.as_str()),
            ("raw.csv", "repaired.csv")
        );
        assert_ne!(read.source.sha256, read.result.sha256);
    }

    #[test]
    fn a_file_has_the_hash_of_its_bytes() {
        let (folder, result, sidecar) = repaired();
        assert_eq!(FileHash::of_file(&result).unwrap(), sidecar.result);
        // Longer than what is read at a time.
        let (long, bytes) = (folder.path().join("long"), vec![7; 600_001]);
        std::fs::write(&long, &bytes).unwrap();
        assert_eq!(FileHash::of_file(&long).unwrap(), FileHash::of(&long, &bytes));
        // FIPS 180-4, "abc".
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(FileHash::of(Path::new("x/abc"), b"abc").sha256, abc);
        assert!(FileHash::of_file(&folder.path().join("none")).is_err());
    }

    #[test]
    fn without_a_sidecar_nothing_is_hashed() {
        let folder = tempfile::tempdir().unwrap();
        let capture = folder.path().join("raw.csv");
        let found = RepairSidecar::beside(&capture, || Err(std::io::Error::other("asked for")));
        assert_eq!(found, Ok(None));
    }

    #[test]
    fn a_sidecar_of_other_bytes_or_of_none_is_refused_with_its_name() {
        let (_folder, result, sidecar) = repaired();
        std::fs::write(&result, "frame,time,a_x,a_y,a_z\n").unwrap();
        let error = beside(&result).unwrap_err();
        assert!(matches!(&error, SidecarError::OtherCapture { expected, .. }
            if *expected == sidecar.result.sha256));
        let text = error.to_string();
        assert!(text.contains("repaired.csv.repair.json: of a capture with SHA-256"), "{text}");
        assert!(text.ends_with("; repair the capture again, or remove the file"), "{text}");

        std::fs::write(sidecar_path(&result), "{\"program\": 3}").unwrap();
        let text = beside(&result).unwrap_err().to_string();
        assert!(text.contains("repaired.csv.repair.json: invalid type"), "{text}");

        std::fs::write(sidecar_path(&result), sidecar.to_json()).unwrap();
        std::fs::remove_file(&result).unwrap();
        assert!(matches!(beside(&result), Err(SidecarError::Unreadable { .. })));
    }

    #[test]
    fn the_hash_is_of_what_was_done_and_not_of_names() {
        let (_folder, _, sidecar) = repaired();
        let changed = |change: &dyn Fn(&mut RepairSidecar)| {
            let mut other = sidecar.clone();
            change(&mut other);
            other.hash()
        };
        let hash = sidecar.hash();
        assert_eq!(changed(&|s| s.source.file = "other.c3d".to_owned()), hash);
        assert_eq!(changed(&|s| s.program = "mimique 9".to_owned()), hash);
        assert_ne!(changed(&|s| s.source.sha256 = sha256_hex(b"other")), hash);
        assert_ne!(changed(&|s| s.result.sha256 = sha256_hex(b"other")), hash);
        assert_ne!(changed(&|s| s.repair.gaps.clear()), hash);
    }
}
