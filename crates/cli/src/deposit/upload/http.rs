//! Requests to one repository: the token in a header and nowhere else, answers as JSON, a bound on how often and how long
//! is waited, and errors that say what to do.

use std::fs::File;
use std::io::{Cursor, Read};
use std::path::Path;
use std::time::Duration;

use anyhow::{Context as _, anyhow, bail};
use serde_json::Value;
use ureq::http::{Response, Uri};
use ureq::{Agent, SendBody};

/// How often a request is made at most.
const ATTEMPTS: u32 = 5;
/// Longest wait between two attempts.
const LONGEST_WAIT: Duration = Duration::from_secs(120);
/// Largest answer that is read.
const LARGEST_ANSWER: u64 = 64 * 1024 * 1024;

/// What asks one repository.
pub(super) struct Client {
    agent: Agent,
    host: String,
    header: (&'static str, String),
}

/// What is sent with a request.
#[derive(Clone, Copy)]
pub(super) enum Sent<'a> {
    Nothing,
    Json(&'a Value),
    File(&'a Path),
    /// A form with JSON in `jsonData`, and a file under this name.
    Form {
        json: &'a Value,
        name: &'a str,
        file: &'a Path,
    },
}

/// An answer.
pub(super) struct Answer {
    pub status: u16,
    pub body: Value,
}

/// How a request ended that was made.
enum Outcome {
    Answered(Answer),
    /// It may be made again after this time.
    Later(Option<Duration>, String),
    Refused(anyhow::Error),
}

impl Client {
    /// Asks this host, with this header.
    pub fn new(host: &str, header: (&'static str, String)) -> Self {
        let config = Agent::config_builder()
            .http_status_as_error(false)
            // A redirect would take the token somewhere else.
            .max_redirects(0)
            .timeout_connect(Some(Duration::from_secs(30)))
            .timeout_recv_response(Some(Duration::from_secs(300)))
            .user_agent(concat!("mimique/", env!("CARGO_PKG_VERSION")));
        let config = match host.starts_with("https://") {
            true => config,
            // What is on this machine is behind no proxy.
            false => config.proxy(None),
        };
        Self { agent: config.build().into(), host: host.to_owned(), header }
    }

    /// The path of an address of this host; none of another's.
    pub fn path_of<'a>(&self, address: &'a str) -> Option<&'a str> {
        address.strip_prefix(&*self.host).filter(|path| path.starts_with('/'))
    }

    /// A path of this host as an address.
    pub fn address(&self, path: &str) -> String {
        format!("{}{path}", self.host)
    }

    /// Makes a request that may be made twice, as often as it takes within the bound.
    pub fn repeatable(
        &self,
        method: &'static str,
        path: &str,
        sent: Sent<'_>,
    ) -> anyhow::Result<Answer> {
        let mut waited = Vec::new();
        loop {
            match self.once(method, path, sent) {
                Outcome::Answered(answer) => return Ok(answer),
                Outcome::Refused(error) => return Err(error),
                Outcome::Later(after, why) => self.wait(&mut waited, after, method, path, &why)?,
            }
        }
    }

    /// Makes a request that makes something: it is made again where the repository says that nothing was made, or where
    /// `is_made` finds nothing; what that finds stands in the place of the answer.
    pub fn making(
        &self,
        path: &str,
        sent: Sent<'_>,
        is_made: &dyn Fn() -> anyhow::Result<Option<Answer>>,
    ) -> anyhow::Result<Answer> {
        let mut waited = Vec::new();
        loop {
            match self.once("POST", path, sent) {
                Outcome::Answered(answer) => return Ok(answer),
                Outcome::Refused(error) => return Err(error),
                Outcome::Later(after, why) => {
                    self.wait(&mut waited, after, "POST", path, &why)?;
                    if let Some(answer) = is_made()? {
                        return Ok(answer);
                    }
                }
            }
        }
    }

    /// Waits as long as the repository asks, else twice as long each time; gives up after [`ATTEMPTS`].
    fn wait(
        &self,
        waited: &mut Vec<Duration>,
        after: Option<Duration>,
        method: &str,
        path: &str,
        why: &str,
    ) -> anyhow::Result<()> {
        let attempts = waited.len() as u32 + 1;
        if attempts >= ATTEMPTS {
            bail!(
                "{method} {path}: {why}, {attempts} times; look whether the repository is well, and run the command later"
            );
        }
        let wait = after.unwrap_or(Duration::from_secs(1 << waited.len())).min(LONGEST_WAIT);
        eprintln!("{method} {path}: {why}; again in {} s", wait.as_secs());
        std::thread::sleep(wait);
        waited.push(wait);
        Ok(())
    }

    fn once(&self, method: &'static str, path: &str, sent: Sent<'_>) -> Outcome {
        let answered = match self.send(method, path, sent) {
            Ok(answered) => answered,
            Err(Failed::Here(error)) => return Outcome::Refused(error),
            Err(Failed::There(error)) => return Outcome::Later(None, self.without_token(&error)),
        };
        let status = answered.status().as_u16();
        let after = answered.headers().get("retry-after").and_then(|value| value.to_str().ok());
        let after = after.and_then(|text| text.trim().parse().ok()).map(Duration::from_secs);
        let to = answered.headers().get("location").and_then(|value| value.to_str().ok());
        let to = to.unwrap_or_default().to_owned();
        let text = answered.into_body().into_with_config().limit(LARGEST_ANSWER).read_to_string();
        let text = match text {
            Ok(text) => text,
            Err(error) => return Outcome::Later(None, self.without_token(&error.to_string())),
        };
        let body: Value = serde_json::from_str(&text).unwrap_or(Value::Null);
        match status {
            200..300 | 404 => Outcome::Answered(Answer { status, body }),
            429 | 500.. => Outcome::Later(after, format!("{status} {}", said(&body))),
            _ => {
                let words = self.without_token(&said(&body));
                Outcome::Refused(anyhow!(
                    "{method} {path}: {status} {words}{}",
                    remedy(status, &to)
                ))
            }
        }
    }

    fn send(
        &self,
        method: &'static str,
        path: &str,
        sent: Sent<'_>,
    ) -> Result<Response<ureq::Body>, Failed> {
        let address: Uri = format!("{}{path}", self.host)
            .parse()
            .map_err(|error| Failed::Here(anyhow!("{path}: no address ({error})")))?;
        let (name, value) = &self.header;
        let there = |error: ureq::Error| Failed::There(error.to_string());
        let here = |error: anyhow::Error| Failed::Here(error);
        if method == "GET" {
            return self.agent.get(address).header(*name, value).call().map_err(there);
        }
        let request = match method {
            "PUT" => self.agent.put(address),
            _ => self.agent.post(address),
        };
        let request = request.header(*name, value);
        match sent {
            Sent::Nothing => request.send_empty().map_err(there),
            Sent::Json(value) => {
                request.content_type("application/json").send(value.to_string()).map_err(there)
            }
            Sent::File(path) => {
                let file = opened(path).map_err(here)?;
                request.content_type("application/octet-stream").send(file).map_err(there)
            }
            Sent::Form { json, name, file } => {
                let form = Form::of(json, name, file).map_err(here)?;
                let request = request.header("Content-Length", form.bytes.to_string());
                let request = request
                    .content_type(format!("multipart/form-data; boundary={}", Form::BOUNDARY));
                request.send(SendBody::from_owned_reader(form.reader)).map_err(there)
            }
        }
    }

    /// A message of somebody else's, which might say our token back.
    fn without_token(&self, text: &str) -> String {
        let token = self.header.1.trim_start_matches("Bearer ");
        text.replace(token, "(the token)")
    }
}

/// Why nothing came back.
enum Failed {
    /// It was not sent.
    Here(anyhow::Error),
    /// The network, or the repository.
    There(String),
}

/// `multipart/form-data` of JSON and a file, which is read while it is sent.
struct Form {
    reader: Box<dyn Read>,
    bytes: u64,
}

impl Form {
    /// It stands in no JSON of ours, and where it stood in a file it would be there by intent alone.
    const BOUNDARY: &str = "mimique-deposit-7d6c1f0e9b3a48528c1d";

    fn of(json: &Value, name: &str, path: &Path) -> anyhow::Result<Self> {
        let boundary = Self::BOUNDARY;
        let name = name.replace(['"', '\r', '\n'], "_");
        let head = format!(
            "--{boundary}\r\nContent-Disposition: form-data; name=\"jsonData\"\r\n\r\n{json}\r\n\
             --{boundary}\r\nContent-Disposition: form-data; name=\"file\"; filename=\"{name}\"\r\n\
             Content-Type: application/octet-stream\r\n\r\n"
        );
        let tail = format!("\r\n--{boundary}--\r\n");
        let file = opened(path)?;
        let size = file.metadata().with_context(|| path.display().to_string())?.len();
        let bytes = (head.len() + tail.len()) as u64 + size;
        let reader = Cursor::new(head.into_bytes())
            .chain(file.take(size))
            .chain(Cursor::new(tail.into_bytes()));
        Ok(Self { reader: Box::new(reader), bytes })
    }
}

fn opened(path: &Path) -> anyhow::Result<File> {
    File::open(path).with_context(|| path.display().to_string())
}

/// What the repository says, in one line.
fn said(body: &Value) -> String {
    let mut words: Vec<String> = body["message"].as_str().map(str::to_owned).into_iter().collect();
    for error in body["errors"].as_array().into_iter().flatten() {
        let field = error["field"].as_str().unwrap_or_default();
        let message =
            error["message"].as_str().map_or_else(|| error["messages"].to_string(), str::to_owned);
        words.push(format!("{field}: {message}"));
    }
    words.join("; ").replace(['\n', '\r'], " ")
}

/// What to do about an answer that refuses.
fn remedy(status: u16, to: &str) -> String {
    match status {
        300..=399 => format!("; it stands at {to} now: name that host by --host"),
        401 => "; the token is not known there: make one at this very host (those for trying have their own)".to_owned(),
        403 => "; the token may not do this: give it the right to write and to publish, or ask for it in the collection".to_owned(),
        413 => "; it is too large for the repository: leave the clips out by --no-stimuli, or ask for more".to_owned(),
        _ => "; correct what it names".to_owned(),
    }
}
