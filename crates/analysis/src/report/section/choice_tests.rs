//! What tests say of the choices between the levels of a factor: table of tests, worths, their ranking, pairs, and
//! whether the model describes the choices.

use mimique_locale::Language;
use mimique_report::document::{Block, DataTable, slug};
use mimique_report::figure::ranking;
use mimique_stats::{BradleyTerry, Outcome, PairedComparisons, Thurstone, WorthEstimates};

use crate::choices::reading::{self, chosen_in};
use crate::choices::tested::{self, ChoiceTests};
use crate::naming::people_counted;
use crate::report::section::Writer;
use crate::report::tables;
use crate::trials::asked_question::AskedQuestion;
use crate::trials::measure::MeasureKind;

impl Writer<'_> {
    /// Tests of the choices between the levels of a factor, and what they say.
    pub(crate) fn choice_tests(
        &mut self,
        asked: &AskedQuestion<'_>,
        factor: &str,
        data: &PairedComparisons,
    ) -> ChoiceTests {
        let language = self.language();
        let found = tested::tested(&asked.id, factor, data, tested::FIT_ROUNDS);
        let shown = self.naming.factor(factor);
        let id = format!("{}-choices-{}", slug(&asked.id), slug(factor));
        self.blocks.push(Block::Heading(
            3,
            language.pick(format!("Choices by {shown}"), format!("Choix par {shown}")),
        ));
        let table = self.sides(&id, factor, data);
        self.blocks.push(Block::Table(table));
        let mut table = tables::two_columns(
            &self.naming,
            format!("{id}-tests"),
            language.pick(
                format!(
                    "Tests of choices by {shown}: answers taken for independent, and recommended"
                ),
                format!(
                    "Tests des choix par {shown} : réponses supposées indépendantes, et recommandé"
                ),
            ),
            factor,
            MeasureKind::Choice,
            &found.as_in_the_thesis,
            &found.recommended,
        );
        tables::headings_of_choices(language, &mut table);
        self.blocks.push(Block::Table(table));
        if let Some(worths) = &found.worths {
            self.worths(&id, factor, worths, found.thurstone.as_ref());
        }
        let label = asked.label(language.code());
        let words = reading::choices(&self.naming, &found, factor, &label);
        self.blocks.push(Block::Reading(words));
        found
    }

    /// Every two levels in each order in which they were shown.
    fn sides(&self, id: &str, factor: &str, data: &PairedComparisons) -> DataTable {
        let language = self.language();
        let caption = language.pick("Choices by pair and side", "Choix par paire et par côté");
        let columns = language.pick(
            ["left", "right", "left chosen", "no difference", "right chosen", "trials"],
            ["gauche", "droite", "gauche choisi", "sans différence", "droite choisi", "essais"],
        );
        let mut table = DataTable::new(format!("{id}-sides"), caption, columns);
        for own in data.presentations() {
            let names =
                [own.left, own.right].map(|item| self.naming.level(factor, &data.items[item]));
            let [left, same, right] = own.counts;
            let counts = [left, same, right, left + same + right].map(|count| count.to_string());
            table.row(names.into_iter().chain(counts));
        }
        table
    }

    /// Worths of levels: their ranking, every two of them, and whether the model describes the choices.
    pub(crate) fn worths(
        &mut self,
        id: &str,
        factor: &str,
        worths: &BradleyTerry,
        thurstone: Option<&Thurstone>,
    ) {
        let language = self.language();
        let named: Vec<String> =
            worths.items.iter().map(|item| self.naming.level(factor, item)).collect();
        if named.len() > 2 {
            let table = self.shares(id, &named, worths);
            self.blocks.push(Block::Table(table));
        }
        let shown = self.naming.factor(factor);
        match (&worths.estimates, &worths.penalised) {
            (Outcome::Ok(found), _) => {
                let model = model_in_words(language, found);
                let caption = language.pick(
                    format!("Ranking by {shown}: worths ({model}) with 95 % intervals"),
                    format!("Classement par {shown} : valeurs ({model}) et intervalles à 95 %"),
                );
                let ranked = found.in_jnd().into_iter().zip(&named);
                let ranked: Vec<_> =
                    ranked.map(|((jnd, ends), name)| (name.clone(), jnd, ends)).collect();
                self.figure(ranking(language, &format!("{id}-ranking"), &caption, &ranked));
                let table = self.table_of_worths(id, &named, found, thurstone);
                self.blocks.push(Block::Table(table));
                let table = self.contrasts(id, factor, found);
                self.blocks.push(Block::Table(table));
                self.beside_the_worths(found);
            }
            (Outcome::Undefined { .. }, Some(found)) => {
                let caption = language.pick(
                    "Worths, penalised (Firth 1993): by maximum likelihood they have no finite estimate; no interval, no p",
                    "Valeurs, pénalisées (Firth 1993) : par maximum de vraisemblance elles n’ont pas d’estimation finie ; ni intervalle, ni p",
                );
                let columns = language.pick(
                    ["level", "worth", "standard error"],
                    ["niveau", "valeur", "erreur type"],
                );
                let mut table = DataTable::new(format!("{id}-worths"), caption, columns);
                for ((name, worth), se) in named.iter().zip(&found.worth).zip(&found.se_model) {
                    table.row([name.clone(), language.fixed(*worth, 3), language.fixed(*se, 3)]);
                }
                self.blocks.push(Block::Table(table));
            }
            (Outcome::Undefined { .. }, None) => {}
        }
    }

    /// How often the level of the row was chosen over that of the column.
    fn shares(&self, id: &str, named: &[String], worths: &BradleyTerry) -> DataTable {
        let language = self.language();
        let caption = language.pick(
            "Share of choices of the row over the column, where one was chosen",
            "Part des choix de la ligne plutôt que de la colonne, quand l’une a été choisie",
        );
        let columns = std::iter::once(String::new()).chain(named.iter().cloned());
        let mut table = DataTable::new(format!("{id}-shares"), caption, columns);
        for (name, own) in named.iter().zip(&worths.shares) {
            let cells = own
                .iter()
                .map(|share| share.map_or_else(|| "–".to_owned(), |share| language.percent(share)));
            table.row(std::iter::once(name.clone()).chain(cells));
        }
        table
    }

    fn table_of_worths(
        &self,
        id: &str,
        named: &[String],
        found: &WorthEstimates,
        thurstone: Option<&Thurstone>,
    ) -> DataTable {
        let language = self.language();
        let caption = language.pick(
            "Worths: log scale with sum 0, errors clustered by participant; in just noticeable differences (JND), beside those of Thurstone’s case V",
            "Valeurs : échelle logarithmique de somme 0, erreurs groupées par participant ; en différences juste perceptibles (JND), avec celles du cas V de Thurstone",
        );
        let columns = language.pick(
            ["level", "worth", "standard error", "JND", "95 % interval (JND)", "JND (Thurstone V)"],
            [
                "niveau",
                "valeur",
                "erreur type",
                "JND",
                "intervalle à 95 % (JND)",
                "JND (Thurstone V)",
            ],
        );
        let mut table = DataTable::new(format!("{id}-worths"), caption, columns);
        let number = |value: Option<f64>| {
            value.map_or_else(|| "–".to_owned(), |value| language.fixed(value, 3))
        };
        for (item, (jnd, ends)) in found.in_jnd().into_iter().enumerate() {
            let interval = ends.map_or_else(
                || "–".to_owned(),
                |[low, high]| format!("{} – {}", language.fixed(low, 3), language.fixed(high, 3)),
            );
            table.row([
                named[item].clone(),
                language.fixed(found.worth[item], 3),
                number(found.se_cluster.as_ref().map(|se| se[item])),
                language.fixed(jnd, 3),
                interval,
                number(thurstone.map(|own| own.jnd[item])),
            ]);
        }
        table
    }

    /// Every two levels.
    fn contrasts(&self, id: &str, factor: &str, found: &WorthEstimates) -> DataTable {
        let language = self.language();
        let caption = language.pick(
            "All pairs: difference of worths, share of decided choices of the first (95 %), t test clustered by participant, Holm’s correction",
            "Toutes les paires : différence des valeurs, part des choix tranchés pour le premier (95 %), test t groupé par participant, correction de Holm",
        );
        let columns = language.pick(
            ["pair", "JND", "first chosen", "p", "p (Holm)"],
            ["paire", "JND", "premier choisi", "p", "p (Holm)"],
        );
        let mut table = DataTable::new(format!("{id}-pairs"), caption, columns);
        let cell =
            |p: Option<f64>| p.map_or_else(|| "–".to_owned(), |p| language.p_cell(p, p.ln()));
        for contrast in &found.contrasts {
            table.row([
                self.naming.pair(factor, &contrast.a, &contrast.b),
                language.fixed(contrast.jnd, 3),
                chosen_in(language, contrast, true),
                cell(contrast.p),
                cell(contrast.p_holm),
            ]);
        }
        table
    }

    /// Side bias, ties, and whether the model describes the choices.
    fn beside_the_worths(&mut self, found: &WorthEstimates) {
        let language = self.language();
        let mut words = Vec::new();
        if let Some(side) = &found.side {
            let (share, p) = (1.0 / (1.0 + (-side.estimate).exp()), found.lr_side.map(|own| own.p));
            let p = p.map_or_else(String::new, |p| format!(", {}", language.p(p)));
            let share = language.percent(share);
            words.push(language.pick(
                format!("Side: of two equal clips the one on the left is chosen in {share} of decided choices{p} (likelihood ratio, answers taken for independent)."),
                format!("Côté : de deux extraits égaux, celui de gauche est choisi dans {share} des choix tranchés{p} (rapport de vraisemblance, réponses supposées indépendantes)."),
            ));
        }
        if let Some(nu) = found.tie.as_ref().and_then(|tie| tie.nu) {
            let share = language.percent(nu / (2.0 + nu));
            words.push(language.pick(
                format!("Ties (Davidson): of two equal clips no difference is seen in {share} of answers."),
                format!("Égalités (Davidson) : entre deux extraits égaux, aucune différence n’est vue dans {share} des réponses."),
            ));
        }
        let fit = &found.lack_of_fit;
        if let Some(p) = fit.p_drawn.map(|[g2, _]| g2).or(fit.p_G2) {
            let (g2, df, p_words) = (language.number(fit.G2), fit.df, language.p(p));
            words.push(language.pick(
                format!("Lack of fit: G² = {g2}, df = {df}, {p_words}."),
                format!("Défaut d’ajustement : G² = {g2}, ddl = {df}, {p_words}."),
            ));
            if p < 0.05 {
                self.blocks.push(Block::Caution(language.pick(
                    "One worth per level does not describe these choices: read the table of pairs and sides, not the ranking alone.",
                    "Une valeur par niveau ne décrit pas ces choix : lisez le tableau des paires et des côtés, et pas seulement le classement.",
                ).to_owned()));
            }
        }
        if found.worth_interval.is_some() {
            words.push(language.pick(
                "Intervals at 95 % are those of the t tests, with errors clustered by participant.".to_owned(),
                "Les intervalles à 95 % sont ceux des tests t, à erreurs groupées par participant.".to_owned(),
            ));
        }
        self.blocks.push(Block::Paragraph(words.join(" ")));
    }

    /// Whether each person, and all of them, choose consistently.
    pub(crate) fn consistency(&mut self, found: &ChoiceTests) {
        let language = self.language();
        let Some(found) = found.consistency.as_ref().filter(|found| found.items.len() > 2) else {
            return;
        };
        let circular: usize = found.people.iter().map(|person| person.circular_triads).sum();
        let most: usize = found.people.iter().map(|person| person.most).sum();
        let u = language.fixed(found.u, 2);
        let p = found.p.map_or_else(String::new, |p| format!(" ({})", language.p(p)));
        let judges = found.judges;
        self.blocks.push(Block::Paragraph(language.pick(
            format!("Consistency (Kendall and Babington Smith): {circular} circular triads of at most {most} among {}; agreement between them u = {u}{p}.", people_counted(language, judges)),
            format!("Cohérence (Kendall et Babington Smith) : {circular} triades circulaires sur {most} au plus parmi {} ; accord entre elles u = {u}{p}.", people_counted(language, judges)),
        )));
    }
}

/// What was fitted.
fn model_in_words(language: Language, found: &WorthEstimates) -> String {
    let mut words = language.pick("Bradley-Terry model", "modèle de Bradley-Terry").to_owned();
    if found.tie.is_some() {
        words += language.pick(", Davidson’s ties", ", égalités de Davidson");
    }
    if found.side.is_some() {
        words += language.pick(", side bias", ", biais de côté");
    }
    words
}
