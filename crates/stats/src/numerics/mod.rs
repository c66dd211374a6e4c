//! Numerics that several statistics share: sums, minima, random streams, support vector machines, largest statistics of permutations, and the cones in
//! which a likelihood has no maximum.

pub(crate) mod largest;
pub(crate) mod minimise;
pub(crate) mod random;
pub(crate) mod recession;
pub(crate) mod support_vector_dual;

/// Numbers that are added side by side, so that processors can: always as many, so that the sum is
/// the same bits everywhere.
const LANES: usize = 8;

/// Sum of the products of two lists' members, lists of one length.
#[inline(always)]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    for (a, b) in a.iter().zip(b) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let [p, q, r, s, t, u, v, w] = sums;
    let mut sum = ((p + t) + (r + v)) + ((q + u) + (s + w));
    for (a, b) in a_rest.iter().zip(b_rest) {
        sum += a * b;
    }
    sum
}
