//! A private PostgreSQL cluster for one test: made in a temporary folder, on loopback, gone after.

use std::net::TcpListener;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use mimique_test_support::skip;
use sqlx::{AssertSqlSafe, Connection, PgConnection};

/// A running cluster; stopped and deleted when dropped.
pub struct Cluster {
    binaries: PathBuf,
    folder: tempfile::TempDir,
    port: u16,
}

impl Cluster {
    /// Starts one, or says that the test is skipped where PostgreSQL is not installed. What it has
    /// committed survives its own end, not the machine's: tests need no more and are quicker.
    pub fn start(test: &str) -> Option<Self> {
        Self::start_with(test, "-c fsync=off")
    }

    /// The same with these settings.
    pub fn start_with(test: &str, settings: &str) -> Option<Self> {
        let Some(binaries) = binaries() else {
            skip(test, "PostgreSQL's initdb not found; install the package postgresql");
            return None;
        };
        let folder = tempfile::tempdir().unwrap();
        // PostgreSQL's own user has to reach the folder where we are root.
        std::fs::set_permissions(folder.path(), std::fs::Permissions::from_mode(0o777)).unwrap();
        let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
        let cluster = Self { binaries, folder, port };
        let data = cluster.data();
        let log = cluster.folder.path().join("log");
        cluster.run(&format!(
            "initdb --pgdata={data} --username=mimique --auth=trust --no-sync --encoding=UTF8 \
             --locale=C"
        ));
        cluster.run(&format!(
            "pg_ctl --pgdata={data} --log={} --wait start -o '-p {port} -c listen_addresses=127.0.0.1 \
             -c unix_socket_directories={} -c max_connections=50 {settings}'",
            log.display(),
            cluster.folder.path().display(),
        ));
        Some(cluster)
    }

    /// The address of a new database.
    pub async fn fresh_database(&self, name: &str) -> String {
        // PostgreSQL cuts names at 63 bytes.
        let name = &name[..name.len().min(60)];
        let server = format!("postgres://mimique@127.0.0.1:{}", self.port);
        let mut connection = PgConnection::connect(&format!("{server}/postgres")).await.unwrap();
        sqlx::query(AssertSqlSafe(format!("CREATE DATABASE \"{name}\"")))
            .execute(&mut connection)
            .await
            .unwrap();
        format!("{server}/{name}")
    }

    /// Changes a setting for everybody, now.
    pub async fn set(&self, name: &str, value: &str) {
        let server = format!("postgres://mimique@127.0.0.1:{}/postgres", self.port);
        let mut connection = PgConnection::connect(&server).await.unwrap();
        for statement in [
            // The connection itself may be under the setting that it is to change.
            "SET default_transaction_read_only = off".to_owned(),
            format!("ALTER SYSTEM SET {name} = {value}"),
            "SELECT pg_reload_conf()".to_owned(),
        ] {
            sqlx::query(AssertSqlSafe(statement)).execute(&mut connection).await.unwrap();
        }
    }

    /// Stops (`fast`: rolling back; `immediate`: as if killed) and starts.
    pub fn restart(&self, mode: &str) {
        let log = self.folder.path().join("log");
        self.run(&format!(
            "pg_ctl --pgdata={} --log={} --mode={mode} --wait restart",
            self.data(),
            log.display()
        ));
    }

    /// Turns on TLS with a certificate for 127.0.0.1; the certificate to trust.
    pub fn use_tls(&self) -> PathBuf {
        let data = self.data();
        self.shell(&format!(
            "cd {data} && openssl req -x509 -newkey rsa:2048 -nodes -days 2 -subj /CN=test-ca \
             -keyout ca.key -out ca.crt && openssl req -newkey rsa:2048 -nodes -subj /CN=127.0.0.1 \
             -keyout server.key -out server.csr && printf 'subjectAltName=IP:127.0.0.1' > san && \
             openssl x509 -req -in server.csr -CA ca.crt -CAkey ca.key -CAcreateserial -days 2 \
             -extfile san -out server.crt && chmod 600 server.key && \
             echo 'ssl = on' >> postgresql.conf && cp ca.crt .. && chmod 644 ../ca.crt"
        ));
        self.restart("fast");
        self.folder.path().join("ca.crt")
    }

    fn data(&self) -> String {
        self.folder.path().join("data").display().to_string()
    }

    /// Runs one of PostgreSQL's programs, as its own user where we are root (it refuses root).
    fn run(&self, command_line: &str) {
        let output = self.output(command_line);
        assert!(
            output.status.success(),
            "{command_line}: {}{}",
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr),
        );
    }

    fn output(&self, command_line: &str) -> Output {
        self.shell_output(&format!("{}/{command_line}", self.binaries.display()))
    }

    fn shell(&self, command_line: &str) {
        let output = self.shell_output(command_line);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
    }

    fn shell_output(&self, command_line: &str) -> Output {
        let mut command = if is_root() {
            let mut command = Command::new("su");
            command.args(["postgres", "-s", "/bin/sh", "-c", command_line]);
            command
        } else {
            let mut command = Command::new("sh");
            command.args(["-c", command_line]);
            command
        };
        // The server keeps what it inherits: a pipe would never close.
        let text = self.folder.path().join("output");
        let file = std::fs::File::create(&text).unwrap();
        let status = command
            .current_dir(self.folder.path())
            .stdin(std::process::Stdio::null())
            .stdout(file.try_clone().unwrap())
            .stderr(file)
            .status()
            .unwrap();
        Output { status, stdout: std::fs::read(&text).unwrap_or_default(), stderr: Vec::new() }
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        let data = self.data();
        self.output(&format!("pg_ctl --pgdata={data} --mode=immediate --wait stop"));
    }
}

/// The folder of `initdb`: the newest version that Debian has, or the search path's.
fn binaries() -> Option<PathBuf> {
    let mut versions: Vec<PathBuf> = std::fs::read_dir("/usr/lib/postgresql")
        .into_iter()
        .flatten()
        .filter_map(|entry| Some(entry.ok()?.path().join("bin")))
        .collect();
    versions.sort();
    let path = std::env::var_os("PATH").unwrap_or_default();
    let holds = |folder: &PathBuf| folder.join("initdb").exists() && folder.join("pg_ctl").exists();
    versions.into_iter().rev().chain(std::env::split_paths(&path)).find(holds)
}

fn is_root() -> bool {
    use std::os::unix::fs::MetadataExt;
    std::fs::metadata(Path::new("/proc/self")).is_ok_and(|data| data.uid() == 0)
}
