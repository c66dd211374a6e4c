//! The exponential of many numbers, the same bits everywhere.
//!
//! Only additions, multiplications and integer shifts, each number by itself: a compiler does
//! several at a time, which `libm`'s branches and tables do not let it.

use crate::linear_algebra::dense::widest;

widest! {
    /// x_i := exp(x_i), to 2 units in the last place; 0 below -708, infinity above 709.
    fn exp_all(x: &mut [f64]) {
        for x in x {
            *x = exp(*x);
        }
    }
}

/// exp(x) = 2^k exp(r), k the nearest integer to x / ln 2, |r| <= ln 2 / 2.
#[inline(always)]
fn exp(x: f64) -> f64 {
    /// 1.5 * 2^52: added to a number below 2^51 it leaves its nearest integer in the low bits.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    /// ln 2 in two parts, the first with 20 trailing zeros, so that k times it is exact.
    const LN2_HIGH: f64 = f64::from_bits(0x3fe6_2e42_fee0_0000);
    const LN2_LOW: f64 = f64::from_bits(0x3dea_39ef_3579_3c76);
    // Beyond these the result is set below; within them no bit pattern overflows.
    let inside = x.clamp(-708.0, 709.0);
    let shifted = inside * std::f64::consts::LOG2_E + ROUND;
    let k = shifted - ROUND;
    let r = (inside - k * LN2_HIGH) - k * LN2_LOW;
    // Taylor to r^13: the next term is below 1e-17 of the sum for |r| <= 0.3466.
    let mut p = 1.0 / 6_227_020_800.0;
    p = p * r + 1.0 / 479_001_600.0;
    p = p * r + 1.0 / 39_916_800.0;
    p = p * r + 1.0 / 3_628_800.0;
    p = p * r + 1.0 / 362_880.0;
    p = p * r + 1.0 / 40_320.0;
    p = p * r + 1.0 / 5_040.0;
    p = p * r + 1.0 / 720.0;
    p = p * r + 1.0 / 120.0;
    p = p * r + 1.0 / 24.0;
    p = p * r + 1.0 / 6.0;
    p = p * r + 0.5;
    p = (p * r) * r + r;
    p += 1.0;
    // The low bits of `shifted` are k; 2^k by its exponent.
    let scale = f64::from_bits((shifted.to_bits() << 52).wrapping_add(0x3ff0_0000_0000_0000));
    let value = p * scale;
    if x > 709.0 {
        f64::INFINITY
    } else if x < -708.0 {
        0.0
    } else {
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_libm_and_ends_well() {
        let mut worst: f64 = 0.0;
        for i in -70_000..70_000 {
            let x = f64::from(i) * 0.01 + f64::from(i % 97) * 1e-4;
            if x > -707.0 {
                worst = worst.max((exp(x) / libm::exp(x) - 1.0).abs());
            }
        }
        assert!(worst < 5e-16, "{worst:e}");
        let mut ends = [0.0, -1e300, 1e300, f64::NEG_INFINITY, f64::INFINITY, 710.0, -0.0];
        exp_all(&mut ends);
        assert_eq!(ends, [1.0, 0.0, f64::INFINITY, 0.0, f64::INFINITY, f64::INFINITY, 1.0]);
        assert!(exp(f64::NAN).is_nan());
    }
}
