//! Writes the shader modules: each is the shared declarations followed by its files, without comments and
//! indentation, because the browser downloads them. With the feature `webgl` the modules are also parsed
//! here, so that the canvas for WebGL2 does not contain a parser of WGSL.

use std::fs;
use std::path::{Path, PathBuf};

const FOLDER: &str = "src/shaders";

/// Declarations that every module begins with.
const SHARED: &str = "scene";

/// The modules and the files of each, in order. A module has the name of its first file.
const MODULES: [&[&str]; 7] = [
    &["deform"],
    &["encode"],
    &["occlusion"],
    &["shade", "hair", "creases"],
    &["soften"],
    &["strain"],
    &["surface"],
];

fn main() {
    println!("cargo::rerun-if-changed={FOLDER}");
    println!("cargo::rerun-if-changed=build.rs");
    let into = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    for files in MODULES {
        let text: String = [SHARED].iter().chain(files).map(|name| bare(name)).collect();
        fs::write(into.join(format!("{}.wgsl", files[0])), &text).expect("OUT_DIR can be written");
        #[cfg(feature = "webgl")]
        fs::write(into.join(format!("{}.naga", files[0])), parsed(files[0], &text))
            .expect("OUT_DIR can be written");
    }
}

/// The text of one file. WGSL has no text in which `//` could be anything but a comment.
fn bare(name: &str) -> String {
    let path = Path::new(FOLDER).join(format!("{name}.wgsl"));
    let text = fs::read_to_string(&path).expect("a shader is text");
    assert!(!text.contains("/*"), "{}: write comments as `//`", path.display());
    let lines = text.lines().map(|line| line.split("//").next().unwrap_or_default().trim());
    lines.filter(|line| !line.is_empty()).flat_map(|line| [line, "\n"]).collect()
}

/// Naga's representation of a module, without the declarations that it does not use.
#[cfg(feature = "webgl")]
fn parsed(name: &str, text: &str) -> Vec<u8> {
    let mut module = naga::front::wgsl::parse_str(text)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string_with_path(text, name)));
    naga::compact::compact(&mut module, naga::compact::KeepUnused::No);
    postcard::to_allocvec(&module).expect("a module can be serialised")
}
