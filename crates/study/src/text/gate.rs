//! The words of the device gate, of calibration, practice and time limits, and of the ends of a
//! session before its last page, in English and French.

use super::Words;
use crate::flow::Unmet;

impl Words {
    fn french(&self) -> bool {
        self.language == "fr"
    }

    fn either(&self, english: &'static str, french: &'static str) -> &'static str {
        if self.french() { french } else { english }
    }

    /// Heading while the device is looked at.
    pub fn device_heading(&self) -> &'static str {
        self.either("Your screen", "Votre écran")
    }

    /// The device is being looked at.
    pub fn device_measuring(&self) -> &'static str {
        self.either("Just a moment: looking at your screen.", "Un instant : examen de votre écran.")
    }

    /// Nothing is missing.
    pub fn device_fine(&self) -> &'static str {
        self.either("Everything is fine. You can go on.", "Tout va bien. Vous pouvez continuer.")
    }

    /// Something is missing.
    pub fn device_lacks(&self) -> &'static str {
        self.either(
            "This study cannot be shown here yet:",
            "Cette étude ne peut pas encore être présentée ici :",
        )
    }

    /// Nothing is missing, and the page is to fill the screen.
    pub fn device_fullscreen(&self) -> &'static str {
        self.either(
            "The study fills the whole screen. The Escape key leaves it.",
            "L’étude occupe tout l’écran. La touche Échap permet d’en sortir.",
        )
    }

    /// Button: fill the screen and go on.
    pub fn enter_fullscreen(&self) -> &'static str {
        self.either("Go on in full screen", "Continuer en plein écran")
    }

    /// Button: go on without.
    pub fn without_fullscreen(&self) -> &'static str {
        self.either("Go on without full screen", "Continuer sans plein écran")
    }

    /// A clip waits for the full screen.
    pub fn fullscreen_first(&self) -> &'static str {
        self.either(
            "This study is shown in full screen. Please go back to it, then play the clip.",
            "Cette étude se déroule en plein écran. Revenez-y, puis lancez l’extrait.",
        )
    }

    /// Button: back to the full screen.
    pub fn back_to_fullscreen(&self) -> &'static str {
        self.either("Back to full screen", "Revenir en plein écran")
    }

    /// Button: measure again.
    pub fn device_again(&self) -> &'static str {
        self.either("Look again", "Examiner à nouveau")
    }

    /// Button: what is missing cannot be mended.
    pub fn device_give_up(&self) -> &'static str {
        self.either("I cannot change this: end here", "Je ne peux pas changer cela : terminer ici")
    }

    /// What is missing, and what to do about it.
    pub fn unmet(&self, unmet: &Unmet) -> (String, String) {
        let french = self.french();
        let (what, remedy) = match unmet {
            Unmet::Width { least, found } if french => (
                format!("La fenêtre fait {found} pixels de large ; il en faut {least}."),
                "Élargissez la fenêtre ou réduisez le zoom de la page (Ctrl et −) ; cette page le remarque d’elle-même.",
            ),
            Unmet::Width { least, found } => (
                format!("The window is {found} pixels wide; the study needs {least}."),
                "Make the window wider, or the page's zoom smaller (Ctrl and −); this page notices by itself.",
            ),
            Unmet::Height { least, found } if french => (
                format!("La fenêtre fait {found} pixels de haut ; il en faut {least}."),
                "Agrandissez la fenêtre ou réduisez le zoom de la page (Ctrl et −) ; cette page le remarque d’elle-même.",
            ),
            Unmet::Height { least, found } => (
                format!("The window is {found} pixels high; the study needs {least}."),
                "Make the window higher, or the page's zoom smaller (Ctrl and −); this page notices by itself.",
            ),
            Unmet::Kind if french => (
                "L’étude demande un ordinateur avec une souris ou un pavé tactile.".to_owned(),
                "Ouvrez l’adresse de cette page sur un ordinateur.",
            ),
            Unmet::Kind => (
                "The study needs a computer with a mouse or a touch pad.".to_owned(),
                "Open the address of this page on a computer.",
            ),
            Unmet::Backend if french => (
                "Ce navigateur ne peut pas dessiner les animations.".to_owned(),
                "Essayez une version récente de Chrome, Edge, Firefox ou Safari, avec l’accélération matérielle activée.",
            ),
            Unmet::Backend => (
                "This browser cannot draw the animations.".to_owned(),
                "Try a current Chrome, Edge, Firefox or Safari with hardware acceleration switched on.",
            ),
            Unmet::Refresh { least, found } if french => (
                format!("L’écran affiche {found:.0} images par seconde ; il en faut {least:.0}."),
                "Fermez les autres programmes, branchez l’ordinateur au secteur, puis examinez à nouveau.",
            ),
            Unmet::Refresh { least, found } => (
                format!("The screen shows {found:.0} frames a second; the study needs {least:.0}."),
                "Close other programs, plug the computer in, then look again.",
            ),
            Unmet::Fullscreen if french => (
                "Ce navigateur ne permet pas le plein écran.".to_owned(),
                "Ouvrez l’adresse de cette page sur un ordinateur.",
            ),
            Unmet::Fullscreen => (
                "This browser allows no full screen.".to_owned(),
                "Open the address of this page on a computer.",
            ),
        };
        (what, remedy.to_owned())
    }

    /// Heading of the calibration.
    pub fn calibration_heading(&self) -> &'static str {
        self.either("The size of your screen", "La taille de votre écran")
    }

    /// What to do with the card.
    pub fn card_instruction(&self) -> &'static str {
        self.either(
            "Hold a bank card (or any card of that size) against the screen and make the picture exactly as large. Nothing on the card is read or recorded.",
            "Tenez une carte bancaire (ou toute carte de ce format) contre l’écran et donnez à l’image exactement la même taille. Rien de la carte n’est lu ni enregistré.",
        )
    }

    /// Label of the slider.
    pub fn card_label(&self) -> &'static str {
        self.either("Width of the picture", "Largeur de l’image")
    }

    /// Button: a little smaller.
    pub fn card_smaller(&self) -> &'static str {
        self.either("Smaller", "Plus petit")
    }

    /// Button: a little larger.
    pub fn card_larger(&self) -> &'static str {
        self.either("Larger", "Plus grand")
    }

    /// Button: no card at hand.
    pub fn no_card(&self) -> &'static str {
        self.either("I have no card at hand", "Je n’ai pas de carte sous la main")
    }

    /// The picture was not adjusted.
    pub fn card_missing(&self) -> &'static str {
        self.either(
            "Please make the picture as large as the card.",
            "Veuillez donner à l’image la taille de la carte.",
        )
    }

    /// Button: the picture is right.
    pub fn calibrated(&self) -> &'static str {
        self.either("The size is right", "La taille est juste")
    }

    /// Where to sit.
    pub fn distance_stated(&self, centimetres: f64) -> String {
        if self.french() {
            format!("Veuillez vous placer à environ {centimetres} cm de l’écran, et y rester.")
        } else {
            format!("Please sit about {centimetres} cm from the screen, and stay there.")
        }
    }

    /// How far the participant sits.
    pub fn distance_label(&self) -> &'static str {
        self.either(
            "How far are your eyes from the screen?",
            "À quelle distance de l’écran sont vos yeux ?",
        )
    }

    /// A distance that cannot be.
    pub fn distance_problem(&self) -> &'static str {
        self.either(
            "Please write a distance from 15 to 300 cm.",
            "Veuillez indiquer une distance de 15 à 300 cm.",
        )
    }

    /// Heading: every answer was right.
    pub fn feedback_right(&self) -> &'static str {
        self.either("That is right", "C’est juste")
    }

    /// Heading: not every answer was right.
    pub fn feedback_wrong(&self) -> &'static str {
        self.either("Not quite", "Pas tout à fait")
    }

    /// "You answered: joy".
    pub fn feedback_given(&self, answer: Option<&str>) -> String {
        match (answer, self.french()) {
            (Some(answer), true) => format!("Votre réponse : {answer}"),
            (Some(answer), false) => format!("You answered: {answer}"),
            (None, true) => "Vous n’avez pas répondu.".to_owned(),
            (None, false) => "You gave no answer.".to_owned(),
        }
    }

    /// "Right is: fear".
    pub fn feedback_answer(&self, answer: &str) -> String {
        if self.french() {
            format!("La bonne réponse : {answer}")
        } else {
            format!("Right is: {answer}")
        }
    }

    /// The round was not good enough and begins again.
    pub fn practise_again(&self, right: u32, of: usize) -> String {
        if self.french() {
            format!("{right} extraits sur {of} étaient justes. L’entraînement recommence.")
        } else {
            format!("{right} of {of} clips were right. The practice begins again.")
        }
    }

    /// Practice is over.
    pub fn practice_over(&self) -> &'static str {
        self.either(
            "This was the last practice clip.",
            "C’était le dernier extrait d’entraînement.",
        )
    }

    /// "12 s left".
    pub fn seconds_left(&self, seconds: u64) -> String {
        let (minutes, rest) = (seconds / 60, seconds % 60);
        match (self.french(), minutes) {
            (true, 0) => format!("Temps restant : {rest} s"),
            (false, 0) => format!("Time left: {rest} s"),
            (true, _) => format!("Temps restant : {minutes} min {rest:02} s"),
            (false, _) => format!("Time left: {minutes} min {rest:02} s"),
        }
    }

    /// There will be a limit.
    pub fn time_limit(&self, seconds: f64) -> String {
        if self.french() {
            format!("Après l’extrait, vous aurez {seconds} s pour répondre.")
        } else {
            format!("After the clip you will have {seconds} s to answer.")
        }
    }

    /// The end is near.
    pub fn time_warning(&self, extendable: bool) -> &'static str {
        match extendable {
            true => self.either(
                "The time is nearly over. Press “More time” if you need it.",
                "Le temps est presque écoulé. Appuyez sur « Plus de temps » si besoin.",
            ),
            false => self.either("The time is nearly over.", "Le temps est presque écoulé."),
        }
    }

    /// Button: more time.
    pub fn more_time(&self) -> &'static str {
        self.either("More time", "Plus de temps")
    }

    /// The time was over.
    pub fn time_over(&self) -> &'static str {
        self.either(
            "The time was over; your answers so far were sent.",
            "Le temps était écoulé ; vos réponses ont été envoyées telles quelles.",
        )
    }

    /// Heading: the study does not take this participant.
    pub fn screened_out(&self) -> &'static str {
        self.either(
            "You cannot take part in this study",
            "Vous ne pouvez pas participer à cette étude",
        )
    }

    /// Too few practice clips were answered right.
    pub fn screened_out_training(&self) -> &'static str {
        self.either(
            "The practice clips were not answered as the study needs it.",
            "Les extraits d’entraînement n’ont pas été réussis comme l’étude le demande.",
        )
    }

    /// What becomes of somebody who was screened out.
    pub fn screened_out_text(&self) -> &'static str {
        self.either(
            "Thank you for your time. Nothing more is asked of you; you can close this page.",
            "Merci de votre temps. Rien d’autre ne vous est demandé ; vous pouvez fermer cette page.",
        )
    }

    /// Heading: too many attention checks were failed.
    pub fn checks_failed(&self) -> &'static str {
        self.either("The study ends here", "L’étude se termine ici")
    }

    /// Why.
    pub fn checks_failed_text(&self, failed: u32) -> String {
        if self.french() {
            format!(
                "Vous avez répondu autrement que demandé à {failed} questions qui vérifient l’attention. Vos réponses sont bien arrivées."
            )
        } else {
            format!(
                "You answered {failed} questions that check attention otherwise than they asked. Your answers have arrived."
            )
        }
    }
}
