//! The words of the pages that no study file writes: buttons, messages, in English and French.

mod gate;
mod refusals;

use crate::answer::AnswerProblem;

/// Every fixed text of the pages in one language.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Words {
    /// Its language code.
    pub language: &'static str,
    /// The language's own name.
    pub language_name: &'static str,
    /// Button: agree to take part.
    pub agree: &'static str,
    /// Button: do not agree.
    pub decline: &'static str,
    /// Button: next page.
    pub next: &'static str,
    /// Button: begin.
    pub begin: &'static str,
    /// Button: send the answers of a trial.
    pub submit: &'static str,
    /// Button: play.
    pub play: &'static str,
    /// Button: play again.
    pub play_again: &'static str,
    /// Button: try again.
    pub retry: &'static str,
    /// Button: stop taking part.
    pub withdraw: &'static str,
    /// Question before stopping.
    pub withdraw_question: &'static str,
    /// Button: yes, stop and delete.
    pub withdraw_yes: &'static str,
    /// Button: no, go on.
    pub withdraw_no: &'static str,
    /// Label of the choice of language.
    pub choose_language: &'static str,
    /// Marks an answer that may be left out.
    pub optional: &'static str,
    /// Heading of the consent page's line on age.
    pub age: &'static str,
    /// Heading of how long answers are kept.
    pub retention: &'static str,
    /// Heading of the addresses.
    pub contact: &'static str,
    /// Who leads the study.
    pub investigator: &'static str,
    /// The ethics board.
    pub ethics_board: &'static str,
    /// Heading of the questions about the participant, if the study gives none.
    pub about_you: &'static str,
    /// The clip is being prepared.
    pub loading: &'static str,
    /// The last answer is being stored.
    pub saving: &'static str,
    /// Ready to be played.
    pub ready: &'static str,
    /// Being played.
    pub playing: &'static str,
    /// Watch first, then answer.
    pub watch_first: &'static str,
    /// Answer now.
    pub answer_now: &'static str,
    /// A play was cut short.
    pub play_interrupted: &'static str,
    /// A clip failed.
    pub clip_failed: &'static str,
    /// Heading while the last answers are sent.
    pub sending: &'static str,
    /// Below it.
    pub sending_text: &'static str,
    /// Heading of the last page.
    pub thanks: &'static str,
    /// Text of the last page.
    pub thanks_text: &'static str,
    /// Label of the completion code.
    pub completion_code: &'static str,
    /// Link back to the recruiting site.
    pub go_back: &'static str,
    /// Label of the receipt.
    pub receipt: &'static str,
    /// Label of the withdrawal code.
    pub withdrawal_code: &'static str,
    /// What the withdrawal code is for.
    pub withdrawal_code_text: &'static str,
    /// Heading after declining.
    pub declined: &'static str,
    /// Text after declining.
    pub declined_text: &'static str,
    /// Heading while answers are deleted.
    pub withdrawing: &'static str,
    /// Heading after withdrawal.
    pub withdrawn: &'static str,
    /// Text after withdrawal.
    pub withdrawn_text: &'static str,
    /// No script, no network, no graphics: something this page needs is missing.
    pub cannot_run: &'static str,
    /// The connection is lost; answers are kept.
    pub offline: &'static str,
    /// The browser keeps nothing: a reload would lose what waits.
    pub not_kept: &'static str,
    /// The address names no study.
    pub no_study: &'static str,
    /// The server cannot be reached.
    pub unreachable: &'static str,
    /// The server does not let this participant begin.
    pub cannot_begin: &'static str,
    /// Heading: the session is open in another tab.
    pub other_tab: &'static str,
    /// What to do about it.
    pub other_tab_text: &'static str,
    /// Button: the order of a ranking is right as it stands.
    pub confirm_order: &'static str,
    /// Button beside an item of a ranking, before the item's name.
    pub move_up: &'static str,
    /// Button beside an item of a ranking, before the item's name.
    pub move_down: &'static str,
    /// Answer of a comparison: the clip on the left, or above on a narrow screen.
    pub left_one: &'static str,
    /// Answer of a comparison: the clip on the right, or below on a narrow screen.
    pub right_one: &'static str,
    /// Answer of a comparison: no difference.
    pub both_alike: &'static str,
    /// Button: another person takes part in the same browser.
    pub another_person: &'static str,
    /// Button: the answers as a file, where there is no server.
    pub download: &'static str,
}

/// English.
const ENGLISH: Words = Words {
    language: "en",
    language_name: "English",
    agree: "I agree to take part",
    decline: "I do not want to take part",
    next: "Next",
    begin: "Begin",
    submit: "Send and go on",
    play: "Play the clip",
    play_again: "Play again",
    retry: "Try again",
    withdraw: "Stop and withdraw",
    withdraw_question: "Do you want to stop now and have all your answers deleted?",
    withdraw_yes: "Yes, stop and delete my answers",
    withdraw_no: "No, go on",
    choose_language: "Language",
    optional: "optional",
    age: "Age",
    retention: "How long answers are kept",
    contact: "Contact",
    investigator: "Investigator",
    ethics_board: "Ethics board",
    about_you: "About you",
    loading: "The clip is being prepared",
    saving: "Your answers are being saved",
    ready: "The clip is ready",
    playing: "The clip is playing",
    watch_first: "Please watch the whole clip before you answer.",
    answer_now: "Please answer the questions.",
    play_interrupted: "The clip was interrupted. Please play it again.",
    clip_failed: "This clip could not be shown.",
    sending: "Your last answers are being sent",
    sending_text: "Please keep this page open until it says that everything has arrived.",
    thanks: "Thank you",
    thanks_text: "All your answers have arrived. You can close this page now.",
    completion_code: "Completion code",
    go_back: "Go back to the site that sent you here",
    receipt: "Receipt",
    withdrawal_code: "Withdrawal code",
    withdrawal_code_text: "Keep this code if you might want to have your answers deleted later: give it to the investigator.",
    declined: "You chose not to take part",
    declined_text: "Nothing more is recorded. You can close this page now.",
    withdrawing: "Your answers are being deleted",
    withdrawn: "You have withdrawn",
    withdrawn_text: "Your answers have been deleted. You can close this page now.",
    cannot_run: "This page cannot run in this browser.",
    offline: "The connection is lost. Your answers are kept here and will be sent when it is back.",
    not_kept: "This browser keeps nothing on this device: please do not close or reload the page before the end.",
    no_study: "There is no study at this address.",
    unreachable: "The study cannot be reached. Please check the connection and try again.",
    cannot_begin: "You cannot take part now.",
    other_tab: "This study is open in another tab",
    other_tab_text: "Please go on there, or close that tab and try again here.",
    confirm_order: "This is my order",
    move_up: "Move up:",
    move_down: "Move down:",
    left_one: "The left one (or upper one)",
    right_one: "The right one (or lower one)",
    both_alike: "No difference",
    another_person: "Start again for another person",
    download: "Download my answers",
};

/// French.
const FRENCH: Words = Words {
    language: "fr",
    language_name: "français",
    agree: "J’accepte de participer",
    decline: "Je ne souhaite pas participer",
    next: "Suivant",
    begin: "Commencer",
    submit: "Envoyer et continuer",
    play: "Voir l’extrait",
    play_again: "Revoir l’extrait",
    retry: "Réessayer",
    withdraw: "Arrêter et me retirer",
    withdraw_question: "Voulez-vous arrêter maintenant et faire effacer toutes vos réponses ?",
    withdraw_yes: "Oui, arrêter et effacer mes réponses",
    withdraw_no: "Non, continuer",
    choose_language: "Langue",
    optional: "facultatif",
    age: "Âge",
    retention: "Durée de conservation des réponses",
    contact: "Contact",
    investigator: "Responsable de l’étude",
    ethics_board: "Comité d’éthique",
    about_you: "À propos de vous",
    loading: "L’extrait se prépare",
    saving: "Vos réponses sont en cours d’enregistrement",
    ready: "L’extrait est prêt",
    playing: "L’extrait est en cours de lecture",
    watch_first: "Veuillez regarder l’extrait en entier avant de répondre.",
    answer_now: "Veuillez répondre aux questions.",
    play_interrupted: "La lecture a été interrompue. Veuillez revoir l’extrait.",
    clip_failed: "Cet extrait n’a pas pu être affiché.",
    sending: "Vos dernières réponses sont en cours d’envoi",
    sending_text: "Veuillez garder cette page ouverte jusqu’à ce qu’elle indique que tout est arrivé.",
    thanks: "Merci",
    thanks_text: "Toutes vos réponses sont arrivées. Vous pouvez fermer cette page.",
    completion_code: "Code de fin",
    go_back: "Revenir au site qui vous a adressé ici",
    receipt: "Reçu",
    withdrawal_code: "Code de retrait",
    withdrawal_code_text: "Gardez ce code si vous pensez vouloir faire effacer vos réponses plus tard : donnez-le au responsable de l’étude.",
    declined: "Vous avez choisi de ne pas participer",
    declined_text: "Rien d’autre n’est enregistré. Vous pouvez fermer cette page.",
    withdrawing: "Vos réponses sont en cours d’effacement",
    withdrawn: "Vous vous êtes retiré(e) de l’étude",
    withdrawn_text: "Vos réponses ont été effacées. Vous pouvez fermer cette page.",
    cannot_run: "Cette page ne peut pas fonctionner dans ce navigateur.",
    offline: "La connexion est perdue. Vos réponses sont gardées ici et seront envoyées à son retour.",
    not_kept: "Ce navigateur ne garde rien sur cet appareil : veuillez ne pas fermer ni recharger la page avant la fin.",
    no_study: "Il n’y a pas d’étude à cette adresse.",
    unreachable: "L’étude est injoignable. Vérifiez la connexion et réessayez.",
    cannot_begin: "Vous ne pouvez pas participer pour l’instant.",
    other_tab: "Cette étude est ouverte dans un autre onglet",
    other_tab_text: "Continuez dans cet autre onglet, ou fermez-le et réessayez ici.",
    confirm_order: "C’est mon classement",
    move_up: "Monter :",
    move_down: "Descendre :",
    left_one: "Celui de gauche (ou du haut)",
    right_one: "Celui de droite (ou du bas)",
    both_alike: "Aucune différence",
    another_person: "Recommencer pour une autre personne",
    download: "Télécharger mes réponses",
};

/// Languages whose fixed texts are complete.
pub const LANGUAGES: [&str; 2] = ["en", "fr"];

/// The fixed texts of a language; English where there are none.
pub fn words(language: &str) -> &'static Words {
    if language.split(['-', '_']).next() == Some("fr") { &FRENCH } else { &ENGLISH }
}

impl Words {
    /// "Clip 3 of 12".
    pub fn trial_of(&self, number: usize, of: usize) -> String {
        match self.language {
            "fr" => format!("Extrait {number} sur {of}"),
            _ => format!("Clip {number} of {of}"),
        }
    }

    /// The answers are in this browser alone.
    pub fn kept_here(&self, email: &str) -> String {
        match self.language {
            "fr" => format!(
                "Vos réponses sont gardées dans ce navigateur seulement. Téléchargez-les et envoyez le fichier au responsable de l’étude : {email}."
            ),
            _ => format!(
                "Your answers are kept in this browser only. Please download them and send the file to the investigator: {email}."
            ),
        }
    }

    /// Why the server does not take a participant, and what can be done: message and remedy. `None`
    /// for refusals that are not a participant's.
    pub fn refusal(&self, code: &str) -> Option<(&'static str, &'static str)> {
        let french = self.language == "fr";
        Some(match code {
            "already-took-part" if french => (
                "Vous avez déjà participé à cette étude.",
                "On ne peut y participer qu’une fois. Merci ! Si c’est une erreur, écrivez au responsable de l’étude.",
            ),
            "already-took-part" => (
                "You have already taken part in this study.",
                "Everybody can take part once. Thank you! If this is a mistake, write to the investigator.",
            ),
            "study-full" if french => (
                "L’étude a assez de participants pour l’instant.",
                "Une place peut se libérer : réessayez plus tard. Merci de votre intérêt.",
            ),
            "study-full" => (
                "The study has enough participants for now.",
                "A place may become free: try again later. Thank you for your interest.",
            ),
            "study-not-open" if french => {
                ("L’étude n’est pas encore ouverte.", "Revenez à la date annoncée.")
            }
            "study-not-open" => ("The study is not open yet.", "Come back at the announced time."),
            "study-closed" if french => ("L’étude est terminée.", "Merci de votre intérêt."),
            "study-closed" => ("The study is over.", "Thank you for your interest."),
            "no-identifier" if french => (
                "L’adresse ne dit pas qui vous êtes.",
                "Revenez au site qui vous a adressé ici et suivez son lien.",
            ),
            "no-identifier" => (
                "The address does not say who you are.",
                "Go back to the site that sent you here and follow its link.",
            ),
            _ => return None,
        })
    }

    /// "Practice clip 1 of 2".
    pub fn training_of(&self, number: usize, of: usize) -> String {
        match self.language {
            "fr" => format!("Extrait d’entraînement {number} sur {of}"),
            _ => format!("Practice clip {number} of {of}"),
        }
    }

    /// "You must be at least 18 years old to take part."
    pub fn minimum_age(&self, years: u32) -> String {
        match self.language {
            "fr" => format!("Il faut avoir au moins {years} ans pour participer."),
            _ => format!("You must be at least {years} years old to take part."),
        }
    }

    /// "You can go on in 12 seconds."
    pub fn wait_seconds(&self, seconds: u64) -> String {
        match self.language {
            "fr" => format!("Vous pourrez continuer dans {seconds} s."),
            _ => format!("You can go on in {seconds} s."),
        }
    }

    /// What to mend in an answer.
    pub fn problem(&self, problem: &AnswerProblem) -> String {
        let french = self.language == "fr";
        match problem {
            AnswerProblem::Missing if french => "Veuillez répondre à cette question.".to_owned(),
            AnswerProblem::Missing => "Please answer this question.".to_owned(),
            AnswerProblem::NotAnOption if french => "Veuillez choisir une réponse.".to_owned(),
            AnswerProblem::NotAnOption => "Please choose an answer.".to_owned(),
            AnswerProblem::NotANumber if french => "Veuillez écrire un nombre.".to_owned(),
            AnswerProblem::NotANumber => "Please write a number.".to_owned(),
            AnswerProblem::NotWhole if french => "Veuillez écrire un nombre entier.".to_owned(),
            AnswerProblem::NotWhole => "Please write a whole number.".to_owned(),
            AnswerProblem::TooLow(least) if french => format!("Le minimum est {least}."),
            AnswerProblem::TooLow(least) => format!("The lowest number is {least}."),
            AnswerProblem::TooHigh(most) if french => format!("Le maximum est {most}."),
            AnswerProblem::TooHigh(most) => format!("The highest number is {most}."),
            AnswerProblem::TooLong(most) if french => {
                format!("Veuillez ne pas dépasser {most} caractères.")
            }
            AnswerProblem::TooLong(most) => format!("Please write at most {most} characters."),
            AnswerProblem::TooFew(least) if french => {
                format!("Veuillez en choisir au moins {least}.")
            }
            AnswerProblem::TooFew(least) => format!("Please choose at least {least}."),
            AnswerProblem::TooMany(most) if french => {
                format!("Veuillez en choisir au plus {most}.")
            }
            AnswerProblem::TooMany(most) => format!("Please choose at most {most}."),
            AnswerProblem::Incomplete if french => "Veuillez compléter cette réponse.".to_owned(),
            AnswerProblem::Incomplete => "Please complete this answer.".to_owned(),
        }
    }
}
