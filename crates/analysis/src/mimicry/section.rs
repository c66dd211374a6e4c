//! What the report says of mimicry.

use mimique_locale::Language;
use mimique_report::document::{Block, DataTable};
use mimique_stats::Surrogates;

use super::figure::curve;
use super::{FoundMimicry, LeftOut, MimicryResult, mimicry};
use crate::naming::people_counted;
use crate::report::section::Writer;

impl Writer<'_> {
    /// How people's faces followed the clips; nothing of studies that measure no faces.
    pub(crate) fn mimicry(&mut self) {
        if self.study.mimicry.is_none() {
            return;
        }
        let language = self.language();
        self.heading(2, "Mimicry", "Mimétisme facial");
        let Some(tables) = self.faces_measured else {
            self.paragraph(
                "The study measures faces. This report was made without them: `mimique analyze` takes them as --tracks and --courses.",
                "L’étude mesure des visages. Ce rapport a été fait sans eux : `mimique analyze` les prend par --tracks et --courses.",
            );
            return;
        };
        let clips = self.study.clips();
        let level_of = |clip: &str, factor: &str| {
            let clip = clips.iter().find(|own| own.id == clip)?;
            clip.factors.get(factor).map(ToString::to_string)
        };
        let seed = self.study.seed;
        match mimicry(tables, self.export, &self.factors, seed, &level_of) {
            FoundMimicry::Nothing(left_out) => {
                let why = left_out.words(language);
                self.blocks.push(Block::Caution(language.pick(
                    format!("No play can be used: {why}."),
                    format!("Aucune lecture ne peut être utilisée : {why}."),
                )));
            }
            FoundMimicry::Found(found) => {
                self.found_mimicry(&found);
                self.results.mimicry = Some(*found);
            }
        }
    }

    fn found_mimicry(&mut self, found: &MimicryResult) {
        let language = self.language();
        let all = &found.all;
        let people = all.participants;
        let plays = language.counted(all.n, ["play", "plays"], ["lecture", "lectures"]);
        let surrogates = match all.kind {
            Surrogates::OtherClips => language.pick(
                "what a person did is held against the clips that the same person saw, dealt anew over that person’s plays",
                "ce qu’a fait une personne est comparé aux extraits vus par la même personne, redistribués sur ses lectures",
            ),
            Surrogates::Shifted => language.pick(
                "what a person did is turned round in time against its own clip (few clips per person: this is less exact)",
                "ce qu’a fait une personne est décalé circulairement dans le temps par rapport à son extrait (peu d’extraits par personne : c’est moins exact)",
            ),
        };
        let (count, seed) = (all.surrogates, all.seed);
        self.blocks.push(Block::Paragraph(language.pick(
            format!("How the faces of {} went with the faces that they saw, in {plays}: Pearson’s correlation of each shape’s weight in the clip with its score in the person’s face, at lags from −0.5 to 1.5 s, over shapes that the clip moves (gaze and blinks left out); the mean of Fisher’s z over shapes, then plays, then people (lagged cross-correlation: Boker et al. 2002). The test takes the highest value over all lags. In {count} surrogates (seed {seed}) {surrogates} (Moulder et al. 2018); p is corrected over lags, since the highest value is taken in the surrogates, too. A correlation says that faces went together in time; it says neither how strongly they moved nor why.", people_counted(language, people)),
            format!("Comment les visages de {} ont suivi ceux qu’elles voyaient, en {plays} : corrélation de Pearson du poids de chaque forme dans l’extrait avec son score dans le visage de la personne, aux décalages de −0,5 à 1,5 s, sur les formes que l’extrait anime (regard et clignements exclus) ; moyenne du z de Fisher sur les formes, puis les lectures, puis les personnes (corrélation croisée décalée : Boker et coll. 2002). Le test prend la plus haute valeur sur tous les décalages. Dans {count} substituts (graine {seed}), {surrogates} (Moulder et coll. 2018) ; p est corrigé pour les décalages, puisque la plus haute valeur est prise aussi dans les substituts. Une corrélation dit que les visages allaient ensemble dans le temps ; elle ne dit ni l’ampleur des mouvements, ni leur cause.", people_counted(language, people)),
        )));
        let (r, lag, p) = (
            language.fixed(all.highest_r, 3),
            language.fixed(all.lag_s, 2),
            language.p(all.p_value),
        );
        let is_clear = all.p_value <= 0.05;
        let follows = all.lag_s > 0.0;
        self.blocks.push(Block::Reading(match (is_clear, follows) {
            (true, true) => language.pick(
                format!("People’s faces followed the clips: the mean correlation is highest, {r}, {lag} s after the clip ({p})."),
                format!("Les visages ont suivi les extraits : la corrélation moyenne culmine, à {r}, {lag} s après l’extrait ({p})."),
            ),
            (true, false) => language.pick(
                format!("People’s faces went with the clips, and did not come after them: the mean correlation is highest, {r}, at a lag of {lag} s ({p}). Nobody follows what has not been shown yet: look at the times of the camera, or at what all clips have in common."),
                format!("Les visages allaient avec les extraits, sans venir après : la corrélation moyenne culmine, à {r}, pour un décalage de {lag} s ({p}). Personne ne suit ce qui n’a pas encore été montré : vérifiez les temps de la caméra, ou ce que tous les extraits ont en commun."),
            ),
            (false, _) => language.pick(
                format!("That people’s faces followed the clips is not shown: the highest mean correlation is {r}, at {lag} s ({p})."),
                format!("Il n’est pas montré que les visages ont suivi les extraits : la plus haute corrélation moyenne est {r}, à {lag} s ({p})."),
            ),
        }));
        if found.left_out != LeftOut::default() {
            let why = found.left_out.words(language);
            self.blocks.push(Block::Paragraph(language.pick(
                format!("Plays left out: {why}."),
                format!("Lectures laissées de côté : {why}."),
            )));
        }
        let caption = language.pick(
            "Mean correlation of faces and clips by lag",
            "Corrélation moyenne des visages et des extraits selon le décalage",
        );
        self.figure(curve(language, "mimicry-by-lag", caption, all));
        if !found.levels.is_empty() {
            let table = self.by_level(found);
            self.blocks.push(Block::Table(table));
        }
        let table = self.by_clip(found);
        self.folded_table(table);
    }

    fn by_level(&self, found: &MimicryResult) -> DataTable {
        let language = self.language();
        let caption = language.pick(
            "Mimicry by the levels of the factors, each tested by itself",
            "Mimétisme selon les niveaux des facteurs, chacun testé à part",
        );
        let columns = language.pick(
            [
                "factor",
                "level",
                "people",
                "plays",
                "highest r",
                "lag (s)",
                "p (corrected over lags)",
            ],
            [
                "facteur",
                "niveau",
                "personnes",
                "lectures",
                "r le plus haut",
                "décalage (s)",
                "p (corrigé pour les décalages)",
            ],
        );
        let mut table = DataTable::new("mimicry-by-level", caption, columns);
        for own in &found.levels {
            let it = &own.found;
            table.row([
                self.naming.factor(&own.factor),
                self.naming.level(&own.factor, &own.level),
                it.participants.to_string(),
                it.n.to_string(),
                language.fixed(it.highest_r, 3),
                language.fixed(it.lag_s, 2),
                language.p_rounded(it.p_value),
            ]);
        }
        table
    }

    fn by_clip(&self, found: &MimicryResult) -> DataTable {
        let language = self.language();
        let lag = language.fixed(found.all.lag_s, 2);
        let caption = language.pick(
            format!("Mean correlation by clip at a lag of {lag} s"),
            format!("Corrélation moyenne par extrait au décalage de {lag} s"),
        );
        let columns = language
            .pick(["clip", "people", "r", "from", "to"], ["extrait", "personnes", "r", "de", "à"]);
        let mut table = DataTable::new("mimicry-by-clip", caption, columns);
        for own in &found.clips {
            let cell = |value: f64| match value.is_finite() {
                true => language.fixed(value, 3),
                false => String::new(),
            };
            let [from, to] =
                own.interval_95.map_or([String::new(), String::new()], |it| it.map(cell));
            table.row([own.clip.clone(), own.people.to_string(), cell(own.r), from, to]);
        }
        table
    }
}

impl LeftOut {
    /// Counts and reasons.
    fn words(&self, language: Language) -> String {
        let reasons = [
            (
                self.excluded,
                "of people or trials that are left out",
                "de personnes ou d’essais laissés de côté",
            ),
            (
                self.unknown_clip,
                "of clips of which nothing is known in the table of courses",
                "d’extraits dont la table des cours ne dit rien",
            ),
            (
                self.moves_nothing,
                "of clips that move no shape with one of ARKit’s names",
                "d’extraits qui n’animent aucune forme aux noms d’ARKit",
            ),
            (
                self.too_little,
                "in which a face was seen for less than a second, or did not move",
                "où un visage a été vu moins d’une seconde, ou n’a pas bougé",
            ),
        ];
        let told: Vec<String> = reasons
            .into_iter()
            .filter(|(count, ..)| *count > 0)
            .map(|(count, english, french)| format!("{count} {}", language.pick(english, french)))
            .collect();
        match told.is_empty() {
            true => language.pick("no face was measured", "aucun visage n’a été mesuré").to_owned(),
            false => told.join(", "),
        }
    }
}
