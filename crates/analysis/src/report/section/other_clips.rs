//! Whether what a hypothesis found holds for other clips too: the tests, and the mixed model drawn.

use mimique_report::document::{Block, slug};
use mimique_stats::Outcome;

use crate::hypothesis::HypothesisResult;
use crate::hypothesis::other_clips::ClipModel;
use crate::report::figure;
use crate::report::section::Writer;
use crate::report::tables;

impl Writer<'_> {
    /// Whether what was found holds for other clips too.
    pub(crate) fn other_clips(&mut self, result: &HypothesisResult) {
        let Some(found) = &result.other_clips else { return };
        let language = self.language();
        let id = format!("hypothesis-{}-other-clips", slug(&result.id));
        let factor = result.factors.first().map_or("", String::as_str);
        let caption = language.pick(
            format!("{}: of other people and other clips", result.id),
            format!("{} : pour d’autres personnes et d’autres extraits", result.id),
        );
        let table = tables::other_clips(&self.naming, id.clone(), caption, factor, found);
        self.blocks.push(Block::Table(table));
        match &found.mixed_model {
            None => {}
            Some(Outcome::Ok(model)) => self.drawn_model(result, &id, factor, model),
            Some(Outcome::Undefined { reason }) => {
                let reason = reason.words(language);
                self.paragraph(
                    &format!("The cumulative mixed model has no result ({reason}): its shares and standard deviations are not drawn."),
                    &format!("Le modèle mixte cumulatif n’a pas de résultat ({reason}) : ses parts et ses écarts types ne sont pas dessinés."),
                );
            }
        }
    }

    /// The model's shares of each rating beside those of the answers, and how far people and clips differ.
    fn drawn_model(
        &mut self,
        result: &HypothesisResult,
        id: &str,
        factor: &str,
        model: &ClipModel,
    ) {
        let language = self.language();
        let levels: Vec<_> = model
            .shares
            .iter()
            .map(|(level, own)| (self.naming.level(factor, level), own))
            .collect();
        let caption = language.pick(
            format!("{}: shares of each rating by the mixed model, for the average person and clip, and as observed. People and clips that differ make observed shares more even", result.id),
            format!("{} : parts de chaque note selon le modèle mixte, pour la personne et l’extrait moyens, et parts observées. Les différences entre personnes et entre extraits rendent les parts observées plus égales", result.id),
        );
        let shares_id = format!("{id}-shares");
        let drawing = figure::model_shares(language, &shares_id, &caption, &model.ratings, &levels);
        self.figure(drawing);
        let caption = language.pick(
            format!("{}: how far people, segments and clips differ in the mixed model", result.id),
            format!(
                "{} : de combien personnes, segments et extraits diffèrent dans le modèle mixte",
                result.id
            ),
        );
        let shown = self.naming.factor(factor);
        let terms: Vec<(String, f64)> = model
            .sd
            .iter()
            .map(|(term, sd)| {
                let name = match term {
                    "participant" => language.pick("people", "personnes").to_owned(),
                    "segment" => language.pick("segments", "segments").to_owned(),
                    "clip" => language.pick("clips", "extraits").to_owned(),
                    _ => language.pick(format!("people × {shown}"), format!("personnes × {shown}")),
                };
                (name, *sd)
            })
            .collect();
        let drawing = figure::deviations(language, &format!("{id}-sd"), &caption, &terms);
        self.figure(drawing);
    }
}
