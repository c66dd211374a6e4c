//! `--to`: a deposit uploaded by a repository's documented interface, or told what would be. The token comes from the
//! environment and goes into one header alone.

mod archive;
mod dataverse;
mod http;
mod state;
mod zenodo;

use std::io::Write as _;
use std::path::Path;

use anyhow::{bail, ensure};
use mimique_deposit::{About, DepositFile};
use mimique_study::Study;
use serde_json::{Value, json};

use self::http::Client;
use self::state::State;

/// Where a deposit goes.
#[derive(clap::Args)]
pub struct Target {
    /// Repository that takes it: zenodo or dataverse. Without --upload it is printed what would be sent
    #[arg(long, value_name = "REPOSITORY")]
    to: Option<Repository>,
    /// Send it: the token is taken from the environment, ZENODO_TOKEN or DATAVERSE_TOKEN. What was begun goes on
    #[arg(long, requires = "to")]
    upload: bool,
    /// To zenodo.org itself, not to the repository for trying (sandbox.zenodo.org, demo.dataverse.org)
    #[arg(long, requires = "to", conflicts_with = "host")]
    real: bool,
    /// Address of the installation, which begins with https
    #[arg(long, requires = "to", value_name = "URL", value_parser = host)]
    host: Option<String>,
    /// Publish it, which cannot be taken back; without it a draft is left to look at
    #[arg(long, requires = "upload")]
    publish: bool,
    /// Dataverse: collection that takes it, by its alias
    #[arg(long, value_name = "ALIAS", default_value = "root")]
    collection: String,
    /// Dataverse: electronic mail address that is shown for questions [default: the study's contact]
    #[arg(long, value_name = "ADDRESS")]
    contact: Option<String>,
    /// Dataverse: subject, out of its own list
    #[arg(long, value_name = "SUBJECT", default_value = "Social Sciences")]
    subject: String,
}

/// A repository of research data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Repository {
    /// Zenodo
    Zenodo,
    /// Dataverse
    Dataverse,
}

/// A request that would be made.
struct Planned {
    method: &'static str,
    path: String,
    what: String,
    body: Option<Value>,
}

impl Planned {
    fn new(method: &'static str, path: impl Into<String>, what: impl Into<String>) -> Self {
        Self { method, path: path.into(), what: what.into(), body: None }
    }

    fn with(self, body: Value) -> Self {
        Self { body: Some(body), ..self }
    }
}

/// What is uploaded.
struct Upload<'a> {
    folder: &'a Path,
    about: &'a About,
    files: &'a [DepositFile],
    publish: bool,
}

/// What became of it.
struct Done {
    /// Where it is looked at.
    address: String,
    sent: usize,
    there: usize,
    published: bool,
}

/// An address that a token may be sent to: over TLS, or on this machine.
fn host(text: &str) -> Result<String, String> {
    let address = text.trim_end_matches('/');
    let here = ["http://127.0.0.1", "http://localhost", "http://[::1]"];
    let is_here = here.iter().any(|start| {
        address.strip_prefix(start).is_some_and(|rest| rest.is_empty() || rest.starts_with(':'))
    });
    let name = address.strip_prefix("https://").unwrap_or_default();
    if is_here || (!name.is_empty() && !name.contains(['/', '?', '#', '@', ' '])) {
        return Ok(address.to_owned());
    }
    Err("give scheme and host, such as https://data.example.org".to_owned())
}

impl Repository {
    fn word(self) -> &'static str {
        match self {
            Self::Zenodo => "zenodo",
            Self::Dataverse => "dataverse",
        }
    }

    fn token_variable(self) -> &'static str {
        match self {
            Self::Zenodo => "ZENODO_TOKEN",
            Self::Dataverse => "DATAVERSE_TOKEN",
        }
    }

    fn for_trying(self) -> &'static str {
        match self {
            Self::Zenodo => "https://sandbox.zenodo.org",
            Self::Dataverse => "https://demo.dataverse.org",
        }
    }

    /// Where a token is made.
    fn token_page(self, host: &str) -> String {
        match self {
            Self::Zenodo => format!(
                "{host}/account/settings/applications/tokens/new (scopes deposit:write and deposit:actions)"
            ),
            Self::Dataverse => format!("{host}/dataverseuser.xhtml?selectTab=apiTokenTab"),
        }
    }
}

impl Target {
    /// Whether the options can be followed, before anything is computed.
    pub fn check(&self) -> anyhow::Result<()> {
        let Some(repository) = self.to else { return Ok(()) };
        ensure!(
            !(self.real && repository == Repository::Dataverse),
            "--real: every university has a Dataverse of its own; name yours by --host https://…"
        );
        if self.upload {
            self.token(repository)?;
        }
        Ok(())
    }

    /// Uploads the deposit, or tells what would be sent.
    pub fn run(
        &self,
        folder: &Path,
        about: &About,
        files: &[DepositFile],
        study: &Study,
        json: bool,
    ) -> anyhow::Result<()> {
        let Some(repository) = self.to else { return Ok(()) };
        let host = self.host(repository);
        let upload = Upload { folder, about, files, publish: self.publish };
        let dataset = match repository {
            Repository::Zenodo => Value::Null,
            Repository::Dataverse => {
                mimique_deposit::dataverse_dataset(about, &self.contact(study)?, &self.subject)
            }
        };
        if !self.upload {
            let planned = match repository {
                Repository::Zenodo => zenodo::plan(&upload),
                Repository::Dataverse => dataverse::plan(&upload, &self.collection, &dataset),
            };
            return tell_plan(repository, &host, &planned, json);
        }
        let header = match repository {
            Repository::Zenodo => ("Authorization", format!("Bearer {}", self.token(repository)?)),
            Repository::Dataverse => ("X-Dataverse-key", self.token(repository)?),
        };
        let client = Client::new(&host, header);
        let mut state = State::open(folder, repository.word(), &host)?;
        let done = match repository {
            Repository::Zenodo => zenodo::upload(&client, &mut state, &upload),
            Repository::Dataverse => {
                dataverse::upload(&client, &mut state, &upload, &self.collection, &dataset)
            }
        };
        // What stopped it is told with how to go on.
        let done = done.map_err(|error| {
            error.context(format!("{host} (the same command goes on where this one stopped)"))
        })?;
        tell_done(&host, &done, json)
    }

    fn host(&self, repository: Repository) -> String {
        match (&self.host, self.real) {
            (Some(host), _) => host.clone(),
            (None, true) => "https://zenodo.org".to_owned(),
            (None, false) => repository.for_trying().to_owned(),
        }
    }

    fn token(&self, repository: Repository) -> anyhow::Result<String> {
        let name = repository.token_variable();
        let token = std::env::var(name).unwrap_or_default().trim().to_owned();
        let page = repository.token_page(&self.host(repository));
        if token.is_empty() {
            bail!("{name}: the environment has no token; make one at {page} and set {name} to it");
        }
        if !token.bytes().all(|byte| byte.is_ascii_graphic()) {
            bail!(
                "{name}: a token has letters and digits alone, this has others; copy it anew from {page}"
            );
        }
        Ok(token)
    }

    fn contact(&self, study: &Study) -> anyhow::Result<String> {
        let own = study.contact.as_ref().map(|contact| contact.investigator.email.clone());
        match self.contact.clone().or(own) {
            Some(address) => Ok(address),
            None => bail!(
                "--contact: Dataverse shows an address for questions, and the study has none; give one"
            ),
        }
    }
}

fn tell_plan(
    repository: Repository,
    host: &str,
    planned: &[Planned],
    json: bool,
) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    if json {
        let requests = planned.iter().map(|own| {
            json!({ "method": own.method, "path": own.path, "what": own.what, "body": own.body })
        });
        let requests: Vec<Value> = requests.collect();
        writeln!(out, "{}", json!({ "to": host, "sent": false, "requests": requests }))?;
        return Ok(());
    }
    writeln!(
        out,
        "nothing was sent; --upload would send to {host}, with the token in {}:",
        repository.token_variable()
    )?;
    for own in planned {
        writeln!(out, "  {} {}  {}", own.method, own.path, own.what)?;
        if let Some(body) = &own.body {
            writeln!(out, "    {body}")?;
        }
    }
    Ok(())
}

fn tell_done(host: &str, done: &Done, json: bool) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    let Done { address, sent, there, published } = done;
    if json {
        let value = json!({
            "to": host, "sent": true, "address": address, "files_sent": sent, "files_there_before": there,
            "published": published,
        });
        writeln!(out, "{value}")?;
        return Ok(());
    }
    writeln!(out, "{host}: {sent} files sent, {there} were there; every checksum is right")?;
    match published {
        true => writeln!(out, "  published: {address}")?,
        false => writeln!(
            out,
            "  a draft: look at it and publish it at {address}, or run again with --publish"
        )?,
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::host;

    #[test]
    fn tokens_go_over_tls_or_stay_on_the_machine() {
        for good in ["https://data.example.org/", "http://127.0.0.1:8080", "http://localhost"] {
            assert_eq!(host(good).unwrap(), good.trim_end_matches('/'));
        }
        for bad in [
            "http://data.example.org",
            "http://127.0.0.1.example.org",
            "data.example.org",
            "https://",
            "https://a@b.org",
            "https://a.org/path",
        ] {
            assert!(host(bad).is_err(), "{bad}");
        }
    }
}
