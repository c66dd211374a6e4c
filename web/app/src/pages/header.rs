//! Title, state of the connection, and the way out.

use mimique_session::flow::{Input, View};

use super::button;
use crate::browser::document;
use crate::dom::{Element, el, words};
use crate::engine::Engine;

/// The header of every page, its notices, and the question whether somebody really means to go.
pub fn header(engine: &Engine, view: &View) -> Vec<Element> {
    let fixed = engine.words();
    let title = &engine.plan.study.title;
    let mut header = el("header", "site-header narrow").with(words(
        "span",
        "title",
        title.in_language(&engine.language()),
    ));
    // Before the agreement there is nothing to withdraw, and at the end the code serves.
    let can_withdraw = matches!(
        view,
        View::Questions { .. }
            | View::Page { .. }
            | View::Device(_)
            | View::Calibration(_)
            | View::Scripted(_)
            | View::Feedback(_)
            | View::Trial(_)
            | View::ReceiptPending { .. }
    );
    if can_withdraw {
        let open = button("quiet", "withdraw", fixed.withdraw());
        header = header.with(open.handles("click", |_| {
            document::dialog(true);
            None
        }));
    }
    let timed_out = engine.state().live.timed_out;
    let connection = engine.connection();
    let notice = |there: bool, class: &str, key: &str, text: &str| {
        there.then(|| words("p", class, text).key(key))
    };
    let refused = connection
        .refused
        .as_ref()
        .map(|refusal| fixed.refused(&refusal.code, &refusal.message, &refusal.remedy));
    let notices = el("div", "site-notices")
        .key("notices")
        .set("role", "status")
        .option(notice(timed_out, "notice", "time", fixed.time_over()))
        .option(notice(connection.offline, "notice warn", "offline", fixed.offline()))
        .option(notice(connection.fleeting, "notice warn", "fleeting", fixed.not_kept()))
        .option(refused.map(|text| words("p", "notice bad", &text).key("refused")));
    let no =
        words("button", "", fixed.withdraw_no()).set("type", "button").handles("click", |_| {
            document::dialog(false);
            None
        });
    let yes = button("danger", "withdraw-confirm", fixed.withdraw_yes()).on("click", |_| {
        document::dialog(false);
        Input::Withdraw
    });
    let dialog = el("dialog", "card")
        .set("aria-labelledby", "withdraw-question")
        .with(words("p", "", fixed.withdraw_question()).set("id", "withdraw-question"))
        .with(el("div", "actions").with(no).with(yes));
    vec![header, notices, dialog]
}
