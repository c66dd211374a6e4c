//! Tables as BIDS has them: tabulators, `n/a` where there is no value.

/// A value as a cell: without tabulators and line breaks, `n/a` for none.
pub(super) fn cell(text: &str) -> String {
    let text: String =
        text.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect();
    let text = text.trim();
    if text.is_empty() { "n/a".to_owned() } else { text.to_owned() }
}

/// Seconds with three digits: exports are in tenths of a millisecond at best.
pub(super) fn seconds(value: Option<f64>) -> String {
    value.filter(|value| value.is_finite()).map_or("n/a".to_owned(), |value| format!("{value:.4}"))
}

/// A line of cells.
pub(super) fn line(cells: &[String]) -> String {
    let mut line = cells.join("\t");
    line.push('\n');
    line
}
