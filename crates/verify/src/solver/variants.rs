//! Names of stored optima: which method they are of, and with which parameters.
//!
//! `F4_box_k0.1_a0.3` is `lsts` with kappa 0.1 and alpha 0.3; `kouadio_box_sigma12mm` is `kouadio`
//! with sigma 0.012 m.

use mimique_solver::{LaplacianKind, Method, MethodSpec};
use serde_json::{Map, Value, json};

/// How a name begins and the method that it is of.
const FAMILIES: [(&str, Method); 13] = [
    ("F1", Method::LstsNorm),
    ("F2", Method::LstsShort),
    ("F3", Method::LstsSoft),
    ("F4", Method::Lsts),
    ("thesis_literal", Method::ThesisLiteral),
    ("short_literal", Method::ShortLiteral),
    ("bounds_only", Method::BoundsOnly),
    ("ts_only", Method::ThinShellOnly),
    ("box", Method::Box),
    ("nnls", Method::Nnls),
    ("pinv", Method::PseudoInverse),
    ("kouadio", Method::Kouadio),
    ("ridge", Method::Ridge),
];

/// Words of names that set no number: a Laplacian, a unit.
const WORDS: [(&str, &str, &str); 5] = [
    ("umbrella", "laplacian", "umbrella"),
    ("cotmm", "laplacian", "cotan-literal"),
    ("m", "unit", "m"),
    ("cm", "unit", "cm"),
    ("mm", "unit", "mm"),
];

/// Letters before a number: the parameter, and what the number is multiplied by. The longest that fits.
const NUMBERS: [(&str, &str); 6] = [
    ("sigma", "sigma"),
    ("eps", "eps"),
    ("wb", "boundsWeight"),
    ("a", "alpha"),
    ("k", "kappa"),
    ("s", "s"),
];

/// The method of a name, or why there is none.
pub fn spec(name: &str) -> Result<MethodSpec, String> {
    let family = FAMILIES.iter().find(|(begin, _)| {
        name.strip_prefix(begin).is_some_and(|rest| rest.is_empty() || rest.starts_with('_'))
    });
    let Some((begin, method)) = family else {
        return Err(format!("{name}: no method is known by this name"));
    };
    let mut keys = Map::from_iter([("method".to_owned(), json!(method.name()))]);
    for word in name[begin.len()..].split('_') {
        if let Some((_, key, value)) = WORDS.iter().find(|(own, ..)| *own == word) {
            keys.insert((*key).to_owned(), json!(value));
        } else if let Some((key, value)) = parameter(word) {
            keys.insert(key.to_owned(), json!(value));
        } else if word.contains(|c: char| c.is_ascii_digit()) {
            return Err(format!("{name}: {word} sets no parameter that is known"));
        }
    }
    MethodSpec::checked(&Value::Object(keys)).map_err(|faults| {
        let faults: Vec<String> = faults.iter().map(ToString::to_string).collect();
        format!("{name}: {}", faults.join("; "))
    })
}

/// The parameter that a word sets: `a0.3`, `eps1e-3`, `sigma12mm` (lengths in metres otherwise).
fn parameter(word: &str) -> Option<(&'static str, f64)> {
    let (number, share) = match word.strip_suffix("mm") {
        Some(number) => (number, 1e-3),
        None => (word, 1.0),
    };
    NUMBERS.iter().find_map(|(letters, key)| {
        let value: f64 = number.strip_prefix(letters)?.parse().ok()?;
        Some((*key, value * share))
    })
}

/// How near weights from the displacements come to the stored ones: the pseudo-inverse has a condition
/// of thousands, the literal cotangent one of billions.
pub fn tolerance(spec: &MethodSpec) -> f64 {
    let ill =
        spec.method == Method::PseudoInverse || spec.laplacian() == LaplacianKind::CotanLiteral;
    if ill { 5e-7 } else { 1e-8 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(name: &str) -> Value {
        serde_json::to_value(spec(name).unwrap()).unwrap()
    }

    #[test]
    fn names_say_method_and_parameters() {
        assert_eq!(of("F4_box_k0.1_a0.3"), json!({"method": "lsts", "kappa": 0.1, "alpha": 0.3}));
        assert_eq!(
            of("F3_squared_k0.2_a0.45_s0.02"),
            json!({"method": "lsts-soft", "kappa": 0.2, "alpha": 0.45, "s": 0.02})
        );
        assert_eq!(
            of("F3_cotmm_k0.1_a0.5"),
            json!({"method": "lsts-soft", "laplacian": "cotan-literal", "kappa": 0.1, "alpha": 0.5})
        );
        assert_eq!(
            of("short_literal_mm_a0.1_eps1e-3"),
            json!({"method": "short-literal", "unit": "mm", "alpha": 0.1, "eps": 1e-3})
        );
        assert_eq!(of("kouadio_box_sigma12mm"), json!({"method": "kouadio", "sigma": 0.012}));
        assert_eq!(of("box_no_prior_lsq_linear"), json!({"method": "box"}));
        assert_eq!(
            of("bounds_only_sq_wb1e-3"),
            json!({"method": "bounds-only", "boundsWeight": 1e-3})
        );
    }

    #[test]
    fn what_a_name_does_not_say_is_refused() {
        for (name, why) in [
            ("F9_new", "F9_new: no method is known"),
            ("boxes", "boxes: no method is known"),
            ("F4_box_q3", "F4_box_q3: q3 sets no parameter"),
            ("F4_box_a2", "F4_box_a2: alpha: is 2"),
            ("box_a0.3", "box_a0.3: alpha: 'box' does not use it"),
        ] {
            assert!(spec(name).unwrap_err().starts_with(why), "{:?}", spec(name));
        }
    }
}
