//! The program `mimique`: the commands of `mimique-cli` with the web pages, which are embedded here.
//!
//! Nothing else needs the finished pages, so everything else compiles while they are being built; a changed page costs a
//! link.

use std::process::ExitCode;

use mimique_cli::EmbeddedFile;

/// Every file of the pages, sorted by name; empty if the program was compiled before the pages were built.
static PAGES: &[EmbeddedFile] = include!(concat!(env!("OUT_DIR"), "/embedded_files.rs"));

fn main() -> ExitCode {
    mimique_cli::run(PAGES)
}
