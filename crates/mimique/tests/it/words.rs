//! What errors, helps and documents tell people to type exists: every command and every option that they
//! name.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use proc_macro2::{TokenStream, TokenTree};

use crate::support::ok;

/// Options that are not ours, by who has them.
const OF_OTHERS: [&str; 24] = [
    // cargo and its tests
    "--release",
    "--test",
    "--example",
    "--bench",
    "--target",
    "--nocapture",
    // cargo xtask
    "--no-serve",
    "--browser",
    "--only",
    "--record",
    "--plot",
    "--rounds",
    "--stats",
    "--annotate",
    "--layout",
    "--server",
    "--verdicts",
    "--study",
    "--runs",
    "--check",
    "--built",
    // chmod's long name, in a recipe
    "--chmod",
    // podman
    "--ulimit",
    // sha256sum
    "--ignore-missing",
];

/// The options of every command, by its words: `account list`. Those of no command stand under "".
fn commands() -> BTreeMap<String, BTreeSet<String>> {
    let mut found = BTreeMap::new();
    let mut open = vec![Vec::<String>::new()];
    while let Some(words) = open.pop() {
        let mut args = words.clone();
        args.push("--help".to_owned());
        let help = ok(&args);
        let mut listing = false;
        for line in help.lines() {
            match line.strip_prefix("  ") {
                Some(row) if listing && !row.starts_with(' ') => {
                    let name = row.split_whitespace().next().unwrap_or_default();
                    if name != "help" {
                        open.push(words.iter().cloned().chain([name.to_owned()]).collect());
                    }
                }
                _ => listing = line == "Commands:",
            }
        }
        found.insert(words.join(" "), options_in(&help).collect());
    }
    found
}

/// The words of a text that look like options.
fn options_in(text: &str) -> impl Iterator<Item = String> + '_ {
    let ends = |c: char| !(c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-');
    text.match_indices("--").filter_map(move |(at, _)| {
        let before = text[..at].chars().next_back();
        let apart = before.is_none_or(|c| !(c.is_alphanumeric() || c == '-' || c == '_'));
        let rest = &text[at..];
        let option = &rest[..rest.find(ends).unwrap_or(rest.len())];
        let named = option.len() > 3 && option.as_bytes()[2].is_ascii_lowercase();
        // An arrow of a drawing goes on.
        let ended = !option.ends_with('-') && !rest[option.len()..].starts_with('_');
        (apart && named && ended).then(|| option.to_owned())
    })
}

/// Everything under a folder whose name ends so.
fn files(folder: &Path, ending: &str, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files(&path, ending, found);
        } else if path.extension().is_some_and(|e| e == ending) {
            found.push(path);
        }
    }
}

/// The texts between quotes in code, documentation comments among them.
fn quoted(tokens: TokenStream, found: &mut Vec<String>) {
    for token in tokens {
        match token {
            TokenTree::Group(group) => quoted(group.stream(), found),
            TokenTree::Literal(literal) => {
                let text = literal.to_string();
                if text.starts_with('"') || text.starts_with("r\"") || text.starts_with("r#") {
                    // Continued lines are one line.
                    let lines: Vec<&str> = text.split("\\\n").map(str::trim_start).collect();
                    found.push(lines.concat());
                }
            }
            TokenTree::Ident(_) | TokenTree::Punct(_) => {}
        }
    }
}

/// The texts that people read: quoted texts of the programs, lines of the documents.
fn texts() -> Vec<(PathBuf, String)> {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let (mut code, mut pages) = (Vec::new(), vec![repository.join("README.md")]);
    // Pages name no options; what looks like one there is a variable of a style sheet.
    for entry in std::fs::read_dir(repository.join("crates")).expect("crates") {
        files(&entry.expect("a crate").path().join("src"), "rs", &mut code);
    }
    files(&repository.join("docs"), "md", &mut pages);
    files(&repository.join("study-config"), "md", &mut pages);
    let mut texts = Vec::new();
    for file in code {
        let text = std::fs::read_to_string(&file).expect("a source file");
        let mut found = Vec::new();
        quoted(text.parse().expect("tokens"), &mut found);
        texts.extend(found.into_iter().map(|text| (file.clone(), text)));
    }
    for page in pages {
        let text = std::fs::read_to_string(&page).expect("a page").replace("\\\n", " ");
        texts.extend(text.lines().map(|line| (page.clone(), line.to_owned())));
    }
    texts
}

/// The command that a text names at this place, and what stands behind it up to the end of the quotation.
fn command_at<'t>(
    text: &'t str,
    commands: &BTreeMap<String, BTreeSet<String>>,
) -> Option<(String, &'t str)> {
    let end = text.find(['`', '\n', ';', '|', '"', '(']).unwrap_or(text.len());
    let text = &text[..end];
    let words: Vec<&str> = text.split_whitespace().take(2).collect();
    let two = words.join(" ");
    let name = if commands.contains_key(&two) { two } else { words.first()?.to_string() };
    Some((name, text))
}

#[test]
fn every_option_and_command_that_is_named_exists() {
    let commands = commands();
    assert!(commands.len() > 20 && commands["solve"].contains("--mocap-rate"), "{commands:?}");
    let all: BTreeSet<&String> = commands.values().flatten().collect();
    let mut wrong = Vec::new();
    let (mut options, mut named) = (0, 0);
    for (file, text) in texts() {
        // The variables of a style sheet look like options.
        if text.contains("var(--") {
            continue;
        }
        let file = file.display();
        for option in options_in(&text) {
            options += 1;
            if !all.contains(&option) && !OF_OTHERS.contains(&option.as_str()) {
                wrong.push(format!("{file}: {option}, which no command has: {text}"));
            }
        }
        for (at, _) in text.match_indices("mimique ") {
            let before = text[..at].chars().next_back();
            let is_command = text[at + 8..].starts_with(|c: char| c.is_ascii_lowercase())
                && before.is_none_or(|c| "`($ \"/".contains(c))
                && !matches!(before, Some(' ')) | text[..at].ends_with("$ ");
            if !is_command {
                continue;
            }
            let Some((name, call)) = command_at(&text[at + 8..], &commands) else { continue };
            named += 1;
            match commands.get(&name) {
                None => wrong.push(format!("{file}: no command {name:?}: {text}")),
                Some(own) => wrong.extend(
                    options_in(call)
                        .filter(|o| !own.contains(o) && !commands[""].contains(o))
                        .map(|o| format!("{file}: mimique {name} has no {o}: {text}")),
                ),
            }
        }
    }
    assert!(options > 200 && named > 60, "{options} options, {named} commands were looked at");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
