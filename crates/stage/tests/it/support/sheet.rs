//! The built-in head's emotions, drawn side by side.

use mimique_actor::{Clip, Emotion, HeadSpec, build_head, performance_weights};
use mimique_stage::offscreen::{Offscreen, Picture};
use mimique_stage::{Look, StageError, View};

/// Three rows of intensities from the front, three from three-quarter; seven columns: neutral,
/// then the emotions in alphabetical order. Each cell is `cell` pixels wide and 5/4 as high.
pub fn emotions(stage: &Offscreen, cell: u32) -> Result<Picture, StageError> {
    let avatar = build_head(&HeadSpec::default());
    let [wide, high] = [cell, cell * 5 / 4];
    let renderer = stage.renderer([wide, high], Look::STIMULUS);
    let head = renderer.load(&avatar)?;
    let (width, height) = (7 * wide, 6 * high);
    let mut rgba = vec![255u8; (4 * width * height) as usize];
    for (row, view) in [View::FRONT, View::THREE_QUARTER].into_iter().enumerate() {
        for intensity in 1..=3u8 {
            let y = (3 * row as u32 + u32::from(intensity) - 1) * high;
            for column in 0..7u32 {
                let weights = match column {
                    0 => vec![0.0; avatar.shape_names.len()],
                    _ => apex(&avatar.shape_names, Emotion::ALL[column as usize - 1], intensity),
                };
                let picture = stage.picture(&renderer, &head, view, &weights)?;
                let line = 4 * wide as usize;
                for (i, pixels) in picture.rgba.chunks_exact(line).enumerate() {
                    let at = 4 * ((y as usize + i) * width as usize + (column * wide) as usize);
                    rgba[at..at + line].copy_from_slice(pixels);
                }
            }
        }
    }
    Ok(Picture { width, height, rgba })
}

/// The strongest frame of a performance, between blinks and with the eyes ahead.
pub fn apex(shape_names: &[String], emotion: Emotion, intensity: u8) -> Vec<f32> {
    let clip = Clip { emotion, intensity, seed: 1 };
    let played = performance_weights(shape_names, &clip, 60.0, 4.0);
    let strength = |f: usize| -> f64 {
        let named = shape_names.iter().zip(played.frame(f));
        named.map(|(name, w)| if name.starts_with("eyeBlink") { -3.0 * w } else { *w }).sum()
    };
    let best = (0..played.frames()).max_by(|&a, &b| strength(a).total_cmp(&strength(b)));
    let frame = played.frame(best.unwrap_or(0));
    let aside = |name: &str| name.starts_with("eyeLookIn") || name.starts_with("eyeLookOut");
    let named = shape_names.iter().zip(frame);
    named.map(|(name, w)| if aside(name) { 0.0 } else { *w as f32 }).collect()
}
