//! The finished web pages, embedded in the program together with their compressed forms.
//!
//! A crate of its own, so that everything else compiles while the pages are being built, and a changed page costs a link.

/// A file of the pages.
#[derive(Debug)]
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

/// Every file, sorted by name; empty if the program was compiled before the pages were built.
pub static FILES: &[EmbeddedFile] = include!(concat!(env!("OUT_DIR"), "/embedded_files.rs"));
