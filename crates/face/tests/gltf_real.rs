//! Real avatars through the glTF reader.

use std::path::PathBuf;

use mimique_face::{Part, read_avatar};

/// The real data, or `None` after saying that the test is skipped.
fn data(test: &str) -> Option<PathBuf> {
    let root = std::env::var_os("MIMIQUE_DATA").map_or_else(
        || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data")),
        PathBuf::from,
    );
    if root.is_dir() {
        return Some(root);
    }
    assert!(
        std::env::var_os("MIMIQUE_NO_SKIP").is_none_or(|v| v != "1"),
        "{test}: real data not found at {}",
        root.display()
    );
    eprintln!("SKIPPED {test}: real data not found at {}; set MIMIQUE_DATA", root.display());
    None
}

#[test]
fn ict_facekit_has_its_parts_shapes_and_turning_eyes() {
    let Some(root) = data("ict_facekit_has_its_parts_shapes_and_turning_eyes") else { return };
    let read = read_avatar(&root.join("ict-facekit/ict-facekit.glb")).unwrap();
    let avatar = &read.avatar;
    assert_eq!(avatar.shape_names.len(), 53);
    assert_eq!(avatar.shape_names[0], "browDown_L");
    assert_eq!(read.unit_metres, 1.0);
    let parts: Vec<Part> = avatar.meshes.iter().map(|m| m.part).collect();
    assert_eq!(
        parts,
        [
            Part::Skin,
            Part::Socket,
            Part::Tongue,
            Part::Teeth,
            Part::EyeLeft,
            Part::EyeRight,
            Part::EyeOverlay,
            Part::Lashes
        ]
    );
    assert_eq!(avatar.meshes[0].positions.len(), 11_925);
    assert!((avatar.meshes[0].base_colour[0] - 0.8).abs() < 1e-6);

    assert_eq!(avatar.eyeballs.len(), 2);
    for (eye, side) in avatar.eyeballs.iter().zip([1.0, -1.0]) {
        assert!(eye.centre[0] * side > 0.02, "{:?}", eye.centre);
        assert_eq!(eye.looks.len(), 4);
        // Every point of the eyeball is about as far from the centre as any other.
        let radii: Vec<f32> = avatar.meshes[eye.mesh]
            .positions
            .iter()
            .map(|p| (0..3).map(|a| (p[a] - eye.centre[a]).powi(2)).sum::<f32>().sqrt())
            .collect();
        let mean = radii.iter().sum::<f32>() / radii.len() as f32;
        eprintln!("eyeball {:?} radius {mean}", eye.centre);
        assert!((0.009..0.016).contains(&mean), "radius {mean} m");
    }
}

#[test]
fn size() {
    let Some(root) = data("size") else { return };
    let read = read_avatar(&root.join("ict-facekit/ict-facekit.glb")).unwrap();
    let n: usize =
        read.avatar.meshes.iter().flat_map(|m| &m.shapes).map(|s| s.vertices.len()).sum();
    let t = std::time::Instant::now();
    let pack = mimique_face::pack::encode_pack(&read.avatar);
    eprintln!(
        "{n} entries {} bytes bound {} in {:?}",
        pack.bytes.len(),
        pack.error_bound,
        t.elapsed()
    );
    let t = std::time::Instant::now();
    let back = mimique_face::pack::decode_pack(&pack.bytes).unwrap();
    eprintln!("decode {:?}", t.elapsed());
    assert_eq!(back.shape_names, read.avatar.shape_names);
}
