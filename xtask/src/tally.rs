//! Counting what the test programs say, so that the whole ends with one line.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};

use crate::process::{say, show};

/// What has become of something that not every machine can do.
pub enum Tried {
    /// It is done.
    Done,
    /// Not all of it, and why.
    InPart(String),
    /// It is not done, and why.
    Not(String),
}

/// Tests and checks counted so far.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Passed.
    pub passed: u64,
    /// Failed.
    pub failed: u64,
    /// Skipped, each named in the output.
    pub skipped: u64,
    failures: Vec<String>,
    skips: Vec<String>,
    /// What each step took, in the order in which they ended.
    took: Vec<(String, Duration)>,
}

impl Tally {
    /// Runs a check that counts as one: it passes when the command succeeds.
    pub fn check(&mut self, name: &str, command: &mut Command) {
        say(name);
        let begun = Instant::now();
        let status = command.status();
        self.took(name, begun);
        match status {
            Ok(status) if status.success() => self.passed += 1,
            Ok(status) => self.fail(format!("{name} ({status}): {}", show(command))),
            Err(error) => self.fail(format!("{name} could not start ({error}): {}", show(command))),
        }
    }

    /// Counts what somebody else has counted.
    pub fn add(&mut self, other: Self) {
        self.passed += other.passed;
        self.failed += other.failed;
        self.skipped += other.skipped;
        self.failures.extend(other.failures);
        self.skips.extend(other.skips);
        self.took.extend(other.took);
    }

    fn took(&mut self, name: &str, begun: Instant) {
        self.took.push((name.to_owned(), begun.elapsed()));
    }

    /// Counts something that is done here, or is not.
    pub fn done(&mut self, name: &str, work: impl FnOnce() -> Result<()>) {
        let begun = Instant::now();
        let done = work();
        self.took(name, begun);
        match done {
            Ok(()) => self.passed += 1,
            Err(error) => self.fail(format!("{name}: {error:#}")),
        }
    }

    /// Counts something that is done here, fails, or cannot be done here, which its reason says.
    pub fn tried(&mut self, name: &str, work: impl FnOnce() -> Result<Tried>) {
        say(name);
        let begun = Instant::now();
        let tried = work();
        self.took(name, begun);
        match tried {
            Ok(Tried::Done) => self.passed += 1,
            Ok(Tried::InPart(why)) => self.skip(&format!("{name}, in part: {why}")),
            Ok(Tried::Not(why)) => self.skip(&format!("{name}: {why}")),
            Err(error) => self.fail(format!("{name}: {error:#}")),
        }
    }

    fn skip(&mut self, what: &str) {
        say(&format!("SKIPPED {what}"));
        self.skipped += 1;
        self.skips.push(what.to_owned());
    }

    /// Counts one failure.
    pub fn fail(&mut self, what: String) {
        say(&format!("FAILED: {what}"));
        self.failed += 1;
        self.failures.push(what);
    }

    /// Runs a test program, passing its output on, and counts by its closing lines. A program that
    /// fails without a failed test, or ends on no test, counts as a failure.
    #[expect(clippy::print_stdout, reason = "the test program's own output, passed on")]
    pub fn tests(&mut self, name: &str, command: &mut Command) -> Result<()> {
        say(name);
        let begun = Instant::now();
        let mut child = command
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .with_context(|| format!("could not start: {}", show(command)))?;
        let (send, lines) = mpsc::channel::<String>();
        let out = child.stdout.take().context("stdout is piped")?;
        let err = child.stderr.take().context("stderr is piped")?;
        let readers = [
            thread::spawn({
                let send = send.clone();
                move || pass_lines(BufReader::new(out), &send)
            }),
            thread::spawn(move || pass_lines(BufReader::new(err), &send)),
        ];
        let mut counted = Self::default();
        for line in lines {
            counted.read(&line);
            println!("{line}");
        }
        for reader in readers {
            let _ = reader.join();
        }
        let status = child.wait()?;
        self.took(name, begun);
        // A test that says SKIPPED returned early and was counted as passed by its runner.
        let soft = counted.skips.len() as u64;
        self.passed += counted.passed.saturating_sub(soft);
        self.skipped += counted.skipped + soft;
        self.skips.extend(counted.skips);
        if counted.failed > 0 {
            self.failed += counted.failed;
            self.failures.push(format!("{name}: {} failed", counted.failed));
        } else if !status.success() {
            self.fail(format!("{name} ({status}) without a failed test: {}", show(command)));
        } else if counted.passed == 0 {
            self.fail(format!("{name} ran no test: {}", show(command)));
        }
        Ok(())
    }

    /// Understands one line of nextest, libtest or node's test runner.
    fn read(&mut self, line: &str) {
        let line = strip_colours(line);
        let line = line.trim();
        if let Some(at) = line.find("SKIPPED ") {
            self.skips.push(line[at..].to_owned());
            return;
        }
        // nextest: Summary [   1.2s] 12 tests run: 11 passed (1 slow), 1 failed, 2 skipped
        if line.starts_with("Summary [") {
            let rest = line.split_once("run:").map_or("", |(_, rest)| rest);
            // It stands for all that went before, the output of single tests included.
            self.passed = number_before(rest, "passed");
            self.failed = number_before(rest, "failed")
                + number_before(rest, "timed out")
                + number_before(rest, "exec failed");
            self.skipped = number_before(rest, "skipped");
        // libtest: test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out
        } else if let Some(rest) = line.strip_prefix("test result:") {
            self.passed += number_before(rest, "passed");
            self.failed += number_before(rest, "failed");
            self.skipped += number_before(rest, "ignored");
        // node: # pass 3, or with the spec reporter: ℹ pass 3
        } else if let Some(rest) =
            line.strip_prefix("# ").or_else(|| line.strip_prefix("\u{2139} "))
        {
            let mut words = rest.split_whitespace();
            if let (Some(word), Some(Ok(count)), None) =
                (words.next(), words.next().map(str::parse::<u64>), words.next())
            {
                match word {
                    "pass" => self.passed += count,
                    "fail" | "cancelled" => self.failed += count,
                    "skipped" | "todo" => self.skipped += count,
                    _ => {}
                }
            }
        }
    }

    /// The closing lines; whether all is well.
    #[expect(clippy::print_stdout, reason = "the closing line of the whole")]
    pub fn close(&self, skip_allowed: bool) -> bool {
        for skip in &self.skips {
            println!("skipped: {}", skip.trim_start_matches("SKIPPED "));
        }
        for failure in &self.failures {
            println!("failed: {failure}");
        }
        let minutes = |took: &Duration| took.as_secs_f64() / 60.0;
        let took: Vec<String> =
            self.took.iter().map(|(name, took)| format!("{name} {:.1}", minutes(took))).collect();
        println!("minutes: {}", took.join("; "));
        println!("{} passed, {} failed, {} skipped", self.passed, self.failed, self.skipped);
        self.failed == 0 && (skip_allowed || self.skipped == 0)
    }
}

fn pass_lines(mut reader: impl BufRead, send: &mpsc::Sender<String>) {
    let mut buffer = Vec::new();
    while matches!(reader.read_until(b'\n', &mut buffer), Ok(n) if n > 0) {
        let line = String::from_utf8_lossy(&buffer).trim_end().to_owned();
        buffer.clear();
        if send.send(line).is_err() {
            return;
        }
    }
}

/// The number that stands right before `word`, 0 when there is none.
fn number_before(text: &str, word: &str) -> u64 {
    text.find(word)
        .and_then(|at| text[..at].split_whitespace().next_back())
        .and_then(|n| n.parse().ok())
        .unwrap_or(0)
}

fn strip_colours(line: &str) -> String {
    let mut out = String::with_capacity(line.len());
    let mut chars = line.chars();
    while let Some(c) = chars.next() {
        if c == '\u{1b}' {
            for c in chars.by_ref() {
                if c.is_ascii_alphabetic() {
                    break;
                }
            }
        } else {
            out.push(c);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counted(lines: &[&str]) -> (u64, u64, u64) {
        let mut tally = Tally::default();
        lines.iter().for_each(|l| tally.read(l));
        (tally.passed, tally.failed, tally.skipped + tally.skips.len() as u64)
    }

    #[test]
    fn the_runners_closing_lines_are_understood() {
        let nextest = "     Summary [   0.027s] 14 tests run: 12 passed (1 slow), 1 failed, 1 timed out, 3 skipped";
        assert_eq!(counted(&[nextest]), (12, 2, 3));
        let coloured = "\u{1b}[32;1m     Summary\u{1b}[0m [   0.1s] \u{1b}[1m2\u{1b}[0m tests run: \u{1b}[1m2\u{1b}[0m \u{1b}[32;1mpassed\u{1b}[0m, \u{1b}[1m0\u{1b}[0m \u{1b}[33;1mskipped\u{1b}[0m";
        assert_eq!(counted(&[coloured]), (2, 0, 0));
        let one = "    test result: ok. 1 passed; 0 failed; 0 ignored; 0 measured; 9 filtered out";
        assert_eq!(counted(&[one, one, nextest]), (12, 2, 3), "nothing is counted twice");
        let libtest =
            "test result: FAILED. 3 passed; 2 failed; 1 ignored; 0 measured; 0 filtered out";
        assert_eq!(counted(&[libtest]), (3, 2, 1));
        assert_eq!(counted(&["# tests 5", "# pass 3", "# fail 1", "# skipped 1"]), (3, 1, 1));
        assert_eq!(counted(&["  SKIPPED take: real data not found at x"]), (0, 0, 1));
    }
}
