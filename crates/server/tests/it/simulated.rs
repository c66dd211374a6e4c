//! What `mimique simulate` writes is what the server would: simulated sessions are sent to a server as
//! pages send theirs, and its export is the same bytes in every form.

use std::collections::BTreeMap;

use mimique_analysis::{Dropout, Parameters, Simulation};
use mimique_server::export::{Format, Options, Unstored, export};
use mimique_study::Study;

use crate::client::TestServer;
use crate::study;

pub async fn a_simulated_export_is_the_servers(server: &TestServer) {
    let file = study::demo_file();
    let demo = Study::from_value(&file).unwrap();
    let mut parameters = Parameters::for_study(&demo);
    // Somebody declines, somebody leaves, somebody withdraws, pages are reloaded, plays cut short.
    parameters.dropout = Dropout { declined: 0.15, per_trial: 0.04, withdrawn: 0.4 };
    parameters.display.cut_short = 0.1;
    parameters.display.reload = 0.1;
    parameters.display.replay = 0.3;
    let hash = mimique_study::config_hash(&file);
    let simulation = Simulation::new(&demo, &hash, &parameters, 1).unwrap();
    let people = 16;
    let sessions: Vec<_> = (1..=people).map(|n| simulation.session(n).unwrap()).collect();
    // All begin before anybody leaves: who begins later would get a drop-out's slot.
    let mut begun = Vec::new();
    for session in &sessions {
        let started = server.start_in("demo", session.started.participant).await;
        assert_eq!(started.participant_id, session.started.participant_id);
        assert_eq!(started.participant, session.started.participant);
        assert_eq!(started.config_hash, session.started.config_hash);
        assert_eq!(started.seed, session.started.seed);
        assert_eq!(started.stage, session.started.stage);
        begun.push(started);
    }
    for (session, started) in sessions.iter().zip(&begun) {
        if session.events.is_empty() {
            server.withdrawn(&started.session, &started.withdrawal_code).await;
            continue;
        }
        for part in session.events.chunks(50) {
            server.stored(&started.session, part).await;
        }
    }
    let status = |word: &str| {
        let of = |s: &&mimique_analysis::SimulatedSession| {
            mimique_session::Record::of(None, &s.events).standing.export_word() == word
        };
        sessions.iter().filter(of).count()
    };
    assert!(status("declined") > 0 && status("completed") > 0, "the seed shows every fate");
    assert!(sessions.iter().any(|session| session.events.is_empty()), "somebody withdraws");
    for format in Format::ALL {
        let stored =
            export(&server.storage, Some("demo"), format, Options::default()).await.unwrap();
        let writer = Unstored::new(file.clone(), BTreeMap::new(), format).unwrap();
        assert_eq!(writer.config_hash(), hash);
        let written: Vec<_> =
            sessions.iter().map(|s| writer.write(&s.started, &s.events).unwrap()).collect();
        let simulated = writer.join(written).unwrap();
        assert_eq!(simulated.participants, stored.participants, "{}", format.word());
        assert_eq!(simulated.rows, stored.rows, "{}", format.word());
        for ((name, bytes), (stored_name, stored_bytes)) in
            simulated.files.iter().zip(&stored.files)
        {
            assert_eq!(name, stored_name);
            let (text, stored) =
                (String::from_utf8_lossy(bytes), String::from_utf8_lossy(stored_bytes));
            let differs = text.lines().zip(stored.lines()).find(|(left, right)| left != right);
            assert_eq!(differs, None, "{}: {name}", format.word());
            assert_eq!(bytes.len(), stored_bytes.len(), "{}: {name}", format.word());
        }
        assert_eq!(simulated.files.len(), stored.files.len());
    }
}
