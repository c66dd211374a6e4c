//! A timeline a take: what the annotator and the candidates say, and how probable the suggestion is.

use mimique_annotate::evaluate::true_segments;
use mimique_annotate::{Mark, Marked};
use mimique_locale::Language;
use mimique_report::document::{DataTable, Figure, slug};
use mimique_report::svg::{Anchor, Axis, Svg, WIDTH, clipped};

use super::words;
use crate::annotate::evaluate::Evaluation;

const LEFT: f64 = 112.0;
const RIGHT: f64 = WIDTH - 12.0;
/// Height of a row, and what of it is between rows.
const ROW: f64 = 26.0;
const GAP: f64 = 6.0;
/// Height of a line of the legend.
const LINE: f64 = 19.0;

/// Colours of labels, on which dark text is read; by index, again from the first where there are more.
const COLOURS: [&str; 12] = [
    "#a9c9e8", "#f2b48a", "#a8d5a2", "#e8a3ad", "#c9b6e4", "#e6d383", "#9fd8d4", "#dfb3d6",
    "#c4c9cf", "#cfd98f", "#b9a58f", "#8fb0c9",
];

/// A row of a timeline: who says it, and what from when to when.
struct Track<'a> {
    name: String,
    /// Seconds, label, probability where there is one.
    parts: Vec<([f64; 2], usize, Option<f64>)>,
    /// What stands in the table where there is no label.
    marked: &'a [Marked],
}

/// What the annotator and the candidates say of a take over time; the last candidate's probability.
pub fn timeline(language: Language, of: &Evaluation, take: usize) -> Figure {
    let annotated = &of.corpus.takes[take];
    let labels = &of.corpus.labels;
    let short = abbreviations(labels);
    let rate_hz = annotated.take.rate_hz;
    let seconds = annotated.take.frames() as f64 / rate_hz;
    let tracks = tracks(language, of, take, rate_hz);
    let caption = language.pick(
        format!(
            "{}: annotator and suggestions over time, and the probability of the last one",
            annotated.name
        ),
        format!(
            "{} : annotateur et suggestions dans le temps, et la probabilité de la dernière",
            annotated.name
        ),
    );
    let top = 12.0;
    let curve_top = top + ROW * tracks.len() as f64 + 12.0;
    let curve_bottom = curve_top + 54.0;
    let lines = legend_lines(labels, &short);
    let mut svg = Svg::new(&caption, curve_bottom + 44.0 + LINE * lines.len() as f64);
    let scale = |t: f64| LEFT + t / seconds * (RIGHT - LEFT);
    let headings = language.pick(
        ["by", "label", "from, s", "to, s", "probability"],
        ["par", "étiquette", "de, s", "à, s", "probabilité"],
    );
    let id = format!("timeline-{}-{}", take + 1, slug(&annotated.name));
    let mut data = DataTable::new(&id, caption.clone(), headings);
    for (place, track) in tracks.iter().enumerate() {
        let y = top + ROW * place as f64;
        svg.text(LEFT - 8.0, y + 15.0, "", Anchor::End, &clipped(&track.name, 14));
        svg.class_rect([LEFT, y, RIGHT - LEFT, ROW - GAP], "empty");
        for (ends, label, probability) in &track.parts {
            let [from, to] = ends.map(scale);
            svg.rect([from, y, to - from, ROW - GAP], COLOURS[label % COLOURS.len()]);
            if to - from >= width(&short[*label]) {
                svg.text_on((from + to) / 2.0, y + 14.5, 0.0, &short[*label]);
            }
            let probability = probability.map_or_else(String::new, |p| language.fixed(p, 2));
            let ends = ends.map(|end| language.fixed(end, 2));
            let named = [track.name.clone(), labels[*label].clone()];
            data.row(named.into_iter().chain(ends).chain([probability]));
        }
    }
    curve(&mut svg, language, of, take, [curve_top, curve_bottom], scale);
    let axis = Axis::new(0.0, seconds, LEFT, RIGHT);
    for tick in axis.ticks.iter().filter(|tick| **tick <= seconds) {
        let text = language.fixed(*tick, axis.decimals);
        svg.text(scale(*tick), curve_bottom + 16.0, "small", Anchor::Middle, &text);
    }
    svg.text(LEFT - 10.0, curve_bottom + 16.0, "small", Anchor::End, "s");
    draw_legend(&mut svg, &lines, labels, &short, curve_bottom + 38.0);
    let alt = spoken(language, of, &tracks, seconds);
    Figure { id, caption, alt, svg: svg.finish(), data }
}

/// The room that a text of segments needs.
fn width(text: &str) -> f64 {
    3.0 + 7.0 * text.chars().count() as f64
}

/// For each label its shortest beginning that no other label has.
fn abbreviations(labels: &[String]) -> Vec<String> {
    let beginning = |label: &str, length: usize| label.chars().take(length).collect::<String>();
    let of = |label: &String| {
        let all = label.chars().count();
        let alone = |length: &usize| {
            let own = beginning(label, *length);
            labels.iter().filter(|other| beginning(other, *length) == own).count() == 1
        };
        beginning(label, (1..=all).find(alone).unwrap_or(all))
    };
    labels.iter().map(of).collect()
}

/// The annotator's stretches and each candidate's segments, in seconds.
fn tracks<'a>(language: Language, of: &'a Evaluation, take: usize, rate_hz: f64) -> Vec<Track<'a>> {
    let seconds = |frames: &std::ops::Range<usize>| {
        [frames.start as f64 / rate_hz, frames.end as f64 / rate_hz]
    };
    let marked = &of.corpus.takes[take].marked;
    let stable = marked.iter().filter_map(|own| match own.mark {
        Mark::Stable(label) => Some((seconds(&own.frames), label, None)),
        Mark::Transition(..) => None,
    });
    let mut tracks = vec![Track {
        name: language.pick("annotator", "annotateur").to_owned(),
        parts: stable.collect(),
        marked,
    }];
    for column in &of.columns {
        let Some(own) = column.judged.iter().find(|judged| judged.take == take) else { continue };
        let parts = own.answer.segments.iter();
        tracks.push(Track {
            name: words::column_in_short(language, column.kind).to_owned(),
            parts: parts.map(|s| (seconds(&s.frames), s.label, Some(s.probability))).collect(),
            marked: &[],
        });
    }
    tracks
}

/// The probability of the last candidate's suggestion, the lowest of each step of the drawing.
fn curve(
    svg: &mut Svg,
    language: Language,
    of: &Evaluation,
    take: usize,
    [top, bottom]: [f64; 2],
    scale: impl Fn(f64) -> f64,
) {
    for (share, text) in [(0.0, "0"), (1.0, "1")] {
        let y = bottom + share * (top - bottom);
        svg.line([LEFT, y], [RIGHT, y], "rule");
        svg.text(LEFT - 8.0, y + 4.0, "small", Anchor::End, text);
    }
    let words = language.pick("probability", "probabilité");
    svg.text(LEFT - 18.0, (top + bottom) / 2.0 + 4.0, "small", Anchor::End, words);
    let last = of.columns.last().and_then(|c| c.judged.iter().find(|own| own.take == take));
    let Some(judged) = last else { return };
    let rate_hz = of.corpus.takes[take].take.rate_hz;
    let rows = &judged.answer.probabilities;
    let mut said = vec![f64::NAN; rows.len()];
    for segment in &judged.answer.segments {
        segment.frames.clone().for_each(|f| said[f] = rows.row(f)[segment.label]);
    }
    let step = rows.len().div_ceil((RIGHT - LEFT) as usize).max(1);
    let lowest = |own: &[f64]| own.iter().copied().filter(|p| p.is_finite()).fold(1.0, f64::min);
    let points: Vec<[f64; 2]> = said
        .chunks(step)
        .enumerate()
        .map(|(at, own)| {
            let t = (at * step) as f64 / rate_hz;
            [scale(t), bottom + lowest(own) * (top - bottom)]
        })
        .collect();
    if points.len() > 1 {
        svg.path(&points, "course");
    }
}

/// Which labels stand in which line of a legend.
fn legend_lines(labels: &[String], short: &[String]) -> Vec<Vec<usize>> {
    let mut lines: Vec<Vec<usize>> = vec![Vec::new()];
    let mut x = LEGEND_LEFT;
    for (label, (name, short)) in labels.iter().zip(short).enumerate() {
        let width = legend_width(name, short);
        if x + width > RIGHT && lines.last().is_some_and(|line| !line.is_empty()) {
            lines.push(Vec::new());
            x = LEGEND_LEFT;
        }
        if let Some(line) = lines.last_mut() {
            line.push(label);
        }
        x += width;
    }
    lines
}

const LEGEND_LEFT: f64 = 12.0;

fn legend_width(name: &str, short: &str) -> f64 {
    width(short).max(14.0) + 18.0 + 6.2 * clipped(name, 24).chars().count() as f64
}

fn draw_legend(svg: &mut Svg, lines: &[Vec<usize>], labels: &[String], short: &[String], top: f64) {
    for (row, own) in lines.iter().enumerate() {
        let (mut x, y) = (LEGEND_LEFT, top + LINE * row as f64);
        for &label in own {
            let (name, short) = (&labels[label], &short[label]);
            let swatch = width(short).max(14.0);
            svg.rect([x, y - 10.5, swatch, 14.0], COLOURS[label % COLOURS.len()]);
            svg.text_on(x + swatch / 2.0, y + 0.5, 0.0, short);
            svg.text(x + swatch + 5.0, y + 0.5, "small", Anchor::Start, &clipped(name, 24));
            x += legend_width(name, short);
        }
    }
}

/// The order of the labels, as each says it.
fn spoken(language: Language, of: &Evaluation, tracks: &[Track<'_>], seconds: f64) -> String {
    let names = &of.corpus.labels;
    let said = |track: &Track<'_>| {
        let labels: Vec<&str> = match track.marked {
            [] => track.parts.iter().map(|(_, label, _)| names[*label].as_str()).collect(),
            marked => true_segments(marked).iter().map(|(_, l)| names[*l].as_str()).collect(),
        };
        format!("{}{} {}", track.name, language.pick(":", " :"), labels.join(", "))
    };
    let length = language.fixed(seconds, 1);
    let told: Vec<String> = tracks.iter().map(said).collect();
    language.pick(
        format!("{length} seconds. {}.", told.join(". ")),
        format!("{length} secondes. {}.", told.join(". ")),
    )
}
