//! ROC curves: the rate of hits over the rate of false alarms, a line per category, with the diagonal of chance.

use mimique_locale::Language;
use mimique_report::document::{DataTable, Figure};
use mimique_report::figure::LINES;
use mimique_report::svg::{Anchor, Axis, Svg, clipped};
use mimique_stats::RocCurve;

const LEFT: f64 = 60.0;
const TOP: f64 = 34.0;
/// Both axes are as long as each other.
const SIDE: f64 = 280.0;
/// From the curves to their names, which stand in two columns below.
const NAMES_BELOW: f64 = 58.0;
const NAME_COLUMN: f64 = 190.0;
const NAME_LINE: f64 = 18.0;
/// Letters of a name that a column has room for, with its area.
const NAME_LETTERS: usize = 20;

/// A curve for each category, with its name and its area below them.
pub(crate) fn roc_curves(
    language: Language,
    id: &str,
    caption: &str,
    curves: &[(String, RocCurve)],
) -> Figure {
    let (right, bottom) = (LEFT + SIDE, TOP + SIDE);
    let names = NAME_LINE * curves.len().div_ceil(2) as f64;
    let mut svg = Svg::new(caption, bottom + NAMES_BELOW + names);
    let (across, up) = (Axis::new(0.0, 1.0, LEFT, right), Axis::new(0.0, 1.0, bottom, TOP));
    for &tick in &up.ticks {
        let (x, y) = (across.place(tick), up.place(tick));
        svg.line([LEFT, y], [right, y], "rule");
        svg.line([x, TOP], [x, bottom], "rule");
        let text = language.fixed(tick, up.decimals);
        svg.text(LEFT - 8.0, y + 4.0, "small", Anchor::End, &text);
        svg.text(x, bottom + 16.0, "small", Anchor::Middle, &text);
    }
    let titles = language.pick(
        ["rate of false alarms", "rate of hits"],
        ["taux de fausses alarmes", "taux de détections"],
    );
    svg.text((LEFT + right) / 2.0, bottom + 34.0, "small", Anchor::Middle, titles[0]);
    svg.text(LEFT, TOP - 12.0, "small", Anchor::Start, titles[1]);
    svg.line([LEFT, bottom], [right, TOP], "zero");
    let columns = language.pick(
        ["category", "false alarms", "hits", "area"],
        ["catégorie", "fausses alarmes", "détections", "aire"],
    );
    let mut data = DataTable::new(id, caption, columns);
    let mut spoken = Vec::new();
    for (k, (name, curve)) in curves.iter().enumerate() {
        // Colours that come again have other dashes.
        let dashes = LINES[(k + k / LINES.len()) % LINES.len()].1;
        let line = (LINES[k % LINES.len()].0, dashes);
        let points: Vec<[f64; 2]> =
            curve.points.iter().map(|[x, y]| [across.place(*x), up.place(*y)]).collect();
        svg.coloured_path(&points, line);
        let area = language.fixed(curve.area, 3);
        let x = LEFT + NAME_COLUMN * (k % 2) as f64;
        let y = bottom + NAMES_BELOW + NAME_LINE * (k / 2) as f64;
        svg.coloured_path(&[[x, y], [x + 18.0, y]], line);
        let named = format!("{} {area}", clipped(name, NAME_LETTERS));
        svg.text(x + 24.0, y + 4.0, "small", Anchor::Start, &named);
        spoken.push(format!("{name} {area}"));
        for [x, y] in &curve.points {
            let numbers = [x, y].map(|value| language.fixed(*value, 4));
            data.row([name.clone()].into_iter().chain(numbers).chain([area.clone()]));
        }
    }
    let spoken = spoken.join(", ");
    let alt = language.pick(
        format!("Rate of hits over rate of false alarms, a line per category, and the diagonal of answers that tell nothing. Area below each line: {spoken}."),
        format!("Taux de détections selon le taux de fausses alarmes, une ligne par catégorie, et la diagonale des réponses qui ne distinguent rien. Aire sous chaque ligne : {spoken}."),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}
