//! The psychometric function: how often an answer is right at a level.
//!
//! P(right) = guess + (1 - guess - lapse) F(level), with F one of three [`Shape`]s. Where an answer is
//! "yes" or "no", guess is the share of "yes" without a difference.

use core::f64::consts::{FRAC_1_SQRT_2, LN_2};

/// The form of the function between guess and lapse.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// 1 / (1 + exp(-(x - m) / s)).
    Logistic,
    /// Φ((x - m) / s).
    Normal,
    /// 1 - exp(-(x / m)^s) of levels above 0: m is where 63 % are reached, s the slope.
    Weibull,
}

impl Shape {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Logistic, Self::Normal, Self::Weibull];

    /// Its name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Logistic => "logistic",
            Self::Normal => "normal",
            Self::Weibull => "weibull",
        }
    }

    /// The shape of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|shape| shape.name() == name)
    }

    /// F at a level, with location m and spread (of Weibull: slope) s above 0.
    pub fn at(self, level: f64, location: f64, spread: f64) -> f64 {
        match self {
            Self::Logistic => logistic((level - location) / spread),
            Self::Normal => normal_below((level - location) / spread),
            Self::Weibull if level <= 0.0 => 0.0,
            Self::Weibull => -libm::expm1(-libm::pow(level / location, spread)),
        }
    }

    /// The level at which F is one half.
    pub fn half(self, location: f64, spread: f64) -> f64 {
        match self {
            Self::Logistic | Self::Normal => location,
            Self::Weibull => location * libm::pow(LN_2, 1.0 / spread),
        }
    }

    /// The location whose level of one half is this: the inverse of [`Shape::half`].
    pub fn location_of_half(self, half: f64, spread: f64) -> f64 {
        match self {
            Self::Logistic | Self::Normal => half,
            Self::Weibull => half * libm::pow(LN_2, -1.0 / spread),
        }
    }
}

/// A psychometric function with its parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Psychometric {
    /// Its form.
    pub shape: Shape,
    /// m, in the unit of the levels.
    pub location: f64,
    /// s, above 0: in the unit of the levels; a slope without unit for Weibull.
    pub spread: f64,
    /// Share of right answers without any information.
    pub guess: f64,
    /// Share of wrong answers where all is seen.
    pub lapse: f64,
}

impl Psychometric {
    /// Probability of a right answer at a level.
    pub fn right(&self, level: f64) -> f64 {
        let seen = self.shape.at(level, self.location, self.spread);
        self.guess + (1.0 - self.guess - self.lapse) * seen
    }
}

/// 1 / (1 + exp(-x)).
pub fn logistic(x: f64) -> f64 {
    if x >= 0.0 {
        1.0 / (1.0 + libm::exp(-x))
    } else {
        let odds = libm::exp(x);
        odds / (1.0 + odds)
    }
}

/// Φ(z): the standard normal distribution function.
pub fn normal_below(z: f64) -> f64 {
    0.5 * libm::erfc(-z * FRAC_1_SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_is_where_half_of_it_is_reached() {
        for shape in Shape::ALL {
            for (location, spread) in [(0.3, 0.1), (2.0, 3.5), (0.5, 0.7)] {
                let half = shape.half(location, spread);
                assert!((shape.at(half, location, spread) - 0.5).abs() < 1e-14, "{shape:?}");
                assert!((shape.location_of_half(half, spread) - location).abs() < 1e-14);
            }
            assert_eq!(Shape::from_name(shape.name()), Some(shape));
        }
        assert_eq!(Shape::from_name("cubic"), None);
    }

    #[test]
    fn the_function_goes_from_guess_to_one_minus_lapse() {
        for shape in Shape::ALL {
            let function =
                Psychometric { shape, location: 0.5, spread: 1.5, guess: 0.25, lapse: 0.04 };
            let (low, high) = (function.right(-1e4), function.right(1e4));
            assert!((low - 0.25).abs() < 1e-9 && (high - 0.96).abs() < 1e-9, "{low} {high}");
            let rising = [-1.0, 0.0, 0.2, 0.5, 1.0, 3.0].map(|level| function.right(level));
            assert!(rising.windows(2).all(|pair| pair[0] <= pair[1]), "{rising:?}");
        }
        assert!((logistic(-800.0) - 0.0).abs() < 1e-300 && logistic(800.0) == 1.0);
    }
}
