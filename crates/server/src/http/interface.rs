//! The participant's and the data interface: routes and their description (OpenAPI 3.1) from one
//! list, so that neither says what the other does not do. The schemas are those of the Rust types.

use axum::Router;
use axum::routing::{MethodFilter, MethodRouter, get, on, post};
use mimique_session::wire::{
    Acknowledged, AppendEvents, Bundle, Complete, PanicReport, Receipt, Refusal, Resume,
    SessionStarted, StartSession, StudySummary, Withdraw, Withdrawn,
};
use mimique_study::PairCount;
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, SchemaGenerator};
use serde_json::{Map, Value, json};

use super::statics;
use crate::export::format::Format;
use crate::participant::{pairs, panics, sessions, studies};
use crate::researcher::handlers::{streams, studies as researcher};
use crate::state::App;

/// Every route of the participants' interface.
pub(super) fn router() -> Router<App> {
    interface().router.route("/api/openapi.json", get(|| async { axum::Json(document()) }))
}

/// The researchers' downloads.
pub(super) fn downloads() -> Router<App> {
    describe_downloads(Interface::new()).router
}

/// The description, as `/api/openapi.json` gives it.
pub(super) fn document() -> Value {
    let mut interface = describe_downloads(interface());
    let refusal = interface.schemas.subschema_for::<Refusal>();
    let schemas = interface.schemas.take_definitions(true);
    json!({
        "openapi": "3.1.0",
        "info": {
            "title": "Mimique",
            "version": env!("CARGO_PKG_VERSION"),
            "description": "What passes between a participant's page and the server. An append is \
                idempotent: an event is known by session and sequence. Every refusal is a `Refusal`. \
                Researchers' scripts export with a token, made on the page of one's account.",
            "license": {"name": "MIT OR Apache-2.0"},
        },
        "paths": interface.paths,
        "components": {
            "schemas": schemas,
            "securitySchemes": {"token": {
                "type": "http",
                "scheme": "bearer",
                "description": "A token of an analyst or owner, made at /researcher/account",
            }},
            "responses": {"Refusal": {
                "description": "Why the request is refused, and what to do about it",
                "content": {"application/json": {"schema": refusal}},
            }},
        },
    })
}

fn interface() -> Interface {
    Interface::new()
        .read::<Vec<StudySummary>>(
            "/api/studies",
            &[],
            "The studies of this server",
            get(studies::list),
        )
        .read::<Bundle>(
            "/api/studies/{study}",
            &["config_hash"],
            "All that a page needs of a study, or of an earlier version of it",
            get(studies::bundle),
        )
        .send::<StartSession, ()>(
            "/api/studies/{study}/arrivals",
            "Ask whether somebody could begin; nothing is written",
            post(sessions::arrive),
        )
        .send::<StartSession, SessionStarted>(
            "/api/studies/{study}/sessions",
            "Start a session; the same nonce finds the same session. Its place is held for a minute until \
             its first events come",
            post(sessions::start),
        )
        .read::<Resume>(
            "/api/sessions/{session}",
            &[],
            "All that a page needs to go on after a reload",
            get(sessions::resume),
        )
        .send::<AppendEvents, Acknowledged>(
            "/api/sessions/{session}/events",
            "Append events; answered after they are on disk",
            post(sessions::append),
        )
        .read::<Vec<PairCount>>(
            "/api/sessions/{session}/pairs/{component}",
            &[],
            "What all others answered to the pairs of a block, under which the next pairs are drawn",
            get(pairs::counts),
        )
        .send::<Complete, Receipt>(
            "/api/sessions/{session}/complete",
            "Say that all is sent; the answer is the receipt",
            post(sessions::complete),
        )
        .send::<Withdraw, Withdrawn>(
            "/api/sessions/{session}/withdraw",
            "Delete the answers",
            post(sessions::withdraw),
        )
        .send::<PanicReport, ()>(
            "/api/panics",
            "Report a panic of a page's module, for the server's log",
            panics::route(),
        )
        .bytes("/packs/{hash}", "A pack by its SHA-256", on(MethodFilter::GET, statics::pack))
}

/// What scripts fetch with a token.
fn describe_downloads(interface: Interface) -> Interface {
    const STUDY: &str = "/researcher/studies/{study}";
    let mut words: Vec<&str> = Format::ALL.iter().map(|format| format.word()).collect();
    words.extend(["dictionary", "stimuli", "courses", "study"]);
    let export = Download {
        summary: "Export: csv is the tidy table, wide one row a participant, json the tidy rows as JSON \
            lines, events what is stored as JSON lines, tracks a row per picture of participants' faces, psych-ds a folder in an archive, dictionary \
            what every column means, stimuli a row per clip with what was measured of it, courses a row per frame of the clips that faces are held against, study the study file",
        words: &[("format", &words)],
        queries: &[],
        flags: &[
            ("with_identifiers", "Recruitment identifiers stand in columns of their own"),
            (
                "neutralised",
                "Cells that a spreadsheet would take for a formula begin with an apostrophe",
            ),
        ],
        types: &[
            "text/csv; charset=utf-8",
            "application/x-ndjson",
            "application/json",
            "application/zip",
        ],
    };
    let report = Download {
        summary: "The report: report.html, report.zip with everything, or one file of it by its path",
        words: &[("language", &["en", "fr"])],
        queries: &[],
        flags: &[],
        types: &["text/html; charset=utf-8", "application/zip", "application/octet-stream"],
    };
    let events = Download {
        summary: "Server-sent events: each event of the study's sessions within a second after it is stored (`event` its \
            type, `id` PARTICIPANT.SEQUENCE, `data` JSON with participant, condition, stage, config_hash and the event); \
            from now on, or from the beginning",
        words: &[("from", &["now", "beginning"])],
        queries: &["from"],
        flags: &[],
        types: &["text/event-stream"],
    };
    interface
        .download(&format!("{STUDY}/events"), &events, get(streams::events))
        .download(&format!("{STUDY}/export/{{format}}"), &export, get(researcher::export))
        .download(
            &format!("{STUDY}/report/{{language}}/{{*name}}"),
            &report,
            get(researcher::report),
        )
}

/// A download in words.
struct Download<'a> {
    summary: &'a str,
    /// What stands in the address or in a query, where it is one of some words.
    words: &'a [(&'a str, &'a [&'a str])],
    /// Queries of such words.
    queries: &'a [&'a str],
    /// Queries that are `true` or `false`.
    flags: &'a [(&'a str, &'a str)],
    types: &'a [&'a str],
}

/// Routes and their description as far as they are listed.
struct Interface {
    router: Router<App>,
    paths: Map<String, Value>,
    schemas: SchemaGenerator,
}

impl Interface {
    fn new() -> Self {
        let settings = SchemaSettings::draft2020_12().with(|settings| {
            settings.definitions_path = "/components/schemas".into();
            settings.meta_schema = None;
        });
        Self { router: Router::new(), paths: Map::new(), schemas: settings.into_generator() }
    }

    fn read<A: JsonSchema>(
        mut self,
        path: &str,
        queries: &[&str],
        summary: &str,
        route: MethodRouter<App>,
    ) -> Self {
        let answer = json!({"application/json": {"schema": self.schemas.subschema_for::<A>()}});
        let operation = operation(path, queries, summary, answer);
        self.add(path, "get", operation, route)
    }

    fn send<B: JsonSchema, A: JsonSchema>(
        mut self,
        path: &str,
        summary: &str,
        route: MethodRouter<App>,
    ) -> Self {
        let answer = json!({"application/json": {"schema": self.schemas.subschema_for::<A>()}});
        let mut operation = operation(path, &[], summary, answer);
        let body = self.schemas.subschema_for::<B>();
        operation["requestBody"] =
            json!({"required": true, "content": {"application/json": {"schema": body}}});
        self.add(path, "post", operation, route)
    }

    fn bytes(self, path: &str, summary: &str, route: MethodRouter<App>) -> Self {
        let operation = operation(path, &[], summary, json!({"application/octet-stream": {}}));
        self.add(path, "get", operation, route)
    }

    fn download(self, path: &str, download: &Download<'_>, route: MethodRouter<App>) -> Self {
        let content: Map<String, Value> =
            download.types.iter().map(|kind| ((*kind).to_owned(), json!({}))).collect();
        let mut operation = operation(path, download.queries, download.summary, content.into());
        operation["security"] = json!([{"token": []}]);
        if let Some(parameters) = operation["parameters"].as_array_mut() {
            for parameter in &mut *parameters {
                let known = download.words.iter().find(|(name, _)| parameter["name"] == **name);
                if let Some((_, words)) = known {
                    parameter["schema"]["enum"] = json!(words);
                }
            }
            parameters.extend(download.flags.iter().map(|(name, description)| {
                json!({"name": name, "in": "query", "description": description,
                    "schema": {"type": "boolean"}})
            }));
        }
        self.add(path, "get", operation, route)
    }

    fn add(mut self, path: &str, method: &str, operation: Value, route: MethodRouter<App>) -> Self {
        self.paths.insert(path.replace("{*", "{"), json!({method: operation}));
        self.router = self.router.route(path, route);
        self
    }
}

fn operation(path: &str, queries: &[&str], summary: &str, answer: Value) -> Value {
    let named = path.split('{').skip(1).filter_map(|rest| rest.split('}').next());
    let named = named.map(|name| name.trim_start_matches('*'));
    let text = json!({"type": "string"});
    let parameters: Vec<Value> = named
        .map(|name| json!({"name": name, "in": "path", "required": true, "schema": text}))
        .chain(queries.iter().map(|name| json!({"name": name, "in": "query", "schema": text})))
        .collect();
    json!({
        "summary": summary,
        "parameters": parameters,
        "responses": {
            "200": {"description": "Done", "content": answer},
            "4XX": {"$ref": "#/components/responses/Refusal"},
            "5XX": {"$ref": "#/components/responses/Refusal"},
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `MIMIQUE_UPDATE_GOLDEN=1 cargo test` writes it anew; look at the difference before you keep it.
    #[test]
    fn the_description_is_the_one_in_the_repository() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/openapi.json");
        let current = serde_json::to_string_pretty(&document()).unwrap() + "\n";
        if std::env::var_os("MIMIQUE_UPDATE_GOLDEN").is_some() {
            std::fs::write(&path, &current).unwrap();
        }
        let stored = std::fs::read_to_string(&path).unwrap_or_default();
        let same = stored == current;
        assert!(
            same,
            "{} is not current; write it anew with MIMIQUE_UPDATE_GOLDEN=1",
            path.display()
        );
    }

    #[test]
    fn every_reference_leads_somewhere() {
        let document = document();
        let text = document.to_string();
        let mut references = 0;
        for part in text.split("\"$ref\":\"#").skip(1) {
            let pointer = part.split('"').next().unwrap();
            assert!(document.pointer(pointer).is_some(), "{pointer}");
            references += 1;
        }
        assert!(references > 20, "{references}");
    }
}
