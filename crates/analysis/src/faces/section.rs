//! What the report says of blocks of reverse correlation.

use mimique_locale::{Language, counted, counted_in_french};
use mimique_report::document::{Block, DataTable, Figure, slug};
use mimique_stats::{CategoryImages, GroupImage, UnitCourse};

use super::figure::{ImageWords, face, image};
use super::played::{DrawnHead, PlayedWords};
use super::{BlockImages, FoundImages, LEVEL, PERMUTATIONS, images, is_present};
use crate::naming::people_counted;
use crate::report::section::Writer;

impl Writer<'_> {
    /// The images of each category, for each block of reverse correlation.
    pub(crate) fn faces(&mut self) {
        for FoundImages { block, found } in images(self.export, self.study, PERMUTATIONS) {
            let language = self.language();
            self.blocks.push(Block::Heading(
                2,
                language.pick(
                    format!("Faces that people have in mind: {block}"),
                    format!("Les visages que les gens ont en tête : {block}"),
                ),
            ));
            match found {
                Some(found) => {
                    self.images(&found);
                    self.results.faces.push(found);
                }
                None => self.blocks.push(Block::Caution(
                    language
                        .pick(
                            "All answers are of one category: there is nothing to hold them against, and no image.",
                            "Toutes les réponses sont de la même catégorie : il n’y a rien à quoi les comparer, ni image.",
                        )
                        .to_owned(),
                )),
            }
        }
    }

    fn images(&mut self, found: &BlockImages) {
        let language = self.language();
        let images = &found.images;
        let (people, trials) = (images.participants, images.n);
        let (draws, seed) = (images.permutations, images.seed);
        self.blocks.push(Block::Paragraph(language.pick(
            format!("Dynamic reverse correlation (Yu, Garrod and Schyns 2012): {trials} trials of {} showed action units at random. An image tells which units at which times are more active in trials answered with its category than in all others. Each person’s answers were dealt anew over that person’s trials, {draws} times (seed {seed}); p is corrected over all units and times of an image (largest |z|), not over categories. A small p says that somebody’s answers depend on the unit; the column of people says how many do so visibly by themselves.", people_counted(language, people)),
            format!("Corrélation inverse dynamique (Yu, Garrod et Schyns 2012) : {trials} essais de {} ont montré des unités d’action au hasard. Une image dit quelles unités, à quels moments, sont plus actives dans les essais de sa catégorie que dans tous les autres. Les réponses de chaque personne ont été redistribuées sur ses essais, {draws} fois (graine {seed}) ; p est corrigé sur toutes les unités et tous les moments d’une image (plus grand |z|), non sur les catégories. Un petit p dit que les réponses de quelqu’un dépendent de l’unité ; la colonne des personnes dit chez combien cela se voit séparément.", people_counted(language, people)),
        )));
        if found.not_replayed > 0 {
            let count = found.not_replayed;
            self.blocks.push(Block::Caution(language.pick(
                format!("Error: the weights that were shown in {} are not those that the seed gives again. What was shown so is left out; look at the column weights_expected.", counted(count, "trial")),
                format!("Erreur : les poids montrés dans {} ne sont pas ceux que la graine redonne. Ce qui a été montré ainsi est écarté ; voyez la colonne weights_expected.", counted_in_french(count, "essai", "essais")),
            )));
        }
        let head = DrawnHead::new();
        for category in images.categories.iter().filter(|category| category.answers > 0) {
            self.category(&head, found, category);
        }
    }

    fn category(&mut self, head: &DrawnHead, found: &BlockImages, category: &CategoryImages) {
        let language = self.language();
        let name = self.option(&found.block, &category.category);
        self.blocks.push(Block::Heading(3, name.clone()));
        let Some(group) = category.group.clone().ok() else {
            self.blocks.push(Block::Paragraph(language.pick(
                "Nobody answered so in some trials and not in all: there is no image.",
                "Personne n’a répondu ainsi dans certains essais et pas dans tous : il n’y a pas d’image.",
            ).to_owned()));
            return;
        };
        let answers =
            language.counted(category.answers, ["answer", "answers"], ["réponse", "réponses"]);
        let people = category.people;
        let seen = group.units.iter().filter(|unit| is_present(unit));
        let seen: Vec<String> = seen.map(|unit| unit.unit.clone()).collect();
        let units = if seen.is_empty() {
            language.pick("no unit", "aucune unité").to_owned()
        } else {
            seen.join(", ")
        };
        self.blocks.push(Block::Reading(language.pick(
            format!(
                "{name} ({answers}, {}): more often answered where the face shows {units}.",
                people_counted(language, people)
            ),
            format!(
                "{name} ({answers}, {}) : plus souvent répondu quand le visage montre {units}.",
                people_counted(language, people)
            ),
        )));
        self.image_figure(found, &name, category, &group);
        self.unit_table(found, &name, category, &group);
        if !group.face.is_empty() {
            self.face_figure(head, found, (&name, category), &group.face);
        }
    }

    /// What an option of the block's question is called.
    fn option(&self, block: &str, value: &str) -> String {
        let block = self.study.reverse_correlations().find(|(name, _)| *name == block);
        let question = block.map(|(_, block)| block.question).unwrap_or_default();
        self.naming.level(&question, value)
    }

    fn image_figure(
        &mut self,
        found: &BlockImages,
        name: &str,
        category: &CategoryImages,
        group: &GroupImage,
    ) {
        let language = self.language();
        let caption = language.pick(
            format!("{name}: z of each action unit over time; framed where the corrected p is 0.05 or less"),
            format!("{name} : z de chaque unité d’action au fil du temps ; encadré là où le p corrigé est de 0,05 ou moins"),
        );
        let words = ImageWords {
            title: caption.clone(),
            seconds: language.pick("seconds", "secondes"),
            ends: language.pick(["less", "more"], ["moins", "plus"]),
        };
        let svg = image(&words, group, &found.images.times_s);
        let id = format!("{}-{}", slug(&found.block), slug(&category.category));
        let seconds = found.images.times_s.iter().map(|time| format!("{time:.3}"));
        let columns = std::iter::once(language.pick("unit", "unité").to_owned()).chain(seconds);
        let mut data = DataTable::new(&id, &caption, columns);
        for unit in &group.units {
            let z = unit.z.iter().map(|z| format!("{z:.4}"));
            data.row(std::iter::once(unit.unit.clone()).chain(z));
        }
        let framed = group.units.iter().filter(|unit| unit.p.iter().any(|p| *p <= LEVEL));
        let framed: Vec<&str> = framed.map(|unit| unit.unit.as_str()).collect();
        let alt = language.pick(
            format!(
                "Heat map of {} action units by {} times. Significant at some time: {}.",
                group.units.len(),
                found.images.times_s.len(),
                listed(language, &framed, "none")
            ),
            format!(
                "Carte de {} unités d’action par {} moments. Significatives à un moment : {}.",
                group.units.len(),
                found.images.times_s.len(),
                listed(language, &framed, "aucune")
            ),
        );
        self.figure(Figure { id, caption, alt, svg, data });
    }

    fn unit_table(
        &mut self,
        found: &BlockImages,
        name: &str,
        category: &CategoryImages,
        group: &GroupImage,
    ) {
        let language = self.language();
        let caption = language.pick(
            format!("{name}: presence of each unit (p corrected over units)"),
            format!("{name} : présence de chaque unité (p corrigé sur les unités)"),
        );
        let has_intensity = group.critical_z_intensity.is_some();
        let mut columns = language
            .pick(
                ["unit", "share more", "z", "p (corrected)", "people", "bits"],
                ["unité", "part en plus", "z", "p (corrigé)", "personnes", "bits"],
            )
            .to_vec();
        if has_intensity {
            columns.extend(language.pick(
                ["intensity per amplitude", "p (corrected)"],
                ["intensité par amplitude", "p (corrigé)"],
            ));
        }
        let id = format!("{}-{}-units", slug(&found.block), slug(&category.category));
        let mut table = DataTable::new(id, caption, columns);
        for unit in &group.units {
            let mut cells = vec![
                unit.unit.clone(),
                language.fixed(unit.presence.effect, 3),
                language.fixed(unit.presence.z, 2),
                language.p_cell(unit.presence.p, unit.presence.p.ln()),
                unit.people.to_string(),
                language.fixed(unit.information_bits, 3),
            ];
            if has_intensity {
                let slope = unit.intensity.map_or_else(
                    || [String::new(), String::new()],
                    |own| [language.fixed(own.effect, 2), language.p_cell(own.p, own.p.ln())],
                );
                cells.extend(slope);
            }
            table.row(cells);
        }
        self.blocks.push(Block::Table(table));
    }

    /// The face in mind; its data are recorded weights, which every avatar that has these units plays.
    fn face_figure(
        &mut self,
        head: &DrawnHead,
        found: &BlockImages,
        (name, category): (&str, &CategoryImages),
        courses: &[UnitCourse],
    ) {
        let language = self.language();
        let id = format!("{}-{}-face", slug(&found.block), slug(&category.category));
        let caption = language.pick(
            format!("{name}: the face that people have in mind, drawn on the built-in head, and the mean activation of each unit that goes with it. The figure’s table is a file of recorded weights, which the studio plays on every avatar that has these units, as does a study that names it as a capture"),
            format!("{name} : le visage que les gens ont en tête, dessiné sur la tête intégrée, et l’activation moyenne de chaque unité qui l’accompagne. Le tableau de la figure est un fichier de poids enregistrés, que le studio joue sur tout avatar qui a ces unités, comme le fait une étude qui le nomme comme capture"),
        );
        let bins = found.images.times_s.len();
        let width = found.images.times_s.first().map_or(1.0, |first| 2.0 * first);
        let axes = language.pick(["activation", "seconds"], ["activation", "secondes"]);
        let played = PlayedWords {
            press: language
                .pick("Press the face to see it move", "Appuyez sur le visage pour le voir bouger"),
            seconds: "s",
        };
        let of_face = (courses, width * bins as f64);
        let svg = face(&caption, of_face, (head, &played_id(&id), &played), axes);
        let names = courses.iter().map(|course| course.unit.clone());
        let columns = ["frame".to_owned(), "time".to_owned()].into_iter().chain(names);
        let mut data = DataTable::new(&id, &caption, columns);
        // It begins and ends at rest, a frame a bin.
        for frame in 0..bins + 2 {
            let at = |course: &UnitCourse| {
                let bin = frame.checked_sub(1).and_then(|bin| course.activation.get(bin));
                format!("{:.4}", bin.copied().unwrap_or_default())
            };
            let place = [frame.to_string(), format!("{:.4}", frame as f64 * width)];
            data.row(place.into_iter().chain(courses.iter().map(at)));
        }
        let peak = |course: &UnitCourse| {
            let highest = course.activation.iter().copied().fold(0.0, f64::max);
            format!("{} {}", course.unit, language.fixed(highest, 2))
        };
        let peaks: Vec<String> = courses.iter().map(peak).collect();
        let alt = language.pick(
            format!("A face in lines, still at four moments and moving when it is pressed; below it lines over the seconds of the clip, highest: {}.", peaks.join(", ")),
            format!(
                "Un visage au trait, immobile à quatre moments et en mouvement quand on appuie dessus ; au-dessous, des courbes au fil des secondes de l’extrait, au plus haut : {}.",
                peaks.join(", ")
            ),
        );
        self.figure(Figure { id, caption, alt, svg, data });
    }
}

/// What is pressed. Times of an animation are said as `ID.click`, where a hyphen would be a minus.
fn played_id(figure: &str) -> String {
    format!("{}_played", figure.replace('-', "_"))
}

fn listed(language: Language, names: &[&str], none: &str) -> String {
    if names.is_empty() { none.to_owned() } else { language.list(names) }
}
