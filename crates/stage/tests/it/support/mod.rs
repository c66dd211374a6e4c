//! A small analytic head, an adapter or a skip by name, and the comparison of pictures.

pub mod sheet;

use std::f32::consts::PI;

use mimique_avatar::{
    Avatar, Eyeball, Look as EyeLook, Mesh, Part, SparseShape, Texture, Textured,
};
use mimique_stage::offscreen::{Offscreen, Picture};
use mimique_test_support::skip;

/// The software adapter, or `None` after saying that the test is skipped.
///
/// # Panics
/// Without an adapter when `MIMIQUE_NO_SKIP=1`.
pub fn adapter(test: &str) -> Option<Offscreen> {
    match Offscreen::new(true) {
        Ok(stage) => Some(stage),
        Err(error) => {
            skip(test, &error.to_string());
            None
        }
    }
}

/// An egg with eyes, a mouthless chin and three blendshapes: `puff` swells its cheeks, `jawOpen`
/// draws its lower third down, `eyeLookLeft` turns both eyes. Seam vertices are split as exporters do.
pub fn egg() -> Avatar {
    let mut skin = ball([0.0, 0.0, 0.0], [0.072, 0.105, 0.085], 48, 32);
    skin.part = Part::Skin;
    skin.base_colour = [0.62, 0.42, 0.33];
    let puff = shape(&skin, |p| {
        let side = (p[0].abs() - 0.045) / 0.02;
        let high = (p[1] + 0.025) / 0.025;
        let size = 0.014 * (-side * side - high * high).exp() * p[2].signum().max(0.0);
        [size * p[0].signum(), 0.0, size * 0.6]
    });
    let jaw = shape(&skin, |p| [0.0, -0.018 * ((-0.03 - p[1]) / 0.05).clamp(0.0, 1.0), 0.0]);
    skin.shapes = vec![puff, jaw, SparseShape::default()];
    let mut avatar = Avatar {
        name: "egg".to_owned(),
        shape_names: ["puff", "jawOpen", "eyeLookLeft"].map(str::to_owned).to_vec(),
        meshes: vec![skin],
        ..Avatar::default()
    };
    for (x, part) in [(-0.031, Part::EyeRight), (0.031, Part::EyeLeft)] {
        let centre = [x, 0.024, 0.063];
        let mut eye = ball(centre, [0.0135; 3], 24, 16);
        eye.part = part;
        eye.base_colour = [0.9, 0.9, 0.9];
        eye.shapes = vec![SparseShape::default(); 3];
        let looks = vec![EyeLook { shape: 2, axis: [0.0, 1.0, 0.0], radians: 0.5 }];
        avatar.eyeballs.push(Eyeball { mesh: avatar.meshes.len(), centre, looks });
        avatar.meshes.push(eye);
    }
    avatar
}

/// The egg with a picture on its front: four fields of a colour each under a fine pattern, so that
/// a picture upside down, mirrored, without mipmaps or in the wrong light shows. Its lower right
/// field (the person's left cheek) has holes in it.
pub fn pictured_egg() -> Avatar {
    const SIDE: u16 = 256;
    let texel = |i: u32| {
        let (x, y) = (i % u32::from(SIDE), i / u32::from(SIDE));
        let field = usize::from(x >= 128) + 2 * usize::from(y >= 128);
        let dark = ((x / 4) + (y / 4)) % 2 == 1;
        let colour = [[215u8, 150, 130], [130, 190, 120], [110, 140, 205], [225, 205, 110]][field];
        let hole = field == 3 && (x / 32 + y / 32) % 2 == 1;
        (colour.map(|c| if dark { c / 3 } else { c }), if hole { 0 } else { 255 })
    };
    let texels: Vec<([u8; 3], u8)> = (0..u32::from(SIDE).pow(2)).map(texel).collect();
    let jpeg = |samples: &[u8], kind| {
        let mut out = Vec::new();
        let encoder = jpeg_encoder::Encoder::new(&mut out, 95);
        encoder.encode(samples, SIDE, SIDE, kind).expect("a small picture");
        out
    };
    let rgb: Vec<u8> = texels.iter().flat_map(|t| t.0).collect();
    let mask: Vec<u8> = texels.iter().map(|t| t.1).collect();
    let mut avatar = egg();
    avatar.textures = vec![Texture {
        jpeg: jpeg(&rgb, jpeg_encoder::ColorType::Rgb),
        mask_jpeg: jpeg(&mask, jpeg_encoder::ColorType::Luma),
    }];
    let skin = &mut avatar.meshes[0];
    skin.base_colour = [1.0; 3];
    skin.uvs = skin.positions.iter().map(|p| [0.5 + p[0] / 0.15, 0.5 - p[1] / 0.215]).collect();
    // The back of the head stays plain.
    let behind = |t: &[u32; 3]| t.iter().all(|v| skin.positions[*v as usize][2] < 0.0);
    let (back, front): (Vec<[u32; 3]>, Vec<[u32; 3]>) =
        skin.triangles.iter().partition(|t| behind(t));
    skin.textured = vec![Textured { triangles: back.len()..back.len() + front.len(), texture: 0 }];
    skin.triangles = [back, front].concat();
    avatar
}

fn shape(mesh: &Mesh, delta: impl Fn([f32; 3]) -> [f32; 3]) -> SparseShape {
    let moved = |(v, &p): (usize, &[f32; 3])| {
        let d = delta(p);
        (d != [0.0; 3]).then_some((v as u32, d))
    };
    let (vertices, deltas) = mesh.positions.iter().enumerate().filter_map(moved).unzip();
    SparseShape { vertices, deltas }
}

/// An ellipsoid of `around` x `down` cells; the first and the last meridian lie in one place, the
/// poles are at the left and the right.
pub fn ball(centre: [f32; 3], radii: [f32; 3], around: u32, down: u32) -> Mesh {
    let mut mesh = Mesh { name: "ball".to_owned(), ..Mesh::default() };
    for i in 0..=down {
        let polar = PI * i as f32 / down as f32;
        for j in 0..=around {
            let turn = 2.0 * PI * (j % around) as f32 / around as f32;
            let unit = [-polar.cos(), polar.sin() * turn.cos(), polar.sin() * turn.sin()];
            mesh.positions.push([0, 1, 2].map(|a| centre[a] + radii[a] * unit[a]));
        }
    }
    let at = |i: u32, j: u32| i * (around + 1) + j;
    for i in 0..down {
        for j in 0..around {
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            if i > 0 {
                mesh.triangles.push([a, b, c]);
            }
            if i + 1 < down {
                mesh.triangles.push([a, c, d]);
            }
        }
    }
    mesh
}

/// How far two pictures of one size are apart.
#[derive(Debug)]
pub struct Difference {
    /// Mean over all colour bytes, 0 to 255.
    pub mean: f64,
    /// Part of the pixels with a colour byte that differs by more than 12.
    pub outliers: f64,
}

/// Compares the colours of two pictures.
pub fn difference(a: &Picture, b: &Picture) -> Difference {
    assert_eq!((a.width, a.height), (b.width, b.height), "pictures of different sizes");
    let (mut sum, mut outliers) = (0.0, 0);
    for (p, q) in a.rgba.chunks_exact(4).zip(b.rgba.chunks_exact(4)) {
        let off = [0, 1, 2].map(|c| p[c].abs_diff(q[c]));
        sum += off.iter().map(|&d| f64::from(d)).sum::<f64>();
        outliers += usize::from(off.iter().any(|&d| d > 12));
    }
    let pixels = (a.width * a.height) as f64;
    Difference { mean: sum / (3.0 * pixels), outliers: outliers as f64 / pixels }
}
