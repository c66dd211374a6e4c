//! Sensitivity against criterion: a diamond per category, a dot per person and category.

use crate::language::Language;
use crate::report::document::{DataTable, Figure};
use crate::report::figure::svg::{Anchor, Axis, Svg, WIDTH};

const LEFT: f64 = 44.0;
const RIGHT: f64 = WIDTH - 14.0;
const TOP: f64 = 30.0;
const BOTTOM: f64 = 290.0;

/// A category: its mean, or that of all answers together, and its people; each a criterion and a d'.
pub(crate) struct DetectionPoints {
    pub name: String,
    pub mean: [f64; 2],
    pub people: Vec<[f64; 2]>,
}

/// Criterion across, d' upwards.
pub(crate) fn detection_plane(
    language: Language,
    id: &str,
    caption: &str,
    categories: &[DetectionPoints],
) -> Figure {
    let all = || categories.iter().flat_map(|own| own.people.iter().copied().chain([own.mean]));
    let range = |place: usize| {
        let values = all().map(move |point| point[place]);
        values.fold((-0.2_f64, 0.2_f64), |(low, high), value| (low.min(value), high.max(value)))
    };
    let ((low, high), (least, most)) = (range(0), range(1));
    let (across, up) = (Axis::new(low, high, LEFT, RIGHT), Axis::new(least, most, BOTTOM, TOP));
    let mut svg = Svg::new(caption, BOTTOM + 36.0);
    let class = |tick: f64| if tick.abs() < 1e-12 { "zero" } else { "rule" };
    for &tick in &up.ticks {
        let y = up.place(tick);
        svg.line([LEFT, y], [RIGHT, y], class(tick));
        svg.text(LEFT - 6.0, y + 4.0, "small", Anchor::End, &language.fixed(tick, up.decimals));
    }
    for &tick in &across.ticks {
        let x = across.place(tick);
        svg.line([x, TOP], [x, BOTTOM], class(tick));
        let text = language.fixed(tick, across.decimals);
        svg.text(x, BOTTOM + 15.0, "small", Anchor::Middle, &text);
    }
    svg.text(4.0, 16.0, "strong", Anchor::Start, "d′");
    svg.text(RIGHT, BOTTOM + 30.0, "strong", Anchor::End, "c");
    for own in categories {
        for [c, d] in &own.people {
            svg.circle(across.place(*c), up.place(*d), 2.5, "dot");
        }
    }
    let columns = language.pick(
        ["category", "c", "d′", "people with a dot"],
        ["catégorie", "c", "d′", "personnes avec un point"],
    );
    let mut data = DataTable::new(id, caption, columns);
    let mut spoken = Vec::new();
    for own in categories {
        let [c, d] = own.mean;
        let (x, y) = (across.place(c), up.place(d));
        svg.diamond(x, y, 6.0, "mark");
        // Names stay inside of the drawing.
        let (anchor, beside) =
            if x > (LEFT + RIGHT) / 2.0 { (Anchor::End, -9.0) } else { (Anchor::Start, 9.0) };
        svg.text(x + beside, y + 4.0, "small", anchor, &own.name);
        let [c, d] = [c, d].map(|value| language.fixed(value, 2));
        spoken.push(format!("{} d′ {d}, c {c}", own.name));
        data.row([own.name.clone(), c, d, own.people.len().to_string()]);
    }
    let alt = language.pick(
        format!("Criterion across, d′ upwards; a diamond per category, a dot per person: {}.", spoken.join("; ")),
        format!("Critère en abscisse, d′ en ordonnée ; un losange par catégorie, un point par personne : {}.", spoken.join(" ; ")),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}
