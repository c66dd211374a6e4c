//! Two paragraphs for a paper: what was done, and what was found, in the style of the American Psychological
//! Association. Numbers are those of the tables; nothing is computed here.

use std::collections::BTreeSet;

use mimique_locale::Language;
use mimique_report::document::Block;
use mimique_stats::{EquivalenceVerdict, Outcome};
use mimique_study::KindOfQuestion as _;

use crate::hypothesis::decision::{Decision, EffectUnit, deciding_p_values, decision, effects};
use crate::hypothesis::other_clips::{DecidingTest, OtherClips};
use crate::hypothesis::test_line::TestLine;
use crate::hypothesis::{HypothesisResult, deciding_test, reading};
use crate::naming::people_counted;
use crate::report::results::AboutPeople;
use crate::report::section::Writer;
use crate::trials::rule::Rule;

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
        let flow = &self.export.flow;
        let mut sentences = vec![match flow.people - flow.people_used {
            0 => language.pick(
                format!("{} took part.", people_counted(language, flow.people)),
                format!("{} participé.", language.counted(flow.people, ["", ""], ["personne a", "personnes ont"])),
            ),
            out => language.pick(
                format!("{} took part; {out} {} excluded by rules fixed beforehand ({}), which leaves {}.", people_counted(language, flow.people), if out == 1 { "was" } else { "were" }, Rule::listed(&flow.rules, language), flow.people_used),
                format!("{} participé ; {} par des règles fixées à l’avance ({}), ce qui en laisse {}.", language.counted(flow.people, ["", ""], ["personne a", "personnes ont"]), language.counted(out, ["", ""], ["a été exclue", "ont été exclues"]), Rule::listed(&flow.rules, language), flow.people_used),
            ),
        }];
        sentences.extend(self.about_people_in_paper());
        sentences.push(self.clips_in_paper());
        sentences.extend(self.questions_in_paper());
        if !hypotheses.is_empty() {
            sentences.push(language.pick(
                "Each person’s answers were averaged within levels, so that a person counts once. Several levels were compared by Friedman’s test with Iman and Davenport’s F, two by Wilcoxon’s exact signed rank test, interactions by the aligned rank transform; differences are Hodges-Lehmann estimates.",
                "Les réponses de chaque personne ont été moyennées par niveau, de sorte qu’une personne compte une fois. Plusieurs niveaux ont été comparés par le test de Friedman avec le F d’Iman et Davenport, deux par le test exact des rangs signés de Wilcoxon, les interactions par la transformation des rangs alignés ; les différences sont des estimations de Hodges-Lehmann.",
            ).to_owned());
        }
        let tested = hypotheses.iter().filter(|result| result.p.is_some()).count();
        if tested > 1 {
            sentences.push(language.pick(
                format!("p values of the {tested} hypotheses are corrected by Holm’s method."),
                format!("Les p des {tested} hypothèses sont corrigés par la méthode de Holm."),
            ));
        }
        sentences.join(" ")
    }

    /// Numbers that people told about themselves, such as their age.
    fn about_people_in_paper(&self) -> Option<String> {
        let language = self.language();
        let numbers = self.results.about_people.iter().filter_map(|(column, about)| match about {
            AboutPeople::Numbers(Outcome::Ok(found)) => {
                let [mean, low, high] = [found.mean, found.min, found.max];
                let sd = found.sd.map_or_else(String::new, |sd| {
                    let sd = language.fixed(sd, 1);
                    language.pick(format!(", SD = {sd}"), format!(", ET = {sd}"))
                });
                Some(format!(
                    "{}{} M = {}{sd}, {} – {}",
                    self.naming.column(column),
                    language.pick(":", " :"),
                    language.fixed(mean, 1),
                    language.number(low),
                    language.number(high)
                ))
            }
            _ => None,
        });
        let numbers: Vec<String> = numbers.collect();
        (!numbers.is_empty()).then(|| {
            let numbers = numbers.join("; ");
            language.pick(
                format!("They said of themselves: {numbers}."),
                format!("Elles ont dit d’elles-mêmes : {numbers}."),
            )
        })
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
        let (shown, names) = (shown.len(), methods.join(", "));
        let segments = language.counted(
            segments,
            ["performance", "performances"],
            ["interprétation", "interprétations"],
        );
        let methods =
            language.counted(methods.len(), ["method", "methods"], ["méthode", "méthodes"]);
        language.pick(
            format!("They saw clips out of {shown}, of {segments} by {methods} ({names}), which Mimique solved and rendered in the browser, all with the same camera, light and duration of a performance, in an order drawn for each person."),
            format!("Elles ont vu des extraits parmi {shown}, de {segments} par {methods} ({names}), que Mimique a résolus et rendus dans le navigateur, tous avec la même caméra, la même lumière et la même durée par interprétation, dans un ordre tiré pour chacune."),
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
            let asked = asked.join(", ");
            language.pick(
                format!("They were asked: {asked}."),
                format!("Il leur a été demandé : {asked}."),
            )
        })
    }

    /// A hypothesis with its decision, test and differences.
    fn result_in_paper(&self, result: &HypothesisResult) -> String {
        let language = self.language();
        let statement = result.statement.trim_end_matches(['.', ' ']);
        let found = reading::decision(language, decision(result));
        let mut parts = vec![found.to_owned()];
        let p = deciding_p_values(result).into_iter();
        let p = p.map(|(of, p)| {
            format!("{}{}", p_in_paper(language, p), reading::supports(language, of))
        });
        let p: Vec<String> = p.collect();
        let decides = result.other_clips.as_ref().filter(|found| found.decides);
        if let Some(test) = decides.and_then(OtherClips::deciding_test) {
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
                };
                let number = |value: f64| language.fixed(value * scale, decimals);
                let pair = self.effect_of(factor, effect);
                let [low, high] = effect.interval.map(number);
                let (estimate, covers) = (number(effect.estimate), effect.covers);
                language.pick(
                    format!("{pair} = {estimate}{unit}, {covers}% CI [{low}, {high}]"),
                    format!("{pair} = {estimate}{unit}, IC à {covers} % [{low} ; {high}]"),
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
        let effect = without_zero(language, language.fixed(effect, 2), effect.abs() <= 1.0);
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

/// A number that cannot exceed 1, in English without the zero before the point.
fn without_zero(language: Language, text: String, is_bounded: bool) -> String {
    match language {
        Language::English if is_bounded => text.replacen("0.", ".", 1),
        _ => text,
    }
}
