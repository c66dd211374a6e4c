//! The languages that reports and pages of the laboratory are written in.

use crate::counted::{counted_as, counted_in_french};
use crate::numbers::{format_number, format_p};

/// English or French.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Language {
    /// English.
    #[default]
    English,
    /// French.
    French,
}

impl Language {
    /// From a code such as `fr` or `en-GB`; none for a language that no report is written in.
    pub fn from_code(code: &str) -> Option<Self> {
        match primary_language(code).to_ascii_lowercase().as_str() {
            "en" => Some(Self::English),
            "fr" => Some(Self::French),
            _ => None,
        }
    }

    /// `en` or `fr`.
    pub fn code(self) -> &'static str {
        match self {
            Self::English => "en",
            Self::French => "fr",
        }
    }

    /// One of two texts.
    pub fn pick<T>(self, english: T, french: T) -> T {
        match self {
            Self::English => english,
            Self::French => french,
        }
    }

    /// A count with its noun, given for one and for many in English and in French.
    pub fn counted(self, count: usize, english: [&str; 2], french: [&str; 2]) -> String {
        match self {
            Self::English => counted_as(count, english[0], english[1]),
            Self::French => counted_in_french(count, french[0], french[1]),
        }
    }

    /// Items as one phrase, without a comma before the last: `a`, `a and b`, `a, b and c`; in French with `et`. Empty
    /// without items.
    ///
    /// ```
    /// use mimique_locale::Language;
    ///
    /// assert_eq!(Language::English.list(&["joy", "fear", "anger"]), "joy, fear and anger");
    /// assert_eq!(Language::French.list(&["joie", "peur"]), "joie et peur");
    /// ```
    pub fn list(self, items: &[impl AsRef<str>]) -> String {
        let mut text = String::new();
        for (place, item) in items.iter().enumerate() {
            if place > 0 {
                let is_last = place + 1 == items.len();
                text.push_str(if is_last { self.pick(" and ", " et ") } else { ", " });
            }
            text.push_str(item.as_ref());
        }
        text
    }

    /// A number with this language's decimal mark.
    pub fn number(self, value: f64) -> String {
        self.mark(format_number(value))
    }

    /// A number with a fixed count of decimals.
    pub fn fixed(self, value: f64, decimals: usize) -> String {
        let text = format!("{value:.decimals$}");
        let zero = text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.'));
        self.mark(if zero { text.trim_start_matches('-').to_owned() } else { text })
    }

    /// A share in percent.
    pub fn percent(self, share: f64) -> String {
        format!("{:.0} %", share * 100.0)
    }

    /// `p = 0.012`, or `p < 0.001`.
    pub fn p(self, p: f64) -> String {
        match p < 0.001 {
            true => format!("p {}", self.p_rounded(p)),
            false => format!("p = {}", self.p_rounded(p)),
        }
    }

    /// `0.012`, or `< 0.001`.
    pub fn p_rounded(self, p: f64) -> String {
        if p < 0.001 {
            return format!("< {}", self.mark("0.001".to_owned()));
        }
        // Rounding must not carry a p over the border.
        let decimals = if (0.0495..0.0505).contains(&p) { 4 } else { 3 };
        self.fixed(p, decimals)
    }

    /// A p-value in a table: three decimals, or its order of magnitude.
    pub fn p_cell(self, p: f64, ln_p: f64) -> String {
        if p >= 0.001 {
            return self.p_rounded(p);
        }
        if p > 1e-300 {
            return self.mark(format!("{p:.1e}"));
        }
        self.mark(format_p(p, ln_p).trim_start_matches("= ").to_owned())
    }

    fn mark(self, text: String) -> String {
        match self {
            Self::English => text,
            Self::French => text.replace('.', ","),
        }
    }
}

/// The language that a code begins with: `fr` of `fr-BE` (BCP 47, 2.2.1) and of `fr_BE`.
pub fn primary_language(code: &str) -> &str {
    code.split(['-', '_']).next().unwrap_or(code)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_language_is_known_by_the_code_that_it_begins_with() {
        for (code, language) in [
            ("en", Some(Language::English)),
            ("en-GB", Some(Language::English)),
            ("FR_be", Some(Language::French)),
            ("de", None),
            ("", None),
        ] {
            assert_eq!(Language::from_code(code), language, "{code}");
        }
    }

    #[test]
    fn p_is_never_zero_and_stays_on_its_side_of_five_percent() {
        let [english, french] = [Language::English, Language::French];
        assert_eq!(english.p(0.0123), "p = 0.012");
        assert_eq!(french.p(0.000_01), "p < 0,001");
        assert_eq!(english.p_rounded(0.0496), "0.0496");
        assert_eq!(english.p_rounded(0.0504), "0.0504");
        assert_eq!(french.p_cell(0.000_012_3, 0.000_012_3_f64.ln()), "1,2e-5");
        assert_eq!(english.p_cell(0.0, -2000.0), "2.58e-869");
    }

    #[test]
    fn only_the_last_item_of_a_list_follows_an_and() {
        assert_eq!(Language::English.list(&[""; 0]), "");
        assert_eq!(Language::English.list(&["a"]), "a");
        assert_eq!(Language::English.list(&["a", "b"]), "a and b");
        assert_eq!(Language::French.list(&["a", "b", "c", "d"]), "a, b, c et d");
    }

    #[test]
    fn zero_has_no_sign() {
        assert_eq!(Language::English.fixed(-0.001, 2), "0.00");
        assert_eq!(Language::French.fixed(-0.01, 2), "-0,01");
    }
}
