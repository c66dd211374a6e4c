//! The rules by which a study leaves people and trials out: values; their words are made where somebody reads them.

use mimique_locale::Language;
use mimique_study::{Component, Study};
use serde::{Serialize, Serializer};

use crate::trials::reason::Reason;

/// A rule of exclusion. People come first, then trials.
#[derive(Debug, Clone, PartialEq)]
pub enum Rule {
    /// People who do not finish.
    Incomplete,
    /// People who fail more attention checks.
    FailedAttentionChecks(u32),
    /// People who do not hear the tones of the sound check.
    SoundNotHeard,
    /// People who give one answer in more trials in a row.
    StraightLining {
        /// So many trials are allowed.
        longest_run: u32,
        /// The questions that are counted, each by itself.
        questions: Vec<String>,
    },
    /// Trials with a larger share of late frames.
    LateFrameShare(f64),
    /// Trials with a longer frame, ms.
    LongestFrameMs(f64),
    /// Trials whose sound was not played, or farther from its time, ms.
    SoundOffsetMs(f64),
    /// Trials answered sooner, ms after answers could be given.
    ShortestRtMs(f64),
    /// People whom ITU-R BS.1534-3 leaves out of the panel of this block.
    Bs1534(String),
}

impl Rule {
    /// The rules of a study file, but for those of its panels.
    pub(crate) fn of(study: &Study) -> Vec<Self> {
        let rules = study.exclusions.clone().unwrap_or_default();
        let questions = || {
            let counted = study.straight_lining_questions();
            counted.iter().map(|question| question.id.clone()).collect()
        };
        let straight = rules.straight_lining.map(|rule| Self::StraightLining {
            longest_run: rule.longest_run,
            questions: questions(),
        });
        let all = [
            rules.incomplete.then_some(Self::Incomplete),
            rules.failed_attention_checks.map(Self::FailedAttentionChecks),
            rules.sound_not_heard.then_some(Self::SoundNotHeard),
            straight,
            rules.late_frame_share.map(Self::LateFrameShare),
            rules.longest_frame_ms.map(Self::LongestFrameMs),
            rules.sound_offset_ms.map(Self::SoundOffsetMs),
            rules.shortest_rt_ms.map(Self::ShortestRtMs),
        ];
        all.into_iter().flatten().collect()
    }

    /// Removes the rule from a study file.
    pub(crate) fn remove_from(&self, study: &mut Study) {
        if let Self::Bs1534(block) = self {
            if let Some(Component::Panel(panel)) = study.components.get_mut(block)
                && let Some(keys) = panel.0.as_object_mut()
            {
                keys.remove("exclude");
            }
            return;
        }
        let Some(rules) = &mut study.exclusions else { return };
        match self {
            Self::Incomplete => rules.incomplete = false,
            Self::FailedAttentionChecks(_) => rules.failed_attention_checks = None,
            Self::SoundNotHeard => rules.sound_not_heard = false,
            Self::StraightLining { .. } => rules.straight_lining = None,
            Self::LateFrameShare(_) => rules.late_frame_share = None,
            Self::LongestFrameMs(_) => rules.longest_frame_ms = None,
            Self::SoundOffsetMs(_) => rules.sound_offset_ms = None,
            Self::ShortestRtMs(_) => rules.shortest_rt_ms = None,
            Self::Bs1534(_) => {}
        }
    }

    /// The reason that people and trials have whom the rule excludes.
    pub(crate) fn reason(&self) -> Reason {
        match self {
            Self::Incomplete => Reason::Incomplete,
            Self::FailedAttentionChecks(_) => Reason::AttentionChecks,
            Self::SoundNotHeard => Reason::SoundNotHeard,
            Self::StraightLining { .. } => Reason::StraightLining,
            Self::LateFrameShare(_) => Reason::LateFrames,
            Self::LongestFrameMs(_) => Reason::LongFrame,
            Self::SoundOffsetMs(_) => Reason::SoundOffset,
            Self::ShortestRtMs(_) => Reason::AnsweredTooSoon,
            Self::Bs1534(_) => Reason::Bs1534,
        }
    }

    /// As `results.json` has it: the study file's key and its limit.
    fn key(&self) -> String {
        match self {
            Self::Incomplete => "incomplete".to_owned(),
            Self::FailedAttentionChecks(limit) => format!("failedAttentionChecks > {limit}"),
            Self::SoundNotHeard => "soundNotHeard".to_owned(),
            Self::StraightLining { longest_run, .. } => {
                format!("straightLining.longestRun > {longest_run}")
            }
            Self::LateFrameShare(limit) => format!("lateFrameShare > {limit}"),
            Self::LongestFrameMs(limit) => format!("longestFrameMs > {limit}"),
            Self::SoundOffsetMs(limit) => format!("soundOffsetMs > {limit}"),
            Self::ShortestRtMs(limit) => format!("rt_open < {limit} ms"),
            Self::Bs1534(block) => format!("bs1534 ({block})"),
        }
    }

    /// Whom or what it leaves out, as a part of a sentence; `mark` stands around names of the study file: a backtick
    /// where the text is Markdown.
    pub(crate) fn words(&self, language: Language, mark: &str) -> String {
        let ms = |value: &f64| language.number(*value);
        match self {
            Self::Incomplete => language
                .pick("people who do not finish", "les personnes qui ne terminent pas")
                .to_owned(),
            Self::FailedAttentionChecks(most) => language.pick(
                format!("people who fail more than {most} attention checks"),
                format!("les personnes qui échouent à plus de {most} contrôles d’attention"),
            ),
            Self::SoundNotHeard => language
                .pick(
                    "people who do not hear the tones of the sound check",
                    "les personnes qui n’entendent pas les sons du contrôle d’écoute",
                )
                .to_owned(),
            Self::StraightLining { longest_run, questions } => {
                let asked: Vec<String> = questions.iter().map(|id| format!("{mark}{id}{mark}")).collect();
                let asked = asked.join(", ");
                language.pick(
                    format!(
                        "people who gave the same answer in more than {longest_run} trials in a row (counted for each of {asked})"
                    ),
                    format!(
                        "les personnes ayant donné la même réponse dans plus de {longest_run} essais de suite (compté pour chaque question : {asked})"
                    ),
                )
            }
            Self::LateFrameShare(share) => {
                let percent = language.fixed(100.0 * share, 0);
                language.pick(
                    format!("trials with more than {percent} % late frames"),
                    format!("les essais ayant plus de {percent} % d’images en retard"),
                )
            }
            Self::LongestFrameMs(longest) => language.pick(
                format!("trials with a frame longer than {} ms", ms(longest)),
                format!("les essais ayant une image de plus de {} ms", ms(longest)),
            ),
            Self::SoundOffsetMs(most) => language.pick(
                format!(
                    "trials whose sound was not played, or was heard more than {} ms beside its time",
                    ms(most)
                ),
                format!(
                    "les essais dont le son n’a pas été joué, ou entendu à plus de {} ms de son instant",
                    ms(most)
                ),
            ),
            Self::ShortestRtMs(shortest) => language.pick(
                format!("trials answered sooner than {} ms after answers could be given", ms(shortest)),
                format!(
                    "les essais répondus moins de {} ms après l’ouverture des réponses",
                    ms(shortest)
                ),
            ),
            Self::Bs1534(block) => language.pick(
                format!("people who miss the hidden reference or the anchor of {mark}{block}{mark} (ITU-R BS.1534-3)"),
                format!(
                    "les personnes qui manquent la référence cachée ou l’ancre de {mark}{block}{mark} (UIT-R BS.1534-3)"
                ),
            ),
        }
    }

    /// Several of them, in one sentence.
    pub(crate) fn listed(rules: &[Self], language: Language) -> String {
        let words: Vec<String> = rules.iter().map(|rule| rule.words(language, "")).collect();
        language.list(&words)
    }
}

impl Serialize for Rule {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(&self.key())
    }
}
