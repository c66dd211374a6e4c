//! Short names on the border between a module and its script.
//!
//! wasm-bindgen ends the name of everything that crosses with a hash of 16 hexadecimal digits, which
//! no gzip makes smaller, and says it in both files. Here each gets a number.

use std::collections::HashMap;

use anyhow::{Context as _, Result, bail};

/// Sections of a module that name what crosses (WebAssembly 5.5.2).
const IMPORTS: u8 = 2;
const EXPORTS: u8 = 7;
/// Digits of a hash.
const DIGITS: usize = 16;

/// Script and module with `$0`, `$1`... for every name that ends with a hash, in the order of the
/// script. An error where the module says no such name.
pub fn shortened(script: &str, wasm: &[u8]) -> Result<(String, Vec<u8>)> {
    let mut names: HashMap<&str, String> = HashMap::new();
    let mut short = String::with_capacity(script.len());
    for token in tokens(script) {
        if ends_with_hash(token) {
            let next = names.len();
            short.push_str(names.entry(token).or_insert_with(|| format!("${next}")));
        } else {
            short.push_str(token);
        }
    }
    Ok((short, renamed(wasm, &names)?))
}

/// A text in pieces: words of a script, and what stands between them.
fn tokens(text: &str) -> impl Iterator<Item = &str> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '$';
    let mut rest = text;
    std::iter::from_fn(move || {
        let first = rest.chars().next()?;
        let end = rest.find(|c| is_word(c) != is_word(first)).unwrap_or(rest.len());
        let (token, after) = rest.split_at(end);
        rest = after;
        Some(token)
    })
}

/// `..._0123456789abcdef`, or the same with an `h` before the digits.
fn ends_with_hash(word: &str) -> bool {
    let Some((before, digits)) =
        word.len().checked_sub(DIGITS).and_then(|at| word.split_at_checked(at))
    else {
        return false;
    };
    let is_hash = digits.bytes().all(|digit| matches!(digit, b'0'..=b'9' | b'a'..=b'f'));
    is_hash && (before.ends_with('_') || before.ends_with("_h"))
}

/// The module with other names on its border.
fn renamed(wasm: &[u8], names: &HashMap<&str, String>) -> Result<Vec<u8>> {
    let (head, mut rest) = wasm.split_at_checked(8).context("a module without a head")?;
    let mut out = head.to_vec();
    let mut found = 0;
    while let [kind, after @ ..] = rest {
        let (length, after) = number(after).context("a section without a length")?;
        let (section, after) = after.split_at_checked(length).context("a section cut short")?;
        out.push(*kind);
        if matches!(*kind, IMPORTS | EXPORTS) {
            let (section, count) = renamed_in(section, names);
            found += count;
            leb(&mut out, section.len());
            out.extend(section);
        } else {
            leb(&mut out, section.len());
            out.extend(section);
        }
        rest = after;
    }
    if found != names.len() {
        bail!("the module has {found} of the script's {} names with a hash", names.len());
    }
    Ok(out)
}

/// A section with every name (its length, then its bytes) replaced, and how many were.
fn renamed_in(section: &[u8], names: &HashMap<&str, String>) -> (Vec<u8>, usize) {
    let mut out = Vec::with_capacity(section.len());
    let (mut at, mut found) = (0, 0);
    while at < section.len() {
        let name = number(&section[at..]).and_then(|(length, after)| {
            let name = std::str::from_utf8(after.get(..length)?).ok()?;
            Some((names.get(name)?, section.len() - after.len() + length))
        });
        if let Some((short, end)) = name {
            leb(&mut out, short.len());
            out.extend(short.bytes());
            (at, found) = (end, found + 1);
        } else {
            out.push(section[at]);
            at += 1;
        }
    }
    (out, found)
}

/// A number in unsigned LEB128, and what follows it.
fn number(bytes: &[u8]) -> Option<(usize, &[u8])> {
    let mut number = 0;
    for (place, byte) in bytes.iter().enumerate().take(5) {
        number |= usize::from(byte & 127) << (7 * place);
        if byte & 128 == 0 {
            return Some((number, &bytes[place + 1..]));
        }
    }
    None
}

/// Unsigned LEB128.
pub fn leb(out: &mut Vec<u8>, mut number: usize) {
    while number > 127 {
        out.push(number as u8 & 127 | 128);
        number >>= 7;
    }
    out.push(number as u8);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A module with an import, an export and a section that nobody reads.
    fn module(import: &str, export: &str) -> Vec<u8> {
        let mut wasm = b"\0asm\x01\0\0\0".to_vec();
        let mut section = |kind: u8, parts: &[&[u8]]| {
            let bytes = parts.concat();
            wasm.push(kind);
            leb(&mut wasm, bytes.len());
            wasm.extend(bytes);
        };
        let name = |text: &str| [&[text.len() as u8][..], text.as_bytes()].concat();
        section(1, &[b"\x01\x60\0\0"]);
        section(IMPORTS, &[b"\x01", &name("./a_bg.js"), &name(import), b"\0\0"]);
        section(EXPORTS, &[b"\x01", &name(export), b"\0\0"]);
        section(0, &[&name("mark"), &[7; 200]]);
        wasm
    }

    #[test]
    fn both_files_say_the_same_short_name() {
        let (import, export) = ("__wbg_get_0123456789abcdef", "invoke__h00112233445566aa");
        let script = format!("{{ {import}: f }}; function {export}() {{ wasm.{export}(); }}");
        let (script, wasm) = shortened(&script, &module(import, export)).expect("shortened");
        assert_eq!(script, "{ $0: f }; function $1() { wasm.$1(); }");
        assert_eq!(wasm, module("$0", "$1"));
    }

    #[test]
    fn what_ends_otherwise_keeps_its_name() {
        for name in ["__wbindgen_malloc", "abcdefabcdefabcdefab", "x_0123456789abcdeg", "é_1"] {
            let (script, wasm) = shortened(name, &module(name, "run")).expect("left as it is");
            assert_eq!((script.as_str(), wasm), (name, module(name, "run")));
        }
    }

    #[test]
    fn a_name_that_the_module_lacks_is_said() {
        let error = shortened("__wbg_get_0123456789abcdef", &module("a", "b"));
        assert_eq!(
            error.expect_err("it is not there").to_string(),
            "the module has 0 of the script's 1 names with a hash"
        );
    }

    #[test]
    fn numbers_are_leb128() {
        let mut out = Vec::new();
        [0, 127, 128, 624_485].into_iter().for_each(|number| leb(&mut out, number));
        assert_eq!(out, [0, 127, 128, 1, 0xe5, 0x8e, 0x26]);
        assert_eq!(number(&out[4..]), Some((624_485, &[][..])));
    }
}
