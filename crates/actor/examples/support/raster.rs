//! A small software rasteriser: z-buffer, smooth normals, key, fill and rim light, sRGB out.

use mimique_avatar::{Avatar, Mesh, Part};
use std::error::Error;
use std::fs::File;
use std::io::BufWriter;

/// Where the picture is taken from.
#[derive(Debug, Clone)]
pub struct Camera {
    pub yaw: f32,
    pub pitch: f32,
    pub zoom: f32,
    pub target: [f32; 3],
}

impl Default for Camera {
    fn default() -> Self {
        Camera { yaw: 0.0, pitch: 0.0, zoom: 1.0, target: [0.0, -0.018, 0.0] }
    }
}

/// Samples per pixel along each axis.
const OVER: usize = 2;

/// The picture under construction, supersampled.
pub struct Canvas {
    width: usize,
    height: usize,
    colour: Vec<[f32; 3]>,
    depth: Vec<f32>,
}

type V = [f32; 3];
fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}
fn dot(a: V, b: V) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
fn unit(a: V) -> V {
    let l = dot(a, a).sqrt().max(1e-12);
    [a[0] / l, a[1] / l, a[2] / l]
}

impl Canvas {
    pub fn new(width: usize, height: usize) -> Canvas {
        let n = width * height * OVER * OVER;
        Canvas { width, height, colour: vec![[0.36, 0.38, 0.40]; n], depth: vec![f32::INFINITY; n] }
    }

    /// Draw a head into the rectangle `[x, y, width, height]`.
    pub fn draw_head(
        &mut self,
        head: &Avatar,
        weights: &[f64],
        camera: &Camera,
        rect: [usize; 4],
        lines: bool,
    ) {
        for (m, mesh) in head.meshes.iter().enumerate() {
            let mut positions = mesh.posed(weights);
            for eyeball in head.eyeballs.iter().filter(|e| e.mesh == m) {
                for look in &eyeball.looks {
                    let angle = look.radians * weights[look.shape] as f32;
                    if angle != 0.0 {
                        for p in &mut positions {
                            *p = turned(*p, eyeball.centre, look.axis, angle);
                        }
                    }
                }
            }
            self.draw_mesh(mesh, &positions, camera, rect, lines);
        }
    }

    fn draw_mesh(
        &mut self,
        mesh: &Mesh,
        positions: &[V],
        camera: &Camera,
        rect: [usize; 4],
        lines: bool,
    ) {
        let mut normals = vec![[0f32; 3]; positions.len()];
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|v| positions[v as usize]);
            let n = cross(sub(b, a), sub(c, a));
            for &v in t {
                for k in 0..3 {
                    normals[v as usize][k] += n[k];
                }
            }
        }
        let (sy, cy) = camera.yaw.to_radians().sin_cos();
        let (sp, cp) = camera.pitch.to_radians().sin_cos();
        let distance = 1.1f32;
        let view = |p: V| {
            let p = [p[0] * cy + p[2] * sy, p[1], p[2] * cy - p[0] * sy];
            [p[0], p[1] * cp - p[2] * sp, p[1] * sp + p[2] * cp]
        };
        let focal = rect[3] as f32 * OVER as f32 * camera.zoom * distance / 0.30;
        let centre = [
            (rect[0] as f32 + rect[2] as f32 * 0.5) * OVER as f32,
            (rect[1] as f32 + rect[3] as f32 * 0.5) * OVER as f32,
        ];
        let seen: Vec<V> = positions.iter().map(|&p| view(sub(p, camera.target))).collect();
        let turned_normals: Vec<V> = normals.iter().map(|&n| unit(view(n))).collect();
        let flat: Vec<V> = seen
            .iter()
            .map(|p| {
                let d = distance - p[2];
                [centre[0] + focal * p[0] / d, centre[1] - focal * p[1] / d, d]
            })
            .collect();
        let (w, h) = (self.width * OVER, self.height * OVER);
        let bounds = [
            rect[0] * OVER,
            rect[1] * OVER,
            ((rect[0] + rect[2]) * OVER).min(w),
            ((rect[1] + rect[3]) * OVER).min(h),
        ];
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|v| flat[v as usize]);
            let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            if area == 0.0 {
                continue;
            }
            let lo = |k: usize| a[k].min(b[k]).min(c[k]).floor().max(bounds[k] as f32) as usize;
            let hi =
                |k: usize| (a[k].max(b[k]).max(c[k]).ceil().max(0.0) as usize).min(bounds[k + 2]);
            for y in lo(1)..hi(1) {
                for x in lo(0)..hi(0) {
                    let q = [x as f32 + 0.5, y as f32 + 0.5];
                    let edge =
                        |p: V, r: V| (r[0] - p[0]) * (q[1] - p[1]) - (r[1] - p[1]) * (q[0] - p[0]);
                    let (u, v, s) = (edge(b, c) / area, edge(c, a) / area, edge(a, b) / area);
                    if u < 0.0 || v < 0.0 || s < 0.0 {
                        continue;
                    }
                    let z = u * a[2] + v * b[2] + s * c[2];
                    let slot = y * w + x;
                    if z >= self.depth[slot] {
                        continue;
                    }
                    self.depth[slot] = z;
                    let blend = |values: [V; 3]| {
                        [0, 1, 2].map(|k| u * values[0][k] + v * values[1][k] + s * values[2][k])
                    };
                    let mut n = unit(blend(t.map(|v| turned_normals[v as usize])));
                    let p = blend(t.map(|v| seen[v as usize]));
                    let base = if mesh.vertex_colours.is_empty() {
                        mesh.base_colour
                    } else {
                        blend(t.map(|v| mesh.vertex_colours[v as usize]))
                    };
                    let eye = unit(sub([0.0, 0.0, distance], p));
                    let back = area > 0.0;
                    if back {
                        n = [-n[0], -n[1], -n[2]];
                    }
                    let mut rgb = shade(base, n, eye, mesh.part);
                    if lines && u.min(v).min(s) < 0.04 {
                        rgb = rgb.map(|c| c * 0.45);
                    }
                    if back && mesh.part == Part::Skin && lines {
                        rgb = [0.9, 0.0, 0.6];
                    }
                    self.colour[slot] = rgb;
                }
            }
        }
    }

    /// Write an sRGB PNG.
    pub fn save(&self, path: &str) -> Result<(), Box<dyn Error>> {
        let mut bytes = Vec::with_capacity(self.width * self.height * 3);
        for y in 0..self.height {
            for x in 0..self.width {
                for k in 0..3 {
                    let mut sum = 0.0;
                    for j in 0..OVER {
                        for i in 0..OVER {
                            let slot = (y * OVER + j) * self.width * OVER + x * OVER + i;
                            sum += srgb(self.colour[slot][k]);
                        }
                    }
                    bytes.push((255.0 * sum / (OVER * OVER) as f32 + 0.5) as u8);
                }
            }
        }
        let file = BufWriter::new(File::create(path)?);
        let mut encoder = png::Encoder::new(file, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.write_header()?.write_image_data(&bytes)?;
        Ok(())
    }
}

fn srgb(c: f32) -> f32 {
    let c = c.clamp(0.0, 1.0);
    if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

/// Wrapped diffuse light from key, fill and rim, with a soft highlight.
fn shade(base: V, n: V, eye: V, part: Part) -> V {
    let key = unit([-0.45, 0.55, 0.75]);
    let fill = unit([0.8, 0.1, 0.6]);
    let rim = unit([0.5, 0.5, -0.75]);
    let wrapped = |l: V, w: f32| ((dot(n, l) + w) / (1.0 + w)).max(0.0);
    let skin = matches!(part, Part::Skin);
    let mut out = [0f32; 3];
    for k in 0..3 {
        let w = if skin { [0.35, 0.2, 0.15][k] } else { 0.15 };
        let light = 1.05 * wrapped(key, w)
            + 0.33 * wrapped(fill, w)
            + 0.45 * wrapped(rim, 0.0) * (1.0 - dot(n, eye)).powi(2)
            + 0.13 * (0.6 + 0.4 * n[1]);
        out[k] = base[k] * light;
    }
    let half = unit([key[0] + eye[0], key[1] + eye[1], key[2] + eye[2]]);
    let (power, strength) = match part {
        Part::EyeLeft | Part::EyeRight => (220.0, 0.9),
        Part::Teeth | Part::Tongue => (40.0, 0.12),
        Part::Hair => (12.0, 0.04),
        Part::Socket => (10.0, 0.0),
        _ => (18.0, 0.045),
    };
    let gloss = strength * dot(n, half).max(0.0).powf(power);
    out.map(|c| c + gloss)
}

fn turned(p: V, centre: V, axis: V, angle: f32) -> V {
    let d = sub(p, centre);
    let (s, c) = angle.sin_cos();
    let k = cross(axis, d);
    let along = dot(axis, d) * (1.0 - c);
    [0, 1, 2].map(|i| centre[i] + d[i] * c + k[i] * s + axis[i] * along)
}
