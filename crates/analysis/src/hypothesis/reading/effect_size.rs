//! Standardised effect sizes with their intervals, in APA style.

use mimique_locale::Language;
use mimique_stats::{EffectSize, Outcome};

use crate::hypothesis::person_level::PersonLevel;
use crate::naming::Naming;

/// More pairs of levels than this are in a table only.
const MOST_PAIRS: usize = 3;

/// `d_w = .35, 95% CI [.12, .55]`.
pub(crate) fn effect_size(language: Language, size: &EffectSize) -> String {
    let symbol = size.kind.symbol();
    let number = |value: f64| effect_size_number(language, size, value);
    let estimate = number(size.estimate);
    match size.interval_95.map(|interval| interval.map(number)) {
        Some([low, high]) => language.pick(
            format!("{symbol} = {estimate}, 95% CI [{low}, {high}]"),
            format!("{symbol} = {estimate}, IC à 95 % [{low} ; {high}]"),
        ),
        None => format!("{symbol} = {estimate}"),
    }
}

/// Two decimals, in English without the zero before the point where the size cannot exceed 1.
pub(crate) fn effect_size_number(language: Language, size: &EffectSize, value: f64) -> String {
    without_zero(language, language.fixed(value, 2), size.kind.is_bounded())
}

/// A number in APA style: in English without the zero before the point if its absolute value cannot exceed 1.
pub(crate) fn without_zero(language: Language, text: String, is_bounded: bool) -> String {
    match language {
        Language::English if is_bounded => text.replacen("0.", ".", 1),
        _ => text,
    }
}

/// A sentence on the effect sizes of the deciding overall test and of few pairs; `None` where there are none.
pub(crate) fn effect_sizes(
    naming: &Naming<'_>,
    people: &PersonLevel,
    factor: &str,
) -> Option<String> {
    let language = naming.language;
    let words = |sizes: &[EffectSize]| {
        let sizes: Vec<String> = sizes.iter().map(|size| effect_size(language, size)).collect();
        sizes.join(language.pick("; ", " ; "))
    };
    let mut parts = Vec::new();
    if let Some(Outcome::Ok(line)) = people.overall.last()
        && !line.effect_sizes.is_empty()
    {
        parts.push(words(&line.effect_sizes));
    }
    for pair in people.pairs.iter().filter(|_| people.pairs.len() <= MOST_PAIRS) {
        if let Outcome::Ok(line) = &pair.wilcoxon
            && !line.effect_sizes.is_empty()
        {
            let name = naming.pair(factor, &pair.a, &pair.b);
            let colon = language.pick(":", " :");
            parts.push(format!("{name}{colon} {}", words(&line.effect_sizes)));
        }
    }
    (!parts.is_empty()).then(|| {
        let parts = parts.join(language.pick("; ", " ; "));
        language.pick(
            format!("Standardised effect sizes of participants’ values, for these clips: {parts}."),
            format!("Tailles d’effet standardisées des valeurs des personnes, pour ces extraits : {parts}."),
        )
    })
}

#[cfg(test)]
mod tests {
    use mimique_stats::{EffectSizeKind, paired_dominance, standardised_difference};

    use super::*;

    #[test]
    fn bounded_sizes_have_no_zero_before_the_point_in_english() {
        let [english, french] = [Language::English, Language::French];
        let size = |kind, estimate, interval_95| EffectSize { kind, estimate, interval_95, n: 20 };
        let bounded = size(EffectSizeKind::PairedDominance, -0.35, Some([-0.551, 0.02]));
        assert_eq!(effect_size(english, &bounded), "d_w = -.35, 95% CI [-.55, .02]");
        assert_eq!(effect_size(french, &bounded), "d_w = -0,35, IC à 95 % [-0,55 ; 0,02]");
        let free = size(EffectSizeKind::CohenDz, 0.83, None);
        assert_eq!(effect_size(english, &free), "d_z = 0.83");
    }

    /// 65 % have no difference and all others rise: the rank-biserial correlation is 1, the dominance .35.
    #[test]
    fn zeros_count_in_what_is_printed() {
        let differences: Vec<f64> = (0..20).map(|i| if i < 7 { 1.0 } else { 0.0 }).collect();
        let size = paired_dominance(&differences).unwrap();
        assert!(effect_size(Language::English, &size).starts_with("d_w = .35, 95% CI [.09, .5"));
        let size = standardised_difference(&differences).unwrap();
        assert!(effect_size(Language::English, &size).starts_with("d_z = 0.72, 95% CI [0.2"));
    }
}
