//! Where every cage vertex stands: a first guess of the quilt, features pinned, the rest relaxed on
//! the sculpt, loops laid into the holes, and the control points fitted so that the subdivision
//! surface passes through the wanted places.

use super::ear::place_ear;
use super::eyelids::{Eye, place_eyelids};
use super::lips::place_lips;
use super::nose::{pin_nose, place_nostril};
use super::sculpt::{Landmarks, Sculpt};
use super::subdivide::Step;
use super::topology::{CAP, COLUMNS, Feature, ROWS, Site, Topology};
use super::vec3::{Vec3, mix, smoothstep, v3};

/// Heights of a row at the front, side and back, and its depth and breadth there (guesses).
struct Row {
    front_y: f64,
    side_y: f64,
    back_y: f64,
    front_z: f64,
    side_x: f64,
    back_z: f64,
}

#[rustfmt::skip]
const ROW_GUESS: [[f64; 6]; ROWS as usize] = [
    [ 78.0,  80.0,   72.0,  68.0, 58.0,  -80.0],
    [ 62.0,  68.0,   62.0,  82.0, 66.0,  -90.0],
    [ 47.0,  55.0,   51.0,  90.0, 72.0,  -95.0],
    [ 34.0,  43.0,   40.0,  94.0, 75.0,  -98.0],
    [ 22.0,  32.0,   29.0,  94.0, 76.0,  -98.0],
    [ 11.0,  22.0,   19.0,  92.0, 76.0,  -97.0],
    [  1.0,  11.0,    9.0,  91.0, 75.0,  -96.0],
    [ -9.0,   1.0,   -1.0,  95.0, 74.0,  -94.0],
    [-18.0,  -8.0,  -11.0,  98.0, 73.0,  -91.0],
    [-25.0, -17.0,  -20.0, 103.0, 72.0,  -88.0],
    [-31.0, -25.0,  -29.0, 110.0, 71.0,  -85.0],
    [-38.0, -34.0,  -37.0, 112.0, 70.0,  -82.0],
    [-43.0, -42.0,  -45.0, 110.0, 69.0,  -80.0],
    [-45.0, -49.0,  -52.0, 104.0, 68.0,  -78.0],
    [-48.0, -55.0,  -59.0,  99.0, 67.0,  -76.0],
    [-53.0, -61.0,  -66.0, 100.0, 66.0,  -75.0],
    [-60.0, -66.0,  -73.0, 100.0, 64.0,  -74.0],
    [-68.0, -71.0,  -80.0, 100.0, 62.0,  -73.0],
    [-77.0, -76.0,  -87.0,  99.0, 60.0,  -72.0],
    [-87.0, -81.0,  -94.0,  98.0, 58.0,  -72.0],
    [-94.0, -87.0, -101.0,  98.0, 56.0,  -72.0],
    [-102.0,-93.0, -108.0,  98.0, 54.0,  -72.0],
    [-109.0,-99.0, -115.0,  90.0, 52.0,  -72.0],
    [-111.0,-105.0,-122.0,  76.0, 51.0,  -72.0],
    [-114.0,-112.0,-130.0,  60.0, 51.0,  -73.0],
    [-122.0,-121.0,-139.0,  46.0, 52.0,  -74.0],
    [-135.0,-135.0,-150.0,  38.0, 53.0,  -76.0],
    [-152.0,-152.0,-162.0,  34.0, 54.0,  -78.0],
    [-170.0,-170.0,-174.0,  33.0, 56.0,  -80.0],
];

/// Distance from the midline of the front columns, at the height of the eyes.
const FRONT_X: [f64; 10] = [0.0, 5.0, 9.5, 14.0, 20.0, 27.0, 34.0, 42.0, 50.0, 57.0];

/// The placed cage.
pub(crate) struct Layout {
    /// Where the surface should pass.
    pub surface: Vec<Vec3>,
    /// Control points that make it pass there.
    pub control: Vec<Vec3>,
    pub eye: Eye,
}

pub(crate) fn place(t: &Topology, sculpt: &Sculpt, at: &Landmarks, eye: Eye) -> Layout {
    let mut p = vec![Vec3::default(); t.sites.len()];
    for (v, &site) in t.sites.iter().enumerate() {
        if let Some(guess) = first_guess(site, at) {
            p[v] = sculpt.project(guess);
        }
    }
    let mut pinned: Vec<bool> =
        t.sites.iter().map(|s| !matches!(s, Site::Grid(..) | Site::Cap(..))).collect();
    let mut pin = |site: Site, to: Vec3, p: &mut Vec<Vec3>| {
        let v = t.at(site);
        p[v] = to;
        pinned[v] = true;
        let m = t.mirror[v] as usize;
        p[m] = to.mirrored();
        pinned[m] = true;
    };
    pin_nose(sculpt, at, &mut |r, c, to| pin(Site::Grid(r, c), to, &mut p));
    pin_chin(sculpt, at, &mut |r, c, to| pin(Site::Grid(r, c), to, &mut p));
    pin_boundaries(sculpt, at, &eye, &mut |f, k, to| {
        let (r, c) = f.boundary(k);
        pin(Site::Grid(r, c), to, &mut p);
    });
    for c in 0..=COLUMNS / 2 {
        let site = Site::Grid(ROWS - 1, c);
        let mut to = p[t.at(site)];
        let y = mix(-172.0, -168.0, f64::from(c) / 24.0) + (at.chin_y + 109.0);
        for _ in 0..4 {
            to.y = y;
            to = sculpt.project(to);
        }
        to.y = y;
        pin(site, to, &mut p);
    }
    relax(t, sculpt, &pinned, &mut p);
    place_eyelids(t, sculpt, &eye, &mut p);
    place_lips(t, sculpt, at, &mut p);
    place_nostril(t, sculpt, &mut p);
    place_ear(t, sculpt, at, &mut p);
    mirror_left_to_right(t, &mut p);
    let control = fit_control(t, &p);
    Layout { surface: p, control, eye }
}

fn row(r: i32, at: &Landmarks) -> Row {
    let [front_y, side_y, back_y, front_z, side_x, back_z] = ROW_GUESS[r as usize];
    // Rows of the lower face follow this person's proportions (guesses are for an average chin).
    let lower = smoothstep(-46.0, -109.0, front_y);
    let shift = (at.chin_y + 109.0) * lower;
    Row { front_y: front_y + shift, side_y: side_y + 0.5 * shift, back_y, front_z, side_x, back_z }
}

fn first_guess(site: Site, at: &Landmarks) -> Option<Vec3> {
    match site {
        Site::Grid(r, c) => {
            let row = row(r, at);
            let side = f64::from(c.signum());
            let c = c.unsigned_abs() as usize;
            let breadth = row.side_x / 75.0;
            if c < FRONT_X.len() {
                let x = FRONT_X[c] * breadth;
                let z = row.front_z * (1.0 - (x / row.side_x).powi(2)).max(0.0).sqrt();
                let y = mix(row.front_y, row.side_y, smoothstep(0.5, 1.2, x / row.side_x));
                return Some(v3(side * x, y, z));
            }
            let turn = 48.0 + (c as f64 - 9.0) / 15.0 * 132.0;
            let (s, k) = (libm::sin(turn.to_radians()), libm::cos(turn.to_radians()));
            let x = row.side_x * s;
            if k >= 0.0 {
                let y = mix(row.front_y, row.side_y, smoothstep(0.5, 1.2, s));
                Some(v3(side * x, y, row.front_z * k))
            } else {
                Some(v3(side * x, mix(row.side_y, row.back_y, k * k), -row.back_z * k))
            }
        }
        Site::Cap(i, j) => {
            let half = f64::from(CAP) * 0.5;
            let (a, b) = (f64::from(i) / half - 1.0, f64::from(j) / half - 1.0);
            let x = a * (1.0 - 0.5 * b * b).sqrt();
            let z = -b * (1.0 - 0.5 * a * a).sqrt();
            Some(v3(58.0 * x, 112.0 - 34.0 * (x * x + z * z), 76.0 * z - 4.0))
        }
        Site::Ring(..) | Site::Fill(..) => None,
    }
}

fn pin_boundaries(
    sculpt: &Sculpt,
    at: &Landmarks,
    eye: &Eye,
    pin: &mut dyn FnMut(Feature, i32, Vec3),
) {
    for k in 0..Feature::EyeLeft.ring_length() {
        pin(Feature::EyeLeft, k, eye.orbit(sculpt, k));
    }
    for k in 0..Feature::Mouth.ring_length() {
        let to = super::lips::boundary(sculpt, at, k);
        if to.x >= -1e-9 {
            pin(Feature::Mouth, k, v3(if to.x < 1e-9 { 0.0 } else { to.x }, to.y, to.z));
        }
    }
    for k in 0..Feature::EarLeft.ring_length() {
        pin(Feature::EarLeft, k, super::ear::root(sculpt, at, k));
    }
}

/// Hold chin and throat: left to themselves, rows would slide off the chin into the throat's angle.
fn pin_chin(sculpt: &Sculpt, at: &Landmarks, pin: &mut dyn FnMut(i32, i32, Vec3)) {
    for c in 0..=3 {
        let aside = f64::from(c);
        pin(20, c, sculpt.front(6.4 * aside, at.chin_y + 15.0 + 0.35 * aside * aside));
        pin(21, c, sculpt.front(5.8 * aside, at.chin_y + 7.0 + 0.35 * aside * aside));
    }
    for c in 0..=3 {
        let aside = f64::from(c);
        for (r, x, z) in [(22, 5.3, 87.0), (23, 4.9, 72.0), (24, 4.6, 57.0), (25, 4.3, 42.0)] {
            // The rows bend back beside the midline, as the jaw does.
            pin(r, c, sculpt.below(x * aside, z - 0.75 * aside * aside));
        }
    }
    for c in 0..=COLUMNS / 2 {
        for r in [26, 27] {
            if let Some(guess) = first_guess(Site::Grid(r, c), at) {
                let mut to = sculpt.project(guess);
                // Rows lie level on the neck; a second step undoes what the first moved them.
                to.y = guess.y + if r == 26 { 21.0 } else { 11.0 };
                pin(r, c, sculpt.project(to));
            }
        }
    }
}

/// Spread the free vertices evenly: tangential averaging, each step projected onto the sculpt.
fn relax(t: &Topology, sculpt: &Sculpt, pinned: &[bool], p: &mut [Vec3]) {
    let mut around: Vec<Vec<u32>> = vec![Vec::new(); p.len()];
    for quad in &t.quads {
        for k in 0..4 {
            let (a, b) = (quad[k], quad[(k + 1) % 4]);
            let quilt = |v: u32| matches!(t.sites[v as usize], Site::Grid(..) | Site::Cap(..));
            if quilt(a) && quilt(b) {
                if !around[a as usize].contains(&b) {
                    around[a as usize].push(b);
                }
                if !around[b as usize].contains(&a) {
                    around[b as usize].push(a);
                }
            }
        }
    }
    const PASSES: usize = 60;
    for pass in 0..PASSES {
        let before = p.to_vec();
        for v in 0..p.len() {
            if pinned[v] || before[v].x < 0.0 {
                continue;
            }
            let mut mean = Vec3::default();
            for &n in &around[v] {
                mean += before[n as usize];
            }
            mean = mean * (1.0 / around[v].len() as f64);
            if t.mirror[v] as usize == v {
                mean.x = 0.0;
            }
            let wanted = before[v].lerp(mean, 0.6);
            let mut to =
                if pass + 1 < PASSES { sculpt.towards(wanted) } else { sculpt.project(wanted) };
            if t.mirror[v] as usize == v {
                to.x = 0.0;
            }
            p[v] = to;
            p[t.mirror[v] as usize] = to.mirrored();
        }
    }
}

/// The left half decides; midline vertices stand exactly on the midline.
fn mirror_left_to_right(t: &Topology, p: &mut [Vec3]) {
    for v in 0..p.len() {
        let m = t.mirror[v] as usize;
        if m == v {
            p[v].x = 0.0;
        } else if on_left(t.sites[v]) {
            p[m] = p[v].mirrored();
        }
    }
}

/// Whether an address is on the person's left (or is a mouth's vertex on that side).
pub(crate) fn on_left(site: Site) -> bool {
    match site {
        Site::Grid(_, c) => c > 0 && c < COLUMNS / 2,
        Site::Cap(i, _) => i > CAP / 2,
        Site::Ring(f, _, k) => match f {
            Feature::Mouth => super::lips::along(k).0 > 0.0,
            Feature::EyeLeft | Feature::NostrilLeft | Feature::EarLeft => true,
            _ => false,
        },
        Site::Fill(f, _, j) => match f {
            Feature::Mouth => {
                let (_, _, c0, c1) = f.block();
                2 * j > c1 - c0
            }
            Feature::EyeLeft | Feature::NostrilLeft | Feature::EarLeft => true,
            _ => false,
        },
    }
}

/// Control points whose limit surface passes through `wanted` (a few fixed-point steps; the limit
/// operator is diagonally dominant, so each step shrinks the error).
fn fit_control(t: &Topology, wanted: &[Vec3]) -> Vec<Vec3> {
    let step = Step::new(wanted.len(), &t.quads);
    let mut control = wanted.to_vec();
    for _ in 0..3 {
        let limit = step.limit(&control);
        for (c, (w, l)) in control.iter_mut().zip(wanted.iter().zip(&limit)) {
            *c += (*w - *l) * 0.8;
        }
    }
    // The order of summation differs between the sides by rounding only; remove even that.
    mirror_left_to_right(t, &mut control);
    control
}
