//! Mean courses over the seconds of a clip, with bands; below them where two of them differ.

use mimique_locale::Language;
use mimique_report::document::{DataTable, Figure};
use mimique_report::figure::LINES;
use mimique_report::figure::courses::{LEFT, RIGHT};
use mimique_report::svg::{Anchor, Axis, Link, Svg};

use crate::report::figure::people::vertical;
use crate::report::section::traces::MeanTrace;
use crate::trials::measure::MeasureKind;

/// Height of a pair's line of spans.
const SPANS: f64 = 20.0;

/// Seconds in which two levels differ.
pub(crate) struct TraceSpans {
    /// The two levels.
    pub pair: String,
    /// From where to where, and where each leads.
    pub spans: Vec<([f64; 2], Option<Link>)>,
}

/// A line and its band for each level; the table has ten rows a second.
pub(crate) fn traces(
    language: Language,
    id: &str,
    caption: &str,
    step_seconds: f64,
    levels: &[(String, &MeanTrace)],
    spans: &[TraceSpans],
) -> Figure {
    let bands = || levels.iter().flat_map(|(_, own)| own.interval_95.iter().flatten().flatten());
    let means = || levels.iter().flat_map(|(_, own)| &own.mean);
    let all = || bands().chain(means()).copied();
    let (low, high) =
        (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
    let (top, bottom) = (40.0, 260.0);
    let mut svg = Svg::new(caption, bottom + 46.0 + SPANS * spans.len() as f64);
    let high = if high > low { high } else { low + 1.0 };
    let y = vertical(&mut svg, language, MeasureKind::Rating, (low, high), (top, bottom));
    let longest = levels.iter().map(|(_, own)| own.mean.len()).max().unwrap_or(1);
    let time = Axis::new(0.0, (longest.max(2) - 1) as f64 * step_seconds, LEFT, RIGHT);
    for value in &time.ticks {
        let text = language.fixed(*value, time.decimals);
        svg.text(time.place(*value), bottom + 16.0, "small", Anchor::Middle, &text);
    }
    svg.text(RIGHT, bottom + 32.0, "small", Anchor::End, language.pick("time (s)", "temps (s)"));
    let x = |instant: usize| time.place(instant as f64 * step_seconds);
    let width = (RIGHT - LEFT) / levels.len().max(1) as f64;
    for (k, (name, own)) in levels.iter().enumerate() {
        let line = LINES[k % LINES.len()];
        if let Some(band) = &own.interval_95 {
            let lower = band.iter().enumerate().map(|(at, ends)| [x(at), y(ends[0])]);
            let upper = band.iter().enumerate().rev().map(|(at, ends)| [x(at), y(ends[1])]);
            let outline: Vec<[f64; 2]> = lower.chain(upper).collect();
            svg.band(&outline, line.0);
        }
        let points: Vec<[f64; 2]> =
            own.mean.iter().enumerate().map(|(at, mean)| [x(at), y(*mean)]).collect();
        svg.coloured_path(&points, line);
        let place = LEFT + width * k as f64;
        svg.coloured_path(&[[place, top - 22.0], [place + 18.0, top - 22.0]], line);
        svg.text(place + 24.0, top - 18.0, "small", Anchor::Start, name);
    }
    for (place, TraceSpans { pair, spans }) in spans.iter().enumerate() {
        let y = bottom + 46.0 + SPANS * place as f64;
        svg.text(LEFT, y, "small", Anchor::Start, pair);
        for ([from, to], link) in spans {
            let (from, to) = (time.place(*from), time.place(*to));
            // A cluster of one instant is seen too.
            let bar = [from, y + 4.0, (to - from).max(2.0), 5.0];
            svg.linked(link.as_ref(), |svg| svg.class_rect(bar, "mark"));
        }
    }
    let seconds = language.pick("seconds", "secondes").to_owned();
    let columns = levels.iter().flat_map(|(name, _)| {
        let ends = language.pick(["from", "to"], ["de", "à"]);
        [name.clone(), format!("{name}, {}", ends[0]), format!("{name}, {}", ends[1])]
    });
    let mut data = DataTable::new(id, caption, std::iter::once(seconds).chain(columns));
    let each = ((0.1 / step_seconds).round() as usize).max(1);
    for instant in (0..longest).step_by(each) {
        let cells = levels.iter().flat_map(|(_, own)| {
            let ends = own.interval_95.as_ref().and_then(|band| band.get(instant));
            let values = [own.mean.get(instant), ends.map(|own| &own[0]), ends.map(|own| &own[1])];
            values.map(|value| value.map_or_else(String::new, |own| language.fixed(*own, 2)))
        });
        let seconds = language.fixed(instant as f64 * step_seconds, 1);
        data.row(std::iter::once(seconds).chain(cells));
    }
    let spoken: Vec<String> = levels
        .iter()
        .filter_map(|(name, own)| Some(format!("{name} {}", language.fixed(*own.mean.last()?, 2))))
        .collect();
    let different: Vec<String> = spans
        .iter()
        .flat_map(|own| own.spans.iter().map(|(ends, _)| (&own.pair, ends)))
        .map(|(pair, ends)| {
            let [from, to] = ends.map(|seconds| language.fixed(seconds, 1));
            format!(" {pair} {from} – {to} s.")
        })
        .collect();
    let (spoken, different) = (spoken.join(", "), different.concat());
    let mut alt = language.pick(
        format!("Lines over the seconds of the clip. At the end: {spoken}."),
        format!("Courbes au fil des secondes de l’extrait. À la fin : {spoken}."),
    );
    if !different.is_empty() {
        alt += language.pick(" Clusters that differ:", " Amas qui diffèrent :");
        alt += &different;
    }
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}
