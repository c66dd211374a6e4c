//! Where the camera stands: the landmarks of made and real heads, with eyes and without.

use mimique_actor::{HeadSpec, Identity, build_head};
use mimique_avatar::{Avatar, Part};
use mimique_avatar_files::read_avatar;
use mimique_stage::Landmarks;

use crate::support;

fn heads(test: &str) -> Vec<Avatar> {
    let real = mimique_test_support::real_file(test, "ict-facekit/ict-facekit.glb");
    let real = real.map(|path| read_avatar(&path).expect("the head is read").avatar);
    let seeded = |seed| HeadSpec { identity: Identity::from_seed(seed), ..HeadSpec::default() };
    let built_in = (0..3).map(|seed| build_head(&seeded(seed)));
    built_in.chain(real).collect()
}

fn without_eyes(mut avatar: Avatar) -> Avatar {
    avatar.eyeballs.clear();
    let eye = |part| matches!(part, Part::EyeLeft | Part::EyeRight);
    avatar.meshes.iter_mut().filter(|m| eye(m.part)).for_each(|m| m.part = Part::EyeOverlay);
    avatar
}

/// How far two heads' frames are apart, in units of the second's distance between the eyes: the
/// middle of the eyes, the distance between the eyes, the drop to the chin.
fn apart(a: &Landmarks, b: &Landmarks) -> [f32; 3] {
    let span = b.eye_span();
    let off = (0..3).map(|k| (a.eyes_middle()[k] - b.eyes_middle()[k]).powi(2)).sum::<f32>();
    let drop = |l: &Landmarks| l.eyes_middle()[1] - l.chin[1];
    [off.sqrt() / span, (a.eye_span() / span - 1.0).abs(), (drop(a) - drop(b)).abs() / span]
}

fn near(found: [f32; 3], most: [f32; 3], what: &str) {
    assert!((0..3).all(|k| found[k] <= most[k]), "{what}: {found:?}, at most {most:?}");
}

#[test]
fn landmarks_of_an_egg_are_where_its_maker_put_them() {
    let found = Landmarks::find(&support::egg());
    assert_eq!((found.eye_right, found.eye_left), ([-0.031, 0.024, 0.063], [0.031, 0.024, 0.063]));
    assert_eq!(found.eyes_middle(), [0.0, 0.024, 0.063]);
    assert!((found.eye_span() - 0.062).abs() < 1e-6);
    // The foremost point below the eyes lies on the egg's own front.
    let [x, y, z] = found.nose_tip;
    assert!(
        x.abs() < 0.016 && (-0.05..0.02).contains(&y) && (0.08..0.0851).contains(&z),
        "{found:?}"
    );
}

#[test]
fn a_head_without_eyes_is_framed_as_with_them() {
    for avatar in heads("a_head_without_eyes_is_framed_as_with_them") {
        let whole = Landmarks::find(&avatar);
        let mut blind = without_eyes(avatar);
        near(apart(&Landmarks::find(&blind), &whole), [0.05, 0.10, 0.05], "by its lids");
        // Shapes without telling names, of a face alone.
        let face = blind.face_shapes().len();
        blind.meshes.iter_mut().for_each(|mesh| mesh.shapes.truncate(face));
        blind.shape_names = (0..face).map(|k| format!("s{k}")).collect();
        near(apart(&Landmarks::find(&blind), &whole), [0.15, 0.10, 0.15], "by what shapes move");
    }
}

#[test]
fn hats_hair_and_shoulders_change_nothing() {
    for avatar in heads("hats_hair_and_shoulders_change_nothing") {
        let mut named = without_eyes(avatar.clone());
        let mut mute = named.clone();
        mute.shape_names = (0..mute.shape_names.len()).map(|k| format!("s{k}")).collect();
        for bare in [&avatar, &mut named, &mut mute] {
            let mut dressed = bare.clone();
            for (centre, radii, part) in [
                ([0.0, 0.16, 0.02], [0.20, 0.08, 0.20], Part::Other),
                ([0.0, 0.10, -0.04], [0.12, 0.12, 0.10], Part::Hair),
                ([0.0, -0.30, -0.06], [0.25, 0.10, 0.12], Part::Other),
                // Bare shoulders are skin.
                ([0.0, -0.32, -0.06], [0.24, 0.10, 0.11], Part::Skin),
            ] {
                let mut worn = support::ball(centre, radii, 24, 16);
                worn.part = part;
                worn.shapes = vec![Default::default(); bare.shape_names.len()];
                dressed.meshes.push(worn);
            }
            assert_eq!(Landmarks::find(&dressed), Landmarks::find(bare), "{}", bare.name);
        }
    }
}

#[test]
fn a_head_that_nothing_moves_is_framed_by_its_skin() {
    let mut egg = without_eyes(support::egg());
    egg.meshes.iter_mut().for_each(|m| m.shapes.clear());
    egg.shape_names.clear();
    let bare = Landmarks::find(&egg);
    assert!(bare.eye_left[0] > 0.02 && bare.eye_left[1] > 0.0, "{bare:?}");
    let mut hat = support::ball([0.0, 0.16, 0.02], [0.20, 0.08, 0.20], 24, 16);
    hat.part = Part::Other;
    egg.meshes.push(hat);
    assert_eq!(Landmarks::find(&egg), bare);
}
