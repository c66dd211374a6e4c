//! glTF files made here: quantised and compressed geometry, skeletons, textures.

use mimique_avatar::pack::{decode_pack, encode_pack};
use mimique_avatar::{Image, Part};
use mimique_avatar_files::{AvatarSettings, ReadAvatar, read_avatar_bytes, read_gltf};
use serde_json::{Value, json};

/// A glTF document under construction.
struct Builder {
    document: Value,
    binary: Vec<u8>,
}

impl Builder {
    fn new() -> Self {
        let document = json!({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0, "name": "Head"}], "buffers": [{}], "bufferViews": [], "accessors": [],
            "meshes": [{"primitives": [{"attributes": {}, "targets": [{}]}],
                        "extras": {"targetNames": ["jawOpen"]}}],
        });
        Self { document, binary: Vec::new() }
    }

    fn view(&mut self, bytes: &[u8], stride: Option<usize>) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let mut view =
            json!({"buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len()});
        if let Some(stride) = stride {
            view["byteStride"] = json!(stride);
        }
        self.binary.extend(bytes);
        self.push("bufferViews", view)
    }

    fn accessor(
        &mut self,
        view: usize,
        component: u32,
        count: usize,
        kind: &str,
        normalised: bool,
    ) -> usize {
        let accessor = json!({"bufferView": view, "componentType": component, "count": count,
            "type": kind, "normalized": normalised});
        self.push("accessors", accessor)
    }

    fn floats(&mut self, values: &[f32], numbers: usize, kind: &str) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        let view = self.view(&bytes, None);
        self.accessor(view, 5126, values.len() / numbers, kind, false)
    }

    fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.document.as_object_mut().unwrap().entry(list).or_insert(json!([]));
        let list = list.as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    fn primitive(&mut self) -> &mut Value {
        &mut self.document["meshes"][0]["primitives"][0]
    }

    fn glb(&self) -> Vec<u8> {
        let mut document = self.document.clone();
        document["buffers"][0]["byteLength"] = json!(self.binary.len());
        let mut json = serde_json::to_vec(&document).unwrap();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut out = b"glTF".to_vec();
        let total = 12 + 8 + json.len() + 8 + self.binary.len();
        for word in [2, total as u32, json.len() as u32] {
            out.extend(word.to_le_bytes());
        }
        out.extend(b"JSON");
        out.extend(json);
        out.extend((self.binary.len() as u32).to_le_bytes());
        out.extend(b"BIN\0");
        out.extend(&self.binary);
        out
    }

    fn read(&self) -> ReadAvatar {
        read_gltf(&self.glb(), "made", None).unwrap()
    }

    fn refusal(&self) -> String {
        read_gltf(&self.glb(), "made", None).unwrap_err().to_string()
    }
}

/// A square of 0.2 m as two triangles whose lower corners drop by 0.02 m with the jaw.
fn square() -> Builder {
    let mut b = Builder::new();
    let positions = [0.0, 0.0, 0.0, 0.2, 0.0, 0.0, 0.2, 0.2, 0.0, 0.0, 0.2, 0.0];
    let jaw = [0.0, -0.02, 0.0, 0.0, -0.02, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let (positions, jaw) = (b.floats(&positions, 3, "VEC3"), b.floats(&jaw, 3, "VEC3"));
    let indices = b.view(&[0, 0, 1, 0, 2, 0, 0, 0, 2, 0, 3, 0], None);
    let indices = b.accessor(indices, 5123, 6, "SCALAR", false);
    *b.primitive() = json!({"attributes": {"POSITION": positions}, "indices": indices,
        "targets": [{"POSITION": jaw}]});
    b
}

fn near(p: [f32; 3], q: [f32; 3], tolerance: f32) -> bool {
    (0..3).all(|a| (p[a] - q[a]).abs() <= tolerance)
}

#[test]
fn quantised_positions_are_scaled_by_their_node() {
    let mut b = square();
    // KHR_mesh_quantization: 16-bit positions padded to eight bytes, 8-bit normalised deltas.
    let corners: [[u16; 4]; 4] =
        [[0, 0, 0, 0], [2000, 0, 0, 0], [2000, 2000, 0, 0], [0, 2000, 0, 0]];
    let bytes: Vec<u8> = corners.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let view = b.view(&bytes, Some(8));
    let positions = b.accessor(view, 5123, 4, "VEC3", false);
    let deltas: [i8; 16] = [0, -127, 0, 0, 0, -127, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
    let view = b.view(bytemuck::cast_slice(&deltas), Some(4));
    let jaw = b.accessor(view, 5120, 4, "VEC3", true);
    b.primitive()["attributes"]["POSITION"] = json!(positions);
    b.primitive()["targets"] = json!([{"POSITION": jaw}]);
    b.document["nodes"][0]["scale"] = json!([1e-4, 1e-4, 1e-4]);
    b.document["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let mesh = &b.read().avatar.meshes[0];
    assert!(near(mesh.positions[2], [0.2, 0.2, 0.0], 1e-6), "{:?}", mesh.positions);
    assert_eq!(mesh.shapes[0].vertices, [0, 1]);
    assert!(near(mesh.shapes[0].deltas[0], [0.0, -1e-4, 0.0], 1e-9), "{:?}", mesh.shapes[0]);
}

/// `square` with its positions, deltas and indices compressed.
fn compressed(filter: &str) -> Builder {
    let mut b = square();
    let plain = b.binary.clone();
    let words = |at: usize| -> Vec<[u32; 3]> {
        let word = |i: usize| u32::from_le_bytes(plain[i..i + 4].try_into().unwrap());
        (0..4).map(|v| [0, 4, 8].map(|k| word(at + 12 * v + k))).collect()
    };
    // The exponential filter's numbers: a power of two in the upper byte, 24 bits of mantissa.
    let exponential = |x: u32| {
        let mantissa = (f64::from(f32::from_bits(x)) * f64::from(1 << 20)).round() as i32;
        (mantissa as u32 & 0xff_ffff) | ((-20i32 as u32) << 24)
    };
    let filtered = |list: Vec<[u32; 3]>| match filter {
        "NONE" => list,
        _ => list.into_iter().map(|v| v.map(exponential)).collect(),
    };
    let positions = meshopt::encode_vertex_buffer(&filtered(words(0))).unwrap();
    let jaw = meshopt::encode_vertex_buffer(&filtered(words(48))).unwrap();
    let indices = meshopt::encode_index_buffer(&[0, 1, 2, 0, 2, 3], 4).unwrap();
    b.binary.clear();
    b.document["bufferViews"] = json!([]);
    b.document["buffers"] = json!([{}, {"byteLength": 108,
        "extensions": {"EXT_meshopt_compression": {"fallback": true}}}]);
    let parts = [
        (positions, 4, 12, "ATTRIBUTES"),
        (jaw, 4, 12, "ATTRIBUTES"),
        (indices, 6, 2, "TRIANGLES"),
    ];
    for (i, (bytes, count, stride, mode)) in parts.into_iter().enumerate() {
        let at = b.binary.len();
        b.binary.extend(&bytes);
        b.binary.resize(b.binary.len().next_multiple_of(4), 0);
        let filter = if mode == "ATTRIBUTES" { filter } else { "NONE" };
        b.push(
            "bufferViews",
            json!({
                "buffer": 1, "byteOffset": 48 * i, "byteLength": count * stride,
                "extensions": {"EXT_meshopt_compression": {
                    "buffer": 0, "byteOffset": at, "byteLength": bytes.len(), "byteStride": stride,
                    "count": count, "mode": mode, "filter": filter
                }}
            }),
        );
    }
    b.document["extensionsRequired"] = json!(["EXT_meshopt_compression"]);
    b
}

#[test]
fn meshopt_compression_is_unpacked_and_its_damage_refused() {
    let plain = square().read().avatar;
    assert_eq!(compressed("NONE").read().avatar, plain);
    let filtered = compressed("EXPONENTIAL").read().avatar;
    assert_eq!(filtered.meshes[0].triangles, plain.meshes[0].triangles);
    for (p, q) in filtered.meshes[0].positions.iter().zip(&plain.meshes[0].positions) {
        assert!(near(*p, *q, 1e-6), "{p:?} {q:?}");
    }
    type Damage = fn(&mut Value);
    let cases: [(&str, Damage); 8] = [
        ("count is missing", |e| drop(e.as_object_mut().unwrap().remove("count"))),
        ("fit", |e| e["count"] = json!(u64::MAX / 2)),
        ("fit", |e| e["count"] = json!(1u64 << 40)),
        ("of 13 bytes", |e| e["byteStride"] = json!(13)),
        ("mode \"SPHERES\"", |e| e["mode"] = json!("SPHERES")),
        ("filter SHARP", |e| e["filter"] = json!("SHARP")),
        ("buffer 7 does not exist", |e| e["buffer"] = json!(7)),
        ("asks for 4000000000 bytes", |e| e["byteLength"] = json!(4_000_000_000u32)),
    ];
    for (says, damage) in cases {
        let mut b = compressed("NONE");
        damage(&mut b.document["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]);
        let error = b.refusal();
        assert!(error.contains("bufferViews[0]") && error.contains(says), "{says}: {error}");
    }
    let whole = compressed("NONE");
    for at in 0..whole.binary.len() {
        let mut damaged = compressed("NONE");
        damaged.binary[at] ^= 0x55;
        let _ = read_gltf(&damaged.glb(), "made", None);
    }
}

#[test]
fn draco_is_refused_by_name() {
    let mut b = square();
    b.primitive()["extensions"] =
        json!({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {}}});
    let error = b.refusal();
    assert!(error.starts_with("meshes[0].primitives[0]: compressed with KHR_draco"), "{error}");
    let mut b = square();
    b.document["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    assert!(b.refusal().contains("the extension KHR_draco_mesh_compression"), "{}", b.refusal());
}

#[test]
fn a_skeleton_places_the_skin_and_its_shapes() {
    let mut b = square();
    let plain = b.read().avatar;
    // An armature as exporters write it: joints in centimetres turned a quarter about x, and
    // inverse bind matrices that undo it; the mesh's own node must have no say.
    let half = 0.5f32.sqrt();
    let root =
        b.push("nodes", json!({"scale": [0.01, 0.01, 0.01], "rotation": [half, 0, 0, half]}));
    let joint = b.push("nodes", json!({"translation": [0, 5, 0]}));
    b.document["nodes"][root]["children"] = json!([joint]);
    b.document["scenes"][0]["nodes"] = json!([0, root]);
    // World of the root: y to z, z to -y, times 0.01; of the joint: the same, 0.05 m along z.
    let (of_root, of_joint) = (
        [100.0, 0.0, 0.0, 0.0, 0.0, 0.0, -100.0, 0.0, 0.0, 100.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        [100.0, 0.0, 0.0, 0.0, 0.0, 0.0, -100.0, 0.0, 0.0, 100.0, 0.0, 0.0, 0.0, -5.0, 0.0, 1.0],
    );
    let bind = b.floats(&[of_root, of_joint].concat(), 16, "MAT4");
    b.push("skins", json!({"joints": [root, joint], "inverseBindMatrices": bind}));
    b.document["nodes"][0]["skin"] = json!(0);
    b.document["nodes"][0]["translation"] = json!([9, 9, 9]);
    let joints = b.view(&[0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0], None);
    let joints = b.accessor(joints, 5121, 4, "VEC4", false);
    let shares = [0.25, 0.75, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.5, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let shares = b.floats(&shares, 4, "VEC4");
    b.primitive()["attributes"]["JOINTS_0"] = json!(joints);
    b.primitive()["attributes"]["WEIGHTS_0"] = json!(shares);
    let posed = b.read();
    for (p, q) in posed.avatar.meshes[0].positions.iter().zip(&plain.meshes[0].positions) {
        assert!(near(*p, *q, 1e-6), "{p:?} {q:?}");
    }
    let (a, c) = (&posed.avatar.meshes[0].shapes[0], &plain.meshes[0].shapes[0]);
    assert!(near(a.deltas[0], c.deltas[0], 1e-7), "{a:?}");
    assert!(posed.notes.iter().any(|n| n.contains("skeleton")), "{:?}", posed.notes);

    b.document["skins"][0]["joints"] = json!([root, 99]);
    assert!(b.refusal().contains("skins[0]: joint 1 is node 99"), "{}", b.refusal());
    b.document["skins"][0]["joints"] = json!([root]);
    assert!(b.refusal().contains("joint 1 of 1"), "{}", b.refusal());
}

fn png(width: u32, height: u32, rgba: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().unwrap().write_image_data(rgba).unwrap();
    out
}

/// Two halves, red and blue; the blue one open by half.
fn halves(side: u32) -> Vec<u8> {
    let texel = |i: u32| if i % side < side / 2 { [200, 20, 20, 255] } else { [20, 20, 200, 128] };
    png(side, side, &(0..side * side).flat_map(texel).collect::<Vec<u8>>())
}

fn textured(picture: &[u8]) -> Builder {
    let mut b = square();
    let view = b.view(picture, None);
    b.push("images", json!({"bufferView": view}));
    b.push("textures", json!({"source": 0}));
    b.push(
        "materials",
        json!({"name": "skin", "pbrMetallicRoughness":
        {"baseColorTexture": {"index": 0}, "baseColorFactor": [1, 0.5, 1, 1]}}),
    );
    let uvs = b.floats(&[0.25, 1.0, 0.75, 1.0, 0.75, 0.0, 0.25, 0.0], 2, "VEC2");
    b.primitive()["attributes"]["TEXCOORD_0"] = json!(uvs);
    b.primitive()["material"] = json!(0);
    b
}

#[test]
fn png_textures_travel_through_the_pack() {
    let avatar = textured(&halves(32)).read().avatar;
    let mesh = &avatar.meshes[0];
    assert_eq!(mesh.base_colour, [1.0, 0.5, 1.0]);
    assert_eq!(mesh.textured[0].triangles, 0..2);
    let image = Image::decode(&avatar.textures[0]).unwrap();
    assert_eq!((image.width, image.height), (32, 32));
    let [r, g, b] = image.linear_at([0.1, 0.5]);
    assert!(r > 0.5 && g < 0.02 && b < 0.02, "{r} {g} {b}");
    assert!(image.rgba.chunks_exact(4).all(|p| p[3] == 255), "opaque materials have no holes");

    let back = decode_pack(&encode_pack(&avatar).bytes).unwrap();
    assert_eq!(back.textures, avatar.textures);
    assert_eq!(back.meshes[0].textured, mesh.textured);
    for (a, b) in back.meshes[0].uvs.iter().zip(&mesh.uvs) {
        assert!((a[0] - b[0]).abs() < 4e-5 && (a[1] - b[1]).abs() < 4e-5, "{a:?} {b:?}");
    }
    let mut open = textured(&halves(32));
    open.document["materials"][0]["alphaMode"] = json!("MASK");
    let avatar = open.read().avatar;
    let image = Image::decode(&avatar.textures[0]).unwrap();
    assert!((i32::from(image.rgba[4 * 30 + 3]) - 128).abs() < 6, "{}", image.rgba[4 * 30 + 3]);
}

/// What does not change the face's shape may be required: the picture is passed over, and named.
#[test]
fn pictures_in_other_formats_and_lights_are_passed_over() {
    let mut b = textured(b"RIFF....WEBPVP8 ");
    b.document["extensionsRequired"] = json!(["EXT_texture_webp", "KHR_lights_punctual"]);
    b.document["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "point"}]}});
    b.document["textures"][0] = json!({"extensions": {"EXT_texture_webp": {"source": 0}}});
    let read = b.read();
    assert_eq!(read.avatar.meshes[0].base_colour, [1.0, 0.5, 1.0]);
    assert!(read.avatar.textures.is_empty());
    let note = "textures[0] has its picture by EXT_texture_webp alone, which is not read: its surface keeps its \
                plain colour";
    assert!(read.notes.iter().any(|n| n == note), "{:?}", read.notes);
    b.document["textures"][0] = json!({"extensions": {"KHR_texture_basisu": {"source": 0}}});
    b.document["extensionsRequired"] = json!(["KHR_texture_basisu"]);
    assert!(b.read().notes.iter().any(|n| n.contains("by KHR_texture_basisu alone")));
    // A source beside the extension's is read.
    let mut both = textured(&halves(32));
    both.document["textures"][0]["extensions"] = json!({"EXT_texture_webp": {"source": 9}});
    assert_eq!(both.read().avatar.textures.len(), 1);
    let mut missing = textured(&halves(32));
    missing.document["textures"][0]["source"] = json!(7);
    assert!(
        missing.refusal().contains("images[7]: the image does not exist"),
        "{}",
        missing.refusal()
    );
}

#[test]
fn jpeg_textures_travel_as_they_are() {
    let mut jpeg = Vec::new();
    let rgb: Vec<u8> = (0..64 * 48u32).flat_map(|i| [(i % 64 * 4) as u8, 99, 30]).collect();
    let encoder = jpeg_encoder::Encoder::new(&mut jpeg, 90);
    encoder.encode(&rgb, 64, 48, jpeg_encoder::ColorType::Rgb).unwrap();
    let avatar = textured(&jpeg).read().avatar;
    assert_eq!(avatar.textures[0].jpeg, jpeg);
    // A camera's notes, which may turn the picture, and a comment stay behind.
    let mut noted = jpeg[..2].to_vec();
    noted.extend(b"\xff\xe1\x00\x08Exif\x00\x00\xff\xfe\x00\x04me");
    noted.extend(&jpeg[2..]);
    assert_eq!(textured(&noted).read().avatar.textures[0].jpeg, jpeg);
    assert!(
        textured(&jpeg[..jpeg.len() / 2]).refusal().contains("images[0]: a JPEG picture that ends")
    );
}

#[test]
fn large_textures_are_made_smaller() {
    let avatar = textured(&halves(2560)).read().avatar;
    let image = Image::decode(&avatar.textures[0]).unwrap();
    assert_eq!((image.width, image.height), (1280, 1280));
    let pack = encode_pack(&avatar).bytes.len();
    assert!(pack < 100_000, "{pack} bytes");
}

#[test]
fn textures_of_eyes_colour_their_vertices() {
    let mut b = textured(&halves(32));
    let mut eye = b.document["meshes"][0].clone();
    eye["name"] = json!("EyeLeft");
    b.push("meshes", eye);
    b.push("nodes", json!({"mesh": 1, "name": "EyeLeft"}));
    b.document["scenes"][0]["nodes"] = json!([0, 1]);
    let avatar = b.read().avatar;
    let eye = avatar.meshes.iter().find(|m| m.part == Part::EyeLeft).unwrap();
    assert!(eye.textured.is_empty());
    assert!(
        eye.vertex_colours[0][0] > 0.5 && eye.vertex_colours[1][2] > 0.5,
        "{:?}",
        eye.vertex_colours
    );
}

#[test]
fn places_in_pictures_are_transformed_and_checked() {
    let mut b = textured(&halves(32));
    b.document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] =
        json!({"KHR_texture_transform": {"scale": [0.5, 0.5], "offset": [0.25, 0]}});
    b.document["extensionsRequired"] = json!(["KHR_texture_transform"]);
    assert_eq!(b.read().avatar.meshes[0].uvs[0], [0.375, 0.5]);
    b.document["textures"] = json!([]);
    assert!(b.refusal().contains("texture 0 does not exist"), "{}", b.refusal());
    // An image that is neither PNG nor JPEG is reported, and the plain colour stays.
    let read = textured(b"RIFF....WEBPVP8 ").read();
    assert!(read.avatar.textures.is_empty() && read.avatar.meshes[0].textured.is_empty());
    assert!(read.notes.iter().any(|n| n.contains("images[0] is no PNG")), "{:?}", read.notes);
    let cut = halves(32);
    let error = textured(&cut[..cut.len() / 2]).refusal();
    assert!(error.starts_with("images[0]: a PNG picture"), "{error}");
    // A PNG that declares a gigabyte.
    let mut vast = halves(32);
    vast[16..24].copy_from_slice(&[0, 0, 0x40, 0, 0, 0, 0x40, 0]);
    assert!(textured(&vast).refusal().contains("images[0]"), "{}", textured(&vast).refusal());
}

#[test]
fn settings_beside_a_glb_are_obeyed() {
    let settings = r#"{"parts": {"Head": "skin", "*": "socket"}, "shapes": {"jawOpen": "AU26"},
        "locked": ["AU26"], "unit": "cm"}"#;
    let settings = AvatarSettings::from_json("made.avatar.json", settings.as_bytes()).unwrap();
    let read = read_avatar_bytes(square().glb(), "made", None, Some(settings)).unwrap();
    // The pattern with the most letters counts.
    assert_eq!(read.avatar.meshes[0].part, Part::Skin);
    assert_eq!((read.unit_metres, read.locked), (0.01, vec!["AU26".to_owned()]));
    assert!(near(read.avatar.meshes[0].positions[2], [0.002, 0.002, 0.0], 1e-9));
}
