//! Three numbers per vertex in a pack: how far each lies from a guess, either that of its neighbours
//! (`predict`) or that of its mirror image (`mirror`).

use super::entropy::{Integers, Model, magnitude_bits};
use super::predict::Prediction;

/// Lengths of residuals that are told apart.
const LENGTHS: usize = 10;
/// Contexts of one kind of guess.
const CONTEXTS: usize = LENGTHS * (LENGTHS + 1);

/// Where a guess comes from: they are wrong by different amounts.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Source {
    /// The neighbours that are known.
    Neighbours,
    /// The vertex on the other side of the face.
    Mirror,
}

/// A better guess than the neighbours have, if there is one, of a vertex beside the values so far.
pub(super) type Mirrored<'a> = &'a dyn Fn(u32, &[[i32; 3]]) -> Option<[i32; 3]>;

/// What has been learnt of how far values lie from their guess.
pub(super) struct Residuals {
    model: Model,
    /// The lengths of the last two residuals, by guess and axis.
    before: [[[usize; 2]; 3]; 2],
}

impl Residuals {
    pub fn new() -> Self {
        Self { model: Model::new(2 * CONTEXTS), before: Default::default() }
    }

    /// Writes or reads one vertex's values, whole multiples of `step`. What is expected of a residual
    /// follows from the two before it and from the same vertex on the axis before.
    pub fn vertex(
        &mut self,
        coder: &mut impl Integers,
        source: Source,
        guess: [i32; 3],
        step: i32,
        value: &mut [i32; 3],
    ) {
        let mut length = LENGTHS;
        for axis in 0..3 {
            let before = &mut self.before[source as usize][axis];
            let near = (before[0] + before[1]).div_ceil(2).min(LENGTHS - 1);
            let context = source as usize * CONTEXTS + near * (LENGTHS + 1) + length;
            let guess = (i64::from(guess[axis]) * 2 + i64::from(step))
                .div_euclid(2 * i64::from(step)) as i32;
            let residual = (value[axis] / step).wrapping_sub(guess);
            let residual = coder.integer(&mut self.model, context, residual);
            value[axis] = guess.wrapping_add(residual).wrapping_mul(step);
            let bits = magnitude_bits(residual) as usize;
            *before = [bits, before[0]];
            length = bits.min(LENGTHS - 1);
        }
    }

    /// Writes or reads the values of the visits, in each one's steps; those of
    /// other vertices must be 0. `mirrored` answers a better guess than the neighbours have.
    pub fn vertices(
        &mut self,
        coder: &mut impl Integers,
        prediction: &Prediction,
        visits: &[u32],
        steps: &[i32],
        values: &mut [[i32; 3]],
        mirrored: Mirrored<'_>,
    ) {
        self.before = Default::default();
        for &visit in visits {
            let v = prediction.order[visit as usize];
            let (source, guess) = match mirrored(v, values) {
                Some(guess) => (Source::Mirror, guess),
                None => (Source::Neighbours, prediction.at(visit as usize, values)),
            };
            self.vertex(coder, source, guess, steps[v as usize], &mut values[v as usize]);
            if coder.spent() {
                return;
            }
        }
    }
}

/// About how many bits the values of the visits would take.
pub(super) fn price(
    prediction: &Prediction,
    visits: &[u32],
    steps: &[i32],
    values: &[[i32; 3]],
    mirrored: Mirrored<'_>,
) -> u64 {
    let (mut price, mut values) = (Price(0), values.to_vec());
    Residuals::new().vertices(&mut price, prediction, visits, steps, &mut values, mirrored);
    price.0
}

/// Adds lengths up instead of writing.
struct Price(u64);

impl Integers for Price {
    fn integer(&mut self, _: &mut Model, _: usize, value: i32) -> i32 {
        self.0 += 2 * u64::from(magnitude_bits(value));
        value
    }

    fn spent(&self) -> bool {
        false
    }

    fn writes(&self) -> bool {
        true
    }
}
