//! A real take on a head, frame by frame: `take_sheet AVATAR.glb|builtin CAPTURE MAP.json|suggested
//! OUT.png [COLUMNSxROWS] [WIDTHxHEIGHT]`. Evenly spaced frames of the solved take, drawn as participants
//! see them; residuals are printed. For the built-in head a marker's place may be the name of one of
//! its sites: `"Chin": {"site": "chin"}`.
#![allow(clippy::print_stdout)] // what it is for

use std::path::Path;

use mimique_actor::HeadSpec;
use mimique_solver::{Method, MethodSpec};
use mimique_stage::offscreen::{Offscreen, Picture};
use mimique_stage::{Look, View};
use mimique_stimulus::{AvatarSkin, MarkerMap, TakeOptions, solve_take, suggest_map};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [avatar, capture, map, out, rest @ ..] = arguments.as_slice() else {
        return Err("usage: take_sheet AVATAR.glb|builtin CAPTURE MAP.json|suggested OUT.png \
                    [COLUMNSxROWS] [WIDTHxHEIGHT]"
            .into());
    };
    let pair = |word: Option<&String>, usual: [u32; 2]| -> Result<[u32; 2], String> {
        let Some(word) = word else { return Ok(usual) };
        let numbers =
            word.split_once('x').and_then(|(a, b)| Some([a.parse().ok()?, b.parse().ok()?]));
        numbers.ok_or_else(|| format!("{word}: not of the form 8x5"))
    };
    let [columns, rows] = pair(rest.first(), [8, 5])?;
    let [width, height] = pair(rest.get(1), [240, 300])?;
    let avatar = match avatar.as_str() {
        "builtin" => mimique_actor::build_head(&HeadSpec::default()),
        file => mimique_avatar_files::read_avatar(Path::new(file))?.avatar,
    };
    let skin = AvatarSkin::of(&avatar)?;
    let capture = mimique_mocap::read(Path::new(capture))?;
    let map = match map.as_str() {
        "suggested" => suggest_map(&skin, &capture, None)?.to_map(&skin),
        file => MarkerMap::from_text(&with_sites(&std::fs::read_to_string(file)?)?)?,
    };
    let spec = MethodSpec { head_lowpass_hz: Some(10.0), ..MethodSpec::new(Method::Lsts) };
    let options = TakeOptions::default();
    let solved = solve_take(&skin, &capture, &map, &spec, &options, &mut || 0.0)?;
    let summary = &solved.report.summary;
    println!(
        "{}: {} frames, residual {:.2} mm rms, {:.2} mm at worst",
        skin.name, summary.frames, summary.residual_rms_mm, summary.residual_worst_mm
    );
    solved.report.warnings.iter().for_each(|w| println!("  {w}"));
    let stage = Offscreen::new(false)?;
    let renderer = stage.renderer([width, height], Look::STIMULUS);
    let head = renderer.load(&avatar)?;
    let line = (width * 4) as usize;
    let mut sheet = Picture {
        width: width * columns,
        height: height * rows,
        rgba: vec![0; line * columns as usize * (height * rows) as usize],
    };
    let cells = columns * rows;
    for cell in 0..cells {
        let frame =
            (u64::from(cell) * (summary.frames as u64 - 1) / u64::from(cells.max(2) - 1)) as usize;
        let weights: Vec<f32> = solved.table.row(frame).iter().map(|w| *w as f32).collect();
        let picture = stage.picture(&renderer, &head, View::FRONT, &weights)?;
        let (column, row) = (cell % columns, cell / columns);
        for (y, from) in picture.rgba.chunks_exact(line).enumerate() {
            let to =
                ((row * height) as usize + y) * line * columns as usize + column as usize * line;
            sheet.rgba[to..to + line].copy_from_slice(from);
        }
    }
    std::fs::write(out, sheet.png())?;
    Ok(())
}

/// A marker map's text with the built-in head's sites as vertices.
fn with_sites(text: &str) -> Result<String, Box<dyn std::error::Error>> {
    let mut map: serde_json::Value = serde_json::from_str(text)?;
    let sites = mimique_actor::marker_sites(&HeadSpec::default());
    let markers = map["markers"].as_object_mut().into_iter().flat_map(|m| m.values_mut());
    for marker in markers {
        let Some(name) = marker["site"].as_str() else { continue };
        let place = sites.labels.iter().position(|l| l == name);
        let place = place.ok_or_else(|| format!("no site {name:?} on the built-in head"))?;
        *marker = serde_json::json!({ "vertex": sites.vertices[place] });
    }
    Ok(map.to_string())
}
