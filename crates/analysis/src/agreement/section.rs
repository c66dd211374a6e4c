//! What the report says of agreement and of scales.

use mimique_locale::{counted, counted_in_french};
use mimique_report::document::{Block, DataTable, slug};
use mimique_stats::{
    AlphaEstimate, Cronbach, IccForm, IntraclassCorrelation, MeasurementLevel as Level, Outcome,
};

use super::{Agreement, ScaleConsistency, agreement, consistencies};
use crate::naming::people_counted;
use crate::report::section::Writer;
use crate::trials::asked_question::AskedQuestion;
use crate::trials::measure::Measure;

impl Writer<'_> {
    /// How far people agree about the clips, question by question.
    pub(crate) fn agreement(&mut self, measures: &[(AskedQuestion<'_>, Measure)]) {
        let asked_of_clips = measures.iter().filter(|(asked, _)| {
            !self.study.is_asked_of_no_clip(&asked.id)
                && !asked.question.is_some_and(|question| {
                    mimique_study::KindOfQuestion::compares_clips(&question.kind)
                })
        });
        let found: Vec<(String, Agreement)> = asked_of_clips
            .map(|(asked, measure)| (measure.label.clone(), agreement(self.export, asked, measure)))
            .collect();
        if found.is_empty() {
            return;
        }
        self.heading(2, "Agreement about the clips", "Accord sur les extraits");
        self.paragraph(
            "ICC(2,1) is the share of the variance of single ratings that lies between clips, people being drawn from many (two-way random effects, agreement); ICC(2,k) is the same of the mean over these people. Both take the clips that everybody rated, with 95 % intervals. Krippendorff’s alpha is 1 where all agree and 0 where they agree as by chance; it takes every clip with two answers or more, and its interval is from 1000 draws of clips. Clips that differ in method differ for a reason: low agreement may also say that people see no difference.",
            "ICC(2,1) est la part de la variance des notes prises une à une qui est entre les extraits, les personnes étant tirées parmi beaucoup (effets aléatoires à deux facteurs, accord) ; ICC(2,k) est la même pour la moyenne de ces personnes. Les deux prennent les extraits que tout le monde a notés, avec des intervalles à 95 %. L’alpha de Krippendorff vaut 1 si tous sont d’accord et 0 s’ils le sont comme par hasard ; il prend tout extrait à deux réponses ou plus, et son intervalle vient de 1000 tirages d’extraits. Des extraits de méthodes différentes diffèrent pour une raison ; un accord faible peut aussi dire que les personnes ne voient pas de différence.",
        );
        let table = self.agreement_table(&found);
        self.blocks.push(Block::Table(table));
        for (label, own) in &found {
            let reading = self.agreement_reading(label, own);
            self.blocks.push(Block::Reading(reading));
            if let Some(Outcome::Ok(icc)) = &own.icc {
                let table = self.icc_table(label, &own.response, icc);
                self.folded_table(table);
            }
        }
        self.results.agreement.extend(found.into_iter().map(|(_, own)| own));
    }

    fn interval(&self, estimate: f64, interval: Option<[f64; 2]>) -> String {
        let language = self.language();
        let estimate = language.fixed(estimate, 2);
        match interval.map(|ends| ends.map(|end| language.fixed(end, 2))) {
            Some([low, high]) => format!("{estimate} [{low}; {high}]"),
            None => estimate,
        }
    }

    fn agreement_table(&self, found: &[(String, Agreement)]) -> DataTable {
        let language = self.language();
        let heading = language.pick(
            [
                "question",
                "ICC(2,1)",
                "ICC(2,k)",
                "clips, people",
                "Krippendorff’s alpha",
                "level",
                "clips",
            ],
            [
                "question",
                "ICC(2,1)",
                "ICC(2,k)",
                "extraits, personnes",
                "alpha de Krippendorff",
                "niveau",
                "extraits",
            ],
        );
        let caption =
            language.pick("Agreement, with 95 % intervals", "Accord, avec des intervalles à 95 %");
        let mut table = DataTable::new("agreement", caption, heading);
        let none = language.pick("undefined", "non défini");
        for (label, own) in found {
            let [single, mean, count] = match &own.icc {
                Some(Outcome::Ok(icc)) => {
                    let cell = |form: &IccForm| self.interval(form.icc, Some(form.interval_95));
                    let count = format!("{}, {}", icc.clips_used, icc.raters);
                    [cell(icc.agreement_of_one()), cell(icc.agreement_of_mean()), count]
                }
                Some(Outcome::Undefined { .. }) => [none, none, "–"].map(str::to_owned),
                None => ["–"; 3].map(str::to_owned),
            };
            let alpha = match &own.krippendorff {
                Outcome::Ok(alpha) => self.interval(alpha.alpha, alpha.interval),
                Outcome::Undefined { .. } => none.to_owned(),
            };
            let [used, all] = own.clips;
            let clips = format!("{used}/{all}");
            let level = self.level_of_measurement(own).to_owned();
            table.row([label.clone(), single, mean, count, alpha, level, clips]);
        }
        table
    }

    fn level_of_measurement(&self, own: &Agreement) -> &'static str {
        match own.level {
            Level::Nominal => self.language().pick("nominal", "nominal"),
            Level::Ordinal => self.language().pick("ordinal", "ordinal"),
            Level::Interval | Level::Ratio => self.language().pick("interval", "intervalle"),
        }
    }

    fn agreement_reading(&self, label: &str, own: &Agreement) -> String {
        let language = self.language();
        let mut sentences = Vec::new();
        match &own.icc {
            Some(Outcome::Ok(icc)) => sentences.push(self.icc_reading(icc)),
            Some(Outcome::Undefined { reason }) => {
                let reason = reason.words(language);
                sentences.push(language.pick(
                    format!("The ICC is undefined ({reason})."),
                    format!("L’ICC n’est pas défini ({reason})."),
                ));
            }
            None => {}
        }
        sentences.push(match &own.krippendorff {
            Outcome::Ok(found) => self.alpha_reading(found),
            Outcome::Undefined { reason } => {
                let reason = reason.words(language);
                language.pick(
                    format!("Krippendorff’s alpha is undefined ({reason})."),
                    format!("L’alpha de Krippendorff n’est pas défini ({reason})."),
                )
            }
        });
        if own.repeated > 0 {
            let repeated = own.repeated;
            sentences.push(language.pick(
                format!("Of clips that somebody answered more than once, alpha takes the first answer ({repeated} left out) and the ICC the mean."),
                format!("Pour les extraits auxquels une personne a répondu plusieurs fois, alpha prend la première réponse ({repeated} écartées) et l’ICC la moyenne."),
            ));
        }
        let topic = language.pick(format!("“{label}”: "), format!("« {label} » : "));
        topic + &sentences.join(" ")
    }

    fn icc_reading(&self, icc: &IntraclassCorrelation) -> String {
        let language = self.language();
        let single = self.interval(icc.agreement_of_one().icc, None);
        let mean = self.interval(icc.agreement_of_mean().icc, None);
        let dropped = match icc.clips_dropped {
            0 => String::new(),
            dropped => language.pick(
                format!(" Left out as not rated by everybody: {}.", counted(dropped, "clip")),
                format!(
                    " Écartés, car pas notés par tout le monde : {}.",
                    counted_in_french(dropped, "extrait", "extraits")
                ),
            ),
        };
        language.pick(
            format!("of one person’s ratings {single} of the variance is between clips (ICC(2,1)), of the mean of {} {mean} (ICC(2,k)).{dropped}", people_counted(language, icc.raters)),
            format!("pour les notes d’une personne, {single} de la variance est entre extraits (ICC(2,1)), pour la moyenne de {} {mean} (ICC(2,k)).{dropped}", people_counted(language, icc.raters)),
        )
    }

    fn alpha_reading(&self, found: &AlphaEstimate) -> String {
        let alpha = self.interval(found.alpha, found.interval);
        self.language().pick(
            format!("Krippendorff’s alpha is {alpha}."),
            format!("L’alpha de Krippendorff est {alpha}."),
        )
    }

    fn icc_table(&self, label: &str, response: &str, icc: &IntraclassCorrelation) -> DataTable {
        let language = self.language();
        let heading = language
            .pick(["form", "ICC [95 %]", "F", "df", "p"], ["forme", "ICC [95 %]", "F", "ddl", "p"]);
        let caption = language.pick(
            format!("Intraclass correlation of “{label}” in six forms"),
            format!("Corrélation intraclasse de « {label} » sous six formes"),
        );
        let mut table = DataTable::new(format!("{}-icc", slug(response)), caption, heading);
        for form in &icc.forms {
            table.row([
                form.form.to_owned(),
                self.interval(form.icc, Some(form.interval_95)),
                language.number(form.F),
                format!("{}, {}", form.df1, form.df2),
                language.p_cell(form.p, form.ln_p),
            ]);
        }
        table
    }

    /// Cronbach's alpha of each scale that the study file declares.
    pub(crate) fn scales(&mut self) {
        let found = consistencies(self.export, self.study);
        if found.is_empty() {
            return;
        }
        self.heading(2, "Scales", "Échelles");
        self.paragraph(
            "Cronbach’s alpha of the questions of a scale, a person’s answers being one row, with Feldt’s 95 % interval. An alpha that rises when a question is dropped tells of one that measures something else, or that should be reversed.",
            "Alpha de Cronbach des questions d’une échelle, les réponses d’une personne formant une ligne, avec l’intervalle à 95 % de Feldt. Un alpha qui monte quand une question est retirée signale une question qui mesure autre chose, ou qui devrait être inversée.",
        );
        for scale in &found {
            let reading = self.scale_reading(scale);
            self.blocks.push(Block::Reading(reading));
            if let Outcome::Ok(cronbach) = &scale.cronbach {
                let table = self.scale_table(scale, cronbach);
                self.blocks.push(Block::Table(table));
            }
        }
        self.results.scales.extend(found);
    }

    fn scale_reading(&self, scale: &ScaleConsistency) -> String {
        let (language, name) = (self.language(), &scale.scale);
        let found = match &scale.cronbach {
            Outcome::Ok(found) => found,
            Outcome::Undefined { reason } => {
                let reason = reason.words(language);
                return language.pick(
                    format!("{name}: Cronbach’s alpha is undefined ({reason})."),
                    format!("{name} : l’alpha de Cronbach n’est pas défini ({reason})."),
                );
            }
        };
        let alpha = self.interval(found.alpha, Some(found.interval_95_feldt));
        let (k, n) = (found.k, found.n);
        let mut text = language.pick(
            format!(
                "{name}: Cronbach’s alpha of {k} questions is {alpha}, {}.",
                people_counted(language, n)
            ),
            format!(
                "{name} : l’alpha de Cronbach de {k} questions est {alpha}, {}.",
                people_counted(language, n)
            ),
        );
        if found.dropped > 0 {
            let dropped = people_counted(language, found.dropped);
            text += &language.pick(
                format!(" Without an answer to one of them, and left out: {dropped}."),
                format!(" Sans réponse à l’une d’elles, et écartées : {dropped}."),
            );
        }
        if scale.of_means {
            text += language.pick(
                " The questions are asked in trials: a person’s answers to one are averaged over the trials.",
                " Les questions sont posées dans les essais : les réponses d’une personne à l’une sont moyennées sur les essais.",
            );
        }
        text
    }

    fn scale_table(&self, scale: &ScaleConsistency, found: &Cronbach) -> DataTable {
        let (language, name) = (self.language(), &scale.scale);
        let heading = language.pick(
            ["question", "reversed", "alpha if dropped", "correlation with the others"],
            ["question", "inversée", "alpha sans elle", "corrélation avec les autres"],
        );
        let caption = language.pick(
            format!("Questions of the scale {name}"),
            format!("Questions de l’échelle {name}"),
        );
        let mut table = DataTable::new(format!("scale-{}", slug(name)), caption, heading);
        let number = |value: Option<&Option<f64>>| {
            value
                .copied()
                .flatten()
                .map_or_else(|| "–".to_owned(), |value| language.fixed(value, 2))
        };
        for item in &scale.items {
            let reversed = scale.reversed.contains(item);
            table.row([
                item.clone(),
                if reversed { language.pick("yes", "oui") } else { "" }.to_owned(),
                number(found.alpha_if_dropped.get(item)),
                number(found.item_rest_correlation.get(item)),
            ]);
        }
        table
    }
}
