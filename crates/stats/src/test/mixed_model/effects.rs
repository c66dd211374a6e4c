//! The system of all random effects, I + Λ Z' W Z Λ: factored by eliminating blocks first, solved, inverted where
//! answers need it.
//!
//! Effects are in units of their standard deviation (Λ holds these), so that a standard deviation of 0 is no special
//! case. With B the diagonal blocks and A their coupling with the rest, X = L^-1 A for B = L L', the rest's system is
//! S = C - X' X (the Schur complement), which is dense.
//!
//! A block that represents n others of the same design has their sum, divided by √n, as its effects: of n blocks turned by an
//! orthogonal matrix whose first row is 1/√n, that is the only one that meets the rest (with √n A), and each of the other
//! n - 1 has the system B alone.

use super::design::Layout;
use crate::numerics::dot;

/// A factored system.
#[derive(Clone)]
pub(super) struct Factored {
    /// Where L and X of each block begin.
    at: Vec<[usize; 2]>,
    /// L of each block, one after the other.
    blocks: Vec<f64>,
    /// X of each block, block's effects x rest.
    cross: Vec<f64>,
    /// L of S.
    rest: Vec<f64>,
    /// ln det of the whole.
    pub ln_det: f64,
}

/// What weighs the answers.
#[derive(Clone, Copy)]
pub(super) enum Weights<'w> {
    /// Each by itself.
    Own(&'w [f64]),
    /// All with 1.
    One,
}

impl Factored {
    /// A system of a layout, not yet factored.
    pub(super) fn new(layout: &Layout) -> Self {
        let rest = layout.in_rest;
        let (mut own, mut cross) = (0, 0);
        let mut at: Vec<[usize; 2]> = Vec::with_capacity(layout.blocks.len());
        for block in &layout.blocks {
            at.push([own, cross]);
            own += block.size * block.size;
            cross += block.size * rest;
        }
        let [blocks, cross, rest] = [own, cross, rest * rest].map(|size| vec![0.0; size]);
        Self { at, blocks, cross, rest, ln_det: 0.0 }
    }

    /// L and X of a block.
    fn block(&self, layout: &Layout, place: usize) -> (&[f64], &[f64]) {
        let ([own, cross], size) = (self.at[place], layout.blocks[place].size);
        (&self.blocks[own..own + size * size], &self.cross[cross..cross + size * layout.in_rest])
    }

    /// Factors the system of these standard deviations (a term each) and weights (an answer each). Whether that
    /// succeeded: not where a number is none.
    pub(super) fn factor(&mut self, layout: &Layout, scale: &[f64], weights: Weights<'_>) -> bool {
        let (rest, k) = (layout.in_rest, layout.eliminated);
        self.blocks.fill(0.0);
        self.cross.fill(0.0);
        self.rest.fill(0.0);
        for i in 0..rest {
            self.rest[i * rest + i] = 1.0;
        }
        self.ln_det = 0.0;
        let mut nonzero: Vec<u32> = Vec::with_capacity(rest);
        for (number, block) in layout.blocks.iter().enumerate() {
            let count = block.count as f64;
            let (size, [start, cross]) = (block.size, self.at[number]);
            let own = &mut self.blocks[start..start + size * size];
            let cross = &mut self.cross[cross..cross + size * rest];
            for i in 0..size {
                own[i * size + i] = 1.0;
            }
            for place in block.rows.clone() {
                let effects = layout.effects(place);
                let weight = match weights {
                    Weights::Own(weights) => weights[place],
                    Weights::One => 1.0,
                };
                for (i, effect) in effects.iter().enumerate() {
                    let by = weight * scale[i];
                    if i < k {
                        let row = *effect as usize - block.first;
                        for (j, other) in effects[..k].iter().enumerate() {
                            own[row * size + (*other as usize - block.first)] += by * scale[j];
                        }
                        for (j, other) in effects.iter().enumerate().skip(k) {
                            cross[row * rest + (*other as usize - layout.in_blocks)] +=
                                by * scale[j];
                        }
                    } else {
                        let row = *effect as usize - layout.in_blocks;
                        for (j, other) in effects.iter().enumerate().skip(k) {
                            self.rest[row * rest + (*other as usize - layout.in_blocks)] +=
                                count * by * scale[j];
                        }
                    }
                }
            }
            match cholesky(own, size) {
                Some(ln_det) => self.ln_det += count * ln_det,
                None => return false,
            }
            // X = L^-1 A, row after row; each then leaves the rest's lower half. Effects of people with a segment meet
            // few of the rest.
            for i in 0..size {
                let (before, here) = cross.split_at_mut(i * rest);
                let row = &mut here[..rest];
                for j in 0..i {
                    let by = own[i * size + j];
                    if by != 0.0 {
                        row.iter_mut().zip(&before[j * rest..]).for_each(|(a, x)| *a -= by * x);
                    }
                }
                let by = 1.0 / own[i * size + i];
                row.iter_mut().for_each(|a| *a *= by);
                nonzero.clear();
                nonzero.extend((0..rest as u32).filter(|r| row[*r as usize] != 0.0));
                if nonzero.len() * 2 > rest {
                    for r in nonzero.iter().map(|r| *r as usize) {
                        let x = count * row[r];
                        let lower = &mut self.rest[r * rest..=r * rest + r];
                        lower.iter_mut().zip(row.iter()).for_each(|(s, y)| *s -= x * y);
                    }
                } else {
                    for (n, r) in nonzero.iter().map(|r| *r as usize).enumerate() {
                        let x = count * row[r];
                        for c in nonzero[..=n].iter().map(|c| *c as usize) {
                            self.rest[r * rest + c] -= x * row[c];
                        }
                    }
                }
            }
        }
        match cholesky(&mut self.rest, rest) {
            Some(ln_det) => self.ln_det += ln_det,
            None => return false,
        }
        self.ln_det.is_finite()
    }

    /// Solves the system in place.
    pub(super) fn solve(&self, layout: &Layout, values: &mut [f64]) {
        let rest = layout.in_rest;
        let (own, of_rest) = values.split_at_mut(layout.in_blocks);
        for (number, block) in layout.blocks.iter().enumerate() {
            let (lower, cross) = self.block(layout, number);
            let part = &mut own[block.first..block.first + block.size];
            forward(lower, block.size, part);
            let root = (block.count as f64).sqrt();
            for (i, value) in part.iter().enumerate() {
                let (value, cross) = (root * value, &cross[i * rest..][..rest]);
                of_rest.iter_mut().zip(cross).for_each(|(r, x)| *r -= value * x);
            }
        }
        forward(&self.rest, rest, of_rest);
        backward(&self.rest, rest, of_rest);
        for (number, block) in layout.blocks.iter().enumerate() {
            let (lower, cross) = self.block(layout, number);
            let part = &mut own[block.first..block.first + block.size];
            let root = (block.count as f64).sqrt();
            for (i, value) in part.iter_mut().enumerate() {
                *value -= root * dot(&cross[i * rest..][..rest], of_rest);
            }
            backward(lower, block.size, part);
        }
    }

    /// B^-1 of a block: block's effects x block's effects.
    pub(super) fn block_inverse(&self, layout: &Layout, number: usize) -> Vec<f64> {
        inverse(self.block(layout, number).0, layout.blocks[number].size)
    }

    /// The diagonal of the inverse, an effect each.
    pub(super) fn inverse_diagonal(&self, layout: &Layout) -> Vec<f64> {
        let rest = layout.in_rest;
        let mut diagonal = vec![0.0; layout.size()];
        let mut y = Vec::new();
        for (number, block) in layout.blocks.iter().enumerate() {
            let size = block.size;
            let count = block.count as f64;
            let (lower, cross) = self.block(layout, number);
            let own = inverse_diagonal(lower, size);
            // With Y = B^-1 A the block's part of the inverse is B^-1 + Y S^-1 Y'.
            y.clear();
            y.extend_from_slice(cross);
            to_inverse(lower, size, &mut y);
            for (i, row) in y.chunks_exact_mut(rest.max(1)).enumerate() {
                forward(&self.rest, rest, row);
                diagonal[block.first + i] = count * dot(row, row) + own[i];
            }
        }
        diagonal[layout.in_blocks..].copy_from_slice(&inverse_diagonal(&self.rest, rest));
        diagonal
    }

    /// For each answer, its place and the inverse between the effects that it has: terms x terms.
    pub(super) fn covariances(&self, layout: &Layout, mut each: impl FnMut(usize, &[f64])) {
        let (rest, k, terms) = (layout.in_rest, layout.eliminated, layout.terms.len());
        if terms == 0 {
            return;
        }
        let of_rest = inverse(&self.rest, rest);
        let mut between = vec![0.0; terms * terms];
        for (number, block) in layout.blocks.iter().enumerate() {
            let size = block.size;
            let (lower, cross) = self.block(layout, number);
            let mut y = cross.to_vec();
            to_inverse(lower, size, &mut y);
            // Minus the inverse between block and rest, and the inverse within the block.
            let mut cross = vec![0.0; size * rest];
            for i in 0..size {
                let row = &mut cross[i * rest..][..rest];
                for (r, by) in y[i * rest..][..rest].iter().enumerate().filter(|(_, y)| **y != 0.0)
                {
                    row.iter_mut().zip(&of_rest[r * rest..]).for_each(|(c, s)| *c += by * s);
                }
            }
            let mut own = inverse(lower, size);
            for i in 0..size {
                for j in 0..size {
                    own[i * size + j] += dot(&cross[i * rest..][..rest], &y[j * rest..][..rest]);
                }
            }
            for place in block.rows.clone() {
                let effects = layout.effects(place);
                for (i, effect) in effects.iter().enumerate() {
                    for (j, other) in effects.iter().enumerate().take(i + 1) {
                        let value = match (i < k, j < k) {
                            (true, _) => {
                                let row = *effect as usize - block.first;
                                own[row * size + (*other as usize - block.first)]
                            }
                            (false, true) => {
                                let row = *other as usize - block.first;
                                -cross[row * rest + (*effect as usize - layout.in_blocks)]
                            }
                            (false, false) => {
                                let row = *effect as usize - layout.in_blocks;
                                of_rest[row * rest + (*other as usize - layout.in_blocks)]
                            }
                        };
                        between[i * terms + j] = value;
                        between[j * terms + i] = value;
                    }
                }
                each(place, &between);
            }
        }
    }
}

/// Y = L^-T X = B^-1 A of a block, in place of X.
fn to_inverse(lower: &[f64], size: usize, x: &mut [f64]) {
    let rest = x.len().checked_div(size).unwrap_or(0);
    for i in (0..size).rev() {
        let (here, after) = x.split_at_mut((i + 1) * rest);
        let row = &mut here[i * rest..];
        for j in i + 1..size {
            let by = lower[j * size + i];
            let other = &after[(j - i - 1) * rest..][..rest];
            row.iter_mut().zip(other).for_each(|(a, x)| *a -= by * x);
        }
        let by = 1.0 / lower[i * size + i];
        row.iter_mut().for_each(|a| *a *= by);
    }
}

/// L L' = the matrix, of which the lower half is read and overwritten by L. Returns ln det; none where the matrix is
/// not positive definite.
pub(super) fn cholesky(matrix: &mut [f64], size: usize) -> Option<f64> {
    let mut ln_det = 0.0;
    for i in 0..size {
        let (above, here) = matrix.split_at_mut(i * size);
        let row = &mut here[..size];
        for j in 0..i {
            let other = &above[j * size..][..size];
            row[j] = (row[j] - dot(&row[..j], &other[..j])) / other[j];
        }
        let square = row[i] - dot(&row[..i], &row[..i]);
        if square.is_nan() || square <= 0.0 {
            return None;
        }
        row[i] = square.sqrt();
        ln_det += libm::log(square);
    }
    Some(ln_det)
}

/// L^-1 of values, in place.
fn forward(lower: &[f64], size: usize, values: &mut [f64]) {
    for i in 0..size {
        let row = &lower[i * size..][..size];
        values[i] = (values[i] - dot(&row[..i], &values[..i])) / row[i];
    }
}

/// L'^-1 of values, in place.
fn backward(lower: &[f64], size: usize, values: &mut [f64]) {
    for i in (0..size).rev() {
        let row = &lower[i * size..][..size];
        values[i] /= row[i];
        let by = values[i];
        values[..i].iter_mut().zip(row).for_each(|(v, l)| *v -= by * l);
    }
}

/// The columns of L^-1 as rows, column i from its place i on.
fn inverse_columns(lower: &[f64], size: usize) -> Vec<f64> {
    // Row j of L^-1 is built of those before it.
    let mut columns = vec![0.0; size * size];
    for j in 0..size {
        let row = &lower[j * size..][..size];
        for i in 0..=j {
            let column = &mut columns[i * size..][..size];
            let unit = if i == j { 1.0 } else { 0.0 };
            column[j] = (unit - dot(&row[i..j], &column[i..j])) / row[j];
        }
    }
    columns
}

/// The diagonal of (L L')^-1.
fn inverse_diagonal(lower: &[f64], size: usize) -> Vec<f64> {
    let columns = inverse_columns(lower, size);
    let own = |i: usize| &columns[i * size..][i..size];
    (0..size).map(|i| dot(own(i), own(i))).collect()
}

/// (L L')^-1, whole.
pub(super) fn inverse(lower: &[f64], size: usize) -> Vec<f64> {
    let columns = inverse_columns(lower, size);
    let mut inverse = vec![0.0; size * size];
    for i in 0..size {
        for j in 0..=i {
            let value = dot(&columns[i * size..][i..size], &columns[j * size..][i..size]);
            inverse[i * size + j] = value;
            inverse[j * size + i] = value;
        }
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::factor::Factor;
    use mimique_test_support::Random;
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn elimination_agrees_with_the_dense_system() {
        let mut random = Random::new(5);
        let mut codes = [const { Vec::new() }; 4];
        for (person, segment, method) in
            (0..6).flat_map(|p| (0..4).flat_map(move |s| (0..3).map(move |m| (p, s, m))))
        {
            if random.uniform() < 0.8 {
                let own = [person, person * 3 + method, segment, segment * 3 + method];
                codes.iter_mut().zip(own).for_each(|(codes, own)| codes.push(own));
            }
        }
        let rows = codes[0].len();
        let factors = codes.map(|codes| {
            let levels = (0..18).map(|level: u32| level.to_string()).collect();
            Factor { name: String::new(), levels, codes }.used()
        });
        let layout = Layout::of(&factors.each_ref(), rows);
        assert!(layout.in_blocks > 0 && layout.in_rest > 0);
        let scale = [0.7, 1.3, -0.4, 0.9];
        let weights: Vec<f64> = (0..rows).map(|_| random.uniform()).collect();
        let size = layout.size();
        let mut dense = DMatrix::<f64>::identity(size, size);
        for (place, weight) in weights.iter().enumerate() {
            for (i, one) in layout.effects(place).iter().enumerate() {
                for (j, other) in layout.effects(place).iter().enumerate() {
                    dense[(*one as usize, *other as usize)] += weight * scale[i] * scale[j];
                }
            }
        }
        let mut system = Factored::new(&layout);
        assert!(system.factor(&layout, &scale, Weights::Own(&weights)));
        assert!((system.ln_det - dense.determinant().ln()).abs() < 1e-10);
        let right: Vec<f64> = (0..size).map(|_| random.normal()).collect();
        let mut solved = right.clone();
        system.solve(&layout, &mut solved);
        let back = &dense * DVector::from_vec(solved);
        assert!((back - DVector::from_vec(right)).amax() < 1e-11);
        let whole = dense.try_inverse().unwrap();
        let mut seen = 0;
        system.covariances(&layout, |place, between| {
            seen += 1;
            for (i, one) in layout.effects(place).iter().enumerate() {
                for (j, other) in layout.effects(place).iter().enumerate() {
                    let own = whole[(*one as usize, *other as usize)];
                    assert!((between[i * 4 + j] - own).abs() < 1e-11);
                }
            }
        });
        assert_eq!(seen, rows);
        for (place, own) in system.inverse_diagonal(&layout).into_iter().enumerate() {
            assert!((own - whole[(place, place)]).abs() < 1e-11);
        }
    }

    /// People who answered the same clips are solved as one block of their sums; nothing else changes.
    #[test]
    fn merged_blocks_give_the_same_solutions() {
        let mut codes = [const { Vec::new() }; 4];
        for person in 0..7_u32 {
            // Two orders of the same clips, and two people who miss some.
            for at in 0..12 {
                let clip = if person % 2 == 0 { at } else { 11 - at };
                let (segment, method) = (clip / 3, clip % 3);
                if person < 2 && segment == person {
                    continue;
                }
                let own = [person, person * 3 + method, segment, clip];
                codes.iter_mut().zip(own).for_each(|(codes, own)| codes.push(own));
            }
        }
        let rows = codes[0].len();
        let factors = codes.map(|codes| {
            let levels = (0..21).map(|level: u32| level.to_string()).collect();
            Factor { name: String::new(), levels, codes }.used()
        });
        let each_layout = Layout::of(&factors.each_ref(), rows);
        let (layout, members) = each_layout.merged();
        assert_eq!(members, [vec![0], vec![1], vec![2, 3, 4, 5, 6]]);
        let scale = [0.7, 1.3, -0.4, 0.9];
        let (mut each, mut merged) = (Factored::new(&each_layout), Factored::new(&layout));
        assert!(each.factor(&each_layout, &scale, Weights::Own(&vec![1.0; rows])));
        assert!(merged.factor(&layout, &scale, Weights::One));
        assert!((each.ln_det - merged.ln_det).abs() < 1e-12);
        let mut random = Random::new(5);
        let summed = |values: &[f64]| {
            let mut sums = vec![0.0; layout.size()];
            for (block, same) in layout.blocks.iter().zip(&members) {
                for (number, i) in same.iter().flat_map(|n| (0..block.size).map(move |i| (n, i))) {
                    let own = values[each_layout.blocks[*number].first + i];
                    sums[block.first + i] += own / (same.len() as f64).sqrt();
                }
            }
            sums[layout.in_blocks..].copy_from_slice(&values[each_layout.in_blocks..]);
            sums
        };
        let mut values: Vec<f64> = (0..each_layout.size()).map(|_| random.normal()).collect();
        let mut sums = summed(&values);
        each.solve(&each_layout, &mut values);
        merged.solve(&layout, &mut sums);
        summed(&values).iter().zip(&sums).for_each(|(a, b)| assert!((a - b).abs() < 1e-12));
        let diagonal = each.inverse_diagonal(&each_layout);
        let of_sums = merged.inverse_diagonal(&layout);
        for ((number, block), same) in layout.blocks.iter().enumerate().zip(&members) {
            let alone = merged.block_inverse(&layout, number);
            for (member, i) in same.iter().flat_map(|n| (0..block.size).map(move |i| (n, i))) {
                let share = 1.0 / same.len() as f64;
                let own =
                    share * of_sums[block.first + i] + (1.0 - share) * alone[i * block.size + i];
                let first = each_layout.blocks[*member].first;
                assert!((own - diagonal[first + i]).abs() < 1e-12);
            }
        }
        let of_rest = of_sums[layout.in_blocks..].iter();
        of_rest
            .zip(&diagonal[each_layout.in_blocks..])
            .for_each(|(a, b)| assert!((a - b).abs() < 1e-12));
    }

    #[test]
    fn what_is_not_positive_definite_has_no_factor() {
        assert_eq!(cholesky(&mut [1.0, 0.0, 2.0, 1.0], 2), None);
        assert_eq!(cholesky(&mut [f64::NAN], 1), None);
    }
}
