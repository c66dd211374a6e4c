//! The researchers' pages: what they show, live; exclusion; export and report.

use std::time::Duration;

use axum::body::Body;
use axum::http::{Method, Request, StatusCode, header};
use mimique_server::export::{Format, Options, export};
use mimique_session::Standing;
use mimique_storage::Role;
use tokio_stream::StreamExt;

use crate::client::{TestServer, events};
use crate::participant::takes_part;
use crate::people::{HOST, ORIGIN, encoded, invited, owner, script, token};
use crate::study;

/// A participant of the demo who completes it, or stops after some steps.
pub async fn demo_participant(server: &TestServer, nonce: u64, steps: usize) {
    let demo = study::demo();
    let started = server.start_in("demo", nonce).await;
    let (events, _) = takes_part(demo.study(), &started, steps);
    server.stored(&started.session, &events).await;
    if steps == usize::MAX {
        server.receipt(&started.session, events.len() as u64).await;
    }
}

pub async fn the_page_shows_what_was_stored(server: &TestServer) {
    demo_participant(server, 1, usize::MAX).await;
    demo_participant(server, 2, 6).await;
    let started = server.start_in("demo", 3).await;
    server.stored(&started.session, &events(0..2)).await;
    server.withdrawn(&started.session, &started.withdrawal_code).await;

    let mut owner = owner(server).await;
    let home = owner.open(server, "/researcher").await.text();
    assert!(home.contains("href=\"/researcher/studies/demo\""), "{home}");
    let page = owner.open(server, "/researcher/studies/demo").await.text();
    for (standing, count) in [("completed", 1), ("under way", 1), ("withdrawn", 1)] {
        let wanted = format!("<dt>{standing}</dt><dd>{count}</dd>");
        assert!(page.contains(&wanted), "{wanted} in {page}");
    }
    // Twelve trials of the one who completed: six by each method.
    let boxed = "<th scope=\"row\">box</th>";
    let row = &page[page.find(boxed).unwrap()..];
    let row = &row[..row.find("</tr>").unwrap()];
    assert!(row.ends_with("<td class=\"number\">6</td>"), "{row}");
    for part in [
        "Which emotion do you recognise?",
        "Where people are and where they leave",
        "Time per trial",
        "Late frames by device",
        "<th scope=\"row\">trial 12</th>",
        "<th scope=\"row\">end</th>",
    ] {
        assert!(page.contains(part), "{part} in {page}");
    }
    for hidden in ["person 1", &started.session, &started.withdrawal_code] {
        assert!(!page.contains(hidden), "{hidden}");
    }
    for inline in ["<style", " style=", " onclick="] {
        assert!(!page.contains(inline), "{inline}");
    }
    // In French too, once chosen.
    let chosen = owner.open(server, "/researcher/language/fr?next=/researcher/studies/demo").await;
    assert_eq!(chosen.header(header::LOCATION), "/researcher/studies/demo");
    let page = owner.open(server, "/researcher/studies/demo").await.text();
    assert!(page.contains("<html lang=\"fr\">") && page.contains("<dt>terminé</dt>"), "{page}");
    let answer = owner.open(server, "/researcher/studies/other").await;
    assert_eq!(answer.status, StatusCode::NOT_FOUND);
    assert!(answer.text().contains("Aucune étude"), "{}", answer.text());
}

pub async fn a_change_is_told_at_once(server: &TestServer) {
    let owner = owner(server).await;
    let request = Request::get("/researcher/studies/faces/live")
        .header(header::HOST, HOST)
        .header(header::COOKIE, owner.cookie())
        .body(Body::empty())
        .unwrap();
    let response = server.stream(request).await;
    assert_eq!(response.status(), StatusCode::OK);
    assert_eq!(response.headers()[header::CONTENT_TYPE], "text/event-stream");
    let mut lines = response.into_body().into_data_stream();
    let first = piece(&mut lines).await;
    assert!(first.contains("event: changed"), "{first}");
    let started = server.start(1).await;
    let second = piece(&mut lines).await;
    assert!(second.contains("event: changed") && second != first, "{second}");
    server.stored(&started.session, &events(0..1)).await;
    let third = piece(&mut lines).await;
    assert!(third != second, "{third}");
    // Who is not logged in hears nothing.
    let nobody = server.get("/researcher/studies/faces/live").await;
    nobody.refused(StatusCode::UNAUTHORIZED, "log-in-first");
}

/// What a stream sends, a piece after the other.
async fn piece(lines: &mut axum::body::BodyDataStream) -> String {
    let chunk = tokio::time::timeout(Duration::from_secs(5), lines.next()).await;
    let chunk = chunk.expect("a line within five seconds").unwrap().unwrap();
    String::from_utf8_lossy(&chunk).into_owned()
}

pub async fn stored_events_are_told_to_who_may_export(server: &TestServer) {
    let owner = owner(server).await;
    let started = server.start(1).await;
    server.stored(&started.session, &events(0..2)).await;
    let listen = async |query: &str| {
        let request = Request::get(format!("/researcher/studies/faces/events{query}"))
            .header(header::HOST, HOST)
            .header(header::COOKIE, owner.cookie())
            .body(Body::empty())
            .unwrap();
        let response = server.stream(request).await;
        assert_eq!(response.status(), StatusCode::OK);
        assert_eq!(response.headers()[header::CONTENT_TYPE], "text/event-stream");
        response.into_body().into_data_stream()
    };
    let mut all = listen("?from=beginning").await;
    let first = piece(&mut all).await;
    assert!(first.contains("id: 1.0") && first.contains("\"participant\":1"), "{first}");
    let second = piece(&mut all).await;
    assert!(second.contains("id: 1.1"), "{second}");
    // From now on: nothing of what was there, each new event once, in order.
    let mut fresh = listen("").await;
    let told = tokio::time::timeout(Duration::from_millis(1500), fresh.next()).await;
    assert!(told.is_err(), "{told:?}");
    server.stored(&started.session, &events(2..4)).await;
    for lines in [&mut all, &mut fresh] {
        for id in ["id: 1.2", "id: 1.3"] {
            let line = piece(lines).await;
            assert!(line.contains(id), "{line}");
            assert!(line.contains("\"sequence\":") && line.contains("event: "), "{line}");
        }
    }
    let nobody = server.get("/researcher/studies/faces/events").await;
    nobody.refused(StatusCode::UNAUTHORIZED, "log-in-first");
}

pub async fn exports_are_files(server: &TestServer) {
    let started = server.start(1).await;
    server.stored(&started.session, &events(0..3)).await;
    let mut owner = owner(server).await;
    for (word, kind, name) in [
        ("csv", "text/csv; charset=utf-8", "faces_responses.csv"),
        ("wide", "text/csv; charset=utf-8", "faces_wide.csv"),
        ("json", "application/x-ndjson", "faces_responses.jsonl"),
        ("events", "application/x-ndjson", "faces_events.jsonl"),
        ("psych-ds", "application/zip", "faces_psych-ds.zip"),
        ("dictionary", "text/csv; charset=utf-8", "faces_dictionary.csv"),
        ("study", "application/json", "faces.json"),
    ] {
        let path = format!("/researcher/studies/faces/export/{word}");
        let answer = owner.open(server, &path).await;
        assert_eq!(answer.status, StatusCode::OK, "{}", answer.text());
        assert_eq!(answer.header(header::CONTENT_TYPE), kind);
        let disposition = format!("attachment; filename=\"{name}\"");
        assert_eq!(answer.header(header::CONTENT_DISPOSITION), disposition);
        assert_eq!(answer.header(header::CACHE_CONTROL), "no-store");
        match word {
            "study" => assert_eq!(answer.json::<serde_json::Value>(), study::file()),
            "dictionary" => {
                let text = answer.text();
                assert!(text.starts_with("name,kind,unit,levels,description\n"), "{text}");
                assert!(text.contains("\nexclusion_reason,text,,,"), "{text}");
            }
            _ => {}
        }
    }
    for (path, status) in [
        ("/researcher/studies/faces/export/xls", StatusCode::NOT_FOUND),
        ("/researcher/studies/other/export/csv", StatusCode::NOT_FOUND),
        // A questionnaire without trials has no report, and that is said.
        ("/researcher/studies/faces/report/en/report.html", StatusCode::CONFLICT),
        ("/researcher/studies/faces/report/xx/report.html", StatusCode::NOT_FOUND),
    ] {
        assert_eq!(owner.open(server, path).await.status, status, "{path}");
    }
}

pub async fn an_exclusion_is_in_export_and_report(server: &TestServer) {
    for nonce in 1..=3 {
        demo_participant(server, nonce, usize::MAX).await;
    }
    let mut owner = owner(server).await;
    let person = "/researcher/studies/demo/participants/2";
    let empty = owner.send(server, &format!("{person}/exclude"), &[("reason", " \n ")]).await;
    empty.refused(StatusCode::BAD_REQUEST, "bad-request");
    let fields = [("reason", "=watched  with a friend")];
    let done = owner.send(server, &format!("{person}/exclude"), &fields).await;
    assert_eq!(done.header(header::LOCATION), person);
    let page = owner.open(server, person).await.text();
    assert!(page.contains("<strong>=watched with a friend</strong>"), "{page}");
    let dashboard = owner.open(server, "/researcher/studies/demo").await.text();
    assert!(dashboard.contains("<dt>excluded</dt><dd>1</dd>"), "{dashboard}");
    // Every answer is still exported, marked.
    let rows = async |options: Options| {
        let csv = export(&server.storage, Some("demo"), Format::Csv, options).await.unwrap();
        let bytes = csv.files.into_iter().next().unwrap().1;
        let rows: Vec<std::collections::BTreeMap<String, String>> =
            csv::Reader::from_reader(&*bytes).deserialize().map(Result::unwrap).collect();
        rows
    };
    let all = rows(Options::default()).await;
    for row in &all {
        let (excluded, reason) = match row["participant_id"].as_str() {
            "p0002" => ("true", "=watched with a friend"),
            _ => ("false", ""),
        };
        assert_eq!((&*row["excluded"], &*row["exclusion_reason"]), (excluded, reason));
        assert_eq!(row["status"], "completed");
    }
    let people: std::collections::BTreeSet<_> =
        all.iter().map(|row| row["participant_id"].clone()).collect();
    assert_eq!(people.len(), 3);
    let spreadsheet =
        owner.open(server, "/researcher/studies/demo/export/csv?neutralised=true").await.text();
    assert!(spreadsheet.contains("'=watched with a friend"), "{spreadsheet}");
    // The report leaves the person out and says why.
    let report = "/researcher/studies/demo/report/en";
    let page = owner.open(server, &format!("{report}/report.html")).await;
    assert_eq!(page.status, StatusCode::OK, "{}", page.text());
    let policy = page.header(header::CONTENT_SECURITY_POLICY);
    assert!(policy.contains("style-src 'sha256-") && !policy.contains("unsafe"), "{policy}");
    assert!(page.text().contains("excluded by the researcher (=watched with a friend): 1"));
    let figures = owner.open(server, &format!("{report}/results.json")).await;
    let flow = figures.text();
    assert!(flow.contains("\"people_used\": 2") || flow.contains("\"people_used\":2"), "{flow}");
    let archive = owner.open(server, &format!("{report}/report.zip")).await;
    assert_eq!(archive.header(header::CONTENT_TYPE), "application/zip");
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(&*archive.body)).unwrap();
    let names: Vec<String> = archive.file_names().map(|name| name.unwrap().into_owned()).collect();
    let svgs = names.iter().filter(|name| name.ends_with(".svg"));
    let pdfs: Vec<String> = svgs.map(|name| name.replace(".svg", ".pdf")).collect();
    assert!(!pdfs.is_empty() && pdfs.iter().all(|pdf| names.contains(pdf)), "{names:?}");
    let mut start = [0; 5];
    std::io::Read::read_exact(&mut archive.by_name(&pdfs[0]).unwrap(), &mut start).unwrap();
    assert_eq!(&start, b"%PDF-");
    // Taken back, everybody counts again; who did what is remembered.
    owner.send(server, &format!("{person}/include"), &[]).await;
    assert!(rows(Options::default()).await.iter().all(|row| row["excluded"] == "false"));
    let page = owner.open(server, &format!("{report}/report.html")).await.text();
    assert!(!page.contains("excluded by the researcher"));
    let page = owner.open(server, person).await.text();
    assert!(page.contains("taken back") && page.contains("excluded: =watched"), "{page}");
}

pub async fn an_owner_deletes_a_participant_who_asks_for_it(server: &TestServer) {
    for nonce in 1..=2 {
        demo_participant(server, nonce, usize::MAX).await;
    }
    let person = "/researcher/studies/demo/participants/2";
    let erase = format!("{person}/erase");
    let stored = async || {
        let sessions = server.storage.sessions("demo").await.unwrap();
        let mut counts = Vec::new();
        for session in &sessions {
            counts.push(server.storage.events(session.key).await.unwrap().len());
        }
        counts
    };
    let before = stored().await;
    assert!(before[0] > 20 && before[0] == before[1], "{before:?}");
    let mut owner = owner(server).await;
    let page = owner.open(server, person).await.text();
    assert!(page.contains(&format!("action=\"{erase}\"")), "{page}");
    assert!(page.contains("mimique backup --folder"), "what becomes of backups is said: {page}");
    let confirmed = [("confirmation", "p0002")];
    // An analyst has no such form, and the server does not take it.
    let mut analyst = invited(server, &mut owner, Role::Analyst).await;
    let page = analyst.open(server, person).await.text();
    assert!(!page.contains(&erase), "{page}");
    let answer = analyst.send(server, &erase, &confirmed).await;
    answer.refused(StatusCode::FORBIDDEN, "not-allowed");
    // Neither a forged form nor a name that is not the participant's deletes.
    owner.open(server, person).await;
    let forged = owner.send_from(server, &erase, &confirmed, Some(ORIGIN)).await;
    forged.refused(StatusCode::FORBIDDEN, "foreign-form");
    let other = owner.send(server, &erase, &[("confirmation", "p0001")]).await;
    other.refused(StatusCode::BAD_REQUEST, "not-confirmed");
    let nobody = owner.send(server, "/researcher/studies/demo/participants/9/erase", &confirmed);
    assert_eq!(nobody.await.status, StatusCode::NOT_FOUND);
    assert_eq!(stored().await, before);
    let done = owner.send(server, &erase, &confirmed).await;
    assert_eq!(done.header(header::LOCATION), person, "{}", done.text());
    assert_eq!(stored().await, [before[0], 0]);
    let sessions = server.storage.sessions("demo").await.unwrap();
    assert_eq!(sessions[1].standing, Standing::Withdrawn);
    // The next backup knows it, the log too; the page offers it no more.
    assert_eq!(server.storage.deletions().await.unwrap().len(), 1);
    let entries = server.storage.audit_entries(i64::MAX, 50).await.unwrap();
    let entry = entries.iter().find(|entry| entry.action.starts_with("delete")).unwrap();
    assert_eq!((&*entry.study_id, &*entry.subject), ("demo", "p0002"));
    assert_eq!(entry.who, "owner@example.org");
    let page = owner.open(server, person).await;
    assert_eq!(page.status, StatusCode::OK);
    assert!(!page.text().contains(&erase), "{}", page.text());
}

pub async fn one_account_has_so_many_streams_and_no_more(server: &TestServer) {
    let mut owner = owner(server).await;
    let other = invited(server, &mut owner, Role::Viewer).await;
    let open = async |cookie: String| {
        let request = Request::get("/researcher/studies/faces/live")
            .header(header::HOST, HOST)
            .header(header::COOKIE, cookie)
            .body(Body::empty())
            .unwrap();
        server.stream(request).await
    };
    let mut streams = Vec::new();
    for _ in 0..24 {
        let stream = open(owner.cookie()).await;
        assert_eq!(stream.status(), StatusCode::OK);
        streams.push(stream);
    }
    assert_eq!(open(owner.cookie()).await.status(), StatusCode::TOO_MANY_REQUESTS);
    assert_eq!(open(other.cookie()).await.status(), StatusCode::OK, "others are not touched");
    // A dashboard that is closed makes room.
    streams.clear();
    for _ in 0..100 {
        if open(owner.cookie()).await.status() == StatusCode::OK {
            return;
        }
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
    panic!("closed streams keep their places");
}

pub async fn scripts_export_as_the_description_says(server: &TestServer) {
    demo_participant(server, 1, usize::MAX).await;
    let mut owner = owner(server).await;
    let analyst = token(server, &mut owner, Role::Analyst).await;
    let viewer = token(server, &mut owner, Role::Viewer).await;
    let description: serde_json::Value = server.get("/api/openapi.json").await.ok();
    assert_eq!(description["components"]["securitySchemes"]["token"]["scheme"], "bearer");
    let export = &description["paths"]["/researcher/studies/{study}/export/{format}"]["get"];
    let report =
        &description["paths"]["/researcher/studies/{study}/report/{language}/{name}"]["get"];
    for operation in [export, report] {
        assert_eq!(operation["security"], serde_json::json!([{"token": []}]));
    }
    let words = export["parameters"][1]["schema"]["enum"].as_array().unwrap();
    assert_eq!(words.len(), 10, "{words:?}");
    let studies = "/researcher/studies/demo";
    let kinds = |operation: &serde_json::Value| -> Vec<String> {
        let content = operation["responses"]["200"]["content"].as_object().unwrap();
        content.keys().cloned().collect()
    };
    for word in words {
        let path = format!("{studies}/export/{}", word.as_str().unwrap());
        let answer = script(server, Method::GET, &path, &analyst).await;
        assert_eq!(answer.status, StatusCode::OK, "{path}");
        let kind = answer.header(header::CONTENT_TYPE).to_owned();
        assert!(kinds(export).contains(&kind), "{path}: {kind}");
        let refused = script(server, Method::GET, &path, &viewer).await;
        refused.refused(StatusCode::FORBIDDEN, "not-allowed");
        server.get(&path).await.refused(StatusCode::UNAUTHORIZED, "log-in-first");
    }
    for name in ["report.html", "report.zip"] {
        let path = format!("{studies}/report/fr/{name}");
        let answer = script(server, Method::GET, &path, &analyst).await;
        let kind = answer.header(header::CONTENT_TYPE).to_owned();
        assert!(kinds(report).contains(&kind), "{path}: {kind}");
    }
    let wrong = format!("{studies}/export/csv?neutralised=perhaps");
    let answer = script(server, Method::GET, &wrong, &analyst).await;
    answer.refused(StatusCode::BAD_REQUEST, "bad-request");
}

pub async fn refusals_are_in_the_readers_language(server: &TestServer) {
    server.start(1).await;
    let mut owner = owner(server).await;
    owner.open(server, "/researcher/studies/faces/participants/1").await;
    for (language, text) in [
        ("fr", "Il manque la raison ; dites pourquoi la personne est exclue."),
        ("en", "There is no reason; say why the participant is excluded."),
    ] {
        let fields = [("reason", ""), ("csrf", owner.csrf.as_str())];
        let request = Request::post("/researcher/studies/faces/participants/1/exclude")
            .header(header::HOST, HOST)
            .header(header::ORIGIN, ORIGIN)
            .header(header::ACCEPT, "text/html")
            .header(header::ACCEPT_LANGUAGE, language)
            .header(header::COOKIE, owner.cookie())
            .header(header::CONTENT_TYPE, "application/x-www-form-urlencoded")
            .body(Body::from(encoded(&fields)))
            .unwrap();
        let answer = server.send(request).await;
        assert_eq!(answer.status, StatusCode::BAD_REQUEST);
        assert!(answer.text().contains(text), "{}", answer.text());
    }
}
