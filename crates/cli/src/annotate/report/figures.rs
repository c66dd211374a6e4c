//! The figures of an evaluation: confusion matrices, a timeline a take, how far probabilities hold.

use mimique_analysis::Language;
use mimique_analysis::components::{
    Anchor, Axis, ConfusionRow, ConfusionWords, DataTable, Figure, Svg, WIDTH, clipped,
    confusion_matrix, slug,
};
use mimique_annotate::calibration::ReliabilityBin;
use mimique_annotate::evaluate::true_segments;
use mimique_annotate::{Mark, Marked};

use super::scores::value;
use super::words;
use crate::annotate::evaluate::{Column, Evaluation};

const LEFT: f64 = 92.0;
const RIGHT: f64 = WIDTH - 12.0;

/// Colours of labels, on which dark text is read; by index, again from the first where there are more.
const COLOURS: [&str; 12] = [
    "#a9c9e8", "#f2b48a", "#a8d5a2", "#e8a3ad", "#c9b6e4", "#e6d383", "#9fd8d4", "#dfb3d6",
    "#c4c9cf", "#cfd98f", "#b9a58f", "#8fb0c9",
];

/// Frames by true label and suggested label.
pub fn confusion(language: Language, of: &Evaluation, column: &Column) -> Figure {
    let name = words::column(language, column.kind);
    let confusion = &column.summary.counts.confusion;
    let labels = confusion.label_scores();
    let rows: Vec<ConfusionRow> = confusion
        .rows()
        .enumerate()
        .filter(|(_, counts)| counts.iter().sum::<u64>() > 0)
        .map(|(label, counts)| ConfusionRow {
            label,
            counts: counts.to_vec(),
            beside: vec![value(language, labels[label].recall)],
        })
        .collect();
    let words = ConfusionWords {
        caption: language.pick(
            format!("{name}: label of the annotator (rows) and suggested (columns), percent of each row’s frames"),
            format!("{name} : étiquette de l’annotateur (lignes) et suggérée (colonnes), en pourcentage des images de chaque ligne"),
        ),
        rows: language.pick("annotator", "annotateur").to_owned(),
        columns: language.pick("suggested", "suggérée").to_owned(),
        beside: vec![language.pick("recall", "rappel").to_owned()],
    };
    let names = &of.corpus.labels;
    let told: Vec<String> =
        rows.iter().map(|row| format!("{} {}", names[row.label], row.beside[0])).collect();
    let id = format!("confusion-{}", slug(name));
    confusion_matrix(language, &id, &words, names, &rows, &told.join(", "))
}

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
    let rate_hz = annotated.take.rate_hz;
    let seconds = annotated.take.frames() as f64 / rate_hz;
    let tracks = tracks(language, of, take, rate_hz);
    let caption = language.pick(
        format!(
            "{}: annotator and suggestions over time, and the probability of the suggestion",
            annotated.name
        ),
        format!(
            "{} : annotateur et suggestions dans le temps, et la probabilité de la suggestion",
            annotated.name
        ),
    );
    let (top, line) = (12.0, 26.0);
    let curve_top = top + line * tracks.len() as f64 + 12.0;
    let (curve_bottom, legend) = (curve_top + 54.0, 18.0);
    let lines = legend_lines(&of.corpus.labels);
    let height = curve_bottom + 44.0 + legend * lines.len() as f64;
    let mut svg = Svg::new(&caption, height);
    let scale = |t: f64| LEFT + t / seconds * (RIGHT - LEFT);
    let headings = language.pick(
        ["by", "label", "from, s", "to, s", "probability"],
        ["par", "étiquette", "de, s", "à, s", "probabilité"],
    );
    let id = format!("timeline-{}-{}", take + 1, slug(&annotated.name));
    let mut data = DataTable::new(&id, caption.clone(), headings);
    for (place, track) in tracks.iter().enumerate() {
        let y = top + line * place as f64;
        svg.text(LEFT - 8.0, y + 15.0, "", Anchor::End, &clipped(&track.name, 14));
        svg.class_rect([LEFT, y, RIGHT - LEFT, line - 6.0], "empty");
        for (ends, label, probability) in &track.parts {
            let [from, to] = ends.map(scale);
            let name = &of.corpus.labels[*label];
            svg.rect([from, y, to - from, line - 6.0], COLOURS[label % COLOURS.len()]);
            let room = ((to - from) / 6.6) as usize;
            if room >= 2 {
                svg.text_on((from + to) / 2.0, y + 14.5, 0.0, &clipped(name, room));
            }
            data.row([
                track.name.clone(),
                name.clone(),
                language.fixed(ends[0], 2),
                language.fixed(ends[1], 2),
                probability.map_or_else(String::new, |p| language.fixed(p, 2)),
            ]);
        }
    }
    curve(&mut svg, language, of, take, [curve_top, curve_bottom], scale);
    let axis = Axis::new(0.0, seconds, LEFT, RIGHT);
    for tick in axis.ticks.iter().filter(|tick| **tick <= seconds) {
        let text = language.fixed(*tick, axis.decimals);
        svg.text(scale(*tick), curve_bottom + 16.0, "small", Anchor::Middle, &text);
    }
    svg.text(LEFT - 8.0, curve_bottom + 16.0, "small", Anchor::End, "s");
    draw_legend(&mut svg, &lines, &of.corpus.labels, curve_bottom + 36.0, legend);
    let alt = spoken(language, of, &tracks, seconds);
    Figure { id, caption, alt, svg: svg.finish(), data }
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
            name: words::column(language, column.kind).to_owned(),
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
    svg.text(LEFT - 22.0, (top + bottom) / 2.0 + 4.0, "small", Anchor::End, words);
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
fn legend_lines(labels: &[String]) -> Vec<Vec<usize>> {
    let mut lines: Vec<Vec<usize>> = vec![Vec::new()];
    let mut x = 12.0;
    for (label, name) in labels.iter().enumerate() {
        let width = legend_width(name);
        if x + width > RIGHT && lines.last().is_some_and(|line| !line.is_empty()) {
            lines.push(Vec::new());
            x = 12.0;
        }
        if let Some(line) = lines.last_mut() {
            line.push(label);
        }
        x += width;
    }
    lines
}

fn legend_width(name: &str) -> f64 {
    32.0 + 6.4 * clipped(name, 24).chars().count() as f64
}

fn draw_legend(svg: &mut Svg, lines: &[Vec<usize>], labels: &[String], top: f64, line: f64) {
    for (row, own) in lines.iter().enumerate() {
        let (mut x, y) = (12.0, top + line * row as f64);
        for &label in own {
            let name = &labels[label];
            svg.rect([x, y - 9.0, 12.0, 12.0], COLOURS[label % COLOURS.len()]);
            svg.text(x + 17.0, y + 1.5, "small", Anchor::Start, &clipped(name, 24));
            x += legend_width(name);
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

/// Share of right answers against probability, before and after the temperature.
pub fn reliability(language: Language, column: &Column) -> Figure {
    let name = words::column(language, column.kind);
    let caption = language.pick(
        format!("{name}: share of frames labelled rightly against the probability of their label; on the line both agree"),
        format!("{name} : part d’images justes selon la probabilité de leur étiquette ; sur la droite, les deux concordent"),
    );
    let (top, bottom) = (16.0, 246.0);
    let right = LEFT + (bottom - top);
    let mut svg = Svg::new(&caption, bottom + 66.0);
    let (x, y) = (Axis::new(0.0, 1.0, LEFT, right), Axis::new(0.0, 1.0, bottom, top));
    for &tick in &x.ticks {
        let text = language.fixed(tick, 1);
        svg.line([x.place(tick), top], [x.place(tick), bottom], "rule");
        svg.line([LEFT, y.place(tick)], [right, y.place(tick)], "rule");
        svg.text(x.place(tick), bottom + 16.0, "small", Anchor::Middle, &text);
        svg.text(LEFT - 8.0, y.place(tick) + 4.0, "small", Anchor::End, &text);
    }
    svg.line([x.place(0.0), y.place(0.0)], [x.place(1.0), y.place(1.0)], "zero");
    let middle = (LEFT + right) / 2.0;
    let words = language.pick("probability", "probabilité");
    svg.text(middle, bottom + 33.0, "small", Anchor::Middle, words);
    let words = language.pick("right", "justes");
    svg.text(LEFT - 34.0, (top + bottom) / 2.0 + 4.0, "small", Anchor::End, words);
    let kinds = language.pick(
        ["as the scores have it", "by the temperature"],
        ["selon les scores", "selon la température"],
    );
    let headings = language.pick(
        ["", "frames", "mean probability", "share right"],
        ["", "images", "probabilité moyenne", "part juste"],
    );
    let id = format!("reliability-{}", slug(name));
    let mut data = DataTable::new(&id, caption.clone(), headings);
    for ((own, kind), class) in column.summary.reliability.iter().zip(kinds).zip(["mean", "person"])
    {
        let class = if class == "mean" { "person" } else { "mean" };
        let filled: Vec<&ReliabilityBin> = own.bins().iter().filter(|bin| bin.n > 0).collect();
        let point = |bin: &&ReliabilityBin| {
            let n = bin.n as f64;
            [x.place(bin.probability / n), y.place(bin.right as f64 / n)]
        };
        let points: Vec<[f64; 2]> = filled.iter().map(point).collect();
        if points.len() > 1 {
            svg.path(&points, class);
        }
        for [px, py] in &points {
            if class == "mean" {
                svg.circle(*px, *py, 4.0, "mark")
            } else {
                svg.circle(*px, *py, 3.0, "soft")
            }
        }
        for bin in filled {
            let n = bin.n as f64;
            let shares = [bin.probability / n, bin.right as f64 / n].map(|v| language.fixed(v, 3));
            data.row([kind.to_owned(), bin.n.to_string()].into_iter().chain(shares));
        }
    }
    for (place, (kind, class)) in kinds.into_iter().zip(["person", "mean"]).enumerate() {
        let y = top + 20.0 + 22.0 * place as f64;
        svg.line([right + 14.0, y], [right + 34.0, y], class);
        svg.text(right + 14.0, y + 14.0, "small", Anchor::Start, &clipped(kind, 22));
    }
    let [raw, tempered] =
        column.summary.reliability.each_ref().map(|own| value(language, own.expected_error()));
    let alt = language.pick(
        format!("Two curves about the diagonal. Calibration error {raw} as the scores have it, {tempered} by the temperature."),
        format!("Deux courbes autour de la diagonale. Erreur de calibration {raw} selon les scores, {tempered} selon la température."),
    );
    Figure { id, caption, alt, svg: svg.finish(), data }
}
