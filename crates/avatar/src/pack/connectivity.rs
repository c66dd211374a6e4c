//! The triangles of a mesh in a pack.

use super::entropy::{Integers, Model};

/// Vertices of late that a corner is looked for among.
const LATE: usize = 24;
/// What a corner may be: new, one of late, or far from both.
const KINDS: usize = LATE + 2;

/// Corners of triangles, written or read: most are a vertex of late, or the first that is new. What to
/// expect follows from the corner before and from the same corner two triangles ago: most meshes are
/// quads, two triangles each.
pub(super) fn connect(coder: &mut impl Integers, triangles: &mut [[u32; 3]]) {
    // What a corner is: 0 new, n > 0 the n-th latest, or else one past them and a step from the first.
    let mut kinds: [Model; 3] = std::array::from_fn(|_| Model::new(KINDS * KINDS));
    let mut steps = Model::new(1);
    let mut late = [0u32; LATE];
    let mut kinds_before = [0usize; 6];
    let mut new = 0u32;
    for triangle in triangles {
        for corner in 0..3 {
            let v = triangle[corner];
            let kind = match late.iter().position(|l| *l == v) {
                _ if v == new => 0,
                Some(place) => place + 1,
                None => LATE + 1,
            };
            let context = kinds_before[0] * KINDS + kinds_before[5];
            let kind = coder.integer(&mut kinds[corner], context, kind as i32);
            let kind = (kind.max(0) as usize).min(LATE + 1);
            kinds_before.copy_within(0..5, 1);
            kinds_before[0] = kind;
            let v = match kind {
                0 => new,
                k if k <= LATE => late[k - 1],
                _ => {
                    let step = v.wrapping_sub(late[0]) as i32;
                    late[0].wrapping_add(coder.integer(&mut steps, 0, step) as u32)
                }
            };
            if kind == 0 {
                new = new.wrapping_add(1);
            } else {
                new = new.max(v.wrapping_add(1));
            }
            let place = late.iter().position(|l| *l == v).unwrap_or(LATE - 1);
            late.copy_within(0..place, 1);
            late[0] = v;
            triangle[corner] = v;
        }
    }
}
