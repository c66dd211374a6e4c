//! Draws an avatar file: `portrait AVATAR.glb OUT.png [WIDTHxHEIGHT] [YAW] [shape=weight ...]`.

use std::path::Path;

use mimique_stage::offscreen::Offscreen;
use mimique_stage::{Look, View};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, out, rest @ ..] = arguments.as_slice() else {
        return Err(
            "usage: portrait AVATAR.glb OUT.png [WIDTHxHEIGHT] [yaw=RADIANS] [shape=weight ...]"
                .into(),
        );
    };
    let avatar = mimique_face::read_avatar(Path::new(file))?.avatar;
    let mut weights = vec![0.0_f32; avatar.shape_names.len()];
    let mut size = [640, 800];
    let mut view = View::FRONT;
    let mut look = Look::STIMULUS;
    for word in rest {
        if let Some((name, value)) = word.split_once('=') {
            let value: f32 = value.parse()?;
            match name {
                "yaw" => view.yaw = value,
                "pitch" => view.pitch = value,
                "zoom" => view.zoom = value,
                "reference" => look = Look::REFERENCE,
                _ => {
                    let shape = avatar
                        .shape_index(name)
                        .ok_or_else(|| format!("{name}: no such blendshape"))?;
                    weights[shape] = value;
                }
            }
        } else if let Some((w, h)) = word.split_once('x') {
            size = [w.parse()?, h.parse()?];
        }
    }
    let stage = Offscreen::new(false)?;
    let started = std::time::Instant::now();
    let renderer = stage.renderer(size, look);
    let head = renderer.load(&avatar)?;
    let loaded = started.elapsed();
    let picture = stage.picture(&renderer, &head, view, &weights)?;
    let first = started.elapsed() - loaded;
    let again = std::time::Instant::now();
    let _ = stage.picture(&renderer, &head, view, &weights)?;
    eprintln!(
        "{}: load {loaded:.1?}, first picture {first:.1?}, second {:.1?}",
        stage.adapter(),
        again.elapsed()
    );
    std::fs::write(out, picture.png())?;
    Ok(())
}
