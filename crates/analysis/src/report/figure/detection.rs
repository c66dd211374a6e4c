//! Sensitivity against criterion: a diamond per category, a dot per person and category; a panel per level.

use mimique_locale::Language;
use mimique_report::document::{DataTable, Figure};
use mimique_report::svg::{Anchor, Axis, Svg, WIDTH};

const LEFT: f64 = 44.0;
const RIGHT: f64 = WIDTH - 14.0;
const TOP: f64 = 30.0;
const BOTTOM: f64 = 290.0;
/// Of several panels two stand beside each other.
const BESIDE: usize = 2;
const PANEL_HEIGHT: f64 = 190.0;
const GAP: f64 = 30.0;
/// Below a panel: its ticks, and the title of the next.
const BELOW: f64 = 52.0;

/// Width of a letter and height of a line of names, about.
const NAME_LETTER: f64 = 6.0;
const NAME_LINE: f64 = 12.0;

/// A category: its mean, or that of all answers together, and its people; each a criterion and a d'.
pub(crate) struct DetectionPoints {
    pub name: String,
    pub mean: [f64; 2],
    pub people: Vec<[f64; 2]>,
}

/// The categories at a level, which its title names; without a title of one panel alone.
pub(crate) struct DetectionPanel {
    pub title: String,
    pub categories: Vec<DetectionPoints>,
}

/// Criterion across, d' upwards, the same in each panel.
pub(crate) fn detection_planes(
    language: Language,
    id: &str,
    caption: &str,
    panels: &[DetectionPanel],
) -> Figure {
    let categories = || panels.iter().flat_map(|panel| &panel.categories);
    let all = || categories().flat_map(|own| own.people.iter().copied().chain([own.mean]));
    let range = |place: usize| {
        let values = all().map(move |point| point[place]);
        values.fold((-0.2_f64, 0.2_f64), |(low, high), value| (low.min(value), high.max(value)))
    };
    let ranges = [range(0), range(1)];
    let one = panels.len() <= 1;
    let rows = panels.len().div_ceil(BESIDE);
    let last = if one { BOTTOM } else { TOP + (PANEL_HEIGHT + BELOW) * rows as f64 - BELOW };
    let mut svg = Svg::new(caption, last + 36.0);
    for (place, panel) in panels.iter().enumerate() {
        let edges = if one { [LEFT, RIGHT, TOP, BOTTOM] } else { edges(place) };
        draw(&mut svg, language, panel, ranges, edges);
    }
    let columns = language.pick(
        ["category", "c", "d′", "people with a dot"],
        ["catégorie", "c", "d′", "personnes avec un point"],
    );
    let level = (!one).then(|| language.pick("level", "niveau"));
    let mut data = DataTable::new(id, caption, level.into_iter().chain(columns));
    let mut spoken = Vec::new();
    for panel in panels {
        for own in &panel.categories {
            let [c, d] = own.mean.map(|value| language.fixed(value, 2));
            let named = format!("{} {}", panel.title, own.name);
            spoken.push(format!("{} d′ {d}, c {c}", named.trim()));
            let cells = [own.name.clone(), c, d, own.people.len().to_string()];
            data.row((!one).then(|| panel.title.clone()).into_iter().chain(cells));
        }
    }
    let alt = language.pick(
        format!("Criterion across, d′ upwards; a diamond per category, a dot per person: {}.", spoken.join("; ")),
        format!("Critère en abscisse, d′ en ordonnée ; un losange par catégorie, un point par personne : {}.", spoken.join(" ; ")),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}

/// Left, right, top and bottom of one of several panels.
fn edges(place: usize) -> [f64; 4] {
    let width = (RIGHT - LEFT - GAP * (BESIDE - 1) as f64) / BESIDE as f64;
    let left = LEFT + (width + GAP) * (place % BESIDE) as f64;
    let top = TOP + (PANEL_HEIGHT + BELOW) * (place / BESIDE) as f64;
    [left, left + width, top, top + PANEL_HEIGHT]
}

fn draw(
    svg: &mut Svg,
    language: Language,
    panel: &DetectionPanel,
    [(low, high), (least, most)]: [(f64, f64); 2],
    [left, right, top, bottom]: [f64; 4],
) {
    let (across, up) = (Axis::new(low, high, left, right), Axis::new(least, most, bottom, top));
    let class = |tick: f64| if tick.abs() < 1e-12 { "zero" } else { "rule" };
    for &tick in &up.ticks {
        let y = up.place(tick);
        svg.line([left, y], [right, y], class(tick));
        svg.text(left - 6.0, y + 4.0, "small", Anchor::End, &language.fixed(tick, up.decimals));
    }
    for &tick in &across.ticks {
        let x = across.place(tick);
        svg.line([x, top], [x, bottom], class(tick));
        let text = language.fixed(tick, across.decimals);
        svg.text(x, bottom + 15.0, "small", Anchor::Middle, &text);
    }
    svg.text(left - 40.0, top - 14.0, "strong", Anchor::Start, "d′");
    svg.text(right, bottom + 30.0, "strong", Anchor::End, "c");
    if !panel.title.is_empty() {
        svg.text((left + right) / 2.0, top - 12.0, "strong", Anchor::Middle, &panel.title);
    }
    for [c, d] in panel.categories.iter().flat_map(|own| &own.people) {
        svg.circle(across.place(*c), up.place(*d), 2.5, "dot");
    }
    let mut taken: Vec<[f64; 4]> = Vec::new();
    for own in &panel.categories {
        let [c, d] = own.mean;
        let (x, y) = (across.place(c), up.place(d));
        svg.diamond(x, y, 6.0, "mark");
        // Names stay inside of the drawing.
        let (anchor, beside) =
            if x > (left + right) / 2.0 { (Anchor::End, -9.0) } else { (Anchor::Start, 9.0) };
        let width = NAME_LETTER * own.name.chars().count() as f64;
        let edge = if beside < 0.0 { x + beside - width } else { x + beside };
        let line = free_line(&mut taken, [edge, edge + width], y);
        if (line - y).abs() > NAME_LINE / 2.0 {
            // A name that stands elsewhere is joined to its diamond.
            svg.line([x, y], [x + beside, line], "thin");
        }
        svg.text(x + beside, line + 4.0, "small", anchor, &own.name);
    }
}

/// The height nearest to `y` at which a name covers no other one; it is taken from then on.
fn free_line(taken: &mut Vec<[f64; 4]>, [from, to]: [f64; 2], y: f64) -> f64 {
    let is_free = |y: f64| {
        taken.iter().all(|[left, right, low, high]| {
            to < *left || *right < from || y + NAME_LINE <= *low + 1e-9 || *high <= y + 1e-9
        })
    };
    let steps = (0..20).flat_map(|step| [f64::from(step), -f64::from(step)]);
    let mut lines = steps.map(|step| y + step * NAME_LINE / 2.0);
    let free = lines.find(|line| is_free(*line)).unwrap_or(y);
    taken.push([from, to, free, free + NAME_LINE]);
    free
}
