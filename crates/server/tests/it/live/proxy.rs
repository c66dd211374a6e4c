//! Behind nginx: TLS, and two servers of which one is killed.

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use mimique_test_support::skip;

use crate::client::block_on;
use crate::live::child::Server;
use crate::live::people::{Person, acknowledged, answer_while, compare, exchange, text_of};
use crate::postgres::Cluster;

/// nginx in the foreground; gone when dropped.
struct Nginx(Child);

impl Drop for Nginx {
    fn drop(&mut self) {
        // Its workers end with it when it is asked.
        let _ = Command::new("kill").args(["-QUIT", &self.0.id().to_string()]).status();
        std::thread::sleep(Duration::from_millis(100));
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn free_port() -> u16 {
    std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port()
}

fn nginx(test: &str) -> Option<&'static str> {
    let found = ["/usr/sbin/nginx", "/usr/local/sbin/nginx", "/opt/homebrew/bin/nginx"]
        .into_iter()
        .find(|path| Path::new(path).exists());
    if found.is_none() {
        skip(test, "nginx not found; install the package nginx-light");
    }
    found
}

/// Where nginx listens.
struct Ports {
    plain: u16,
    secure: u16,
    /// Passes requests on without TLS, for people who speak none here.
    inner: u16,
}

/// The configuration of `docs/guide/deployment/nginx.conf`, with this test's ports and files.
fn configuration(folder: &Path, ports: &Ports, servers: &[u16]) -> String {
    let template = include_str!("../../../../../docs/guide/deployment/nginx.conf");
    let Ports { plain, secure, inner } = ports;
    let upstream: String = servers
        .iter()
        .map(|port| format!("server 127.0.0.1:{port} max_fails=1 fail_timeout=1s;\n"))
        .collect();
    let folder = folder.display();
    let mut site = template.to_owned();
    for (theirs, ours) in [
        ("server 127.0.0.1:8080;\n", upstream),
        ("listen 80;", format!("listen 127.0.0.1:{plain};")),
        ("listen 443 ssl;", format!("listen 127.0.0.1:{secure} ssl;")),
        ("/etc/ssl/study/fullchain.pem", format!("{folder}/cert.pem")),
        ("/etc/ssl/study/privkey.pem", format!("{folder}/key.pem")),
        ("/var/log/nginx/mimique.log", format!("{folder}/mimique.log")),
    ] {
        assert!(site.contains(theirs), "{theirs}");
        site = site.replace(theirs, &ours);
    }
    let temporary: String = ["client_body", "proxy", "fastcgi", "uwsgi", "scgi"]
        .map(|kind| format!("{kind}_temp_path {folder}/{kind};\n"))
        .concat();
    let user = if is_root() { "user root;\n" } else { "" };
    format!(
        "daemon off; pid {folder}/nginx.pid; error_log {folder}/error.log warn;\n\
         worker_processes 1; {user}events {{ worker_connections 256; }}\n\
         http {{ {temporary}{site}\n\
         server {{ listen 127.0.0.1:{inner}; location / {{ proxy_pass http://mimique; }} }} }}\n"
    )
}

fn is_root() -> bool {
    use std::os::unix::fs::MetadataExt;
    std::fs::metadata("/proc/self").is_ok_and(|data| data.uid() == 0)
}

fn start(program: &str, folder: &Path, ports: &Ports, servers: &[u16]) -> Nginx {
    let made = Command::new("openssl")
        .args([
            "req",
            "-x509",
            "-newkey",
            "rsa:2048",
            "-nodes",
            "-days",
            "2",
            "-subj",
            "/CN=localhost",
        ])
        .args(["-addext", "subjectAltName=DNS:localhost", "-keyout", "key.pem", "-out", "cert.pem"])
        .current_dir(folder)
        .stderr(Stdio::null())
        .status()
        .unwrap();
    assert!(made.success());
    let path = folder.join("nginx.conf");
    std::fs::write(&path, configuration(folder, ports, servers)).unwrap();
    let child = Command::new(program)
        .arg("-c")
        .arg(&path)
        .arg("-p")
        .arg(folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let nginx = Nginx(child);
    for _ in 0..200 {
        if std::net::TcpStream::connect(("127.0.0.1", ports.secure)).is_ok() {
            return nginx;
        }
        std::thread::sleep(Duration::from_millis(25));
    }
    let log = std::fs::read_to_string(folder.join("error.log")).unwrap_or_default();
    panic!("nginx did not start: {log}");
}

/// The answer to a question for a page over TLS.
fn over_tls(folder: &Path, port: u16, path: &str) -> String {
    sent_over_tls(folder, port, &text_of("GET", path, ""))
}

/// The answer to a request over TLS, the certificate checked.
fn sent_over_tls(folder: &Path, port: u16, request: &str) -> String {
    let mut client = Command::new("openssl")
        .args(["s_client", "-quiet", "-verify_return_error", "-servername", "localhost"])
        .args(["-verify_hostname", "localhost", "-CAfile", "cert.pem", "-connect"])
        .arg(format!("127.0.0.1:{port}"))
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut input = client.stdin.take().unwrap();
    std::io::Write::write_all(&mut input, request.as_bytes()).unwrap();
    let output = client.wait_with_output().unwrap();
    drop(input);
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn one_of_two_servers_behind_nginx_is_killed_under_load() {
    let test = "one_of_two_servers_behind_nginx_is_killed_under_load";
    let Some(program) = nginx(test) else { return };
    let Some(cluster) = Cluster::start(test) else { return };
    let url = block_on(cluster.fresh_database("replicas"));
    let (first, second) = (Server::start(&url), Server::start(&url));
    let folder = tempfile::tempdir().unwrap();
    let ports = Ports { plain: free_port(), secure: free_port(), inner: free_port() };
    let _nginx = start(program, folder.path(), &ports, &[first.port, second.port]);

    // What is not encrypted is sent elsewhere; what is passes through, with all that browsers are told.
    let (status, _) = exchange(ports.plain, text_of("GET", "/s/faces/", "").as_bytes()).unwrap();
    assert_eq!(status, 308);
    let page = over_tls(folder.path(), ports.secure, "/s/faces/").to_ascii_lowercase();
    for expected in [
        "http/1.1 200",
        "strict-transport-security: max-age=31536000",
        "x-content-type-options: nosniff",
        "content-security-policy: default-src 'none'",
        "<!doctype html>",
    ] {
        assert!(page.contains(expected), "{expected}: {page}");
    }
    assert!(
        over_tls(folder.path(), ports.secure, "/metrics").contains(" 404 "),
        "not for the world"
    );

    a_form_arrives(folder.path(), ports.secure);
    let mut people = Person::several(6);
    answer_while(&mut people, &[ports.inner], || {
        std::thread::sleep(Duration::from_millis(600));
        first.kill();
        std::thread::sleep(Duration::from_millis(900));
    });
    assert!(people.iter().all(|person| person.acknowledged > 0));
    let (all, unanswered) =
        (acknowledged(&people), people.iter().map(|person| person.unanswered).sum::<u64>());
    assert!(unanswered < all / 4, "{unanswered} of {all} were not answered");
    block_on(compare(&url, &people));
    // Neither addresses nor tokens, though a server died in the middle of requests.
    let logs = ["error.log", "mimique.log"]
        .map(|name| std::fs::read_to_string(folder.path().join(name)).unwrap_or_default());
    for private in ["client:", "127.0.0.1,", "/api/sessions/"] {
        assert!(logs.iter().all(|log| !log.contains(private)), "{private} in {logs:?}");
    }
}

/// A form of a page whose address has a port of its own is taken for the page's.
fn a_form_arrives(folder: &Path, port: u16) {
    let host = format!("localhost:{port}");
    let ask =
        format!("GET /researcher/login HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n");
    let page = sent_over_tls(folder, port, &ask);
    let between = |start: &str, end: char| {
        let (_, rest) = page.split_once(start).unwrap_or_else(|| panic!("{start}: {page}"));
        rest.split(end).next().unwrap_or_default().to_owned()
    };
    let cookie = between("__Host-mimique_form=", ';');
    let body = format!("csrf={}&email=a%40b&password=x", between("name=\"csrf\" value=\"", '"'));
    let request = format!(
        "POST /researcher/login HTTP/1.1\r\nHost: {host}\r\nOrigin: https://{host}\r\n\
         Cookie: __Host-mimique_form={cookie}\r\nConnection: close\r\nContent-Length: {}\r\n\
         Content-Type: application/x-www-form-urlencoded\r\n\r\n{body}",
        body.len()
    );
    let answer = sent_over_tls(folder, port, &request);
    assert!(!answer.contains("foreign-form"), "{answer}");
    assert!(
        answer.contains("name=\"password\""),
        "the page again, for the wrong password: {answer}"
    );
}
