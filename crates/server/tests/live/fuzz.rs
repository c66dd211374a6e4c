//! The interface as it describes itself, asked everything that schemathesis can think of.

use std::process::Command;

use mimique_test_support::{python, skip};

use crate::child::Server;

#[test]
fn nothing_that_is_sent_makes_the_server_fail() {
    let test = "nothing_that_is_sent_makes_the_server_fail";
    let Some(python) = python(test) else { return };
    let program = python.with_file_name("schemathesis");
    if !program.exists() {
        return skip(test, "schemathesis is not in the Python environment; run cargo xtask test");
    }
    let folder = tempfile::tempdir().unwrap();
    let url = format!("sqlite:{}", folder.path().join("answers.sqlite").display());
    let server = Server::start(&url);
    let output = Command::new(program)
        .arg("run")
        .arg(format!("http://127.0.0.1:{}/api/openapi.json", server.port))
        .args(["--checks", "not_a_server_error", "--max-examples", "25", "--max-time", "30"])
        .args(["--seed", "1", "--no-color", "--warnings", "off"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}\n{}", String::from_utf8_lossy(&output.stderr));
    assert!(said.contains("8 selected / 8 total") || said.contains("Operations:"), "{said}");
}
