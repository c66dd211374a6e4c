//! Counts as bars, and numbers as they are written beside them.

use maud::{Markup, html};
use mimique_locale::Language;

/// Counts under the name of a factor.
pub(super) fn bars<'a>(caption: &str, counts: impl Iterator<Item = (&'a str, u64)>) -> Markup {
    bars_with(&html! { code { (caption) } }, counts)
}

/// Counts under a caption.
pub(super) fn bars_with<'a>(
    caption: &Markup,
    counts: impl Iterator<Item = (&'a str, u64)>,
) -> Markup {
    let counts: Vec<_> = counts.collect();
    let most = counts.iter().map(|(_, count)| *count).max().unwrap_or(0).max(1);
    html! {
        table.bars {
            caption { (caption) }
            tbody {
                @for (label, count) in counts {
                    tr {
                        th scope="row" { (label) }
                        td.bar { progress aria-hidden="true" max=(most) value=(count) {} }
                        td.number { (count) }
                    }
                }
            }
        }
    }
}

/// A number with two decimals at most, as attributes have it.
pub(super) fn plain(value: f64) -> String {
    let text = format!("{value:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The same with the reader's decimal mark.
pub(super) fn round(language: Language, value: f64) -> String {
    language.pick(plain(value), plain(value).replace('.', ","))
}

#[cfg(test)]
mod tests {
    use super::{Language, plain, round};

    #[test]
    fn numbers_are_written_without_idle_digits() {
        assert_eq!(plain(2.0), "2");
        assert_eq!(plain(2.126), "2.13");
        assert_eq!(round(Language::English, 0.5), "0.5");
        assert_eq!(round(Language::French, 6531.64), "6531,64");
    }
}
