//! A preregistration written from the study file: hypotheses, design, sample, variables, analysis and
//! exclusions, in the order of the OSF's form, with the power that the sample has; or by the questions of AsPredicted.
//!
//! What only the researcher knows (whether data exist already, who recruits) stands in square brackets.

mod analysis;
mod as_predicted;
mod design;
mod equivalence;
mod faces;
mod levels;
pub(crate) mod pairs;
mod panels;
mod scaling;

use std::fmt::Write;

pub use as_predicted::as_predicted;
use mimique_locale::Language;
use mimique_study::Study;

use crate::naming::Naming;
use crate::power::{Power, no_effect, power_markdown};
use crate::simulate::Parameters;

/// What a preregistration is written from.
#[derive(Debug, Clone, Copy)]
pub struct Preregistration<'a> {
    /// The study.
    pub study: &'a Study,
    /// Hash of the study's file: which version is registered.
    pub config_hash: &'a str,
    /// Simulated power.
    pub power: &'a Power,
    /// What was assumed.
    pub parameters: &'a Parameters,
    /// Language of the text.
    pub language: Language,
    /// File name of the power curve beside the text, if there is one.
    pub curve: Option<&'a str>,
}

/// The text, in markdown.
pub fn preregistration(from: &Preregistration<'_>) -> String {
    let naming = Naming { language: from.language, study: from.study };
    let mut text = Text { text: String::new(), language: from.language };
    let meta = &from.study.study_metadata;
    let code = from.language.code();
    let title = meta.title.in_language(code);
    text.line(&format!(
        "# {}\n",
        text.language
            .pick(format!("Preregistration: {title}"), format!("Préenregistrement : {title}"))
    ));
    text.both(
        "*Written by Mimique from the study file, in the order of the OSF Preregistration form. Square brackets mark what the file does not say: fill them in before you register.*",
        "*Écrit par Mimique à partir du fichier d’étude, dans l’ordre du formulaire OSF Preregistration. Les crochets marquent ce que le fichier ne dit pas : complétez-les avant l’enregistrement.*",
    );

    text.heading(2, "Study information", "Présentation de l’étude");
    text.item("Title", "Titre", title);
    if !meta.authors.is_empty() {
        text.item("Authors", "Auteurs", &meta.authors.join(", "));
    }
    text.item(
        "Version of the study file",
        "Version du fichier d’étude",
        &format!("{} (SHA-256 `{}`)", meta.version, from.config_hash),
    );
    text.line("");
    text.line(meta.description.in_language(code));
    text.line("");
    text.heading(3, "Hypotheses", "Hypothèses");
    hypotheses(&mut text, from);

    design::write(&mut text, from, &naming);
    sample(&mut text, from);
    design::variables(&mut text, from, &naming);
    analysis::write(&mut text, from, &naming);
    simulation(&mut text, from);
    text.text
}

/// What is tested, in the study's own words.
fn hypotheses(text: &mut Text, from: &Preregistration<'_>) {
    let code = from.language.code();
    for hypothesis in &from.study.hypotheses {
        text.line(&format!("- **{}.** {}", hypothesis.id, hypothesis.statement.in_language(code)));
    }
    text.line("");
    if from.study.hypotheses.is_empty() {
        text.both(
            "No hypothesis is tested: the blocks below are to tell what their analysis says. [Say here what you expect.]",
            "Aucune hypothèse n’est testée : les blocs ci-dessous servent à établir ce que dit leur analyse. [Dites ici ce que vous attendez.]",
        );
    } else {
        text.both(
        "Each statement says that there is no difference; the tests are two-sided, so that a difference in either direction speaks against it. [If you expect a direction, say so here.]",
        "Chaque énoncé dit qu’il n’y a pas de différence ; les tests sont bilatéraux, une différence dans un sens ou dans l’autre parle contre lui. [Si vous attendez un sens, dites-le ici.]",
    );
    }
}

/// Markdown in one language.
struct Text {
    text: String,
    language: Language,
}

impl Text {
    fn line(&mut self, line: &str) {
        let _ = writeln!(self.text, "{line}");
    }

    fn both(&mut self, english: &str, french: &str) {
        let line = self.language.pick(english, french).to_owned();
        self.line(&line);
        self.line("");
    }

    fn heading(&mut self, level: usize, english: &str, french: &str) {
        let words = self.language.pick(english, french);
        let _ = writeln!(self.text, "{} {words}\n", "#".repeat(level));
    }

    fn item(&mut self, english: &str, french: &str, what: &str) {
        let name = self.language.pick(english, french);
        let colon = self.language.pick(":", " :");
        let _ = writeln!(self.text, "- **{name}{colon}** {what}");
    }
}

/// The number of people that the study wants, or that its power asks for.
fn wanted(from: &Preregistration<'_>) -> Option<usize> {
    from.study.recruitment.participants.map(|number| number as usize)
}

fn sample(text: &mut Text, from: &Preregistration<'_>) {
    text.heading(2, "Sampling plan", "Échantillon");
    text.heading(3, "Existing data", "Données existantes");
    text.both(
        "[Registration prior to creation of data: no answer has been collected when this is registered. Change this if it is not so.]",
        "[Enregistrement avant la création des données : aucune réponse n’a été recueillie au moment de l’enregistrement. Modifiez si ce n’est pas le cas.]",
    );
    text.heading(3, "Data collection", "Recueil des données");
    collection(text, from);
    text.heading(3, "Sample size", "Taille de l’échantillon");
    size(text, from);
    text.heading(3, "Rationale", "Justification");
    rationale(text, from);
    text.heading(3, "Stopping rule", "Règle d’arrêt");
    stopping_rule(text, from);
}

fn collection(text: &mut Text, from: &Preregistration<'_>) {
    let language = from.language;
    let study = from.study;
    let mut words = language.pick(
        format!(
            "The study runs online, in the participant’s browser, in: {}.",
            study.languages.join(", ")
        ),
        format!(
            "L’étude se déroule en ligne, dans le navigateur, en : {}.",
            study.languages.join(", ")
        ),
    );
    if let Some(consent) = &study.consent {
        let _ = write!(words, "{}", language.pick(
            format!(" Participants agree to version {} of the consent text before anything is asked.", consent.version),
            format!(" Les participants acceptent la version {} du texte de consentement avant toute question.", consent.version),
        ));
        if let Some(age) = consent.minimum_age {
            let _ = write!(
                words,
                "{}",
                language.pick(
                    format!(" They are at least {age} years old."),
                    format!(" Ils ont au moins {age} ans."),
                )
            );
        }
    }
    words += language.pick(
        " [Say where participants are recruited, and what they are paid.]",
        " [Dites où les participants sont recrutés et comment ils sont rétribués.]",
    );
    text.line(&words);
    text.line("");
}

fn size(text: &mut Text, from: &Preregistration<'_>) {
    let language = from.language;
    match wanted(from) {
        Some(number) => {
            let line = language.pick(
                format!("{number} participants."),
                format!("{number} participants."),
            );
            text.line(&line);
        }
        None => text.line(language.pick(
            "[Number of participants; `recruitment.participants` of the study file says it to the server too.]",
            "[Nombre de participants ; `recruitment.participants` du fichier d’étude le dit aussi au serveur.]",
        )),
    }
    text.line("");
}

fn rationale(text: &mut Text, from: &Preregistration<'_>) {
    let (language, study) = (from.language, from.study);
    let line = language.pick(
        format!(
            "Power was found by simulation: whole studies were simulated with the parameters at the end of this text ({} a point, seed {}), with dropout and careless answers, and analysed exactly as below at α = {}.",
            from.power.runs, from.power.seed, from.power.alpha
        ),
        format!(
            "La puissance a été établie par simulation : des études entières ont été simulées avec les paramètres donnés à la fin de ce texte ({} par point, graine {}), abandons et réponses négligentes compris, et analysées exactement comme ci-dessous à α = {}.",
            from.power.runs,
            from.power.seed,
            language.number(from.power.alpha)
        ),
    );
    text.line(&line);
    text.line("");
    for (place, hypothesis) in study.hypotheses.iter().enumerate() {
        let line = match crate::power::enough(from.power, place, 0.8) {
            Some((people, clips)) => language.pick(
                format!("- {}: {people} people and {clips} clips have a power of 80 % or more.", hypothesis.id),
                format!("- {} : {people} personnes et {clips} extraits ont une puissance de 80 % ou plus.", hypothesis.id),
            ),
            None if from.power.points.iter().any(|point| !point.hypotheses[place].effect) => {
                ["- ", &hypothesis.id, language.pick(": ", "\u{a0}: "), no_effect(language)].concat()
            }
            None => language.pick(
                format!("- {}: none of the sizes below has a power of 80 %.", hypothesis.id),
                format!("- {} : aucune des tailles ci-dessous n’a une puissance de 80 %.", hypothesis.id),
            ),
        };
        text.line(&line);
    }
    text.line("");
    let table = power_markdown(from.power, language);
    text.line(table.trim_end());
    text.line("");
    if let Some(curve) = from.curve {
        let alt = language
            .pick("Power against the number of people", "Puissance selon le nombre de personnes");
        text.line(&format!("![{alt}]({curve})"));
        text.line("");
    }
    text.both(
        "‘Recommended’ counts each person once; ‘with Holm’ corrects over the hypotheses and decides; ‘as in the thesis’ treats every trial as an independent observation and is given for comparison only. In brackets: Wilson’s 95 % interval of the simulation.",
        "« Recommandé » compte chaque personne une fois ; « avec Holm » corrige sur l’ensemble des hypothèses et décide ; « comme dans la thèse » prend chaque essai pour une observation indépendante et n’est donné que pour comparaison. Entre crochets : intervalle de Wilson à 95 % de la simulation.",
    );
}

fn stopping_rule(text: &mut Text, from: &Preregistration<'_>) {
    let language = from.language;
    let line = match wanted(from) {
        Some(number) => language.pick(
            format!("Collection stops when {number} people have completed the study and passed the rules on people below. No test is computed before."),
            format!("Le recueil s’arrête quand {number} personnes ont terminé l’étude et satisfait aux règles ci-dessous. Aucun test n’est calculé avant."),
        ),
        None => language.pick(
            "Collection stops when the number above have completed the study and passed the rules on people below. No test is computed before.",
            "Le recueil s’arrête quand le nombre ci-dessus de personnes ont terminé l’étude et satisfait aux règles ci-dessous. Aucun test n’est calculé avant.",
        )
        .to_owned(),
    };
    text.line(&line);
    text.line("");
}

fn simulation(text: &mut Text, from: &Preregistration<'_>) {
    text.heading(2, "Parameters of the simulation", "Paramètres de la simulation");
    text.both(
        "`mimique power` with this study file, these parameters and the seed above gives the same numbers.",
        "`mimique power` avec ce fichier d’étude, ces paramètres et la graine ci-dessus redonne les mêmes nombres.",
    );
    let json = serde_json::to_string_pretty(from.parameters).unwrap_or_default();
    text.line(&format!("```json\n{json}\n```"));
}
