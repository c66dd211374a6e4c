//! Active schedules of pairs: a page is told what all others have answered, of such blocks alone.

use axum::http::StatusCode;
use mimique_analysis::{Parameters, Simulation};
use mimique_server::{HostedStudy, Stage};
use mimique_study::{PairCount, Study};
use serde_json::{Value, json};

use crate::client::TestServer;
use crate::study;

/// The study of pairs, dealt as this schedule says.
fn file(schedule: &Value) -> Value {
    let mut file = study::of("pairs");
    let blocks = file["components"].as_object_mut().unwrap().values_mut();
    for block in blocks.filter(|block| block["type"] == "pairs") {
        block["schedule"] = schedule.clone();
    }
    file
}

pub async fn pages_are_told_what_others_answered(server: &TestServer) {
    for (rule, is_told) in [("active", true), ("incomplete", false)] {
        let file = file(&json!({ "rule": rule, "perParticipant": 12 }));
        let pairs = Study::from_value(&file).unwrap();
        let (component, block) = pairs.pair_blocks().next().unwrap();
        let levels = block.compared(&pairs.clips());
        let mut parameters = Parameters::for_study(&pairs);
        (parameters.dropout.declined, parameters.dropout.per_trial) = (0.0, 0.0);
        let hash = mimique_study::config_hash(&file);
        let simulation = Simulation::new(&pairs, &hash, &parameters, 1).unwrap();
        // A pilot's answers are not among those of the study itself.
        let pilot = HostedStudy::new(file.clone(), Default::default(), Stage::Pilot).unwrap();
        let server = server.restart_with(vec![pilot]).await;
        let started = server.start_in("pairs", 1000 * u64::from(is_told) + 99).await;
        assert_eq!(started.stage, "pilot");
        for part in simulation.session(99).unwrap().events.chunks(50) {
            server.stored(&started.session, part).await;
        }
        let server = server.restart_with(vec![study::host(file)]).await;
        let mut tokens = Vec::new();
        let mut choices = 0;
        for number in 1..=4 {
            let session = simulation.session(number).unwrap();
            let started = server.start_in("pairs", 1000 * u64::from(is_told) + number).await;
            for part in session.events.chunks(50) {
                server.stored(&started.session, part).await;
            }
            let answers = session.events.iter().filter(|event| {
                event.body["type"] == "trial_finished"
                    && event.body["step"].as_str().unwrap().starts_with(component)
            });
            choices += answers.count() as u64;
            tokens.push(started.session);
        }
        for token in &tokens {
            let path = format!("/api/sessions/{token}/pairs/{component}");
            let counts: Vec<PairCount> = server.get(&path).await.ok();
            if !is_told {
                assert!(counts.is_empty(), "how others choose is nobody's concern: {counts:?}");
                continue;
            }
            // All others' answers, and none of one's own.
            let all: u64 = counts.iter().flat_map(|count| count.answers).sum();
            assert_eq!(all, choices * 3 / 4);
            assert!(counts.windows(2).all(|pair| pair[0].items < pair[1].items), "{counts:?}");
            for PairCount { items, .. } in &counts {
                assert!(items[0] < items[1] && items.iter().all(|item| levels.contains(item)));
            }
        }
        let other = format!("/api/sessions/{}/pairs/none", tokens[0]);
        assert_eq!(server.get(&other).await.ok::<Vec<PairCount>>(), []);
        let unknown = format!("/api/sessions/{}/pairs/{component}", "0".repeat(32));
        server.get(&unknown).await.refused(StatusCode::NOT_FOUND, "unknown-session");
    }
}
