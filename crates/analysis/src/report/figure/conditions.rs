//! People between conditions: one point a person, one mark for the mean of each condition.

use mimique_locale::Language;
use mimique_report::document::{DataTable, Figure};
use mimique_report::figure::courses::{LEFT, RIGHT};
use mimique_report::svg::{Anchor, Svg, clipped};

use crate::naming::people_counted;
use crate::report::figure::people::{tick, vertical};
use crate::trials::measure::MeasureKind;

/// Points beside each other before the next stands where the first does.
const ABREAST: usize = 9;

/// Conditions by name, each with its people and their means.
pub(crate) fn people_by_condition(
    language: Language,
    id: &str,
    caption: &str,
    kind: MeasureKind,
    conditions: &[(String, Vec<(&str, f64)>)],
) -> Figure {
    let all = || conditions.iter().flat_map(|(_, people)| people.iter().map(|(_, mean)| *mean));
    let (low, high) =
        (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
    let (top, bottom) = (28.0, 256.0);
    let mut svg = Svg::new(caption, bottom + 52.0);
    let place = vertical(&mut svg, language, kind, (low, high), (top, bottom));
    let step = (RIGHT - LEFT) / conditions.len() as f64;
    let heading =
        language.pick(["condition", "person", "mean"], ["condition", "personne", "moyenne"]);
    let mut data = DataTable::new(id, caption, heading);
    let mut spoken = Vec::new();
    for (number, (name, people)) in conditions.iter().enumerate() {
        let x = LEFT + step * (number as f64 + 0.5);
        // Neighbouring names take turns in height where columns are narrow.
        let y = if conditions.len() > 4 && number % 2 == 1 { 31.0 } else { 18.0 };
        let most = ((step / 7.0) as usize).max(12);
        svg.text(x, bottom + y, "small", Anchor::Middle, &clipped(name, most));
        for (i, (person, mean)) in people.iter().enumerate() {
            let aside = (i % ABREAST) as f64 - (ABREAST / 2) as f64;
            svg.circle(x + aside * (step / 20.0).min(9.0), place(*mean), 3.5, "dot");
            data.row([name.clone(), (*person).to_owned(), language.fixed(*mean, 3)]);
        }
        let mean = people.iter().map(|(_, mean)| mean).sum::<f64>() / people.len() as f64;
        let half = (step / 4.0).min(50.0);
        svg.line([x - half, place(mean)], [x + half, place(mean)], "mean");
        svg.circle(x, place(mean), 5.0, "mark");
        spoken.push(format!("{name} {} ({})", tick(language, kind, mean, 2), people.len()));
    }
    let title = language.pick("condition", "condition");
    svg.text((LEFT + RIGHT) / 2.0, bottom + 46.0, "small", Anchor::Middle, title);
    let spoken = spoken.join(", ");
    let alt = language.pick(
        format!("One small point each of {} by condition, a large one for the mean of each condition, with its number of people: {spoken}.", people_counted(language, all().count())),
        format!("Un petit point par personne ({}), par condition, un grand pour la moyenne de chaque condition, avec son effectif : {spoken}.", people_counted(language, all().count())),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}
