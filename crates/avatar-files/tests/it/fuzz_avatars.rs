//! Damaged avatars, made by the thousand: the readers refuse or read them, never panic, and never
//! take memory that the file's size does not justify.
//!
//! Seeds are made here, one a feature; mutations are drawn from a seeded generator, so every run
//! sees the same files. `MIMIQUE_FUZZ_SECONDS=600` goes on for so long; what was run is kept in
//! `tests/records/fuzz-avatar.md`.

use std::alloc::{GlobalAlloc, Layout, System};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use mimique_avatar::pack::{encode_pack, open_plain};
use mimique_avatar_files::read_avatar_bytes;
use serde_json::{Value, json};

use crate::support::any_avatar::{Kind, consume};

/// Counts what is allocated.
struct Counted;

static NOW: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

#[allow(unsafe_code)]
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let now = NOW.fetch_add(layout.size(), Ordering::Relaxed) + layout.size();
        PEAK.fetch_max(now, Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static COUNTED: Counted = Counted;

/// Most memory that reading a file of a few kilobytes may take: a few pictures of full size.
const MOST_MEMORY: usize = 192 << 20;

/// SplitMix64 (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count.max(1) as u64) as usize
    }
}

// ---- seeds ----

fn glb(document: &Value, binary: &[u8]) -> Vec<u8> {
    let mut json = serde_json::to_vec(document).unwrap();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut out = b"glTF".to_vec();
    for word in [2, (28 + json.len() + binary.len()) as u32, json.len() as u32] {
        out.extend(word.to_le_bytes());
    }
    out.extend(b"JSON");
    out.extend(json);
    out.extend((binary.len() as u32).to_le_bytes());
    out.extend(b"BIN\0");
    out.extend(binary);
    out
}

/// A sheet of 5 x 5 with a dense and a sparse shape, a skeleton, two materials, a PNG and a JPEG.
fn rich() -> (Value, Vec<u8>) {
    let mut binary = Vec::new();
    let mut views = Vec::new();
    let mut view = |bytes: &[u8], extension: Option<Value>| {
        binary.resize(usize::next_multiple_of(binary.len(), 4), 0u8);
        let mut view = json!({"buffer": 0, "byteOffset": binary.len(), "byteLength": bytes.len()});
        if let Some(mut extension) = extension {
            extension["byteOffset"] = json!(binary.len());
            extension["byteLength"] = json!(bytes.len());
            view["extensions"] = json!({"EXT_meshopt_compression": extension});
        }
        binary.extend(bytes);
        views.push(view);
        views.len() - 1
    };
    let place =
        |v: usize| [0.03 * (v % 5) as f32, 0.04 * (v / 5) as f32, 0.001 * (v * v % 7) as f32];
    let floats = |f: &dyn Fn(usize) -> Vec<f32>| -> Vec<u8> {
        (0..25).flat_map(f).flat_map(f32::to_le_bytes).collect()
    };
    let positions = view(&floats(&|v| place(v).to_vec()), None);
    let dense = view(&floats(&|v| vec![0.0, -0.002 * (v % 3) as f32, 0.0]), None);
    let quads = (0..20).filter(|v| v % 5 < 4).flat_map(|v| [v, v + 1, v + 6, v, v + 6, v + 5]);
    let corners: Vec<u32> = quads.collect();
    let packed = meshopt::encode_index_buffer(&corners, 25).unwrap();
    let mut meshopt =
        json!({"buffer": 0, "byteStride": 2, "count": corners.len(), "mode": "TRIANGLES"});
    let indices = view(&packed, Some(meshopt.take()));
    let sparse_at = view(&[3, 0, 7, 0, 24, 0], None);
    let sparse = view(&[9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9], None);
    let vertices: Vec<[f32; 4]> = (0..25).map(|v| [0.2 * (v % 5) as f32, 0.1, 0.5, 1.0]).collect();
    let packed = meshopt::encode_vertex_buffer(&vertices).unwrap();
    let meshopt =
        json!({"buffer": 0, "byteStride": 16, "count": 25, "mode": "ATTRIBUTES", "filter": "NONE"});
    let weights = view(&packed, Some(meshopt));
    let joints = view(&[0u8, 1, 0, 1].repeat(25), None);
    let uvs = view(&floats(&|v| vec![0.25 * (v % 5) as f32, 0.25 * (v / 5) as f32]), None);
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, 8, 8);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header().unwrap().write_image_data(&[120; 256]).unwrap();
    let png = view(&png, None);
    let mut jpeg = Vec::new();
    let encoder = jpeg_encoder::Encoder::new(&mut jpeg, 80);
    encoder.encode(&[90; 768], 16, 16, jpeg_encoder::ColorType::Rgb).unwrap();
    let jpeg = view(&jpeg, None);
    let keys: Vec<u8> = [0.0_f32, 0.1, 0.3].into_iter().flat_map(f32::to_le_bytes).collect();
    let times = view(&keys, None);
    let keys: Vec<u8> = (0..6).map(|key| 0.2 * key as f32).flat_map(f32::to_le_bytes).collect();
    let moved = view(&keys, None);
    let accessor = |view: usize, component: u32, count: usize, kind: &str, normalised: bool| {
        json!({"bufferView": view, "componentType": component, "count": count, "type": kind,
            "normalized": normalised})
    };
    let primitive = |material: usize| {
        json!({"attributes": {"POSITION": 0, "TEXCOORD_0": 6, "JOINTS_0": 5, "WEIGHTS_0": 4},
            "indices": 2, "material": material, "targets": [{"POSITION": 1}, {"POSITION": 3}]})
    };
    let material = |texture: usize, mode: &str| {
        json!({"alphaMode": mode, "pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.8, 0.7, 1.0],
            "baseColorTexture": {"index": texture,
                "extensions": {"KHR_texture_transform": {"scale": [2, 1], "rotation": 0.1}}}}})
    };
    let document = json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "extensionsRequired": ["KHR_mesh_quantization", "EXT_meshopt_compression"],
        "nodes": [{"mesh": 0, "skin": 0, "name": "Head"},
            {"scale": [1, 2, 1], "children": [2]},
            {"translation": [0, 0.1, 0], "rotation": [0, 0, 0.1, 0.99]}],
        "skins": [{"joints": [1, 2]}],
        "meshes": [{"primitives": [primitive(0), primitive(1)],
            "extras": {"targetNames": ["jawOpen", "AU12_L"]}}],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}],
            "samplers": [{"input": 7, "output": 8, "interpolation": "LINEAR"}]}],
        "materials": [material(0, "MASK"), material(1, "OPAQUE")],
        "textures": [{"source": 0}, {"source": 1}],
        "images": [{"bufferView": png}, {"bufferView": jpeg}],
        "accessors": [
            accessor(positions, 5126, 25, "VEC3", false),
            accessor(dense, 5126, 25, "VEC3", false),
            accessor(indices, 5123, corners.len(), "SCALAR", false),
            {"componentType": 5122, "normalized": true, "count": 25, "type": "VEC3", "sparse": {
                "count": 3, "indices": {"bufferView": sparse_at, "componentType": 5123},
                "values": {"bufferView": sparse}}},
            accessor(weights, 5126, 25, "VEC4", false),
            accessor(joints, 5121, 25, "VEC4", false),
            accessor(uvs, 5126, 25, "VEC2", false),
            accessor(times, 5126, 3, "SCALAR", false),
            accessor(moved, 5126, 6, "SCALAR", false),
        ],
        "bufferViews": views, "buffers": [{"byteLength": binary.len()}],
    });
    (document, binary)
}

/// A mesh of four vertices and a face of four corners as text, or little-endian.
fn ply(text: bool) -> Vec<u8> {
    let order = if text { "ascii" } else { "binary_little_endian" };
    let header = format!(
        "ply\nformat {order} 1.0\ncomment a template\nelement vertex 4\nproperty float x\nproperty float y\n\
         property float z\nproperty uchar red\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    );
    let mut bytes = header.into_bytes();
    if text {
        bytes.extend(b"0 0 0 9\n0.1 0 0 9\n0.1 0.2 0 9\n0 0.2 0.01 9\n4 0 1 2 3\n");
        return bytes;
    }
    for place in [[0.0_f32, 0.0, 0.0], [0.1, 0.0, 0.0], [0.1, 0.2, 0.0], [0.0, 0.2, 0.01]] {
        bytes.extend(place.into_iter().flat_map(f32::to_le_bytes));
        bytes.push(9);
    }
    bytes.push(4);
    bytes.extend((0..4_i32).flat_map(i32::to_le_bytes));
    bytes
}

fn bank() -> Vec<(String, String)> {
    let pose = |lift: f32| {
        format!(
            "o Head\nusemtl skin\nv 0 0 0\nv 10 {lift} 0\nv 10 10 1\nv 0 10 0\nvt 0 1\nf 1/1 2 3 4\nf -4//2 -3 -2\n"
        )
    };
    vec![
        ("neutral.obj".to_owned(), pose(0.0)),
        ("smile.obj".to_owned(), pose(1.5)),
        ("skin.mtl".to_owned(), "newmtl skin\nKd 1 0.5 0.2\n".to_owned()),
        ("avatar.json".to_owned(), SETTINGS.to_owned()),
    ]
}

const SETTINGS: &str = r#"{"unit": "cm", "parts": {"skin": "skin"}, "shapes": {"smile": "AU12"},
    "vertexParts": [{"first": 3, "end": 4, "part": "socket"}], "locked": ["AU*"], "leaveOut": ["x*"]}"#;

fn zip_of(files: &[(String, String)]) -> Vec<u8> {
    use std::io::Write as _;
    let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, text) in files {
        zip.start_file(name.as_str(), zip::write::SimpleFileOptions::default()).unwrap();
        zip.write_all(text.as_bytes()).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

fn tar_of(files: &[(String, String)]) -> Vec<u8> {
    let mut tar = tar::Builder::new(Vec::new());
    for (name, text) in files {
        let mut header = tar::Header::new_ustar();
        header.set_size(text.len() as u64);
        header.set_cksum();
        tar.append_data(&mut header, name, text.as_bytes()).unwrap();
    }
    tar.into_inner().unwrap()
}

// ---- mutations ----

const NUMBERS: [&str; 14] = [
    "0",
    "1",
    "-1",
    "2",
    "255",
    "65536",
    "16777216",
    "2147483647",
    "4294967295",
    "9007199254740993",
    "18446744073709551615",
    "1e30",
    "-0.0",
    "0.5",
];

/// Bytes changed, cut, doubled or moved.
fn mutate_bytes(bytes: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..1 + random.below(4) {
        if bytes.is_empty() {
            return;
        }
        let at = random.below(bytes.len());
        let length = random.below(64).min(bytes.len() - at);
        match random.below(7) {
            0 => bytes[at] ^= 1 << random.below(8),
            1 => bytes[at] = random.next() as u8,
            2 => {
                let word = [0, 1, 0x7fff_ffff, 0x8000_0000, u32::MAX, 1 << 30][random.below(6)];
                let end = (at + 4).min(bytes.len());
                bytes[at..end].copy_from_slice(&word.to_le_bytes()[..end - at]);
            }
            3 => bytes.truncate(at),
            4 => drop(bytes.drain(at..at + length)),
            5 => {
                let part = bytes[at..at + length].to_vec();
                bytes.splice(at..at, part);
            }
            _ => {
                let part = bytes[at..at + length].to_vec();
                let to = random.below(bytes.len() - length + 1);
                bytes[to..to + length].copy_from_slice(&part);
            }
        }
    }
}

/// One value of a JSON text, reached at random, becomes another.
fn mutate_json(value: &mut Value, random: &mut Random) {
    match value {
        Value::Object(map) if !map.is_empty() && random.below(12) > 0 => {
            let key = map.keys().nth(random.below(map.len())).cloned().unwrap_or_default();
            match random.below(40) {
                0 => drop(map.remove(&key)),
                _ => map.get_mut(&key).into_iter().for_each(|v| mutate_json(v, random)),
            }
        }
        Value::Array(list) if !list.is_empty() && random.below(12) > 0 => {
            let index = random.below(list.len());
            match random.below(30) {
                0 => drop(list.remove(index)),
                1 => list.push(list[index].clone()),
                _ => mutate_json(&mut list[index], random),
            }
        }
        value => {
            *value = match random.below(8) {
                0 => Value::Null,
                1 => json!("skin"),
                2 => json!([]),
                3 => json!(true),
                _ => serde_json::from_str(NUMBERS[random.below(NUMBERS.len())]).unwrap(),
            }
        }
    }
}

/// The next file: whole container formats, and what is inside them.
fn next(random: &mut Random, seeds: &Seeds) -> (Kind, Vec<u8>) {
    let (mut document, mut binary) = seeds.rich.clone();
    match random.below(9) {
        0 => {
            let mut bytes = seeds.glb.clone();
            mutate_bytes(&mut bytes, random);
            (Kind::Gltf, bytes)
        }
        1 | 2 => {
            (0..1 + random.below(3)).for_each(|_| mutate_json(&mut document, random));
            (Kind::Gltf, glb(&document, &binary))
        }
        3 => {
            mutate_bytes(&mut binary, random);
            (Kind::Gltf, glb(&document, &binary))
        }
        4 => {
            let archives = [&seeds.zip, &seeds.tar, &seeds.tar_gz, &seeds.tar_xz];
            let mut bytes = archives[random.below(4)].clone();
            mutate_bytes(&mut bytes, random);
            (Kind::Bank, bytes)
        }
        5 => {
            let mut files = bank();
            let index = random.below(files.len());
            let mut bytes = files[index].1.clone().into_bytes();
            mutate_bytes(&mut bytes, random);
            files[index].1 = String::from_utf8_lossy(&bytes).into_owned();
            (Kind::Bank, tar_of(&files))
        }
        7 => {
            let mut bytes = [ply(true), ply(false)][random.below(2)].clone();
            mutate_bytes(&mut bytes, random);
            (Kind::Template, bytes)
        }
        6 => {
            let mut value: Value = serde_json::from_str(SETTINGS).unwrap();
            mutate_json(&mut value, random);
            let mut bytes = value.to_string().into_bytes();
            if random.below(4) == 0 {
                mutate_bytes(&mut bytes, random);
            }
            (Kind::Settings, bytes)
        }
        _ => {
            let mut bytes = [&seeds.pack, &seeds.pack_body][random.below(2)].clone();
            mutate_bytes(&mut bytes, random);
            (Kind::Pack, bytes)
        }
    }
}

struct Seeds {
    rich: (Value, Vec<u8>),
    glb: Vec<u8>,
    zip: Vec<u8>,
    tar: Vec<u8>,
    tar_gz: Vec<u8>,
    tar_xz: Vec<u8>,
    pack: Vec<u8>,
    pack_body: Vec<u8>,
}

impl Seeds {
    fn new() -> Self {
        use std::io::Write as _;
        let rich = rich();
        let glb = glb(&rich.0, &rich.1);
        let avatar = read_avatar_bytes(glb.clone(), "seed", None, None).unwrap().avatar;
        assert_eq!((avatar.textures.len(), avatar.shape_names.len()), (2, 2));
        let tar = tar_of(&bank());
        let zip = zip_of(&bank());
        // Packed by XZ Utils; its poses are those of the others.
        let tar_xz = include_bytes!("../../../../fuzz/corpus/avatar_file/seed-tar-xz").to_vec();
        for seed in [&tar, &zip, &tar_xz] {
            let read = read_avatar_bytes(seed.clone(), "seed", None, None).unwrap();
            assert_eq!(read.locked, ["AU12"]);
        }
        let mut gz = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        gz.write_all(&tar).unwrap();
        let pack = encode_pack(&avatar).bytes;
        let files = avatar.textures.iter().map(|t| t.jpeg.len() + t.mask_jpeg.len() + 8);
        let behind = files.sum::<usize>() + 4;
        let pack_body = open_plain("MMAV", 4, &pack[..pack.len() - behind]).unwrap().to_vec();
        Self { rich, glb, zip, tar, tar_gz: gz.finish().unwrap(), tar_xz, pack, pack_body }
    }
}

/// What the fuzzer that sees coverage begins with and has found; `MIMIQUE_FUZZ_WRITE=1` writes the
/// seeds anew.
#[test]
fn the_corpus_of_the_fuzzer_is_replayed() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus");
    let folders = [
        ("avatar_file", Kind::Gltf),
        ("avatar_pack", Kind::Pack),
        ("avatar_settings", Kind::Settings),
    ];
    if std::env::var_os("MIMIQUE_FUZZ_WRITE").is_some() {
        let seeds = Seeds::new();
        for (name, bytes) in [
            ("avatar_file/seed-glb", &seeds.glb),
            ("avatar_file/seed-zip", &seeds.zip),
            ("avatar_file/seed-tar", &seeds.tar),
            ("avatar_file/seed-tar-gz", &seeds.tar_gz),
            ("avatar_file/seed-ply-text", &ply(true)),
            ("avatar_file/seed-ply-binary", &ply(false)),
            ("avatar_settings/seed-all-keys", &SETTINGS.as_bytes().to_vec()),
            ("avatar_settings/seed-one-pattern", &br#"{"parts": {"h*d": "eyeLeft"}}"#.to_vec()),
            ("avatar_pack/seed-pack", &seeds.pack),
            ("avatar_pack/seed-body", &seeds.pack_body),
        ] {
            let path = corpus.join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, bytes).unwrap();
        }
    }
    for (folder, kind) in folders {
        let files = std::fs::read_dir(corpus.join(folder)).unwrap();
        let mut count = 0;
        for file in files {
            consume(kind, &std::fs::read(file.unwrap().path()).unwrap());
            count += 1;
        }
        assert!(count > 1, "{folder} holds no seeds");
    }
}

#[test]
fn damaged_avatars_are_refused_within_bounds() {
    let seeds = Seeds::new();
    let seconds = std::env::var("MIMIQUE_FUZZ_SECONDS").ok().and_then(|s| s.parse().ok());
    let first: u64 =
        std::env::var("MIMIQUE_FUZZ_SEED").ok().and_then(|s| s.parse().ok()).unwrap_or(1);
    let until = Instant::now() + Duration::from_secs(seconds.unwrap_or(0));
    let mut worst = 0;
    let mut seed = first;
    while seed < first + 20_000 || Instant::now() < until {
        let mut random = Random(seed);
        let (kind, bytes) = next(&mut random, &seeds);
        let before = NOW.load(Ordering::Relaxed);
        PEAK.store(before, Ordering::Relaxed);
        let done = std::panic::catch_unwind(|| consume(kind, &bytes));
        assert!(done.is_ok(), "MIMIQUE_FUZZ_SEED={seed} panics, {} bytes", bytes.len());
        let taken = PEAK.load(Ordering::Relaxed).saturating_sub(before);
        assert!(
            taken <= MOST_MEMORY,
            "MIMIQUE_FUZZ_SEED={seed}: {taken} bytes for {}",
            bytes.len()
        );
        worst = worst.max(taken);
        seed += 1;
    }
    eprintln!("{} files, {worst} bytes of memory at most", seed - first);
}
