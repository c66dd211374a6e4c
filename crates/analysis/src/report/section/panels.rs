//! Panels: whom BS.1534 leaves out, how the conditions are rated, and how they are ordered on the page.

use std::collections::BTreeMap;

use mimique_report::document::{Block, DataTable, slug};
use mimique_stats::{
    BradleyTerry, BradleyTerryOptions, Chosen, Compared, Outcome, PairedComparisons,
    ScreenedPerson, bradley_terry,
};
use mimique_study::PanelComponent;
use serde::Serialize;

use crate::choices::tested::FIT_ROUNDS;
use crate::hypothesis::call::{Call, Design};
use crate::hypothesis::comparison::{Comparison, within};
use crate::hypothesis::reading;
use crate::hypothesis::test_line::TestLine;
use crate::hypothesis::undefined::TestOutcome;
use crate::naming::people_counted;
use crate::report::figure;
use crate::report::section::Writer;
use crate::report::section::measures::values_by_level;
use crate::report::tables;
use crate::trials::asked_question::AskedQuestion;
use crate::trials::measure::Measure;
use crate::trials::screening::Screening;

/// What was found of a block of panels.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct PanelResult {
    pub block: String,
    pub response: String,
    /// Whom BS.1534 leaves out; none without a hidden reference.
    pub screening: Option<Screening>,
    /// The conditions without reference and anchor; none of fewer than two.
    pub conditions: Option<Comparison>,
    /// Worths by the order of the ratings on each page, and their test; none where the model has no such data.
    pub order: Option<PageOrder>,
}

/// Which conditions were rated higher on the same page.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct PageOrder {
    /// Equal worths, participants being clusters.
    pub test: TestOutcome,
    pub worths: BradleyTerry,
}

impl Writer<'_> {
    /// Every block of panels of the study.
    pub(crate) fn panels(&mut self, measures: &[(AskedQuestion<'_>, Measure)]) {
        let blocks: Vec<(String, PanelComponent)> =
            self.study.panel_blocks().map(|(name, block)| (name.to_owned(), block)).collect();
        for (name, block) in blocks {
            if let Some((_, measure)) = measures.iter().find(|(own, _)| own.id == block.question) {
                self.panel(&name, &block, measure);
            }
        }
    }

    fn panel(&mut self, name: &str, block: &PanelComponent, measure: &Measure) {
        let language = self.language();
        let id = format!("panel-{}", slug(name));
        self.blocks.push(Block::Heading(
            2,
            language.pick(
                format!("Panel {name}: {}", measure.label),
                format!("Panel {name} : {}", measure.label),
            ),
        ));
        let screening = self.export.screening.iter().find(|own| own.block == name).cloned();
        if let Some(screening) = &screening {
            self.screening(&id, screening);
        }
        let all = measure.factor(self.export, &block.compare, &[]);
        let (matched, matched_factor) = measure.matched(self.export, &all);
        let rows: Vec<(String, Vec<f64>)> = values_by_level(&matched, &matched_factor)
            .into_iter()
            .map(|(level, values)| (self.condition(block, &level), values))
            .collect();
        let caption = language.pick("Ratings of each condition", "Notes de chaque condition");
        let drawing =
            figure::boxes(language, &format!("{id}-boxes"), caption, &measure.label, &rows);
        self.figure(drawing);
        let is_control =
            |level: &String| [&block.reference, &block.anchor].contains(&&Some(level.clone()));
        let compared: Vec<String> =
            all.levels.iter().filter(|level| !is_control(level)).cloned().collect();
        let conditions = (compared.len() >= 2).then(|| {
            let factor = measure.factor(self.export, &block.compare, &compared);
            within(self.export, measure, &factor)
        });
        if let Some(found) = &conditions {
            self.panel_tests(&id, block, measure, found);
        }
        let order = self.page_order(&id, block, measure, &all.levels);
        self.results.panels.push(PanelResult {
            block: name.to_owned(),
            response: block.question.clone(),
            screening,
            conditions,
            order,
        });
    }

    /// A condition by its name, reference and anchor said.
    fn condition(&self, block: &PanelComponent, level: &str) -> String {
        let name = self.naming.level(&block.compare, level);
        let is = |control: &Option<String>| control.as_deref() == Some(level);
        let role = if is(&block.reference) {
            self.language().pick("hidden reference", "référence cachée")
        } else if is(&block.anchor) {
            self.language().pick("anchor", "ancre")
        } else {
            return name;
        };
        format!("{name} ({role})")
    }

    /// Whom the rule of BS.1534 leaves out.
    fn screening(&mut self, id: &str, screening: &Screening) {
        let language = self.language();
        let found = &screening.found;
        let out: Vec<&ScreenedPerson> =
            found.people.iter().filter(|person| person.excluded).collect();
        let of = people_counted(language, found.people.len());
        let count = out.len();
        self.blocks.push(Block::Paragraph(match screening.applied {
            true => language.pick(
                format!("ITU-R BS.1534-3 (section 4.1.2) leaves {count} of {of} out of the analysis, who rate the hidden reference below 90, or the anchor above 90, on more than 15 % of the pages."),
                format!("L’UIT-R BS.1534-3 (section 4.1.2) écarte de l’analyse {count} sur {of}, pour avoir noté la référence cachée au-dessous de 90, ou l’ancre au-dessus de 90, sur plus de 15 % des pages."),
            ),
            false => language.pick(
                format!("ITU-R BS.1534-3 (section 4.1.2) would leave out {count} of {of}, who rate the hidden reference below 90, or the anchor above 90, on more than 15 % of the pages. The study file does not apply the rule, and nobody is left out by it."),
                format!("L’UIT-R BS.1534-3 (section 4.1.2) écarterait {count} sur {of}, pour avoir noté la référence cachée au-dessous de 90, ou l’ancre au-dessus de 90, sur plus de 15 % des pages. Le fichier de l’étude n’applique pas cette règle ; personne n’est écarté par elle."),
            ),
        }));
        let without = found.segments_without_anchor_rule.join(", ");
        if !without.is_empty() {
            self.blocks.push(Block::Paragraph(language.pick(
                format!("The rule about the anchor does not count on {without}: over 25 % of people put the anchor above 90 there."),
                format!("La règle sur l’ancre ne compte pas pour {without} : plus de 25 % des personnes y mettent l’ancre au-dessus de 90."),
            )));
        }
        if out.is_empty() {
            return;
        }
        let caption = language.pick("Left out by BS.1534-3", "Écartés selon BS.1534-3");
        let heading = language.pick(
            ["person", "reference below 90", "anchor above 90"],
            ["personne", "référence au-dessous de 90", "ancre au-dessus de 90"],
        );
        let mut table = DataTable::new(format!("{id}-screening"), caption, heading);
        for person in out {
            let share =
                |own: Option<f64>| own.map_or("–".to_owned(), |own| language.percent(own));
            let (reference, anchor) =
                (person.share_reference_below_90, person.share_anchor_above_90);
            table.row([person.participant.clone(), share(reference), share(anchor)]);
        }
        self.blocks.push(Block::Table(table));
    }

    /// The conditions against each other, reference and anchor left out.
    fn panel_tests(
        &mut self,
        id: &str,
        block: &PanelComponent,
        measure: &Measure,
        found: &Comparison,
    ) {
        let language = self.language();
        let shown = self.naming.factor(&block.compare);
        self.blocks.push(Block::Heading(
            3,
            language
                .pick(
                    "The conditions, without reference and anchor",
                    "Les conditions, sans référence ni ancre",
                )
                .to_owned(),
        ));
        let caption = language.pick(
            format!("{} by {shown}", measure.label),
            format!("{} par {shown}", measure.label),
        );
        let table = tables::descriptions(&self.naming, format!("{id}-described"), caption, found);
        self.blocks.push(Block::Table(table));
        let caption = language.pick(
            format!("Tests of {shown}: as in the thesis and recommended"),
            format!("Tests de {shown} : comme dans la thèse et recommandés"),
        );
        let table = tables::two_columns(
            &self.naming,
            format!("{id}-tests"),
            caption,
            &block.compare,
            measure.kind,
            &found.as_in_the_thesis,
            &found.recommended,
        );
        self.blocks.push(Block::Table(table));
        let pairs_id = format!("{id}-pairs");
        let people = &found.recommended;
        let pairs =
            tables::many_pairs(&self.naming, pairs_id, &block.compare, measure.kind, people);
        self.blocks.extend(pairs.map(Block::Table));
        let words = reading::comparison(&self.naming, found, &measure.label);
        self.blocks.push(Block::Reading(words));
    }

    /// Davidson's model of which of two conditions is rated higher on a page.
    fn page_order(
        &mut self,
        id: &str,
        block: &PanelComponent,
        measure: &Measure,
        levels: &[String],
    ) -> Option<PageOrder> {
        let data = self.on_one_page(block, measure, levels);
        // The first of two is the earlier condition, wherever it stood: there is no side.
        let options = BradleyTerryOptions {
            side: Some(false),
            fit_rounds: FIT_ROUNDS,
            ..BradleyTerryOptions::default()
        };
        let worths = bradley_terry(&data, &options).ok()?;
        let language = self.language();
        self.blocks.push(Block::Heading(
            3,
            language.pick("Order on the page", "Ordre sur la page").to_owned(),
        ));
        self.blocks.push(Block::Paragraph(language.pick(
            "Of every two clips of a page, the one that is rated higher counts as chosen, equal ratings as no difference: this takes nothing of a rating but the order, so that people who use the scale differently count alike. Participants are clusters. Reference and anchor take part.",
            "De deux extraits d’une page, celui qui est noté plus haut compte comme choisi, des notes égales comme sans différence : seul l’ordre des notes est retenu, si bien que ceux qui utilisent l’échelle différemment comptent de même. Les participants sont des grappes. La référence et l’ancre en font partie.",
        ).to_owned()));
        self.worths(&format!("{id}-order"), &block.compare, &worths, None);
        let call = Call::new(Design::PageOrder, "bradley_terry").text(&measure.id);
        let test = TestLine::worths(&worths, call.text(&block.compare).list(&data.items));
        if let Outcome::Ok(line) = &test {
            let p = language.p_cell(line.row.p_value, line.row.ln_p);
            self.blocks.push(Block::Paragraph(language.pick(
                format!("Equal worths of all conditions, clustered by participant: p {p}."),
                format!(
                    "Valeurs égales de toutes les conditions, grappes par participant : p {p}."
                ),
            )));
        }
        Some(PageOrder { test, worths })
    }

    /// Every two conditions of every page, the earlier condition being the first of two; ratings of a page by its
    /// person and its place among the person's trials.
    fn on_one_page(
        &self,
        block: &PanelComponent,
        measure: &Measure,
        levels: &[String],
    ) -> PairedComparisons {
        let factor = measure.factor(self.export, &block.compare, levels);
        let mut pages: BTreeMap<(usize, Option<usize>), BTreeMap<u32, f64>> = BTreeMap::new();
        for (row, &code) in factor.codes.iter().enumerate() {
            let order = self.export.trials[measure.trial[row]].order;
            if (code as usize) < levels.len() {
                let page = pages.entry((measure.person[row], order)).or_default();
                page.insert(code, measure.values[row]);
            }
        }
        let mut people: Vec<usize> = pages.keys().map(|(person, _)| *person).collect();
        people.dedup();
        let mut answers = Vec::new();
        for ((person, _), page) in &pages {
            let participant = people.binary_search(person).unwrap_or_default();
            for (&left, own) in page {
                for (&right, other) in page.range(left + 1..) {
                    let chosen = match own.total_cmp(other) {
                        std::cmp::Ordering::Greater => Chosen::Left,
                        std::cmp::Ordering::Less => Chosen::Right,
                        std::cmp::Ordering::Equal => Chosen::Same,
                    };
                    let (left, right) = (left as usize, right as usize);
                    answers.push(Compared { participant, left, right, chosen });
                }
            }
        }
        PairedComparisons {
            answers,
            participants: people.iter().map(|&one| self.export.people[one].id.clone()).collect(),
            items: factor.levels,
            dropped: 0,
        }
    }
}
