//! Source paths of other people's code in a module: of the standard library and of the registry's crates,
//! for messages of panics. They are half a kilobyte of the gzip and name the machine's folders; our own
//! paths stay, and a panic inside a library is nearly always told at the place that called it.

use std::path::PathBuf;

/// Longest path that is looked for, bytes.
const LONGEST: usize = 300;

/// The module with those paths written over by dots, every byte else at its place.
pub fn dotted(module: &[u8]) -> Vec<u8> {
    let registry = cargo_home().join("registry/src/");
    dotted_below(module, &["/rustc/", &registry.to_string_lossy()])
}

fn dotted_below(module: &[u8], folders: &[&str]) -> Vec<u8> {
    let mut out = module.to_vec();
    for folder in folders {
        let mut at = 0;
        while let Some(found) = find(&out[at..], folder.as_bytes()) {
            let start = at + found;
            at = start + folder.len();
            let end = out.len().min(start + LONGEST);
            let length = find(&out[start..end], b".rs").map(|length| length + 3);
            let path = length.and_then(|length| out.get_mut(start..start + length));
            // Anything else that begins like a path is left alone.
            let is_path = |b: &u8| b.is_ascii_alphanumeric() || b"/._-+".contains(b);
            if let Some(path) = path.filter(|path| path.iter().all(is_path)) {
                path.fill(b'.');
            }
        }
    }
    out
}

fn find(bytes: &[u8], what: &[u8]) -> Option<usize> {
    bytes.windows(what.len()).position(|window| window == what)
}

/// Where cargo keeps the registry's crates.
fn cargo_home() -> PathBuf {
    match std::env::var_os("CARGO_HOME") {
        Some(home) => home.into(),
        None => std::env::home_dir().unwrap_or_default().join(".cargo"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_paths_of_others_are_dotted() {
        let module = b"web/app/src/dom.rs/rustc/59/library/alloc/src/str.rscrates/study/src/answer.rs\
            /home/ada/.cargo/registry/src/index-1/js-sys-0.3.107/src/lib.rs\0/rustc/ no path.rs /rustc/";
        let dotted = dotted_below(module, &["/rustc/", "/home/ada/.cargo/registry/src/"]);
        let text = String::from_utf8(dotted).unwrap();
        assert_eq!(text.len(), module.len());
        let expected = [
            "web/app/src/dom.rs",
            &".".repeat("/rustc/59/library/alloc/src/str.rs".len()),
            "crates/study/src/answer.rs",
            &".".repeat("/home/ada/.cargo/registry/src/index-1/js-sys-0.3.107/src/lib.rs".len()),
            "\0/rustc/ no path.rs /rustc/",
        ];
        assert_eq!(text, expected.concat());
    }
}
