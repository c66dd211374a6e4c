//! The native side of `cargo xtask bench`: one measurement a line of standard input.
//!
//! `figures PROBLEM_FOLDER` writes there what the peers and the browser's module solve, then reads
//! names of measurements and answers each with a line of JSON: `{"units": 5660, "seconds": 0.13}`.
//! Seconds are processor time of all threads where the system tells it (Linux), else the clock's.
//! `figures scale N` builds the operators of the whole head with every triangle cut into N x N.
//! Without arguments (as `cargo bench` calls it) it does nothing: it has no figures by itself.
#![allow(missing_docs, clippy::print_stdout)]

mod mesh;

use std::hint::black_box;
use std::io::BufRead as _;
use std::path::{Path, PathBuf};

use mimique_avatar_files::read_avatar;
use mimique_clip::{encode_operators, encode_take, solve_packs};
use mimique_solver::{
    Fit, FrontEnd, MarkerColumns, MarkerFrames, Method, MethodSpec, OperatorOptions, Operators,
    SkinMesh, Synthesis,
};
use mimique_stimulus::{AvatarSkin, JoinedTake, MarkerMap, TakeOptions};
use mimique_test_support::Clock;
use serde_json::json;

/// Every twentieth frame goes to the peers, which are slow.
const PEER_STRIDE: usize = 20;

/// Clips of a study for the browser, each of four seconds at 200 frames per second.
const CLIPS: usize = 54;
const CLIP: usize = 800;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    match args.as_slice() {
        [scale, n] if scale == "scale" => measure_scale(n.parse().expect("a number of parts")),
        [folder] => serve(Path::new(folder)),
        _ => println!("figures of the solver: cargo xtask bench"),
    }
}

/// The planted take of the real data, ready to be timed.
struct Planted {
    skin: AvatarSkin,
    markers: Vec<(String, usize)>,
    operators: Operators,
    positions: Vec<f64>,
    columns: MarkerColumns,
    displacements: Vec<f64>,
}

fn serve(folder: &Path) {
    let planted = Planted::read();
    let peers = planted.write(folder);
    println!("{peers}");
    for line in std::io::stdin().lock().lines().map_while(Result::ok) {
        let start = Clock::start();
        let (units, start) = match line.trim() {
            "front end" => {
                black_box(planted.front_end());
                (planted.frames(), start)
            }
            "synthesis" => planted.synthesise(),
            "set-up 11248" => {
                black_box(set_up(&planted.skin.mesh, &planted.skin.shape_names, &planted.markers));
                (1, start)
            }
            "set-up 26719" => {
                let (mesh, names, markers) = mesh::whole_head(&data(), 1);
                let start = Clock::start();
                black_box(set_up(&mesh, &names, &markers));
                (1, start)
            }
            "lsts fine" => planted.solve_on_finer_mesh(),
            packs if packs.starts_with("packs ") => {
                let spec = spec(&packs[6..]);
                let read = |name: &str| std::fs::read(folder.join(name)).expect("a pack");
                let (operators, take) = (read("operators.mmop"), read("take.mmtk"));
                let start = Clock::start();
                black_box(solve_packs(&operators, &take, &spec).expect("solved"));
                (planted.frames(), start)
            }
            method => {
                let fit = Fit::new(&planted.operators, &spec(method)).expect("a method");
                let start = Clock::start();
                black_box(fit.solve_take(&planted.displacements).expect("solved"));
                (planted.frames(), start)
            }
        };
        println!("{}", json!({ "units": units, "seconds": start.seconds() }));
    }
}

impl Planted {
    fn read() -> Planted {
        let lsts = data().join("lsts");
        let avatar = read_avatar(&lsts.join("avatar_skin.glb")).expect("the avatar").avatar;
        let skin = AvatarSkin::of(&avatar).expect("a skin");
        let (capture, map) = capture_and_map(&lsts);
        let joined = JoinedTake::new(&skin, &capture, &map, &TakeOptions::default());
        let operators = joined.expect("a take").operators(&spec("lsts")).expect("operators");
        let sites = map.resolve(&skin).expect("the map fits");
        let markers: Vec<(String, usize)> =
            sites.iter().map(|site| (site.label.clone(), site.vertex())).collect();
        let labels: Vec<String> =
            markers.iter().map(|m| m.0.clone()).chain(map.head.iter().cloned()).collect();
        let columns: Vec<usize> =
            labels.iter().map(|l| capture.marker_index(l).expect("a marker")).collect();
        let metres = capture.unit.metres();
        let positions = (0..capture.frames())
            .flat_map(|frame| columns.iter().map(move |&c| (frame, c)))
            .flat_map(|(frame, c)| capture.frame(frame)[c].map(|x| x * metres).to_array())
            .collect();
        let face = markers.len();
        let columns =
            MarkerColumns { face: (0..face).collect(), head: Some((face..labels.len()).collect()) };
        let displacements = Vec::new();
        let mut planted = Planted { skin, markers, operators, positions, columns, displacements };
        planted.displacements = planted.front_end();
        planted
    }

    fn frames(&self) -> usize {
        self.take().len()
    }

    fn take(&self) -> MarkerFrames<'_> {
        let head = self.columns.head.as_ref().map_or(0, Vec::len);
        MarkerFrames { positions: &self.positions, columns: self.columns.face.len() + head }
    }

    fn front_end(&self) -> Vec<f64> {
        let avatar = &self.operators.parts().marker_positions;
        let poses = FrontEnd::head_poses(self.take(), &self.columns, None).expect("poses");
        let front = FrontEnd::fit(self.take(), &self.columns, &poses, 0..60, avatar);
        front.expect("a front end").take_displacements(self.take(), &poses).expect("displacements")
    }

    /// `lsts` with operators of a skin four times as fine.
    fn solve_on_finer_mesh(&self) -> (usize, Clock) {
        let finer = mesh::finer(&self.skin.mesh, 2);
        let operators = set_up(&finer, &self.skin.shape_names, &self.markers);
        let fit = Fit::new(&operators, &spec("lsts")).expect("a method");
        let start = Clock::start();
        black_box(fit.solve_take(&self.displacements).expect("solved"));
        (self.frames(), start)
    }

    /// Vertices of every frame of the take, from the weights of `lsts`.
    fn synthesise(&self) -> (usize, Clock) {
        let fit = Fit::new(&self.operators, &spec("lsts")).expect("a method");
        let weights = fit.solve_take(&self.displacements).expect("solved").weights;
        let synthesis = Synthesis::new(&self.skin.mesh);
        let n = self.operators.shape_count();
        let mut out = vec![0.0; Synthesis::FRAMES * synthesis.coordinates()];
        let start = Clock::start();
        for frames in weights.chunks(Synthesis::FRAMES * n) {
            synthesis.pose(frames, &mut out);
            black_box(&out);
        }
        (self.frames(), start)
    }

    /// D, H, displacements and answers for the peers; packs for the browser's module.
    fn write(&self, folder: &Path) -> serde_json::Value {
        let write = |name: &str, numbers: &[f64]| {
            let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
            std::fs::write(folder.join(name), bytes).expect("a file for the peers");
        };
        let parts = self.operators.parts();
        let (n, width) = (self.operators.shape_count(), 3 * self.operators.marker_count());
        let some = |numbers: &[f64], width: usize| -> Vec<f64> {
            numbers.chunks_exact(width).step_by(PEER_STRIDE).flatten().copied().collect()
        };
        write("marker_deltas.f64", &parts.marker_deltas);
        write("shell_gram.f64", &parts.shell_gram);
        write("displacements.f64", &some(&self.displacements, width));
        for method in ["lsts", "lsts-norm"] {
            let fit = Fit::new(&self.operators, &spec(method)).expect("a method");
            let solved = fit.solve_take(&self.displacements).expect("solved");
            write(&format!("{method}.f64"), &some(&solved.weights, n));
        }
        let (capture, map) = capture_and_map(&data().join("lsts"));
        let joined = JoinedTake::new(&self.skin, &capture, &map, &TakeOptions::default());
        let joined = joined.expect("a take");
        let take = joined.segment(&self.operators, &spec("lsts"), 0..self.frames());
        let put = |name: &str, bytes: Vec<u8>| {
            std::fs::write(folder.join(name), bytes).expect("a pack");
        };
        put("operators.mmop", encode_operators(&self.operators));
        put("take.mmtk", encode_take(&take.expect("a segment")));
        for (clip, start) in (0..CLIPS).map(|c| (c, c * (self.frames() - CLIP) / (CLIPS - 1))) {
            let take = joined.segment(&self.operators, &spec("lsts"), start..start + CLIP);
            put(&format!("clip{clip}.mmtk"), encode_take(&take.expect("a segment")));
        }
        for method in ["lsts", "lsts-norm"] {
            let text = serde_json::to_string(&spec(method)).expect("a method as JSON");
            put(&format!("{method}.json"), text.into_bytes());
        }
        let problem = json!({
            "shapes": n, "rows": width, "l2": self.operators.data_scale(),
            "tau": self.operators.shell_scale(), "kappa": 0.1,
            "alpha": { "lsts": 0.3, "lsts-norm": 0.5 }, "lo": -0.1, "hi": 1.1, "s": 0.1,
        });
        std::fs::write(folder.join("problem.json"), problem.to_string()).expect("a file");
        json!({ "frames": self.frames(), "vertices": self.skin.mesh.positions.len() })
    }
}

fn capture_and_map(lsts: &Path) -> (mimique_mocap::Capture, MarkerMap) {
    let capture = mimique_mocap::read(&lsts.join("take_n01.csv")).expect("the take");
    let map = std::fs::read_to_string(lsts.join("mapping.csv")).expect("the map");
    let mut map = MarkerMap::from_text(&map).expect("the map");
    map.neutral = Some(0..60);
    (capture, map)
}

fn spec(method: &str) -> MethodSpec {
    let found = Method::ALL.into_iter().find(|m| m.name() == method);
    let mut spec = MethodSpec::new(found.expect("the name of a method"));
    // The peers get displacements of a head that is not filtered.
    spec.head_lowpass_hz = Some(0.0);
    spec.alpha = match spec.method {
        Method::Lsts => Some(0.3),
        Method::LstsNorm | Method::LstsShort | Method::LstsSoft => Some(0.5),
        _ => None,
    };
    spec
}

fn set_up(mesh: &SkinMesh, names: &[String], markers: &[(String, usize)]) -> Operators {
    Operators::build(mesh, names, markers, &OperatorOptions::default()).expect("operators")
}

/// One build of a mesh N x N times as fine, in a process of its own for its peak of memory.
fn measure_scale(parts: usize) {
    let (mesh, names, markers) = mesh::whole_head(&data(), parts);
    let deltas: usize = mesh.shapes.iter().map(|s| s.vertices.len()).sum();
    let mut seconds: Vec<f64> = Vec::new();
    let before = peak_memory(true);
    for _ in 0..3 {
        let start = Clock::start();
        black_box(set_up(&mesh, &names, &markers));
        seconds.push(start.seconds());
    }
    seconds.sort_by(f64::total_cmp);
    let memory = peak_memory(false).zip(before).map(|(after, before)| after - before);
    let line = json!({
        "vertices": mesh.positions.len(), "deltas": deltas, "seconds": seconds[1],
        "bytes": memory,
    });
    println!("{line}");
}

/// Bytes of resident memory: now, after forgetting the peak; or the peak since then.
fn peak_memory(forget: bool) -> Option<u64> {
    if forget {
        std::fs::write("/proc/self/clear_refs", "5").ok()?;
    }
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    Some(1024 * line.split_whitespace().nth(1)?.parse::<u64>().ok()?)
}

/// The folder of the real data; `cargo xtask bench` has looked that it is there.
fn data() -> PathBuf {
    let given = std::env::var_os("MIMIQUE_DATA").unwrap_or_else(|| "../shared/data".into());
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(given)
}
