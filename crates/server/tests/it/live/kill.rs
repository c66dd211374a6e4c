//! The server is killed at random moments while people answer.
//!
//! A few dozen kills each run; `MIMIQUE_KILLS=1000` is the long run.

use std::time::Duration;

use crate::client::block_on;
use crate::live::child::Server;
use crate::live::people::{Person, acknowledged, compare};
use crate::postgres::Cluster;

const PEOPLE: u64 = 4;

#[test]
fn nothing_acknowledged_is_lost_on_sqlite() {
    let folder = tempfile::tempdir().unwrap();
    let url = format!("sqlite:{}", folder.path().join("answers.sqlite").display());
    kill_again_and_again(&url);
}

#[test]
fn nothing_acknowledged_is_lost_on_postgres() {
    let Some(cluster) = Cluster::start("nothing_acknowledged_is_lost_on_postgres") else { return };
    let url = block_on(cluster.fresh_database("kills"));
    kill_again_and_again(&url);
}

fn kill_again_and_again(url: &str) {
    let kills: u64 = std::env::var("MIMIQUE_KILLS").map_or(24, |text| text.parse().unwrap());
    let mut people = Person::several(PEOPLE);
    for kill in 0..kills {
        let server = Server::start(url);
        let port = server.port;
        // 5 to 120 ms, spread by a linear congruential generator (Knuth's constants).
        let random = (kill + 1).wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695);
        let lifetime = Duration::from_millis(5 + (random >> 33) % 116);
        std::thread::scope(|scope| {
            for person in &mut people {
                scope.spawn(move || while person.answer(port).is_some() {});
            }
            std::thread::sleep(lifetime);
            server.kill();
        });
    }
    let acknowledged = acknowledged(&people);
    assert!(acknowledged > kills, "the server did something between the kills");
    // Ends where one is lost or doubled.
    let stored = block_on(compare(url, &people));
    eprintln!(
        "{kills} kills: {acknowledged} events acknowledged, {stored} stored, 0 lost, 0 doubled"
    );
}
