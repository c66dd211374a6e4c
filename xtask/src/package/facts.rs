//! What every package says of Mimique, each fact once: name, version, licence, where releases stand.

/// Name of the program and of its packages.
pub const NAME: &str = "mimique";
/// Name of the npm package of element, canvas and worker.
pub const STAGE: &str = "@mimique/stage";
/// Name of the npm package of the plugin of jsPsych.
pub const JSPSYCH_PLUGIN: &str = "@mimique/jspsych-plugin";
/// The version of the workspace.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
/// The licence of the workspace, an SPDX expression.
pub const LICENCE: &str = env!("CARGO_PKG_LICENSE");
/// The address of the repository, as `Cargo.toml` states it, and nothing else does.
pub const REPOSITORY: &str = env!("CARGO_PKG_REPOSITORY");
/// One line.
pub const SUMMARY: &str =
    "Perceptual studies of avatar faces: capture, animation, questions, statistics";
/// Who publishes, as CITATION.cff has it.
pub const PUBLISHER: &str = "The Mimique maintainers";
/// Where Debian packages say that their maintainer is reached: a placeholder, like the repository's address.
pub const MAINTAINER_MAIL: &str = "maintainers@example.org";

/// Where a file of this version's release is downloaded from.
pub fn release_address(file: &str) -> String {
    format!("{REPOSITORY}/releases/download/v{VERSION}/{file}")
}
