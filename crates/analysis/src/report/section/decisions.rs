//! What comes first in a report: who took part, and what every hypothesis found, a row each.

use mimique_report::document::{Block, DataTable, DecisionTable, RowEffects};
use mimique_report::figure::{DrawnInterval, forest_row};
use mimique_stats::Outcome;

use crate::hypothesis::HypothesisResult;
use crate::hypothesis::decision::{
    Decision, Effect, EffectOf, EffectUnit, deciding_p_values, decision, effects,
};
use crate::hypothesis::other_clips::DecidingTest;
use crate::hypothesis::reading;
use crate::naming::people_counted;
use crate::report::figure::flow_chart::flow_in_words;
use crate::report::section::Writer;
use crate::trials::exclusion_rates::by_factors;

impl Writer<'_> {
    /// Who took part, and what the hypotheses found.
    pub(crate) fn in_short(&mut self, hypotheses: &[HypothesisResult]) {
        let language = self.language();
        self.heading(2, "In short", "En bref");
        let flow = flow_in_words(language, &self.export.flow);
        self.blocks.push(Block::Paragraph(flow));
        for version in self.other_versions {
            self.blocks.push(Block::Caution(reading::other_version(language, version)));
        }
        if hypotheses.is_empty() {
            self.paragraph(
                "The study file states no hypothesis; every comparison below is exploratory.",
                "Le fichier de l’étude n’énonce aucune hypothèse ; toutes les comparaisons ci-dessous sont exploratoires.",
            );
        } else {
            let decisions = self.decisions(hypotheses);
            self.blocks.push(Block::Decisions(decisions));
        }
        self.unequal_exclusion(hypotheses);
        let n = self.export.flow.people_used;
        if n < 6 {
            self.blocks.push(Block::Caution(language.pick(
                format!("With {} in the analysis no paired test of a difference can reach p < 0.05: six are the least (five for equivalence), and most effects need many more. Take what follows as a trial run of the analysis.", people_counted(language, n)),
                format!("Avec {} dans l’analyse, aucun test apparié d’une différence ne peut atteindre p < 0,05 : il en faut au moins six (cinq pour l’équivalence), et la plupart des effets en demandent bien plus. Considérez ce qui suit comme un essai de l’analyse.", people_counted(language, n)),
            )));
        }
    }

    /// Warnings where trials are excluded more often at some levels of the factors that are compared.
    fn unequal_exclusion(&mut self, hypotheses: &[HypothesisResult]) {
        let mut factors: Vec<&str> = self.factors.first().map(String::as_str).into_iter().collect();
        for factor in hypotheses.iter().flat_map(|result| &result.factors) {
            if !factors.contains(&factor.as_str()) {
                factors.push(factor);
            }
        }
        let rates = by_factors(self.export, &factors);
        for own in &rates {
            if let Some(p) = own.p_holm.filter(|p| *p < reading::LEVEL) {
                let words = reading::unequal_exclusion(&self.naming, own, p);
                self.blocks.push(Block::Caution(words));
            }
        }
        self.results.exclusion_rates = rates;
    }

    /// A row per hypothesis.
    fn decisions(&self, hypotheses: &[HypothesisResult]) -> DecisionTable {
        let language = self.language();
        let tested = hypotheses.iter().filter(|result| result.p.is_some()).count();
        let p = match tested {
            0 | 1 => "p".to_owned(),
            _ => language.pick(
                format!("p, corrected for {tested} hypotheses (Holm)"),
                format!("p, corrigé pour {tested} hypothèses (Holm)"),
            ),
        };
        let columns = language.pick(
            ["expected", "decision", "difference or worth [95 %], or effect size", "people"],
            ["attendu", "décision", "différence ou valeur [95 %], ou taille d’effet", "personnes"],
        );
        let [hypothesis, decided, effect, people] = columns.map(str::to_owned);
        let caption = language.pick("What the hypotheses found", "Ce que donnent les hypothèses");
        let mut table = DecisionTable {
            data: DataTable::new("hypotheses", caption, [hypothesis, decided, effect, p, people]),
            ..DecisionTable::default()
        };
        let all: Vec<Vec<Effect<'_>>> = hypotheses.iter().map(effects).collect();
        let edge = |unit: EffectUnit| {
            let own = all.iter().flatten().filter(|effect| effect.unit == unit);
            let ends = own.flat_map(|effect| {
                let smallest = effect.smallest.unwrap_or(0.0);
                effect.interval.map(|end| unit.drawn(end).abs().max(smallest))
            });
            ends.filter(|end| end.is_finite()).fold(0.0, f64::max)
        };
        for (result, own) in hypotheses.iter().zip(&all) {
            let factor = result.factors.first().map_or("", String::as_str);
            let lines: Vec<String> = match own.as_slice() {
                [] => effect_size(self, result).into_iter().collect(),
                own => own.iter().map(|effect| self.effect_in_words(factor, effect)).collect(),
            };
            let found = decision(result);
            let p = deciding_p_values(result).into_iter();
            let p = p.map(|(of, p)| {
                format!("{}{}", language.p_rounded(p), reading::supports(language, of))
            });
            let p: Vec<String> = p.collect();
            let p = if p.is_empty() { "–".to_owned() } else { p.join("; ") };
            let people = match result.recommended.people {
                0 => "–".to_owned(),
                people => people.to_string(),
            };
            table.data.row([
                format!("{}. {}", result.id, result.statement),
                format!("{} {}", reading::mark(found), reading::decision_of(language, result)),
                lines.join("; "),
                p,
                people,
            ]);
            let drawn = own.iter().map(|effect| {
                let edge = edge(effect.unit).max(f64::MIN_POSITIVE);
                let place = |value: f64| effect.unit.drawn(value) / edge;
                DrawnInterval {
                    estimate: place(effect.estimate),
                    ends: effect.interval.map(place),
                    zone: effect.smallest.map(|smallest| smallest / edge),
                }
            });
            let drawn: Vec<DrawnInterval> = drawn.collect();
            let drawing = (!drawn.is_empty()).then(|| forest_row(&drawn, &lines.join("; ")));
            table.effects.push(RowEffects { lines, drawing });
        }
        table.scale = self.scale_in_words(&all, edge);
        let open =
            hypotheses.iter().any(|result| matches!(decision(result), Decision::NotShown(_)));
        if open {
            table.scale.push(' ');
            table.scale += reading::no_proof(language);
        }
        table
    }

    fn effect_in_words(&self, factor: &str, effect: &Effect<'_>) -> String {
        let language = self.language();
        let number = |value: f64| match effect.unit {
            EffectUnit::Shares => language.fixed(value * 100.0, 1),
            EffectUnit::Points | EffectUnit::Seconds | EffectUnit::Worth => {
                language.fixed(value, 2)
            }
            EffectUnit::Chosen | EffectUnit::ChosenOverOthers => language.fixed(value * 100.0, 0),
        };
        let unit = match effect.unit {
            EffectUnit::Shares => language.pick(" percentage points", " points de pourcentage"),
            EffectUnit::Seconds => " s",
            EffectUnit::Points => "",
            EffectUnit::Chosen => {
                language.pick(" % of the choices of one of them", " % des choix de l’un des deux")
            }
            EffectUnit::ChosenOverOthers => {
                language.pick(" % of choices over the others", " % des choix face aux autres")
            }
            EffectUnit::Worth => language.pick(" JND", " DJP"),
        };
        let [low, high] = effect.interval.map(number);
        let covers = match effect.covers {
            95 => String::new(),
            covers => format!("{covers} %: "),
        };
        let of = self.effect_of(factor, effect);
        let colon = language.pick(":", " :");
        format!("{of}{colon} {}{unit} [{covers}{low}; {high}]", number(effect.estimate))
    }

    /// What an effect is of, in words.
    pub(crate) fn effect_of(&self, factor: &str, effect: &Effect<'_>) -> String {
        let naming = &self.naming;
        match (effect.of, effect.unit) {
            (EffectOf::Level(level), _) => naming.level(factor, level),
            (EffectOf::Difference([a, b]), EffectUnit::Chosen) => {
                let [a, b] = [a, b].map(|level| naming.level(factor, level));
                self.language().pick(format!("{a} over {b}"), format!("{a} plutôt que {b}"))
            }
            (EffectOf::Difference([a, b]), _) => naming.pair(factor, a, b),
        }
    }

    /// How wide the drawings are, in the units that are drawn.
    fn scale_in_words(&self, all: &[Vec<Effect<'_>>], edge: impl Fn(EffectUnit) -> f64) -> String {
        let language = self.language();
        let mut units: Vec<EffectUnit> = all.iter().flatten().map(|effect| effect.unit).collect();
        units.sort_unstable();
        units.dedup();
        let ranges: Vec<String> = units
            .into_iter()
            .map(|unit| match (unit, edge(unit)) {
                (EffectUnit::Points, edge) => language.pick(
                    format!("±{} points of the scale", language.fixed(edge, 2)),
                    format!("±{} points de l’échelle", language.fixed(edge, 2)),
                ),
                (EffectUnit::Shares, edge) => language.pick(
                    format!("±{} percentage points", language.fixed(edge * 100.0, 1)),
                    format!("±{} points de pourcentage", language.fixed(edge * 100.0, 1)),
                ),
                (EffectUnit::Seconds, edge) => format!("±{} s", language.fixed(edge, 2)),
                (EffectUnit::Chosen | EffectUnit::ChosenOverOthers, edge) => {
                    let [low, high] = [0.5 - edge, 0.5 + edge].map(|share| language.percent(share));
                    language.pick(
                        format!("choices from {low} to {high}, the line at {}", language.percent(0.5)),
                        format!("choix de {low} à {high}, le trait à {}", language.percent(0.5)),
                    )
                }
                (EffectUnit::Worth, edge) => language.pick(
                    format!("±{} just noticeable differences (JND: one of two is chosen in 75 %) from the mean of all levels", language.fixed(edge, 2)),
                    format!("±{} différences juste perceptibles (DJP : l’un des deux est choisi dans 75 %) par rapport à la moyenne des niveaux", language.fixed(edge, 2)),
                ),
            })
            .collect();
        if ranges.is_empty() {
            return String::new();
        }
        let ranges = ranges.join(", ");
        language.pick(
            format!("Intervals are drawn around the line of no difference, to the edges at {ranges}."),
            format!("Les intervalles sont dessinés autour de la ligne d’une différence nulle, jusqu’aux bords à {ranges}."),
        )
    }
}

/// The effect size of the test that decides, where there is no difference of two levels to tell.
fn effect_size(writer: &Writer<'_>, result: &HypothesisResult) -> Option<String> {
    let language = writer.language();
    match result.other_clips.as_ref().filter(|found| found.decides).map(|own| own.deciding_test()) {
        None => {}
        Some(Some(DecidingTest::LinearModel(model))) => {
            return Some(reading::f_of(language, model));
        }
        Some(_) => return None,
    }
    let Outcome::Ok(line) = result.recommended.overall.last()? else { return None };
    let effect = line.row.effect?;
    Some(format!("{} = {}", line.names.effect_symbol, language.fixed(effect, 2)))
}
