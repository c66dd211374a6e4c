//! Ten thousand sessions through the page's own state machine and outbox, over a network that drops,
//! delays, doubles and reorders, with reloads, killed tabs and closed lids: nothing is lost and
//! nothing is doubled.
//!
//! `MIMIQUE_SESSIONS` sets another number. What stands in for the browser and the server here follows
//! `engine.rs` (an event is sent only once it is kept; one request at a time; what failed, or was not
//! answered within `patience`, is sent again after `back_off`) and the server's append (first write
//! wins, by session and sequence; the answer follows the commit).

use std::collections::{BTreeMap, VecDeque};

use mimique_app::outbox::{Outbox, back_off, patience};
use mimique_session::flow::{
    Effect, Input, Phase, Plan, QuestionKindView, State, View, update, view,
};
use mimique_session::wire::{Acknowledged, Event, Receipt, SessionStarted};
use mimique_session::{Client, PlayLog};
use mimique_study::{Display, Study};
use serde_json::{Value, json};

/// SplitMix64 (Steele, Lea & Flood 2014): the same run for the same session.
struct Chance(u64);

impl Chance {
    fn below(&mut self, n: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (mixed ^ (mixed >> 31)) % n
    }

    fn one_in(&mut self, n: u64) -> bool {
        self.below(n) == 0
    }
}

/// The server's side of one session.
#[derive(Default)]
struct Server {
    stored: BTreeMap<u64, Event>,
    /// Events written: once each.
    writes: u64,
    /// Other events under a sequence that is stored.
    conflicts: u64,
    receipt: Option<u64>,
}

impl Server {
    fn append(&mut self, events: &[Event]) -> Acknowledged {
        for event in events {
            match self.stored.get(&event.sequence) {
                None => {
                    self.stored.insert(event.sequence, event.clone());
                    self.writes += 1;
                }
                Some(known) => self.conflicts += u64::from(known != event),
            }
        }
        let stored = (0..).take_while(|n| self.stored.contains_key(n)).count() as u64;
        let highest = self.stored.keys().next_back().copied().unwrap_or(0);
        let gaps = (stored..highest).filter(|n| !self.stored.contains_key(n)).collect();
        Acknowledged { stored, gaps }
    }

    /// Refuses (`None`) while an event is missing.
    fn complete(&mut self, events: u64) -> Option<Receipt> {
        if (0..events).any(|sequence| !self.stored.contains_key(&sequence)) {
            return None;
        }
        self.receipt = Some(events);
        Some(Receipt {
            receipt: "feed".to_owned(),
            stored: events,
            completion_code: None,
            redirect: None,
        })
    }
}

/// What is asked of the server.
#[derive(Clone)]
enum Request {
    Append(Vec<Event>),
    Complete(u64),
}

/// What is heard of a request.
#[derive(Clone)]
enum Answer {
    Acknowledged(Vec<Event>, Acknowledged),
    Receipt(Receipt),
    /// The connection broke, or the server refuses for now.
    Failed,
}

/// What lies on the way, with the number of its request.
#[derive(Clone)]
enum Packet {
    Request(u64, Request),
    Answer(u64, Answer),
}

/// One browser, one server and the network between them.
struct World<'p> {
    plan: &'p Plan,
    chance: Chance,
    now_ms: f64,
    server: Server,
    /// On its way: due time and packet. Requests outlive the tab that sent them.
    network: Vec<(f64, Packet)>,
    /// IndexedDB: outlives the tab.
    kept: BTreeMap<u64, Event>,
    // The tab.
    state: State,
    outbox: Outbox,
    to_keep: VecDeque<Event>,
    /// The request that is out: its number, and when it is given up.
    out: Option<(u64, f64)>,
    /// Requests so far, of every tab.
    requests: u64,
    /// Requests in a row that failed, and those of them that nobody answered.
    failures: u32,
    unanswered: u32,
    /// Requests that were given up.
    given_up: u32,
    /// When the next request may leave.
    rest_until: f64,
    completing: Option<u64>,
    reloads: u32,
}

/// Every network is well after this many steps, so that a session ends.
const STORM: u32 = 1_500;

impl<'p> World<'p> {
    fn new(plan: &'p Plan, seed: u64) -> Self {
        let mut world = Self {
            plan,
            chance: Chance(seed),
            now_ms: 1_790_000_000_000.0,
            server: Server::default(),
            network: Vec::new(),
            kept: BTreeMap::new(),
            state: State::new(plan, "en"),
            outbox: Outbox::new(0),
            to_keep: VecDeque::new(),
            out: None,
            requests: 0,
            failures: 0,
            unanswered: 0,
            given_up: 0,
            rest_until: 0.0,
            completing: None,
            reloads: 0,
        };
        world.input(Input::Opened(Client::default()));
        world
    }

    fn input(&mut self, input: Input) {
        let mut inputs = VecDeque::from([input]);
        while let Some(input) = inputs.pop_front() {
            let state = std::mem::take(&mut self.state);
            let (state, effects) = update(self.plan, state, input, self.now_ms);
            self.state = state;
            for effect in effects {
                match effect {
                    Effect::Store(event) => self.to_keep.push_back(event),
                    Effect::PrepareClips(clips) => {
                        inputs.extend(clips.into_iter().map(|clip| Input::ClipPrepared { clip }))
                    }
                    Effect::PlayClips { .. } => {
                        let onset_ms = self.now_ms;
                        inputs.push_back(Input::Played(PlayLog { onset_ms, ..PlayLog::default() }));
                    }
                    Effect::MeasureDevice => inputs.push_back(Input::Measured(display())),
                    Effect::Complete { events } => self.completing = Some(events),
                    Effect::Flush => self.rest_until = 0.0,
                    _ => {}
                }
            }
        }
    }

    /// The tab is gone, with everything that it had not kept; another one opens.
    fn reopen(&mut self) {
        self.reloads += 1;
        self.to_keep.clear();
        (self.out, self.completing) = (None, None);
        (self.failures, self.unanswered, self.rest_until) = (0, 0, 0.0);
        // `GET session`, and what IndexedDB kept: as `start.rs` joins them.
        let mut all: BTreeMap<u64, Event> = self.kept.clone();
        all.extend(self.server.stored.iter().map(|(n, event)| (*n, event.clone())));
        let stored = (0..).take_while(|n| self.server.stored.contains_key(n)).count() as u64;
        self.outbox = Outbox::new(stored);
        self.kept.retain(|number, _| *number >= stored);
        self.kept.values().cloned().for_each(|event| self.outbox.push(event));
        let events: Vec<Event> = all.into_values().collect();
        if events.is_empty() {
            self.state = State::new(self.plan, "en");
            self.input(Input::Opened(Client::default()));
        } else {
            self.state = State::replay(self.plan, &events);
            self.input(Input::Resumed(Client::default()));
        }
    }

    /// A request or an answer leaves: it may be lost (heard at once, or never), late, doubled.
    fn send(&mut self, packet: &Packet, storm: bool) {
        let (Packet::Request(number, _) | Packet::Answer(number, _)) = packet;
        let copies = match self.chance.below(10) {
            _ if !storm => 1,
            0 => {
                let broken = Packet::Answer(*number, Answer::Failed);
                self.network.push((self.now_ms + 30.0, broken));
                0
            }
            1 => 0,
            2 => 2,
            _ => 1,
        };
        for _ in 0..copies {
            let delay = match self.chance.below(20) {
                _ if !storm => 40,
                // Longer than anybody waits.
                0 => 20_000 + self.chance.below(40_000),
                _ => self.chance.below(6_000),
            };
            self.network.push((self.now_ms + delay as f64, packet.clone()));
        }
    }

    /// Everything that is due arrives, in any order.
    fn deliver(&mut self, storm: bool) {
        while let Some(at) = self.network.iter().position(|(due, _)| *due <= self.now_ms) {
            let (_, packet) = self.network.swap_remove(at);
            match packet {
                Packet::Request(number, Request::Append(events)) => {
                    let answer = self.server.append(&events);
                    let answer = Answer::Acknowledged(events, answer);
                    self.send(&Packet::Answer(number, answer), storm);
                }
                Packet::Request(number, Request::Complete(events)) => {
                    let receipt = self.server.complete(events);
                    let answer = receipt.map_or(Answer::Failed, Answer::Receipt);
                    self.send(&Packet::Answer(number, answer), storm);
                }
                // An answer that comes after its request was given up, or to a tab that is gone, is
                // heard by nobody.
                Packet::Answer(number, answer) => {
                    if self.out.is_some_and(|(out, _)| out == number) {
                        self.out = None;
                        self.hear(answer);
                    }
                }
            }
        }
    }

    fn hear(&mut self, answer: Answer) {
        if !matches!(answer, Answer::Failed) {
            (self.failures, self.unanswered) = (0, 0);
        }
        match answer {
            Answer::Acknowledged(sent, answer) => {
                let gone = self.outbox.acknowledge(&sent, &answer);
                gone.iter().for_each(|number| drop(self.kept.remove(number)));
                let stored = self.outbox.stored();
                self.input(Input::Acknowledged { stored });
                if gone.is_empty() {
                    self.rest_until = self.now_ms + 1_000.0;
                }
            }
            Answer::Receipt(receipt) => {
                self.completing = None;
                self.input(Input::ReceiptArrived(receipt));
            }
            Answer::Failed => self.fail(),
        }
    }

    /// A request failed: the next one leaves after a rest.
    fn fail(&mut self) {
        self.failures += 1;
        let jitter = self.chance.below(1_000) as f64 / 1_000.0;
        let rest = back_off(self.failures, jitter).as_millis() as f64;
        self.rest_until = self.now_ms + rest;
    }

    /// The tab's machinery: writer, sender, completion.
    fn work(&mut self, storm: bool) {
        // Writing takes its time: an event is sent only after it is kept.
        if let Some(event) = self.to_keep.pop_front() {
            self.kept.insert(event.sequence, event.clone());
            self.outbox.push(event);
        }
        if self.out.is_some_and(|(_, until)| until <= self.now_ms) {
            self.out = None;
            self.given_up += 1;
            self.unanswered += 1;
            self.fail();
        }
        if self.out.is_some() || self.now_ms < self.rest_until {
            return;
        }
        let batch = self.outbox.batch();
        let request = match (batch.is_empty(), self.completing) {
            (false, _) => Request::Append(batch),
            (true, Some(events)) => Request::Complete(events),
            (true, None) => return,
        };
        self.requests += 1;
        let until = self.now_ms + patience(self.unanswered).as_millis() as f64;
        self.out = Some((self.requests, until));
        self.send(&Packet::Request(self.requests, request), storm);
    }

    /// The participant does the next thing that the page asks for.
    fn act(&mut self) {
        let next = match view(self.plan, &self.state) {
            View::Consent { .. } => Input::Consent,
            View::Questions { questions, .. } => match open(&questions) {
                Some((id, kind)) => {
                    let value = self.choose(&kind);
                    Input::Answer { question: id, value }
                }
                None => Input::Next,
            },
            View::Trial(trial) => match trial.phase {
                Phase::Ready => Input::Play,
                Phase::Answering => match open(&trial.questions) {
                    Some((id, kind)) => {
                        let value = self.choose(&kind);
                        Input::Answer { question: id, value }
                    }
                    None => Input::Next,
                },
                _ => Input::Tick,
            },
            View::Page { .. } => Input::Next,
            _ => Input::Tick,
        };
        self.input(next);
    }

    fn choose(&mut self, kind: &QuestionKindView) -> Value {
        match kind {
            QuestionKindView::Likert { points, .. } => {
                json!(points[self.chance.below(points.len() as u64) as usize].0)
            }
            _ => json!(18 + self.chance.below(60)),
        }
    }

    /// The whole session.
    fn run(&mut self) {
        for turn in 0_u32.. {
            let storm = turn < STORM;
            self.now_ms += 20.0 + self.chance.below(400) as f64;
            self.deliver(storm);
            self.work(storm);
            if matches!(view(self.plan, &self.state), View::End(_)) {
                return;
            }
            match self.chance.below(60) {
                0 if storm => self.reopen(),
                // A closed lid: hours without a step; what was out is given up or long there.
                1 if storm && self.chance.one_in(10) => self.now_ms += 3.0 * 3_600_000.0,
                2 if storm => self.input(Input::FocusLost),
                3 if storm => self.input(Input::FocusGained),
                // The back button: the address stays, the page is loaded anew.
                4 if storm && self.chance.one_in(5) => self.reopen(),
                _ if self.chance.below(3) > 0 => self.act(),
                _ => self.input(Input::Tick),
            }
            assert!(turn < 20_000, "no end: {:?}", view(self.plan, &self.state));
        }
    }
}

/// The first question without an answer.
fn open(questions: &[mimique_session::flow::QuestionView]) -> Option<(String, QuestionKindView)> {
    let question = questions.iter().find(|question| question.value.is_none())?;
    Some((question.id.clone(), question.kind.clone()))
}

fn plan() -> Plan {
    let study = Study::from_text(
        "{ id: 's', studyMetadata: { title: 'Faces', version: '1' }, languages: ['en'], seed: 5,
           consent: { version: '1', sections: [] },
           demographics: { questions: [{ id: 'age', type: 'number', prompt: 'Age?', minimum: 18 }] },
           questions: [{ id: 'r', type: 'likert', prompt: 'How?', leftLabel: 'l', rightLabel: 'r', numItems: 7 }],
           components: { faces: { type: 'trials', questions: ['r'] } },
           sequence: { order: 'random', components: ['faces'] },
           stimuli: { avatars: { h: { builtin: {} } }, captures: { c: { file: 'x' } },
             segments: [{ id: 'p', capture: 'c', first: 0, end: 9 }, { id: 'q', capture: 'c', first: 0, end: 9 }],
             methods: { box: { method: 'box' } } } }",
    )
    .expect("a study");
    let started = SessionStarted {
        session: "s".to_owned(),
        participant_id: "p1".to_owned(),
        participant: 1,
        slot: 1,
        condition: None,
        seed: 5,
        stage: "live".to_owned(),
        config_hash: "h".to_owned(),
        withdrawal_code: "w".to_owned(),
    };
    Plan::new(study.projection(), started).expect("a plan")
}

#[test]
fn ten_thousand_sessions_lose_nothing_and_double_nothing() {
    let sessions: u64 = std::env::var("MIMIQUE_SESSIONS")
        .map_or(10_000, |text| text.parse().expect("MIMIQUE_SESSIONS is a number"));
    let plan = plan();
    let (mut events, mut reloads, mut given_up) = (0, 0, 0);
    for session in 0..sessions {
        let mut world = World::new(&plan, session);
        world.run();
        let server = &world.server;
        let made = world.state.record.events;
        // Nothing lost: the server has every event of the session that the participant ended with.
        assert_eq!(server.stored.len() as u64, made, "session {session}");
        let stored: Vec<Event> = server.stored.values().cloned().collect();
        assert_eq!(State::replay(&plan, &stored).record, world.state.record, "session {session}");
        // Nothing doubled, and nothing written over.
        assert_eq!((server.writes, server.conflicts), (made, 0), "session {session}");
        // Every answer once: two trials, one page.
        let of = |kind: &str| stored.iter().filter(|event| event.body["type"] == kind).count();
        assert_eq!((of("trial_finished"), of("page_finished")), (2, 1), "session {session}");
        // The code stands on the page only after the receipt for everything.
        assert_eq!(server.receipt, Some(made), "session {session}");
        assert!(world.outbox.batch().is_empty() && world.kept.is_empty(), "session {session}");
        events += made;
        reloads += world.reloads;
        given_up += world.given_up;
    }
    eprintln!(
        "{sessions} sessions, {events} events, {reloads} reloads, {given_up} requests given up: \
         0 lost, 0 doubled"
    );
    assert!(sessions < 100 || reloads > sessions as u32 / 10, "{reloads} reloads");
    assert!(sessions < 100 || given_up > sessions as u32 / 10, "{given_up} requests given up");
}

/// A display that draws clips.
fn display() -> Display {
    Display { backend: Some("webgl2".to_owned()), ..Display::default() }
}
