//! Incomplete gamma and beta functions as natural logarithms of both tails.
//!
//! A p-value below 1e-308 is still a finite logarithm, so everything here is computed as a logarithm
//! first. `libm` supplies `lgamma`; the tails are a power series or Lentz's continued fraction,
//! whichever converges.

/// Iterations of a series or continued fraction: both need about the square root of the larger
/// parameter, so this is enough for 10^10 degrees of freedom.
const ITERATIONS: usize = 1_000_000;

/// Below this relative change another term no longer moves a double.
const SETTLED: f64 = 1e-17;

/// Keeps Lentz's denominators away from zero.
const TINY: f64 = 1e-300;

/// Natural logarithms of a lower and an upper tail, which add up to one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LnTails {
    /// ln P(X <= x).
    pub lower: f64,
    /// ln P(X > x).
    pub upper: f64,
}

impl LnTails {
    fn from_lower(lower: f64) -> Self {
        let lower = lower.min(0.0);
        Self { lower, upper: ln_one_minus_exp(lower) }
    }

    fn from_upper(upper: f64) -> Self {
        Self::from_lower(upper).swap()
    }

    fn swap(self) -> Self {
        Self { lower: self.upper, upper: self.lower }
    }
}

/// ln(1 - e^a) for a <= 0, without cancellation.
pub(crate) fn ln_one_minus_exp(a: f64) -> f64 {
    if a > -std::f64::consts::LN_2 { (-a.exp_m1()).ln() } else { (-a.exp()).ln_1p() }
}

/// The remainder s(z) of Stirling's formula ln Γ(z) = (z - 1/2) ln z - z + ln(2π)/2 + s(z), z >= 10
/// (Abramowitz and Stegun 6.1.40; the first term left out is below 2e-17 there).
fn stirling_remainder(z: f64) -> f64 {
    const COEFFICIENTS: [f64; 7] = [
        1.0 / 12.0,
        -1.0 / 360.0,
        1.0 / 1260.0,
        -1.0 / 1680.0,
        1.0 / 1188.0,
        -691.0 / 360_360.0,
        1.0 / 156.0,
    ];
    let inverse = 1.0 / z;
    let square = inverse * inverse;
    COEFFICIENTS.iter().rev().fold(0.0, |sum, c| sum * square + c) * inverse
}

/// ln B(a, b), without the cancellation of three large log-gammas.
pub(crate) fn ln_beta(a: f64, b: f64) -> f64 {
    let (a, b) = if a <= b { (a, b) } else { (b, a) };
    if b < 10.0 {
        return libm::lgamma(a) + libm::lgamma(b) - libm::lgamma(a + b);
    }
    // ln Γ(b) - ln Γ(a + b) by Stirling's formula, its large terms cancelled on paper.
    let remainder = stirling_remainder(b) - stirling_remainder(a + b);
    if a < 10.0 {
        return libm::lgamma(a) - (b - 0.5) * (a / b).ln_1p() - a * (a + b).ln() + a + remainder;
    }
    0.5 * (2.0 * std::f64::consts::PI).ln() - 0.5 * b.ln() + (a - 0.5) * (a / (a + b)).ln()
        - b * (a / b).ln_1p()
        + stirling_remainder(a)
        + remainder
}

/// Tails of the gamma distribution with shape `a` and scale 1 at `x` (DLMF 8.2.4).
pub(crate) fn gamma_tails(a: f64, x: f64) -> LnTails {
    if x <= 0.0 {
        return LnTails { lower: f64::NEG_INFINITY, upper: 0.0 };
    }
    if x == f64::INFINITY {
        return LnTails { lower: 0.0, upper: f64::NEG_INFINITY };
    }
    // ln of x^a e^-x / Γ(a)
    let ln_front = if a < 10.0 {
        a * x.ln() - x - libm::lgamma(a)
    } else {
        let u = (x - a) / a;
        let distance = if u.abs() < 0.5 { u - u.ln_1p() } else { u - (x / a).ln() };
        -a * distance + 0.5 * (a / (2.0 * std::f64::consts::PI)).ln() - stirling_remainder(a)
    };
    if x < a + 1.0 {
        // DLMF 8.7.1: P = front * sum x^k / (a (a+1) ... (a+k))
        let (mut term, mut sum) = (1.0 / a, 1.0 / a);
        for k in 1..ITERATIONS {
            term *= x / (a + k as f64);
            sum += term;
            if term < sum * SETTLED {
                break;
            }
        }
        LnTails::from_lower(ln_front + sum.ln())
    } else {
        // DLMF 8.9.2, by Lentz's method
        let mut b = x + 1.0 - a;
        let mut c = 1.0 / TINY;
        let mut d = 1.0 / b;
        let mut fraction = d;
        for k in 1..ITERATIONS {
            let k = k as f64;
            let numerator = -k * (k - a);
            b += 2.0;
            d = 1.0 / away_from_zero(numerator * d + b);
            c = away_from_zero(b + numerator / c);
            let step = c * d;
            fraction *= step;
            if (step - 1.0).abs() < 1e-16 {
                break;
            }
        }
        LnTails::from_upper(ln_front + fraction.ln())
    }
}

/// A point of the unit interval with what must not be lost of it: x and 1 - x and their logarithms.
#[derive(Debug, Clone, Copy)]
pub(crate) struct UnitPoint {
    x: f64,
    y: f64,
    ln_x: f64,
    ln_y: f64,
}

impl UnitPoint {
    /// From x itself.
    pub(crate) fn new(x: f64) -> Self {
        Self { x, y: 1.0 - x, ln_x: x.ln(), ln_y: (-x).ln_1p() }
    }

    /// x = p / (p + q), with p, q > 0.
    pub(crate) fn from_parts(p: f64, q: f64) -> Self {
        let ratio = q / p;
        Self { x: p / (p + q), y: q / (p + q), ln_x: -ratio.ln_1p(), ln_y: -(1.0 / ratio).ln_1p() }
    }

    fn mirrored(self) -> Self {
        Self { x: self.y, y: self.x, ln_x: self.ln_y, ln_y: self.ln_x }
    }
}

/// Tails of the beta distribution with parameters `a`, `b` at `point` (DLMF 8.17.22).
pub(crate) fn beta_tails(a: f64, b: f64, point: UnitPoint) -> LnTails {
    if point.x <= 0.0 {
        return LnTails { lower: f64::NEG_INFINITY, upper: 0.0 };
    }
    if point.y <= 0.0 {
        return LnTails { lower: 0.0, upper: f64::NEG_INFINITY };
    }
    if point.x > (a + 1.0) / (a + b + 2.0) {
        return beta_tails_left(b, a, point.mirrored()).swap();
    }
    beta_tails_left(a, b, point)
}

fn beta_tails_left(a: f64, b: f64, point: UnitPoint) -> LnTails {
    let x = point.x;
    let mut c = 1.0;
    let mut d = 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0));
    let mut fraction = d;
    for m in 1..ITERATIONS {
        let m = m as f64;
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        d = 1.0 / away_from_zero(1.0 + even * d);
        c = away_from_zero(1.0 + even / c);
        fraction *= d * c;
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        d = 1.0 / away_from_zero(1.0 + odd * d);
        c = away_from_zero(1.0 + odd / c);
        let step = d * c;
        fraction *= step;
        if (step - 1.0).abs() < 1e-16 {
            break;
        }
    }
    LnTails::from_lower(a * point.ln_x + b * point.ln_y - a.ln() - ln_beta(a, b) + fraction.ln())
}

fn away_from_zero(value: f64) -> f64 {
    if value.abs() < TINY { TINY } else { value }
}
