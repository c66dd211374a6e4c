//! Intervals of one row of a table, drawn: a forest plot whose rows are those of the table.

use std::fmt::Write as _;

use crate::svg::short;

/// Width of the drawing; a line of the table is as high as a line of text in it.
const WIDTH: f64 = 140.0;
const LINE: f64 = 22.0;
const MARGIN: f64 = 8.0;

/// One interval, on the scale on which it is drawn: 0 is no difference, and ±1 are the edges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawnInterval {
    /// The estimate.
    pub estimate: f64,
    /// The ends of its interval.
    pub ends: [f64; 2],
    /// Half the width of the zone of differences that do not matter.
    pub zone: Option<f64>,
}

/// The intervals below each other, around the line of no difference. `label` says the same in words.
pub fn forest_row(intervals: &[DrawnInterval], label: &str) -> String {
    let height = LINE * intervals.len() as f64;
    let place = |value: f64| {
        let half = WIDTH / 2.0;
        half + value.clamp(-1.0, 1.0) * (half - MARGIN)
    };
    let mut svg = format!(
        r#"<svg viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" class="forest" role="img" aria-label="{label}">"#,
        height = short(height),
        label = crate::document::escape(label)
    );
    for (line, interval) in intervals.iter().enumerate() {
        let y = LINE * (line as f64 + 0.5);
        if let Some(zone) = interval.zone {
            let (left, right) = (place(-zone), place(zone));
            let _ = write!(
                svg,
                r#"<rect x="{}" y="{}" width="{}" height="{LINE}" class="zone"/>"#,
                short(left),
                short(y - LINE / 2.0),
                short(right - left)
            );
        }
        let [low, high] = interval.ends.map(place);
        let _ = write!(
            svg,
            r#"<line x1="{}" y1="{y}" x2="{}" y2="{y}" class="interval"/><rect x="{}" y="{}" width="8" height="8" class="estimate"/>"#,
            short(low),
            short(high),
            short(place(interval.estimate) - 4.0),
            short(y - 4.0),
            y = short(y)
        );
    }
    let middle = short(WIDTH / 2.0);
    let _ = write!(
        svg,
        r#"<line x1="{middle}" y1="0" x2="{middle}" y2="{}" class="none"/></svg>"#,
        short(height)
    );
    svg
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_beyond_no_difference_lies_on_one_side_of_its_line() {
        let interval = DrawnInterval { estimate: 0.5, ends: [0.25, 0.75], zone: None };
        let svg = forest_row(&[interval], "0.5 [0.25; 0.75]");
        assert!(svg.contains(r#"x1="85.5""#) && svg.contains(r#"x2="116.5""#), "{svg}");
        assert!(svg.contains(r#"<line x1="70" y1="0""#), "{svg}");
    }
}
