//! Draws an avatar file or the built-in head (or packs it, when OUT ends in `.mmav`):
//! `portrait AVATAR.glb|builtin[:SEED] OUT.png [WIDTHxHEIGHT] [yaw=RADIANS] [vertices=COUNT] [shape=weight ...]`.

use std::path::Path;

use mimique_actor::{Density, HeadSpec, Identity};
use mimique_stage::offscreen::Offscreen;
use mimique_stage::{Look, View};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, out, rest @ ..] = arguments.as_slice() else {
        return Err(
            "usage: portrait AVATAR.glb|builtin[:SEED] OUT.png [WIDTHxHEIGHT] [yaw=RADIANS] [shape=weight ...]"
                .into(),
        );
    };
    let vertices = rest.iter().find_map(|word| word.strip_prefix("vertices="));
    let density = match vertices {
        Some(count) => Density::nearest(count.parse()?),
        None => Density::default(),
    };
    let avatar = match file.as_str() {
        "builtin" => mimique_actor::build_head(&HeadSpec { density, ..HeadSpec::default() }),
        file => match file.strip_prefix("builtin:") {
            Some(seed) => mimique_actor::build_head(&HeadSpec {
                identity: Identity::from_seed(seed.parse()?),
                density,
            }),
            None => mimique_avatar_files::read_avatar(Path::new(file))?.avatar,
        },
    };
    if out.ends_with(".mmav") {
        std::fs::write(out, mimique_avatar::pack::encode_pack(&avatar).bytes)?;
        return Ok(());
    }
    let mut weights = vec![0.0_f32; avatar.shape_names.len()];
    let mut size = [640, 800];
    let mut repeat = 0;
    let mut view = View::FRONT;
    let mut look = Look::STIMULUS;
    for word in rest {
        if let Some(grey) = word.strip_prefix("grey=") {
            look = look.with_background_srgb([grey.parse()?; 3]);
        } else if let Some((name, value)) = word.split_once('=') {
            let value: f32 = value.parse()?;
            match name {
                "yaw" => view.yaw = value,
                "pitch" => view.pitch = value,
                "zoom" => view.zoom = value,
                "vertices" => {}
                "repeat" => repeat = value as u32,
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
    for _ in 0..repeat {
        stage.picture(&renderer, &head, view, &weights)?;
    }
    let each = again.elapsed() / repeat.max(1);
    let adapter = stage.adapter();
    eprintln!("{adapter}: load {loaded:.1?}, first picture {first:.1?}, then {each:.1?} each");
    std::fs::write(out, picture.png())?;
    Ok(())
}
