use mimique_layout::*;
use mimique_stimulus::{AvatarSkin, RecordedWeights};
use mimique_solver::{Method as Solve, MethodSpec};
use std::time::Instant;

fn take(skin: &AvatarSkin, file: &str) -> Take {
    let options = mimique_mocap::WeightOptions { rate_hz: None, shape_names: &skin.shape_names };
    let table = mimique_mocap::read_weights_file(std::path::Path::new(file), &options).unwrap();
    let r = RecordedWeights::of(&table, &skin.shape_names).unwrap();
    Take { name: file.to_owned(), rate_hz: r.table.rate_hz(), content: TakeContent::Weights(r.table.weights) }
}

#[test]
fn table() {
    let avatar = mimique_avatar_files::read_avatar(std::path::Path::new("/work/shared/data/lsts/avatar_skin.glb")).unwrap().avatar;
    let skin = AvatarSkin::of(&avatar).unwrap();
    let t = Instant::now();
    let face = Face::of(&skin).unwrap();
    let candidates = Candidates::of(&face, &Where::default());
    eprintln!("face {:?} {:?}", t.elapsed(), candidates.counts);
    let unseen = unseen_shapes(&face, &candidates.vertices);
    eprintln!("unseen {:?}", unseen.iter().map(|k| &skin.shape_names[*k]).collect::<Vec<_>>());
    let roms: Vec<Take> = std::env::var("ROM").unwrap().split(',').map(|f| take(&skin, f)).collect();
    let test = FaceMotion::of(&face, &[take(&skin, "/work/shared/data/lsts/truth.csv")], &unseen).unwrap();
    let motion = FaceMotion::of(&face, &roms, &unseen).unwrap();
    let t = Instant::now();
    let spacing = Spacing::of(&face, &motion, &candidates.vertices, 0.008);
    eprintln!("spacing {:?}", t.elapsed());
    let symmetric = std::env::var("FREE").is_err();
    let units = Units::of(&face, &candidates, spacing, symmetric, &[]).unwrap();
    eprintln!("units {}", units.each.len());
    let lambda: f64 = std::env::var("LAMBDA").ok().map_or(0.1, |x| x.parse().unwrap());
    let mut spec = MethodSpec::new(Solve::Lsts);
    spec.rbf_smoothing = Some(lambda);
    let put = Conditions { noise: 1e-4, slip: 1.5e-3, others: true };
    let t = Instant::now();
    let rehearsal = Rehearsal::new(&face, &motion, None, &spec, put, Effort::SEARCH, 1);
    eprintln!("rehearsal {:?}", t.elapsed());
    let task = Task { units: &units, motion: &motion, rehearsal: &rehearsal, noise: 1e-4, slip: 1.5e-3, seed: 1, progress: &Silent };
    let judge = |slip: f64, others, smoothing: f64| {
        let mut s = MethodSpec::new(Solve::Lsts); s.rbf_smoothing = Some(smoothing);
        Rehearsal::new(&face, &test, None, &s, Conditions { noise: 1e-4, slip, others }, Effort::REPORT, 77)
    };
    let judges = [judge(0.0, false, 0.0), judge(0.0, false, 0.1), judge(1.5e-3, true, 0.0), judge(1.5e-3, true, 0.1), judge(1.5e-3, true, 0.3)];
    for n in [20, 30, 40] {
        for method in [Method::Kmeans, Method::Greedy, Method::Qr, Method::Farthest, Method::Shell, Method::Rehearse] {
            let t = Instant::now();
            match method.choose(&task, n, &Choice::default()) {
                Ok(found) => {
                    let el = t.elapsed();
                    let t = Instant::now();
                    let e: Vec<String> = judges.iter().map(|j| format!("{:.3}", 1e3 * j.mean_square(&test, &found.vertices()).unwrap().sqrt())).collect();
                    eprintln!("{n} {method}: {} ({:.2?}; judged {:.2?}) {} markers", e.join("  "), el, t.elapsed(), found.vertices().len());
                }
                Err(e) => eprintln!("{n} {method}: {e}"),
            }
        }
    }
}
