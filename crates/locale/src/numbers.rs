//! Numbers as people read them.

/// Four significant digits, without an exponent from 1e-4 to 1e9.
pub fn format_number(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return "undefined".to_owned();
    }
    let magnitude = value.abs().log10().floor();
    if !(-4.0..9.0).contains(&magnitude) {
        return format!("{value:.3e}");
    }
    let decimals = (3.0 - magnitude).max(0.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        let short = text.trim_end_matches('0').trim_end_matches('.');
        return if short == "-0" { "0".to_owned() } else { short.to_owned() };
    }
    text
}

/// A p-value with its sign of comparison: `= 0.0123`, `= 3.2e-12`, and where it underflows
/// `= 1e-400`, from its natural logarithm.
pub fn format_p(p: f64, ln_p: f64) -> String {
    if p >= 0.0001 {
        return format!("= {}", format_number(p));
    }
    if p > 1e-300 {
        return format!("= {p:.2e}");
    }
    if !ln_p.is_finite() {
        return "< 1e-300".to_owned();
    }
    let tens = ln_p / std::f64::consts::LN_10;
    let exponent = tens.floor();
    format!("= {:.2}e{exponent}", 10f64.powf(tens - exponent))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_p_never_zero() {
        assert_eq!(format_number(0.123_456), "0.1235");
        assert_eq!(format_number(12_345.6), "12346");
        assert_eq!(format_number(1.5), "1.5");
        assert_eq!(format_number(-0.000_01), "-1.000e-5");
        assert_eq!(format_p(0.049_99, 0.0), "= 0.04999");
        assert_eq!(format_p(0.0, -2000.0), "= 2.58e-869");
    }
}
