//! A cell as a number.

/// A finite number; with `decimal_comma` also `1,5`.
pub fn parse_number(cell: &str, decimal_comma: bool) -> Option<f64> {
    if let Some(number) = plain_decimal(cell.as_bytes()) {
        return Some(number);
    }
    let parsed = cell.parse::<f64>().ok().or_else(|| {
        let with_point = decimal_comma
            && cell.bytes().filter(|&byte| byte == b',').count() == 1
            && !cell.contains('.');
        if with_point { cell.replace(',', ".").parse().ok() } else { None }
    })?;
    parsed.is_finite().then_some(parsed)
}

/// Digits with at most one point, few enough that the quotient of two exact doubles is the nearest
/// double (Clinger 1990): below 2^53 over a power of ten below 10^23. None for anything else.
#[inline]
pub(crate) fn plain_decimal(cell: &[u8]) -> Option<f64> {
    const POWERS: [f64; 16] =
        [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];
    let (negative, digits) = match cell {
        [b'-', rest @ ..] => (true, rest),
        rest => (false, rest),
    };
    // 16 characters are below 10^16, which is above 2^53: looked at in the end.
    if digits.is_empty() || digits.len() > 16 {
        return None;
    }
    let (mut mantissa, mut places) = (0u64, digits.len());
    for (place, &byte) in digits.iter().enumerate() {
        let digit = byte.wrapping_sub(b'0');
        if digit <= 9 {
            mantissa = mantissa * 10 + u64::from(digit);
        } else if byte == b'.' && places == digits.len() && digits.len() > 1 {
            places = place + 1;
        } else {
            return None;
        }
    }
    if mantissa >= 1 << 53 {
        return None;
    }
    let value = mantissa as f64 / POWERS[digits.len() - places];
    Some(if negative { -value } else { value })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn plain_decimals_are_read_to_the_last_bit() {
        for cell in [
            "0",
            "7",
            "-3",
            "0.1",
            "-0.3",
            "123456789.123456",
            "9007199254740991",
            "5.",
            ".5",
            "-0",
            "1.00000000000001",
            "999999999999999.",
            "00012.50",
            "-.25",
        ] {
            let exact: f64 = cell.parse().unwrap();
            assert_eq!(
                plain_decimal(cell.as_bytes()).map(f64::to_bits),
                Some(exact.to_bits()),
                "{cell}"
            );
        }
        for cell in
            ["", "-", ".", "-.", "1e5", "1.2.3", " 1", "+1", "9007199254740993", "1,5", "nan"]
        {
            assert_eq!(plain_decimal(cell.as_bytes()), None, "{cell}");
        }
        assert_eq!(parse_number("1e5", false), Some(1e5));
        assert_eq!(parse_number("1,5", true), Some(1.5));
        assert_eq!(parse_number("1,5", false), None);
        assert_eq!(parse_number("inf", false), None);
    }

    proptest! {
        #[test]
        fn what_is_read_is_what_the_language_reads(cell in "-?[0-9]{0,12}\\.?[0-9]{0,9}") {
            if let Some(number) = plain_decimal(cell.as_bytes()) {
                prop_assert_eq!(number.to_bits(), cell.parse::<f64>().unwrap().to_bits());
            }
        }
    }
}
