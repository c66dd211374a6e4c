//! Roles in single studies.

use axum::http::{Method, StatusCode};
use mimique_storage::Role;

use crate::client::{TestServer, events};
use crate::people::{Browser, PASSWORD, link_in, owner, script, token};

/// Somebody invited to one study, logged in.
async fn invited_to(
    server: &TestServer,
    owner: &mut Browser,
    email: &str,
    study: &str,
    role: Role,
) -> Browser {
    let fields = [("email", email), ("role", role.word()), ("study", study)];
    let page = owner.send(server, "/researcher/people/invite", &fields).await;
    let link = link_in(&page);
    let mut browser = Browser::default();
    let invitation = browser.open(server, &link).await.text();
    assert!(invitation.contains(&format!("In the study <code>{study}</code>")), "{invitation}");
    let fields = [("email", email), ("password", PASSWORD)];
    let made = browser.send(server, &link, &fields).await;
    assert_eq!(made.status, StatusCode::SEE_OTHER, "{}", made.text());
    browser.open(server, "/researcher/account").await;
    browser
}

pub async fn a_role_in_one_study_is_none_in_another(server: &TestServer) {
    for study in ["faces", "demo"] {
        let started = server.start_in(study, 1).await;
        server.stored(&started.session, &events(0..3)).await;
    }
    let mut owner = owner(server).await;
    let mut people = Vec::new();
    for role in Role::ALL {
        let email = format!("{}@faces.org", role.word());
        people.push((role, invited_to(server, &mut owner, &email, "faces", role).await));
    }
    for (role, browser) in &mut people {
        let role = *role;
        // They see the study that they have a role in, and no other.
        let home = browser.open(server, "/researcher").await.text();
        assert!(home.contains("/researcher/studies/faces"), "{home}");
        assert!(!home.contains("/researcher/studies/demo"), "{home}");
        assert!(!home.contains("href=\"/researcher/people\""), "{home}");
        let list = browser.open(server, "/api/studies").await.text();
        assert!(list.contains("\"faces\"") && !list.contains("\"demo\""), "{list}");
        let may = |needed: Role| match role >= needed {
            true => StatusCode::OK,
            false => StatusCode::FORBIDDEN,
        };
        for (path, needed) in [
            ("", Role::Viewer),
            ("/participants/1", Role::Viewer),
            ("/export/csv", Role::Analyst),
            ("/export/wide", Role::Analyst),
            ("/export/psych-ds", Role::Analyst),
            ("/export/stimuli", Role::Analyst),
            ("/export/study", Role::Analyst),
        ] {
            let own = browser.open(server, &format!("/researcher/studies/faces{path}")).await;
            assert_eq!(own.status, may(needed), "{role:?} {path} {}", own.text());
            let other = browser.open(server, &format!("/researcher/studies/demo{path}")).await;
            assert_eq!(other.status, StatusCode::NOT_FOUND, "{role:?} {path}");
        }
        for path in
            ["/researcher/studies/demo/live", "/researcher/studies/demo/report/en/report.html"]
        {
            assert_eq!(browser.open(server, path).await.status, StatusCode::NOT_FOUND, "{path}");
        }
        assert_eq!(browser.open(server, "/preview/faces").await.status, StatusCode::OK);
        assert_eq!(browser.open(server, "/preview/demo").await.status, StatusCode::NOT_FOUND);
        // The server is nobody's of them.
        for path in ["/researcher/people", "/researcher/log"] {
            assert_eq!(browser.open(server, path).await.status, StatusCode::FORBIDDEN, "{path}");
        }
        browser.open(server, "/researcher/account").await;
        let fields = [("reason", "asleep")];
        for (study, expected) in [
            (
                "faces",
                if role >= Role::Analyst { StatusCode::SEE_OTHER } else { StatusCode::FORBIDDEN },
            ),
            ("demo", StatusCode::NOT_FOUND),
        ] {
            let path = format!("/researcher/studies/{study}/participants/1/exclude");
            assert_eq!(browser.send(server, &path, &fields).await.status, expected, "{role:?}");
        }
        for (path, fields) in [
            ("/researcher/studies/demo/participants/1/erase", vec![("confirmation", "p0001")]),
            ("/researcher/studies/demo/participants/1/include", vec![]),
            ("/researcher/studies/demo/withdraw", vec![("code", "x")]),
            ("/researcher/studies/demo/keep", vec![]),
            ("/researcher/studies/demo/stage", vec![("stage", "live")]),
            ("/researcher/studies/demo/remove", vec![]),
        ] {
            let answer = browser.send(server, path, &fields).await;
            assert_eq!(answer.status, StatusCode::NOT_FOUND, "{role:?} {path}");
        }
        for (path, fields) in [
            ("/researcher/people/invite", vec![("email", "x@y.org"), ("role", "owner")]),
            ("/researcher/people/1", vec![("action", "disable")]),
            ("/researcher/clock", vec![]),
        ] {
            let answer = browser.send(server, path, &fields).await;
            assert_eq!(answer.status, StatusCode::FORBIDDEN, "{role:?} {path}");
        }
        // Nobody gives a script more than they have.
        let fields = [("name", "t"), ("role", Role::Owner.word())];
        let answer = browser.send(server, "/researcher/tokens", &fields).await;
        assert_eq!(answer.status, may(Role::Owner), "{role:?}");
    }
    // A token of theirs goes no further than they do.
    let (_, analyst) = &mut people[1];
    analyst.open(server, "/researcher/account").await;
    let analysts = token(server, analyst, Role::Analyst).await;
    let export = |study: &str| format!("/researcher/studies/{study}/export/csv");
    assert_eq!(script(server, Method::GET, &export("faces"), &analysts).await.status, 200);
    assert_eq!(script(server, Method::GET, &export("demo"), &analysts).await.status, 404);
    let viewers = token(server, analyst, Role::Viewer).await;
    assert_eq!(script(server, Method::GET, &export("faces"), &viewers).await.status, 403);
    // An owner deletes in the study that is theirs.
    let (_, faces) = &mut people[2];
    let erase = "/researcher/studies/faces/participants/1/erase";
    let erased = faces.send(server, erase, &[("confirmation", "p0001")]).await;
    assert_eq!(erased.status, StatusCode::SEE_OTHER, "{}", erased.text());
    // The server's owner gives one more role, and takes the first away: at once, of the token, too.
    let page = owner.open(server, "/researcher/people").await.text();
    let row = &page[page.find("analyst@faces.org</th>").expect("the analyst")..];
    let key = &row[row.find("/researcher/people/").unwrap() + "/researcher/people/".len()..];
    let path = format!("/researcher/people/{}", key.split('"').next().unwrap());
    for (study, role) in [("demo", "viewer"), ("faces", "none")] {
        let fields = [("action", "study-role"), ("study", study), ("role", role)];
        let answer = owner.send(server, &path, &fields).await;
        assert_eq!(answer.status, StatusCode::SEE_OTHER, "{}", answer.text());
    }
    let (_, analyst) = &mut people[1];
    let home = analyst.open(server, "/researcher").await.text();
    assert!(home.contains("/researcher/studies/demo"), "{home}");
    assert!(!home.contains("/researcher/studies/faces"), "{home}");
    assert_eq!(script(server, Method::GET, &export("faces"), &analysts).await.status, 404);
    assert_eq!(script(server, Method::GET, &export("demo"), &analysts).await.status, 403);
    let log = owner.open(server, "/researcher/log").await.text();
    assert!(
        log.contains("account: study-role") && log.contains("analyst@faces.org (none)"),
        "{log}"
    );
    let unknown = [("action", "study-role"), ("study", "unheard-of"), ("role", "viewer")];
    assert_eq!(owner.send(server, &path, &unknown).await.status, StatusCode::NOT_FOUND);
}
