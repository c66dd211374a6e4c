//! Every fixed text of the pages by its name, in English and in French. A word in braces stands for what
//! is filled in; a translation (`translations` in the study file) has the same names and the same
//! words in braces.

use super::Words;

macro_rules! table {
    (
        fixed { $($(#[$doc:meta])* $name:ident: $english:literal, $french:literal;)* }
        made { $($(#[$_:meta])* $place:ident: $en:literal, $fr:literal;)* }
    ) => {
        /// Where a text stands.
        #[derive(Clone, Copy)]
        #[allow(non_camel_case_types, reason = "the names are those of the translations")]
        #[allow(dead_code, reason = "what is said of refusals and failures is found by its name")]
        pub(super) enum Place { $($name,)* $($place,)* }

        /// The names of the texts.
        pub(super) static NAMES: [&str; COUNT] =
            [$(stringify!($name),)* $(stringify!($place),)*];
        pub(super) static ENGLISH: [&str; COUNT] = [$($english,)* $($en,)*];
        pub(super) static FRENCH: [&str; COUNT] = [$($french,)* $($fr,)*];
        /// How many there are.
        pub(super) const COUNT: usize = [$($english,)* $($en,)*].len();

        impl Words {
            $($(#[$doc])* pub fn $name(&self) -> &str { self.at(Place::$name) })*
        }
    };
}

table! {
fixed {
    /// The language's own name.
    language_name: "English", "français";
    /// Button: agree to take part.
    agree: "I agree to take part", "J’accepte de participer";
    /// Button: do not agree.
    decline: "I do not want to take part", "Je ne souhaite pas participer";
    /// Button: next page.
    next: "Next", "Suivant";
    /// Button: begin.
    begin: "Begin", "Commencer";
    /// Button: send the answers of a trial.
    submit: "Send and go on", "Envoyer et continuer";
    /// Button: play.
    play: "Play the clip", "Voir l’extrait";
    /// Button: play again.
    play_again: "Play again", "Revoir l’extrait";
    /// Names the open reference of a panel.
    reference: "Reference", "Référence";
    /// Button: try again.
    retry: "Try again", "Réessayer";
    /// Button: stop taking part.
    withdraw: "Stop and withdraw", "Arrêter et me retirer";
    /// Question before stopping.
    withdraw_question:
        "Do you want to stop now and have all your answers deleted?",
        "Voulez-vous arrêter maintenant et faire effacer toutes vos réponses\u{a0}?";
    /// Button: yes, stop and delete.
    withdraw_yes: "Yes, stop and delete my answers", "Oui, arrêter et effacer mes réponses";
    /// Button: no, go on.
    withdraw_no: "No, go on", "Non, continuer";
    /// Label of the choice of language.
    choose_language: "Language", "Langue";
    /// Marks an answer that may be left out.
    optional: "optional", "facultatif";
    /// What a slider says that nobody has touched.
    not_answered: "not answered yet", "pas encore de réponse";
    /// Heading of the consent page's line on age.
    age: "Age", "Âge";
    /// Heading of how long answers are kept.
    retention: "How long answers are kept", "Durée de conservation des réponses";
    /// Heading of the addresses.
    contact: "Contact", "Contact";
    /// Who leads the study.
    investigator: "Investigator", "Responsable de l’étude";
    /// The ethics board.
    ethics_board: "Ethics board", "Comité d’éthique";
    /// Heading of the questions about the participant, if the study gives none.
    about_you: "About you", "À propos de vous";
    /// The clip is being prepared.
    loading: "The clip is being prepared", "L’extrait se prépare";
    /// The last answer is being stored.
    saving: "Your answers are being saved", "Vos réponses sont en cours d’enregistrement";
    /// Ready to be played.
    ready: "The clip is ready", "L’extrait est prêt";
    /// Being played.
    playing: "The clip is playing", "L’extrait est en cours de lecture";
    /// Watch first, then answer.
    watch_first:
        "Please watch the whole clip before you answer.",
        "Veuillez regarder l’extrait en entier avant de répondre.";
    /// Answer now.
    answer_now: "Please answer the questions.", "Veuillez répondre aux questions.";
    /// A play was cut short.
    play_interrupted:
        "The clip was interrupted. Please play it again.",
        "La lecture a été interrompue. Veuillez revoir l’extrait.";
    /// A play was not wholly in view.
    play_out_of_view:
        "A part of the clip was not in view. Please play it again with the whole picture on the screen.",
        "Une partie de l’extrait n’était pas visible. Veuillez le revoir avec l’image entière à l’écran.";
    /// A play showed too few frames.
    play_too_slow:
        "The clip did not run smoothly on this device. Please close other pages and programs, then play it once more.",
        "L’extrait n’a pas été fluide sur cet appareil. Fermez d’autres pages et programmes, puis revoyez-le une fois.";
    /// A clip failed.
    clip_failed: "This clip could not be shown.", "Cet extrait n’a pas pu être affiché.";
    /// A picture or a sign-language video of the page failed.
    media_failed:
        "A picture or a video of this page could not be shown.",
        "Une image ou une vidéo de cette page n’a pas pu être affichée.";
    /// Heading while the last answers are sent.
    sending: "Your last answers are being sent", "Vos dernières réponses sont en cours d’envoi";
    /// Below it.
    sending_text:
        "Please keep this page open until it says that everything has arrived.",
        "Veuillez garder cette page ouverte jusqu’à ce qu’elle indique que tout est arrivé.";
    /// Heading of the last page.
    thanks: "Thank you", "Merci";
    /// Text of the last page.
    thanks_text:
        "All your answers have arrived.",
        "Toutes vos réponses sont arrivées.";
    /// Nothing more is to be done on this page.
    can_close: "You can close this page now.", "Vous pouvez fermer cette page.";
    /// What to do with the completion code.
    take_code:
        "Please give this code to the site that sent you here.",
        "Donnez ce code au site qui vous a adressé ici.";
    /// What to do where there is a way back.
    take_way_back:
        "Please go back to the site that sent you here: only then does it know that you have been here.",
        "Veuillez revenir au site qui vous a adressé ici\u{a0}: c’est ainsi qu’il sait que vous êtes venu(e).";
    /// Button: copy the completion code.
    copy_code: "Copy the code", "Copier le code";
    /// The code was copied.
    copied: "Copied", "Copié";
    /// Button: do not go back by itself.
    stay_here: "Stay on this page", "Rester sur cette page";
    /// Heading of what a participant keeps: withdrawal code, number, receipt.
    for_your_records: "For your records", "À conserver";
    /// Label of the participant's number.
    participant_number: "Participant number", "Numéro de participant";
    /// Label of the completion code.
    completion_code: "Completion code", "Code de fin";
    /// Link back to the recruiting site.
    go_back: "Go back to the site that sent you here", "Revenir au site qui vous a adressé ici";
    /// Label of the receipt.
    receipt: "Receipt", "Reçu";
    /// Label of the withdrawal code.
    withdrawal_code: "Withdrawal code", "Code de retrait";
    /// What the withdrawal code is for.
    withdrawal_code_text:
        "Keep the withdrawal code and your number if you might want to have your answers deleted later: give them to the investigator.",
        "Gardez le code de retrait et votre numéro si vous pensez vouloir faire effacer vos réponses plus tard\u{a0}: donnez-les au responsable de l’étude.";
    /// Link to the page where answers are deleted by the withdrawal code.
    delete_by_code: "Have my answers deleted by this code", "Faire effacer mes réponses avec ce code";
    /// The session is being begun.
    beginning: "Just a moment: the study begins.", "Un instant\u{a0}: l’étude commence.";
    /// Button: back to the agreement, after declining.
    back_to_consent: "Back to the agreement", "Revenir à l’accord de participation";
    /// Heading after declining.
    declined: "You chose not to take part", "Vous avez choisi de ne pas participer";
    /// Text after declining.
    declined_text:
        "Nothing more is recorded. You can close this page now.",
        "Rien d’autre n’est enregistré. Vous pouvez fermer cette page.";
    /// Heading while answers are deleted.
    withdrawing: "Your answers are being deleted", "Vos réponses sont en cours d’effacement";
    /// Heading after withdrawal.
    withdrawn: "You have withdrawn", "Vous vous êtes retiré(e) de l’étude";
    /// Text after withdrawal.
    withdrawn_text:
        "Your answers have been deleted. You can close this page now.",
        "Vos réponses ont été effacées. Vous pouvez fermer cette page.";
    /// No script, no network, no graphics: something this page needs is missing.
    cannot_run:
        "This page cannot run in this browser.",
        "Cette page ne peut pas fonctionner dans ce navigateur.";
    /// The connection is lost; answers are kept.
    offline:
        "The connection is lost. Your answers are kept here and will be sent when it is back.",
        "La connexion est perdue. Vos réponses sont gardées ici et seront envoyées à son retour.";
    /// The browser keeps nothing: a reload would lose what waits.
    not_kept:
        "This browser keeps nothing on this device: please do not close or reload the page before the end.",
        "Ce navigateur ne garde rien sur cet appareil\u{a0}: veuillez ne pas fermer ni recharger la page avant la fin.";
    /// The address names no study.
    no_study: "There is no study at this address.", "Il n’y a pas d’étude à cette adresse.";
    /// The server cannot be reached.
    unreachable:
        "The study cannot be reached. Please check the connection and try again.",
        "L’étude est injoignable. Vérifiez la connexion et réessayez.";
    /// The server does not let this participant begin.
    cannot_begin: "You cannot take part now.", "Vous ne pouvez pas participer pour l’instant.";
    /// Heading: the session is open in another tab.
    other_tab: "This study is open in another tab", "Cette étude est ouverte dans un autre onglet";
    /// What to do about it.
    other_tab_text:
        "Please go on there, or close that tab and try again here.",
        "Continuez dans cet autre onglet, ou fermez-le et réessayez ici.";
    /// Button: the order of a ranking is right as it stands.
    confirm_order: "This is my order", "C’est mon classement";
    /// Button beside an item of a ranking, before the item's name.
    move_up: "Move up:", "Monter\u{a0}:";
    /// Button beside an item of a ranking, before the item's name.
    move_down: "Move down:", "Descendre\u{a0}:";
    /// Answer of a comparison: the clip on the left.
    left_one: "The left one", "Celui de gauche";
    /// Answer of a comparison: the clip on the right.
    right_one: "The right one", "Celui de droite";
    /// Answer of a comparison: no difference.
    both_alike: "No difference", "Aucune différence";
    /// Group of answers: which of the options is best.
    best: "Best", "Le meilleur";
    /// Group of answers: which of the options is worst.
    worst: "Worst", "Le pire";
    /// Button: another person takes part in the same browser.
    another_person: "Start again for another person", "Recommencer pour une autre personne";
    /// Button: the answers as a file, where there is no server.
    download: "Download my answers", "Télécharger mes réponses";
    /// Heading while the device is looked at.
    device_heading: "Your screen", "Votre écran";
    /// The device is being looked at.
    device_measuring:
        "Just a moment: looking at your screen.",
        "Un instant\u{a0}: examen de votre écran.";
    /// Nothing is missing.
    device_fine: "Everything is fine. You can go on.", "Tout va bien. Vous pouvez continuer.";
    /// Something is missing.
    device_lacks:
        "This study cannot be shown here yet:",
        "Cette étude ne peut pas encore être présentée ici\u{a0}:";
    /// Nothing is missing, and the page is to fill the screen.
    device_fullscreen:
        "The study fills the whole screen. The Escape key leaves it.",
        "L’étude occupe tout l’écran. La touche Échap permet d’en sortir.";
    /// Button: fill the screen and go on.
    enter_fullscreen: "Go on in full screen", "Continuer en plein écran";
    /// Button: go on without.
    without_fullscreen: "Go on without full screen", "Continuer sans plein écran";
    /// A clip waits for the full screen.
    fullscreen_first:
        "This study is shown in full screen. Please go back to it, then play the clip.",
        "Cette étude se déroule en plein écran. Revenez-y, puis lancez l’extrait.";
    /// Button: back to the full screen.
    back_to_fullscreen: "Back to full screen", "Revenir en plein écran";
    /// Button: measure again.
    device_again: "Look again", "Examiner à nouveau";
    /// Button: what is missing cannot be put right.
    device_give_up: "I cannot change this: end here", "Je ne peux pas changer cela\u{a0}: terminer ici";
    /// Heading of the calibration.
    calibration_heading: "The size of your screen", "La taille de votre écran";
    /// What to do with the card.
    card_instruction:
        "Hold a bank card (or any card of that size) against the screen and make the picture exactly as large. Nothing on the card is read or recorded.",
        "Tenez une carte bancaire (ou toute carte de ce format) contre l’écran et donnez à l’image exactement la même taille. Rien de la carte n’est lu ni enregistré.";
    /// Label of the slider.
    card_label: "Width of the picture", "Largeur de l’image";
    /// Button: a little smaller.
    card_smaller: "Smaller", "Plus petit";
    /// Button: a little larger.
    card_larger: "Larger", "Plus grand";
    /// Button: no card at hand.
    no_card: "I have no card at hand", "Je n’ai pas de carte sous la main";
    /// The picture was not adjusted.
    card_missing:
        "Please make the picture as large as the card.",
        "Veuillez donner à l’image la taille de la carte.";
    /// Button: the picture is right.
    calibrated: "The size is right", "La taille est juste";
    /// How far the participant sits.
    distance_label:
        "How far are your eyes from the screen?",
        "À quelle distance de l’écran sont vos yeux\u{a0}?";
    /// A distance that cannot be.
    distance_problem:
        "Please write a distance from 15 to 300 cm.",
        "Veuillez indiquer une distance de 15 à 300 cm.";
    /// Heading: every answer was right.
    feedback_right: "That is right", "C’est juste";
    /// Heading: not every answer was right.
    feedback_wrong: "Not quite", "Pas tout à fait";
    /// Practice is over.
    practice_over:
        "This was the last practice clip.",
        "C’était le dernier extrait d’entraînement.";
    /// Button: more time.
    more_time: "More time", "Plus de temps";
    /// The time was over.
    time_over:
        "The time was over; your answers so far were sent.",
        "Le temps était écoulé\u{a0}; vos réponses ont été envoyées telles quelles.";
    /// Heading: the study does not take this participant.
    screened_out:
        "You cannot take part in this study",
        "Vous ne pouvez pas participer à cette étude";
    /// Too few practice clips were answered right.
    screened_out_training:
        "The practice clips were not answered as the study needs it.",
        "Les extraits d’entraînement n’ont pas été réussis comme l’étude le demande.";
    /// The device shows too few frames.
    screened_out_frames:
        "The clips do not run smoothly enough on this device, so that your answers could not be compared with those of others. This is not your fault.",
        "Les extraits ne sont pas assez fluides sur cet appareil pour que vos réponses soient comparables à celles des autres. Vous n’y êtes pour rien.";
    /// What becomes of somebody who was screened out.
    screened_out_text:
        "Thank you for your time. Nothing more is asked of you.",
        "Merci de votre temps. Rien d’autre ne vous est demandé.";
    /// Heading: too many attention checks were failed.
    checks_failed: "The study ends here", "L’étude se termine ici";
}
made {
    /// "Clip 3 of 12".
    trial_of: "Clip {number} of {of}", "Extrait {number} sur {of}";
    /// "Practice clip 1 of 2".
    training_of: "Practice clip {number} of {of}", "Extrait d’entraînement {number} sur {of}";
    /// Button: play one clip of a panel.
    play_alone: "Play {name}", "Revoir {name}";
    /// The answers are in this browser alone.
    kept_here:
        "Your answers are kept in this browser only. Please download them and send the file to the investigator: {email}.",
        "Vos réponses sont gardées dans ce navigateur seulement. Téléchargez-les et envoyez le fichier au responsable de l’étude\u{a0}: {email}.";
    /// Who may take part.
    minimum_age:
        "You must be at least {years} years old to take part.",
        "Il faut avoir au moins {years} ans pour participer.";
    /// The page goes back by itself.
    go_back_in: "You go back by itself in {seconds} s.", "Retour automatique dans {seconds} s.";
    /// Why something could not be shown.
    failed_connection:
        "The connection broke off. It is fetched by itself when the connection is back; you can also try again.",
        "La connexion s’est interrompue. Le chargement reprendra de lui-même à son retour\u{a0}; vous pouvez aussi réessayer.";
    /// Why something could not be shown.
    failed_stalled:
        "Nothing arrived for {seconds} s. Please check the connection and try again.",
        "Rien n’est arrivé pendant {seconds} s. Vérifiez la connexion et réessayez.";
    /// Why something could not be shown.
    failed_refused:
        "The server does not give it out (answer {status}). Try again in a moment.",
        "Le serveur ne le fournit pas (réponse {status}). Réessayez dans un instant.";
    /// Why something could not be shown.
    failed_damaged:
        "It arrived damaged. Please check the connection and try again.",
        "Il est arrivé endommagé. Vérifiez la connexion et réessayez.";
    /// Why something could not be shown.
    failed_missing:
        "The server does not have it. Please write to the investigator.",
        "Le serveur ne l’a pas. Écrivez au responsable de l’étude.";
    /// Why something could not be shown.
    failed_module:
        "A part of this page could not be loaded. Please check the connection and try again, or reload the page.",
        "Une partie de cette page n’a pas pu être chargée. Vérifiez la connexion et réessayez, ou rechargez la page.";
    /// Why something could not be shown.
    failed_no_graphics:
        "This browser cannot draw the animations. Use a current Chrome, Edge, Firefox or Safari with hardware acceleration switched on.",
        "Ce navigateur ne peut pas dessiner les animations. Utilisez une version récente de Chrome, Edge, Firefox ou Safari, avec l’accélération matérielle activée.";
    /// Why something could not be shown.
    failed_graphics_lost:
        "The graphics of this device stopped. Close other pages and programs, then try again.",
        "L’affichage graphique de cet appareil s’est arrêté. Fermez d’autres pages et programmes, puis réessayez.";
    /// Why something could not be shown.
    failed_solver:
        "The animation could not be computed. Please try again, or reload the page.",
        "L’animation n’a pas pu être calculée. Réessayez, ou rechargez la page.";
    /// Why something could not be shown.
    failed_solver_silent:
        "The animation was not computed within {seconds} s. Close other pages and programs, then try again.",
        "L’animation n’a pas été calculée en {seconds} s. Fermez d’autres pages et programmes, puis réessayez.";
    /// Why something could not be shown.
    failed_video:
        "This browser cannot play the video. Try another browser.",
        "Ce navigateur ne peut pas lire la vidéo. Essayez un autre navigateur.";
    /// Why something could not be shown.
    failed_picture:
        "This browser cannot read a picture of the face. Try another browser.",
        "Ce navigateur ne peut pas lire une image du visage. Essayez un autre navigateur.";
    /// Why something could not be shown.
    failed_picture_hidden:
        "This browser hides pictures from pages (its protection against fingerprinting). Allow this page to read canvases, or use another browser.",
        "Ce navigateur cache les images aux pages (protection contre le pistage). Autorisez cette page à lire les canevas, ou utilisez un autre navigateur.";
    /// Why something could not be shown.
    failed_memory:
        "There is not enough memory for a picture of the face. Close other pages and programs, then try again.",
        "La mémoire ne suffit pas pour une image du visage. Fermez d’autres pages et programmes, puis réessayez.";
    /// Why something could not be shown.
    failed_unknown:
        "Something unexpected happened. Please try again, or reload the page.",
        "Une erreur inattendue est survenue. Réessayez, ou rechargez la page.";
    /// A break lasts so long.
    wait_seconds: "You can go on in {seconds} s.", "Vous pourrez continuer dans {seconds} s.";
    /// What to correct in an answer.
    answer_missing: "Please answer this question.", "Veuillez répondre à cette question.";
    /// What to correct in an answer.
    answer_not_an_option: "Please choose an answer.", "Veuillez choisir une réponse.";
    /// What to correct in an answer.
    answer_not_a_number: "Please write a number.", "Veuillez écrire un nombre.";
    /// What to correct in an answer.
    answer_not_whole: "Please write a whole number.", "Veuillez écrire un nombre entier.";
    /// What to correct in an answer.
    answer_too_low: "The lowest number is {least}.", "Le minimum est {least}.";
    /// What to correct in an answer.
    answer_too_high: "The highest number is {most}.", "Le maximum est {most}.";
    /// What to correct in an answer.
    answer_too_long:
        "Please write at most {most} characters.",
        "Veuillez ne pas dépasser {most} caractères.";
    /// What to correct in an answer.
    answer_too_few: "Please choose at least {least}.", "Veuillez en choisir au moins {least}.";
    /// What to correct in an answer.
    answer_too_many: "Please choose at most {most}.", "Veuillez en choisir au plus {most}.";
    /// What to correct in an answer.
    answer_incomplete: "Please complete this answer.", "Veuillez compléter cette réponse.";
    /// What the device lacks, or what to do about it.
    lacks_width:
        "The window is {found} pixels wide; the study needs {least}.",
        "La fenêtre fait {found} pixels de large\u{a0}; il en faut {least}.";
    /// What the device lacks, or what to do about it.
    lacks_width_remedy:
        "Make the window wider, or the page's zoom smaller (Ctrl and −); this page notices by itself.",
        "Élargissez la fenêtre ou réduisez le zoom de la page (Ctrl et −)\u{a0}; cette page le remarque d’elle-même.";
    /// What the device lacks, or what to do about it.
    lacks_height:
        "The window is {found} pixels high; the study needs {least}.",
        "La fenêtre fait {found} pixels de haut\u{a0}; il en faut {least}.";
    /// What the device lacks, or what to do about it.
    lacks_height_remedy:
        "Make the window higher, or the page's zoom smaller (Ctrl and −); this page notices by itself.",
        "Agrandissez la fenêtre ou réduisez le zoom de la page (Ctrl et −)\u{a0}; cette page le remarque d’elle-même.";
    /// What the device lacks, or what to do about it.
    lacks_computer:
        "The study needs a computer with a mouse or a touch pad.",
        "L’étude demande un ordinateur avec une souris ou un pavé tactile.";
    /// What the device lacks, or what to do about it.
    lacks_computer_remedy:
        "Open the address of this page on a computer.",
        "Ouvrez l’adresse de cette page sur un ordinateur.";
    /// What the device lacks, or what to do about it.
    lacks_graphics:
        "This browser cannot draw the animations.",
        "Ce navigateur ne peut pas dessiner les animations.";
    /// What the device lacks, or what to do about it.
    lacks_graphics_remedy:
        "Try a current Chrome, Edge, Firefox or Safari with hardware acceleration switched on.",
        "Essayez une version récente de Chrome, Edge, Firefox ou Safari, avec l’accélération matérielle activée.";
    /// What the device lacks, or what to do about it.
    lacks_refresh:
        "The screen shows {found} frames a second; the study needs {least}.",
        "L’écran affiche {found} images par seconde\u{a0}; il en faut {least}.";
    /// What the device lacks, or what to do about it.
    lacks_refresh_remedy:
        "Close other programs, plug the computer in, then look again.",
        "Fermez les autres programmes, branchez l’ordinateur au secteur, puis examinez à nouveau.";
    /// What the device lacks, or what to do about it.
    lacks_fullscreen:
        "This browser allows no full screen.",
        "Ce navigateur ne permet pas le plein écran.";
    /// What the device lacks, or what to do about it.
    lacks_fullscreen_remedy:
        "Open the address of this page on a computer.",
        "Ouvrez l’adresse de cette page sur un ordinateur.";
    /// Where to sit.
    distance_stated:
        "Please sit about {centimetres} cm from the screen, and stay there.",
        "Veuillez vous placer à environ {centimetres} cm de l’écran, et y rester.";
    /// What was answered.
    feedback_given: "You answered: {answer}", "Votre réponse\u{a0}: {answer}";
    /// Nothing was answered.
    feedback_none: "You gave no answer.", "Vous n’avez pas répondu.";
    /// What is right.
    feedback_answer: "Right is: {answer}", "La bonne réponse\u{a0}: {answer}";
    /// The round was not good enough and begins again.
    practise_again:
        "{right} of {of} clips were right. The practice begins again.",
        "{right} extraits sur {of} étaient justes. L’entraînement recommence.";
    /// How much time is left, below a minute.
    seconds_left: "Time left: {seconds} s", "Temps restant\u{a0}: {seconds} s";
    /// How much time is left.
    minutes_left:
        "Time left: {minutes} min {seconds} s",
        "Temps restant\u{a0}: {minutes} min {seconds} s";
    /// There will be a limit.
    time_limit:
        "After the clip you will have {seconds} s to answer.",
        "Après l’extrait, vous aurez {seconds} s pour répondre.";
    /// The end is near, and more time can be had.
    time_warning_extendable:
        "The time is nearly over. Press “More time” if you need it.",
        "Le temps est presque écoulé. Appuyez sur «\u{a0}Plus de temps\u{a0}» si besoin.";
    /// The end is near.
    time_warning: "The time is nearly over.", "Le temps est presque écoulé.";
    /// Too many attention checks were failed.
    checks_failed_text:
        "You answered {failed} questions that check attention otherwise than they asked. Your answers have arrived.",
        "Vous avez répondu autrement que demandé à {failed} questions qui vérifient l’attention. Vos réponses sont bien arrivées.";
    /// Why somebody cannot begin.
    refused_already_took_part:
        "You have already taken part in this study.",
        "Vous avez déjà participé à cette étude.";
    /// And what can be done.
    refused_already_took_part_remedy:
        "Everybody can take part once. Thank you! If this is a mistake, write to the investigator.",
        "On ne peut y participer qu’une fois. Merci\u{a0}! Si c’est une erreur, écrivez au responsable de l’étude.";
    /// Why somebody cannot begin.
    refused_study_full:
        "The study has enough participants for now.",
        "L’étude a assez de participants pour l’instant.";
    /// And what can be done.
    refused_study_full_remedy:
        "A place may become free: try again later. Thank you for your interest.",
        "Une place peut se libérer\u{a0}: réessayez plus tard. Merci de votre intérêt.";
    /// Why somebody cannot begin.
    refused_study_not_open: "The study is not open yet.", "L’étude n’est pas encore ouverte.";
    /// And what can be done.
    refused_study_not_open_remedy:
        "Come back at the announced time.",
        "Revenez à la date annoncée.";
    /// Why somebody cannot begin.
    refused_study_closed: "The study is over.", "L’étude est terminée.";
    /// And what can be done.
    refused_study_closed_remedy: "Thank you for your interest.", "Merci de votre intérêt.";
    /// Why somebody cannot begin.
    refused_no_identifier:
        "The address does not say who you are.",
        "L’adresse ne dit pas qui vous êtes.";
    /// And what can be done.
    refused_no_identifier_remedy:
        "Go back to the site that sent you here and follow its link.",
        "Revenez au site qui vous a adressé ici et suivez son lien.";
    /// Why nobody begins by this address.
    unknown_condition:
        "The address asks for the condition “{name}”; the study has: {conditions}.",
        "L’adresse demande la condition «\u{a0}{name}\u{a0}»\u{a0}; l’étude a\u{a0}: {conditions}.";
    /// And what can be done.
    unknown_condition_remedy:
        "Please write to whoever sent you the link.",
        "Écrivez à qui vous a envoyé le lien.";
    /// What the server refuses.
    refused_unknown_study:
        "There is no such study here. Check the address, or ask whoever gave it to you.",
        "Cette étude n’existe pas ici. Vérifiez l’adresse ou demandez à la personne qui vous l’a donnée.";
    /// What the server refuses.
    refused_unknown_session:
        "This session is not known here any more. Reload the page to begin anew.",
        "Cette session n’est plus connue ici. Rechargez la page pour recommencer.";
    /// What the server refuses.
    refused_withdrawn:
        "You have withdrawn from this study; your answers were deleted.",
        "Vous vous êtes retiré(e) de cette étude\u{a0}; vos réponses ont été effacées.";
    /// What the server refuses.
    refused_event_conflict:
        "This session went on in another window. Reload the page to go on from there.",
        "Cette session a continué dans une autre fenêtre. Rechargez la page pour la reprendre.";
    /// What the server refuses.
    refused_missing_events:
        "Some answers have not arrived yet. Keep this page open; they are sent again.",
        "Certaines réponses ne sont pas encore arrivées. Gardez cette page ouverte\u{a0}; elles sont renvoyées.";
    /// What the server refuses.
    refused_wrong_withdrawal_code:
        "This withdrawal code does not belong to the session.",
        "Ce code de retrait n’est pas celui de la session.";
    /// What the server refuses.
    refused_too_large:
        "An answer is too long to be stored. Shorten it and try again.",
        "Une réponse est trop longue pour être enregistrée. Raccourcissez-la et réessayez.";
    /// What the server refuses.
    refused_bad_request:
        "The server does not understand this page. Reload it; if that does not help, write to the investigator.",
        "Le serveur ne comprend pas cette page. Rechargez-la\u{a0}; si cela ne change rien, écrivez au responsable de l’étude.";
    /// What the server refuses.
    refused_unavailable:
        "The server cannot store answers now. They are kept here and sent again.",
        "Le serveur ne peut pas enregistrer de réponses pour l’instant. Elles sont gardées ici et seront renvoyées.";
    /// What the server refuses.
    refused_internal:
        "Something went wrong on the server. Your answers are kept here. Reload the page in a moment.",
        "Une erreur est survenue sur le serveur. Vos réponses sont gardées ici. Rechargez la page dans un instant.";
}
}
