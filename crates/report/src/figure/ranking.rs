//! Worths of what was compared in pairs, from the highest to the lowest.

use mimique_locale::Language;

use crate::document::{DataTable, Figure};
use crate::figure::{LEFT, RIGHT};
use crate::svg::{Anchor, Axis, Svg, WIDTH, clipped};

/// A level, its worth in just noticeable differences, and the ends of its interval.
pub type Ranked = (String, f64, Option<[f64; 2]>);

/// A dot per level with its interval, the highest worth on top.
pub fn ranking(language: Language, id: &str, caption: &str, levels: &[Ranked]) -> Figure {
    let mut ranked: Vec<&Ranked> = levels.iter().collect();
    ranked.sort_by(|(_, one, _), (_, other, _)| other.total_cmp(one));
    let all = || {
        ranked.iter().flat_map(|(_, worth, interval)| {
            [*worth].into_iter().chain(interval.iter().flatten().copied())
        })
    };
    let (low, high) = (all().fold(0.0, f64::min), all().fold(0.0, f64::max));
    let axis = Axis::new(low, high, LEFT, RIGHT - 6.0);
    let (top, height) = (18.0, 34.0);
    let bottom = top + height * ranked.len() as f64;
    let mut svg = Svg::new(caption, bottom + 48.0);
    for &tick in &axis.ticks {
        let x = axis.place(tick);
        let class = if tick.abs() < 1e-12 { "zero" } else { "rule" };
        svg.line([x, top - 6.0], [x, bottom], class);
        let text = language.fixed(tick, axis.decimals);
        svg.text(x, bottom + 17.0, "small", Anchor::Middle, &text);
    }
    let title = language.pick(
        "worth in just noticeable differences (1: chosen in 75 %)",
        "valeur en différences juste perceptibles (1 : choisi dans 75 %)",
    );
    svg.text((LEFT + RIGHT) / 2.0, bottom + 36.0, "small", Anchor::Middle, &clipped(title, most()));
    let columns = language.pick(
        ["level", "worth (JND)", "95 % low", "95 % high"],
        ["niveau", "valeur (JND)", "95 % bas", "95 % haut"],
    );
    let mut data = DataTable::new(id, caption, columns);
    let mut spoken = Vec::new();
    for (place, (level, worth, interval)) in ranked.iter().enumerate() {
        let y = top + height * (place as f64 + 0.5);
        svg.text(LEFT - 12.0, y + 4.0, "", Anchor::End, &clipped(level, 15));
        let mut cells = vec![level.clone(), language.fixed(*worth, 3)];
        let mut said = format!("{level} {}", language.fixed(*worth, 2));
        if let Some([low, high]) = interval {
            let (from, to) = (axis.place(*low), axis.place(*high));
            svg.line([from, y], [to, y], "whisker");
            svg.line([from, y - 5.0], [from, y + 5.0], "whisker");
            svg.line([to, y - 5.0], [to, y + 5.0], "whisker");
            cells.extend([language.fixed(*low, 3), language.fixed(*high, 3)]);
            said += &format!(" ({} – {})", language.fixed(*low, 2), language.fixed(*high, 2));
        } else {
            cells.extend([String::new(), String::new()]);
        }
        svg.circle(axis.place(*worth), y, 5.0, "mark");
        data.row(cells);
        spoken.push(said);
    }
    let alt = language.pick(
        format!("Worths in just noticeable differences, highest first: {}.", spoken.join("; ")),
        format!(
            "Valeurs en différences juste perceptibles, de la plus haute à la plus basse : {}.",
            spoken.join(" ; ")
        ),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}

/// Characters of small text that a figure has room for.
fn most() -> usize {
    (WIDTH / 5.5) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_highest_worth_stands_on_top_with_its_interval() {
        let levels = [
            ("box".to_owned(), -0.4, Some([-0.7, -0.1])),
            ("lsts".to_owned(), 0.6, Some([0.2, 1.1])),
            ("real".to_owned(), -0.2, None),
        ];
        let figure = ranking(Language::English, "f", "Worths", &levels);
        let names: Vec<&str> = figure.data.rows.iter().map(|row| row[0].as_str()).collect();
        assert_eq!(names, ["lsts", "real", "box"]);
        assert!(figure.alt.contains("lsts 0.60 (0.20 – 1.10); real -0.20; box"), "{}", figure.alt);
        assert!(figure.svg.contains("just noticeable differences (1: chosen in 75 %)"));
        assert_eq!(figure.svg.matches("class=\"mark\"").count(), 3);
        assert_eq!(figure.svg.matches("class=\"whisker\"").count(), 6);
    }
}
