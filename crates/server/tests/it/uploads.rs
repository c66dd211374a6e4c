//! Studies through the page: checked, prepared, hosted as pilots; hostile ones are refused whole.

use std::io::{Cursor, Write};
use std::time::Duration;

use axum::body::Body;
use axum::http::{Request, StatusCode, header};
use mimique_server::{Access, StudioFile, StudioFiles, StudioRole, router};
use mimique_session::wire::SessionStarted;
use serde_json::{Value, json};
use zip::write::SimpleFileOptions;

use crate::client::{Answer, TestServer};
use crate::people::{Browser, HOST, ORIGIN, PASSWORD, link_in, owner};
use crate::study;

const BOUNDARY: &str = "----a-boundary";

/// A server with a data folder.
fn with_folder(server: &TestServer, folder: &std::path::Path) -> TestServer {
    let app = server.app.clone().with_data_folder(folder.to_owned());
    let mut hosting = server.with_router(router(app.clone()));
    hosting.app = app;
    hosting
}

/// A file sent by the page's form.
async fn upload(server: &TestServer, browser: &Browser, file: &[u8]) -> Answer {
    upload_with(server, browser, file, &browser.csrf, ORIGIN).await
}

async fn upload_with(
    server: &TestServer,
    browser: &Browser,
    file: &[u8],
    csrf: &str,
    origin: &str,
) -> Answer {
    let mut body = format!(
        "--{BOUNDARY}\r\nContent-Disposition: form-data; name=\"csrf\"\r\n\r\n{csrf}\r\n\
         --{BOUNDARY}\r\nContent-Disposition: form-data; name=\"study\"; filename=\"../../x.zip\"\r\n\
         Content-Type: application/zip\r\n\r\n"
    )
    .into_bytes();
    body.extend(file);
    body.extend(format!("\r\n--{BOUNDARY}--\r\n").bytes());
    let request = Request::post("/researcher/upload")
        .header(header::HOST, HOST)
        .header(header::ORIGIN, origin)
        .header(header::ACCEPT, "text/html")
        .header(header::COOKIE, browser.cookie())
        .header(header::CONTENT_TYPE, format!("multipart/form-data; boundary={BOUNDARY}"))
        .body(Body::from(body))
        .unwrap();
    server.send(request).await
}

fn packed(entries: &[(&str, &[u8])]) -> Vec<u8> {
    let mut writer = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in entries {
        writer.start_file(*name, SimpleFileOptions::default()).unwrap();
        writer.write_all(bytes).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

/// A whole study without stimuli.
fn whole_study(id: &str) -> Value {
    let mut file = study::demo_file();
    let object = file.as_object_mut().unwrap();
    object.insert("id".into(), id.into());
    file
}

/// Waits until preparing has come to an end; the page then.
async fn prepared(server: &TestServer, browser: &mut Browser, id: &str) -> String {
    for _ in 0..600 {
        let page = browser.open(server, &format!("/researcher/upload/{id}")).await.text();
        if !page.contains("data-reload-s") {
            return page;
        }
        tokio::time::sleep(Duration::from_millis(100)).await;
    }
    panic!("the study is not prepared within a minute");
}

/// A study sent by the studio.
async fn from_studio(
    server: &TestServer,
    browser: Option<&Browser>,
    token: &str,
    origin: &str,
    archive: &[u8],
) -> Answer {
    let mut request = Request::post("/studio/study")
        .header(header::HOST, HOST)
        .header(header::ORIGIN, origin)
        .header("x-mimique-form", token);
    if let Some(browser) = browser {
        request = request.header(header::COOKIE, browser.cookie());
    }
    server.send(request.body(Body::from(archive.to_vec())).unwrap()).await
}

pub async fn a_study_of_the_studio_is_hosted_for_its_preview(server: &TestServer) {
    let folder = tempfile::tempdir().unwrap();
    let server = with_folder(server, folder.path());
    let mut owner = owner(&server).await;
    let page = owner.open(&server, "/studio").await.text();
    assert!(page.contains(&format!("data-token=\"{}\"", owner.csrf)), "{page}");
    let mut file = whole_study("of-the-studio");
    let archive = packed(&[("mine/study.json", file.to_string().as_bytes())]);
    // Nobody, a page of another site, a page that is not the studio: none of them.
    let csrf = owner.csrf.clone();
    for (browser, token, origin) in [
        (None, csrf.as_str(), ORIGIN),
        (Some(&owner), csrf.as_str(), "https://elsewhere.example"),
        (Some(&owner), "", ORIGIN),
        (Some(&owner), "alone", ORIGIN),
    ] {
        let answer = from_studio(&server, browser, token, origin, &archive).await;
        assert!(answer.status.is_client_error(), "{token} {origin}: {}", answer.text());
    }
    let answer = from_studio(&server, Some(&owner), &csrf, ORIGIN, &archive).await;
    assert_eq!(answer.status, StatusCode::ACCEPTED, "{}", answer.text());
    assert_eq!(answer.json::<Value>(), json!({ "study": "of-the-studio" }));
    let page = prepared(&server, &mut owner, "of-the-studio").await;
    assert!(page.contains("hosted as a pilot"), "{page}");
    let told = owner.open(&server, "/studio/study/of-the-studio").await;
    assert_eq!(told.json::<Value>()["state"], "ready", "{}", told.text());
    assert_eq!(owner.open(&server, "/preview/of-the-studio").await.status, StatusCode::OK);
    assert_eq!(
        server.get("/studio/study/of-the-studio").await.status,
        StatusCode::UNAUTHORIZED,
        "how far it is, is for those who may know"
    );
    // What is wrong with a study is told with its place.
    file["questions"] = json!(7);
    let broken = packed(&[("study.json", file.to_string().as_bytes())]);
    let answer = from_studio(&server, Some(&owner), &csrf, ORIGIN, &broken).await;
    assert_eq!(answer.status, StatusCode::UNPROCESSABLE_ENTITY, "{}", answer.text());
    let told: Value = answer.json();
    assert_eq!(told["issues"][0]["place"], "/questions", "{told}");
}

pub async fn the_studio_alone_hosts_what_it_makes(server: &TestServer) {
    let folder = tempfile::tempdir().unwrap();
    let access = Access { open_preview: true, studio_alone: true, ..Access::default() };
    let file = StudioFile { name: "head.glb".to_owned(), bytes: b"glTF".as_slice().into() };
    let app = (server.app.clone())
        .with_data_folder(folder.path().to_owned())
        .with_access(access)
        .with_studio_files(StudioFiles::from([(StudioRole::Avatar, file)]));
    let mut server = server.with_router(router(app.clone()));
    server.app = app;
    let first = server.get("/").await;
    assert_eq!(first.header(header::LOCATION), "/studio");
    let page = server.get("/studio").await.text();
    assert!(page.contains("data-token=\"alone\"") && page.contains("head.glb"), "{page}");
    assert_eq!(server.get("/studio/files/avatar").await.text(), "glTF");
    assert_eq!(server.get("/studio/files/take").await.status, StatusCode::NOT_FOUND);
    let file = whole_study("made-alone").to_string();
    let archive = packed(&[("study.json", file.as_bytes())]);
    let elsewhere = "https://elsewhere.example";
    let answer = from_studio(&server, None, "alone", elsewhere, &archive).await;
    assert_eq!(answer.status, StatusCode::FORBIDDEN, "{}", answer.text());
    let answer = from_studio(&server, None, "alone", ORIGIN, &archive).await;
    assert_eq!(answer.status, StatusCode::ACCEPTED, "{}", answer.text());
    for _ in 0..600 {
        let told: Value = server.get("/studio/study/made-alone").await.json();
        if told["state"] != "under" {
            assert_eq!(told["state"], "ready", "{told}");
            break;
        }
        tokio::time::sleep(Duration::from_millis(100)).await;
    }
    assert_eq!(server.get("/preview/made-alone").await.status, StatusCode::OK);
}

pub async fn an_uploaded_study_is_hosted_as_a_pilot(server: &TestServer) {
    let folder = tempfile::tempdir().unwrap();
    let server = with_folder(server, folder.path());
    let mut owner = owner(&server).await;
    let file = whole_study("uploaded");
    let archive = packed(&[("faces/study.json", file.to_string().as_bytes())]);
    let answer = upload(&server, &owner, &archive).await;
    assert_eq!(answer.status, StatusCode::SEE_OTHER, "{}", answer.text());
    assert_eq!(answer.header(header::LOCATION), "/researcher/upload/uploaded");
    let page = prepared(&server, &mut owner, "uploaded").await;
    assert!(page.contains("hosted as a pilot"), "{page}");
    // Whichever server on the database is asked says so.
    let twin = TestServer::open(server.url()).await;
    let told = owner.open(&twin, "/researcher/upload/uploaded").await;
    assert!(told.text().contains("hosted as a pilot"), "{}", told.text());
    twin.storage.close().await;
    let listed = owner.open(&server, "/researcher").await.text();
    assert!(listed.contains("/researcher/studies/uploaded") && listed.contains("<td>pilot</td>"));
    let started: SessionStarted = server.start_in("uploaded", 1).await;
    assert_eq!(started.stage, "pilot");
    let bundle: mimique_session::wire::Bundle = server.get("/api/studies/uploaded").await.ok();
    let pack = bundle.clips.values().flat_map(|clip| clip.packs()).next().unwrap().to_owned();
    assert_eq!(server.get(&format!("/packs/{pack}")).await.status, StatusCode::OK);
    // Live: sessions that begin now count.
    let stage = "/researcher/studies/uploaded/stage";
    let done = owner.send(&server, stage, &[("stage", "live")]).await;
    assert_eq!(done.status, StatusCode::SEE_OTHER, "{}", done.text());
    assert_eq!(server.start_in("uploaded", 2).await.stage, "live");
    // Another server on the same database and folder hosts it too; a third has no folder.
    let restarted = server.restart().await;
    assert_eq!(restarted.get("/s/uploaded/").await.status, StatusCode::NOT_FOUND);
    let other = with_folder(&restarted, folder.path());
    other.app.host_uploads().await.unwrap();
    assert_eq!(other.get("/s/uploaded/").await.status, StatusCode::OK);
    assert_eq!(other.start_in("uploaded", 3).await.stage, "live");
    assert_eq!(other.get(&format!("/packs/{pack}")).await.status, StatusCode::OK);
    // Hosted no more; its answers stay.
    let done = owner.send(&other, "/researcher/studies/uploaded/remove", &[]).await;
    assert_eq!(done.status, StatusCode::SEE_OTHER);
    assert_eq!(other.get("/s/uploaded/").await.status, StatusCode::NOT_FOUND);
    assert_eq!(other.storage.sessions("uploaded").await.unwrap().len(), 3);
    // What the server was started with is not the page's to change.
    let own = owner.send(&other, "/researcher/studies/faces/remove", &[]).await;
    own.refused(StatusCode::BAD_REQUEST, "bad-request");
}

pub async fn a_study_with_errors_is_refused_with_all_of_them(server: &TestServer) {
    let folder = tempfile::tempdir().unwrap();
    let server = with_folder(server, folder.path());
    let owner = owner(&server).await;
    let mut file = whole_study("broken");
    let object = file.as_object_mut().unwrap();
    object.insert("languges".into(), json!(["en"]));
    object.remove("sequence");
    let answer = upload(&server, &owner, file.to_string().as_bytes()).await;
    assert_eq!(answer.status, StatusCode::UNPROCESSABLE_ENTITY);
    let page = answer.text();
    for part in ["/languges", "did you mean", "sequence"] {
        assert!(page.contains(part), "{part} in {page}");
    }
    // An identifier of the server's own files is taken.
    let taken = upload(&server, &owner, whole_study("demo").to_string().as_bytes()).await;
    assert_eq!(taken.status, StatusCode::UNPROCESSABLE_ENTITY);
    assert!(taken.text().contains("another id"), "{}", taken.text());
    assert!(server.storage.uploads().await.unwrap().is_empty());
}

pub async fn hostile_uploads_leave_nothing(server: &TestServer) {
    let outer = tempfile::tempdir().unwrap();
    let folder = outer.path().join("data");
    std::fs::create_dir(&folder).unwrap();
    std::fs::write(outer.path().join("secret.csv"), "a secret").unwrap();
    let server = with_folder(server, &folder);
    let owner = owner(&server).await;
    let study = whole_study("hostile").to_string();
    let outside = {
        let mut file = whole_study("hostile");
        let path = outer.path().join("secret.csv").display().to_string();
        file["stimuli"]["captures"] =
            json!({"actor": {"file": path, "markers": "../../secret.csv"}});
        file.to_string()
    };
    // Ten MiB of zeros in ten KiB, a thousand times over.
    let zeros = vec![0; 10 * 1024 * 1024];
    let names: Vec<String> = (0..210).map(|index| format!("{index}.bin")).collect();
    let mut bomb = zip::ZipWriter::new(Cursor::new(Vec::new()));
    bomb.start_file("study.json", SimpleFileOptions::default()).unwrap();
    bomb.write_all(study.as_bytes()).unwrap();
    bomb.start_file(&*names[0], SimpleFileOptions::default()).unwrap();
    bomb.write_all(&zeros).unwrap();
    for name in &names[1..] {
        bomb.deep_copy_file(&names[0], name).unwrap();
    }
    let bomb = bomb.finish().unwrap().into_inner();
    assert!(bomb.len() < 4 * 1024 * 1024, "{}", bomb.len());
    for (what, bytes) in [
        ("traversal", packed(&[("study.json", study.as_bytes()), ("../../evil.txt", b"x")])),
        ("absolute", packed(&[("study.json", study.as_bytes()), ("/tmp/evil.txt", b"x")])),
        ("no study", packed(&[("readme.txt", b"x")])),
        ("not an archive", b"MZ\x90\x00".to_vec()),
        ("cut off", packed(&[("study.json", study.as_bytes())])[..200].to_vec()),
        ("empty", Vec::new()),
        ("a path outside", packed(&[("study.json", outside.as_bytes())])),
        ("a bomb", bomb),
    ] {
        let answer = upload(&server, &owner, &bytes).await;
        assert_eq!(answer.status, StatusCode::UNPROCESSABLE_ENTITY, "{what}: {}", answer.text());
        assert!(!answer.text().contains("a secret"), "{what}");
        let left: Vec<_> = std::fs::read_dir(folder.join("uploads")).unwrap().collect();
        assert!(left.is_empty(), "{what} leaves {left:?}");
        assert!(!outer.path().join("evil.txt").exists(), "{what}");
    }
    // A forged form is not even taken in.
    for (csrf, origin) in [("", ORIGIN), (owner.csrf.as_str(), "https://evil.example")] {
        let answer = upload_with(&server, &owner, study.as_bytes(), csrf, origin).await;
        assert_eq!(answer.status, StatusCode::FORBIDDEN);
    }
    assert!(std::fs::read_dir(folder.join("uploads")).unwrap().next().is_none());
    assert!(server.storage.uploads().await.unwrap().is_empty());
}

/// What a question shows is hosted with the study, whichever way it came.
pub async fn pictures_and_signed_videos_are_hosted(server: &TestServer) {
    let folder = tempfile::tempdir().unwrap();
    let server = with_folder(server, folder.path());
    let mut owner = owner(&server).await;
    let mut file = whole_study("pictured");
    let questions = file["questions"].as_array_mut().unwrap();
    let choice = questions.iter_mut().find(|question| question["type"] == "singleChoice").unwrap();
    choice["options"][0]["image"] = json!("pictures/first.png");
    choice["video"] = json!({"en": "signs/asl.webm", "fr": "signs/lsf.webm"});
    let media: [(&str, &[u8]); 3] = [
        ("pictures/first.png", b"\x89PNG the picture"),
        ("signs/asl.webm", b"\x1a\x45 signed in ASL"),
        ("signs/lsf.webm", b"\x1a\x45 signed in LSF"),
    ];
    let text = file.to_string();
    // One that is not in the archive is refused before anything is hosted.
    let lacking = packed(&[("study.json", text.as_bytes()), media[0]]);
    let answer = upload(&server, &owner, &lacking).await;
    assert_eq!(answer.status, StatusCode::UNPROCESSABLE_ENTITY);
    assert!(answer.text().contains("signs/asl.webm"), "{}", answer.text());
    let whole: Vec<_> = std::iter::once(("study.json", text.as_bytes())).chain(media).collect();
    let answer = upload(&server, &owner, &packed(&whole)).await;
    assert_eq!(answer.status, StatusCode::SEE_OTHER, "{}", answer.text());
    let page = prepared(&server, &mut owner, "pictured").await;
    assert!(page.contains("hosted as a pilot"), "{page}");
    let bundle: mimique_session::wire::Bundle = server.get("/api/studies/pictured").await.ok();
    for (path, bytes) in media {
        let source = bundle.clips.get(&format!("media:{path}"));
        let hash = source.unwrap_or_else(|| panic!("{path} is not hosted")).packs().next().unwrap();
        assert_eq!(server.get(&format!("/packs/{hash}")).await.body, bytes, "{path}");
    }
}

/// What cannot be prepared leaves nothing behind but why; what arrives is its owner's alone.
pub async fn what_fails_is_taken_away(server: &TestServer) {
    let folder = tempfile::tempdir().unwrap();
    let server = with_folder(server, folder.path());
    let mut owner = owner(&server).await;
    let mut file = whole_study("broken");
    file["stimuli"]["avatars"]["broken"] = json!({"file": "head.glb"});
    let avatars = file["stimuli"]["avatars"].as_object().unwrap().keys().cloned();
    let first = avatars.into_iter().find(|name| name != "broken").unwrap();
    file["stimuli"]["avatars"][&first] = json!({"file": "head.glb"});
    let text = file.to_string();
    let archive = packed(&[("study.json", text.as_bytes()), ("head.glb", b"no head")]);
    let answer = upload(&server, &owner, &archive).await;
    assert_eq!(answer.status, StatusCode::SEE_OTHER, "{}", answer.text());
    let page = prepared(&server, &mut owner, "broken").await;
    assert!(page.contains("role=\"alert\"") && page.contains("head.glb"), "{page}");
    // Files are named as the archive names them: where the server has put them is nothing for a page.
    assert!(!page.contains(&folder.path().display().to_string()), "{page}");
    let uploads = folder.path().join("uploads");
    assert_eq!(std::fs::read_dir(&uploads).unwrap().count(), 0);
    // Nor does what the server hosts by itself.
    owner.open(&server, "/researcher/upload").await;
    let own = upload(&server, &owner, whole_study("demo").to_string().as_bytes()).await;
    assert!(own.status.is_client_error(), "{}", own.text());
    assert_eq!(std::fs::read_dir(&uploads).unwrap().count(), 0);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode =
            |path: &std::path::Path| std::fs::metadata(path).unwrap().permissions().mode() & 0o777;
        assert_eq!(mode(&uploads), 0o700);
        if let Some(path) = server.url().strip_prefix("sqlite:") {
            for name in ["", "-wal"] {
                let path = format!("{path}{name}");
                assert_eq!(mode(std::path::Path::new(&path)), 0o600, "{path}");
            }
        }
    }
}

/// Whoever owns a study uploads new versions of it; other studies are the server's owners' to bring.
pub async fn an_owner_of_a_study_uploads_it_and_no_other(server: &TestServer) {
    let folder = tempfile::tempdir().unwrap();
    let server = with_folder(server, folder.path());
    let mut owner = owner(&server).await;
    let first = whole_study("theirs");
    upload(&server, &owner, first.to_string().as_bytes()).await;
    assert!(prepared(&server, &mut owner, "theirs").await.contains("hosted as a pilot"));
    owner.open(&server, "/researcher/people").await;
    let fields = [("email", "one@lab.org"), ("role", "owner"), ("study", "theirs")];
    let link = link_in(&owner.send(&server, "/researcher/people/invite", &fields).await);
    let mut lab = Browser::default();
    lab.open(&server, &link).await;
    lab.send(&server, &link, &[("email", "one@lab.org"), ("password", PASSWORD)]).await;
    assert!(lab.open(&server, "/researcher").await.text().contains("/researcher/upload"));
    lab.open(&server, "/researcher/upload").await;
    let uploads = folder.path().join("uploads");
    let kept = std::fs::read_dir(&uploads).unwrap().count();
    let other = upload(&server, &lab, whole_study("another").to_string().as_bytes()).await;
    assert_eq!(other.status, StatusCode::FORBIDDEN, "{}", other.text());
    assert_eq!(std::fs::read_dir(&uploads).unwrap().count(), kept, "nothing is left of it");
    let mut second = first.clone();
    second["studyMetadata"]["version"] = json!("2.0.0");
    let taken = upload(&server, &lab, second.to_string().as_bytes()).await;
    assert_eq!(taken.status, StatusCode::SEE_OTHER, "{}", taken.text());
    assert!(prepared(&server, &mut lab, "theirs").await.contains("hosted as a pilot"));
    let bundle: mimique_session::wire::Bundle = server.get("/api/studies/theirs").await.ok();
    assert_eq!(bundle.config_hash, mimique_study::config_hash(&second));
    let live = lab.send(&server, "/researcher/studies/theirs/stage", &[("stage", "live")]).await;
    assert_eq!(live.status, StatusCode::SEE_OTHER, "{}", live.text());
    assert_eq!(server.start_in("theirs", 1).await.stage, "live");
}

/// One name twice, a name that is a file and a folder, and JSON that would not fit into memory are refused by name.
pub async fn an_archive_is_refused_for_its_names_and_its_study_file(server: &TestServer) {
    let folder = tempfile::tempdir().unwrap();
    let server = with_folder(server, folder.path());
    let mut owner = owner(&server).await;
    owner.open(&server, "/researcher/upload").await;
    // No writer makes two entries of one name: the second is renamed in the bytes.
    let mut twice = packed(&[("study.json", b"{}"), ("study.jsox", b"{}")]);
    while let Some(at) = twice.windows(10).position(|bytes| bytes == b"study.jsox") {
        twice[at + 9] = b'n';
    }
    let mut ones = b"[".to_vec();
    ones.extend(b"1,".repeat(9 * 1024 * 1024));
    ones.extend(b"1]");
    for (name, archive, expected) in [
        ("twice", twice, "another entry has this name"),
        ("file and folder", packed(&[("study.json", b"{}"), ("a", b""), ("a/b", b"")]), "a/b"),
        (
            "folder and file",
            packed(&[("study.json", b"{}"), ("a/b", b""), ("A", b"")]),
            "&quot;A&quot;",
        ),
        ("large study", packed(&[("study.json", ones.as_slice())]), "study.json"),
        (
            "large settings",
            packed(&[("study.json", b"{}"), ("take.repair.json", ones.as_slice())]),
            "take.repair.json",
        ),
    ] {
        let answer = upload(&server, &owner, &archive).await;
        assert_eq!(answer.status, StatusCode::UNPROCESSABLE_ENTITY, "{name}: {}", answer.text());
        assert!(answer.text().contains(expected), "{name}: {}", answer.text());
        let path = folder.path().display().to_string();
        assert!(!answer.text().contains(&path), "{name}: {}", answer.text());
    }
}
