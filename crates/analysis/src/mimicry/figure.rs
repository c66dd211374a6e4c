//! The curve of mean correlations by lag, with its interval and the band of the surrogates.

use mimique_locale::Language;
use mimique_report::document::{DataTable, Figure};
use mimique_report::figure::LINES;
use mimique_report::svg::{Anchor, Axis, Svg, WIDTH};
use mimique_stats::LaggedCorrelation;

const LEFT: f64 = 52.0;
const RIGHT: f64 = WIDTH - 12.0;
const TOP: f64 = 62.0;
const BOTTOM: f64 = 270.0;

/// The curve.
pub(super) fn curve(
    language: Language,
    id: &str,
    caption: &str,
    found: &LaggedCorrelation,
) -> Figure {
    let ends = || found.interval_95.iter().flatten().chain(&found.surrogates_95).flatten();
    let all = || ends().chain(&found.r).copied().filter(|value| value.is_finite()).chain([0.0]);
    let (low, high) = (all().fold(0.0, f64::min), all().fold(0.0, f64::max));
    let mut svg = Svg::new(caption, BOTTOM + 46.0);
    let value = Axis::new(low, high.max(low + 1e-6), BOTTOM, TOP);
    svg.text(4.0, TOP - 10.0, "small", Anchor::Start, language.pick("mean r", "r moyen"));
    for tick in &value.ticks {
        let y = value.place(*tick);
        svg.line([LEFT, y], [RIGHT, y], "rule");
        let text = language.fixed(*tick, value.decimals);
        svg.text(LEFT - 8.0, y + 4.0, "small", Anchor::End, &text);
    }
    let lags = &found.lags_s;
    let (first, last) = (lags.first().copied().unwrap_or(0.0), lags.last().copied().unwrap_or(1.0));
    let lag = Axis::new(first, last, LEFT, RIGHT);
    for tick in &lag.ticks {
        let text = language.fixed(*tick, lag.decimals);
        svg.text(lag.place(*tick), BOTTOM + 16.0, "small", Anchor::Middle, &text);
    }
    let axis = language
        .pick("lag (s): the person after the clip", "décalage (s) : la personne après l’extrait");
    svg.text(RIGHT, BOTTOM + 36.0, "small", Anchor::End, axis);
    let band = |svg: &mut Svg, ends: &[[f64; 2]], colour: &str| {
        let known =
            || lags.iter().zip(ends).filter(|(_, ends)| ends.iter().all(|own| own.is_finite()));
        let lower = known().map(|(at, ends)| [lag.place(*at), value.place(ends[0])]);
        let upper = known().map(|(at, ends)| [lag.place(*at), value.place(ends[1])]);
        let mut outline: Vec<[f64; 2]> = upper.collect();
        outline.reverse();
        let outline: Vec<[f64; 2]> = lower.chain(outline).collect();
        svg.band(&outline, colour);
    };
    let [own, surrogates] = [LINES[0], LINES[1]];
    band(&mut svg, &found.surrogates_95, surrogates.0);
    if let Some(interval) = &found.interval_95 {
        band(&mut svg, interval, own.0);
    }
    let points = lags.iter().zip(&found.r).filter(|(_, r)| r.is_finite());
    let points: Vec<[f64; 2]> = points.map(|(at, r)| [lag.place(*at), value.place(*r)]).collect();
    svg.coloured_path(&points, own);
    svg.circle(lag.place(found.lag_s), value.place(found.highest_r), 4.0, "mark");
    let critical = value.place(found.critical_r.clamp(low, high));
    svg.coloured_path(&[[LEFT, critical], [RIGHT, critical]], surrogates);
    let keys = [
        (
            own,
            language.pick(
                "mean over people, 95 % interval",
                "moyenne sur les personnes, intervalle à 95 %",
            ),
        ),
        (
            surrogates,
            language.pick(
                "surrogates: middle 95 %, and limit of the highest value",
                "substituts : 95 % centraux, et limite de la plus haute valeur",
            ),
        ),
    ];
    for (place, (line, text)) in keys.into_iter().enumerate() {
        let y = 16.0 + 16.0 * place as f64;
        svg.coloured_path(&[[LEFT, y - 4.0], [LEFT + 18.0, y - 4.0]], line);
        svg.text(LEFT + 24.0, y, "small", Anchor::Start, text);
    }
    let columns = language.pick(
        ["lag (s)", "r", "from", "to", "surrogates from", "surrogates to"],
        ["décalage (s)", "r", "de", "à", "substituts de", "substituts à"],
    );
    let mut data = DataTable::new(id, caption, columns);
    let cell =
        |value: f64| if value.is_finite() { language.fixed(value, 3) } else { String::new() };
    for (place, at) in lags.iter().enumerate() {
        let interval = found.interval_95.as_ref().map_or([f64::NAN; 2], |own| own[place]);
        let [low, high] = found.surrogates_95[place];
        let values = [found.r[place], interval[0], interval[1], low, high].map(cell);
        data.row(std::iter::once(language.fixed(*at, 3)).chain(values));
    }
    let (r, at) = (language.fixed(found.highest_r, 3), language.fixed(found.lag_s, 2));
    let limit = language.fixed(found.critical_r, 3);
    let alt = language.pick(
        format!("A curve over lags: it is highest, {r}, at {at} s; surrogates stay below {limit} in 95 of 100."),
        format!("Une courbe selon le décalage : elle culmine, à {r}, à {at} s ; 95 substituts sur 100 restent sous {limit}."),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}
