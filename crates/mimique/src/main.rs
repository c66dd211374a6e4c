//! The program `mimique`: the commands of `mimique-cli` with the pages of `mimique-pages`.
//!
//! The commands compile while the pages are being built; a changed page costs a link.

use std::process::ExitCode;

use mimique_cli::EmbeddedFile;

fn main() -> ExitCode {
    let pages = mimique_pages::FILES.iter().map(|file| EmbeddedFile {
        name: file.name,
        raw: file.raw,
        brotli: file.brotli,
        gzip: file.gzip,
    });
    mimique_cli::run(&pages.collect::<Vec<_>>())
}
