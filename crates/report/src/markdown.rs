//! A report as Markdown; figures are links to their files.

use std::fmt::Write;

use crate::document::{Block, DataTable, Document};

pub(crate) fn markdown(document: &Document) -> String {
    let mut text = format!("# {}\n\n{}\n", plain(&document.title), plain(&document.subtitle));
    blocks(&mut text, &document.blocks);
    text
}

fn blocks(text: &mut String, blocks: &[Block]) {
    for block in blocks {
        text.push('\n');
        let _ = match block {
            Block::Heading(level, heading) => {
                writeln!(text, "{} {}", "#".repeat(usize::from(*level)), plain(heading))
            }
            Block::Paragraph(words) => writeln!(text, "{}", plain(words)),
            Block::Reading(words) => writeln!(text, "**{}**", plain(words)),
            Block::Caution(words) => writeln!(text, "> {}", plain(words)),
            Block::Paper(words) => writeln!(text, "{}", plain(words)),
            Block::Table(data) => {
                table(text, data);
                Ok(())
            }
            Block::Decisions(decisions) => {
                table(text, &decisions.data);
                Ok(())
            }
            Block::Folded(heading, own) => {
                let _ = writeln!(text, "#### {}", plain(heading));
                self::blocks(text, own);
                Ok(())
            }
            Block::Figure(figure) => writeln!(
                text,
                "![{}](figures/{}.svg)\n\n*{}*",
                plain(&figure.alt),
                figure.id,
                plain(&figure.caption)
            ),
        };
    }
}

fn table(text: &mut String, data: &DataTable) {
    let line = |cells: &[String]| {
        let cells: Vec<String> = cells.iter().map(|cell| plain(cell).replace('|', "\\|")).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let _ = writeln!(text, "*{}*\n", plain(&data.caption));
    text.push_str(&line(&data.full_columns()));
    text.push_str(&line(&vec!["---".to_owned(); data.columns.len()]));
    for row in &data.rows {
        text.push_str(&line(row));
    }
}

/// Text whose own marks are not taken for Markdown.
fn plain(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '*' | '_' | '`' | '<' | '[' | ']' | '#' => {
                plain.push('\\');
                plain.push(c);
            }
            '\n' => plain.push(' '),
            c => plain.push(c),
        }
    }
    plain
}
