//! Dashboard, event store, export, quota, balance and report agree on how every session stands.

use std::collections::{BTreeMap, BTreeSet};

use axum::http::StatusCode;
use mimique_analysis::analyze;
use mimique_locale::Language;
use mimique_server::HostedStudy;
use mimique_server::export::{Format, Options, export};
use mimique_session::flow::Plan;
use mimique_session::wire::{Event, SessionStarted};
use mimique_session::{Record, Standing};
use mimique_stats::Table;
use mimique_study::Study;
use serde_json::{Value, json};

use crate::client::TestServer;
use crate::participant::takes_part;
use crate::study;

/// How many sessions are made.
const SESSIONS: u64 = 45;

/// Numbers that look random and are the same each time (Knuth's linear congruence).
struct Random(u64);

impl Random {
    fn below(&mut self, end: u64) -> u64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % end
    }
}

/// The events of a session that goes so far, gets events that do not fit in between, and ends somehow.
fn log(study: &Study, started: &SessionStarted, random: &mut Random) -> Vec<Event> {
    let ends = [
        None,
        None,
        None,
        None,
        Some(json!({"type": "declined"})),
        Some(json!({"type": "screened_out", "step": "device", "reason": "device",
            "details": ["minimumWidth"]})),
        Some(
            json!({"type": "screened_out", "step": "x", "reason": "screening", "details": ["age"]}),
        ),
        Some(json!({"type": "screened_out", "step": "x", "reason": "training", "details": []})),
        Some(json!({"type": "checks_failed", "failed": 2})),
        Some(json!({"type": "withdrawn"})),
        Some(json!({"type": "finished"})),
    ];
    let end = ends[random.below(ends.len() as u64) as usize].clone();
    let steps = match random.below(3) {
        0 => usize::MAX,
        1 => 0,
        _ => random.below(12) as usize,
    };
    let (mut events, _) = takes_part(study, started, steps);
    let noise = [
        json!({"type": "focus_lost"}),
        json!({"type": "unexpected", "input": "next", "step": "end"}),
        json!({"type": "from_a_later_version", "standing": "completed"}),
        json!({"type": "page_finished", "step": "nowhere", "timed_out": true}),
        json!({"type": "answered", "step": "nowhere", "question": "q", "value": "finished"}),
        json!({"type": "declined"}),
    ];
    // What comes after consent cannot decline any more.
    let first = if events.len() > 1 { 2 } else { events.len() as u64 };
    for _ in 0..random.below(4) {
        let place = first + random.below(events.len() as u64 - first + 1);
        let kinds = if first == 2 { noise.len() } else { 2 };
        let body = noise[random.below(kinds as u64) as usize].clone();
        events.insert(place as usize, Event { sequence: 0, at_ms: 1.79e12, body });
    }
    events.extend(end.map(|body| Event { sequence: 0, at_ms: 1.79e12, body }));
    for (sequence, event) in (0..).zip(&mut events) {
        event.sequence = sequence;
    }
    events
}

fn demo_with(recruitment: Value) -> HostedStudy {
    let mut file = study::demo_file();
    file["exclusions"] = json!({"incomplete": true});
    for (key, value) in recruitment.as_object().unwrap() {
        file["recruitment"][key] = value.clone();
    }
    study::host(file)
}

/// The dashboard's words.
fn word(standing: Standing) -> &'static str {
    match standing {
        Standing::InProgress => "under way",
        Standing::Abandoned => "abandoned",
        Standing::Declined => "declined",
        Standing::DeviceRefused => "device refused",
        Standing::ScreenedOut => "screened out",
        Standing::PracticeFailed => "practice failed",
        Standing::ChecksFailed => "attention checks failed",
        Standing::Withdrawn => "withdrawn",
        Standing::Completed => "completed",
    }
}

fn counted<T: Ord>(items: impl IntoIterator<Item = T>) -> BTreeMap<T, usize> {
    let mut counts = BTreeMap::new();
    for item in items {
        *counts.entry(item).or_default() += 1;
    }
    counts
}

pub async fn everybody_agrees_on_every_session(server: &TestServer) {
    let server = server.restart_with(vec![demo_with(json!({}))]).await;
    let hosted = demo_with(json!({}));
    let mut random = Random(18);
    // What the events say, by participant.
    let mut by_events = BTreeMap::new();
    let mut deleted = BTreeSet::new();
    for nonce in 1..=SESSIONS {
        let started = server.start_in("demo", nonce).await;
        let events = log(hosted.study(), &started, &mut random);
        for part in events.chunks(1 + random.below(40) as usize) {
            server.stored(&started.session, part).await;
        }
        let plan = Plan::new(hosted.study().projection(), started.clone()).unwrap();
        let standing = Record::of(None, &events).standing;
        assert_eq!(Record::of(Some(&plan), &events).standing, standing, "with and without a plan");
        by_events.insert(started.participant, standing);
        // A page asks for its receipt at every end but a refusal to take part and a withdrawal.
        if standing.has_receipt() {
            server.receipt(&started.session, events.len() as u64).await;
        }
        if random.below(8) == 0 {
            server.withdrawn(&started.session, &started.withdrawal_code).await;
            by_events.insert(started.participant, Standing::Withdrawn);
            deleted.insert(started.participant);
        }
    }
    // Every third gave its last sign of life long ago.
    server
        .run_sql("UPDATE sessions SET started_ms = 1, last_event_ms = 1 WHERE participant % 3 = 0")
        .await;
    let now: BTreeMap<u64, Standing> = by_events
        .iter()
        .map(|(number, standing)| (*number, standing.at(1, if number % 3 == 0 { 0 } else { 2 })))
        .collect();
    let found: BTreeSet<Standing> = now.values().copied().collect();
    assert_eq!(found, BTreeSet::from(Standing::ALL), "every standing comes up");

    // The event store.
    for session in server.storage.sessions("demo").await.unwrap() {
        assert_eq!(session.standing, by_events[&session.participant], "{}", session.participant);
    }
    // The dashboard.
    let mut owner = crate::people::owner(&server).await;
    let page = owner.open(&server, "/researcher/studies/demo").await.text();
    let counts = counted(now.values().copied());
    for standing in Standing::ALL {
        let count = counts.get(&standing).copied().unwrap_or(0);
        let wanted = format!("<dt>{}</dt><dd>{count}</dd>", word(standing));
        assert!(page.contains(&wanted), "{wanted} in {page}");
    }
    // The export.
    let exported =
        export(&server.storage, Some("demo"), Format::Csv, Options::default()).await.unwrap();
    let csv = String::from_utf8(exported.files[0].1.clone()).unwrap();
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let rows: Vec<BTreeMap<String, String>> = reader.deserialize().map(Result::unwrap).collect();
    let statuses: BTreeMap<u64, &str> =
        rows.iter().map(|row| (row["participant"].parse().unwrap(), &*row["status"])).collect();
    assert!(statuses.len() > 20, "{statuses:?}");
    for (number, status) in &statuses {
        assert_eq!(*status, by_events[number].export_word(), "{number}");
        assert!(!deleted.contains(number));
    }
    // The balance of what the completed were shown.
    for method in ["box", "lsts30"] {
        let is_shown = |row: &&BTreeMap<String, String>| {
            row["status"] == "completed" && row["trial_type"] == "trial" && row["method"] == method
        };
        let shown = rows.iter().filter(is_shown).map(|row| (&row["participant"], &row["trial_id"]));
        let shown = shown.collect::<BTreeSet<_>>().len();
        let head = format!("<th scope=\"row\">{method}</th>");
        let row = &page[page.find(&head).expect("the method's row")..];
        let row = &row[..row.find("</tr>").unwrap()];
        assert!(row.ends_with(&format!("<td class=\"number\">{shown}</td>")), "{shown}: {row}");
    }
    // The report.
    let table = Table::parse(csv.as_bytes()).unwrap();
    let report = analyze(&table, hosted.study(), Language::English).unwrap();
    let results = report.files.iter().find(|file| file.path == "results.json").unwrap();
    let results: Value = serde_json::from_str(&results.text).unwrap();
    let why = |number: &u64| match by_events[number] {
        Standing::Completed => None,
        Standing::InProgress | Standing::Abandoned => Some("incomplete"),
        Standing::Declined => Some("declined"),
        Standing::ChecksFailed => Some("attention checks"),
        Standing::Withdrawn => Some("withdrawn"),
        _ => Some("screened out"),
    };
    let left_out = counted(statuses.keys().filter_map(why));
    assert_eq!(results["flow"]["people_left_out"], json!(left_out));
    // The quota: one more place than is held.
    let held = now.values().filter(|standing| standing.holds_place()).count();
    let larger = demo_with(json!({"participants": held + 1}));
    let server = server.restart_with(vec![larger]).await;
    server.start_in("demo", 1000).await;
    let body = json!({"nonce": format!("{:032x}", 1001), "language": "en"});
    let answer = server.post("/api/studies/demo/sessions", body).await;
    answer.refused(StatusCode::FORBIDDEN, "study-full");
}
