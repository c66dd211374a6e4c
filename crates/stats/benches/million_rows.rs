//! A million rows: tests against SciPy and NumPy, reading against polars, in one run on one machine.
//!
//! `cargo bench -p mimique-stats`; the peers run in the Python of `MIMIQUE_PYTHON` (numpy, scipy,
//! polars), and are left out where it is not given. Each figure is the best of several runs.
#![allow(clippy::print_stdout, missing_docs)]

use std::hint::black_box;
use std::io::Write;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use mimique_stats::{
    Factor, Numbers, SumsOfSquares, Table, WilcoxonOptions, kruskal_wallis, scheirer_ray_hare,
    spearman, wilcoxon,
};

const ROWS: usize = 1_000_000;
const RUNS: usize = 7;

fn main() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let path = folder.join("million.csv");
    if let Some(place) = std::env::args().position(|argument| argument == "--memory") {
        // A process of its own: the peak is that of reading alone.
        read(Path::new(&std::env::args().nth(place + 1).unwrap_or_default()));
        println!("{}", peak_bytes());
        return;
    }
    write_rows(&path);
    let bytes = std::fs::metadata(&path).map_or(0, |data| data.len());
    let columns = read(&path);
    let mut own: Vec<(&str, f64)> = vec![("read CSV", best(|| read(&path)))];
    let [method, expression] = &columns.factors;
    let [rating, other, seconds, more] = &columns.numbers;
    for (kind, x, y) in [("ratings", rating, other), ("doubles", seconds, more)] {
        let differences = Numbers {
            name: "difference".to_owned(),
            values: x.values.iter().zip(&y.values).map(|(x, y)| x - y).collect(),
        };
        let names = if kind == "ratings" { RATINGS } else { DOUBLES };
        own.push((names[0], best(|| kruskal_wallis(x, method).unwrap())));
        own.push((names[1], best(|| wilcoxon(&differences, WilcoxonOptions::default()).unwrap())));
        own.push((names[2], best(|| spearman(x, y).unwrap())));
        let both = [method, expression];
        own.push((names[3], best(|| scheirer_ray_hare(x, both, SumsOfSquares::Two).unwrap())));
    }
    let peers = peers(&path);
    println!("{:<36}{:>12}{:>12}{:>10}", "", "Mimique ms", "peer ms", "times");
    for (name, seconds) in &own {
        let peer = peers.iter().find(|(other, _)| other == name).map(|(_, seconds)| *seconds);
        let ms = seconds * 1e3;
        match peer {
            Some(peer) => {
                println!("{name:<36}{ms:>12.1}{:>12.1}{:>10.1}", peer * 1e3, peer / seconds)
            }
            None => println!("{name:<36}{ms:>12.1}{:>12}{:>10}", "-", "-"),
        }
    }
    let this = std::env::current_exe().expect("the path of this program");
    let output = Command::new(this).arg("--memory").arg(&path).output().expect("a second run");
    let peak: f64 = String::from_utf8_lossy(&output.stdout).trim().parse().unwrap_or(f64::NAN);
    println!("memory of reading: {:.1} times the file of {bytes} bytes", peak / bytes as f64);
}

const RATINGS: [&str; 4] = [
    "Kruskal-Wallis, ratings",
    "Wilcoxon, ratings",
    "Spearman, ratings",
    "Scheirer-Ray-Hare, ratings",
];
const DOUBLES: [&str; 4] = [
    "Kruskal-Wallis, doubles",
    "Wilcoxon, doubles",
    "Spearman, doubles",
    "Scheirer-Ray-Hare, doubles",
];

struct Columns {
    factors: [Factor; 2],
    numbers: [Numbers; 4],
}

/// File to typed columns.
fn read(path: &Path) -> Columns {
    let table = Table::parse(&std::fs::read(path).unwrap()).unwrap();
    Columns {
        factors: ["method", "expression"].map(|name| table.factor(name).unwrap()),
        numbers: ["rating", "other", "seconds", "more"].map(|name| table.numbers(name).unwrap()),
    }
}

fn best<T>(mut run: impl FnMut() -> T) -> f64 {
    (0..RUNS)
        .map(|_| {
            let start = Instant::now();
            black_box(run());
            start.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min)
}

fn write_rows(path: &Path) {
    let mut state = 7u64;
    let mut uniform = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut text = String::from("method,expression,rating,other,seconds,more\n");
    let methods = ["lsts30", "lsts50", "lsts70"];
    let expressions = ["anger", "disgust", "fear", "joy", "sadness", "surprise"];
    for _ in 0..ROWS {
        let (method, expression) = ((uniform() * 3.0) as usize, (uniform() * 6.0) as usize);
        let mut rating = || ((uniform() + uniform()) * 3.5).floor() as u32 + 1;
        let (rating, other) = (rating(), rating());
        let mut time = || 2.0 * (uniform() + uniform() + uniform()).exp();
        let (seconds, more) = (time(), time());
        text.push_str(&format!(
            "{},{},{rating},{other},{seconds:.9},{more:.9}\n",
            methods[method], expressions[expression]
        ));
    }
    std::fs::File::create(path).and_then(|mut file| file.write_all(text.as_bytes())).unwrap();
}

/// Seconds of the peers by name.
fn peers(path: &Path) -> Vec<(String, f64)> {
    let Some(python) = std::env::var_os("MIMIQUE_PYTHON") else { return Vec::new() };
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/peers.py");
    let output = Command::new(python).args([script.as_ref(), path.as_os_str()]).output().unwrap();
    eprint!("{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout)
        .lines()
        .filter_map(|line| line.rsplit_once('\t'))
        .filter_map(|(name, seconds)| Some((name.to_owned(), seconds.parse().ok()?)))
        .collect()
}

/// Peak resident memory of this process.
fn peak_bytes() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmHWM"));
    let kib = line.and_then(|line| line.split_whitespace().nth(1)?.parse::<u64>().ok());
    kib.unwrap_or(0) * 1024
}
