//! The built-in head's lashes, brows, lids, lips and teeth: they go where the skin goes, and stay on
//! their own side of it. Lengths are in millimetres.

use std::collections::BTreeSet;

use mimique_actor::{
    Clip, Emotion, HeadSpec, Identity, build_head, marker_sites, performance_weights,
};
use mimique_avatar::{Avatar, Mesh, Part};

type Pose<'a> = &'a [(&'a str, f64)];

const SMILE: [(&str, f64); 2] = [("mouthSmileLeft", 1.0), ("mouthSmileRight", 1.0)];

/// The house face and two other people.
fn people() -> impl Iterator<Item = Avatar> {
    let identity = |seed| if seed == 0 { Identity::default() } else { Identity::from_seed(seed) };
    [0, 3, 5]
        .into_iter()
        .map(move |seed| build_head(&HeadSpec { identity: identity(seed), ..HeadSpec::default() }))
}

fn pose(avatar: &Avatar, weights: Pose) -> Vec<f64> {
    let mut out = vec![0.0; avatar.shape_names.len()];
    for (name, w) in weights {
        out[avatar.shape_index(name).expect("shape exists")] = *w;
    }
    out
}

fn part<'a>(avatar: &'a Avatar, name: &str) -> &'a Mesh {
    avatar.meshes.iter().find(|m| m.name == name).expect("the part exists")
}

fn mm(p: [f32; 3]) -> [f64; 3] {
    p.map(|c| f64::from(c) * 1e3)
}

fn less(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn away(a: [f64; 3], b: [f64; 3]) -> f64 {
    dot(less(a, b), less(a, b)).sqrt()
}

/// The nearest point of a triangle, as a distance (the best of its inside and its three edges).
fn to_triangle(p: [f64; 3], t: [[f64; 3]; 3]) -> f64 {
    let edge = |a: [f64; 3], b: [f64; 3]| {
        let along = less(b, a);
        let f = (dot(less(p, a), along) / dot(along, along).max(1e-12)).clamp(0.0, 1.0);
        away(p, [0, 1, 2].map(|k| a[k] + f * along[k]))
    };
    let rim = edge(t[0], t[1]).min(edge(t[1], t[2])).min(edge(t[2], t[0]));
    let (u, v, w) = (less(t[1], t[0]), less(t[2], t[0]), less(p, t[0]));
    let (uu, uv, vv, wu, wv) = (dot(u, u), dot(u, v), dot(v, v), dot(w, u), dot(w, v));
    let det = uu * vv - uv * uv;
    let (a, b) = ((vv * wu - uv * wv) / det, (uu * wv - uv * wu) / det);
    let inside = a >= 0.0 && b >= 0.0 && a + b <= 1.0;
    if !inside {
        return rim;
    }
    away(w, [0, 1, 2].map(|k| a * u[k] + b * v[k]))
}

/// How far the farthest of `points` lies from the surface.
fn farthest(points: &[[f64; 3]], triangles: &[[u32; 3]], surface: &[[f32; 3]]) -> f64 {
    let triangles: Vec<[[f64; 3]; 3]> =
        triangles.iter().map(|t| t.map(|v| mm(surface[v as usize]))).collect();
    let nearest = |p: &[f64; 3]| {
        let near = triangles.iter().filter(|t| away(*p, t[0]) < 15.0);
        near.map(|t| to_triangle(*p, *t)).fold(f64::INFINITY, f64::min)
    };
    points.iter().map(nearest).fold(0.0, f64::max)
}

#[test]
fn lashes_stay_on_the_lid_that_closes() {
    for avatar in people() {
        let (skin, lashes) = (avatar.skin().expect("a skin"), part(&avatar, "lashes"));
        let roots = |posed: &[[f32; 3]]| -> Vec<[f64; 3]> {
            posed.chunks_exact(5).flat_map(|blade| [mm(blade[0]), mm(blade[1])]).collect()
        };
        let tips = |posed: &[[f32; 3]]| -> Vec<f64> {
            posed.chunks_exact(5).map(|blade| away(mm(blade[0]), mm(blade[4]))).collect()
        };
        let lengths = tips(&lashes.positions);
        for blink in [0.0, 0.25, 0.5, 0.75, 1.0] {
            for squint in [0.0, 1.0] {
                let weights = pose(
                    &avatar,
                    &[
                        ("eyeBlinkLeft", blink),
                        ("eyeBlinkRight", blink),
                        ("eyeSquintLeft", squint),
                        ("eyeSquintRight", squint),
                    ],
                );
                let posed = lashes.posed(&weights);
                let off = farthest(&roots(&posed), &skin.triangles, &skin.posed(&weights));
                assert!(off < MOST_ROOT, "blink {blink}, squint {squint}: roots {off} mm off");
                for (now, rest) in tips(&posed).into_iter().zip(&lengths) {
                    assert!((now / rest - 1.0).abs() < 0.25, "blink {blink}: {rest} to {now} mm");
                }
            }
        }
        // The measure tells: lashes that stay behind are millimetres off the lid.
        let shut = pose(&avatar, &[("eyeBlinkLeft", 1.0), ("eyeBlinkRight", 1.0)]);
        let off = farthest(&roots(&lashes.positions), &skin.triangles, &skin.posed(&shut));
        assert!(off > 2.0 * MOST_ROOT, "lashes left behind are {off} mm off");
    }
}

/// Lashes are rooted on the smooth surface, on which the mesh has its vertices and is flat between them.
const MOST_ROOT: f64 = 0.35;

#[test]
fn brows_go_with_the_skin_under_them() {
    for avatar in people() {
        let (skin, brows) = (avatar.skin().expect("a skin"), part(&avatar, "brows"));
        let under: Vec<usize> = brows
            .positions
            .iter()
            .map(|p| {
                let apart = |v: &usize| away(mm(skin.positions[*v]), mm(*p));
                let all = 0..skin.positions.len();
                all.min_by(|a, b| apart(a).total_cmp(&apart(b))).expect("a vertex")
            })
            .collect();
        for shapes in [
            &[("browInnerUp", 1.0)][..],
            &[("browOuterUpLeft", 1.0), ("browOuterUpRight", 1.0)],
            &[("browDownLeft", 1.0), ("browDownRight", 1.0)],
            &[("browInnerUp", 1.0), ("browDownLeft", 0.7)],
        ] {
            let weights = pose(&avatar, shapes);
            let (hair, face) = (brows.posed(&weights), skin.posed(&weights));
            let (mut way, mut slip) = (0.0f64, 0.0f64);
            for (k, &v) in under.iter().enumerate() {
                let own = less(mm(hair[k]), mm(brows.positions[k]));
                let below = less(mm(face[v]), mm(skin.positions[v]));
                way = way.max(away(own, [0.0; 3]));
                slip = slip.max(away(own, below));
            }
            assert!(way > 5.0, "{shapes:?}: brows go {way} mm");
            // The brows' outer ends reach half a way between two vertices from the one that is nearest.
            assert!(slip < 1.25, "{shapes:?}: brows slip {slip} mm on the skin");
        }
    }
}

/// The nearest surface seen from the front, a depth for each square of a fifth of a millimetre round
/// the mouth.
fn front(mesh: &Mesh, positions: &[[f32; 3]]) -> Vec<f64> {
    const SIDE: usize = 500;
    const STEP: f64 = 0.2;
    let mut depth = vec![f64::NEG_INFINITY; SIDE * SIDE];
    let cell = |v: f64, o: f64| (((v - o) / STEP).max(0.0) as usize).min(SIDE);
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|v| mm(positions[v as usize]));
        let det = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if det.abs() < 1e-10 {
            continue;
        }
        let low = |k: usize| a[k].min(b[k]).min(c[k]);
        let high = |k: usize| a[k].max(b[k]).max(c[k]) + STEP;
        for j in cell(low(1), -125.0)..cell(high(1), -125.0) {
            for i in cell(low(0), -50.0)..cell(high(0), -50.0) {
                let (x, y) = (-50.0 + (i as f64 + 0.5) * STEP, -125.0 + (j as f64 + 0.5) * STEP);
                let u = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / det;
                let v = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / det;
                if u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
                    let z = a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2]);
                    depth[j * SIDE + i] = depth[j * SIDE + i].max(z);
                }
            }
        }
    }
    depth
}

/// Square millimetres in which the inside of the mouth shows, and in which teeth or tongue stand out
/// of lips or cheeks: there the skin lies less than a lip's thickness behind them. The inside is
/// moved forwards by `forward`.
fn mouth(avatar: &Avatar, weights: &[f64], forward: f32) -> (f64, f64) {
    let skin = avatar.skin().expect("a skin");
    let lips = front(skin, &skin.posed(weights));
    let (mut open, mut pierced) = (vec![false; lips.len()], vec![false; lips.len()]);
    for mesh in &avatar.meshes {
        if !matches!(mesh.part, Part::Teeth | Part::Socket | Part::Tongue) {
            continue;
        }
        let mut posed = mesh.posed(weights);
        posed.iter_mut().for_each(|p| p[2] += forward * 1e-3);
        for (k, z) in front(mesh, &posed).into_iter().enumerate() {
            open[k] |= z > lips[k];
            pierced[k] |= mesh.part != Part::Socket && z > lips[k] && z - lips[k] < 8.0;
        }
    }
    let area = |cells: Vec<bool>| cells.into_iter().filter(|c| *c).count() as f64 * 0.04;
    (area(open), area(pierced))
}

#[test]
fn teeth_and_tongue_stay_behind_lips_and_cheeks() {
    for avatar in people() {
        let mut poses: Vec<(String, Vec<f64>)> = Vec::new();
        for emotion in Emotion::ALL {
            let clip = Clip { emotion, intensity: 3, seed: 2 };
            let played = performance_weights(&avatar.shape_names, &clip, 2.0, 4.0);
            for f in 0..played.frames() {
                poses.push((format!("{emotion:?}, frame {f}"), played.frame(f).to_vec()));
            }
        }
        for (jaw, smile) in [(0.0, 1.0), (0.3, 1.0), (1.0, 0.0), (1.0, 1.0)] {
            let shapes = [("jawOpen", jaw), ("mouthSmileLeft", smile), ("mouthSmileRight", smile)];
            poses.push((format!("{shapes:?}"), pose(&avatar, &shapes)));
        }
        poses.push(("half a smile".to_owned(), pose(&avatar, &SMILE[..1])));
        for (name, weights) in &poses {
            let (_, pierced) = mouth(&avatar, weights, 0.0);
            assert!(pierced < 0.5, "{name}: {pierced} mm^2 stand out");
        }
        // The measure tells: six millimetres farther forwards they come through the lips.
        let (_, pierced) = mouth(&avatar, &pose(&avatar, &SMILE), 6.0);
        assert!(pierced > 5.0, "teeth before the lips: {pierced} mm^2");
    }
}

#[test]
fn an_open_jaw_and_a_smile_go_together() {
    let sites = marker_sites(&HeadSpec::default());
    for avatar in people() {
        let skin = avatar.skin().expect("a skin");
        let jaw = [("jawOpen", 1.0)];
        let both = [jaw[0], SMILE[0], SMILE[1]];
        let at = |label: &str, shapes: Pose| {
            let k = sites.labels.iter().position(|l| l == label).expect("a label");
            mm(skin.posed(&pose(&avatar, shapes))[sites.vertices[k] as usize])
        };
        let width = |s: Pose| at("mouth_corner_left", s)[0] - at("mouth_corner_right", s)[0];
        let wider = width(&both) - width(&jaw);
        assert!(wider > 8.0, "a smile widens the open mouth by {wider} mm");
        assert!(width(&both) > width(&[]) + 4.0, "corners are drawn in: {}", width(&both));
        for (upper, lower) in [
            ("lip_upper", "lip_lower"),
            ("lip_upper_left", "lip_lower_left"),
            ("lip_upper_right", "lip_lower_right"),
        ] {
            for half in [0.25, 0.5, 1.0] {
                let some = both.map(|(name, w)| (name, w * half));
                let gap = |s: Pose| at(upper, s)[1] - at(lower, s)[1];
                let opened = gap(&some) - gap(&[]);
                assert!(opened > 10.0 * half, "{upper} at {half}: opened by {opened} mm");
            }
        }
        let area = |s: Pose| mouth(&avatar, &pose(&avatar, s), 0.0).0;
        assert!(area(&both) > 1.1 * area(&jaw), "{} and {} mm^2", area(&jaw), area(&both));
    }
}

/// The edges along the rims of the left eye's lids, in the direction of their triangles.
fn rims(avatar: &Avatar) -> Vec<(u32, u32)> {
    let skin = avatar.skin().expect("a skin");
    let centre = left_eye(avatar);
    let edges: BTreeSet<(u32, u32)> =
        skin.triangles.iter().flat_map(|t| [0, 1, 2].map(|k| (t[k], t[(k + 1) % 3]))).collect();
    let near = |v: u32| away(mm(skin.positions[v as usize]), centre) < 22.0;
    edges.iter().copied().filter(|&(a, b)| !edges.contains(&(b, a)) && near(a)).collect()
}

fn left_eye(avatar: &Avatar) -> [f64; 3] {
    mm(avatar.eyeballs.iter().find(|e| e.centre[0] > 0.0).expect("a left eye").centre)
}

/// Heights of the left eye's upper rim over the lower one at places across it, least and most. The
/// rims are tucked some 6 degrees (1.7 mm) behind the margins that are seen.
fn rims_apart(avatar: &Avatar, edges: &[(u32, u32)], weights: &[f64]) -> (f64, f64) {
    let (skin, centre) = (avatar.skin().expect("a skin"), left_eye(avatar));
    let posed = skin.posed(weights);
    let at = |v: u32| mm(posed[v as usize]);
    let mut all = (f64::INFINITY, f64::NEG_INFINITY);
    for step in -4..=4 {
        let x = centre[0] + 2.0 * f64::from(step);
        let mut heights: Vec<f64> = Vec::new();
        // The loop runs one way along the upper rim and back along the lower one.
        for &(a, b) in edges {
            let (p, q) = (at(a), at(b));
            if (p[0] <= x) != (q[0] <= x) {
                let y = p[1] + (x - p[0]) / (q[0] - p[0]) * (q[1] - p[1]);
                heights.push(if p[0] <= x { y } else { -y });
            }
        }
        assert_eq!(heights.len(), 2, "the rims fold at {x} mm");
        // One is a height there, the other a negated height back.
        let apart = heights[0] + heights[1];
        all = (all.0.min(apart), all.1.max(apart));
    }
    all
}

#[test]
fn lids_meet_without_passing_through_each_other() {
    for avatar in people() {
        let edges = rims(&avatar);
        let apart = |blink: f64, squint: f64| {
            let shapes = [("eyeBlinkLeft", blink), ("eyeSquintLeft", squint)];
            rims_apart(&avatar, &edges, &pose(&avatar, &shapes))
        };
        // Rims are twice 6 degrees of the ball, about 3.3 mm, farther apart than margins: a shut
        // eye's lids cover each other by 1.5 mm at most, and leave no slit.
        let shut = apart(1.0, 0.0);
        assert!(shut.0 > 1.8 && shut.1 < 3.3, "a shut eye's rims are {shut:?} mm apart");
        // Half a blink over a full squint is nearly shut, not more.
        let narrow = apart(0.5, 1.0);
        assert!(narrow.0 > 1.8, "rims of half a blink with squint are {narrow:?} mm apart");
        // Each step closes the eye further, everywhere across it.
        for [wide, close] in
            [[[0.0, 0.0], [0.5, 0.0]], [[0.5, 0.0], [1.0, 0.0]], [[0.0, 0.0], [0.0, 1.0]]]
        {
            let (before, after) = (apart(wide[0], wide[1]), apart(close[0], close[1]));
            assert!(after.0 < before.0 - 0.5, "{wide:?} to {close:?}: {before:?} to {after:?} mm");
        }
    }
}

#[test]
fn lids_of_a_performance_never_pass_each_other() {
    // A blink and a squint together would drive the lids past each other: a performance lets go of
    // the squint for its blinks.
    for avatar in people() {
        let both = pose(&avatar, &[("eyeBlinkLeft", 1.0), ("eyeSquintLeft", 1.0)]);
        let edges = rims(&avatar);
        assert!(rims_apart(&avatar, &edges, &both).0 < 0.0, "the measure tells");
        for emotion in Emotion::ALL {
            for seed in 0..2 {
                let clip = Clip { emotion, intensity: 3, seed };
                let played = performance_weights(&avatar.shape_names, &clip, 25.0, 4.0);
                for f in 0..played.frames() {
                    let apart = rims_apart(&avatar, &edges, played.frame(f));
                    assert!(apart.0 > 1.5, "{emotion:?}, seed {seed}, frame {f}: {apart:?} mm");
                }
            }
        }
    }
}
