//! Two paragraphs for a paper: what was done, and what was found, in the style of the American Psychological
//! Association. Numbers are those of the tables; nothing is computed here.

use std::collections::BTreeSet;

use mimique_locale::Language;
use mimique_report::document::Block;
use mimique_stats::{EffectSize, EquivalenceVerdict, Outcome};
use mimique_study::KindOfQuestion as _;

use crate::hypothesis::decision::{
    Decision, EffectOf, EffectUnit, deciding_p_values, decision, effects,
};
use crate::hypothesis::other_clips::{DecidingTest, OtherClips};
use crate::hypothesis::test_line::{TestLine, Unit};
use crate::hypothesis::{HypothesisResult, deciding_test, reading};
use crate::preregistration::pairs::shown;
use crate::report::section::Writer;
use crate::trials::measure::MeasureKind;

impl Writer<'_> {
    /// Methods and results, to be copied.
    pub(crate) fn paper(&mut self, hypotheses: &[HypothesisResult]) {
        self.heading(2, "For a paper", "Pour un article");
        self.paragraph(
            "Two paragraphs to start from, in APA style. What the study file does not say (where people were found, what they were paid, who the actor is) is yours to add. Every figure is also a file of its own in the folder figures.",
            "Deux paragraphes pour commencer, au format APA. Ce que le fichier de l’étude ne dit pas (où les personnes ont été trouvées, leur rémunération, qui est l’acteur) est à ajouter. Chaque figure est aussi un fichier du dossier figures.",
        );
        let methods = self.methods_paragraph(hypotheses);
        self.heading(3, "Methods", "Méthode");
        self.blocks.push(Block::Paper(methods));
        if hypotheses.is_empty() {
            return;
        }
        let results: Vec<String> =
            hypotheses.iter().map(|result| self.result_in_paper(result)).collect();
        self.heading(3, "Results", "Résultats");
        self.blocks.push(Block::Paper(results.join(" ")));
    }

    fn methods_paragraph(&self, hypotheses: &[HypothesisResult]) -> String {
        let language = self.language();
        let mut sentences = self.participants_in_paper();
        sentences.push(self.clips_in_paper());
        sentences.extend(self.presentation_in_paper());
        sentences.extend(self.questions_in_paper());
        sentences.extend(self.tests_in_paper(hypotheses));
        let tested = hypotheses.iter().filter(|result| result.p.is_some()).count();
        if tested > 1 {
            sentences.push(language.pick(
                format!("p values of the {tested} hypotheses are corrected by Holm’s method."),
                format!("Les p des {tested} hypothèses sont corrigés par la méthode de Holm."),
            ));
        }
        if has_effect_sizes(hypotheses) {
            let words = language.pick(
                "d_z is the mean of the differences between participants’ means divided by their standard deviation, without Hedges’s correction; d_w is the share of participants with a positive difference less the share with a negative one (Cliff, 1993), in which participants without a difference count.",
                "d_z est la moyenne des différences entre moyennes des participants divisée par leur écart type, sans correction de Hedges ; d_w est la part des participants à différence positive moins celle à différence négative (Cliff, 1993), où comptent les participants sans différence.",
            );
            sentences.push(words.to_owned());
        }
        let version = env!("CARGO_PKG_VERSION");
        sentences.push(language.pick(
            format!("Analyses were computed with Mimique {version}."),
            format!("Les analyses ont été calculées avec Mimique {version}."),
        ));
        sentences.join(" ")
    }

    /// How clips were shown where several stood on one page.
    fn presentation_in_paper(&self) -> Vec<String> {
        let language = self.language();
        let mut sentences: Vec<String> = Vec::new();
        let mut add = |sentence: String| {
            if !sentences.contains(&sentence) {
                sentences.push(sentence);
            }
        };
        for (_, block) in self.study.pair_blocks() {
            let how = shown(language, block.show);
            add(language.pick(
                format!("Clips were shown in pairs, {how}, and participants chose between them; the sides were dealt evenly."),
                format!("Les extraits ont été montrés par paires, {how}, et les participants ont choisi entre eux ; les côtés ont été répartis également."),
            ));
        }
        if self.study.panel_blocks().next().is_some() {
            add(language.pick(
                "All versions of a performance were rated together on one page, in an order drawn for each page.",
                "Toutes les versions d’une interprétation ont été notées ensemble sur une page, dans un ordre tiré pour chaque page.",
            ).to_owned());
        }
        sentences
    }

    /// By which tests the hypotheses were decided, a sentence each.
    fn tests_in_paper(&self, hypotheses: &[HypothesisResult]) -> Vec<String> {
        let language = self.language();
        let mut found: Vec<(String, Vec<&str>)> = Vec::new();
        let mut rank_estimates = false;
        for result in hypotheses {
            let decides = result.other_clips.as_ref().filter(|own| own.decides);
            let test = match (decides, deciding_test(&result.recommended)) {
                (Some(own), _) => match own.deciding_test() {
                    Some(DecidingTest::LinearModel(_)) if result.kind == MeasureKind::Choice => language.pick(
                        "linear model of choices (1/2 for the left clip, −1/2 for the right one, 0 for neither; Scheffé, 1952), fitted by restricted maximum likelihood with random effects of participants, of participants with each level, and of segments with each level, with Satterthwaite’s degrees of freedom",
                        "modèle linéaire des choix (1/2 pour l’extrait de gauche, −1/2 pour celui de droite, 0 pour aucun ; Scheffé, 1952), ajusté par maximum de vraisemblance restreinte avec des effets aléatoires des participants, des participants à chaque niveau et des segments à chaque niveau, aux degrés de liberté de Satterthwaite",
                    )
                    .to_owned(),
                    Some(DecidingTest::LinearModel(_)) if result.equivalence.is_some() => language.pick(
                        "two one-sided t tests of the difference in a linear mixed model, fitted by restricted maximum likelihood with random effects of participants, of segments, of both at each level, and of participants for each segment, with Satterthwaite’s degrees of freedom",
                        "deux tests t unilatéraux de la différence dans un modèle linéaire mixte, ajusté par maximum de vraisemblance restreinte avec des effets aléatoires des participants, des segments, de chacun à chaque niveau, et des participants pour chaque segment, aux degrés de liberté de Satterthwaite",
                    )
                    .to_owned(),
                    Some(DecidingTest::LinearModel(_)) => language.pick(
                        "linear mixed model, fitted by restricted maximum likelihood with random effects of participants, of segments, of both at each level, and of participants for each segment, with Satterthwaite’s degrees of freedom",
                        "modèle linéaire mixte, ajusté par maximum de vraisemblance restreinte avec des effets aléatoires des participants, des segments, de chacun à chaque niveau, et des participants pour chaque segment, aux degrés de liberté de Satterthwaite",
                    )
                    .to_owned(),
                    Some(DecidingTest::MinF(line)) => test_in_methods(language, line),
                    None => continue,
                },
                (None, Some(Outcome::Ok(line))) => {
                    rank_estimates |= result.recommended.pairs.iter().any(|pair| pair.difference.is_some());
                    test_in_methods(language, line)
                }
                _ => continue,
            };
            match found.iter_mut().find(|(other, _)| *other == test) {
                Some((_, ids)) => ids.push(&result.id),
                None => found.push((test, vec![&result.id])),
            }
        }
        let tests: Vec<String> = found
            .into_iter()
            .map(|(test, ids)| {
                let colon = language.pick(":", " :");
                format!("{}{colon} {test}", language.list(&ids))
            })
            .collect();
        let mut sentences = Vec::new();
        if !tests.is_empty() {
            let tests = tests.join(language.pick("; ", " ; "));
            sentences
                .push(language.pick(format!("Tests of {tests}."), format!("Tests de {tests}.")));
        }
        sentences.extend(formulas_in_paper(language, hypotheses));
        if rank_estimates {
            let words = language.pick(
                "Differences of these rank tests are Hodges-Lehmann estimates.",
                "Les différences de ces tests sont des estimations de Hodges-Lehmann.",
            );
            sentences.push(words.to_owned());
        }
        sentences
    }

    fn clips_in_paper(&self) -> String {
        let language = self.language();
        let shown: BTreeSet<&str> =
            self.export.trials.iter().map(|trial| trial.stimulus.as_ref()).collect();
        let clips = self.study.clips();
        let of_clips = |of: fn(&mimique_study::Clip) -> &str| -> BTreeSet<String> {
            let own = clips.iter().filter(|clip| shown.contains(clip.id.as_str()));
            own.map(|clip| of(clip).to_owned()).collect()
        };
        let segments = of_clips(|clip| &clip.segment).len();
        let methods: Vec<String> = of_clips(|clip| &clip.method)
            .iter()
            .map(|method| self.naming.level("method", method))
            .collect();
        let (shown, names) = (shown.len(), self.language().list(&methods));
        let segments = language.counted(
            segments,
            ["performance", "performances"],
            ["interprétation", "interprétations"],
        );
        let methods =
            language.counted(methods.len(), ["method", "methods"], ["méthode", "méthodes"]);
        language.pick(
            format!("Participants saw clips from a set of {shown} ({segments}, {methods}: {names}), which Mimique solved and rendered in the browser, all with the same camera, light and duration per performance, in a random order for each participant."),
            format!("Les participants ont vu des extraits d’un ensemble de {shown} ({segments}, {methods} : {names}), que Mimique a résolus et rendus dans le navigateur, tous avec la même caméra, la même lumière et la même durée par interprétation, dans un ordre tiré au hasard pour chacun."),
        )
    }

    fn questions_in_paper(&self) -> Option<String> {
        let language = self.language();
        let asked: Vec<String> = self
            .export
            .questions(self.study)
            .into_iter()
            .map(|asked| {
                let label = asked.label(language.code());
                let kind = asked.question.map(|question| &question.kind);
                let scale = kind.and_then(|kind| {
                    let (points, ends) = (kind.points()?, kind.ends()?);
                    let [low, high] = ends.map(|end| {
                        end.map_or("", |text| text.in_language(language.code())).to_owned()
                    });
                    let [first, last] = [points.start(), points.end()];
                    Some(language.pick(
                        format!(" ({first} = {low}, {last} = {high})"),
                        format!(" ({first} = {low} ; {last} = {high})"),
                    ))
                });
                let scale = scale.unwrap_or_default();
                language.pick(format!("“{label}”{scale}"), format!("« {label} »{scale}"))
            })
            .collect();
        (!asked.is_empty()).then(|| {
            let asked = language.list(&asked);
            language.pick(
                format!("They were asked {asked}."),
                format!("Il leur a été demandé : {asked}."),
            )
        })
    }

    /// A hypothesis with its decision, test and differences.
    fn result_in_paper(&self, result: &HypothesisResult) -> String {
        let language = self.language();
        let statement = result.statement.trim_end_matches(['.', ' ']);
        let mut parts = vec![reading::decision_of(language, result)];
        let p = deciding_p_values(result).into_iter();
        let p = p.map(|(of, p)| {
            format!("{}{}", p_in_paper(language, p), reading::supports(language, of))
        });
        let p: Vec<String> = p.collect();
        let decides = result.other_clips.as_ref().filter(|found| found.decides);
        let equivalence = result.equivalence.as_ref().and_then(|found| found.for_other_clips);
        if let Some(tests) = equivalence {
            parts.push(reading::equivalence_t(language, &tests));
            parts.extend(p);
        } else if let Some(test) = decides.and_then(OtherClips::deciding_test) {
            match test {
                DecidingTest::LinearModel(model) => {
                    let f = reading::f_of(language, model);
                    parts.push(language.pick(
                        format!("linear mixed model with random participants and segments, {f}"),
                        format!("modèle linéaire mixte à participants et segments aléatoires, {f}"),
                    ));
                    parts.extend(p);
                }
                DecidingTest::MinF(line) => parts.extend(test_in_paper(language, line, p)),
            }
        } else if decision(result) == Decision::Equivalence(EquivalenceVerdict::Different) {
            // The statistic of equivalence does not belong to the p of the difference.
            let test = "two-sided test of the difference";
            parts.push(language.pick(test, "test bilatéral de la différence").to_owned());
            parts.push(format!("n = {}", result.recommended.people));
            parts.extend(p);
        } else if let Some(Outcome::Ok(line)) = deciding_test(&result.recommended) {
            parts.extend(test_in_paper(language, line, p));
        }
        let factor = result.factors.first().map_or("", String::as_str);
        let differences: Vec<String> = effects(result)
            .iter()
            .map(|effect| {
                let (scale, decimals, unit) = match effect.unit {
                    EffectUnit::Points => (1.0, 2, ""),
                    EffectUnit::Shares => {
                        (100.0, 1, language.pick(" percentage points", " points de pourcentage"))
                    }
                    EffectUnit::Seconds => (1.0, 2, " s"),
                    EffectUnit::Worth => (1.0, 2, language.pick(" JND", " DJP")),
                    EffectUnit::Chosen => {
                        (100.0, 0, language.pick("% of decided choices", " % des choix tranchés"))
                    }
                    EffectUnit::ChosenOverOthers => (
                        100.0,
                        0,
                        language
                            .pick("% of choices over the others", " % des choix face aux autres"),
                    ),
                };
                let number = |value: f64| language.fixed(value * scale, decimals);
                let pair = self.effect_of(factor, effect);
                let [low, high] = effect.interval.map(number);
                let (estimate, covers) = (number(effect.estimate), effect.covers);
                let sizes = pair_effect_sizes(result, effect.of).into_iter();
                let sizes =
                    sizes.map(|size| format!(", {}", reading::effect_size(language, &size)));
                let sizes: String = sizes.collect();
                language.pick(
                    format!("{pair} = {estimate}{unit}, {covers}% CI [{low}, {high}]{sizes}"),
                    format!("{pair} = {estimate}{unit}, IC à {covers} % [{low} ; {high}]{sizes}"),
                )
            })
            .collect();
        let colon = language.pick(":", " :");
        let mut sentence = format!("{} ({}){colon} {}", statement, result.id, parts.join(", "));
        if !differences.is_empty() {
            sentence.push_str(language.pick("; ", " ; "));
            sentence += &differences.join(language.pick("; ", " ; "));
        }
        sentence.push('.');
        sentence
    }
}

/// A test with what it counts as one observation.
fn test_in_methods(language: Language, line: &TestLine) -> String {
    let of = match &line.unit {
        Unit::Trials => language.pick("on single trials", "sur les essais"),
        Unit::PersonMeans => {
            language.pick("on one mean per participant", "sur une moyenne par participant")
        }
        Unit::MeansWithinPeople => language.pick(
            "on one mean per participant and level",
            "sur une moyenne par participant et niveau",
        ),
        Unit::DifferencesOfPeople(_) => language.pick(
            "on each participant’s difference between two levels",
            "sur la différence de chaque participant entre deux niveaux",
        ),
        Unit::CorrelationsOfPeople => language
            .pick("on each participant’s correlation", "sur la corrélation de chaque participant"),
        Unit::ChoicesOfPeople => language.pick(
            "on how much more often each participant chose one level than the other",
            "sur l’excès de choix de l’un des niveaux par chaque participant",
        ),
        Unit::WinsOfPeople => language.pick(
            "on how often each participant chose each level",
            "sur le nombre de choix de chaque niveau par chaque participant",
        ),
        Unit::ClusteredByPerson => {
            language.pick("clustered by participant", "à erreurs groupées par participant")
        }
        Unit::PeopleAndSegments => {
            language.pick("over participants and segments", "sur les participants et les segments")
        }
    };
    format!("{} {of}", line.names.in_words[language.pick(0, 1)])
}

/// Test, statistic, p and effect size.
fn test_in_paper(language: Language, line: &TestLine, p: Vec<String>) -> Vec<String> {
    let mut parts = vec![
        line.names.in_words[language.pick(0, 1)].to_owned(),
        format!(
            "{}{} = {}",
            line.names.statistic_symbol,
            line.degrees_in_brackets(),
            language.fixed(line.row.statistic, 2)
        ),
        format!("n = {}", line.row.n),
    ];
    parts.extend(p);
    parts.extend(line.row.effect.map(|effect| {
        // With its interval where it has one.
        if let [size] = line.effect_sizes.as_slice()
            && size.kind.symbol() == line.names.effect_symbol
        {
            return reading::effect_size(language, size);
        }
        // Those that cannot exceed 1.
        let is_bounded = matches!(
            line.names.effect_symbol,
            "r" | "W" | "V" | "rho" | "share" | "u" | "ε²" | "ηp²" | "η²H" | "ICC"
        );
        let effect = reading::without_zero(language, language.fixed(effect, 2), is_bounded);
        format!("{} = {effect}", line.names.effect_symbol)
    }));
    parts
}

/// p as papers print it: in English without the zero before the point.
fn p_in_paper(language: Language, p: f64) -> String {
    let text = language.p(p);
    match language {
        Language::English => text.replacen("0.", ".", 1),
        Language::French => text,
    }
}

/// The formula of each model that decided a hypothesis, in the notation of R's lme4; `None` where no model decided.
fn formulas_in_paper(language: Language, hypotheses: &[HypothesisResult]) -> Option<String> {
    let formula = |result: &HypothesisResult| {
        let decides = result.other_clips.as_ref().filter(|own| own.decides)?;
        let Some(DecidingTest::LinearModel(model)) = decides.deciding_test() else { return None };
        Some(format!("{}{} {}", result.id, language.pick(":", " :"), model.formula))
    };
    let formulas: Vec<String> = hypotheses.iter().filter_map(formula).collect();
    (!formulas.is_empty()).then(|| {
        let formulas = formulas.join(language.pick("; ", " ; "));
        language.pick(
            format!("Model formulas in the notation of lme4 are {formulas}."),
            format!("Les formules des modèles, dans la notation de lme4, sont {formulas}."),
        )
    })
}

/// The effect sizes of participants' differences between two levels, in the direction of the effect.
fn pair_effect_sizes(result: &HypothesisResult, of: EffectOf<'_>) -> Vec<EffectSize> {
    let EffectOf::Difference([a, b]) = of else { return Vec::new() };
    for pair in &result.recommended.pairs {
        let Outcome::Ok(line) = &pair.wilcoxon else { continue };
        if pair.a == a && pair.b == b {
            return line.effect_sizes.clone();
        }
        if pair.a == b && pair.b == a {
            let turned = line.effect_sizes.iter().map(|size| EffectSize {
                estimate: -size.estimate,
                interval_95: size.interval_95.map(|[low, high]| [-high, -low]),
                ..*size
            });
            return turned.collect();
        }
    }
    Vec::new()
}

/// Whether a difference of a hypothesis is printed with its standardised effect sizes.
fn has_effect_sizes(hypotheses: &[HypothesisResult]) -> bool {
    hypotheses.iter().any(|result| {
        let mut all = effects(result).into_iter();
        all.any(|effect| !pair_effect_sizes(result, effect.of).is_empty())
    })
}
