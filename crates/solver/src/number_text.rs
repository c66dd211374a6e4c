//! A number as text: the fewest digits that are read as the same number, without an exponent.
//!
//! In the browser it is the browser that finds the digits (ECMA-262, `Number::toString`): the code for
//! it is there already, and is not downloaded with the page.

/// The text of a number: `0.1`, `-2`, `0.00000001`; `NaN`, `inf` and `-inf` for what is none.
pub fn number_text(number: f64) -> String {
    #[cfg(target_arch = "wasm32")]
    return browser(number);
    #[cfg(not(target_arch = "wasm32"))]
    return number.to_string();
}

#[cfg(target_arch = "wasm32")]
fn browser(number: f64) -> String {
    use wasm_bindgen::prelude::wasm_bindgen;

    #[wasm_bindgen]
    extern "C" {
        #[wasm_bindgen(js_name = String)]
        fn text_of(number: f64) -> String;
    }
    if number == 0.0 && number.is_sign_negative() {
        return "-0".to_owned();
    }
    plain(&text_of(number))
}

/// What ECMAScript writes, as Rust writes it: `1.5e-7` is `0.00000015`.
#[cfg(any(test, target_arch = "wasm32"))]
fn plain(text: &str) -> String {
    let (sign, size) = match text.strip_prefix('-') {
        Some(size) => ("-", size),
        None => ("", text),
    };
    if size == "Infinity" {
        return [sign, "inf"].concat();
    }
    let Some((mantissa, exponent)) = size.split_once('e') else { return text.to_owned() };
    let exponent: i32 = exponent.trim_start_matches('+').parse().unwrap_or(0);
    let (whole, part) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let zeros = |count: i32| "0".repeat(count.max(0) as usize);
    if exponent < 0 {
        return [sign, "0.", &zeros(-exponent - 1), whole, part].concat();
    }
    [sign, whole, part, &zeros(exponent - part.len() as i32)].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_ecmascript_writes_becomes_what_rust_writes() {
        // Right: Node's `String(x)`.
        for (number, script) in [
            (0.1, "0.1"),
            (-2.0, "-2"),
            (1e-8, "1e-8"),
            (1.5e-7, "1.5e-7"),
            (-0.000_001, "-0.000001"),
            (5e-324, "5e-324"),
            (1e21, "1e+21"),
            (123_456_789_012_345_680_000.0, "123456789012345680000"),
            (-1.797_693_134_862_315_7e308, "-1.7976931348623157e+308"),
            (f64::NAN, "NaN"),
            (f64::INFINITY, "Infinity"),
            (f64::NEG_INFINITY, "-Infinity"),
        ] {
            assert_eq!(plain(script), number.to_string(), "{script}");
        }
    }
}
