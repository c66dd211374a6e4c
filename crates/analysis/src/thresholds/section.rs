//! What the report says of adaptive blocks.

use mimique_report::document::{Block, DataTable, Figure, slug};

use super::figure::{FigureWords, curve_and_track};
use super::{BlockThresholds, PersonThreshold, ROUNDS, Threshold, thresholds};
use crate::report::section::Writer;

/// People whose track and curve are drawn, at most.
const MOST_DRAWN: usize = 6;

impl Writer<'_> {
    /// The thresholds of people and their mean, for each adaptive block.
    pub(crate) fn thresholds(&mut self) {
        for block in thresholds(self.export, self.study, ROUNDS) {
            self.block_thresholds(&block);
            self.results.thresholds.push(block);
        }
    }

    fn block_thresholds(&mut self, block: &BlockThresholds) {
        let language = self.language();
        let BlockThresholds { block: name, parameter, people, mean, .. } = block;
        self.blocks.push(Block::Heading(
            2,
            language.pick(format!("Threshold: {name}"), format!("Seuil : {name}")),
        ));
        let half = if block.yes_no {
            language.pick(
                "half of the way from none to the best share of yes is reached: 50 % without lapses",
                "est atteinte la moitié du chemin de zéro à la meilleure proportion de oui : 50 % sans inattention",
            )
        } else {
            language.pick(
                "half of the way from chance to the best share of right answers is reached: 75 % are right without lapses",
                "est atteinte la moitié du chemin entre le hasard et la meilleure proportion de bonnes réponses : 75 % sans inattention",
            )
        };
        self.blocks.push(Block::Paragraph(language.pick(
            format!("The threshold is the level of {parameter} at which {half}. Each person's function is fitted by maximum likelihood, its lapse from 0 to 0.2 with the prior Beta(1, 10); the interval runs the rule that chose the levels 1000 times with answers of the fitted function. Slopes from levels that follow the answers are biased upwards, and no test of them stands here."),
            format!("Le seuil est le niveau de {parameter} auquel {half}. La fonction de chaque personne est ajustée par maximum de vraisemblance, l’inattention de 0 à 0,2 avec la loi a priori Bêta(1, 10) ; l’intervalle rejoue 1000 fois la règle qui choisit les niveaux, avec des réponses de la fonction ajustée. Les pentes tirées de niveaux qui suivent les réponses sont biaisées vers le haut ; aucun test n’en figure ici."),
        )));
        let summary = match mean.clone().ok() {
            Some(found) => {
                let interval = found.mean_ci_t.map_or_else(String::new, |[low, high]| {
                    let ends = [low, high].map(|end| language.fixed(end, 3));
                    language.pick(
                        format!(", 95 % interval {} to {} (t)", ends[0], ends[1]),
                        format!(", intervalle à 95 % de {} à {} (t)", ends[0], ends[1]),
                    )
                });
                let mean = language.fixed(found.mean, 3);
                language.pick(
                    format!("The mean threshold is {mean}{interval}, of the {} of {} people whose threshold lies within the levels. Where some are left out, the mean is biased towards the levels.", found.n, people.len()),
                    format!("Le seuil moyen est {mean}{interval}, sur les {} personnes (de {}) dont le seuil est dans les niveaux. Si d’autres sont écartées, la moyenne est biaisée vers les niveaux.", found.n, people.len()),
                )
            }
            None => language.pick(
                "Nobody's threshold lies within the levels: there is no mean.".to_owned(),
                "Aucun seuil n’est dans les niveaux : il n’y a pas de moyenne.".to_owned(),
            ),
        };
        self.blocks.push(Block::Paragraph(summary));
        let wrong: Vec<&str> = people
            .iter()
            .filter(|own| own.threshold == Threshold::NotReplayed)
            .map(|own| own.participant.as_str())
            .collect();
        if !wrong.is_empty() {
            let who = wrong.join(", ");
            self.blocks.push(Block::Paragraph(language.pick(
                format!("Error: seed and answers do not give the levels that were recorded for {who}. Their thresholds are left out; look at the column level_replayed."),
                format!("Erreur : la graine et les réponses ne donnent pas les niveaux enregistrés pour {who}. Leurs seuils sont écartés ; voyez la colonne level_replayed."),
            )));
        }
        if block.yes_no {
            self.false_alarms(block);
        }
        let table = self.threshold_table(block);
        self.blocks.push(Block::Table(table));
        for person in people.iter().take(MOST_DRAWN) {
            self.threshold_figure(block, person);
        }
    }

    /// How often people say yes without a difference, which moves their thresholds.
    fn false_alarms(&mut self, block: &BlockThresholds) {
        let language = self.language();
        let sums = block.people.iter().fold([0, 0], |[all, right], own| {
            let [own_all, own_right] = own.catches;
            [all + own_all, right + own_right]
        });
        let [all, said_yes] = [sums[0], sums[0] - sums[1]];
        self.blocks.push(Block::Paragraph(language.pick(
            format!("In {said_yes} of {all} catch trials, which showed no difference, people said yes. A threshold of yes or no depends on what somebody sees and on how readily they say yes, and the fitted function takes nobody to say yes to nothing: who says it often in catch trials has a threshold that is too low. A question of which clip is the varied one is free of this."),
            format!("À {said_yes} des {all} essais pièges, qui ne montraient aucune différence, la réponse était oui. Un seuil par oui ou non dépend de ce que l’on voit et de la facilité à dire oui, et la fonction ajustée suppose que personne ne dit oui à rien : qui le dit souvent aux essais pièges a un seuil trop bas. La question de savoir lequel des extraits est modifié en est exempte."),
        )));
    }

    fn threshold_table(&self, block: &BlockThresholds) -> DataTable {
        let BlockThresholds { block: name, people, levels, .. } = block;
        let language = self.language();
        let columns = language.pick(
            ["person", "threshold", "95 %", "spread", "lapse", "answers", "catch trials right"],
            [
                "personne",
                "seuil",
                "95 %",
                "étendue",
                "inattention",
                "réponses",
                "essais pièges réussis",
            ],
        );
        let caption = language.pick(format!("Thresholds of {name}"), format!("Seuils de {name}"));
        let mut table = DataTable::new(format!("{}-thresholds", slug(name)), caption, columns);
        for own in people {
            let number = |value: f64| language.fixed(value, 3);
            // Beyond the levels the function is not seen.
            let end = |end: f64| {
                self.threshold_words(match (end < levels[0], end > levels[1]) {
                    (true, _) => Threshold::Below(levels[0]),
                    (_, true) => Threshold::Above(levels[1]),
                    _ => Threshold::At(end),
                })
            };
            let interval = own
                .interval
                .map_or_else(String::new, |[low, high]| format!("{} – {}", end(low), end(high)));
            table.row([
                own.participant.clone(),
                self.threshold_words(own.threshold),
                interval,
                own.fit.map_or_else(String::new, |fit| number(fit.scale_or_shape)),
                own.fit.map_or_else(String::new, |fit| number(fit.lapse_estimate)),
                own.answers.to_string(),
                format!("{}/{}", own.catches[1], own.catches[0]),
            ]);
        }
        table
    }

    fn threshold_words(&self, threshold: Threshold) -> String {
        let language = self.language();
        let number = |value: f64| language.number(value);
        match threshold {
            Threshold::At(level) => language.fixed(level, 3),
            Threshold::Above(level) => language.pick(
                format!("above {}", number(level)),
                format!("au-dessus de {}", number(level)),
            ),
            Threshold::Below(level) => language.pick(
                format!("below {}", number(level)),
                format!("au-dessous de {}", number(level)),
            ),
            Threshold::Between([low, high]) => language.pick(
                format!("between {} and {}", number(low), number(high)),
                format!("entre {} et {}", number(low), number(high)),
            ),
            Threshold::Unknown => {
                language.pick("the answers do not tell", "les réponses n’en disent rien").to_owned()
            }
            Threshold::NotReplayed => {
                language.pick("levels not replayed", "niveaux non retrouvés").to_owned()
            }
        }
    }

    fn threshold_figure(&mut self, block: &BlockThresholds, person: &PersonThreshold) {
        let language = self.language();
        let Some((_, own)) = self.study.adaptive().find(|(name, _)| *name == block.block) else {
            return;
        };
        let who = &person.participant;
        let caption = language.pick(
            format!("{}: track and function of {who}", block.block),
            format!("{} : suite des niveaux et fonction de {who}", block.block),
        );
        let words = FigureWords {
            title: caption.clone(),
            level: block.parameter.clone(),
            trial: language.pick("trial", "essai"),
            share: if block.yes_no {
                language.pick("share of yes", "proportion de oui")
            } else {
                language.pick("share right", "proportion juste")
            },
        };
        let svg = curve_and_track(&words, &person.shown, person.fit.as_ref(), &own.vary);
        let columns = language.pick(["track", "level", "right"], ["suite", "niveau", "juste"]);
        let id = format!("{}-track-{}", slug(&block.block), slug(who));
        let mut data = DataTable::new(format!("{id}-data"), &caption, columns);
        for answer in &person.shown {
            data.row([
                answer.track.to_string(),
                language.number(answer.level),
                u8::from(answer.right).to_string(),
            ]);
        }
        let [filled, counted] = if block.yes_no {
            language.pick(["the answer was yes", "yes"], ["la réponse était oui", "oui"])
        } else {
            language.pick(
                ["the answer was right", "right answers"],
                ["la réponse était juste", "bonnes réponses"],
            )
        };
        let alt = language.pick(
            format!("Levels of {} trials in their order, filled where {filled}, and the share of {counted} by level with the fitted function.", person.shown.len()),
            format!("Niveaux de {} essais dans leur ordre, pleins où {filled}, et la proportion de {counted} par niveau avec la fonction ajustée.", person.shown.len()),
        );
        self.blocks.push(Block::Figure(Figure { id, caption, alt, svg, data }));
    }
}
