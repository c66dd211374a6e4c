//! Real avatars through the glTF reader.

use mimique_avatar::Part;
use mimique_avatar::pack::{decode_pack, encode_pack};
use mimique_avatar_files::read_avatar;
use mimique_test_support::real_data;

#[test]
fn ict_facekit_has_its_parts_shapes_and_turning_eyes() {
    let Some(root) = real_data("ict_facekit_has_its_parts_shapes_and_turning_eyes") else { return };
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
fn ict_facekit_packs_small_and_true() {
    let Some(root) = real_data("ict_facekit_packs_small_and_true") else { return };
    let avatar = read_avatar(&root.join("ict-facekit/ict-facekit.glb")).unwrap().avatar;
    let pack = encode_pack(&avatar);
    eprintln!("{} bytes, {:.2} um at most", pack.bytes.len(), pack.error_bound * 1e6);
    assert!(pack.bytes.len() <= 2_500_000);
    assert!(pack.error_bound <= 1e-5);
    let back = decode_pack(&pack.bytes).unwrap();
    assert_eq!(back.shape_names, avatar.shape_names);
    assert_eq!(back.eyeballs, avatar.eyeballs);
    // Every shape alone, and some mixtures.
    let mut poses: Vec<Vec<f64>> =
        (0..53).map(|k| (0..53).map(|j| f64::from(u8::from(j == k))).collect()).collect();
    for m in 1..6 {
        poses.push((0..53).map(|j| f64::from((j * m * 7) % 11) / 10.0).collect());
    }
    let mut worst = 0f64;
    for weights in &poses {
        for (a, b) in avatar.meshes.iter().zip(&back.meshes) {
            for (p, q) in a.posed(weights).iter().zip(&b.posed(weights)) {
                let square: f64 = (0..3).map(|k| f64::from(p[k] - q[k]).powi(2)).sum();
                worst = worst.max(square.sqrt());
            }
        }
    }
    eprintln!("{:.2} um at most in {} poses", worst * 1e6, poses.len());
    assert!(worst < 1e-5);
}
