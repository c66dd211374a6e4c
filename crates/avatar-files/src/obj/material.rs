//! Materials of MTL files: diffuse colours, and the pictures that `map_Kd` lays on surfaces.

use std::collections::HashMap;

use crate::ReadError;
use crate::files::Files;
use crate::pictures::{Picture, picture_of};
use mimique_avatar::Texture;

/// Colour of a surface without material.
pub(super) const NO_MATERIAL: [f32; 3] = [0.8, 0.8, 0.8];

/// What an MTL file says of a surface.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Material {
    /// Linear; multiplied with the picture.
    pub colour: [f32; 3],
    /// File name of the picture, without folders.
    pub picture: Option<String>,
    /// Whether the picture's alpha opens the surface: there is a `map_d` too.
    pub open: bool,
}

/// Materials of an MTL file by name. What is not understood is passed over: colours are no reason to
/// refuse a head.
pub(super) fn materials(bytes: &[u8]) -> Vec<(String, Material)> {
    let mut out: Vec<(String, Material)> = Vec::new();
    for line in String::from_utf8_lossy(bytes).lines() {
        let mut words = line.split_ascii_whitespace();
        let word = words.next();
        if word == Some("newmtl") {
            let plain = Material { colour: NO_MATERIAL, picture: None, open: false };
            out.push((words.collect::<Vec<_>>().join(" "), plain));
            continue;
        }
        let Some((_, material)) = out.last_mut() else { continue };
        match word {
            Some("Kd") => {
                let rgb: Vec<f32> = words.filter_map(|w| w.parse().ok()).collect();
                if let [r, g, b] = rgb.as_slice() {
                    material.colour = [*r, *g, *b].map(linear);
                }
            }
            Some("map_Kd") => material.picture = picture_name(line),
            Some("map_d") => material.open = true,
            _ => {}
        }
    }
    for (_, material) in &mut out {
        // Some exporters write black where the picture says all.
        if material.picture.is_some() && material.colour == [0.0; 3] {
            material.colour = [1.0; 3];
        }
    }
    out
}

/// The file's name in `map_Kd -s 1 1 1 textures/skin of Ada.png`: behind the options and the folders.
fn picture_name(line: &str) -> Option<String> {
    let mut rest = line.trim().strip_prefix("map_Kd")?.trim_start();
    while rest.starts_with('-') {
        let option = rest.split_ascii_whitespace().next()?;
        rest = rest[option.len()..].trim_start();
        // What belongs to an option is numbers, `on`, `off` or one letter.
        while let Some(word) = rest.split_ascii_whitespace().next() {
            let value =
                word.parse::<f64>().is_ok() || word.len() == 1 || ["on", "off"].contains(&word);
            if !value {
                break;
            }
            rest = rest[word.len()..].trim_start();
        }
    }
    let name = rest.rsplit(['/', '\\']).next()?.trim();
    (!name.is_empty()).then(|| name.to_owned())
}

/// Pictures that surfaces carry, by file name and whether they open them, and their textures.
#[derive(Debug, Default)]
pub(super) struct Pictures {
    found: HashMap<(String, bool), usize>,
    /// One each.
    pub textures: Vec<Texture>,
}

impl Pictures {
    /// Reads the pictures of those materials among the files. One that is not there, or is neither
    /// PNG nor JPEG, is noted.
    pub fn read<'m>(
        files: &Files,
        materials: impl Iterator<Item = &'m Material>,
        notes: &mut Vec<String>,
    ) -> Result<Self, ReadError> {
        let mut wanted: Vec<(String, bool)> =
            materials.filter_map(|m| Some((m.picture.clone()?, m.open))).collect();
        wanted.sort();
        wanted.dedup();
        let mut this = Self::default();
        if wanted.is_empty() {
            return Ok(this);
        }
        files.each(&mut |file, content| {
            for (name, open) in wanted.iter().filter(|(name, _)| name.eq_ignore_ascii_case(file)) {
                if this.found.contains_key(&(name.clone(), *open)) {
                    continue;
                }
                let picture = picture_of(&content()?, *open);
                if let Picture::Read(texture) =
                    picture.map_err(|what| ReadError::damaged(file, what))?
                {
                    this.found.insert((name.clone(), *open), this.textures.len());
                    this.textures.push(texture);
                }
            }
            Ok(())
        })?;
        for missing in wanted.iter().filter(|key| !this.found.contains_key(*key)) {
            notes.push(format!(
                "{}: no PNG and no JPEG picture of that name is there; its surface keeps its plain colour",
                missing.0
            ));
        }
        Ok(this)
    }

    /// The texture of a material.
    pub fn of(&self, material: &Material) -> Option<usize> {
        self.found.get(&(material.picture.clone()?, material.open)).copied()
    }
}

/// sRGB to linear light (IEC 61966-2-1); MTL says nothing, pickers and exporters mean sRGB.
fn linear(c: f32) -> f32 {
    let c = if c.is_finite() { c.clamp(0.0, 1.0) } else { 1.0 };
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_named_behind_options_and_folders() {
        for (line, name) in [
            ("map_Kd skin.png", Some("skin.png")),
            ("  map_Kd  textures/skin of Ada.jpg ", Some("skin of Ada.jpg")),
            ("map_Kd -s 1 1 1 -clamp on C:\\heads\\a.png", Some("a.png")),
            ("map_Kd -imfchan r 4.png", Some("4.png")),
            ("map_Kd", None),
            ("map_Kd -s 1 2", None),
        ] {
            assert_eq!(picture_name(line).as_deref(), name, "{line}");
        }
    }

    #[test]
    fn materials_have_colours_and_pictures() {
        let text =
            b"Kd 1 1 1\nnewmtl a b\nKd 0 0 0\nmap_Kd x/y.png\nmap_d z.png\nnewmtl c\nKd 1 0 1\n";
        let read = materials(text);
        let picture = Some("y.png".to_owned());
        let first = Material { colour: [1.0; 3], picture, open: true };
        assert_eq!(read[0], ("a b".to_owned(), first));
        assert_eq!(read[1].1, Material { colour: [1.0, 0.0, 1.0], picture: None, open: false });
    }
}
