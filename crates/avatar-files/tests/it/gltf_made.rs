//! glTF files made here, feature by feature, and damaged ones.

use mimique_avatar::Part;
use mimique_avatar_files::{ReadError, read_gltf};
use serde_json::{Value, json};

/// Bytes of a GLB file of a document and its binary chunk.
fn glb(document: &Value, binary: &[u8]) -> Vec<u8> {
    let mut json = serde_json::to_vec(document).unwrap();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut out = b"glTF".to_vec();
    let total = 12 + 8 + json.len() + 8 + binary.len();
    for word in [2, total as u32, json.len() as u32] {
        out.extend(word.to_le_bytes());
    }
    out.extend(b"JSON");
    out.extend(json);
    out.extend((binary.len() as u32).to_le_bytes());
    out.extend(b"BIN\0");
    out.extend(binary);
    out
}

fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// A triangle with a dense shape `open` and a sparse normalised one `smile`.
fn triangle() -> (Value, Vec<u8>) {
    let mut binary = floats(&[0.0, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.2, 0.0]);
    binary.extend(floats(&[0.0, 0.0, 0.0, 0.0, -0.01, 0.0, 0.0, 0.0, 0.0]));
    binary.extend([0u8, 1, 2, 0]); // Indices, a byte each, at 72.
    binary.extend([2u8, 0, 0, 0]); // Sparse index at 76.
    for x in [i16::MAX, -i16::MAX, 0, 0] {
        binary.extend(x.to_le_bytes()); // Sparse value at 80.
    }
    let document = json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "Head"}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 1]}}],
        "meshes": [{
            "primitives": [{
                "attributes": {"POSITION": 0}, "indices": 2, "material": 0,
                "targets": [{"POSITION": 1}, {"POSITION": 3}]
            }],
            "extras": {"targetNames": ["open", "smile"]}
        }],
        "buffers": [{"byteLength": binary.len()}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 36},
            {"buffer": 0, "byteOffset": 72, "byteLength": 3},
            {"buffer": 0, "byteOffset": 76, "byteLength": 1},
            {"buffer": 0, "byteOffset": 80, "byteLength": 6}
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
             "min": [0, 0, 0], "max": [0.1, 0.2, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5121, "count": 3, "type": "SCALAR"},
            {"componentType": 5122, "normalized": true, "count": 3, "type": "VEC3",
             "sparse": {"count": 1, "indices": {"bufferView": 3, "componentType": 5121},
                        "values": {"bufferView": 4}}}
        ]
    });
    (document, binary)
}

fn refusal(document: &Value, binary: &[u8]) -> String {
    match read_gltf(&glb(document, binary), "test", None) {
        Err(error) => error.to_string(),
        Ok(read) => panic!("read as {:?}", read.avatar),
    }
}

#[test]
fn dense_and_sparse_shapes_colours_and_names_are_read() {
    let (document, binary) = triangle();
    let read = read_gltf(&glb(&document, &binary), "Ada", None).unwrap();
    let mesh = &read.avatar.meshes[0];
    assert_eq!(read.avatar.name, "Ada");
    assert_eq!(read.avatar.shape_names, ["open", "smile"]);
    assert_eq!(mesh.part, Part::Skin);
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
    assert_eq!(mesh.base_colour, [0.5, 0.25, 0.125]);
    assert_eq!(mesh.shapes[0].vertices, [1]);
    assert_eq!(mesh.shapes[0].deltas, [[0.0, -0.01, 0.0]]);
    assert_eq!(mesh.shapes[1].vertices, [2]);
    assert_eq!(mesh.shapes[1].deltas, [[1.0, -1.0, 0.0]]);
    assert_eq!(read.notes.len(), 2, "{:?}", read.notes);
    assert!(read.notes[0].starts_with("unit: metres"), "{:?}", read.notes);
}

#[test]
fn colours_of_vertices_are_multiplied_with_the_materials() {
    let (mut document, mut binary) = triangle();
    let at = binary.len();
    binary.resize(at.next_multiple_of(4), 0);
    let at = binary.len();
    binary.extend([255u8, 0, 0, 255, 0, 255, 0, 9, 51, 51, 51, 0]);
    document["buffers"][0]["byteLength"] = json!(binary.len());
    let views = document["bufferViews"].as_array_mut().unwrap();
    views.push(json!({"buffer": 0, "byteOffset": at, "byteLength": 12}));
    let view = views.len() - 1;
    let accessors = document["accessors"].as_array_mut().unwrap();
    accessors.push(json!({"bufferView": view, "componentType": 5121, "normalized": true,
        "count": 3, "type": "VEC4"}));
    let accessor = accessors.len() - 1;
    let primitive = &mut document["meshes"][0]["primitives"][0];
    primitive["attributes"]["COLOR_0"] = json!(accessor);
    let colours = |document: &Value| {
        let read = read_gltf(&glb(document, &binary), "test", None).unwrap();
        read.avatar.meshes[0].vertex_colours.clone()
    };
    let near = |found: Vec<[f32; 3]>, expected: [[f32; 3]; 3]| {
        let all = found.as_flattened().iter().zip(expected.as_flattened());
        assert!(
            found.len() == 3 && all.into_iter().all(|(a, b)| (a - b).abs() < 1e-6),
            "{found:?}"
        );
    };
    near(colours(&document), [[0.5, 0.0, 0.0], [0.0, 0.25, 0.0], [0.1, 0.05, 0.025]]);
    // Without a material they stand for themselves.
    document["meshes"][0]["primitives"][0].as_object_mut().unwrap().remove("material");
    near(colours(&document), [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.2; 3]]);
    document["accessors"][accessor]["count"] = json!(2);
    let error = refusal(&document, &binary);
    assert!(error.contains("COLOR_0") && error.contains("2 colours of 3"), "{error}");
}

#[test]
fn a_plain_gltf_with_its_buffer_inside_is_read() {
    use base64::Engine as _;
    let (mut document, binary) = triangle();
    let data = base64::engine::general_purpose::STANDARD.encode(&binary);
    document["buffers"][0]["uri"] = json!(format!("data:application/octet-stream;base64,{data}"));
    let text = serde_json::to_vec(&document).unwrap();
    let read = read_gltf(&text, "Ada", None).unwrap();
    assert_eq!(read.avatar.meshes[0].positions[2], [0.0, 0.2, 0.0]);
}

#[test]
fn a_buffer_in_a_file_of_its_own_must_lie_beside_the_avatar() {
    let (mut document, binary) = triangle();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a b.bin"), &binary).unwrap();
    document["buffers"][0]["uri"] = json!("a%20b.bin");
    let text = serde_json::to_vec(&document).unwrap();
    assert!(read_gltf(&text, "Ada", Some(folder.path())).is_ok());
    assert!(read_gltf(&text, "Ada", None).is_err());
    for outside in ["../a b.bin", "/etc/hostname"] {
        document["buffers"][0]["uri"] = json!(outside);
        let text = serde_json::to_vec(&document).unwrap();
        let error = read_gltf(&text, "Ada", Some(folder.path())).unwrap_err().to_string();
        assert!(error.contains("not in the folder"), "{error}");
    }
    document["buffers"][0]["uri"] = json!("absent.bin");
    let text = serde_json::to_vec(&document).unwrap();
    let error = read_gltf(&text, "Ada", Some(folder.path())).unwrap_err();
    assert!(matches!(error, ReadError::Io { .. }), "{error}");
}

#[test]
fn nodes_place_their_meshes_and_mirrors_turn_triangles() {
    let (mut document, binary) = triangle();
    document["nodes"] = json!([
        {"children": [1], "translation": [0, 1, 0]},
        {"mesh": 0, "scale": [-1, 2, 1], "rotation": [0, 0, 0.5f32.sqrt(), 0.5f32.sqrt()]}
    ]);
    let read = read_gltf(&glb(&document, &binary), "test", None).unwrap();
    let mesh = &read.avatar.meshes[0];
    // (0.1, 0, 0) scaled to (-0.1, 0, 0), turned a quarter about z to (0, -0.1, 0), lifted by 1.
    let near = |p: [f32; 3], q: [f32; 3]| (0..3).all(|a| (p[a] - q[a]).abs() < 1e-6);
    assert!(near(mesh.positions[1], [0.0, 0.9, 0.0]), "{:?}", mesh.positions);
    assert!(near(mesh.positions[2], [-0.4, 1.0, 0.0]), "{:?}", mesh.positions);
    assert!(near(mesh.shapes[0].deltas[0], [0.02, 0.0, 0.0]), "{:?}", mesh.shapes[0].deltas);
    assert_eq!(mesh.triangles, [[0, 2, 1]]);
}

#[test]
fn units_are_recognised_by_the_size_of_the_face() {
    for (scale, metres) in [(1.0, 1.0), (100.0, 0.01), (1000.0, 0.001)] {
        let (mut document, binary) = triangle();
        document["nodes"][0]["scale"] = json!([scale, scale, scale]);
        let read = read_gltf(&glb(&document, &binary), "test", None).unwrap();
        assert_eq!(read.unit_metres, metres);
        let p = read.avatar.meshes[0].positions[2];
        assert!((p[1] - 0.2).abs() < 1e-6, "{p:?}");
        assert!(read.notes.iter().any(|n| n.starts_with("unit: ")), "{:?}", read.notes);
    }
}

#[test]
fn numbers_that_no_head_has_are_refused_with_mesh_and_vertex() {
    let put = |at: usize, value: f32| {
        let (document, mut binary) = triangle();
        binary[at..at + 4].copy_from_slice(&value.to_le_bytes());
        refusal(&document, &binary)
    };
    let far = put(4 * 3, 3e37);
    assert!(far.contains("vertex 1 lies at 3e34 m"), "{far}");
    // The second vertex of `open`, downwards.
    let moved = put(36 + 4 * 4, -1e20);
    assert!(moved.contains("shape \"open\" moves vertex 1 by 1e20 m"), "{moved}");
}

#[test]
fn materials_of_one_mesh_become_one_skin_with_colours() {
    let (mut document, binary) = triangle();
    document["materials"].as_array_mut().unwrap().push(json!({"name": "lips"}));
    let mut second = document["meshes"][0]["primitives"][0].clone();
    second["material"] = json!(1);
    document["meshes"][0]["primitives"].as_array_mut().unwrap().push(second);
    let read = read_gltf(&glb(&document, &binary), "test", None).unwrap();
    assert_eq!(read.avatar.meshes.len(), 1);
    let mesh = &read.avatar.meshes[0];
    assert_eq!(mesh.positions.len(), 6);
    assert_eq!(mesh.triangles[1], [3, 4, 5]);
    assert_eq!(mesh.shapes[0].vertices, [1, 4]);
    assert_eq!(mesh.vertex_colours[0], [0.5, 0.25, 0.125]);
    assert_eq!(mesh.vertex_colours[5], [1.0, 1.0, 1.0]);
}

#[test]
fn what_is_wrong_is_named_with_its_place() {
    type Damage = fn(&mut Value, &mut Vec<u8>);
    let cases: [(&str, Damage); 16] = [
        ("extensionsRequired", |d, _| {
            d["extensionsRequired"] = json!(["KHR_draco_mesh_compression"])
        }),
        ("meshes[0].primitives[0].attributes.POSITION", |d, _| {
            d["accessors"][0]["count"] = json!(4)
        }),
        ("accessor 9 does not exist", |d, _| {
            d["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(9);
        }),
        ("targets[0]", |d, _| d["accessors"][1]["count"] = json!(2)),
        ("4294967295", |d, _| d["accessors"][3]["count"] = json!(4294967295u32)),
        ("sparse index 200", |_, b| b[76] = 200),
        ("not a finite number", |_, b| b[0..4].copy_from_slice(&f32::NAN.to_le_bytes())),
        ("vertex 7 of 3", |_, b| b[74] = 7),
        ("extras.targetNames", |d, _| d["meshes"][0]["extras"]["targetNames"] = json!(["open"])),
        ("names two", |d, _| d["meshes"][0]["extras"]["targetNames"] = json!(["a", "a"])),
        ("no blendshapes", |d, _| {
            d["meshes"][0]["primitives"][0].as_object_mut().unwrap().remove("targets");
        }),
        ("below two others or itself", |d, _| d["nodes"][0]["children"] = json!([0])),
        ("node 5 does not exist", |d, _| d["scenes"][0]["nodes"] = json!([5])),
        ("mesh 3 does not exist", |d, _| d["nodes"][0]["mesh"] = json!(3)),
        ("no mesh", |d, _| d["scenes"][0]["nodes"] = json!([])),
        ("not made of triangles", |d, _| d["meshes"][0]["primitives"][0]["mode"] = json!(1)),
    ];
    for (says, damage) in cases {
        let (mut document, mut binary) = triangle();
        damage(&mut document, &mut binary);
        let error = refusal(&document, &binary);
        assert!(error.contains(says), "{says}: {error}");
        assert!(error.contains("; "), "no remedy: {error}");
    }
}

#[test]
fn containers_that_lie_about_their_length_are_refused() {
    let (document, binary) = triangle();
    let whole = glb(&document, &binary);
    for (at, value) in [(4, 1u32), (8, u32::MAX), (8, 0), (12, 1 << 30), (16, 0)] {
        let mut damaged = whole.clone();
        damaged[at..at + 4].copy_from_slice(&value.to_le_bytes());
        // A length of 0 in the header only says less than there is.
        let read = read_gltf(&damaged, "test", None);
        assert!(read.is_err() || (at, value) == (8, 0), "{at} {value}");
    }
    for length in 0..whole.len() {
        assert!(read_gltf(&whole[..length], "test", None).is_err(), "cut to {length}");
    }
    assert!(read_gltf(b"PK\x03\x04", "test", None).unwrap_err().to_string().contains("byte 0"));
}

#[test]
fn every_single_byte_may_be_wrong() {
    let (document, binary) = triangle();
    let whole = glb(&document, &binary);
    for at in 0..whole.len() {
        for value in [0, 1, 0x7f, 0xff, b'9', b'-', b'"', b'}'] {
            let mut damaged = whole.clone();
            damaged[at] = value;
            let _ = read_gltf(&damaged, "test", None);
        }
    }
}

/// A GLB of a head, with a mesh `Eyes` that holds two balls of 24 mm, 62 mm apart, as one primitive
/// of positions and a shape that moves the person's left one up.
fn head_with_eyes_in_one_mesh() -> Vec<u8> {
    let (around, down) = (16u16, 10u16);
    let mut eyes: Vec<[f32; 3]> = Vec::new();
    let mut corners: Vec<u16> = Vec::new();
    for x in [-0.031f32, 0.031] {
        let first = eyes.len() as u16;
        for i in 0..=down {
            let (high, ring) = (std::f32::consts::PI * f32::from(i) / f32::from(down)).sin_cos();
            for j in 0..around {
                let turn = std::f32::consts::TAU * f32::from(j) / f32::from(around);
                let unit = [high * turn.cos(), high * turn.sin(), ring];
                eyes.push([x + 0.012 * unit[0], 0.02 + 0.012 * unit[1], 0.06 + 0.012 * unit[2]]);
                let at = |i: u16, j: u16| first + i * around + j % around;
                if i < down {
                    let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                    corners.extend([a, b, c, a, c, d]);
                }
            }
        }
    }
    let up = eyes.iter().map(|p| [0.0, if p[0] > 0.0 { 0.001 } else { 0.0 }, 0.0]);
    let up: Vec<f32> = up.flatten().collect();
    let skin = [[-0.08f32, -0.1, 0.05], [0.08, -0.1, 0.05], [0.0, 0.12, 0.05]];
    let open = [[0.0f32, -0.01, 0.0], [0.0; 3], [0.0; 3]];
    let mut binary = floats(&skin.concat());
    binary.extend(floats(&open.concat()));
    let at_eyes = binary.len();
    binary.extend(floats(&eyes.concat()));
    binary.extend(floats(&up));
    let at_corners = binary.len();
    corners.iter().for_each(|c| binary.extend(c.to_le_bytes()));
    binary.resize(binary.len().next_multiple_of(4), 0);
    let (bytes, moved) = (eyes.len() * 12, at_eyes + eyes.len() * 12);
    let document = json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "name": "Head"}, {"mesh": 1, "name": "Eyes"}],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 1}]}],
             "extras": {"targetNames": ["jawOpen"]}},
            {"name": "Eyes", "extras": {"targetNames": ["eyeLookUpLeft"]},
             "primitives": [{"attributes": {"POSITION": 2}, "indices": 4,
                             "targets": [{"POSITION": 3}]}]}
        ],
        "buffers": [{"byteLength": binary.len()}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 36},
            {"buffer": 0, "byteOffset": at_eyes, "byteLength": bytes},
            {"buffer": 0, "byteOffset": moved, "byteLength": bytes},
            {"buffer": 0, "byteOffset": at_corners, "byteLength": corners.len() * 2}
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
             "min": [-0.08, -0.1, 0.05], "max": [0.08, 0.12, 0.05]},
            {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5126, "count": eyes.len(), "type": "VEC3",
             "min": [-0.043, 0.008, 0.048], "max": [0.043, 0.032, 0.072]},
            {"bufferView": 3, "componentType": 5126, "count": eyes.len(), "type": "VEC3"},
            {"bufferView": 4, "componentType": 5123, "count": corners.len(), "type": "SCALAR"}
        ]
    });
    glb(&document, &binary)
}

#[test]
fn eyes_in_one_mesh_become_two_that_turn_about_their_own_centres() {
    let file = head_with_eyes_in_one_mesh();
    let read = read_gltf(&file, "test", None).unwrap();
    let avatar = &read.avatar;
    let named: Vec<(&str, Part)> =
        avatar.meshes.iter().map(|m| (m.name.as_str(), m.part)).collect();
    assert_eq!(named[1..], [("Eyes_L", Part::EyeLeft), ("Eyes_R", Part::EyeRight)]);
    assert!(read.notes.iter().any(|n| n.contains("into left and right: Eyes")), "{:?}", read.notes);
    assert_eq!(avatar.eyeballs.len(), 2);
    for (eye, x) in avatar.eyeballs.iter().zip([0.031, -0.031]) {
        for (found, truth) in eye.centre.iter().zip([x, 0.02, 0.06]) {
            assert!((found - truth).abs() < 1e-6, "{eye:?}");
        }
    }
    // The look that moves the left eye's vertices turns nothing, and leaves the right eye alone.
    let [_, left, right] = avatar.meshes.as_slice() else { panic!("{named:?}") };
    assert_eq!(left.shapes[1].vertices.len(), left.positions.len());
    assert_eq!((left.positions.len(), left.triangles.len()), (right.positions.len(), 320));
    assert!(right.shapes[1].vertices.is_empty());
    assert!(avatar.eyeballs.iter().all(|e| e.looks.is_empty()));
    // What the user calls otherwise stays whole.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("head.glb");
    std::fs::write(&path, &file).unwrap();
    std::fs::write(folder.path().join("head.avatar.json"), r#"{"parts": {"Eyes": "other"}}"#)
        .unwrap();
    let other = mimique_avatar_files::read_avatar(&path).unwrap().avatar;
    assert_eq!((other.meshes.len(), other.meshes[1].part), (2, Part::Other));
}

#[test]
fn more_shapes_or_eyeballs_than_can_be_drawn_are_refused_when_read() {
    let (mut document, binary) = triangle();
    let many = |count: usize| {
        let targets: Vec<Value> = (0..count).map(|_| json!({"POSITION": 1})).collect();
        let names: Vec<String> = (0..count).map(|k| format!("s{k}")).collect();
        (json!(targets), json!(names))
    };
    for (count, fits) in [(2048, true), (2049, false)] {
        (
            document["meshes"][0]["primitives"][0]["targets"],
            document["meshes"][0]["extras"]["targetNames"],
        ) = many(count);
        let read = read_gltf(&glb(&document, &binary), "test", None);
        assert_eq!(read.is_ok(), fits, "{count} shapes");
        let says = "meshes, blendshapes: 2049 of them, at most 2048 can be drawn; leave unused";
        assert!(fits || read.unwrap_err().to_string().starts_with(says));
    }
    let (mut document, binary) = triangle();
    for (eyes, fits) in [(16, true), (17, false)] {
        let mut nodes = vec![json!({"mesh": 0, "name": "Head"})];
        nodes.extend((0..eyes).map(|_| json!({"mesh": 0, "name": "Eye_L"})));
        document["scenes"][0]["nodes"] = json!((0..=eyes).collect::<Vec<_>>());
        document["nodes"] = json!(nodes);
        let read = read_gltf(&glb(&document, &binary), "test", None);
        assert_eq!(read.is_ok(), fits, "{eyes} eyes: {read:?}");
        let says = "meshes, eyeballs: 17 of them, at most 16 can be drawn; leave layers out";
        assert!(fits || read.unwrap_err().to_string().starts_with(says));
    }
}
