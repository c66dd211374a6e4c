//! Questions of a command where its options leave something open: a question a line, the answers from any reader.

use std::io::{BufRead, Write};

use anyhow::bail;

/// Whom to ask, and where the questions stand.
pub struct Asker<'a, R, W> {
    /// The answers, a line each.
    pub input: &'a mut R,
    /// Where questions are written.
    pub out: &'a mut W,
    /// The command whose options say the same.
    pub command: &'static str,
}

impl<R: BufRead, W: Write> Asker<'_, R, W> {
    /// An answer as it is typed, without the spaces around it.
    pub fn line(&mut self, question: &str) -> anyhow::Result<String> {
        write!(self.out, "{question}: ")?;
        self.out.flush()?;
        let mut answer = String::new();
        if self.input.read_line(&mut answer)? == 0 {
            writeln!(self.out)?;
            bail!(
                "{question}: there is no answer; answer it, or give options ({} --help)",
                self.command
            );
        }
        Ok(answer.trim().to_owned())
    }

    /// An answer, or none where it is empty.
    pub fn optional(&mut self, question: &str) -> anyhow::Result<Option<String>> {
        Ok(Some(self.line(question)?).filter(|answer| !answer.is_empty()))
    }

    /// An answer whose parts stand between commas.
    pub fn list(&mut self, question: &str) -> anyhow::Result<Vec<String>> {
        let answer = self.line(question)?;
        let parts = answer.split(',').map(|part| part.trim().to_owned());
        Ok(parts.filter(|part| !part.is_empty()).collect())
    }

    /// Asks until the answer can be read.
    pub fn until<T>(
        &mut self,
        question: &str,
        read: impl Fn(&str) -> Result<T, String>,
    ) -> anyhow::Result<T> {
        loop {
            let answer = self.line(question)?;
            match read(&answer) {
                Ok(value) => return Ok(value),
                Err(why) => writeln!(self.out, "{answer:?}: {why}")?,
            }
        }
    }
}
