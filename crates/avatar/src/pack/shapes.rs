//! The displacements of a mesh's shapes in a pack.

use super::entropy::{IntegerReader, IntegerWriter, Integers, Model};
use super::mirror::{Halves, Places};
use super::predict::Prediction;
use super::values::{Residuals, price};

/// Vertices that move, ascending, and by how many units.
pub(super) type Moved = Vec<(u32, [i32; 3])>;

/// Writes or reads the shapes of one mesh, one after the other.
///
/// A shape may be the mirror image of one before it, or of itself: its `twin`. Which vertices move,
/// and how far, is then guessed from the other side.
pub(super) struct Shapes<'p> {
    prediction: &'p Prediction,
    halves: &'p Halves,
    /// The step of each vertex, units.
    pub steps: Vec<i32>,
    /// The shapes so far.
    so_far: Vec<Moved>,
    /// The shape at hand and its twin, all vertices; zeros between shapes.
    own: Vec<[i32; 3]>,
    other: Vec<[i32; 3]>,
    twins: Model,
    runs: Model,
    residuals: Residuals,
}

impl<'p> Shapes<'p> {
    /// For a mesh whose vertices have these steps.
    pub fn new(prediction: &'p Prediction, halves: &'p Halves, steps: Vec<i32>) -> Self {
        let count = steps.len();
        Self {
            prediction,
            halves,
            steps,
            so_far: vec![],
            own: vec![[0; 3]; count],
            other: vec![[0; 3]; count],
            twins: Model::new(1),
            runs: Model::new(4),
            residuals: Residuals::new(),
        }
    }

    /// Writes the next shape.
    pub fn write(&mut self, coder: &mut IntegerWriter, moved: &[(u32, [i32; 3])]) {
        moved.iter().for_each(|&(v, d)| self.own[v as usize] = d);
        let twin = self.best_twin();
        self.through(coder, twin);
    }

    /// Reads the next shape; none if it is damaged.
    pub fn read(&mut self, coder: &mut IntegerReader<'_>) -> Option<&Moved> {
        self.through(coder, None)?;
        self.so_far.last()
    }

    /// Writes or reads: the twin, which vertices move, how far.
    fn through(&mut self, coder: &mut impl Integers, twin: Option<usize>) -> Option<()> {
        let k = self.so_far.len();
        // 0 = none, 1 = itself, 2 = the shape before.
        let back = coder.integer(&mut self.twins, 0, twin.map_or(0, |t| (k - t) as i32 + 1));
        let twin = match usize::try_from(back).ok()? {
            0 => None,
            back => Some((k + 1).checked_sub(back)?),
        };
        self.scatter(twin);
        let visits = self.moving(coder, twin)?;
        let halves = self.halves;
        let other = twin.map(|t| (t < k).then_some(self.other.as_slice()));
        let guess = |v: u32, own: &[[i32; 3]]| guess(halves, other?, v, own);
        self.residuals.vertices(
            coder,
            self.prediction,
            &visits,
            &self.steps,
            &mut self.own,
            &guess,
        );
        self.clear(twin);
        let own = self.own.iter_mut().zip(0u32..).filter(|(d, _)| **d != [0; 3]);
        let moved: Moved = own.map(|(d, v)| (v, std::mem::take(d))).collect();
        self.so_far.push(moved);
        (!coder.spent()).then_some(())
    }

    /// The visits at which a vertex moves: runs of vertices that do what is expected of them, and of
    /// those that do not.
    fn moving(&mut self, coder: &mut impl Integers, twin: Option<usize>) -> Option<Vec<u32>> {
        let count = self.own.len();
        let known = twin.is_some_and(|t| t < self.so_far.len());
        let expected = |i: usize| {
            let other = self.halves.of(self.prediction.order[i]);
            known && other.is_some_and(|w| self.other[w as usize] != [0; 3])
        };
        let moves = |i: usize| self.own[self.prediction.order[i] as usize] != [0; 3];
        let mut visits = Vec::new();
        let (mut at, mut odd) = (0usize, false);
        while at < count {
            let mut end = at;
            if coder.writes() {
                while end < count && (expected(end) != moves(end)) == odd {
                    end += 1;
                }
            }
            let context = 2 * usize::from(known) + usize::from(odd);
            let run = coder.integer(&mut self.runs, context, (end - at) as i32);
            let end = at.checked_add(usize::try_from(run).ok()?).filter(|end| *end <= count)?;
            if coder.spent() || (run == 0 && at > 0) {
                return None;
            }
            visits.extend((at..end).filter(|&i| expected(i) != odd).map(|i| i as u32));
            (at, odd) = (end, !odd);
        }
        Some(visits)
    }

    fn scatter(&mut self, twin: Option<usize>) {
        for &(v, d) in twin.and_then(|t| self.so_far.get(t)).into_iter().flatten() {
            self.other[v as usize] = d;
        }
    }

    fn clear(&mut self, twin: Option<usize>) {
        for &(v, _) in twin.and_then(|t| self.so_far.get(t)).into_iter().flatten() {
            self.other[v as usize] = [0; 3];
        }
    }

    /// The twin from which the shape at hand is best guessed, if that is better than its neighbours.
    fn best_twin(&mut self) -> Option<usize> {
        let k = self.so_far.len();
        let visits: Vec<u32> = (0..self.own.len() as u32)
            .filter(|&i| self.own[self.prediction.order[i as usize] as usize] != [0; 3])
            .collect();
        let mut best: Option<(u64, usize)> = None;
        for t in 0..=k {
            let there = self.so_far.get(t).map_or(visits.len(), Vec::len);
            if 4 * there > 5 * visits.len() || 4 * visits.len() > 5 * there {
                continue;
            }
            self.scatter(Some(t));
            let off = |&i: &u32| {
                let v = self.prediction.order[i as usize];
                let here = self.own[v as usize];
                let there = if t < k { &self.other } else { &self.own };
                let there =
                    self.halves.of(v).map_or([0; 3], |w| Places::image(there[w as usize], 0));
                here.iter().zip(there).map(|(a, b)| u64::from(a.abs_diff(b))).sum::<u64>()
            };
            let off = visits.iter().map(off).sum();
            self.clear(Some(t));
            if best.is_none_or(|b| (off, t) < b) {
                best = Some((off, t));
            }
        }
        let twin = best?.1;
        self.scatter(Some(twin));
        let other = (twin < k).then_some(self.other.as_slice());
        let mirrored = |v: u32, own: &[[i32; 3]]| guess(self.halves, other, v, own);
        let price_of = |mirrored| price(self.prediction, &visits, &self.steps, &self.own, mirrored);
        let better = price_of(&mirrored) < price_of(&|_, _| None);
        self.clear(Some(twin));
        better.then_some(twin)
    }
}

/// What the other side says of a vertex, where it is known already: the `twin`'s vertices, or this
/// shape's own, if it has none.
fn guess(halves: &Halves, twin: Option<&[[i32; 3]]>, v: u32, own: &[[i32; 3]]) -> Option<[i32; 3]> {
    let there = match twin {
        Some(twin) => twin[halves.of(v)? as usize],
        None => own[halves.known(v)? as usize],
    };
    Some(Places::image(there, 0))
}
