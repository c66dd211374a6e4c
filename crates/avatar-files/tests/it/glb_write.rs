//! What is written as GLB is read back as it was.

use mimique_actor::{HeadSpec, build_head, performance_weights};
use mimique_avatar::{Avatar, Part};
use mimique_avatar_files::{read_avatar_bytes, write_glb};

fn head() -> Avatar {
    build_head(&HeadSpec { density: mimique_actor::Density::nearest(2_000), ..HeadSpec::default() })
}

#[test]
fn the_head_comes_back_with_its_shapes() {
    let head = head();
    let glb = write_glb(&head, &[], 60.0).unwrap();
    let back = read_avatar_bytes(glb, "head", None, None).unwrap().avatar;
    assert_eq!(back.shape_names, head.shape_names);
    assert_eq!(back.meshes.len(), head.meshes.len());
    for (a, b) in head.meshes.iter().zip(&back.meshes) {
        assert_eq!((&a.name, a.part), (&b.name, b.part));
        assert_eq!(a.triangles.len(), b.triangles.len(), "{}", a.name);
        if a.part == Part::Skin {
            assert_eq!(a.positions, b.positions, "{}", a.name);
            assert_eq!(a.triangles, b.triangles, "{}", a.name);
        }
        // Hair and skin keep what is painted on them.
        if a.vertex_colours.is_empty() {
            assert_eq!(a.base_colour, b.base_colour, "{}", a.name);
        }
        assert_eq!(a.vertex_colours.len(), b.vertex_colours.len(), "{}", a.name);
        for (x, y) in a.vertex_colours.iter().zip(&b.vertex_colours) {
            assert_eq!(x.map(|c| c.clamp(0.0, 1.0)), *y, "{}", a.name);
        }
        for (name, (x, y)) in head.shape_names.iter().zip(a.shapes.iter().zip(&b.shapes)) {
            assert_eq!(x, y, "{} {name}", a.name);
        }
        for (p, q) in a.positions.iter().zip(&b.positions) {
            let apart = (0..3).map(|i| (p[i] - q[i]).abs()).fold(0.0, f32::max);
            assert!(apart < 1e-7, "{}: {apart}", a.name);
        }
    }
}

#[test]
fn the_animation_holds_every_frame_and_turns_the_eyes() {
    let head = head();
    let clip = mimique_actor::Clip { emotion: mimique_actor::Emotion::Fear, intensity: 3, seed: 4 };
    let played = performance_weights(&head.shape_names, &clip, 50.0, 2.0);
    let weights: Vec<f32> = played.weights.iter().map(|w| *w as f32).collect();
    let frames = weights.len() / head.shape_names.len();
    let glb = write_glb(&head, &weights, 50.0).unwrap();
    let file = gltf::Glb::from_slice(&glb).unwrap();
    let document: serde_json::Value = serde_json::from_slice(&file.json).unwrap();
    let animation = &document["animations"][0];
    let channels = animation["channels"].as_array().unwrap();
    let paths = |path: &str| channels.iter().filter(|c| c["target"]["path"] == path).count();
    assert_eq!(paths("rotation"), 2);
    assert!(paths("weights") >= 3);
    let sampler = &animation["samplers"][0];
    let accessor = |of: &serde_json::Value| &document["accessors"][of.as_u64().unwrap() as usize];
    assert_eq!(accessor(&sampler["input"])["count"], frames);
    assert_eq!(accessor(&sampler["output"])["count"], weights.len());
    let end = accessor(&sampler["input"])["max"][0].as_f64().unwrap();
    assert!((end - (frames - 1) as f64 / 50.0).abs() < 1e-5);
    let view = accessor(&sampler["output"])["bufferView"].as_u64().unwrap() as usize;
    let at = document["bufferViews"][view]["byteOffset"].as_u64().unwrap() as usize;
    let binary = file.bin.unwrap();
    let first = &binary[at..at + 4 * weights.len()];
    let read: Vec<f32> =
        first.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
    assert_eq!(read, weights);
    // A reader that checks everything takes it.
    gltf::Gltf::from_slice(&glb).unwrap();
}

#[test]
fn what_is_no_animation_is_refused() {
    let head = head();
    let error = write_glb(&head, &[0.0; 7], 60.0).unwrap_err().to_string();
    assert!(error.contains("7 for 57"), "{error}");
    assert!(write_glb(&head, &[], 0.0).unwrap_err().to_string().contains("0 Hz"));
}
