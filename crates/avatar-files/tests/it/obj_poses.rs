//! Heads as folders and archives of OBJ poses: made here, and the real one.

use std::collections::HashMap;
use std::io::Write as _;
use std::path::Path;

use mimique_avatar::pack::encode_pack;
use mimique_avatar::{Avatar, Part};
use mimique_avatar_files::{
    AvatarSettings, ReadAvatar, ReadError, is_folder_of_poses, read_avatar,
};
use mimique_test_support::real_data;

/// A folded sheet of quads, two teeth and a pose `smile` that lifts its corner.
fn pose(lift: f64) -> String {
    format!(
        "mtllib head.mtl\no Head\nusemtl skin\nv 0 0 0\nv 10 {lift} 0\nv 10 10 1\nv 0 10 0\nv 20 0 2\n\
         v 20 10 2\nf 1 2 3 4\nf 2 5 6 3\no Teeth\nusemtl enamel\nv 1 1 -1\nv 2 1 -1\nv 2 2 -1\nf 7 8 9\n"
    )
}

fn files() -> Vec<(&'static str, String)> {
    vec![
        ("smile.obj", pose(3.0)),
        ("neutral.obj", pose(0.0)),
        ("AU26.obj", pose(-5.0)),
        ("head.mtl", "newmtl skin\nKd 1 0.5 0\nnewmtl enamel\nKd 1 1 1\n".to_owned()),
        ("notes.txt", "not looked at".to_owned()),
    ]
}

fn folder(files: &[(&str, String)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

fn read(files: &[(&str, String)]) -> Result<ReadAvatar, ReadError> {
    read_avatar(folder(files).path())
}

#[test]
fn a_folder_of_poses_is_a_head() {
    let there = folder(&files());
    assert!(is_folder_of_poses(there.path()));
    assert!(!is_folder_of_poses(&there.path().join("smile.obj")));
    assert!(!is_folder_of_poses(folder(&[("notes.txt", String::new())]).path()));
    let read = read(&files()).unwrap();
    let avatar = &read.avatar;
    assert_eq!(avatar.shape_names, ["AU26", "smile"]);
    assert_eq!(read.unit_metres, 0.01);
    let [skin, teeth] = avatar.meshes.as_slice() else { panic!("{:?}", avatar.meshes) };
    assert_eq!((skin.part, teeth.part), (Part::Skin, Part::Teeth));
    assert_eq!(skin.positions.len(), 6);
    assert_eq!(skin.triangles, [[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]]);
    assert_eq!(teeth.triangles, [[0, 1, 2]]);
    assert_eq!(skin.shapes[1].vertices, [1]);
    assert!((skin.shapes[1].deltas[0][1] - 0.03).abs() < 1e-7, "{:?}", skin.shapes[1]);
    assert!(teeth.shapes.iter().all(|s| s.vertices.is_empty()));
    // sRGB 0.5 in linear light.
    assert!((skin.base_colour[1] - 0.214).abs() < 1e-3, "{:?}", skin.base_colour);
    assert!(read.notes.iter().any(|n| n.starts_with("unit: centimetres")), "{:?}", read.notes);
    assert!(read.notes.iter().any(|n| n.starts_with("1 of 2 shapes")), "{:?}", read.notes);
}

/// A picture of two halves on two quads: the seam's vertices are split, the rest stays whole.
#[test]
fn pictures_lie_on_surfaces() {
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, 16, 16);
    encoder.set_color(png::ColorType::Rgb);
    let texels = (0..256).flat_map(|i| if i % 16 < 8 { [250, 30, 30] } else { [30, 30, 250] });
    let texels: Vec<u8> = texels.collect();
    encoder.write_header().unwrap().write_image_data(&texels).unwrap();
    let quads = |lift: f64| {
        pose(lift).replace(
            "f 1 2 3 4\nf 2 5 6 3",
            "vt 0 0\nvt 0.4 0\nvt 0.4 1\nvt 0 1\nvt 0.6 0\nvt 0.98 0\nvt 0.98 1\nvt 0.6 1\n\
            f 1/1 2/2 3/3 4/4\nf 2/5 5/6 6/7 3/8",
        )
    };
    let folder = folder(&[
        ("neutral.obj", quads(0.0)),
        ("smile.obj", quads(3.0)),
        (
            "head.mtl",
            "newmtl skin\nKd 1 1 1\nmap_Kd -s 1 1 1 maps\\Skin.PNG\n\
            newmtl enamel\nKd 1 1 1\nmap_Kd absent.png\n"
                .to_owned(),
        ),
    ]);
    std::fs::write(folder.path().join("skin.png"), &png).unwrap();
    let read = read_avatar(folder.path()).unwrap();
    let [skin, teeth] = read.avatar.meshes.as_slice() else { panic!("two meshes") };
    assert_eq!((skin.positions.len(), skin.triangles.len()), (8, 4));
    assert_eq!((skin.textured.len(), skin.textured[0].triangles.clone()), (1, 0..4));
    assert!(teeth.textured.is_empty() && teeth.uvs.is_empty());
    // The lifted vertex is split in two, and both move.
    assert_eq!(skin.shapes[0].vertices.len(), 2);
    let image = mimique_avatar::Image::decode(&read.avatar.textures[0]).unwrap();
    for t in [0, 3] {
        let colour = image.linear_at(skin.uvs[skin.triangles[t][1] as usize]);
        let (red, blue) = if t == 0 { (0.8, 0.1) } else { (0.1, 0.8) };
        assert!(
            (colour[0] > red) == (red > blue) && (colour[2] > blue) == (blue > red),
            "{colour:?}"
        );
    }
    // A picture on the foot of the sheet is on its foot: v counts from below.
    assert_eq!(skin.uvs[skin.triangles[0][0] as usize], [0.0, 1.0]);
    // A picture that nothing can lie on is not looked for: the teeth have no places in it.
    assert_eq!(read.avatar.textures.len(), 1);
    assert!(!read.notes.iter().any(|n| n.contains("absent.png")), "{:?}", read.notes);
    std::fs::remove_file(folder.path().join("skin.png")).unwrap();
    let bare = read_avatar(folder.path()).unwrap();
    assert!(bare.notes.iter().any(|n| n.starts_with("Skin.PNG: no PNG")), "{:?}", bare.notes);
    assert_eq!(bare.avatar.meshes[0].positions.len(), 6);
    std::fs::write(folder.path().join("skin.png"), &png[..40]).unwrap();
    let broken = read_avatar(folder.path()).unwrap_err().to_string();
    assert!(broken.contains("skin.png: a PNG picture"), "{broken}");
}

#[test]
fn archives_hold_the_same_head() {
    let expected = read(&files()).unwrap().avatar;
    let place = tempfile::tempdir().unwrap();
    let zip_file = place.path().join("head.zip");
    let mut zip = zip::ZipWriter::new(std::fs::File::create(&zip_file).unwrap());
    let mut tar = tar::Builder::new(flate2::write::GzEncoder::new(Vec::new(), Default::default()));
    let mut plain = tar::Builder::new(Vec::new());
    for (name, text) in files() {
        let name = format!("bank/{name}");
        let options = zip::write::SimpleFileOptions::default();
        zip.start_file(name.clone(), options).unwrap();
        zip.write_all(text.as_bytes()).unwrap();
        let mut header = tar::Header::new_ustar();
        header.set_size(text.len() as u64);
        header.set_mode(0o644);
        header.set_cksum();
        tar.append_data(&mut header.clone(), &name, text.as_bytes()).unwrap();
        plain.append_data(&mut header, &name, text.as_bytes()).unwrap();
    }
    zip.finish().unwrap();
    let tar_file = place.path().join("head.tar.gz");
    std::fs::write(&tar_file, tar.into_inner().unwrap().finish().unwrap()).unwrap();
    let plain_file = place.path().join("head.tar");
    std::fs::write(&plain_file, plain.into_inner().unwrap()).unwrap();
    for file in [zip_file, tar_file, plain_file] {
        let avatar = read_avatar(&file).unwrap().avatar;
        assert_eq!(avatar.name, "head");
        assert_eq!(avatar, Avatar { name: "head".to_owned(), ..expected.clone() });
        // Every cut is refused with a place, none is a panic.
        let whole = std::fs::read(&file).unwrap();
        for length in (0..whole.len()).step_by(37) {
            let cut = whole[..length].to_vec();
            if let Err(error) = mimique_avatar_files::read_avatar_bytes(cut, "head", None, None) {
                assert!(error.to_string().contains(": "), "{error}");
            }
        }
    }
}

#[test]
fn settings_name_parts_shapes_and_unit() {
    let mut files = files();
    let text = r#"{"unit": "mm", "parts": {"enamel": "lashes", "Head": "skin"},
        "shapes": {"smile": "mouthSmileLeft"}, "locked": ["mouth*"],
        "vertexParts": [{"first": 1, "end": 2, "part": "socket"}]}"#;
    files.push(("avatar.json", text.to_owned()));
    let first = read(&files).unwrap();
    assert_eq!(first.unit_metres, 0.001);
    assert_eq!(first.locked, ["mouthSmileLeft"]);
    assert_eq!(first.avatar.shape_names, ["AU26", "mouthSmileLeft"]);
    let parts: Vec<Part> = first.avatar.meshes.iter().map(|m| m.part).collect();
    assert_eq!(parts, [Part::Skin, Part::Socket, Part::Lashes]);
    // The file beside the folder wins over the one in it.
    let inside = folder(&files);
    let name = inside.path().file_name().unwrap().to_string_lossy().into_owned();
    let beside = inside.path().with_file_name(format!("{name}.avatar.json"));
    std::fs::write(&beside, r#"{"leaveOut": ["smile"], "unit": "m"}"#).unwrap();
    let read = read_avatar(inside.path());
    std::fs::remove_file(&beside).unwrap();
    let read = read.unwrap();
    assert_eq!((read.avatar.shape_names.len(), read.unit_metres), (1, 1.0));

    for (text, says) in [
        (r#"{"neutral": "calm"}"#, "/neutral: there is no calm.obj"),
        (r#"{"locked": ["nose*"]}"#, "/locked: no shape \"nose*\"; the file has AU26, smile"),
        (r#"{"shapes": {"frown": "x"}}"#, "/shapes: no shape \"frown\""),
        (r#"{"shapes": {"smile": "AU26"}}"#, "\"AU26\" is the name of two shapes"),
        (r#"{"leaveOut": ["*"]}"#, "no blendshapes"),
        (r#"{"vertexParts": [{"first": 0, "end": 10, "part": "skin"}]}"#, "vertex 10 of 9"),
    ] {
        files.pop();
        files.push(("avatar.json", text.to_owned()));
        let error = read_avatar(folder(&files).path()).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
}

#[test]
fn poses_that_do_not_fit_are_refused_by_name() {
    type Damage = fn(&mut Vec<(&'static str, String)>);
    let cases: [(&str, Damage); 7] = [
        ("smile.obj: 10 vertices, the neutral neutral.obj has 9", |f| f[0].1 += "v 0 0 0\n"),
        ("smile.obj, line 18: \"NaN\" is not a finite number", |f| f[0].1 += "v 0 NaN 0\n"),
        ("no OBJ file", |f| f.retain(|(name, _)| !name.ends_with("obj"))),
        ("none of 2 files is named neutral", |f| f.retain(|(name, _)| *name != "neutral.obj")),
        ("may both be the neutral", |f| f.push(("neutral2.obj", pose(0.0)))),
        ("no blendshapes", |f| f.retain(|(name, _)| *name == "neutral.obj")),
        ("no skin", |f| f.iter_mut().for_each(|(_, t)| *t = t.replace("\nf ", "\n#f "))),
    ];
    for (says, damage) in cases {
        let mut files = files();
        damage(&mut files);
        let error = read(&files).unwrap_err().to_string();
        assert!(error.contains(says), "{says}: {error}");
        assert!(error.contains("; "), "no remedy: {error}");
    }
}

/// The settings of the real bank, as users would put them beside it.
fn real_settings() -> AvatarSettings {
    let file = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../study-config/avatars/ict-facekit-obj.avatar.json");
    AvatarSettings::from_json("settings", &std::fs::read(file).unwrap()).unwrap()
}

#[test]
fn the_real_bank_of_poses_is_the_real_glb() {
    let Some(root) = real_data("the_real_bank_of_poses_is_the_real_glb") else { return };
    let glb = read_avatar(&root.join("ict-facekit/ict-facekit.glb")).unwrap().avatar;
    let archive = std::fs::read(root.join("ict-facekit/ict-facekit-obj.tar.xz")).unwrap();
    let read =
        mimique_avatar_files::read_avatar_bytes(archive, "bank", None, Some(real_settings()));
    let read = read.unwrap();
    let bank = &read.avatar;
    assert_eq!(bank.shape_names, glb.shape_names);
    assert_eq!(read.unit_metres, 0.01);
    // Every part, welded by position, has the same points, displacements and triangles.
    for mesh in &glb.meshes {
        let twin = bank.meshes.iter().find(|m| m.part == mesh.part).unwrap();
        let grid = |p: &[f32; 3]| p.map(|x| (f64::from(x) * 1e6).round() as i64);
        let mut at: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
        for (v, p) in twin.positions.iter().enumerate() {
            at.entry(grid(p)).or_default().push(v);
        }
        // Rounding differs by a step at most: metres were written with six digits or more.
        let near = |p: &[f32; 3]| -> Vec<usize> {
            let [x, y, z] = grid(p);
            let steps = || -1..=1;
            steps()
                .flat_map(|i| {
                    steps().flat_map(move |j| steps().map(move |k| [x + i, y + j, z + k]))
                })
                .filter_map(|cell| at.get(&cell))
                .flatten()
                .copied()
                .collect()
        };
        let delta = |m: &mimique_avatar::Mesh, k: usize| -> HashMap<u32, [f32; 3]> {
            m.shapes[k].vertices.iter().copied().zip(m.shapes[k].deltas.iter().copied()).collect()
        };
        let twins: Vec<Vec<usize>> = mesh.positions.iter().map(near).collect();
        assert!(twins.iter().all(|t| !t.is_empty()), "{:?} differs", mesh.part);
        for k in 0..glb.shape_names.len() {
            let (a, b) = (delta(mesh, k), delta(twin, k));
            for (v, candidates) in twins.iter().enumerate() {
                let p = a.get(&(v as u32)).copied().unwrap_or_default();
                let off = candidates.iter().map(|&t| {
                    let q = b.get(&(t as u32)).copied().unwrap_or_default();
                    (0..3).map(|i| (p[i] - q[i]).abs()).fold(0f32, f32::max)
                });
                let off = off.fold(f32::INFINITY, f32::min);
                assert!(
                    off < 2e-6,
                    "{:?}, {}: vertex {v} is {off} m off",
                    mesh.part,
                    glb.shape_names[k]
                );
            }
        }
        assert_eq!(mesh.triangles.len(), twin.triangles.len(), "{:?}", mesh.part);
    }
    let (a, b) = (encode_pack(&glb), encode_pack(bank));
    eprintln!("packs: GLB {} bytes, poses {} bytes", a.bytes.len(), b.bytes.len());
    assert!(b.bytes.len() <= 2_500_000 && b.error_bound <= 1e-5, "{}", b.bytes.len());
}

#[test]
fn a_posture_follows_the_shapes_that_drive_it() {
    let plain = read(&files()).unwrap().avatar;
    let (au26, smile) = (plain.shape_index("AU26").unwrap(), plain.shape_index("smile").unwrap());
    // The smile becomes a posture of every mesh that it moves.
    let moved: Vec<usize> = (0..plain.meshes.len())
        .filter(|&m| !plain.meshes[m].shapes[smile].vertices.is_empty())
        .collect();
    assert!(!moved.is_empty());
    let mesh = |m: usize| format!("{:?}: {{\"smile\": [\"AU26\"]}}", plain.meshes[m].name);
    let map: Vec<String> = moved.iter().map(|&m| mesh(m)).collect();
    let with = |driven: String| {
        let mut files = files();
        files.push(("avatar.json", format!("{{\"driven\": {{{driven}}}}}")));
        read(&files)
    };
    let driven = with(map.join(", ")).unwrap().avatar;
    assert_eq!(driven.shape_names, ["AU26"]);
    let mut weights = [0.0; 2];
    (weights[au26], weights[smile]) = (0.5, 0.5);
    for (before, after) in plain.meshes.iter().zip(&driven.meshes) {
        // The sum is rounded once more than the two.
        for (p, q) in before.posed(&weights).iter().zip(after.posed(&[0.5])) {
            assert!((0..3).all(|a| (p[a] - q[a]).abs() < 1e-7), "{}: {p:?} {q:?}", before.name);
        }
    }
    let error = with(r#""hat": {"smile": ["AU26"]}"#.to_owned()).unwrap_err().to_string();
    assert!(error.starts_with("avatar.json: /driven/hat: no mesh \"hat\""), "{error}");
}
