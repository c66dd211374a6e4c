//! Renders the built-in head to PNG without a GPU, to look at while its shape is worked on.
//!
//! `contact_sheet OUT.png [key=value ...] [/ key=value ...]...` draws one cell for each `/`; what
//! stands before the first `/` holds for all of them. Keys: `seed`, `density` (skin vertices), `yaw`, `pitch`
//! (degrees), `zoom`, `cx`, `cy` (mm), `size` (pixels), `columns`, `grid=1` for mesh lines, and any
//! blendshape (`mouthSmile=1` moves both sides), or `emotion=joy3` for a performance at its apex. `sheet=3` draws
//! the six emotions at intensity 3, from the front and three-quarter.

#[path = "support/raster.rs"]
mod raster;

use mimique_actor::{Clip, Density, Emotion, HeadSpec, Identity, build_head, performance_weights};
use mimique_avatar::Avatar;
use raster::{Camera, Canvas};
use std::error::Error;

#[derive(Clone, Default)]
struct Cell {
    spec: HeadSpec,
    camera: Camera,
    lines: bool,
    pose: Vec<(String, f64)>,
    emotion: Option<Clip>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let out = args.next().ok_or("usage: contact_sheet OUT.png [key=value ...] [/ ...]")?;
    let (mut size, mut columns) = (600, 6);
    let mut common = Cell::default();
    let mut cells: Vec<Cell> = Vec::new();
    for arg in args {
        if arg == "/" {
            cells.push(common.clone());
            continue;
        }
        let cell = cells.last_mut().unwrap_or(&mut common);
        let (key, value) = arg.split_once('=').ok_or("arguments are key=value")?;
        match key {
            "seed" => cell.spec.identity = Identity::from_seed(value.parse()?),
            "density" => cell.spec.density = Density::nearest(value.parse()?),
            "yaw" => cell.camera.yaw = value.parse()?,
            "pitch" => cell.camera.pitch = value.parse()?,
            "zoom" => cell.camera.zoom = value.parse()?,
            "cx" => cell.camera.target[0] = value.parse::<f32>()? * 1e-3,
            "cy" => cell.camera.target[1] = value.parse::<f32>()? * 1e-3,
            "size" => size = value.parse()?,
            "columns" => columns = value.parse()?,
            "emotion" => cell.emotion = Some(clip(value)?),
            "sheet" => {
                let row = sheet(cell, value)?;
                cells.extend(row);
            }
            "grid" => cell.lines = value == "1",
            name => cell.pose.push((name.to_string(), value.parse()?)),
        }
    }
    if cells.is_empty() {
        cells.push(common);
    }
    let columns = cells.len().min(columns);
    let mut canvas = Canvas::new(columns * size, cells.len().div_ceil(columns) * size);
    for (i, cell) in cells.iter().enumerate() {
        let head = build_head(&cell.spec);
        let mut weights = cell
            .emotion
            .as_ref()
            .map_or_else(|| vec![0.0; head.shape_names.len()], |clip| apex(&head, clip));
        for (name, w) in &cell.pose {
            let mut found = false;
            for (k, shape) in head.shape_names.iter().enumerate() {
                if shape == name
                    || shape.strip_suffix("Left").is_some_and(|s| s == name)
                    || shape.strip_suffix("Right").is_some_and(|s| s == name)
                {
                    weights[k] = *w;
                    found = true;
                }
            }
            if !found {
                return Err(format!("no blendshape `{name}`").into());
            }
        }
        let rect = [i % columns * size, i / columns * size, size, size];
        canvas.draw_head(&head, &weights, &cell.camera, rect, cell.lines);
    }
    canvas.save(&out)
}

/// A clip by its short name, as `joy3`.
fn clip(name: &str) -> Result<Clip, Box<dyn Error>> {
    let (word, digit) = name.split_at(name.len().saturating_sub(1));
    let emotion = Emotion::ALL
        .into_iter()
        .find(|e| e.name() == word)
        .ok_or_else(|| format!("no emotion `{word}`"))?;
    Ok(Clip { emotion, intensity: digit.parse()?, seed: 1 })
}

/// The six emotions at one intensity, a row from the front and a row three-quarter.
fn sheet(like: &Cell, intensity: &str) -> Result<Vec<Cell>, Box<dyn Error>> {
    let mut cells = Vec::new();
    for yaw in [0.0, -35.0] {
        for emotion in Emotion::ALL {
            let mut cell = like.clone();
            cell.camera.yaw = yaw;
            cell.emotion = Some(clip(&format!("{}{intensity}", emotion.name()))?);
            cells.push(cell);
        }
    }
    Ok(cells)
}

/// The strongest frame of a clip, eyes open and ahead.
fn apex(head: &Avatar, clip: &Clip) -> Vec<f64> {
    let played = performance_weights(&head.shape_names, clip, 60.0, 4.0);
    let strength = |f: usize| {
        let mut sum = 0.0;
        for (name, w) in head.shape_names.iter().zip(played.frame(f)) {
            sum += if name.starts_with("eyeBlink") { -3.0 * w } else { *w };
        }
        sum
    };
    let best = (0..played.frames()).max_by(|&a, &b| strength(a).total_cmp(&strength(b)));
    let mut weights = played.frame(best.unwrap_or(0)).to_vec();
    for (name, w) in head.shape_names.iter().zip(&mut weights) {
        if name.starts_with("eyeLookIn") || name.starts_with("eyeLookOut") {
            *w = 0.0;
        }
    }
    weights
}
