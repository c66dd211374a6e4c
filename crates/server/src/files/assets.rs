//! The pages: embedded in the binary, or read from a folder. All addresses carry the hash of all
//! files, so that they can be kept for ever and a new build is never mixed with an old one.

use std::collections::BTreeMap;
use std::io::{self, Read as _};
use std::path::Path;

use axum::body::Bytes;
use mimique_study::Study;
use sha2::{Digest, Sha256};

use super::{compression, folder};
use crate::files::static_file::{StaticFile, content_type};
use crate::participant::first_page::first_page;

/// A file that is part of the program, with its compressed forms.
#[derive(Debug, Clone, Copy)]
pub struct EmbeddedFile {
    /// Path below the folder of the pages, such as `style/style.css`.
    pub name: &'static str,
    /// The content, unless there is a gzip form that it can be unpacked from.
    pub raw: Option<&'static [u8]>,
    /// The brotli form, where it saves at least a twentieth.
    pub brotli: Option<&'static [u8]>,
    /// The gzip form, where it saves at least a twentieth.
    pub gzip: Option<&'static [u8]>,
}

impl EmbeddedFile {
    /// The content; an error if neither it nor a readable gzip form is embedded.
    fn content(&self) -> io::Result<Bytes> {
        if let Some(raw) = self.raw {
            return Ok(Bytes::from_static(raw));
        }
        let mut raw = Vec::new();
        flate2::read::GzDecoder::new(self.gzip.unwrap_or_default()).read_to_end(&mut raw)?;
        Ok(raw.into())
    }
}

/// The pages' files by name.
#[derive(Debug, Clone)]
pub struct Assets {
    hash: String,
    files: BTreeMap<String, StaticFile>,
}

/// The pages are not there.
#[derive(Debug, thiserror::Error)]
pub enum AssetsError {
    /// The binary was built before the pages.
    #[error(
        "the pages are not in this binary; run `cargo xtask web` and build it again, \
         or give their folder by --web-dir"
    )]
    NotEmbedded,
    /// An embedded page cannot be unpacked.
    #[error("the page {name} in this binary is damaged ({error}); install the program again")]
    Damaged {
        /// The file.
        name: &'static str,
        /// What went wrong.
        error: io::Error,
    },
    /// The folder given cannot be read.
    #[error("{folder}: {error}; give the folder that `cargo xtask web` fills")]
    Folder {
        /// The folder.
        folder: String,
        /// What went wrong.
        error: io::Error,
    },
    /// A page that every study needs is missing.
    #[error("{name} is not among the pages; run `cargo xtask web`")]
    Missing {
        /// The file.
        name: &'static str,
    },
}

impl Assets {
    /// The pages inside the program; an error if it was compiled before the pages were built.
    pub fn embedded(files: &[EmbeddedFile]) -> Result<Self, AssetsError> {
        if files.is_empty() {
            return Err(AssetsError::NotEmbedded);
        }
        let stored = files.iter().map(|file| {
            let raw =
                file.content().map_err(|error| AssetsError::Damaged { name: file.name, error })?;
            let stored = StaticFile {
                content_type: content_type(file.name),
                raw,
                brotli: file.brotli.map(Bytes::from_static),
                gzip: file.gzip.map(Bytes::from_static),
            };
            Ok((file.name.to_owned(), stored))
        });
        Self::new(stored.collect::<Result<Vec<_>, AssetsError>>()?)
    }

    /// The pages in a folder, read once.
    pub fn from_folder(path: &Path) -> Result<Self, AssetsError> {
        let read = || -> io::Result<Vec<(String, StaticFile)>> {
            folder::files(path)?
                .into_iter()
                .map(|(name, path)| {
                    let raw = std::fs::read(path)?;
                    let stored = StaticFile {
                        content_type: content_type(&name),
                        brotli: compression::brotli(&raw)?.map(Bytes::from),
                        gzip: compression::gzip(&raw)?.map(Bytes::from),
                        raw: Bytes::from(raw),
                    };
                    Ok((name, stored))
                })
                .collect()
        };
        let files = read()
            .map_err(|error| AssetsError::Folder { folder: path.display().to_string(), error })?;
        Self::new(files)
    }

    fn new(files: impl IntoIterator<Item = (String, StaticFile)>) -> Result<Self, AssetsError> {
        let files: BTreeMap<_, _> = files.into_iter().collect();
        for name in ["participant/index.html", "style/style.css"] {
            if !files.contains_key(name) {
                return Err(AssetsError::Missing { name });
            }
        }
        let mut hasher = Sha256::new();
        for (name, file) in &files {
            hasher.update((name.len() as u64).to_le_bytes());
            hasher.update(name);
            hasher.update((file.raw.len() as u64).to_le_bytes());
            hasher.update(&file.raw);
        }
        let hash = hex::encode(&hasher.finalize()[..8]);
        Ok(Self { hash, files })
    }

    /// The hash of all files, which their addresses carry.
    pub fn hash(&self) -> &str {
        &self.hash
    }

    /// Every file as it is, pages (templates) among them, by its name.
    pub fn files(&self) -> impl Iterator<Item = (&str, &[u8])> {
        self.files.iter().map(|(name, file)| (name.as_str(), file.raw.as_ref()))
    }

    /// What addresses of files begin with: `/assets/{hash}`.
    pub(crate) fn prefix(&self) -> String {
        format!("/assets/{}", self.hash)
    }

    /// A file under the hash that its page was given.
    pub(crate) fn get(&self, hash: &str, name: &str) -> Option<&StaticFile> {
        // The pages themselves are templates: they are not served as they are.
        (hash == self.hash && !name.ends_with(".html")).then(|| self.files.get(name)).flatten()
    }

    /// A page with `{{name}}` replaced by each value, escaped for HTML.
    pub fn page(&self, name: &str, values: &[(&str, &str)]) -> Option<String> {
        let template = std::str::from_utf8(&self.files.get(name)?.raw).ok()?;
        Some(values.iter().fold(template.to_owned(), |page, (name, value)| {
            page.replace(&format!("{{{{{name}}}}}"), &escaped(value))
        }))
    }

    /// The same for a participant's page: `{{first_page}}` is title and agreement of the study.
    pub fn participant_page(
        &self,
        name: &str,
        values: &[(&str, &str)],
        study: &Study,
        language: &str,
    ) -> Option<String> {
        // Last: a study's text may have braces.
        let page = self.page(name, values)?;
        Some(page.replace("{{first_page}}", &first_page(study, language).0))
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pages(style: &str) -> Assets {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in [
            ("participant/index.html", "<html lang=\"{{lang}}\"><title>{{title}}</title>"),
            ("researcher/preview.html", "<p>{{assets}}"),
            ("style/style.css", style),
        ] {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        Assets::from_folder(folder.path()).unwrap()
    }

    #[test]
    fn the_hash_follows_the_content() {
        assert_eq!(pages("a{}").prefix(), pages("a{}").prefix());
        assert_ne!(pages("a{}").prefix(), pages("b{}").prefix());
    }

    #[test]
    fn embedded_pages_are_those_of_the_folder() {
        let style = "a{}".repeat(100).into_bytes().leak();
        let gzip = compression::gzip(style).unwrap().unwrap().leak();
        let raw = |name, raw: &'static [u8]| EmbeddedFile {
            name,
            raw: Some(raw),
            brotli: None,
            gzip: None,
        };
        let packed = |gzip: &'static [u8]| EmbeddedFile {
            name: "style/style.css",
            raw: None,
            brotli: None,
            gzip: Some(gzip),
        };
        let page =
            raw("participant/index.html", b"<html lang=\"{{lang}}\"><title>{{title}}</title>");
        let preview = raw("researcher/preview.html", b"<p>{{assets}}");
        let embedded = Assets::embedded(&[page, preview, packed(gzip)]).unwrap();
        assert_eq!(embedded.hash(), pages(&"a{}".repeat(100)).hash());
        let damaged = Assets::embedded(&[page, packed(&gzip[..20])]).unwrap_err().to_string();
        assert!(
            damaged.starts_with("the page style/style.css in this binary is damaged"),
            "{damaged}"
        );
        assert!(matches!(Assets::embedded(&[]), Err(AssetsError::NotEmbedded)));
    }

    #[test]
    fn a_file_is_found_only_under_its_own_hash() {
        let assets = pages("a{}");
        let hash = assets.hash.clone();
        assert!(assets.get(&hash, "style/style.css").is_some());
        assert!(assets.get("0000000000000000", "style/style.css").is_none());
        assert!(assets.get(&hash, "../style/style.css").is_none());
        assert!(assets.get(&hash, "participant/index.html").is_none());
    }

    #[test]
    fn values_are_escaped_in_pages() {
        let page = pages("")
            .page("participant/index.html", &[("lang", "fr"), ("title", "<b>&\"")])
            .unwrap();
        assert_eq!(page, "<html lang=\"fr\"><title>&lt;b&gt;&amp;&quot;</title>");
    }

    #[test]
    fn missing_pages_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let error = Assets::from_folder(folder.path()).unwrap_err();
        assert_eq!(
            error.to_string(),
            "participant/index.html is not among the pages; run `cargo xtask web`"
        );
        assert!(matches!(
            Assets::from_folder(&folder.path().join("absent")),
            Err(AssetsError::Folder { .. })
        ));
    }
}
