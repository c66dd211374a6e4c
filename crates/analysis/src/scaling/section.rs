//! What the report says of blocks of difference scaling.

use mimique_report::document::{Block, DataTable, Figure, slug};
use mimique_stats::{DifferenceScale, Outcome};

use super::{BlockScale, ROUNDS, figure, scales};
use crate::naming::people_counted;
use crate::report::section::Writer;

impl Writer<'_> {
    /// The perceived scale of each block of difference scaling.
    pub(crate) fn scalings(&mut self) {
        for block in scales(self.export, self.study, ROUNDS) {
            self.scaling(&block);
            self.results.scalings.push(block);
        }
    }

    fn scaling(&mut self, block: &BlockScale) {
        let language = self.language();
        let BlockScale { block: name, parameter, scale, .. } = block;
        self.blocks.push(Block::Heading(
            2,
            language.pick(format!("Perceived scale: {name}"), format!("Échelle perçue : {name}")),
        ));
        let found = match scale {
            Outcome::Ok(found) => found.clone(),
            Outcome::Undefined { reason, .. } => {
                let why = reason.words(language);
                self.blocks.push(Block::Caution(language.pick(
                    format!("The answers give no scale: {why}."),
                    format!("Les réponses ne donnent pas d’échelle : {why}."),
                )));
                return;
            }
        };
        let (trials, people) = (found.trials, found.participants);
        self.blocks.push(Block::Paragraph(language.pick(
            format!("Maximum likelihood difference scaling (Maloney and Yang 2003) of {trials} judgements of {}: ψ is what is perceived of {parameter}; the lowest level has 0, and the unit is the standard deviation of one judgement, so that a step of 1 between two differences is told right in 84 % of judgements. Where the curve is flat, levels look alike.", people_counted(language, people)),
            format!("Mise à l’échelle des différences par maximum de vraisemblance (Maloney et Yang 2003) de {trials} jugements de {} : ψ est ce qui est perçu de {parameter} ; le niveau le plus bas vaut 0 et l’unité est l’écart-type d’un jugement, si bien qu’un écart de 1 entre deux différences est bien jugé dans 84 % des cas. Là où la courbe est plate, les niveaux se ressemblent.", people_counted(language, people)),
        )));
        if found.interval.is_some() {
            let (rounds, seed, without) = (found.rounds, found.seed, found.without_scale);
            self.blocks.push(Block::Paragraph(language.pick(
                format!("The 95 % intervals resample people {rounds} times (seed {seed}); {without} draws gave no scale and are left out."),
                format!("Les intervalles à 95 % rééchantillonnent les personnes {rounds} fois (graine {seed}) ; {without} tirages n’ont pas donné d’échelle et sont écartés."),
            )));
        }
        let caption = language.pick(
            format!("{name}: perceived value by {parameter}, with 95 % intervals"),
            format!("{name} : valeur perçue selon {parameter}, avec des intervalles à 95 %"),
        );
        let axis =
            language.pick("ψ, standard deviations of a judgement", "ψ, écarts-types d’un jugement");
        let svg = figure::scale(&caption, axis, parameter, &found);
        let data = self.perceived_table(name, &caption, &found);
        let highest = found.scale.last().copied().unwrap_or_default();
        let highest = language.fixed(highest, 2);
        let alt = language.pick(
            format!("A curve over {} levels that comes to ψ = {highest}.", found.levels.len()),
            format!("Une courbe sur {} niveaux qui atteint ψ = {highest}.", found.levels.len()),
        );
        let id = format!("{}-scale", slug(name));
        self.blocks.push(Block::Table(data.clone()));
        let data = DataTable { id: format!("{id}-data"), ..data };
        self.figure(Figure { id, caption, alt, svg, data });
    }

    fn perceived_table(&self, name: &str, caption: &str, found: &DifferenceScale) -> DataTable {
        let language = self.language();
        let columns = language.pick(
            ["level", "ψ", "standard error", "95 %", "ψ where the highest is 1"],
            ["niveau", "ψ", "erreur-type", "95 %", "ψ si le plus haut vaut 1"],
        );
        let mut table = DataTable::new(format!("{}-scale", slug(name)), caption, columns);
        for (place, level) in found.levels.iter().enumerate() {
            let interval = found.interval.as_ref().and_then(|all| all.get(place));
            let interval = interval.map_or_else(String::new, |[low, high]| {
                format!("{} – {}", language.fixed(*low, 2), language.fixed(*high, 2))
            });
            let share = found.scale_to_1.as_ref().and_then(|all| all.get(place));
            table.row([
                language.number(*level),
                language.fixed(found.scale[place], 3),
                language.fixed(found.se[place], 3),
                interval,
                share.map_or_else(String::new, |share| language.fixed(*share, 3)),
            ]);
        }
        table
    }
}
