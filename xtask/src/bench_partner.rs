//! A process that is measured: it is asked by lines and answers with lines of JSON.

use std::io::{BufRead, BufReader, Write as _};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use anyhow::{Context, Result, bail};

use crate::process::{say, show};

/// A process that answers lines with lines of JSON.
pub struct Partner {
    child: Child,
    to: Option<ChildStdin>,
    from: BufReader<ChildStdout>,
    /// Its first line.
    pub greeting: String,
}

impl Partner {
    /// Starts it and waits for its greeting.
    pub fn start(command: &mut Command) -> Result<Partner> {
        let shown = show(command);
        say(&shown);
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .with_context(|| format!("could not start: {shown}"))?;
        let (to, from) = (child.stdin.take(), child.stdout.take());
        let from = BufReader::new(from.context("no standard output")?);
        let mut partner = Partner { child, to, from, greeting: String::new() };
        partner.greeting = partner.line().with_context(|| format!("failed: {shown}"))?;
        Ok(partner)
    }

    fn line(&mut self) -> Result<String> {
        loop {
            let mut line = String::new();
            if self.from.read_line(&mut line)? == 0 {
                bail!("it ended before it answered");
            }
            if line.starts_with('{') {
                return Ok(line);
            }
        }
    }

    /// The answer to a line.
    pub fn ask(&mut self, what: &str) -> Result<String> {
        let to = self.to.as_mut().context("it takes no more questions")?;
        writeln!(to, "{what}")?;
        to.flush()?;
        self.line().with_context(|| what.to_owned())
    }

    /// Units a second.
    pub fn rate(&mut self, what: &str) -> Result<f64> {
        let line = self.ask(what)?;
        Ok(number(&line, "\"units\":")? / number(&line, "\"seconds\":")?)
    }
}

impl Drop for Partner {
    fn drop(&mut self) {
        // The end of its input is its end.
        drop(self.to.take());
        let _ = self.child.wait();
    }
}

/// The number after a key of one line of JSON that we write ourselves.
pub fn number(line: &str, key: &str) -> Result<f64> {
    let rest = line.split_once(key).with_context(|| format!("no {key} in {line}"))?.1;
    let end = rest.find([',', '}', ']']).unwrap_or(rest.len());
    rest[..end].trim().parse().with_context(|| format!("{key} in {line}"))
}

/// The text after a key of one line of JSON that we write ourselves.
pub fn text<'l>(line: &'l str, key: &str) -> Result<&'l str> {
    let rest = line.split_once(&format!("\"{key}\": \"")).with_context(|| format!("no {key}"))?.1;
    Ok(rest.split('"').next().unwrap_or_default())
}
