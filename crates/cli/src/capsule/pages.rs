//! The two pages of a capsule: the reader, and the study's page that keeps nothing.

use maud::{DOCTYPE, Markup, html};
use mimique_locale::{Language, counted};
use mimique_server::{first_page, replay_player, replay_words};
use mimique_study::{Multilingual as _, Study, TestName};
use serde::Deserialize as _;
use serde::de::IntoDeserializer as _;
use serde::de::value::{Error, StrDeserializer};

use super::words::script_words;

/// What a reader needs to know before anything else.
pub struct About<'a> {
    /// The study.
    pub study: &'a Study,
    /// SHA-256 of the study file.
    pub config_hash: &'a str,
    /// People, trials, and trials that can be drawn again.
    pub people: usize,
    /// Trials.
    pub trials: (usize, usize),
    /// What stayed out, as sentences.
    pub left_out: &'a [String],
    /// `FORMATS.md`.
    pub formats: &'a str,
}

/// No request leaves the page: scripts and styles lie beside it, everything else is in memory.
const POLICY: &str = "default-src 'none'; script-src 'self' file: blob: 'wasm-unsafe-eval'; \
    style-src 'self' file: 'unsafe-inline'; img-src 'self' file: data: blob:; media-src blob:; connect-src blob: data:; \
    worker-src blob:; frame-src 'self' file:; form-action 'none'; base-uri 'none'";

/// The head of a page: its styles, and the loader, which begins with a module.
fn head(assets: &str, title: &str, styles: &[&str], before: &[&str], module: &str) -> Markup {
    html! {
        meta charset="utf-8";
        meta http-equiv="Content-Security-Policy" content=(POLICY);
        meta name="viewport" content="width=device-width, initial-scale=1";
        meta name="color-scheme" content="light dark";
        meta name="referrer" content="no-referrer";
        meta name="mimique-packs" content="https://capsule.invalid/packs";
        title { (title) }
        link rel="icon" href={ (assets) "/style/icon.svg" } type="image/svg+xml";
        @for style in styles { link rel="stylesheet" href={ (assets) "/" (style) }; }
        @for script in before { script src={ (assets) "/" (script) } {} }
        script defer src={ (assets) "/capsule/loader.js" } data-module={ (assets) "/" (module) } {}
    }
}

/// `index.html`.
pub fn reader(assets: &str, about: &About<'_>, language: Language) -> String {
    let code = language.code();
    let say = |english: &'static str, french: &'static str| language.pick(english, french);
    let title = about.study.study_metadata.title.in_language(code);
    let styles = [
        "style/style.css",
        "researcher/preview.css",
        "researcher/replay.css",
        "capsule/capsule.css",
    ];
    let page = html! {
        (DOCTYPE)
        html lang=(code) {
            head {
                meta name="mimique-site" content="https://capsule.invalid/site.json" data-study=(about.study.id);
                (head(assets, title, &styles, &[], "capsule/reader.js"))
            }
            body {
                main.page.wide #capsule data-words=(script_words(language)) data-replay=(replay_words(language)) {
                    h1 { (title) }
                    (overview(about, language))
                    section.card {
                        h2 { (say("Report", "Rapport")) }
                        p.soft {
                            span #which-report role="status" { (say("The report as it was published.", "Le rapport tel qu’il a été publié.")) }
                            " "
                            (say(
                                "A point of a figure that stands for one clip leads to the trials of that clip.",
                                "Un point d’une figure qui représente un clip mène aux essais de ce clip.",
                            ))
                        }
                        iframe #report src="report/report.html" title=(say("Report", "Rapport")) {}
                    }
                    section.card #change {
                        h2 { (say("Under other rules", "Avec d’autres règles")) }
                        p {
                            (say(
                                "Change a rule of exclusion or a test: the statistics are computed anew in this browser, by the functions that made the report.",
                                "Changez une règle d’exclusion ou un test : les statistiques sont recalculées dans ce navigateur, par les fonctions qui ont fait le rapport.",
                            ))
                        }
                        (changes(about.study, language))
                        p #computing role="status" {}
                        div #compared {}
                    }
                    (trials(language))
                    section.card #formats {
                        h2 { (say("Formats", "Formats")) }
                        p { a href="FORMATS.md" { "FORMATS.md" } (say(" says how each file is read without this program:", " dit comment lire chaque fichier sans ce programme :")) }
                        pre tabindex="0" role="region" aria-label="FORMATS.md" lang="en" { (about.formats) }
                    }
                }
            }
        }
    };
    page.into_string() + "\n"
}

/// What this is, what it is made of, what is not in it.
fn overview(about: &About<'_>, language: Language) -> Markup {
    let say = |english: &'static str, french: &'static str| language.pick(english, french);
    let (all, drawn) = about.trials;
    html! {
        div.card {
            p {
                (say(
                    "This is a study in one folder: its report, its answers, its stimuli, and the program that drew and computed them. It needs a browser and no network.",
                    "Voici une étude dans un seul dossier : son rapport, ses réponses, ses stimuli et le programme qui les a dessinés et calculés. Il faut un navigateur, et pas de réseau.",
                ))
            }
            dl.facts {
                div { dt { (say("Study", "Étude")) } dd { (about.study.id) } }
                div { dt { (say("Version", "Version")) } dd { code { (about.config_hash.get(..12).unwrap_or_default()) } } }
                div { dt { (say("People", "Personnes")) } dd { (about.people) } }
                div { dt { (say("Trials", "Essais")) } dd { (all) " (" (drawn) " " (say("can be drawn again", "peuvent être redessinés")) ")" } }
            }
            @for sentence in about.left_out { p.soft { (sentence) } }
            nav.capsule-nav aria-label=(say("On this page", "Sur cette page")) {
                a href="#report" { (say("Report", "Rapport")) }
                a href="#change" { (say("Other rules", "Autres règles")) }
                a href="#trials" { (say("Trials", "Essais")) }
                a href="#formats" { (say("Formats", "Formats")) }
                a href="take-part.html" { (say("Take part, nothing is kept", "Participer, rien n’est conservé")) }
            }
            noscript {
                p.notice.warn {
                    (say("Clips and statistics need JavaScript; the report and the tables do not: ", "Les clips et les calculs ont besoin de JavaScript, pas le rapport ni les tableaux : "))
                    a href="report/report.html" { "report/report.html" } ", data/"
                }
            }
        }
    }
}

/// The tests that a hypothesis can name.
fn tests() -> impl Iterator<Item = &'static str> {
    let names = mimique_stats::PROCEDURES.iter().map(|procedure| procedure.name);
    names.filter(|name| {
        let name: StrDeserializer<'_, Error> = name.into_deserializer();
        TestName::deserialize(name).is_ok()
    })
}

/// The form with the rules of exclusion and the tests of the hypotheses.
fn changes(study: &Study, language: Language) -> Markup {
    let say = |english: &'static str, french: &'static str| language.pick(english, french);
    let number = |rule: &'static str,
                  label: &'static str,
                  step: &'static str,
                  most: Option<&'static str>| {
        html! {
            label {
                (label)
                input type="number" data-rule=(rule) min="0" max=[most] step=(step) inputmode="decimal";
            }
        }
    };
    html! {
        form #changes {
            fieldset {
                legend { (say("Left out are; an empty field is no rule", "Sont exclus ; un champ vide n’est pas une règle")) }
                label.check {
                    input type="checkbox" data-rule="incomplete";
                    (say("people who did not finish", "les personnes qui n’ont pas terminé"))
                }
                (number("lateFrameShare", say("trials with a larger share of late frames than (0 to 1)", "essais dont la part d’images en retard dépasse (0 à 1)"), "0.01", Some("1")))
                (number("longestFrameMs", say("trials with a frame longer than (ms)", "essais dont une image dure plus de (ms)"), "any", None))
                (number("shortestRtMs", say("trials answered sooner than (ms)", "essais répondus en moins de (ms)"), "any", None))
                (number("failedAttentionChecks", say("people who failed more attention checks than", "personnes ayant manqué plus de contrôles d’attention que"), "1", None))
                (number("straightLining", say("people with more equal answers in a row than", "personnes ayant plus de réponses identiques de suite que"), "1", None))
                @if study.has_sound() {
                    (number("soundOffsetMs", say("trials whose sound was off by more than (ms)", "essais dont le son était décalé de plus de (ms)"), "any", None))
                }
            }
            @if !study.hypotheses.is_empty() {
                fieldset {
                    legend { (say("Tests", "Tests")) }
                    @for hypothesis in &study.hypotheses {
                        label {
                            span { strong { (hypothesis.id) } " " (hypothesis.statement.in_language(language.code())) }
                            select data-hypothesis=(hypothesis.id) {
                                @for test in tests() { option value=(test) { (test) } }
                            }
                        }
                    }
                }
            }
            div.actions {
                button.primary type="submit" { (say("Compute", "Calculer")) }
                button type="reset" { (say("As published", "Comme publié")) }
            }
        }
    }
}

/// The trials, and the player that draws them.
fn trials(language: Language) -> Markup {
    let say = |english: &'static str, french: &'static str| language.pick(english, french);
    html! {
        section.card #trials {
            h2 { (say("Trials", "Essais")) }
            p {
                (say(
                    "Draw a trial: the clip is solved and drawn again on the frames that this person was shown, late frames late, and its weights are held against the hash that the person’s browser noted.",
                    "Dessinez un essai : le clip est résolu et redessiné aux images que cette personne a vues, en retard si elles l’étaient, et ses poids sont comparés à l’empreinte notée par le navigateur de la personne.",
                ))
            }
            div.capsule-filter {
                label { (say("Person", "Personne")) select #person { option value="" { (say("all", "toutes")) } } }
                label { (say("Clip", "Clip")) select #clip { option value="" { (say("all", "tous")) } } }
            }
            p.soft #count role="status" {}
            div.scroll role="region" tabindex="0" aria-label=(say("Trials", "Essais")) {
                table {
                    thead {
                        tr {
                            th scope="col" { (say("Person", "Personne")) }
                            th scope="col" { (say("Trial", "Essai")) }
                            th scope="col" { (say("Clip", "Clip")) }
                            th scope="col" { (say("Answers", "Réponses")) }
                            th scope="col" { (say("Late frames", "Images en retard")) }
                            td {}
                        }
                    }
                    tbody #rows {}
                }
            }
            h3 #drawn hidden {}
            (replay_player(language))
        }
    }
}

/// `take-part.html`: the page of participants, and a line above it that says that nothing is kept.
pub fn take_part(assets: &str, study: &Study) -> String {
    let code = study.default_language();
    let title = study.study_metadata.title.in_language(code);
    let (note, said, back) = match code.get(..2) {
        Some("fr") => (
            "Remarque",
            "Rien de ce que vous répondez ici n’est conservé ni envoyé.",
            "Retour au rapport",
        ),
        _ => ("Note", "Nothing that you answer here is kept or sent.", "Back to the report"),
    };
    let page = html! {
        (DOCTYPE)
        html lang=(code) {
            head {
                meta name="mimique-site" content="https://capsule.invalid/site.json" data-study=(study.id);
                meta name="robots" content="noindex";
                (head(assets, title, &["style/style.css", "capsule/capsule.css"], &["capsule/nothing-kept.js"], "participant/boot.js"))
            }
            body.capsule-part {
                aside.capsule-stays #stays aria-label=(note) { (said) " " a href="index.html" { (back) } }
                div #app { (first_page(study, code)) }
            }
        }
    };
    page.into_string() + "\n"
}

/// What stayed out, as sentences.
pub fn sentences(
    left_out: &super::LeftOut,
    other_versions: usize,
    language: Language,
) -> Vec<String> {
    let people = |count: usize| match language {
        Language::English => mimique_locale::counted_as(count, "person", "people"),
        Language::French => format!("{count} {}", if count < 2 { "personne" } else { "personnes" }),
    };
    let list = |names: Vec<&str>| names.join(", ");
    let mut said = Vec::new();
    if !left_out.withdrawn.is_empty() {
        let who = people(left_out.withdrawn.len());
        said.push(language.pick(
            format!("Not in it: {who} who withdrew."),
            format!("Absentes : {who} qui se sont retirées."),
        ));
    }
    if !left_out.declined.is_empty() {
        let who = people(left_out.declined.len());
        said.push(language.pick(
            format!("Not in it: {who} who did not agree."),
            format!("Absentes : {who} sans accord."),
        ));
    }
    if !left_out.in_one_alone.is_empty() {
        let who = people(left_out.in_one_alone.len());
        said.push(language.pick(
            format!(
                "Not in it: {who} of whom only one of the two exports knows: erased between them, or gone before the first answer."
            ),
            format!(
                "Absentes : {who} que seul un des deux exports connaît : effacées entre-temps, ou parties avant la première réponse."
            ),
        ));
    }
    if !left_out.texts.is_empty() {
        let which = list(left_out.texts.iter().map(String::as_str).collect());
        said.push(language.pick(
            format!("Not in it: what people wrote in their own words ({which})."),
            format!("Absent : ce que les personnes ont écrit librement ({which})."),
        ));
    }
    if !left_out.identifiers.is_empty() {
        let which = list(left_out.identifiers.iter().map(String::as_str).collect());
        said.push(language.pick(
            format!("Not in it: identifiers of recruitment ({which})."),
            format!("Absents : les identifiants de recrutement ({which})."),
        ));
    }
    if other_versions > 0 {
        let sessions = counted(other_versions, "session");
        said.push(language.pick(
            format!("{sessions} of another version of the study: in the tables, not drawn again."),
            format!("{sessions} d’une autre version de l’étude : dans les tableaux, sans dessin."),
        ));
    }
    said
}
