//! The language of a report.

pub(crate) mod naming;

use mimique_stats::Undefined;
use mimique_study::text::{counted_as, counted_in_french, primary_language};

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
    pub(crate) fn counted(self, count: usize, english: [&str; 2], french: [&str; 2]) -> String {
        match self {
            Self::English => counted_as(count, english[0], english[1]),
            Self::French => counted_in_french(count, french[0], french[1]),
        }
    }

    /// Why a statistic does not exist.
    pub(crate) fn why_undefined(self, undefined: &Undefined) -> String {
        match self {
            Self::English => undefined.english(),
            Self::French => undefined.french(),
        }
    }

    /// A number with this language's decimal mark.
    pub fn number(self, value: f64) -> String {
        self.mark(mimique_stats::format_number(value))
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
    pub(crate) fn p(self, p: f64) -> String {
        match p < 0.001 {
            true => format!("p {}", self.p_rounded(p)),
            false => format!("p = {}", self.p_rounded(p)),
        }
    }

    /// `0.012`, or `< 0.001`.
    pub(crate) fn p_rounded(self, p: f64) -> String {
        if p < 0.001 {
            return format!("< {}", self.mark("0.001".to_owned()));
        }
        // Rounding must not carry a p over the border.
        let decimals = if (0.0495..0.0505).contains(&p) { 4 } else { 3 };
        self.fixed(p, decimals)
    }

    /// A p-value in a table: three decimals, or its order of magnitude.
    pub(crate) fn p_cell(self, p: f64, ln_p: f64) -> String {
        if p >= 0.001 {
            return self.p_rounded(p);
        }
        if p > 1e-300 {
            return self.mark(format!("{p:.1e}"));
        }
        self.mark(mimique_stats::format_p(p, ln_p).trim_start_matches("= ").to_owned())
    }

    fn mark(self, text: String) -> String {
        match self {
            Self::English => text,
            Self::French => text.replace('.', ","),
        }
    }
}
