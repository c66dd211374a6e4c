//! ROC curves of a forced choice with a rating of confidence beside it, category by category.

use std::collections::HashMap;

use mimique_report::document::{Block, DataTable, slug};
use mimique_stats::{CategoryRoc, Numbers, Roc, roc};
use mimique_study::KindOfQuestion as _;
use serde::Serialize;

use crate::naming::people_counted;
use crate::report::figure::roc_curves;
use crate::report::section::Writer;
use crate::trials::asked_question::AskedQuestion;
use crate::trials::export::Answer;

/// The curves of a question.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct QuestionRoc {
    pub response: String,
    /// The rating of how sure answers are.
    pub confidence: String,
    #[serde(flatten)]
    pub found: Roc,
}

impl Writer<'_> {
    /// The curves of each category; nothing of a question that names no rating of confidence.
    pub(crate) fn roc(&mut self, asked: &AskedQuestion<'_>, truth: &str) {
        let Some(confidence) = asked.question.and_then(|question| question.kind.confidence())
        else {
            return;
        };
        let language = self.language();
        self.heading(3, "ROC curves by confidence", "Courbes ROC selon la certitude");
        let Some(found) = self.curves(asked, confidence) else {
            self.blocks.push(Block::Caution(language.pick(
                format!("Fewer than two categories have answers with a rating `{confidence}`: there is no curve."),
                format!("Moins de deux catégories ont des réponses avec une note `{confidence}` : il n’y a pas de courbe."),
            )));
            return;
        };
        let (n, dropped) = (found.n, found.dropped);
        self.blocks.push(Block::Paragraph(language.pick(
            format!("Each category against all others: answers that name it, from the surest to the least sure, then those that name another one, from the least sure to the surest. The curve has the shares of hits and of false alarms up to each of these places; the area below it is the probability that an answer to the category stands above one to another category (Mann and Whitney’s U, ties counted half), 0.5 where nothing is told. {n} answers, {dropped} without a rating `{confidence}`. Means are over people with t intervals; where somebody was shown fewer than five of a category, only the answers of all people together are told."),
            format!("Chaque catégorie contre toutes les autres : les réponses qui la nomment, de la plus sûre à la moins sûre, puis celles qui en nomment une autre, de la moins sûre à la plus sûre. La courbe a les proportions de détections et de fausses alarmes jusqu’à chacune de ces places ; l’aire sous elle est la probabilité qu’une réponse à la catégorie soit placée au-dessus d’une réponse à une autre (U de Mann et Whitney, ex æquo comptés pour moitié), 0,5 si rien n’est distingué. {n} réponses, {dropped} sans note `{confidence}`. Les moyennes sont sur les personnes, avec des intervalles t ; si quelqu’un a vu moins de cinq extraits d’une catégorie, seules les réponses de toutes les personnes ensemble sont données."),
        )));
        let table = self.areas_table(asked, truth, &found);
        self.folded_table(table);
        let curves = found.categories.iter().filter_map(|own| {
            let curve = own.pooled.clone().ok()?;
            Some((self.naming.level(truth, &own.category), curve))
        });
        let curves: Vec<_> = curves.collect();
        let caption = language.pick(
            "ROC curves of all answers together, by category",
            "Courbes ROC de toutes les réponses ensemble, par catégorie",
        );
        let id = format!("{}-roc", slug(&asked.id));
        self.figure(roc_curves(language, &id, caption, &curves));
        let (response, confidence) = (asked.id.clone(), confidence.to_owned());
        self.results.roc.push(QuestionRoc { response, confidence, found });
    }

    fn curves(&self, asked: &AskedQuestion<'_>, confidence: &str) -> Option<Roc> {
        let ratings = self.export.answers_to(confidence).iter();
        let sure: HashMap<usize, f64> =
            ratings.filter_map(|answer| Some((answer.trial, answer.number?))).collect();
        let answers: Vec<&Answer> = self.export.answers_to(&asked.id).iter().collect();
        let [people, shown, given] = self.told(&answers);
        let values = answers.iter().map(|own| sure.get(&own.trial).copied().unwrap_or(f64::NAN));
        let sure = Numbers { name: confidence.to_owned(), values: values.collect() };
        roc(&people, &shown, &given, &sure).ok()
    }

    fn areas_table(&self, asked: &AskedQuestion<'_>, truth: &str, found: &Roc) -> DataTable {
        let language = self.language();
        let people = found.participants;
        let caption = language.pick(
            format!(
                "Area below the ROC curve of each category ({})",
                people_counted(language, people)
            ),
            format!(
                "Aire sous la courbe ROC de chaque catégorie ({})",
                people_counted(language, people)
            ),
        );
        let heading = language.pick(
            [
                "",
                "shown",
                "others shown",
                "area, mean over people [95 %]",
                "people",
                "area, all together",
            ],
            [
                "",
                "montrés",
                "autres montrés",
                "aire, moyenne des personnes [95 %]",
                "personnes",
                "aire, ensemble",
            ],
        );
        let mut table = DataTable::new(format!("{}-roc", slug(&asked.id)), caption, heading);
        let number = |value: f64| language.fixed(value, 3);
        for own in &found.categories {
            let areas = of_people(own);
            let mean =
                areas.as_ref().map(|found| match found.mean_ci_t.map(|ends| ends.map(number)) {
                    Some([low, high]) => format!("{} [{low}; {high}]", number(found.mean)),
                    None => number(found.mean),
                });
            let pooled = own.pooled.clone().ok().map(|curve| number(curve.area));
            let undefined = || language.pick("undefined", "non définie").to_owned();
            table.row([
                self.naming.level(truth, &own.category),
                own.signals.to_string(),
                own.noise.to_string(),
                mean.unwrap_or_else(|| "–".to_owned()),
                areas.map_or_else(|| "–".to_owned(), |found| found.n.to_string()),
                pooled.unwrap_or_else(undefined),
            ]);
        }
        table
    }
}

/// Of people's areas; none where somebody was shown fewer than five signals.
pub(crate) fn of_people(found: &CategoryRoc) -> Option<mimique_stats::Description> {
    found.areas.clone().ok().filter(|_| !found.few_signals)
}
