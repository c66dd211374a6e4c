//! Figures of people and of the course of a session: lines of each person, order, fatigue, late frames.

use mimique_locale::Language;
use mimique_report::document::{DataTable, Figure};
use mimique_report::figure::courses::{LEFT, RIGHT};
use mimique_report::svg::{Anchor, Axis, Svg, clipped, shade};
use mimique_stats::Proportion;

use crate::naming::people_counted;
use crate::report::figure::values_title;
use crate::trials::measure::MeasureKind;

/// A value as people read it: shares in percent.
pub(super) fn tick(language: Language, kind: MeasureKind, value: f64, decimals: usize) -> String {
    match kind {
        MeasureKind::Recognition => language.percent(value),
        MeasureKind::Rating | MeasureKind::ResponseTime | MeasureKind::Choice => {
            language.fixed(value, decimals)
        }
    }
}

/// A vertical axis with its title and rules; the place of a value.
pub(super) fn vertical(
    svg: &mut Svg,
    language: Language,
    kind: MeasureKind,
    (low, high): (f64, f64),
    (top, bottom): (f64, f64),
) -> impl Fn(f64) -> f64 + use<> {
    let axis = Axis::new(low, high, bottom, top);
    svg.text(4.0, top - 10.0, "small", Anchor::Start, values_title(language, kind));
    for &value in &axis.ticks {
        let y = axis.place(value);
        svg.line([LEFT, y], [RIGHT, y], "rule");
        let text = tick(language, kind, value, axis.decimals);
        svg.text(LEFT - 8.0, y + 4.0, "small", Anchor::End, &text);
    }
    move |value| axis.place(value)
}

/// One line a person over the levels of a factor, and the mean of all people.
pub(crate) fn person_lines(
    language: Language,
    id: &str,
    caption: &str,
    kind: MeasureKind,
    (factor, levels): (&str, &[String]),
    people: &[(String, Vec<f64>)],
) -> Figure {
    let all = || people.iter().flat_map(|(_, means)| means.iter().copied());
    let (low, high) =
        (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
    let (top, bottom) = (28.0, 256.0);
    let mut svg = Svg::new(caption, bottom + 52.0);
    let place = vertical(&mut svg, language, kind, (low, high), (top, bottom));
    let step = (RIGHT - LEFT) / levels.len() as f64;
    let x = |level: usize| LEFT + step * (level as f64 + 0.5);
    for (level, name) in levels.iter().enumerate() {
        let most = (step / 7.0) as usize;
        // Neighbouring names take turns in height where columns are narrow.
        let y = if levels.len() > 4 && level % 2 == 1 { 31.0 } else { 18.0 };
        svg.text(x(level), bottom + y, "small", Anchor::Middle, &clipped(name, most.max(12)));
    }
    svg.text((LEFT + RIGHT) / 2.0, bottom + 46.0, "small", Anchor::Middle, factor);
    // Many people together make a tone: a line of each is drawn all the thinner.
    let class = if people.len() > 60 { "person faint" } else { "person" };
    let heading = std::iter::once(language.pick("person", "personne").to_owned());
    let mut data = DataTable::new(id, caption, heading.chain(levels.iter().cloned()));
    for (person, means) in people {
        let line: Vec<[f64; 2]> =
            means.iter().enumerate().map(|(level, &mean)| [x(level), place(mean)]).collect();
        svg.path(&line, class);
        data.row(
            std::iter::once(person.clone())
                .chain(means.iter().map(|&mean| language.fixed(mean, 3))),
        );
    }
    let n = people.len() as f64;
    let means: Vec<f64> = (0..levels.len())
        .map(|level| people.iter().map(|(_, means)| means[level]).sum::<f64>() / n)
        .collect();
    let line: Vec<[f64; 2]> =
        means.iter().enumerate().map(|(level, &mean)| [x(level), place(mean)]).collect();
    svg.path(&line, "mean");
    for point in &line {
        svg.circle(point[0], point[1], 5.0, "mark");
    }
    let spoken: Vec<String> = levels
        .iter()
        .zip(&means)
        .map(|(level, &mean)| format!("{level} {}", tick(language, kind, mean, 2)))
        .collect();
    let spoken = spoken.join(", ");
    let alt = language.pick(
        format!(
            "One thin line each of {}, a thick line for their mean: {spoken}.",
            people_counted(language, people.len())
        ),
        format!(
            "Une ligne fine par personne ({}), une ligne épaisse pour la moyenne : {spoken}.",
            people_counted(language, people.len())
        ),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}

/// Mean over people at each part of the session, with the t interval.
pub(crate) struct Part {
    /// First and last trial.
    pub trials: (usize, usize),
    pub mean: f64,
    pub interval: [f64; 2],
    pub people: usize,
}

/// A measure over the course of the session.
pub(crate) fn course(
    language: Language,
    id: &str,
    caption: &str,
    kind: MeasureKind,
    parts: &[Part],
) -> Figure {
    let low = parts.iter().map(|part| part.interval[0]).fold(f64::INFINITY, f64::min);
    let high = parts.iter().map(|part| part.interval[1]).fold(f64::NEG_INFINITY, f64::max);
    let (top, bottom) = (28.0, 202.0);
    let mut svg = Svg::new(caption, bottom + 46.0);
    let place = vertical(&mut svg, language, kind, (low, high), (top, bottom));
    let step = (RIGHT - LEFT) / parts.len() as f64;
    let headings = language.pick(
        ["trials", "people", "mean", "95 % low", "95 % high"],
        ["essais", "personnes", "moyenne", "95 % bas", "95 % haut"],
    );
    let mut data = DataTable::new(id, caption, headings);
    let mut line = Vec::new();
    let mut spoken = Vec::new();
    for (i, part) in parts.iter().enumerate() {
        let x = LEFT + step * (i as f64 + 0.5);
        let (first, last) = part.trials;
        let name = if first == last { first.to_string() } else { format!("{first}–{last}") };
        svg.text(x, bottom + 18.0, "small", Anchor::Middle, &name);
        let [low, high] = part.interval.map(&place);
        svg.line([x, low], [x, high], "whisker");
        line.push([x, place(part.mean)]);
        data.row([
            name.clone(),
            part.people.to_string(),
            language.fixed(part.mean, 3),
            language.fixed(part.interval[0], 3),
            language.fixed(part.interval[1], 3),
        ]);
        spoken.push(format!("{name}: {}", tick(language, kind, part.mean, 2)));
    }
    svg.path(&line, "course");
    for point in &line {
        svg.circle(point[0], point[1], 4.5, "mark");
    }
    let axis =
        language.pick("place of the trial in the session", "rang de l’essai dans la session");
    svg.text((LEFT + RIGHT) / 2.0, bottom + 38.0, "small", Anchor::Middle, axis);
    let spoken = spoken.join(", ");
    let alt = language.pick(
        format!("Mean over people by place of the trial, with intervals: {spoken}."),
        format!("Moyenne des personnes selon le rang de l’essai, avec intervalles : {spoken}."),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}

/// Trials by their share of late frames, a row a level.
pub(crate) fn late_frames(
    language: Language,
    id: &str,
    caption: &str,
    rows: &[(String, Vec<f64>)],
) -> Figure {
    // Shares above each border and up to the next.
    const BORDERS: [f64; 4] = [0.0, 0.02, 0.1, 0.25];
    let names = language.pick(
        ["none", "to 2 %", "to 10 %", "to 25 %", "more"],
        ["aucune", "≤ 2 %", "≤ 10 %", "≤ 25 %", "plus"],
    );
    let left = 116.0;
    let (top, height, gap) = (44.0, 26.0, 12.0);
    let tone = |class: usize| class as f64 / BORDERS.len() as f64;
    let mut svg = Svg::new(caption, top + (height + gap) * rows.len() as f64 + 40.0);
    let step = (RIGHT - left) / names.len() as f64;
    for (class, name) in names.iter().enumerate() {
        let x = left + step * class as f64;
        svg.rect([x, 10.0, step - 2.0, 18.0], &shade(tone(class)));
        svg.text_on(x + step / 2.0 - 1.0, 23.5, tone(class), name);
    }
    let late = language.pick("late frames", "en retard");
    svg.text(left - 10.0, 23.0, "soft", Anchor::End, late);
    let mut data =
        DataTable::new(id, caption, std::iter::once(String::new()).chain(names.map(str::to_owned)));
    let mut spoken = Vec::new();
    for (i, (label, shares)) in rows.iter().enumerate() {
        let y = top + (height + gap) * i as f64;
        svg.text(left - 10.0, y + height / 2.0 + 4.5, "", Anchor::End, &clipped(label, 15));
        let mut counts = [0usize; BORDERS.len() + 1];
        for share in shares {
            counts[BORDERS.iter().filter(|border| *share > **border).count()] += 1;
        }
        let mut x = left;
        for (class, &count) in counts.iter().enumerate() {
            let width = count as f64 / shares.len() as f64 * (RIGHT - left);
            svg.rect([x, y, width, height], &shade(tone(class)));
            if width > 26.0 {
                let text = count.to_string();
                svg.text_on(x + width / 2.0, y + height / 2.0 + 4.5, tone(class), &text);
            }
            x += width;
        }
        spoken.push(format!("{label} {} / {}", shares.len() - counts[0], shares.len()));
        let counts = counts.map(|count| count.to_string());
        data.row(std::iter::once(label.clone()).chain(counts));
    }
    let bottom = top + (height + gap) * rows.len() as f64 + 8.0;
    for share in [0.0, 0.5, 1.0] {
        let anchor = if share == 1.0 { Anchor::End } else { Anchor::Middle };
        let x = left + share * (RIGHT - left);
        svg.text(x, bottom + 4.0, "small", anchor, &language.percent(share));
    }
    let title = language.pick("share of trials", "part des essais");
    svg.text((left + RIGHT) / 2.0, bottom + 20.0, "small", Anchor::Middle, title);
    let alt = language.pick(
        format!("Stacked bars of trials by their share of late frames. Trials with any: {}.", spoken.join(", ")),
        format!("Barres empilées des essais selon leur part d’images en retard. Essais avec retard : {}.", spoken.join(", ")),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}

/// Right answers of each person with Wilson intervals, the best first.
pub(crate) fn person_shares(
    language: Language,
    id: &str,
    caption: &str,
    chance: Option<f64>,
    people: &[(String, Proportion)],
) -> Figure {
    let mut people: Vec<&(String, Proportion)> = people.iter().collect();
    let share = |person: &(String, Proportion)| person.1.proportion.unwrap_or(0.0);
    people.sort_by(|a, b| share(b).total_cmp(&share(a)).then_with(|| a.0.cmp(&b.0)));
    let (top, bottom) = (28.0, 202.0);
    let mut svg = Svg::new(caption, bottom + 30.0);
    let kind = MeasureKind::Recognition;
    let place = vertical(&mut svg, language, kind, (0.0, 1.0), (top, bottom));
    if let Some(chance) = chance {
        svg.line([LEFT, place(chance)], [RIGHT, place(chance)], "zero");
        let words = language.pick("guessing", "au hasard");
        svg.text(LEFT + 4.0, place(chance) + 13.0, "small", Anchor::Start, words);
    }
    let headings = language.pick(
        ["person", "right", "trials", "share", "95 % low", "95 % high"],
        ["personne", "justes", "essais", "part", "95 % bas", "95 % haut"],
    );
    let mut data = DataTable::new(id, caption, headings);
    let step = (RIGHT - LEFT) / people.len().max(1) as f64;
    for (i, (person, result)) in people.iter().enumerate() {
        let x = LEFT + step * (i as f64 + 0.5);
        let (Some(share), Some([low, high])) = (result.proportion, result.wilson) else { continue };
        // Intervals that would cover each other are left to the table.
        if step > 2.5 {
            svg.line([x, place(low)], [x, place(high)], "thin");
        }
        svg.circle(x, place(share), (step / 2.5).clamp(0.8, 4.0), "mark");
        data.row([
            person.clone(),
            result.successes.to_string(),
            result.n.to_string(),
            language.fixed(share, 3),
            language.fixed(low, 3),
            language.fixed(high, 3),
        ]);
    }
    let axis = language.pick("people, by their share", "personnes, par part décroissante");
    svg.text((LEFT + RIGHT) / 2.0, bottom + 20.0, "small", Anchor::Middle, axis);
    let ends = (people.last().map_or(0.0, |p| share(p)), people.first().map_or(0.0, |p| share(p)));
    let (low, high) = (language.percent(ends.0), language.percent(ends.1));
    let counted = people_counted(language, people.len());
    let alt = language.pick(
        format!("One point with its interval each of {counted}, from {low} to {high}."),
        format!(
            "Un point avec son intervalle pour chaque personne ({counted}), de {low} à {high}."
        ),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}
