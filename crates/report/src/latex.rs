//! Tables as LaTeX with booktabs: one file a table, and a document that shows them all.

use std::fmt::Write;

use crate::document::DataTable;

/// Characters beyond which a cell is set as a paragraph.
const LONG_CELL: usize = 48;

/// One table, to be taken in by `\input`.
pub(crate) fn table(data: &DataTable) -> String {
    let mut text = String::from(
        "% \\usepackage[T1]{fontenc}\n% \\usepackage{booktabs,graphicx,textcomp}\n\\begin{table}[htbp]\n\\centering\n",
    );
    let _ = writeln!(text, "\\caption{{{}}}", escape(&data.caption));
    let _ = writeln!(text, "\\label{{tab:{}}}", data.id);
    // Shrunk to the width of the text where it is wider, never blown up.
    text.push_str(
        "\\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{%\n\\begin{tabular}{",
    );
    for place in 0..data.columns.len() {
        text.push_str(alignment(data, place));
    }
    text.push_str("}\n\\toprule\n");
    if !data.groups.is_empty() {
        group_line(&mut text, data);
    }
    line(&mut text, &data.columns);
    text.push_str("\\midrule\n");
    for row in &data.rows {
        line(&mut text, row);
    }
    text.push_str("\\bottomrule\n\\end{tabular}}\n\\end{table}\n");
    text
}

/// A document that shows every table; `ids` name their files.
pub(crate) fn document(title: &str, ids: &[&str]) -> String {
    let mut text = String::from(
        "\\documentclass[a4paper]{article}\n\\usepackage[utf8]{inputenc}\n\\usepackage[T1]{fontenc}\n\\usepackage{booktabs,graphicx,textcomp}\n\\usepackage[margin=2cm]{geometry}\n\\begin{document}\n",
    );
    let _ = writeln!(text, "\\section*{{{}}}", escape(title));
    for (place, id) in ids.iter().enumerate() {
        let _ = writeln!(text, "\\input{{{id}}}");
        if place % 8 == 7 {
            // LaTeX keeps only so many tables waiting for a page.
            text.push_str("\\clearpage\n");
        }
    }
    text.push_str("\\end{document}\n");
    text
}

fn alignment(data: &DataTable, place: usize) -> &'static str {
    let longest =
        data.rows.iter().filter_map(|row| row.get(place)).map(|cell| cell.chars().count());
    if longest.max().unwrap_or(0) > LONG_CELL {
        "p{7cm}"
    } else if place > 0 && data.is_number_column(place) {
        "r"
    } else {
        "l"
    }
}

fn group_line(text: &mut String, data: &DataTable) {
    let cells: Vec<String> = data
        .groups
        .iter()
        .map(|(heading, columns)| format!("\\multicolumn{{{columns}}}{{c}}{{{}}}", escape(heading)))
        .collect();
    let _ = writeln!(text, "{} \\\\", cells.join(" & "));
    let mut first = 1;
    for (heading, columns) in &data.groups {
        if !heading.is_empty() {
            let _ = write!(text, "\\cmidrule(lr){{{first}-{}}}", first + columns - 1);
        }
        first += columns;
    }
    text.push('\n');
}

fn line(text: &mut String, cells: &[String]) {
    let cells: Vec<String> = cells.iter().map(|cell| escape(cell)).collect();
    let _ = writeln!(text, "{} \\\\", cells.join(" & "));
}

/// Text without a mark that LaTeX would take for its own, and without a letter that its standard fonts
/// lack where the reports use one.
pub(crate) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\\' => escaped.push_str("\\textbackslash{}"),
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => {
                escaped.push('\\');
                escaped.push(c);
            }
            '~' => escaped.push_str("\\textasciitilde{}"),
            '^' => escaped.push_str("\\textasciicircum{}"),
            '<' => escaped.push_str("\\textless{}"),
            '>' => escaped.push_str("\\textgreater{}"),
            '|' => escaped.push_str("\\textbar{}"),
            '"' => escaped.push_str("\\textquotedbl{}"),
            // After the end of a line a bracket would be taken for an option.
            '[' => escaped.push_str("{[}"),
            ']' => escaped.push_str("{]}"),
            '\n' | '\r' | '\t' => escaped.push(' '),
            '\u{a0}' | '\u{202f}' => escaped.push('~'),
            '−' => escaped.push_str("$-$"),
            '×' => escaped.push_str("$\\times$"),
            '²' => escaped.push_str("\\textsuperscript{2}"),
            'χ' => escaped.push_str("$\\chi$"),
            'ε' => escaped.push_str("$\\varepsilon$"),
            'η' => escaped.push_str("$\\eta$"),
            'ρ' => escaped.push_str("$\\rho$"),
            'α' => escaped.push_str("$\\alpha$"),
            'κ' => escaped.push_str("$\\kappa$"),
            '–' => escaped.push_str("--"),
            '—' => escaped.push_str("---"),
            '’' => escaped.push('\''),
            '′' => escaped.push_str("$'$"),
            '‘' => escaped.push('`'),
            '“' => escaped.push_str("``"),
            '”' => escaped.push_str("''"),
            '≤' => escaped.push_str("$\\leq$"),
            '…' => escaped.push_str("\\ldots{}"),
            '→' => escaped.push_str("$\\rightarrow$"),
            '±' => escaped.push_str("$\\pm$"),
            '●' => escaped.push_str("$\\bullet$"),
            '○' => escaped.push_str("$\\circ$"),
            '◐' => escaped.push_str("$\\odot$"),
            '■' => escaped.push_str("\\rule{1ex}{1ex}"),
            c => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_of_latex_are_escaped() {
        assert_eq!(
            escape("50 % of a_b & {c} #1 $x$ ^~\\"),
            "50 \\% of a\\_b \\& \\{c\\} \\#1 \\$x\\$ \\textasciicircum{}\\textasciitilde{}\\textbackslash{}"
        );
        assert_eq!(
            escape("[0,1; 2] χ²(2) < 3 − 1"),
            "{[}0,1; 2{]} $\\chi$\\textsuperscript{2}(2) \\textless{} 3 $-$ 1"
        );
    }

    #[test]
    fn every_line_has_as_many_cells_as_columns() {
        let mut data = DataTable::new("t", "A & B", ["", "p", "words"]);
        data.groups = vec![(String::new(), 1), ("Both".to_owned(), 2)];
        data.row(["a_1", "0.5", "x"]);
        data.row(["[b", "<0.001", "y"]);
        let text = table(&data);
        assert!(text.contains("\\begin{tabular}{lrl}"), "{text}");
        assert!(text.contains("\\multicolumn{2}{c}{Both} \\\\\n\\cmidrule(lr){2-3}\n"), "{text}");
        assert!(
            text.contains("a\\_1 & 0.5 & x \\\\\n{[}b & \\textless{}0.001 & y \\\\\n"),
            "{text}"
        );
        assert!(text.contains("\\caption{A \\& B}"));
        let open = text.matches('{').count() - text.matches("\\{").count();
        let close = text.matches('}').count() - text.matches("\\}").count();
        assert_eq!(open, close);
    }
}
