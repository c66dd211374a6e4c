//! The interface as it describes itself, asked everything that schemathesis can think of.

use std::process::Command;

use mimique_storage::Storage;
use mimique_test_support::{python, skip};
use serde_json::Value;

use crate::client::block_on;
use crate::live::child::Server;
use crate::live::owner::add_owner;
use crate::live::people::exchange;

/// What a script of an owner sends.
const TOKEN: &str = "mimique_fuzz";

/// An owner with a token: then the researchers' addresses are reached too.
async fn with_owner(url: &str) {
    let storage = Storage::open(url).await.unwrap();
    add_owner(&storage, TOKEN).await;
    storage.close().await;
}

/// How many operations the interface describes of itself.
fn operations(port: u16) -> usize {
    const METHODS: [&str; 5] = ["get", "put", "post", "delete", "patch"];
    let request = b"GET /api/openapi.json HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
    let (status, body) = exchange(port, request).unwrap();
    assert_eq!(status, 200);
    let document: Value = serde_json::from_str(&body).unwrap();
    let paths = document["paths"].as_object().unwrap();
    let named = paths.values().flat_map(|path| path.as_object().unwrap().keys());
    named.filter(|name| METHODS.contains(&name.as_str())).count()
}

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
    block_on(with_owner(&url));
    let server = Server::start(&url);
    // The token is one, or everything behind it would be refused at the door.
    let export = "/researcher/studies/faces/export/csv";
    let request = format!(
        "GET {export} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\nAuthorization: Bearer {TOKEN}\r\n\r\n"
    );
    assert_eq!(exchange(server.port, request.as_bytes()).unwrap().0, 200);
    let output = Command::new(program)
        .arg("run")
        .arg(format!("http://127.0.0.1:{}/api/openapi.json", server.port))
        .args(["--checks", "not_a_server_error", "--max-examples", "25", "--max-time", "30"])
        .args(["--header", &format!("Authorization: Bearer {TOKEN}")])
        .args(["--seed", "1", "--no-color", "--warnings", "off"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}\n{}", String::from_utf8_lossy(&output.stderr));
    let all = operations(server.port);
    assert!(all > 0);
    assert!(said.contains(&format!("{all} selected / {all} total")), "{all}: {said}");
}
