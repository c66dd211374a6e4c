//! Accounts: links, log-in, roles, forged forms, tokens, the log.

use axum::http::{Method, StatusCode, header};
use mimique_server::{Access, reset_link, router};
use mimique_storage::Role;

use crate::client::{TestServer, events};
use crate::people::{Browser, ORIGIN, PASSWORD, invited, link_in, owner, script, token};

const SESSION: &str = "mimique_session";

pub async fn the_first_link_makes_the_owner_once(server: &TestServer) {
    let link = server.app.first_owner_link().await.unwrap().unwrap();
    assert!(link.rsplit('/').next().unwrap().len() >= 32, "128 bits: {link}");
    let other = server.app.first_owner_link().await.unwrap().unwrap();
    let mut browser = Browser::default();
    // Looking uses nothing up.
    for _ in 0..2 {
        assert_eq!(browser.open(server, &link).await.status, StatusCode::OK);
    }
    let short = [("email", "a@b"), ("password", "too short")];
    let refused = browser.send(server, &link, &short).await;
    assert_eq!(refused.status, StatusCode::BAD_REQUEST);
    assert!(refused.text().contains("12 characters"), "{}", refused.text());
    let good = [("email", "a@b"), ("password", PASSWORD)];
    let made = browser.send(server, &link, &good).await;
    assert_eq!(made.status, StatusCode::SEE_OTHER);
    assert_eq!(browser.open(server, "/researcher").await.status, StatusCode::OK);
    // Neither this link nor the other one makes a second owner.
    for dead in [&link, &other] {
        let mut thief = Browser::default();
        thief.open(server, "/researcher/login").await;
        let fields = [("email", "thief@b"), ("password", PASSWORD)];
        let answer = thief.send(server, dead, &fields).await;
        answer.refused(StatusCode::GONE, "dead-link");
    }
    assert!(server.app.first_owner_link().await.unwrap().is_none());
    assert_eq!(server.storage.accounts().await.unwrap().len(), 1);
}

pub async fn links_expire_and_secrets_are_not_stored(server: &TestServer) {
    let link = server.app.first_owner_link().await.unwrap().unwrap();
    server.run_sql("UPDATE account_links SET expires_ms = 1000").await;
    let mut browser = Browser::default();
    let page = browser.open(server, &link).await;
    assert_eq!(page.status, StatusCode::GONE);
    let wrong = browser.open(server, "/researcher/link/00112233445566778899aabbccddeeff").await;
    assert_eq!(wrong.status, StatusCode::GONE);
    let mut browser = owner(server).await;
    let secret = browser.cookie_value(SESSION).unwrap().to_owned();
    assert_eq!(secret.len(), 32);
    // What the database holds of the session opens nothing.
    let mut forged = Browser::default();
    forged.cookies.push((SESSION.into(), crate::study::sha256(&secret)));
    let answer = forged.open(server, "/researcher").await;
    assert_eq!(answer.status, StatusCode::SEE_OTHER);
    // Nor does a session that was idle too long, or is too old.
    server.run_sql("UPDATE account_sessions SET seen_ms = 1000").await;
    let answer = browser.open(server, "/researcher").await;
    assert_eq!(answer.header(header::LOCATION), "/researcher/login?next=%2Fresearcher");
    browser.open(server, "/researcher/login").await;
    let fields = [("email", "owner@example.org"), ("password", PASSWORD)];
    browser.send(server, "/researcher/login", &fields).await;
    assert_eq!(browser.open(server, "/researcher").await.status, StatusCode::OK);
    server.run_sql("UPDATE account_sessions SET expires_ms = 1000").await;
    assert_eq!(browser.open(server, "/researcher").await.status, StatusCode::SEE_OTHER);
}

pub async fn logging_in_begins_a_new_session(server: &TestServer) {
    let mut known = owner(server).await;
    let mut browser = Browser::default();
    // A session that somebody planted is not the one that is logged in.
    browser.cookies.push((SESSION.into(), "0".repeat(32)));
    browser.open(server, "/researcher/login").await;
    let fields =
        [("email", " OWNER@example.org "), ("password", PASSWORD), ("next", "/researcher/log")];
    let answer = browser.send(server, "/researcher/login", &fields).await;
    assert_eq!(answer.status, StatusCode::SEE_OTHER);
    assert_eq!(answer.header(header::LOCATION), "/researcher/log");
    let cookie = answer.header(header::SET_COOKIE).to_owned();
    assert!(cookie.starts_with("mimique_session="), "{cookie}");
    for flag in ["HttpOnly", "SameSite=Lax", "Path=/", "Max-Age="] {
        assert!(cookie.contains(flag), "{flag}: {cookie}");
    }
    let fresh = browser.cookie_value(SESSION).unwrap().to_owned();
    assert_ne!(fresh, "0".repeat(32));
    assert_ne!(known.cookie_value(SESSION).unwrap(), fresh);
    // Logged out, the cookie of before opens nothing.
    browser.open(server, "/researcher/account").await;
    let kept = browser.clone();
    let out = browser.send(server, "/researcher/logout", &[]).await;
    assert_eq!(out.status, StatusCode::SEE_OTHER);
    let mut replayed = kept;
    assert_eq!(replayed.open(server, "/researcher").await.status, StatusCode::SEE_OTHER);
    // The other browser goes on, until it logs out everywhere.
    assert_eq!(known.open(server, "/researcher/account").await.status, StatusCode::OK);
    known.send(server, "/researcher/logout-everywhere", &[]).await;
    assert_eq!(known.open(server, "/researcher").await.status, StatusCode::SEE_OTHER);
}

pub async fn behind_tls_cookies_are_secure(server: &TestServer) {
    let access = Access { public_url: Some("https://faces.example".into()), ..Access::default() };
    let secure = router(server.app.clone().with_access(access));
    let server = server.with_router(secure);
    let link = server.app.first_owner_link().await.unwrap().unwrap();
    let mut browser = Browser::default();
    let page = browser.open(&server, &link).await;
    let cookie = page.header(header::SET_COOKIE);
    assert!(cookie.starts_with("__Host-mimique_form=") && cookie.contains("; Secure"), "{cookie}");
    let csrf = browser.csrf.clone();
    let fields = [("email", "a@b"), ("password", PASSWORD), ("csrf", csrf.as_str())];
    let origin = Some("https://faces.example");
    let made = browser.send_from(&server, &link, &fields, origin).await;
    assert_eq!(made.status, StatusCode::SEE_OTHER, "{}", made.text());
    let cookie = made.header(header::SET_COOKIE);
    assert!(
        cookie.starts_with("__Host-mimique_session=") && cookie.contains("; Secure"),
        "{cookie}"
    );
    // The address says it for everything, and so does the setting; what a caller says does not.
    assert!(page.header(header::STRICT_TRANSPORT_SECURITY).starts_with("max-age="));
    let settings = mimique_server::Settings { behind_tls: true, ..Default::default() };
    let set = server.with_settings(settings);
    let page = Browser::default().open(&set, "/researcher/login").await;
    assert!(page.header(header::SET_COOKIE).starts_with("__Host-"), "the setting alone is enough");
    let plain = server.with_router(router(server.app.clone()));
    let headers = [(axum::http::HeaderName::from_static("x-forwarded-proto"), "https")];
    let page = plain.get_with("/researcher/login", &headers).await;
    assert!(page.header(header::SET_COOKIE).starts_with("mimique_form="));
}

pub async fn wrong_passwords_wait_and_say_nothing(server: &TestServer) {
    owner(server).await;
    let mut said = Vec::new();
    for email in ["owner@example.org", "nobody@example.org"] {
        let mut browser = Browser::default();
        browser.open(server, "/researcher/login").await;
        for attempt in 1..=9 {
            let fields = [("email", email), ("password", "a wrong password")];
            let answer = browser.send(server, "/researcher/login", &fields).await;
            let wanted =
                if attempt <= 8 { StatusCode::FORBIDDEN } else { StatusCode::TOO_MANY_REQUESTS };
            assert_eq!(answer.status, wanted, "{email}, attempt {attempt}");
            if attempt == 1 {
                said.push(answer.text().replace(&browser.csrf, ""));
            }
        }
        // Even the right one has to wait now.
        let fields = [("email", email), ("password", PASSWORD)];
        let answer = browser.send(server, "/researcher/login", &fields).await;
        assert_eq!(answer.status, StatusCode::TOO_MANY_REQUESTS);
    }
    assert_eq!(said[0], said[1], "a known address looks like an unknown one");
    // A quarter of an hour later the right one is let in.
    server.run_sql("UPDATE login_attempts SET at_ms = at_ms - 901000").await;
    let mut browser = Browser::default();
    browser.open(server, "/researcher/login").await;
    let fields = [("email", "owner@example.org"), ("password", PASSWORD)];
    let answer = browser.send(server, "/researcher/login", &fields).await;
    assert_eq!(answer.status, StatusCode::SEE_OTHER);
}

pub async fn forged_forms_change_nothing(server: &TestServer) {
    let mut browser = owner(server).await;
    let other = invited(server, &mut browser, Role::Owner).await;
    server.start(1).await;
    let csrf = browser.csrf.clone();
    let theirs = other.csrf.clone();
    let mut posts = vec![
        "/researcher/logout".to_owned(),
        "/researcher/logout-everywhere".to_owned(),
        "/researcher/account/password".to_owned(),
        "/researcher/tokens".to_owned(),
        "/researcher/tokens/1/revoke".to_owned(),
        "/researcher/people/invite".to_owned(),
        "/researcher/people/1".to_owned(),
    ];
    for action in ["exclude", "include"] {
        posts.push(format!("/researcher/studies/faces/participants/1/{action}"));
    }
    for path in &posts {
        for (sent, origin) in [
            (None, Some(ORIGIN)),
            (Some(""), Some(ORIGIN)),
            (Some("00112233445566778899aabbccddeeff"), Some(ORIGIN)),
            (Some(theirs.as_str()), Some(ORIGIN)),
            (Some(csrf.as_str()), Some("https://evil.example")),
            (Some(csrf.as_str()), Some("null")),
            (Some(csrf.as_str()), None),
        ] {
            let mut fields =
                vec![("reason", "x"), ("email", "x@y"), ("role", "owner"), ("name", "n")];
            fields.extend([("action", "disable"), ("old", PASSWORD), ("new", "another password")]);
            fields.extend(sent.map(|sent| ("csrf", sent)));
            let answer = browser.send_from(server, path, &fields, origin).await;
            answer.refused(StatusCode::FORBIDDEN, "foreign-form");
        }
    }
    // Before there is a session too.
    let mut nobody = Browser::default();
    nobody.open(server, "/researcher/login").await;
    let token = nobody.csrf.clone();
    let fields = [("email", "owner@example.org"), ("password", PASSWORD)];
    for (sent, origin) in
        [("", Some(ORIGIN)), (theirs.as_str(), Some(ORIGIN)), (&token, Some("http://evil"))]
    {
        let fields: Vec<_> = fields.iter().copied().chain([("csrf", sent)]).collect();
        let answer = nobody.send_from(server, "/researcher/login", &fields, origin).await;
        answer.refused(StatusCode::FORBIDDEN, "foreign-form");
    }
    assert_eq!(browser.open(server, "/researcher").await.status, StatusCode::OK);
    assert!(server.storage.exclusions("faces").await.unwrap().is_empty());
    assert!(server.storage.tokens().await.unwrap().is_empty());
    let accounts = server.storage.accounts().await.unwrap();
    assert!(accounts.len() == 2 && accounts.iter().all(|account| account.disabled_ms.is_none()));
}

/// What a role gets of an address.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Gets {
    Page,
    Refused,
    LogIn,
}

pub async fn each_role_may_do_what_it_may(server: &TestServer) {
    let started = server.start(1).await;
    server.stored(&started.session, &events(0..3)).await;
    let mut owner = owner(server).await;
    let mut analyst = invited(server, &mut owner, Role::Analyst).await;
    let mut viewer = invited(server, &mut owner, Role::Viewer).await;
    let mut nobody = Browser::default();
    let study = "/researcher/studies/faces";
    use Gets::{LogIn, Page, Refused};
    let reads = [
        ("/researcher".to_owned(), [LogIn, Page, Page, Page]),
        (study.to_owned(), [LogIn, Page, Page, Page]),
        (format!("{study}/participants/1"), [LogIn, Page, Page, Page]),
        ("/researcher/account".to_owned(), [LogIn, Page, Page, Page]),
        ("/preview/faces".to_owned(), [LogIn, Page, Page, Page]),
        (format!("{study}/export/csv"), [LogIn, Refused, Page, Page]),
        (format!("{study}/export/wide"), [LogIn, Refused, Page, Page]),
        (format!("{study}/export/json"), [LogIn, Refused, Page, Page]),
        (format!("{study}/export/events"), [LogIn, Refused, Page, Page]),
        (format!("{study}/export/psych-ds"), [LogIn, Refused, Page, Page]),
        (format!("{study}/export/dictionary"), [LogIn, Refused, Page, Page]),
        (format!("{study}/export/stimuli"), [LogIn, Refused, Page, Page]),
        (format!("{study}/export/study"), [LogIn, Refused, Page, Page]),
        ("/researcher/people".to_owned(), [LogIn, Refused, Refused, Page]),
        ("/researcher/log".to_owned(), [LogIn, Refused, Refused, Page]),
        ("/researcher/upload".to_owned(), [LogIn, Refused, Refused, Page]),
    ];
    for (path, expected) in &reads {
        let browsers = [&mut nobody, &mut viewer, &mut analyst, &mut owner];
        for (browser, expected) in browsers.into_iter().zip(expected) {
            let answer = browser.open(server, path).await;
            let got = match answer.status {
                StatusCode::OK => Page,
                StatusCode::FORBIDDEN => Refused,
                StatusCode::SEE_OTHER => LogIn,
                other => panic!("{path}: {other}: {}", answer.text()),
            };
            assert_eq!(got, *expected, "{path}");
            assert!(!answer.header(header::CONTENT_SECURITY_POLICY).contains("unsafe-inline"));
        }
    }
    for browser in [&mut viewer, &mut analyst, &mut owner] {
        browser.open(server, "/researcher/account").await;
    }
    let person = format!("{study}/participants/1");
    let writes = [
        (format!("{person}/exclude"), vec![("reason", "asleep")], [Refused, Page, Page]),
        (format!("{person}/include"), vec![], [Refused, Page, Page]),
        (
            "/researcher/people/invite".to_owned(),
            vec![("email", "x@y"), ("role", "viewer")],
            [Refused, Refused, Page],
        ),
        (
            "/researcher/people/1".to_owned(),
            vec![("action", "role"), ("role", "owner")],
            [Refused, Refused, Page],
        ),
        (
            "/researcher/tokens".to_owned(),
            vec![("name", "t"), ("role", "owner")],
            [Refused, Refused, Page],
        ),
    ];
    for (path, fields, expected) in &writes {
        let browsers = [&mut viewer, &mut analyst, &mut owner];
        for (browser, expected) in browsers.into_iter().zip(expected) {
            let answer = browser.send(server, path, fields).await;
            let got = match answer.status {
                StatusCode::OK | StatusCode::SEE_OTHER => Page,
                StatusCode::FORBIDDEN => Refused,
                other => panic!("{path}: {other}: {}", answer.text()),
            };
            assert_eq!(got, *expected, "{path} {}", answer.text());
        }
    }
    // What people said is for those who may read it.
    let page = viewer.open(server, &person).await.text();
    assert!(!page.contains("mood: "), "{page}");
    assert!(analyst.open(server, &person).await.text().contains("mood: "));
}

pub async fn tokens_do_what_their_role_may_until_revoked(server: &TestServer) {
    let started = server.start(1).await;
    server.stored(&started.session, &events(0..2)).await;
    let mut owner = owner(server).await;
    let mut analyst = invited(server, &mut owner, Role::Analyst).await;
    let key = token(server, &mut analyst, Role::Analyst).await;
    assert!(key.len() >= 32);
    let csv = "/researcher/studies/faces/export/csv";
    let answer = script(server, Method::GET, csv, &key).await;
    assert_eq!(answer.status, StatusCode::OK, "{}", answer.text());
    assert_eq!(answer.header(header::CONTENT_TYPE), "text/csv; charset=utf-8");
    // A script reads no cookie and needs no form's token; it makes no tokens and no people.
    let tokens = script(server, Method::POST, "/researcher/tokens", &key).await;
    assert_eq!(tokens.status, StatusCode::BAD_REQUEST, "the fields are missing");
    let people = script(server, Method::GET, "/researcher/people", &key).await;
    people.refused(StatusCode::FORBIDDEN, "not-allowed");
    let wrong = script(server, Method::GET, csv, "mimique_00112233445566778899aabbccddeeff").await;
    wrong.refused(StatusCode::UNAUTHORIZED, "log-in-first");
    // A viewer's token exports nothing.
    let lesser = token(server, &mut analyst, Role::Viewer).await;
    let answer = script(server, Method::GET, csv, &lesser).await;
    answer.refused(StatusCode::FORBIDDEN, "not-allowed");
    // When the person may do less, so may the token.
    let accounts = server.storage.accounts().await.unwrap();
    let person = accounts.iter().find(|account| account.role == Role::Analyst).unwrap();
    let path = format!("/researcher/people/{}", person.key);
    owner.send(server, &path, &[("action", "role"), ("role", "viewer")]).await;
    let answer = script(server, Method::GET, csv, &key).await;
    answer.refused(StatusCode::FORBIDDEN, "not-allowed");
    owner.send(server, &path, &[("action", "role"), ("role", "analyst")]).await;
    assert_eq!(script(server, Method::GET, csv, &key).await.status, StatusCode::OK);
    let first = server.storage.tokens().await.unwrap()[0].key;
    let revoked = analyst.send(server, &format!("/researcher/tokens/{first}/revoke"), &[]).await;
    assert_eq!(revoked.status, StatusCode::SEE_OTHER);
    let answer = script(server, Method::GET, csv, &key).await;
    answer.refused(StatusCode::UNAUTHORIZED, "log-in-first");
}

pub async fn a_lost_password_is_replaced(server: &TestServer) {
    let mut owner = owner(server).await;
    let mut analyst = invited(server, &mut owner, Role::Analyst).await;
    // By oneself: the old password is asked for, other browsers are logged out.
    let wrong = [("old", "not the password"), ("new", "five words are better still")];
    let answer = analyst.send(server, "/researcher/account/password", &wrong).await;
    answer.refused(StatusCode::BAD_REQUEST, "bad-request");
    let right = [("old", PASSWORD), ("new", "five words are better still")];
    let answer = analyst.send(server, "/researcher/account/password", &right).await;
    assert_eq!(answer.status, StatusCode::OK);
    // By the owner's link, and by the command line's.
    let accounts = server.storage.accounts().await.unwrap();
    let person = accounts.iter().find(|account| account.role == Role::Analyst).unwrap();
    let path = format!("/researcher/people/{}", person.key);
    let by_owner = link_in(&owner.send(server, &path, &[("action", "reset")]).await);
    let by_command = reset_link(&server.storage, "Analyst@example.org").await.unwrap();
    let mut browser = Browser::default();
    browser.open(server, "/researcher/login").await;
    let fields = [("email", "ignored@x"), ("password", "six words are best of all")];
    let replaced = browser.send(server, &by_owner, &fields).await;
    replaced.refused(StatusCode::GONE, "dead-link");
    let used = browser.send(server, &by_command, &fields).await;
    assert_eq!(used.status, StatusCode::SEE_OTHER, "{}", used.text());
    assert!(
        browser.open(server, "/researcher/account").await.text().contains("analyst@example.org")
    );
    // Whoever was logged in by the old password is so no more.
    assert_eq!(analyst.open(server, "/researcher").await.status, StatusCode::SEE_OTHER);
    let unknown = reset_link(&server.storage, "nobody@example.org").await.unwrap_err();
    assert!(unknown.to_string().contains("analyst@example.org, owner@example.org"), "{unknown}");
}

pub async fn somebody_always_owns_the_server(server: &TestServer) {
    let mut owner = owner(server).await;
    for fields in [vec![("action", "disable")], vec![("action", "role"), ("role", "viewer")]] {
        let answer = owner.send(server, "/researcher/people/1", &fields).await;
        answer.refused(StatusCode::CONFLICT, "last-owner");
    }
    let mut second = invited(server, &mut owner, Role::Owner).await;
    let answer = second.send(server, "/researcher/people/1", &[("action", "disable")]).await;
    assert_eq!(answer.status, StatusCode::SEE_OTHER);
    // At once, everywhere.
    assert_eq!(owner.open(server, "/researcher").await.status, StatusCode::SEE_OTHER);
    let mut browser = Browser::default();
    browser.open(server, "/researcher/login").await;
    let fields = [("email", "owner@example.org"), ("password", PASSWORD)];
    let answer = browser.send(server, "/researcher/login", &fields).await;
    assert_eq!(answer.status, StatusCode::FORBIDDEN);
}

pub async fn the_log_says_who_did_what(server: &TestServer) {
    let started = server.start(1).await;
    server.stored(&started.session, &events(0..3)).await;
    let mut owner = owner(server).await;
    owner.open(server, "/researcher/studies/faces/export/csv?with_identifiers=true").await;
    let person = "/researcher/studies/faces/participants/1";
    owner.send(server, &format!("{person}/exclude"), &[("reason", "fell asleep, said so")]).await;
    owner.send(server, &format!("{person}/include"), &[]).await;
    let key = token(server, &mut owner, Role::Analyst).await;
    script(server, Method::GET, "/researcher/studies/faces/export/json", &key).await;
    reset_link(&server.storage, "owner@example.org").await.unwrap();
    let page = owner.open(server, "/researcher/log").await.text();
    for line in [
        "<td>owner@example.org</td><td>use a link</td>",
        "<td>export</td><td>faces</td><td>csv, identifiers</td>",
        "<td>exclude</td><td>faces</td><td>p0001</td>",
        "<td>take an exclusion back</td>",
        "<td>owner@example.org (token)</td><td>export</td><td>faces</td><td>json</td>",
        "<td>(server)</td><td>reset link</td>",
    ] {
        assert!(page.contains(line), "{line} in {page}");
    }
    // Neither answers nor secrets nor the words of a reason.
    for hidden in ["asleep", key.as_str(), "mood", PASSWORD, "person 1"] {
        assert!(!page.contains(hidden), "{hidden}");
    }
}

pub async fn what_is_hosted_is_for_researchers(server: &TestServer) {
    server.get("/api/studies").await.refused(StatusCode::UNAUTHORIZED, "log-in-first");
    server.get("/preview/faces").await.refused(StatusCode::UNAUTHORIZED, "log-in-first");
    let exertion = "/preview/faces/exertion?clip=run";
    server.get(exertion).await.refused(StatusCode::UNAUTHORIZED, "log-in-first");
    assert!(!server.get("/").await.text().contains("/s/faces/"));
    // The page of a participant needs what it needs.
    assert_eq!(server.get("/s/faces/").await.status, StatusCode::OK);
    assert_eq!(server.get("/api/studies/faces").await.status, StatusCode::OK);
    let access = Access { open_preview: true, ..Access::default() };
    let open = server.with_router(router(server.app.clone().with_access(access)));
    assert_eq!(open.get("/api/studies").await.status, StatusCode::OK);
    assert_eq!(open.get("/preview/faces").await.status, StatusCode::OK);
    open.get(exertion).await.refused(StatusCode::NOT_FOUND, "not-found");
    assert!(open.get("/").await.text().contains("/s/faces/"));
}

/// Whoever was shut out has no way back that was prepared before.
pub async fn a_disabled_account_has_no_way_in(server: &TestServer) {
    let mut owner = owner(server).await;
    let mut analyst = invited(server, &mut owner, Role::Analyst).await;
    let key = token(server, &mut analyst, Role::Analyst).await;
    let accounts = server.storage.accounts().await.unwrap();
    let person = accounts.iter().find(|account| account.role == Role::Analyst).unwrap();
    let path = format!("/researcher/people/{}", person.key);
    let earlier = link_in(&owner.send(server, &path, &[("action", "reset")]).await);
    assert_eq!(Browser::default().open(server, &earlier).await.status, StatusCode::OK);
    owner.send(server, &path, &[("action", "disable")]).await;
    let disabled = async || {
        let accounts = server.storage.accounts().await.unwrap();
        let person = accounts.into_iter().find(|account| account.role == Role::Analyst);
        person.unwrap().disabled_ms.is_some()
    };
    let mut back = Browser::default();
    back.open(server, "/researcher/login").await;
    let fields = [("email", "x@y"), ("password", "six words are best of all")];
    let used = back.send(server, &earlier, &fields).await;
    used.refused(StatusCode::GONE, "dead-link");
    assert!(disabled().await);
    // Nor can a link be made that would work at once when the account is enabled by mistake.
    let refused = owner.send(server, &path, &[("action", "reset")]).await;
    refused.refused(StatusCode::CONFLICT, "account-disabled");
    // A link of before that is still in the database, as one of an earlier version, enables nothing.
    let secret = "00112233445566778899aabbccddeeff";
    let link = mimique_storage::AccountLink {
        purpose: mimique_storage::LinkPurpose::Reset,
        email: "analyst@example.org".into(),
        role: Role::Analyst,
        study_id: None,
        expires_ms: i64::MAX,
    };
    server.storage.add_link(&crate::study::sha256(secret), &link, 0).await.unwrap();
    let used = back.send(server, &format!("/researcher/link/{secret}"), &fields).await;
    used.refused(StatusCode::GONE, "dead-link");
    assert!(disabled().await);
    // Enabled again, neither its sessions nor its tokens are.
    owner.send(server, &path, &[("action", "enable")]).await;
    assert_eq!(analyst.open(server, "/researcher").await.status, StatusCode::SEE_OTHER);
    let csv = "/researcher/studies/faces/export/csv";
    let answer = script(server, Method::GET, csv, &key).await;
    answer.refused(StatusCode::UNAUTHORIZED, "log-in-first");
    // Who can reach the database gets in, as before.
    owner.send(server, &path, &[("action", "disable")]).await;
    let by_command = reset_link(&server.storage, "analyst@example.org").await.unwrap();
    let used = back.send(server, &by_command, &fields).await;
    assert_eq!(used.status, StatusCode::SEE_OTHER, "{}", used.text());
    assert!(!disabled().await);
}

/// A token of an owner, once stolen, makes no way in that outlives it.
pub async fn no_token_manages_people(server: &TestServer) {
    let mut owner = owner(server).await;
    let key = token(server, &mut owner, Role::Owner).await;
    let ask = async |path: &str, fields: &[(&str, &str)]| {
        let request = axum::http::Request::post(path)
            .header(header::AUTHORIZATION, format!("Bearer {key}"))
            .header(header::CONTENT_TYPE, "application/x-www-form-urlencoded")
            .body(axum::body::Body::from(crate::people::encoded(fields)));
        server.send(request.unwrap()).await
    };
    for fields in [
        &[("action", "reset")][..],
        &[("action", "role"), ("role", "viewer")],
        &[("action", "enable")],
        &[("action", "disable")],
    ] {
        ask("/researcher/people/1", fields).await.refused(StatusCode::FORBIDDEN, "not-allowed");
    }
    let invitation = [("email", "thief@x"), ("role", "owner")];
    let invited = ask("/researcher/people/invite", &invitation).await;
    invited.refused(StatusCode::FORBIDDEN, "not-allowed");
    assert_eq!(server.storage.accounts().await.unwrap().len(), 1);
    // It goes with the password that it was made under.
    let csv = "/researcher/studies/faces/export/csv";
    assert_eq!(script(server, Method::GET, csv, &key).await.status, StatusCode::OK);
    owner.open(server, "/researcher/account").await;
    let fields = [("old", PASSWORD), ("new", "five words are better still")];
    let changed = owner.send(server, "/researcher/account/password", &fields).await;
    assert_eq!(changed.status, StatusCode::OK);
    let answer = script(server, Method::GET, csv, &key).await;
    answer.refused(StatusCode::UNAUTHORIZED, "log-in-first");
    assert_eq!(
        owner.open(server, "/researcher").await.status,
        StatusCode::OK,
        "this browser stays"
    );
    // And with a password that a link has set.
    let key = token(server, &mut owner, Role::Owner).await;
    let link = reset_link(&server.storage, "owner@example.org").await.unwrap();
    let mut browser = Browser::default();
    browser.open(server, &link).await;
    browser.send(server, &link, &[("email", "x@y"), ("password", PASSWORD)]).await;
    let answer = script(server, Method::GET, csv, &key).await;
    answer.refused(StatusCode::UNAUTHORIZED, "log-in-first");
}

/// Whoever tries passwords at an account makes strangers wait, not the person whose browser is known.
pub async fn nobody_can_lock_an_owner_out(server: &TestServer) {
    let mut known = owner(server).await;
    known.send(server, "/researcher/logout", &[]).await;
    let attempt = async |browser: &mut Browser, password: &str| {
        browser.open(server, "/researcher/login").await;
        let fields = [("email", "owner@example.org"), ("password", password)];
        browser.send(server, "/researcher/login", &fields).await.status
    };
    let mut stranger = Browser::default();
    for _ in 0..8 {
        assert_eq!(attempt(&mut stranger, "a wrong password").await, StatusCode::FORBIDDEN);
    }
    for _ in 0..20 {
        let waits = attempt(&mut stranger, PASSWORD).await;
        assert_eq!(waits, StatusCode::TOO_MANY_REQUESTS);
    }
    // A mark that the server has not made, or made for somebody else, is none.
    let mark = known.cookie_value("mimique_known").unwrap().to_owned();
    assert_eq!(mark.len(), 64);
    stranger.cookies.push(("mimique_known".into(), "0".repeat(64)));
    assert_eq!(attempt(&mut stranger, PASSWORD).await, StatusCode::TOO_MANY_REQUESTS);
    assert_eq!(attempt(&mut known, PASSWORD).await, StatusCode::SEE_OTHER);
    // A known browser is bounded as well, by itself.
    known.send(server, "/researcher/logout", &[]).await;
    let mut stolen = Browser::default();
    let mark = known.cookie_value("mimique_known").unwrap().to_owned();
    stolen.cookies.push(("mimique_known".into(), mark));
    for _ in 0..8 {
        assert_eq!(attempt(&mut stolen, "a wrong password").await, StatusCode::FORBIDDEN);
    }
    assert_eq!(attempt(&mut stolen, PASSWORD).await, StatusCode::TOO_MANY_REQUESTS);
}

/// One address cannot go through the accounts with a password that many have.
pub async fn one_address_cannot_try_every_account(server: &TestServer) {
    let (behind_proxy, logins_per_address) = (true, 2);
    let settings =
        mimique_server::Settings { behind_proxy, logins_per_address, ..Default::default() };
    let server = server.with_settings(settings);
    let mut browser = Browser::default();
    browser.open(&server, "/researcher/login").await;
    let attempt = async |address: &str, email: &str| {
        let fields = [("email", email), ("password", "123"), ("csrf", browser.csrf.as_str())];
        let request = axum::http::Request::post("/researcher/login")
            .header(header::HOST, crate::people::HOST)
            .header(header::ORIGIN, ORIGIN)
            .header(header::COOKIE, browser.cookie())
            .header(header::CONTENT_TYPE, "application/x-www-form-urlencoded")
            .header("x-real-ip", address)
            .body(axum::body::Body::from(crate::people::encoded(&fields)));
        server.send(request.unwrap()).await.status
    };
    for (number, status) in (0..).zip([
        StatusCode::FORBIDDEN,
        StatusCode::FORBIDDEN,
        StatusCode::TOO_MANY_REQUESTS,
        StatusCode::TOO_MANY_REQUESTS,
    ]) {
        assert_eq!(attempt("192.0.2.1", &format!("person{number}@example.org")).await, status);
    }
    assert_eq!(attempt("192.0.2.2", "person@example.org").await, StatusCode::FORBIDDEN);
}
