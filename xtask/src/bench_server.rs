//! `cargo xtask bench --server`: a study of a million events on each database: what its exports take in time and
//! memory, how long the dashboard takes, and a restart of the server.
//!
//! `crates/server/examples/large_study.rs` fills the databases, PostgreSQL's in a cluster of its own, which lives
//! as long as that process. Everything else is the released binary: `mimique export`, `mimique serve`.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};

use crate::bench_figures::{print, record};
use crate::bench_stats::{best, peak};
use crate::demo;
use crate::process::{cargo, root, run, say, target};
use crate::server::Server;

const EVENTS: &str = "1000000";
const TOKEN: &str = "mimique_bench";
const FORMATS: [&str; 5] = ["csv", "wide", "json", "events", "psych-ds"];
/// A session of whose newest events the dashboard says so is not counted yet.
const BEHIND: &str = "do not count the newest events";

/// What was measured on one database, row by row.
type Column = Vec<String>;

/// Measures, prints, and records where asked.
pub fn run_bench(study: &str, recorded: bool) -> Result<()> {
    demo::binary()?;
    let mut build = cargo();
    build.args(["build", "--release", "--package", "mimique-server", "--example", "large_study"]);
    run(&mut build)?;
    let folder = target().join("bench-server");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder)?;
    let sqlite = format!("sqlite:{}", folder.join("answers.sqlite").display());
    let mut names = Vec::new();
    let mut columns: Vec<Column> = Vec::new();
    let mut filled = String::new();
    for (name, database) in [("SQLite", sqlite.as_str()), ("PostgreSQL", "postgres")] {
        say(&format!("{name}: filling it with {EVENTS} events of {study}"));
        let Some(source) = Filled::start(database, study)? else {
            say(&format!("{name} is not installed, and is left out"));
            continue;
        };
        filled = source.said.clone();
        names.push(name);
        columns.push(measure(&source.database, study, &folder.join(name))?);
    }
    let table = table(&names, &columns);
    let text = format!("{table}\n{filled}, filled by the example `large_study`. {}\n", machine());
    print(&text);
    if recorded {
        record("docs/measured/server-benchmarks.md", &text)?;
    }
    Ok(())
}

/// A database that is filled, and what keeps it there.
struct Filled {
    database: String,
    said: String,
    child: Child,
}

impl Filled {
    /// Fills a database; none where it is PostgreSQL and that is not installed.
    fn start(database: &str, study: &str) -> Result<Option<Self>> {
        let mut child = Command::new(target().join("release/examples/large_study"))
            .args([database, &study_file(study), EVENTS, TOKEN])
            .current_dir(root())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .context("the example large_study")?;
        let mut lines = BufReader::new(child.stdout.take().context("no output")?).lines();
        let Some(database) = lines.next().transpose()? else {
            child.wait()?;
            return Ok(None);
        };
        let said = lines.next().transpose()?.context("nothing was filled")?;
        Ok(Some(Self { database, said, child }))
    }
}

impl Drop for Filled {
    fn drop(&mut self) {
        // The end of its input tells it to end, and PostgreSQL with it.
        drop(self.child.stdin.take());
        let _ = self.child.wait();
    }
}

fn study_file(study: &str) -> String {
    format!("study-config/{study}.json")
}

/// The names of the rows of a [`Column`], and the goals.
fn rows() -> Vec<(String, &'static str)> {
    let exports = FORMATS.iter().map(|format| {
        (format!("`mimique export --format {format}`: seconds; memory, MB"), "20 s; 300 MB")
    });
    let others = [
        ("first start with this study, which prepares its clips, s", ""),
        ("dashboard before anything is counted, s; KB", "1 s"),
        ("until every session is counted, s", ""),
        ("restart until the server listens, s", "1 s"),
        ("dashboard after a restart, s; KB", "1 s"),
        ("dashboard again, s", "1 s"),
        ("three downloads at once (csv, wide, psych-ds), s; the server's memory, MB", "300 MB"),
        ("the statistical report, s; the server's memory, MB", ""),
    ];
    exports.chain(others.map(|(name, goal)| (name.to_owned(), goal))).collect()
}

fn measure(database: &str, study: &str, folder: &Path) -> Result<Column> {
    std::fs::create_dir_all(folder)?;
    let mut column = Column::new();
    let mut note = |text: String| {
        say(&format!("{}: {text}", rows()[column.len()].0));
        column.push(text);
    };
    for format in FORMATS {
        let out = folder.join(if format == "psych-ds" { "set.zip" } else { "export" });
        let mut export = Command::new(demo::binary_path());
        export.args(["export", "--database", database, "--format", format, "--out"]).arg(&out);
        let run = best(1, &mut export)?;
        std::fs::remove_file(&out)?;
        let memory = run.memory.map_or("-".to_owned(), |bytes| format!("{:.0}", bytes / 1e6));
        note(format!("{:.1}; {memory}", run.seconds));
    }
    let (server, first) = serve(database, study, folder)?;
    note(format!("{first:.2}"));
    let page = format!("/researcher/studies/{study}");
    let (seconds, text) = server.read(&page)?;
    note(format!("{seconds:.2}; {:.0}", text.len() as f64 / 1e3));
    let began = Instant::now();
    while server.read(&page)?.1.contains(BEHIND) {
        std::thread::sleep(Duration::from_secs(1));
    }
    note(format!("{:.0}", began.elapsed().as_secs_f64()));
    drop(server);
    let (server, again) = serve(database, study, folder)?;
    note(format!("{again:.2}"));
    let (seconds, text) = server.read(&page)?;
    if text.contains(BEHIND) {
        bail!("a restart has forgotten what was counted");
    }
    note(format!("{seconds:.2}; {:.0}", text.len() as f64 / 1e3));
    note(format!("{:.2}", server.read(&page)?.0));
    drop(server);
    let (server, _) = serve(database, study, folder)?;
    let began = Instant::now();
    std::thread::scope(|scope| -> Result<()> {
        let downloads = ["csv", "wide", "psych-ds"].map(|format| {
            let path = format!("{page}/export/{format}");
            let server = &server;
            scope.spawn(move || server.count(&path))
        });
        for download in downloads {
            download.join().map_err(|_| anyhow::anyhow!("a download broke off"))??;
        }
        Ok(())
    })?;
    note(format!("{:.1}; {:.0}", began.elapsed().as_secs_f64(), memory_mb(&server)));
    drop(server);
    let (server, _) = serve(database, study, folder)?;
    let began = Instant::now();
    // A large report may take longer than a request may: then it is ready for the next one.
    let mut report = server.count(&format!("{page}/report/en/report.html"));
    while report.is_err() && began.elapsed() < Duration::from_secs(600) {
        report = server.count(&format!("{page}/report/en/report.html"));
    }
    report?;
    note(format!("{:.1}; {:.0}", began.elapsed().as_secs_f64(), memory_mb(&server)));
    Ok(column)
}

/// `mimique serve` with this study; how long it took until it answered, seconds.
fn serve(database: &str, study: &str, folder: &Path) -> Result<(Server, f64)> {
    let mut serve = Command::new(demo::binary_path());
    serve.args(["serve", &study_file(study), "--database", database, "--data-dir"]);
    let (server, seconds) = Server::start(serve.arg(folder.join("data")).current_dir(root()))?;
    Ok((server.with_token(TOKEN), seconds))
}

/// The largest resident size of the server so far, MB.
fn memory_mb(server: &Server) -> f64 {
    peak(&format!("/proc/{}/status", server.id())).map_or(f64::NAN, |bytes| bytes / 1e6)
}

fn table(names: &[&str], columns: &[Column]) -> String {
    let mut text = format!("| what | goal | {} |\n", names.join(" | "));
    text.push_str(&format!("|---|---|{}\n", "---|".repeat(names.len())));
    for (index, (name, goal)) in rows().iter().enumerate() {
        let cells: Vec<&str> = columns.iter().map(|column| column[index].as_str()).collect();
        text.push_str(&format!("| {name} | {goal} | {} |\n", cells.join(" | ")));
    }
    text
}

/// What else the machine did, as far as the system tells.
fn machine() -> String {
    let load = std::fs::read_to_string(PathBuf::from("/proc/loadavg")).unwrap_or_default();
    let load = load.split_whitespace().take(3).collect::<Vec<_>>().join(", ");
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{cores} cores; load averages over 1, 5 and 15 minutes at the end: {load}.")
}
