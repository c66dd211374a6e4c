//! What a simulated person answers to each kind of trial, and to a page.

use mimique_session::LevelShown;
use mimique_session::flow::{Input, Panel};
use mimique_study::{Answers, KindOfQuestion as _};

use super::panels::RatedPage;
use super::person::{Companion, Raw, as_json};
use super::session::Walk;

impl Walk<'_, '_> {
    pub(super) fn answer_trial(&mut self, clip: &str, training: bool) {
        let here = self.page.state.record.step;
        if let Some(shown) = self.page.state.record.attempt.level.clone() {
            self.answer_level(&shown);
            return;
        }
        let trial = self.page.plan.steps[here].trial();
        if trial.is_some_and(|trial| trial.face.is_some()) {
            self.answer_face();
            return;
        }
        if let Some(panel) = trial.and_then(|trial| trial.panel.as_deref().cloned()) {
            match panel.is_rated() {
                true => self.answer_panel(&panel),
                false => self.answer_differences(&panel),
            }
            return;
        }
        let Some(clip) = self.model.clip(clip) else { return };
        let chosen = self.page.state.record.chosen(&self.page.plan.steps[here]);
        let beside = trial.and_then(|trial| trial.pair(chosen.as_ref()).1);
        let beside =
            beside.and_then(|(clip, left)| Some(Companion { clip: self.model.clip(clip)?, left }));
        for question in self.page.plan.steps[here].questions() {
            let record = &self.page.state.record;
            if !question.is_shown(&record.drafts, &record.answers) {
                continue;
            }
            let Some(place) = self.model.question(&question.id) else { continue };
            if question.kind.is_traced() {
                continue;
            }
            if question.kind.keys().is_some() {
                // Whoever has not pressed while the clip was played does so now.
                let (id, clip) = (question.id.clone(), self.model.clips[clip].id.clone());
                if self.page.state.record.draft(&id).is_none()
                    && let Some((value, ms)) = self.pressed(&id, &clip, training)
                {
                    self.page.wait(ms);
                    let at_ms = self.page.now_ms;
                    self.page.send(Input::Press { question: id, value, at_ms });
                }
                continue;
            }
            let person = if training { &mut self.practice } else { &mut self.person };
            let ms = person.answering_ms(Some(clip));
            let Some(raw) = person.trial_answer(place, clip, beside, self.trial) else { continue };
            let value = as_json(&self.model.questions[place], raw);
            self.page.wait(ms);
            self.page.send(Input::Answer { question: question.id.clone(), value });
        }
        self.read(500.0);
    }

    /// Each clip of a panel, from the first place to the last.
    fn answer_panel(&mut self, panel: &Panel) {
        let step = &self.page.plan.steps[self.page.state.record.step];
        let number = self.page.plan.started.participant;
        let page = RatedPage::of(self.model.parameters, self.seed, number, &step.id);
        let Some(place) = self.model.question(&panel.question) else { return };
        for (question, id) in step.questions().iter().zip(&panel.clips) {
            let Some(clip) = self.model.clip(id) else { continue };
            let ms = self.person.answering_ms(Some(clip));
            let found = page.is_found(panel, id) && !self.person.is_careless();
            let raw = match question.kind.bounds() {
                Some([_, Some(most)]) if found => Some(Raw::Number(most)),
                _ => self.person.panel_answer(place, clip, page.shift, self.trial),
            };
            let Some(raw) = raw else { continue };
            let value = as_json(&self.model.questions[place], raw);
            self.page.wait(ms);
            self.page.send(Input::Answer { question: question.id.clone(), value });
        }
        self.read(500.0);
    }

    /// What a face is that was drawn for this trial.
    fn answer_face(&mut self) {
        let here = self.page.state.record.step;
        let step = &self.page.plan.steps[here];
        let careless = self.person.is_careless();
        let started = &self.page.plan.started;
        let answers = self.viewer.answers(&step.id, step.questions(), started, careless);
        for (question, value) in answers.unwrap_or_default() {
            let Some(asked) = step.questions().iter().find(|each| each.id == question) else {
                continue;
            };
            let record = &self.page.state.record;
            if !asked.is_shown(&record.drafts, &record.answers) {
                continue;
            }
            let ms = self.person.answering_ms(None);
            self.page.wait(ms);
            match (asked.kind.keys(), value.as_str()) {
                (Some(keys), Some(value)) if keys.contains_key(value) => {
                    let (value, at_ms) = (value.to_owned(), self.page.now_ms);
                    self.page.send(Input::Press { question, value, at_ms });
                }
                // Not to press is the answer that has no key.
                (Some(_), _) => {}
                _ => self.page.send(Input::Answer { question, value }),
            }
        }
        self.read(500.0);
    }

    /// Which of two pairs of clips differ more.
    fn answer_differences(&mut self, panel: &Panel) {
        let here = self.page.state.record.step;
        let step = &self.page.plan.steps[here];
        let careless = self.person.is_careless();
        let second = self.judge.second_differs_more(&step.id, &panel.clips, careless);
        let asked = step.questions().first();
        if let (Some(second), Some(asked)) = (second, asked)
            && let Some(option) = asked.kind.options().get(usize::from(second))
        {
            let ms = self.person.answering_ms(None);
            self.page.wait(ms);
            let (question, value) = (asked.id.clone(), option.value.as_str().into());
            self.page.send(Input::Answer { question, value });
        }
        self.read(500.0);
    }

    /// Which of two clips is the varied one, or whether they differ.
    fn answer_level(&mut self, shown: &LevelShown) {
        let here = self.page.state.record.step;
        let ms = self.person.answering_ms(None);
        self.page.wait(ms);
        let careless = self.person.is_careless();
        for question in self.page.plan.steps[here].questions() {
            let options = question.kind.options().iter().map(|option| option.value.as_str());
            let offered = options.chain(["left", "right"]);
            let Some(answer) = self.observer.answer(shown, offered, careless) else { return };
            let value = answer.into();
            self.page.send(Input::Answer { question: question.id.clone(), value });
        }
        self.read(500.0);
    }

    pub(super) fn answer_page(&mut self, page: &mimique_study::Questionnaire, demographics: bool) {
        let told: Answers = self.person.about.clone();
        for question in &page.questions {
            let record = &self.page.state.record;
            if !question.is_shown(&record.drafts, &record.answers) {
                continue;
            }
            let answer = match demographics {
                true => told.get(&question.id).cloned(),
                false => self.person.page_answer(&question.id),
            };
            self.read(4_000.0);
            if let Some(value) = answer {
                self.page.send(Input::Answer { question: question.id.clone(), value });
            }
        }
    }
}
