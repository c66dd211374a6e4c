//! The examples of deployment: their options are the binary's, their files what they say they are.

use std::collections::BTreeSet;
use std::process::Command;

use mimique_test_support::{python, repository, skip};

use crate::support::{ok, text};

fn example(name: &str) -> String {
    let path = repository().join("docs/guide/deployment").join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The options (`--word`) of a text.
fn options(text: &str) -> BTreeSet<&str> {
    text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '-'))
        .filter(|word| word.len() > 3 && word.starts_with("--") && !word[2..].starts_with('-'))
        .collect()
}

/// What follows `mimique serve` until the command's end.
fn served(file: &str) -> &str {
    let start = file.find("mimique serve ").expect("it starts the server");
    let rest = &file[start..];
    // The unit's command is a line; those in YAML go on in lines that are set in further.
    let lines = if file.contains("ExecStart=") { 1 } else { 4 };
    let end = rest.match_indices('\n').nth(lines - 1).map_or(rest.len(), |(at, _)| at);
    &rest[..end]
}

#[test]
fn the_examples_use_options_that_there_are() {
    let help = ok(&["serve", "--help"]);
    let known = options(&help);
    for name in ["mimique.service", "compose.yaml", "kubernetes.yaml"] {
        let file = example(name);
        let used = options(served(&file));
        assert!(used.contains("--behind-tls") && used.len() >= 3, "{name}: {used:?}");
        let unknown: Vec<_> = used.difference(&known).collect();
        assert!(unknown.is_empty(), "{name}: {unknown:?}");
    }
}

#[test]
fn the_unit_is_one_that_systemd_takes() {
    let test = "the_unit_is_one_that_systemd_takes";
    let folder = tempfile::tempdir().expect("a folder");
    let unit = folder.path().join("mimique.service");
    // It looks whether the program is there.
    let file = example("mimique.service");
    let ours = file.replace("/usr/local/bin/mimique", env!("CARGO_BIN_EXE_mimique"));
    assert_ne!(file, ours);
    std::fs::write(&unit, ours).expect("a file");
    let Ok(output) = Command::new("systemd-analyze").arg("verify").arg(&unit).output() else {
        // Not everybody has systemd: this is no fault of the machine.
        eprintln!("SKIPPED {test}: systemd-analyze not found");
        return;
    };
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.trim().is_empty(), "{said}");
}

#[test]
fn compose_and_kubernetes_have_the_shape_that_they_need() {
    let test = "compose_and_kubernetes_have_the_shape_that_they_need";
    let Some(python) = python(test) else { return };
    let look = r#"
import sys, yaml
compose = yaml.safe_load(open(sys.argv[1]))
services = compose["services"]
assert set(services) == {"database", "study", "study-2", "proxy"}, services
for name, service in services.items():
    assert isinstance(service["image"], str), name
    for volume in service.get("volumes", []):
        source = volume.split(":")[0]
        assert source.startswith("./") or source in compose["volumes"], (name, volume)
    for secret in service.get("secrets", []):
        assert secret in compose["secrets"], (name, secret)
    for other in service.get("depends_on", []):
        assert other in services, (name, other)
assert services["study"]["command"] == services["study-2"]["command"]
parts = {part["kind"]: part for part in yaml.safe_load_all(open(sys.argv[2]))}
assert set(parts) == {"Deployment", "Service", "Ingress"}, set(parts)
spec = parts["Deployment"]["spec"]
template = spec["template"]
assert spec["replicas"] >= 2
labels = template["metadata"]["labels"]
assert spec["selector"]["matchLabels"] == labels == parts["Service"]["spec"]["selector"]
[container] = template["spec"]["containers"]
volumes = {volume["name"] for volume in template["spec"]["volumes"]}
assert {mount["name"] for mount in container["volumeMounts"]} == volumes
port = container["ports"][0]["containerPort"]
for probe, path in [("livenessProbe", "/healthz"), ("readinessProbe", "/readyz")]:
    assert container[probe]["httpGet"] == {"path": path, "port": port}, container[probe]
assert parts["Service"]["spec"]["ports"][0]["targetPort"] == port
backend = parts["Ingress"]["spec"]["rules"][0]["http"]["paths"][0]["backend"]["service"]
assert backend == {"name": parts["Service"]["metadata"]["name"],
                   "port": {"number": parts["Service"]["spec"]["ports"][0]["port"]}}, backend
print("sound")
"#;
    let has_yaml = Command::new(&python).args(["-c", "import yaml"]).output().expect("Python");
    if !has_yaml.status.success() {
        return skip(test, "Python has no yaml; run cargo xtask test");
    }
    let folder = repository().join("docs/guide/deployment");
    let output = Command::new(python)
        .args(["-c", look])
        .args(["compose.yaml", "kubernetes.yaml"].map(|name| text(&folder.join(name))))
        .output()
        .expect("Python");
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(said.trim(), "sound", "{}", String::from_utf8_lossy(&output.stderr));
}
