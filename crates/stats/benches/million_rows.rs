//! A million rows: the tests, and reading the file.
//!
//! `cargo bench -p mimique-stats --bench million_rows` prints our own times. With `--serve FILE` it
//! writes the rows to FILE, then answers each line of standard input, the name of a measurement, with
//! one line of JSON: so `cargo xtask bench --stats` lets it and its peers (`peers.py`) take turns.
#![allow(clippy::print_stdout, missing_docs)]

use std::hint::black_box;
use std::io::{BufRead, Write};
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use mimique_stats::{
    Factor, Numbers, SumsOfSquares, Table, WilcoxonOptions, kruskal_wallis, scheirer_ray_hare,
    spearman, wilcoxon,
};

const ROWS: usize = 1_000_000;
/// Runs of a measurement; the quickest counts.
const RUNS: usize = 3;
const TESTS: [&str; 4] = ["Kruskal-Wallis", "Wilcoxon", "Spearman", "Scheirer-Ray-Hare"];
const KINDS: [&str; 2] = ["ratings", "doubles"];

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let after = |name: &str| {
        let place = arguments.iter().position(|argument| argument == name)?;
        arguments.get(place + 1).map(|path| Path::new(path).to_path_buf())
    };
    if let Some(path) = after("--memory") {
        // A process of its own: the peak is that of reading alone.
        read(&path);
        println!("{}", peak_bytes());
        return;
    }
    let served = after("--serve");
    let path = served
        .clone()
        .unwrap_or_else(|| Path::new(env!("CARGO_TARGET_TMPDIR")).join("million.csv"));
    write_rows(&path);
    let bench = Bench::of(&path);
    if served.is_some() {
        println!("{{\"ready\": true}}");
        for line in std::io::stdin().lock().lines().map_while(Result::ok) {
            println!("{}", bench.answer(&line));
            let _ = std::io::stdout().flush();
        }
        return;
    }
    println!("reading the CSV: {:.1} ms", 1e3 * bench.seconds("read"));
    for kind in KINDS {
        for test in TESTS {
            println!("{test}, {kind}: {:.1} ms", 1e3 * bench.seconds(&format!("{test}, {kind}")));
        }
    }
    println!("memory of reading: {:.1} times the file", bench.memory());
}

struct Bench<'a> {
    path: &'a Path,
    columns: Columns,
    /// Differences of ratings and of doubles.
    differences: [Numbers; 2],
}

struct Columns {
    factors: [Factor; 2],
    numbers: [Numbers; 4],
}

impl<'a> Bench<'a> {
    fn of(path: &'a Path) -> Self {
        let columns = read(path);
        let difference = |x: &Numbers, y: &Numbers| Numbers {
            name: "difference".to_owned(),
            values: x.values.iter().zip(&y.values).map(|(x, y)| x - y).collect(),
        };
        let [rating, other, seconds, more] = &columns.numbers;
        let differences = [difference(rating, other), difference(seconds, more)];
        Self { path, columns, differences }
    }

    fn answer(&self, name: &str) -> String {
        if name == "memory" {
            return format!("{{\"times\": {}}}", self.memory());
        }
        format!("{{\"units\": 1, \"seconds\": {}}}", self.seconds(name))
    }

    fn seconds(&self, name: &str) -> f64 {
        let kind = usize::from(name.ends_with(KINDS[1]));
        let [method, expression] = &self.columns.factors;
        let (x, y) = (&self.columns.numbers[2 * kind], &self.columns.numbers[2 * kind + 1]);
        match name.split(',').next() {
            Some("Kruskal-Wallis") => best(|| kruskal_wallis(x, method).unwrap()),
            Some("Wilcoxon") => {
                best(|| wilcoxon(&self.differences[kind], WilcoxonOptions::default()).unwrap())
            }
            Some("Spearman") => best(|| spearman(x, y).unwrap()),
            Some("Scheirer-Ray-Hare") => {
                best(|| scheirer_ray_hare(x, [method, expression], SumsOfSquares::Two).unwrap())
            }
            _ => best(|| read(self.path)),
        }
    }

    /// Peak memory of reading, in times of the file.
    fn memory(&self) -> f64 {
        let this = std::env::current_exe().expect("the path of this program");
        let output = Command::new(this).arg("--memory").arg(self.path).output().expect("a run");
        let peak: f64 = String::from_utf8_lossy(&output.stdout).trim().parse().unwrap_or(f64::NAN);
        peak / std::fs::metadata(self.path).map_or(f64::NAN, |data| data.len() as f64)
    }
}

/// File to typed columns.
fn read(path: &Path) -> Columns {
    let table = Table::parse(std::fs::read(path).unwrap()).unwrap();
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
    std::fs::write(path, text).unwrap();
}

/// Peak resident memory of this process.
fn peak_bytes() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmHWM"));
    let kib = line.and_then(|line| line.split_whitespace().nth(1)?.parse::<u64>().ok());
    kib.unwrap_or(0) * 1024
}
