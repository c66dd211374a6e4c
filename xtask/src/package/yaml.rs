//! YAML, read for tests: manifests of winget and the release workflow.

use saphyr::{LoadableYamlNode as _, YamlOwned};

/// The only document of a text.
pub fn read(text: &str) -> YamlOwned {
    let documents =
        YamlOwned::load_from_str(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(documents.len(), 1, "{text}");
    documents.into_iter().next().expect("one document")
}

/// The workflow of a release builds every target and runs the commands that there are.
#[test]
fn the_release_workflow_is_yaml_that_builds_every_target() {
    let path = crate::process::root().join(".github/workflows/release.yml");
    let text = std::fs::read_to_string(&path).unwrap();
    let workflow = read(&text);
    let jobs = workflow["jobs"].as_mapping().expect("jobs");
    assert!(jobs.len() >= 3, "{} jobs", jobs.len());
    for (name, job) in jobs {
        let steps = job["steps"].as_sequence().unwrap_or_else(|| panic!("{name:?}: no steps"));
        let does = |key: &str| steps.iter().any(|step| step.as_mapping_get(key).is_some());
        assert!(does("run") || does("uses"), "{name:?}");
        assert!(job.as_mapping_get("runs-on").is_some(), "{name:?}: on no machine");
    }
    for target in super::target::TARGETS.iter().filter(|target| !target.is_linux()) {
        assert!(text.contains(target.triple), "{}", target.triple);
    }
    assert!(text.contains("cargo xtask package --check"));
}
