//! What was answered is what is exported, in every form.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Read;

use mimique_server::export::{Export, ExportError, Exported, Format, Options, Part, export};
use serde_json::{Value, json};

use crate::client::TestServer;
use crate::participant::{Planted, takes_part};
use crate::study;

/// Three participants: one completes, one stops half-way, one withdraws.
async fn take_part(server: &TestServer) -> Planted {
    let demo = study::demo();
    let mut planted = Planted::new();
    for (nonce, steps) in [(1, usize::MAX), (2, 9), (3, 5)] {
        let started = server.start_in("demo", nonce).await;
        let (events, answers) = takes_part(demo.study(), &started, steps);
        for part in events.chunks(7) {
            server.stored(&started.session, part).await;
        }
        match nonce {
            1 => drop(server.receipt(&started.session, events.len() as u64).await),
            3 => {
                server.withdrawn(&started.session, &started.withdrawal_code).await;
                continue;
            }
            _ => {}
        }
        planted.extend(answers);
    }
    planted
}

async fn exported(server: &TestServer, format: Format) -> Exported {
    export(&server.storage, Some("demo"), format, Options::default()).await.unwrap()
}

/// The ZIP archive that an export is written to.
fn archive(exported: Exported) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("export.zip");
    assert_eq!(exported.write(&path).unwrap(), std::slice::from_ref(&path));
    std::fs::read(path).unwrap()
}

/// The files in an archive, by their paths below its folder.
fn unpacked(archive: &[u8]) -> Vec<(String, Vec<u8>)> {
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(archive)).unwrap();
    let mut files = Vec::new();
    for index in 0..archive.len() {
        let mut file = archive.by_index(index).unwrap();
        let path = file.name().unwrap().strip_prefix("demo_psych-ds/").unwrap().to_owned();
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).unwrap();
        files.push((path, bytes));
    }
    files.sort();
    files
}

/// The only file, read as CSV: rows as name -> cell.
fn rows(bytes: &[u8]) -> Vec<BTreeMap<String, String>> {
    csv::Reader::from_reader(bytes).deserialize().map(Result::unwrap).collect()
}

fn text(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

pub async fn the_tidy_table_holds_every_answer(server: &TestServer) {
    let planted = take_part(server).await;
    let exported = exported(server, Format::Csv).await;
    assert_eq!(exported.files[0].0, "demo_responses.csv");
    assert_eq!((exported.participants, exported.rows), (2, planted.len()));
    let rows = rows(&exported.files[0].1);
    let found: BTreeMap<_, _> = rows
        .iter()
        .map(|row| {
            let key = ["participant_id", "trial_id", "response_id"].map(|name| row[name].clone());
            (key, row["answer"].clone())
        })
        .collect();
    let expected: BTreeMap<_, _> = planted
        .into_iter()
        .map(|((who, step, question), answer)| ([who, step, question], text(&answer)))
        .collect();
    assert_eq!(found, expected);
    // Factors, times and hash stand in every row of a trial.
    let hash = study::demo().config_hash().to_owned();
    for row in rows.iter().filter(|row| row["trial_type"] == "trial") {
        assert!(["lsts30", "box"].contains(&&*row["method"]), "{row:?}");
        assert_eq!(row["config_hash"], hash);
        assert_eq!(row["stage"], "live");
        assert_eq!(row["weights_hash"], "00ff");
        assert_eq!(row["start_time"].len(), 24);
    }
    let statuses: BTreeSet<_> =
        rows.iter().map(|r| (&*r["participant_id"], &*r["status"])).collect();
    assert_eq!(statuses, BTreeSet::from([("p0001", "completed"), ("p0002", "active")]));
}

pub async fn every_form_is_the_same_each_time(server: &TestServer) {
    take_part(server).await;
    let mut first = Vec::new();
    for format in Format::ALL {
        let bytes = exported(server, format).await;
        assert_eq!(bytes, exported(server, format).await, "{}", format.word());
        first.push(bytes);
    }
    let zipped = archive(first.last().unwrap().clone());
    // The database alone is enough: nothing of the first server is left.
    let server = server.restart().await;
    for (format, before) in Format::ALL.into_iter().zip(first) {
        assert_eq!(exported(&server, format).await, before, "{}", format.word());
    }
    assert_eq!(archive(exported(&server, Format::PsychDs).await), zipped);
    server.storage.close().await;
}

pub async fn the_other_forms_hold_the_same_answers(server: &TestServer) {
    let planted = take_part(server).await;
    let lines = exported(server, Format::Json).await;
    let lines: Vec<Value> = String::from_utf8(lines.files[0].1.clone())
        .unwrap()
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    assert_eq!(lines.len(), planted.len());
    for line in &lines {
        let key = ["participant_id", "trial_id", "response_id"].map(|name| text(&line[name]));
        assert_eq!(line["answer"], planted[&key.into()]);
    }

    let wide = exported(server, Format::Wide).await;
    let wide = rows(&wide.files[0].1);
    assert_eq!(wide.len(), 2);
    for ((who, step, question), answer) in &planted {
        let row = wide.iter().find(|row| row["participant_id"] == *who).unwrap();
        let name =
            if step == "demographics" { question.clone() } else { format!("{step}.{question}") };
        assert_eq!(row[&name], text(answer), "{name}");
    }

    let events = exported(server, Format::Events).await;
    let lines = String::from_utf8(events.files[0].1.clone()).unwrap();
    assert_eq!(lines.lines().count(), events.rows);
    let mut stored = 0;
    for session in server.storage.sessions("demo").await.unwrap() {
        stored += server.storage.events(session.key).await.unwrap().len();
    }
    assert_eq!(events.rows, stored);
    assert!(lines.contains("\"frames\":[[0.0,0.0,0.0],[16.667"), "frame times are kept");
}

pub async fn a_psych_ds_folder_explains_every_column(server: &TestServer) {
    take_part(server).await;
    let clip = study::demo().study().clips()[0].id.clone();
    let mut versions = server.storage.study_versions().await.unwrap();
    versions.retain(|version| version.study_id == "demo");
    versions[0].measures =
        json!([{"clip": clip, "values": [["obj_jerk_m_per_s3", 2.5]]}]).to_string();
    server.storage.register_study(&versions[0], 0).await.unwrap();
    let exported = exported(server, Format::PsychDs).await;
    let file = |name: &str| {
        &exported
            .files
            .iter()
            .find(|(found, _)| found == name)
            .unwrap_or_else(|| panic!("{name}"))
            .1
    };
    let description: Value = serde_json::from_slice(file("dataset_description.json")).unwrap();
    let measured: Vec<&str> = description["variableMeasured"]
        .as_array()
        .unwrap()
        .iter()
        .map(|variable| variable["name"].as_str().unwrap())
        .collect();
    let table = file("data/study-demo_data.csv");
    let header = csv::Reader::from_reader(&table[..]).headers().unwrap().clone();
    assert_eq!(measured, header.iter().collect::<Vec<_>>());
    let short = study::demo().config_hash()[..12].to_owned();
    let material = file(&format!("materials/study-demo_version-{short}.json"));
    let material: Value = serde_json::from_slice(material).unwrap();
    assert_eq!(mimique_study::config_hash(&material), study::demo().config_hash());

    // What was measured of a clip stands in its row; videos and unmeasured clips have a row, too.
    let (_, stimuli) =
        mimique_server::export::stimuli(&server.storage, Some("demo")).await.unwrap();
    assert_eq!(file("materials/study-demo_stimuli.csv"), &stimuli);
    let demo = study::demo();
    let told = rows(&stimuli);
    let clips = demo.study().clips();
    assert_eq!(told.len(), clips.len());
    for row in &told {
        let own = clips.iter().find(|own| own.id == row["stimulus"]).unwrap();
        assert_eq!((&row["segment"], &row["method"]), (&own.segment, &own.method));
        assert_eq!(row["expression"], own.factors["expression"].to_string());
        let jerk = if row["stimulus"] == clip { "2.5" } else { "" };
        assert_eq!(row["obj_jerk_m_per_s3"], jerk, "{row:?}");
    }

    // The archive holds the same files.
    assert_eq!(unpacked(&archive(exported.clone())), exported.files);

    // Written to a folder, and to an archive where the name says so.
    let folder = tempfile::tempdir().unwrap();
    let written = exported.clone().write(&folder.path().join("set")).unwrap();
    assert_eq!(written.len(), exported.files.len());
    assert_eq!(&std::fs::read(folder.path().join("set/data/study-demo_data.csv")).unwrap(), table);
    let written = exported.write(&folder.path().join("set.zip")).unwrap();
    assert_eq!(written, [folder.path().join("set.zip")]);
}

pub async fn identifiers_are_exported_only_when_asked_for(server: &TestServer) {
    take_part(server).await;
    for format in Format::ALL {
        for (name, bytes) in exported(server, format).await.files {
            let text = String::from_utf8(bytes).unwrap();
            assert!(!text.contains("person 1"), "{name}");
        }
    }
    let with = export(
        &server.storage,
        Some("demo"),
        Format::Csv,
        Options { with_identifiers: true, ..Options::default() },
    )
    .await
    .unwrap();
    for row in rows(&with.files[0].1) {
        let number = row["participant"].clone();
        assert_eq!(row["PROLIFIC_PID"], format!("person {number}"));
    }
}

pub async fn each_session_is_read_by_its_own_version(server: &TestServer) {
    let planted = take_part(server).await;
    let mut changed = study::demo_file();
    changed["studyMetadata"]["version"] = json!("2.0.0");
    changed["stimuli"]["segments"][0]["factors"] = json!({"take": "second"});
    let server = server.restart_with(vec![study::host(changed.clone())]).await;
    let new_hash = mimique_study::config_hash(&changed);
    let started = server.start_in("demo", 9).await;
    assert_eq!((started.participant, &started.config_hash), (4, &new_hash));
    let (events, answers) = takes_part(study::host(changed).study(), &started, usize::MAX);
    server.stored(&started.session, &events).await;

    let exported = exported(&server, Format::Csv).await;
    assert_eq!(exported.rows, planted.len() + answers.len());
    let rows = rows(&exported.files[0].1);
    for row in &rows {
        let is_new = row["participant_id"] == "p0004";
        assert_eq!(row["config_hash"] == new_hash, is_new);
        assert_eq!(row["take"].is_empty(), !(is_new && row["stimulus"].starts_with("anger2")));
    }
    // Both files go along; a participant of the old version can still be given it.
    let files = self::exported(&server, Format::PsychDs).await.files;
    assert_eq!(
        files.iter().filter(|(name, _)| name.starts_with("materials/study-demo_version")).count(),
        2
    );
    let old = study::demo().config_hash().to_owned();
    let bundle: Value = server.get(&format!("/api/studies/demo?config_hash={old}")).await.ok();
    assert_eq!(bundle["config_hash"], old);
    assert_eq!(bundle["study"], json!(study::demo().study().projection()));
    assert!(!bundle.to_string().contains("MIMIQUE-DEMO"));
    let unknown = server.get("/api/studies/demo?config_hash=00").await;
    unknown.refused(axum::http::StatusCode::NOT_FOUND, "unknown-study");
    server.storage.close().await;
}

pub async fn a_study_must_be_named_where_there_are_several(server: &TestServer) {
    let error = export(&server.storage, None, Format::Csv, Options::default()).await.unwrap_err();
    assert!(matches!(error, ExportError::SeveralStudies { .. }), "{error}");
    let error =
        export(&server.storage, Some("other"), Format::Csv, Options::default()).await.unwrap_err();
    let text = "study other: not in this database, which holds demo, faces; choose one of these";
    assert_eq!(error.to_string(), text);
    // Nobody has taken part: the header alone.
    let empty =
        export(&server.storage, Some("faces"), Format::Csv, Options::default()).await.unwrap();
    assert_eq!((empty.participants, empty.rows), (0, 0));
    assert!(empty.files[0].1.starts_with(b"participant_id,"));
}

/// What is downloaded is what is exported, sent session by session.
pub async fn a_download_comes_in_pieces(server: &TestServer) {
    take_part(server).await;
    let mut owner = crate::people::owner(server).await;
    for format in [Format::Csv, Format::Json, Format::Events, Format::Wide] {
        let word = format.word();
        let path = format!("/researcher/studies/demo/export/{word}");
        let whole = exported(server, format).await.files.remove(0);
        let downloaded = owner.open(server, &path).await;
        assert_eq!(downloaded.body, whole.1, "{word}");
        assert!(downloaded.header("content-disposition").contains(&whole.0), "{word}");
        let request = axum::http::Request::get(&path)
            .header("cookie", owner.cookie())
            .body(axum::body::Body::empty())
            .unwrap();
        let mut pieces = server.stream(request).await.into_body().into_data_stream();
        let mut sizes = Vec::new();
        while let Some(piece) = tokio_stream::StreamExt::next(&mut pieces).await {
            sizes.push(piece.unwrap().len());
        }
        assert_eq!(sizes.iter().sum::<usize>(), whole.1.len());
        // Two people have answers: neither's come with the other's.
        assert!(sizes.iter().filter(|size| **size > 0).count() >= 2, "{word}: {sizes:?}");
        assert!(sizes.iter().all(|size| *size < whole.1.len()), "{word}: {sizes:?}");
    }
}

/// The archive of a data set is made while it is sent, and holds what the data set has.
pub async fn a_data_set_is_zipped_while_it_is_sent(server: &TestServer) {
    take_part(server).await;
    let mut owner = crate::people::owner(server).await;
    let downloaded = owner.open(server, "/researcher/studies/demo/export/psych-ds").await;
    assert!(downloaded.header("content-disposition").contains("demo_psych-ds.zip"));
    let whole = exported(server, Format::PsychDs).await;
    assert_eq!(unpacked(&downloaded.body), whole.files);
    // Written to disk as it is sent, too.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("set.zip");
    let options = Options::default();
    let export =
        Export::open(&server.storage, Some("demo"), Format::PsychDs, options).await.unwrap();
    let written = export.write(&path).await.unwrap();
    assert_eq!((written.participants, written.rows), (whole.participants, whole.rows));
    assert_eq!(std::fs::read(&path).unwrap(), downloaded.body);
}

/// Columns of the wide form are found before its rows are written: what comes in between is in neither.
pub async fn a_wide_export_is_as_of_its_beginning(server: &TestServer) {
    take_part(server).await;
    let before = exported(server, Format::Wide).await;
    let options = Options::default();
    let mut export =
        Export::open(&server.storage, Some("demo"), Format::Wide, options).await.unwrap();
    assert_eq!(export.next().await.unwrap(), Some(Part::File("demo_wide.csv".into())));
    let Some(Part::Bytes(mut bytes)) = export.next().await.unwrap() else { panic!("no header") };
    assert_eq!(bytes.iter().filter(|byte| **byte == b'\n').count(), 1);
    // One goes on, and somebody new takes part.
    let second = server.start_in("demo", 2).await;
    let (events, _) = takes_part(study::demo().study(), &second, usize::MAX);
    server.stored(&second.session, &events).await;
    let fourth = server.start_in("demo", 4).await;
    let (events, _) = takes_part(study::demo().study(), &fourth, usize::MAX);
    server.stored(&fourth.session, &events).await;
    while let Some(part) = export.next().await.unwrap() {
        if let Part::Bytes(more) = part {
            bytes.extend(more);
        }
    }
    assert_eq!(
        String::from_utf8(bytes).unwrap(),
        String::from_utf8(before.files[0].1.clone()).unwrap()
    );
    assert_eq!(exported(server, Format::Wide).await.participants, 3);
}
