//! A head as artists deliver it: one OBJ file per pose, the neutral and one per blendshape.
//!
//! All poses have the vertices of the neutral in its order; only the neutral's polygons count.
//! A shape is called as its file. Vertices that lie in one place but are split (texture seams)
//! stay split here; the solver welds them by position.

mod material;
mod parse;

use std::collections::{BTreeMap, HashMap};
use std::ops::Range;
use std::path::Path;

use self::material::{Material, NO_MATERIAL, Pictures, materials};
use self::parse::{Corner, Group, Obj, parse, parse_positions};
use crate::files::Files;
use crate::parts::{PartName, assign_parts};
use crate::settings::{AvatarSettings, fits};
use crate::template::Surface;
use crate::{ReadAvatar, ReadError};
use mimique_avatar::{Avatar, Image, Mesh, Part, SparseShape, Textured};

/// Settings inside the folder or archive.
const SETTINGS_FILE: &str = "avatar.json";
/// Words in the name of the neutral pose's file, the most telling first.
const NEUTRAL_WORDS: [&str; 4] = ["neutral", "rest", "base", "default"];
/// Most vertices of one pose, and most coordinates of all poses together.
const MOST_VERTICES: usize = 1 << 22;
const MOST_COORDINATES: usize = 1 << 27;

/// Reads the OBJ poses of a folder or archive. `settings` win over an `avatar.json` among them.
pub(crate) fn read_obj_poses(
    files: &Files,
    name: &str,
    settings: Option<AvatarSettings>,
) -> Result<ReadAvatar, ReadError> {
    let (names, inside) = look_over(files)?;
    let settings = settings.or(inside).unwrap_or_default();
    let neutral = neutral_of(&names, &settings)?;
    let mut notes = Vec::new();
    let identities = names.iter().filter(|n| **n != neutral && is_identity(n, &settings)).count();
    if identities > 0 {
        notes.push(format!("{identities} files of other identities are left out"));
    }
    let poses = Poses::read(files, &neutral, &settings, &mut notes)?;
    let (shape_names, meshes) = poses.meshes(&settings)?;
    let (name, textures) = (name.to_owned(), poses.pictures.textures);
    let avatar = Avatar { name, shape_names, meshes, textures, ..Avatar::default() };
    ReadAvatar::finish(avatar, notes, &settings)
}

/// The vertices of one file in its order, in its unit, and its triangles.
pub(crate) fn mesh_of(file: &str, bytes: &[u8]) -> Result<Surface, ReadError> {
    let read = parse(file, bytes)?;
    let triangles = read.groups.iter().flat_map(|group| &group.triangles);
    let triangles = triangles.map(|t| t.map(|(vertex, _)| vertex)).collect();
    Ok((read.positions.iter().map(|&p| single(p)).collect(), triangles))
}

/// Names of the OBJ files without their ending, and the settings among them.
fn look_over(files: &Files) -> Result<(Vec<String>, Option<AvatarSettings>), ReadError> {
    let mut names: Vec<String> = Vec::new();
    let mut settings = None;
    files.each(&mut |file, content| {
        if let Some(stem) = obj_stem(file) {
            if names.iter().any(|n| n == stem) {
                let what = format!("{file} is there twice");
                return Err(ReadError::broken("poses", what, "keep one file per pose"));
            }
            names.push(stem.to_owned());
        } else if file == SETTINGS_FILE {
            settings = Some(AvatarSettings::from_json(file, &content()?)?);
        }
        Ok(())
    })?;
    Ok((names, settings))
}

/// Whether a path is a folder with at least one pose in it.
pub fn is_folder_of_poses(path: &Path) -> bool {
    let Ok(entries) = std::fs::read_dir(path) else { return false };
    entries.flatten().any(|entry| entry.file_name().to_str().and_then(obj_stem).is_some())
}

fn obj_stem(file: &str) -> Option<&str> {
    let (stem, ending) = file.rsplit_once('.')?;
    (ending.eq_ignore_ascii_case("obj") && !stem.is_empty()).then_some(stem)
}

/// `identity000`: another person, no expression. Banks deliver them beside the poses.
fn is_identity(name: &str, settings: &AvatarSettings) -> bool {
    let digits = name.to_lowercase().strip_prefix("identity").map(str::to_owned);
    let named =
        digits.is_some_and(|d| d.trim_start_matches('_').bytes().all(|b| b.is_ascii_digit()));
    named && !settings.shapes.iter().any(|(file, _)| file == name)
}

fn neutral_of(names: &[String], settings: &AvatarSettings) -> Result<String, ReadError> {
    if names.is_empty() {
        return Err(ReadError::broken(
            "poses",
            "no OBJ file",
            "give a .glb or .gltf file, or a folder or archive with one .obj a pose",
        ));
    }
    if let Some(wanted) = &settings.neutral {
        return names.iter().find(|n| *n == wanted).cloned().ok_or_else(|| {
            let what = format!("there is no {wanted}.obj");
            ReadError::broken("avatar.json: /neutral", what, "name the neutral pose's file")
        });
    }
    for word in NEUTRAL_WORDS {
        let mut found = names.iter().filter(|n| n.to_lowercase().contains(word));
        match (found.next(), found.next()) {
            (Some(one), None) => return Ok(one.clone()),
            (Some(one), Some(other)) => {
                return Err(ReadError::broken(
                    "poses",
                    format!("{one}.obj and {other}.obj may both be the neutral pose"),
                    "name one of them as \"neutral\" in an avatar.json beside them",
                ));
            }
            _ => {}
        }
    }
    Err(ReadError::broken(
        "poses",
        format!("none of {} files is named neutral", names.len()),
        "name the neutral pose's file neutral.obj, or name it in an avatar.json beside them",
    ))
}

/// The neutral and the poses of one head.
struct Poses {
    neutral: Obj,
    /// By name, in alphabetical order.
    posed: BTreeMap<String, Vec<[f64; 3]>>,
    materials: HashMap<String, Material>,
    pictures: Pictures,
}

impl Poses {
    fn read(
        files: &Files,
        neutral: &str,
        settings: &AvatarSettings,
        notes: &mut Vec<String>,
    ) -> Result<Self, ReadError> {
        let mut base = Obj::default();
        let mut posed: BTreeMap<String, Vec<[f64; 3]>> = BTreeMap::new();
        let mut all_materials: HashMap<String, Material> = HashMap::new();
        let mut coordinates = 0usize;
        files.each(&mut |file, content| {
            let Some(stem) = obj_stem(file) else {
                if file.to_lowercase().ends_with(".mtl") {
                    all_materials.extend(materials(&content()?));
                }
                return Ok(());
            };
            let left_out = settings.leave_out.iter().any(|p| fits(p, stem));
            if stem == neutral {
                base = parse(file, &content()?)?;
                coordinates += 3 * base.positions.len();
            } else if !left_out && !is_identity(stem, settings) {
                let positions = parse_positions(file, &content()?)?;
                coordinates += 3 * positions.len();
                posed.insert(stem.to_owned(), positions);
            }
            if base.positions.len() > MOST_VERTICES || coordinates > MOST_COORDINATES {
                let what = format!("{} coordinates by here", coordinates);
                return Err(ReadError::broken(file, what, "give a mesh that a browser can draw"));
            }
            Ok(())
        })?;
        let vertices = base.positions.len();
        for (name, positions) in &posed {
            if positions.len() != vertices {
                return Err(ReadError::broken(
                    format!("{name}.obj"),
                    format!(
                        "{} vertices, the neutral {neutral}.obj has {vertices}",
                        positions.len()
                    ),
                    "export all poses from one mesh, without reordering its vertices",
                ));
            }
        }
        // Only those that a surface has, and only where it says how they lie on it.
        let with_places = |g: &&Group| g.triangles.iter().flatten().any(|(_, uv)| uv.is_some());
        let worn = base.groups.iter().filter(with_places);
        let worn = worn.filter_map(|g| all_materials.get(&g.material));
        let pictures = Pictures::read(files, worn, notes)?;
        Ok(Self { neutral: base, posed, materials: all_materials, pictures })
    }

    /// One mesh a part, with the shapes of all poses.
    fn meshes(&self, settings: &AvatarSettings) -> Result<(Vec<String>, Vec<Mesh>), ReadError> {
        let groups = self.split_groups(settings)?;
        let vertices_of = |group: &Group| -> Vec<usize> {
            let mut all: Vec<usize> =
                group.triangles.iter().flatten().map(|(v, _)| *v as usize).collect();
            all.sort_unstable();
            all.dedup();
            all
        };
        let points: Vec<Vec<[f32; 3]>> = groups
            .iter()
            .map(|(g, _)| {
                vertices_of(g).iter().map(|&v| single(self.neutral.positions[v])).collect()
            })
            .collect();
        let moved = |g: &Group| -> Vec<usize> {
            let vertices = vertices_of(g);
            let by = |p: &Vec<[f64; 3]>| {
                vertices.iter().filter(|v| p[**v] != self.neutral.positions[**v]).count()
            };
            self.posed.values().map(by).collect()
        };
        let named: Vec<PartName<'_>> = groups
            .iter()
            .zip(&points)
            .map(|((g, _), positions)| {
                let moved = moved(g);
                PartName {
                    names: [&g.group, &g.object, &g.material],
                    positions,
                    shapes: moved.iter().filter(|n| **n > 0).count(),
                    moved: moved.iter().sum(),
                }
            })
            .collect();
        let parts = assign_parts(&named, settings)?;
        let mut by_part: Vec<(Part, String, Vec<&Group>)> = Vec::new();
        for ((group, said), part) in groups.iter().zip(parts) {
            let Some(part) = said.or(part) else { continue };
            match by_part.iter_mut().find(|(p, _, _)| *p == part) {
                Some((_, _, list)) => list.push(group),
                None => {
                    let names = [&group.group, &group.object, &group.material];
                    let name = names.into_iter().find(|n| !n.is_empty());
                    let name = name.cloned().unwrap_or_else(|| format!("{part:?}"));
                    by_part.push((part, name, vec![group]));
                }
            }
        }
        let meshes = by_part.into_iter().map(|(part, name, list)| self.mesh(part, name, &list));
        let meshes = meshes.collect::<Result<_, _>>()?;
        Ok((self.posed.keys().cloned().collect(), meshes))
    }

    /// The groups, those cut apart that `vertexParts` says are of several parts.
    fn split_groups(
        &self,
        settings: &AvatarSettings,
    ) -> Result<Vec<(Group, Option<Part>)>, ReadError> {
        let count = self.neutral.positions.len();
        for (i, (range, _)) in settings.vertex_parts.iter().enumerate() {
            if range.end > count {
                return Err(ReadError::broken(
                    format!("avatar.json: /vertexParts/{i}/end"),
                    format!("vertex {} of {count}", range.end),
                    "end is one past the last vertex",
                ));
            }
        }
        // A polygon over a border goes with its first corner.
        let said = |triangle: &[Corner; 3]| {
            let first = triangle[0].0 as usize;
            settings.vertex_parts.iter().find(|(range, _)| range.contains(&first)).map(|(_, p)| *p)
        };
        let mut out: Vec<(Group, Option<Part>)> = Vec::new();
        for group in &self.neutral.groups {
            let first = out.len();
            for triangle in &group.triangles {
                let part = said(triangle);
                match out[first..].iter_mut().find(|(_, p)| *p == part) {
                    Some((g, _)) => g.triangles.push(*triangle),
                    None => out.push((Group { triangles: vec![*triangle], ..group.clone() }, part)),
                }
            }
        }
        Ok(out)
    }

    /// One mesh of groups. A vertex that lies in several places of a picture is split, as in glTF.
    fn mesh(&self, part: Part, name: String, groups: &[&Group]) -> Result<Mesh, ReadError> {
        let texture = |g: &Group| self.pictures.of(self.materials.get(&g.material)?);
        // A corner without a picture is its vertex alone.
        let bare = |g: &Group| texture(g).is_none();
        let corner = |c: &Corner, bare: bool| (c.0, c.1.filter(|_| !bare));
        let corners = |g: &&Group| {
            let bare = bare(g);
            g.triangles.iter().flatten().map(move |c| corner(c, bare)).collect::<Vec<_>>()
        };
        let mut used: Vec<Corner> = groups.iter().flat_map(corners).collect();
        used.sort_unstable();
        used.dedup();
        let colour = |g: &Group| self.materials.get(&g.material).map_or(NO_MATERIAL, |m| m.colour);
        let base_colour = groups.first().map_or(NO_MATERIAL, |g| colour(g));
        let mut vertex_colours = vec![base_colour; used.len()];
        let mut triangles = Vec::new();
        let mut textured: Vec<Textured> = Vec::new();
        let mut uvs = Vec::new();
        let place = |uv: Option<u32>| uv.map_or([0.0; 2], |uv| self.neutral.uvs[uv as usize]);
        for group in groups {
            let (picture, first) = (texture(group), triangles.len());
            let eye = matches!(part, Part::EyeLeft | Part::EyeRight);
            // An eye takes its colours vertex by vertex: the stage draws iris and cornea itself.
            let painted =
                picture.filter(|_| eye).map(|index| self.image(index, group)).transpose()?;
            for t in &group.triangles {
                let t = t.map(|c| {
                    used.binary_search(&corner(&c, picture.is_none())).unwrap_or_default() as u32
                });
                triangles.push(t);
                for &v in &t {
                    let plain = colour(group);
                    let seen = painted.as_ref().map(|i| i.linear_at(place(used[v as usize].1)));
                    let seen = seen.unwrap_or([1.0; 3]);
                    vertex_colours[v as usize] = std::array::from_fn(|c| plain[c] * seen[c]);
                }
            }
            let Some(texture) = picture.filter(|_| !eye) else { continue };
            add_textured(&mut textured, first..triangles.len(), texture);
        }
        if !textured.is_empty() {
            uvs = used.iter().map(|c| place(c.1)).collect();
        }
        if vertex_colours.iter().all(|c| *c == base_colour) {
            vertex_colours.clear();
        }
        let neutral = &self.neutral.positions;
        Ok(Mesh {
            name,
            part,
            positions: used.iter().map(|&(v, _)| single(neutral[v as usize])).collect(),
            triangles,
            vertex_colours,
            base_colour,
            shapes: self.shapes(&used),
            uvs,
            textured,
        })
    }

    /// The picture of a group, decoded.
    fn image(&self, index: usize, group: &Group) -> Result<Image, ReadError> {
        Image::decode(&self.pictures.textures[index])
            .map_err(|e| ReadError::damaged(&group.material, e.to_string()))
    }

    /// The displacements of the vertices of corners in every pose.
    fn shapes(&self, used: &[Corner]) -> Vec<SparseShape> {
        let neutral = &self.neutral.positions;
        let of_pose = |posed: &Vec<[f64; 3]>| {
            let moved = |&(v, _): &Corner| {
                let (p, q) = (posed[v as usize], neutral[v as usize]);
                single([p[0] - q[0], p[1] - q[1], p[2] - q[2]])
            };
            SparseShape::from_dense(&used.iter().map(moved).collect::<Vec<_>>())
        };
        self.posed.values().map(of_pose).collect()
    }
}

/// Adds triangles with a picture, to the run before them where it has the same one.
fn add_textured(textured: &mut Vec<Textured>, triangles: Range<usize>, texture: usize) {
    match textured.last_mut() {
        Some(last) if last.texture == texture && last.triangles.end == triangles.start => {
            last.triangles.end = triangles.end;
        }
        _ => textured.push(Textured { triangles, texture }),
    }
}

fn single(p: [f64; 3]) -> [f32; 3] {
    p.map(|x| x as f32)
}
