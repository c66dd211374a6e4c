//! The replay of a session: for whom it is, and what stands in it.

use axum::http::{StatusCode, header};
use mimique_session::wire::Event;
use mimique_storage::Role;
use serde_json::{Value, json};

use crate::client::TestServer;
use crate::participant::takes_part;
use crate::people::{invited, owner};
use crate::study;

const PAGE: &str = "/researcher/studies/demo/participants/1/replay";

/// A frame of the second clip came late.
fn with_a_late_frame(events: &mut [Event]) {
    let mut plays = events.iter_mut().filter(|event| event.body["type"] == "trial_played");
    let log = &mut plays.nth(1).expect("a second clip").body["log"];
    let frames = log["frames"].as_array_mut().unwrap();
    frames.truncate(3);
    frames[2] = json!([100.25, 100.25, 1.0]);
    log["late"] = json!(1);
    log["longest_ms"] = json!(83.583);
}

pub async fn a_session_is_gone_through_again(server: &TestServer) {
    let demo = study::demo();
    let started = server.start_in("demo", 1).await;
    let (mut events, planted) = takes_part(demo.study(), &started, 12);
    with_a_late_frame(&mut events);
    server.stored(&started.session, &events).await;

    let mut owner = owner(server).await;
    let person = owner.open(server, "/researcher/studies/demo/participants/1").await.text();
    assert!(person.contains(&format!("href=\"{PAGE}\"")), "{person}");
    let page = owner.open(server, PAGE).await;
    assert_eq!(page.status, StatusCode::OK, "{}", page.text());
    let page = page.text();
    // Every page that was left, and the one on the screen.
    assert_eq!(page.matches("class=\"card seen\"").count(), 13, "{page}");
    assert_eq!(page.matches(", not left").count(), 1);
    assert!(page.contains("Clip 1 of 12"), "{page}");
    assert!(page.contains("Which emotion do you recognise?"), "{page}");
    // In the words that were read: the label, and not what stands in the table.
    let emotion = planted.iter().find(|((_, _, question), _)| question == "emotion").unwrap().1;
    let option = emotion.as_str().unwrap();
    assert!(page.to_lowercase().contains(&format!(">{option}</span>")), "{option} in {page}");
    assert!(page.contains("3 frames, 1 late, longest 83.6 ms"), "{page}");
    for inline in ["<style", " style=", " onclick="] {
        assert!(!page.contains(inline), "{inline}");
    }

    // Frames come with the page that they are of, alone.
    let trials: Vec<usize> = (1..=13)
        .filter(|number| page.contains(&format!("id=\"page-{number}\" data-plays")))
        .collect();
    assert!(trials.len() > 2, "{trials:?}");
    let second: Value = owner.open(server, &format!("{PAGE}/{}", trials[1])).await.json();
    assert_eq!(second["configHash"], started.config_hash);
    let plays = second["plays"].as_array().unwrap();
    assert_eq!(plays.len(), 1);
    let late = json!([[0.0, 0.0, 0.0], [16.667, 16.667, 0.0], [100.25, 100.25, 1.0]]);
    assert_eq!((&plays[0]["frames"], &plays[0]["late"]), (&late, &json!(1)));
    let clip = &plays[0]["clips"][0];
    assert_eq!(clip["weightsHash"], "00ff");
    let shown = events.iter().filter(|event| event.body["type"] == "trial_started").nth(1).unwrap();
    assert_eq!(clip["clip"], shown.body["clip"]);
    let consent: Value = owner.open(server, &format!("{PAGE}/1")).await.json();
    assert_eq!(consent["plays"], json!([]));
    for number in [0, 14] {
        let answer = owner.open(server, &format!("{PAGE}/{number}")).await;
        assert_eq!(answer.status, StatusCode::NOT_FOUND, "{number}");
    }
    let log = owner.open(server, "/researcher/log").await.text();
    assert!(log.contains("replay a session"), "{log}");

    // In French too.
    owner.open(server, "/researcher/language/fr?next=/researcher").await;
    let page = owner.open(server, PAGE).await.text();
    assert!(page.contains("p0001 revu") && page.contains("3 images, 1 en retard"), "{page}");
}

pub async fn a_replay_is_for_those_who_may_read_answers(server: &TestServer) {
    let demo = study::demo();
    let started = server.start_in("demo", 1).await;
    let (events, _) = takes_part(demo.study(), &started, 8);
    server.stored(&started.session, &events).await;
    let mut owner = owner(server).await;
    let nobody = server.get_with(PAGE, &[(header::ACCEPT, "application/json")]).await;
    nobody.refused(StatusCode::UNAUTHORIZED, "log-in-first");
    let mut viewer = invited(server, &mut owner, Role::Viewer).await;
    for path in [PAGE.to_owned(), format!("{PAGE}/7")] {
        assert_eq!(viewer.open(server, &path).await.status, StatusCode::FORBIDDEN, "{path}");
    }
    let person = viewer.open(server, "/researcher/studies/demo/participants/1").await.text();
    assert!(!person.contains(PAGE), "{person}");
    let mut analyst = invited(server, &mut owner, Role::Analyst).await;
    assert_eq!(analyst.open(server, PAGE).await.status, StatusCode::OK);
    // Whoever has withdrawn has left nothing to look at.
    server.withdrawn(&started.session, &started.withdrawal_code).await;
    let page = analyst.open(server, PAGE).await.text();
    assert!(page.contains("Nothing is stored.") && !page.contains("class=\"card seen\""), "{page}");
}
