//! Reports, of a study or of anything else: a [`document::Document`] comes in, [`ReportFile`]s go out, as HTML,
//! Markdown, LaTeX and CSV. Figures are drawn as SVG ([`svg`]); those that several reports share are in [`figure`].
//! Nothing here knows a study or computes a statistic.
//!
//! ```
//! use mimique_locale::Language;
//! use mimique_report::document::{Block, DataTable, Document};
//! use mimique_report::document_files;
//!
//! let mut weights = DataTable::new("weights", "Weights of a smile", ["shape", "weight"]);
//! weights.row(["mouthSmileLeft", "0.8"]);
//! let document = Document {
//!     title: "A smile".to_owned(),
//!     subtitle: "One frame".to_owned(),
//!     blocks: vec![Block::Table(weights)],
//! };
//! let files = document_files(&document, Language::English);
//! let paths: Vec<&str> = files.iter().map(|file| file.path.as_str()).collect();
//! assert_eq!(
//!     paths,
//!     ["report.html", "report.md", "tables/weights.csv", "tables/weights.tex", "tables/all.tex"]
//! );
//! ```

pub mod document;
pub mod figure;
mod files;
mod html;
mod latex;
mod markdown;
pub mod svg;

pub use files::{ReportFile, document_files};
