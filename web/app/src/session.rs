//! How pages reach the engine: a handle that copies.

use std::rc::Rc;

use leptos::prelude::*;
use mimique_study::flow::{Input, View, view};
use mimique_study::text::Words;

use crate::engine::{Connection, Engine};

/// The running session, for pages and controls.
#[derive(Clone, Copy)]
pub struct Session {
    engine: StoredValue<Rc<Engine>, LocalStorage>,
    /// What stands on the screen; changes only when something on the screen does.
    pub view: Memo<View>,
    /// The header's message.
    pub connection: RwSignal<Connection>,
}

impl Session {
    /// A handle on an engine.
    pub fn new(engine: Rc<Engine>) -> Self {
        let state = engine.state;
        let connection = engine.connection;
        let plan = StoredValue::new(engine.plan.clone());
        let view =
            Memo::new(move |_| plan.with_value(|plan| state.with(|state| view(plan, state))));
        Self { engine: StoredValue::new_local(engine), view, connection }
    }

    /// The session of the page.
    pub fn here() -> Self {
        expect_context()
    }

    /// Hands an input to the engine.
    pub fn send(self, input: Input) {
        self.engine().dispatch(input);
    }

    /// The engine.
    pub fn engine(self) -> Rc<Engine> {
        self.engine.get_value()
    }

    /// The fixed texts in the language of the moment (tracked).
    pub fn words(self) -> &'static Words {
        let engine = self.engine();
        engine.state.with(|state| engine.plan.words(&state.record.language))
    }

    /// The language of the moment (tracked).
    pub fn language(self) -> String {
        self.engine().state.with(|state| state.record.language.clone())
    }
}
