//! The dashboard of a large study: pages of participants, sums that are kept.

use axum::http::StatusCode;
use mimique_analysis::{Parameters, Simulation};
use mimique_server::SUMS_FORM;
use mimique_study::Study;
use serde_json::json;

use crate::client::TestServer;
use crate::people::owner;
use crate::researcher::demo_participant;
use crate::study;

/// However many there are, a page lists a hundred.
pub async fn the_list_of_participants_has_pages(server: &TestServer) {
    for number in 1..=230 {
        let session = crate::storage::session("faces", format!("{number:064}"));
        server.storage.start(session).await.unwrap();
    }
    server.run_sql("UPDATE sessions SET status = 'declined' WHERE participant % 2 = 0").await;
    let mut owner = owner(server).await;
    let mut listed = async |query: &str| -> (Vec<u64>, String) {
        let page = owner.open(server, &format!("/researcher/studies/faces{query}")).await;
        assert_eq!(page.status, StatusCode::OK, "{}", page.text());
        let text = page.text();
        let people = text.split("/participants/").skip(1);
        (people.map(|rest| rest.split('"').next().unwrap().parse().unwrap()).collect(), text)
    };
    let (people, first) = listed("").await;
    assert_eq!(people, (131..=230).rev().collect::<Vec<_>>());
    assert!(first.contains("1–100 of 230"), "{first}");
    assert!(first.contains("href=\"/researcher/studies/faces?page=2\""), "{first}");
    assert!(first.contains("<dt>declined</dt><dd>115</dd>"), "counts are of all of them");
    let (people, last) = listed("?page=3").await;
    assert_eq!(people, (1..=30).rev().collect::<Vec<_>>());
    assert!(last.contains("201–230 of 230") && !last.contains("rel=\"next\""), "{last}");
    assert!(last.contains("href=\"/researcher/studies/faces?page=2\""), "{last}");
    assert_eq!(listed("?page=99").await.0.len(), 30, "there are not so many");
    let (people, declined) = listed("?standing=declined&page=2").await;
    assert_eq!(people, (1..=15).rev().map(|half| half * 2).collect::<Vec<_>>());
    assert!(
        declined.contains("href=\"/researcher/studies/faces?standing=declined\""),
        "{declined}"
    );
    let answer = owner.open(server, "/researcher/studies/faces?standing=gone").await;
    assert_eq!(answer.status, StatusCode::NOT_FOUND);
}

/// The page without what differs each time it is looked at.
fn figures(page: &str) -> String {
    page[page.find("<dl class=\"counts\">").expect("the counts")..].to_owned()
}

/// What is counted of a session is kept, and is not read again; counted anew it is the same.
pub async fn sums_are_kept_and_are_what_is_counted_anew(server: &TestServer) {
    demo_participant(server, 1, usize::MAX).await;
    demo_participant(server, 2, 6).await;
    demo_participant(server, 3, 11).await;
    let mut owner = owner(server).await;
    let path = "/researcher/studies/demo";
    let before = figures(&owner.open(server, path).await.text());
    assert!(before.contains("trial 12"), "{before}");
    // What is kept is not made of the events again: neither in this process nor in the next one.
    server.run_sql("UPDATE events SET body = '{}'").await;
    assert_eq!(figures(&owner.open(server, path).await.text()), before);
    let server = server.restart().await;
    assert_eq!(figures(&owner.open(&server, path).await.text()), before);
    // Without what was kept there is nothing to see any more.
    server.run_sql("DELETE FROM session_sums").await;
    let server = server.restart().await;
    assert_ne!(figures(&owner.open(&server, path).await.text()), before);
}

/// Of an adaptive block the page shows the thresholds so far, one a person; of a staircase where it stands.
pub async fn thresholds_so_far_are_shown(server: &TestServer) {
    let mut owner = owner(server).await;
    for (rule, words) in [(None, "threshold so far"), (Some(0.1), "level of the staircases now")] {
        let mut file = study::of("jnd-alpha");
        if let Some(step) = rule {
            file["id"] = "steps".into();
            let block = &mut file["components"]["limit"];
            block["rule"] = json!({ "staircase": { "down": 2, "steps": [step] } });
        }
        let id = file["id"].as_str().unwrap().to_owned();
        let adaptive = Study::from_value(&file).unwrap();
        let mut parameters = Parameters::for_study(&adaptive);
        (parameters.dropout.declined, parameters.dropout.per_trial) = (0.0, 0.0);
        let hash = mimique_study::config_hash(&file);
        let simulation = Simulation::new(&adaptive, &hash, &parameters, 1).unwrap();
        let server = server.restart_with(vec![study::host(file)]).await;
        for number in 1..=3 {
            let session = simulation.session(number).unwrap();
            let started = server.start_in(&id, 70 + number).await;
            for part in session.events.chunks(50) {
                server.stored(&started.session, part).await;
            }
        }
        let page = owner.open(&server, &format!("/researcher/studies/{id}")).await.text();
        let (_, found) = page.split_once(words).unwrap_or_else(|| panic!("{page}"));
        assert!(found.starts_with(" (3 people), 0."), "{}", &found[..60]);
    }
}

/// Both clips of a pair are shown, and both count in the balance; the page first says how many are done.
pub async fn both_clips_of_a_pair_are_in_the_balance(server: &TestServer) {
    let mut owner = owner(server).await;
    let mut file = study::of("pairs");
    file["recruitment"]["participants"] = 40.into();
    let pairs = Study::from_value(&file).unwrap();
    let mut parameters = Parameters::for_study(&pairs);
    (parameters.dropout.declined, parameters.dropout.per_trial) = (0.0, 0.0);
    let hash = mimique_study::config_hash(&file);
    let simulation = Simulation::new(&pairs, &hash, &parameters, 1).unwrap();
    let server = server.restart_with(vec![study::host(file)]).await;
    for number in 1..=2 {
        let session = simulation.session(number).unwrap();
        let started = server.start_in("pairs", 70 + number).await;
        for part in session.events.chunks(50) {
            server.stored(&started.session, part).await;
        }
        server.receipt(&started.session, session.events.len() as u64).await;
    }
    let page = owner.open(&server, "/researcher/studies/pairs").await.text();
    assert!(page.contains("<strong>2 of 40 people have completed the study</strong>"), "{page}");
    let (_, balance) = page.split_once("Condition balance").unwrap();
    let (_, method) = balance.split_once("<code>method</code>").unwrap();
    let (method, _) = method.split_once("</table>").unwrap();
    let count = |row: &str| -> Option<u64> {
        row.split_once("class=\"number\">")?.1.split_once('<')?.0.parse().ok()
    };
    let levels: Vec<u64> = method.split("<tr>").filter_map(count).collect();
    let (_, times) = page.split_once("Time per trial").unwrap();
    // The first row is of all trials, their number in its last cell.
    let (all, _) = times.split_once("<tbody>").unwrap().1.split_once("</tr>").unwrap();
    let trials: u64 =
        all.rsplit_once("class=\"number\">").unwrap().1.trim_end_matches("</td>").parse().unwrap();
    assert!(levels.len() > 1 && trials > 0, "{method}");
    assert_eq!(levels.iter().sum::<u64>(), 2 * trials, "{method} {trials}");
}

/// Neither sums that were kept nor those that are on their way outlive the answers.
pub async fn a_deleted_session_leaves_no_sums(server: &TestServer) {
    demo_participant(server, 1, usize::MAX).await;
    demo_participant(server, 2, usize::MAX).await;
    let mut owner = owner(server).await;
    let path = "/researcher/studies/demo";
    owner.open(server, path).await;
    let sessions = server.storage.sessions("demo").await.unwrap();
    let keys = [sessions[0].key, sessions[1].key];
    let kept = server.storage.kept_sums_of(&keys, SUMS_FORM).await.unwrap();
    assert_eq!(kept.len(), 2);
    let erased = server.storage.erase_participant("demo", 1, "somebody", 1).await.unwrap();
    assert!(erased > 0);
    let left = async || -> Vec<i64> {
        let kept = server.storage.kept_sums_of(&keys, SUMS_FORM).await.unwrap();
        kept.iter().map(|kept| kept.session_key).collect()
    };
    assert_eq!(left().await, keys[1..]);
    // Whoever was counting meanwhile keeps nothing of it.
    server.storage.keep_sums(SUMS_FORM, &kept).await.unwrap();
    assert_eq!(left().await, keys[1..]);
    // Nor of a session that has changed meanwhile.
    let old = mimique_storage::CountedSo { event_count: 3, receipt_events: None };
    let old = mimique_storage::KeptSums { counted: old, sums: "old".into(), ..kept[1].clone() };
    server.storage.keep_sums(SUMS_FORM, &[old]).await.unwrap();
    assert_eq!(server.storage.kept_sums_of(&keys, SUMS_FORM).await.unwrap(), kept[1..]);
    let page = owner.open(server, path).await.text();
    assert!(page.contains("<dt>withdrawn</dt><dd>1</dd>"), "{page}");
}
