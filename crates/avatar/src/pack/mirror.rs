//! The other side of a face. Most heads are made as one half and its mirror image: positions and
//! shapes of the second half are guessed from the first, and mostly rightly.
//!
//! The mirror is the plane x = `plane` / 2, in the pack's own integers. Nothing is assumed of who is
//! whose image: both sides look for the vertex that lies nearest.

use super::predict::Prediction;

/// Edge of a cell in which places are looked up, steps of positions: 3 mm.
const CELL: i32 = 1500;
/// Most places of a bucket that are looked at: a damaged pack may have all vertices in one.
const MOST_IN_A_BUCKET: usize = 512;

/// Where vertices lie, to be found by place.
pub(super) struct Places {
    /// Twice the x at which the mirror stands; none = no mirror.
    pub plane: Option<i32>,
    /// The latest vertex of each bucket of cells, and the one before each; both plus one, 0 = none.
    buckets: Vec<u32>,
    before: Vec<u32>,
    positions: Vec<[i32; 3]>,
}

impl Places {
    pub fn new(plane: Option<i32>) -> Self {
        Self { plane, buckets: vec![0; 1 << 14], before: vec![], positions: vec![] }
    }

    /// How many places there are: the number of the next.
    pub fn count(&self) -> usize {
        self.positions.len()
    }

    pub fn add(&mut self, position: [i32; 3]) {
        let bucket = self.bucket(position.map(|x| x.div_euclid(CELL)));
        self.before.push(self.buckets[bucket]);
        self.positions.push(position);
        self.buckets[bucket] = self.positions.len() as u32;
    }

    /// The mirror image of a place or, with `plane` 0, of a displacement.
    pub fn image([x, y, z]: [i32; 3], plane: i32) -> [i32; 3] {
        [plane.wrapping_sub(x), y, z]
    }

    /// The mirror image of the place nearest to where `guess` has its own image, and its number; none
    /// where no place from number `first` on is within `reach` (at most a cell) of it, the distances on
    /// the three axes added up.
    pub fn across(&self, guess: [i32; 3], first: usize, reach: i32) -> Option<([i32; 3], usize)> {
        let plane = self.plane?;
        let sought = Self::image(guess, plane);
        let [low, high] =
            [-reach, reach].map(|r| sought.map(|x| x.wrapping_add(r).div_euclid(CELL)));
        let mut best = (reach as u32 + 1, 0);
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    let mut at = self.buckets[self.bucket([x, y, z])] as usize;
                    // Latest first: those before `first` end the chain.
                    for _ in 0..MOST_IN_A_BUCKET {
                        if at <= first {
                            break;
                        }
                        let place = self.positions[at - 1].iter().zip(&sought);
                        let off =
                            place.fold(0u32, |sum, (a, b)| sum.saturating_add(a.abs_diff(*b)));
                        best = best.min((off, at));
                        at = self.before[at - 1] as usize;
                    }
                }
            }
        }
        let at = best.1.checked_sub(1)?;
        Some((Self::image(self.positions[at], plane), at))
    }

    fn bucket(&self, cell: [i32; 3]) -> usize {
        let mixed = (cell.iter()).fold(0u32, |h, x| (h ^ *x as u32).wrapping_mul(0x9e37_79b1));
        (mixed >> 18) as usize
    }
}

/// No vertex on the other side.
const ALONE: u32 = u32::MAX;
/// How far from a vertex's image its other half may lie, steps of positions: a twentieth of a millimetre.
const NEAR: i32 = 25;

/// Which vertices of a mesh are each other's mirror images.
pub(super) struct Halves {
    across: Vec<u32>,
    /// At which visit each vertex is reached.
    visit: Vec<u32>,
}

impl Halves {
    /// Of a mesh whose vertices are the places from number `first` on, in visiting order.
    pub fn new(prediction: &Prediction, places: &Places, first: usize) -> Self {
        let count = prediction.order.len();
        let (mut visit, mut across) = (vec![0; count], vec![ALONE; count]);
        for (i, &v) in prediction.order.iter().enumerate() {
            visit[v as usize] = i as u32;
            let other =
                places.positions.get(first + i).and_then(|p| places.across(*p, first, NEAR));
            if let Some(&w) = other.and_then(|(_, number)| prediction.order.get(number - first)) {
                across[v as usize] = w;
            }
        }
        Self { across, visit }
    }

    /// The vertex on the other side.
    pub fn of(&self, v: u32) -> Option<u32> {
        Some(self.across[v as usize]).filter(|w| *w != ALONE)
    }

    /// The same, where it is visited before this one.
    pub fn known(&self, v: u32) -> Option<u32> {
        self.of(v).filter(|w| self.visit[*w as usize] < self.visit[v as usize])
    }
}

/// Twice the x of the plane of which most vertices have an image among the others, if a third have:
/// that through the origin, or that in the middle of the first mesh.
pub(super) fn plane(meshes: impl Iterator<Item = Vec<[i32; 3]>>) -> Option<i32> {
    let meshes: Vec<_> = meshes.collect();
    let first = meshes.first()?.iter().map(|p| p[0]);
    let middle = first.clone().min()?.wrapping_add(first.max()?);
    let mut places = Places::new(Some(0));
    meshes.iter().flatten().for_each(|p| places.add(*p));
    let count = places.count();
    let mut images = |plane: i32| {
        places.plane = Some(plane);
        let of = |p: &&[i32; 3]| places.across(**p, 0, 2).is_some();
        (meshes.iter().flatten().filter(of).count(), plane)
    };
    let (most, plane) = images(0).max(images(middle));
    (3 * most > count).then_some(plane)
}
