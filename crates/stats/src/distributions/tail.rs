//! Tails and quantiles of the distributions that the tests refer to, with logarithms that stay right
//! where the probability itself underflows.
//!
//! Quantiles are those of `statrs`. Tails are our own: a logarithm is needed below 1e-308 as well, which
//! takes the same series and continued fractions again, and against 40 digits of mpmath the largest
//! relative errors down to 1e-300 are
//!
//! | tail | ours | statrs 0.19 |
//! |---|---|---|
//! | normal | 9e-14 | 9e-11 |
//! | chi-square, to 333 and to 1e6 degrees of freedom | 3e-14, 4e-13 | 1e-13, 6e-10 |
//! | t, to 333 and to 1e6 | 7e-15, 2e-11 | 5e-12, 9e-9 |
//! | F, to 300 and to 1e5 | 2e-14, 3e-12 | 1e-12, 4e-10 |

use serde::Serialize;
use statrs::distribution::{Beta, ContinuousCDF, Normal, StudentsT};

use crate::distributions::special::{
    LnTails, UnitPoint, beta_tails, gamma_tails, ln_beta, ln_one_minus_exp,
};

/// A tail probability and its natural logarithm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Tail {
    /// The probability; zero only where it is below the smallest double.
    pub p: f64,
    /// Its natural logarithm, finite also where `p` underflows.
    pub ln_p: f64,
}

impl Tail {
    /// From the logarithm; probabilities never exceed one.
    pub fn from_ln(ln_p: f64) -> Self {
        let ln_p = ln_p.min(0.0);
        Self { p: ln_p.exp(), ln_p }
    }

    /// From the probability itself.
    pub fn from_p(p: f64) -> Self {
        let p = p.min(1.0);
        Self { p, ln_p: p.ln() }
    }

    /// Twice this tail, at most one.
    pub fn doubled(self) -> Self {
        Self { p: (2.0 * self.p).min(1.0), ln_p: (self.ln_p + std::f64::consts::LN_2).min(0.0) }
    }
}

/// Which tail answers the question.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Alternative {
    /// Either direction: twice the smaller tail.
    #[default]
    TwoSided,
    /// The first is larger.
    Greater,
    /// The first is smaller.
    Less,
}

impl Alternative {
    /// The word used on the command line and in results.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::TwoSided => "two-sided",
            Self::Greater => "greater",
            Self::Less => "less",
        }
    }
}

/// P(chi-square with `df` degrees of freedom > x).
pub fn chi_square_upper(x: f64, df: f64) -> Tail {
    Tail::from_ln(gamma_tails(df / 2.0, x / 2.0).upper)
}

/// P(Z > z) of the standard normal distribution.
pub fn normal_upper(z: f64) -> Tail {
    let p = 0.5 * libm::erfc(z * std::f64::consts::FRAC_1_SQRT_2);
    if z < -1.0 {
        return Tail { p, ln_p: (-0.5 * libm::erfc(-z * std::f64::consts::FRAC_1_SQRT_2)).ln_1p() };
    }
    if z < 5.0 {
        return Tail { p, ln_p: p.ln() };
    }
    // Mills' ratio as 1/(z + 1/(z + 2/(z + 3/(z + ...)))), Abramowitz and Stegun 26.2.14; from 5 on
    // 60 steps are more than double precision needs.
    let ratio = (1..=60).rev().fold(z, |rest, k| z + k as f64 / rest);
    let ln_p = -0.5 * z * z - ratio.ln() - 0.5 * (2.0 * std::f64::consts::PI).ln();
    Tail { p, ln_p }
}

/// The normal tail of a z value for an alternative.
pub fn normal_tail(z: f64, alternative: Alternative) -> Tail {
    match alternative {
        Alternative::TwoSided => normal_upper(z.abs()).doubled(),
        Alternative::Greater => normal_upper(z),
        Alternative::Less => normal_upper(-z),
    }
}

fn t_tails(t: f64, df: f64) -> LnTails {
    // P(|T| > t) is the beta tail at df / (df + t^2) with parameters df/2 and 1/2.
    let square = t * t;
    let both = if square == 0.0 {
        LnTails { lower: 0.0, upper: f64::NEG_INFINITY }
    } else {
        beta_tails(df / 2.0, 0.5, UnitPoint::from_parts(df, square))
    };
    let outer = both.lower - std::f64::consts::LN_2;
    let inner = ln_one_minus_exp(outer);
    if t >= 0.0 {
        LnTails { lower: inner, upper: outer }
    } else {
        LnTails { lower: outer, upper: inner }
    }
}

/// P(T > t) of Student's t with `df` degrees of freedom.
pub fn t_upper(t: f64, df: f64) -> Tail {
    Tail::from_ln(t_tails(t, df).upper)
}

/// P(|T| > |t|) of Student's t with `df` degrees of freedom.
pub fn t_two_sided(t: f64, df: f64) -> Tail {
    t_upper(t.abs(), df).doubled()
}

/// P(F > f) of the F distribution.
pub fn f_upper(f: f64, df1: f64, df2: f64) -> Tail {
    if f <= 0.0 {
        return Tail { p: 1.0, ln_p: 0.0 };
    }
    let point = UnitPoint::from_parts(df2, df1 * f);
    Tail::from_ln(beta_tails(df2 / 2.0, df1 / 2.0, point).lower)
}

/// P(X >= k) of a binomial variable of `n` trials with probability 1/2.
pub fn binomial_half_at_least(k: usize, n: usize) -> Tail {
    match k {
        0 => Tail::from_ln(0.0),
        k if k > n => Tail { p: 0.0, ln_p: f64::NEG_INFINITY },
        // The incomplete beta function at 1/2 (DLMF 8.17.5).
        k => Tail::from_ln(beta_tails(k as f64, (n - k + 1) as f64, UnitPoint::new(0.5)).lower),
    }
}

/// The z above which a standard normal variable falls with probability `p`, between 0 and 1.
pub fn normal_quantile_upper(p: f64) -> f64 {
    -Normal::standard().inverse_cdf(p)
}

/// The t above which Student's t with `df` degrees of freedom falls with probability `p`, from 1e-6 to 1/2;
/// NaN where there are no degrees of freedom.
pub fn t_quantile_upper(p: f64, df: f64) -> f64 {
    match StudentsT::new(0.0, 1.0, df) {
        Ok(student) => -student.inverse_cdf(p),
        Err(_) => f64::NAN,
    }
}

/// The x below which a beta variable falls with probability `p`; NaN where `a` or `b` is not positive.
pub fn beta_quantile(p: f64, a: f64, b: f64) -> f64 {
    match Beta::new(a, b) {
        Ok(beta) => beta.inverse_cdf(p),
        Err(_) => f64::NAN,
    }
}

/// The f below which an F variable falls with probability `p`, between 0 and 1; NaN without degrees of freedom.
pub fn f_quantile(p: f64, df1: f64, df2: f64) -> f64 {
    // From the beta variable df1 F / (df1 F + df2), whichever end of it keeps its digits, ...
    let (a, b) = (df1 / 2.0, df2 / 2.0);
    let mut f = if p < 0.5 {
        let x = beta_quantile(p, a, b);
        df2 * x / (df1 * (1.0 - x))
    } else {
        let y = beta_quantile(1.0 - p, b, a);
        df2 * (1.0 - y) / (df1 * y)
    };
    // ... then Newton's steps on our own tails.
    for _ in 0..4 {
        if !(f.is_finite() && f > 0.0) {
            break;
        }
        let point = UnitPoint::from_parts(df1 * f, df2);
        let lower = beta_tails(a, b, point).lower.exp();
        let ln_density = a * libm::log(df1 / df2) + (a - 1.0) * libm::log(f)
            - (a + b) * libm::log1p(df1 * f / df2)
            - ln_beta(a, b);
        let step = (lower - p) / libm::exp(ln_density);
        let next = f - step;
        f = if next > 0.0 { next } else { f / 2.0 };
    }
    f
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_invert_tails() {
        assert!((normal_quantile_upper(0.025) - 1.959_963_984_540_054).abs() < 1e-13);
        assert!((t_quantile_upper(0.025, 6.0) - 2.446_911_851_144_969).abs() < 1e-12);
        let x = beta_quantile(0.975, 3.0, 8.0);
        assert!((beta_tails(3.0, 8.0, UnitPoint::new(x)).lower.exp() - 0.975).abs() < 1e-12);
    }

    #[test]
    fn quantiles_of_f_invert_its_tail() {
        for (df1, df2) in [(1.0, 1.0), (3.0, 44.7), (10.0, 33.0), (0.6, 200.0), (250.0, 2.5)] {
            for p in [0.001, 0.025, 0.3, 0.5, 0.9, 0.975, 0.9999] {
                let f = f_quantile(p, df1, df2);
                let upper = f_upper(f, df1, df2).p;
                assert!((upper - (1.0 - p)).abs() < 1e-12, "{df1} {df2} {p}: {f} {upper}");
            }
        }
    }

    #[test]
    fn logarithms_go_on_where_probabilities_underflow() {
        let tail = chi_square_upper(4000.0, 2.0);
        assert_eq!(tail.p, 0.0);
        assert!((tail.ln_p + 2000.0).abs() < 1e-9);
        let tail = normal_upper(50.0);
        assert_eq!(tail.p, 0.0);
        assert!((tail.ln_p + 1_254.831_360_8).abs() < 1e-6, "{}", tail.ln_p);
    }

    #[test]
    fn tails_agree_with_another_implementation() {
        use statrs::distribution::{ChiSquared, FisherSnedecor};
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-8 * b.abs() + 1e-300;
        for df in [1.0, 2.0, 3.0, 7.0, 40.0, 333.0] {
            let chi = ChiSquared::new(df).unwrap();
            let student = StudentsT::new(0.0, 1.0, df).unwrap();
            let fisher = FisherSnedecor::new(df, 9.0).unwrap();
            for x in [0.01, 0.5, 1.0, 3.0, 17.0, 80.0] {
                assert!(close(chi_square_upper(x, df).p, chi.sf(x)), "chi {df} {x}");
                assert!(close(t_upper(x, df).p, student.sf(x)), "t {df} {x}");
                assert!(close(f_upper(x, df, 9.0).p, fisher.sf(x)), "F {df} {x}");
            }
        }
    }

    #[test]
    fn no_tail_exceeds_one() {
        assert_eq!(normal_tail(0.0, Alternative::TwoSided).p, 1.0);
        assert_eq!(t_two_sided(0.0, 3.0).p, 1.0);
        assert_eq!(f_upper(0.0, 2.0, 3.0).p, 1.0);
    }
}
