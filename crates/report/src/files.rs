//! The files that a document is written as.

use mimique_locale::Language;

use crate::document::{Block, DataTable, Document};
use crate::{html, latex, markdown};

/// One file of a report.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReportFile {
    /// Path below the report's folder, with `/`.
    pub path: String,
    /// Contents.
    pub text: String,
}

/// The files of a document: as HTML and Markdown, each table as CSV and LaTeX, each figure as SVG and as a
/// table.
pub fn document_files(document: &Document, language: Language) -> Vec<ReportFile> {
    let mut files = vec![
        ReportFile { path: "report.html".to_owned(), text: html::html(document, language) },
        ReportFile { path: "report.md".to_owned(), text: markdown::markdown(document) },
    ];
    files.extend(document.blocks.iter().flat_map(block_files));
    let tables: Vec<&str> = document.blocks.iter().flat_map(table_ids).collect();
    files.push(ReportFile {
        path: "tables/all.tex".to_owned(),
        text: latex::document(&document.title, &tables),
    });
    files
}

/// The files of a block: a table as CSV and LaTeX, a figure as SVG and as a table.
fn block_files(block: &Block) -> Vec<ReportFile> {
    let file = |path, text| ReportFile { path, text };
    match block {
        Block::Table(data) => table_files(data),
        Block::Figure(figure) => vec![
            file(format!("figures/{}.svg", figure.id), figure.svg.clone()),
            file(format!("tables/figure-{}.csv", figure.data.id), figure.data.to_csv()),
            file(format!("tables/figure-{}.tex", figure.data.id), latex::table(&figure.data)),
        ],
        Block::Decisions(decisions) => table_files(&decisions.data),
        Block::Folded(_, blocks) => blocks.iter().flat_map(block_files).collect(),
        _ => Vec::new(),
    }
}

fn table_files(data: &DataTable) -> Vec<ReportFile> {
    vec![
        ReportFile { path: format!("tables/{}.csv", data.id), text: data.to_csv() },
        ReportFile { path: format!("tables/{}.tex", data.id), text: latex::table(data) },
    ]
}

fn table_ids(block: &Block) -> Vec<&str> {
    match block {
        Block::Table(data) => vec![&data.id],
        Block::Decisions(decisions) => vec![&decisions.data.id],
        Block::Folded(_, blocks) => blocks.iter().flat_map(table_ids).collect(),
        _ => Vec::new(),
    }
}
