//! Twins of a file: what people and programs do to captures on the way. A benign twin holds the same
//! capture; a hostile one says something else than its rows, or lost some of them.

use std::fmt::Write as _;

/// A twin of a file.
pub struct Twin {
    /// What was done.
    pub name: String,
    /// The twin.
    pub bytes: Vec<u8>,
    /// Whether it holds the same capture.
    pub benign: bool,
}

/// What the rules need to know of a text format.
pub struct Form {
    /// [`mimique_mocap::Format::id`].
    pub id: &'static str,
    /// What parts the fields.
    pub delimiter: char,
    /// Whether a line is the last before the rows.
    pub last_of_header: fn(&str) -> bool,
    /// Whether fields may be quoted.
    pub quotes: bool,
    /// Whether lines that start with `#` are comments.
    pub comments: bool,
    /// Other delimiters that the format is found with, and whether with decimal commas.
    pub others: &'static [(char, bool)],
    /// Whether rows may stand in any order, or nothing in them tells it.
    pub any_order: bool,
    /// Benign replacements in the text: what is done, what, by what.
    pub benign: &'static [(&'static str, &'static str, &'static str)],
    /// Hostile ones.
    pub hostile: &'static [(&'static str, &'static str, &'static str)],
}

/// The twins of a file of a text format. `fronts` are beginnings of files of other formats.
pub fn text_twins(form: &Form, text: &str, fronts: &[(String, String)]) -> Vec<Twin> {
    let mut twins = Vec::new();
    let mut add = |benign: bool, name: &str, bytes: Vec<u8>| {
        twins.push(Twin { name: name.to_owned(), bytes, benign });
    };
    for (name, bytes) in encodings(text) {
        add(true, name, bytes);
    }
    for (name, text) in layouts(form, text) {
        add(true, &name, text.into_bytes());
    }
    for (name, text) in damaged(form, text) {
        add(false, name, text.into_bytes());
    }
    for (list, benign) in [(form.benign, true), (form.hostile, false)] {
        for (name, what, by) in list.iter().filter(|(_, what, _)| text.contains(what)) {
            add(benign, name, text.replacen(what, by, 1).into_bytes());
        }
    }
    for (other, front) in fronts.iter().filter(|(other, _)| other != form.id) {
        add(
            false,
            &format!("the beginning of {other} in front"),
            format!("{front}{text}").into_bytes(),
        );
    }
    twins
}

/// The same characters in other bytes.
fn encodings(text: &str) -> Vec<(&'static str, Vec<u8>)> {
    let utf16 = |order: fn(u16) -> [u8; 2]| -> Vec<u8> {
        "\u{feff}".encode_utf16().chain(text.encode_utf16()).flat_map(order).collect()
    };
    vec![
        ("CRLF", text.replace('\n', "\r\n").into_bytes()),
        ("CR", text.replace('\n', "\r").into_bytes()),
        ("byte order mark", format!("\u{feff}{text}").into_bytes()),
        ("UTF-16, little-endian", utf16(u16::to_le_bytes)),
        ("UTF-16, big-endian", utf16(u16::to_be_bytes)),
    ]
}

/// The first line of the rows, counted from 0.
fn first_row(form: &Form, lines: &[&str]) -> usize {
    let header = lines.iter().position(|line| (form.last_of_header)(line));
    let rows = header.map_or(0, |line| line + 1);
    rows + lines[rows..].iter().take_while(|line| line.trim().is_empty()).count()
}

/// Lines as a text.
fn joined(lines: &[impl AsRef<str>]) -> String {
    lines.iter().fold(String::new(), |mut text, line| {
        let _ = writeln!(text, "{}", line.as_ref());
        text
    })
}

/// The same capture laid out otherwise.
fn layouts(form: &Form, text: &str) -> Vec<(String, String)> {
    let lines: Vec<&str> = text.lines().collect();
    let first = first_row(form, &lines);
    let every = |change: &dyn Fn(&str) -> String| -> String {
        let row =
            |(at, line): (usize, &&str)| if at < first { (*line).to_owned() } else { change(line) };
        joined(&lines.iter().enumerate().map(row).collect::<Vec<_>>())
    };
    let mut twins = vec![
        ("no end of the last line".to_owned(), text.trim_end_matches('\n').to_owned()),
        ("blank lines at the end".to_owned(), format!("{text}\n\n  \n")),
        ("blanks at the end of rows".to_owned(), every(&|line| format!("{line}  "))),
        ("a blank line among the rows".to_owned(), {
            let mut lines = lines.clone();
            lines.insert(first + 2, "");
            joined(&lines)
        }),
    ];
    if form.quotes {
        let quoted = |line: &str| {
            let fields: Vec<String> =
                line.split(form.delimiter).map(|f| format!("\"{f}\"")).collect();
            fields.join(&form.delimiter.to_string())
        };
        twins.push(("quoted fields".to_owned(), every(&quoted)));
    }
    if form.comments {
        let mut lines = lines.clone();
        lines.insert(first, "# a comment");
        twins.push(("a comment".to_owned(), joined(&lines)));
    }
    for &(other, comma) in form.others {
        let change = |c: char| match c {
            _ if c == form.delimiter => other,
            '.' if comma => ',',
            _ => c,
        };
        // Decimal commas are written in rows; names keep their dots.
        let line = |(at, line): (usize, &&str)| -> String {
            let names = at < first && !line.starts_with("100");
            line.chars().map(|c| if names && c == '.' { c } else { change(c) }).collect()
        };
        let changed: Vec<String> = lines.iter().enumerate().map(line).collect();
        let name = format!("parted by {other:?}{}", if comma { ", decimal commas" } else { "" });
        twins.push((name, joined(&changed)));
    }
    twins
}

/// A capture whose rows are no longer what they were.
fn damaged(form: &Form, text: &str) -> Vec<(&'static str, String)> {
    let lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let first = first_row(form, &lines.iter().map(String::as_str).collect::<Vec<_>>());
    let d = form.delimiter.to_string();
    let with = |change: &dyn Fn(&mut Vec<String>)| {
        let mut lines = lines.clone();
        change(&mut lines);
        joined(&lines)
    };
    let fields = |change: &dyn Fn(&mut Vec<&str>)| {
        with(&|lines| {
            let line = lines[first + 3].clone();
            let mut fields: Vec<&str> = line.split(form.delimiter).collect();
            change(&mut fields);
            lines[first + 3] = fields.join(&d);
        })
    };
    let last = lines.last().map_or("", String::as_str);
    let cut = text.trim_end().len() - last.len() + last.rfind(form.delimiter).unwrap_or(0);
    let middle = cut - last[..cut + last.len() - text.trim_end().len()].len() / 2;
    let mut twins = vec![
        ("a row twice", with(&|lines| lines.insert(first + 3, lines[first + 3].clone()))),
        (
            "a row missing",
            with(&|lines| {
                lines.remove(first + 3);
            }),
        ),
        ("a row short", fields(&|fields| fields.truncate(fields.len() - 1))),
        ("a row of half its columns", fields(&|fields| fields.truncate(fields.len().div_ceil(2)))),
        ("a row long", fields(&|fields| fields.push("7"))),
        ("a row with a number more in it", fields(&|fields| fields.insert(fields.len() / 2, "7"))),
        (
            "a row of other numbers of columns",
            fields(&|fields| {
                fields.remove(fields.len() / 2);
            }),
        ),
        ("words for a number", fields(&|fields| *fields.last_mut().unwrap() = "lost")),
        ("infinity for a number", fields(&|fields| *fields.last_mut().unwrap() = "inf")),
        ("two points in a number", fields(&|fields| *fields.last_mut().unwrap() = "1.2.3")),
        ("cut before the last number", text[..cut].to_owned()),
        ("cut in the last row", text[..middle].to_owned()),
        ("no rows", joined(&lines[..first])),
        ("two files in one", format!("{text}{text}")),
        ("rows twice", joined(&[&lines[..], &lines[first..]].concat())),
    ];
    if !form.any_order {
        twins.push(("two rows change places", with(&|lines| lines.swap(first + 2, first + 4))));
    }
    twins
}

impl Form {
    /// The rows of a file.
    pub fn rows(&self, text: &str) -> usize {
        let lines: Vec<&str> = text.lines().collect();
        lines.len() - first_row(self, &lines)
    }

    /// What the replacements look for.
    pub fn replaced(&self) -> impl Iterator<Item = &'static str> {
        self.benign.iter().chain(self.hostile).map(|(_, what, _)| *what)
    }
}
