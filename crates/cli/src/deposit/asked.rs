//! What is personal, in words: asked where somebody sits at the terminal, refused where nobody does.

use std::io::{BufRead, IsTerminal as _, Write};

use mimique_deposit::{Answers, Finding, Rare, addresses_in_study};
use mimique_locale::counted_as;
use serde_json::Value;

use crate::asker::Asker;

/// A finding: what it is answered by, how much there is of it, where it begins, why it is looked at.
pub(super) fn words(finding: &Finding) -> String {
    let Finding { key, is_question, kind, values, people, first_line, .. } = finding;
    let what = if *is_question { "answers to " } else { "" };
    let values = counted_as(*values, "value", "values");
    let people = counted_as(*people, "participant", "participants");
    format!("{what}{key}: {values} of {people}, first in line {first_line}: {}", kind.words())
}

/// Why nothing was written: every finding that nobody has answered.
pub(super) fn refusal(place: &str, unanswered: &[Finding]) -> String {
    let mut lines = vec![format!("{place}: this may say who somebody is, and is not answered")];
    lines.extend(unanswered.iter().map(|finding| format!("  {}", words(finding))));
    let mut keys: Vec<&str> = unanswered.iter().map(|finding| &*finding.key).collect();
    keys.dedup();
    lines.push(format!(
        "leave it out by --drop {}, or look at it and keep it by --keep; --texts keep or drop answers for all texts; \
         nothing was written",
        keys.join(",")
    ));
    lines.join("\n")
}

/// Asks about what is not answered, where a person is at the terminal.
pub(super) fn ask_what_is_open(answers: &mut Answers, findings: &[Finding]) -> anyhow::Result<()> {
    let (stdin, mut stderr) = (std::io::stdin(), std::io::stderr());
    if !(stdin.is_terminal() && stderr.is_terminal()) {
        return Ok(());
    }
    ask(answers, findings, &mut stdin.lock(), &mut stderr)
}

/// Asks about each key that is not answered, once.
fn ask(
    answers: &mut Answers,
    findings: &[Finding],
    input: &mut impl BufRead,
    out: &mut impl Write,
) -> anyhow::Result<()> {
    let mut asker = Asker { input, out, command: "mimique deposit" };
    loop {
        let open = answers.judge(findings).unanswered;
        let Some(first) = open.first() else { return Ok(()) };
        let key = first.key.clone();
        for finding in open.iter().filter(|finding| finding.key == key) {
            writeln!(asker.out, "{}", words(finding))?;
        }
        let kept = asker.until(&format!("{key}: keep or drop"), |answer| match answer {
            "keep" | "k" => Ok(true),
            "drop" | "d" => Ok(false),
            _ => Err("answer keep or drop".to_owned()),
        })?;
        if kept { &mut answers.keep } else { &mut answers.drop }.insert(key);
    }
}

/// People who are told apart by what they said of themselves.
pub(super) fn note_of_rare(rare: &Rare) -> String {
    let alone = match rare.alone {
        1 => "1 participant is".to_owned(),
        many => format!("{many} participants are each"),
    };
    format!(
        "{alone} the only one of {} with this combination of answers about themselves ({}); leave columns out by --drop if \
         somebody could know them by it",
        rare.people,
        rare.columns.join(", ")
    )
}

/// What in the study file looks like an address; participants were shown it.
pub(super) fn notes_of_study(file: &Value) -> Vec<String> {
    let note = |(pointer, pattern): (String, mimique_deposit::Pattern)| {
        format!(
            "study file: {pointer} {}; it is deposited, since participants were shown it",
            pattern.words()
        )
    };
    addresses_in_study(file).into_iter().map(note).collect()
}

#[cfg(test)]
mod tests {
    use mimique_deposit::{Kind, Pattern};

    use super::*;

    fn finding(key: &str, kind: Kind) -> Finding {
        Finding {
            file: "a.csv".into(),
            key: key.into(),
            is_question: false,
            kind,
            values: 3,
            people: 1,
            first_line: 7,
        }
    }

    #[test]
    fn each_key_is_asked_once_until_it_is_answered() {
        let findings = [
            finding("remarks", Kind::FreeText),
            finding("remarks", Kind::Looks(Pattern::EmailAddress)),
            finding("start_time", Kind::ClockTime),
        ];
        let mut answers = Answers::default();
        let mut said = Vec::new();
        ask(&mut answers, &findings, &mut &b"perhaps\nd\nkeep\n"[..], &mut said).unwrap();
        assert!(answers.drop.contains("remarks") && answers.keep.contains("start_time"));
        let said = String::from_utf8(said).unwrap();
        assert_eq!(said.matches("remarks: keep or drop").count(), 2, "{said}");
        assert!(said.contains("e-mail address") && said.contains("answer keep or drop"), "{said}");
        assert!(answers.judge(&findings).unanswered.is_empty());
        let mut open = Answers::default();
        let ended = ask(&mut open, &findings, &mut &b""[..], &mut Vec::new()).unwrap_err();
        assert!(ended.to_string().contains("mimique deposit --help"), "{ended}");
    }

    #[test]
    fn a_refusal_names_everything_and_what_to_do() {
        let text = refusal("a.csv", &[finding("start_time", Kind::ClockTime)]);
        assert!(
            text.contains(
                "start_time: 3 values of 1 participant, first in line 7: time of the clock"
            )
        );
        assert!(
            text.contains("--drop start_time") && text.ends_with("nothing was written"),
            "{text}"
        );
    }
}
