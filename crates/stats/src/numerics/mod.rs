//! Numerics that several statistics share: sums, minima, random streams, and the cones in which a likelihood
//! has no maximum.

pub(crate) mod minimise;
pub(crate) mod random;
pub(crate) mod recession;

/// Numbers that are added side by side, so that processors can: always as many, so that the sum is
/// the same bits everywhere.
const LANES: usize = 8;

/// Sum of the products of two lists' members, lists of one length.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    for (a, b) in a.iter().zip(b) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    sums.iter_mut().zip(a_rest).zip(b_rest).for_each(|((sum, a), b)| *sum += a * b);
    let [a, b, c, d, e, f, g, h] = sums;
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}
