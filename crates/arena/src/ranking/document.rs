//! The page of a ranking: who may be called better than whom, how sure that is, and what it is made of.

use mimique_locale::{Language, counted, counted_as, format_p};
use mimique_report::document::{Block, DataTable, Document};
use mimique_report::figure::ranking as ranking_figure;

use super::rows::{ranking_rows, span};
use super::{Band, Difference, FEWEST_PEOPLE, FEWEST_VOTES, NotRanked, Ranking};
use crate::arena_file::Arena;
use crate::pool::Laboratory;
use crate::submission::{Submission, SubmittedKind};

/// The page.
pub fn ranking_document(
    arena: &Arena,
    submissions: &[&Submission],
    ranking: &Ranking,
    laboratories: &[Laboratory],
) -> Document {
    let mut blocks = vec![Block::Heading(2, "Ranking".to_owned())];
    blocks.extend(result(submissions, ranking));
    if ranking.votes > 0 {
        blocks.extend(differences(ranking));
        blocks.extend(people(ranking, laboratories));
    }
    blocks.extend(methods(submissions));
    blocks.extend(sources(arena, laboratories));
    let days = ranking.days.as_ref().map_or_else(String::new, |[first, last]| {
        if first == last { format!(", on {first}") } else { format!(", from {first} to {last}") }
    });
    Document {
        title: arena.title.clone(),
        subtitle: format!(
            "{} by {} in {}{days}; {}.",
            counted(ranking.votes, "vote"),
            counted_as(ranking.people, "person", "people"),
            counted_as(laboratories.len(), "laboratory", "laboratories"),
            counted(submissions.len(), "method"),
        ),
        blocks,
    }
}

/// A p value as reports write it.
fn p_of(p: f64) -> String {
    format_p(p, p.ln())
}

/// Names as in a sentence.
fn listed(names: &[String]) -> String {
    match names {
        [] => "none".to_owned(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

fn result(submissions: &[&Submission], ranking: &Ranking) -> Vec<Block> {
    let mut blocks = Vec::new();
    match &ranking.not_ranked {
        Some(why) => blocks.push(Block::Caution(no_ranking(why, ranking))),
        None => {
            blocks.push(Block::Reading(said(&ranking.bands, &ranking.differences)));
            let levels: Vec<_> = (ranking.placed.iter())
                .map(|own| (own.standing.method.clone(), own.worth, own.interval))
                .collect();
            let caption = "Worths of the methods with the 95 % interval of each alone; methods of one band are not ranked";
            blocks.push(Block::figure(ranking_figure(
                Language::English,
                "ranking",
                caption,
                &levels,
            )));
            let mut table = DataTable::new(
                "ranking",
                "Methods by band; a rank is the range that the votes leave",
                [
                    "band",
                    "method",
                    "rank",
                    "worth (JND)",
                    "95 %",
                    "votes",
                    "chosen",
                    "people",
                    "submitted",
                ],
            );
            for row in ranking_rows(ranking, submissions).iter().filter(|row| row.band.is_some()) {
                table.row([
                    row.band.map_or_else(String::new, |band| band.to_string()),
                    name(submissions, &row.method),
                    row.ranks.map_or_else(String::new, span),
                    row.worth.map_or_else(String::new, |worth| format!("{worth:.2}")),
                    row.interval.map_or_else(String::new, ends),
                    row.votes.to_string(),
                    row.chosen.to_string(),
                    row.people.to_string(),
                    row.submitted.clone(),
                ]);
            }
            blocks.push(Block::Table(table));
        }
    }
    if !ranking.waiting.is_empty() {
        let heading = "Waiting for votes";
        blocks.push(Block::Heading(3, heading.to_owned()));
        blocks.push(Block::Paragraph(format!(
            "A method gets a place from {FEWEST_VOTES} votes of {FEWEST_PEOPLE} people on; until then it is shown, and not ranked."
        )));
        let mut table = DataTable::new(
            "waiting",
            "Methods without a place",
            ["method", "votes", "chosen", "people", "submitted"],
        );
        for own in &ranking.waiting {
            table.row([
                name(submissions, &own.method),
                own.votes.to_string(),
                own.chosen.to_string(),
                own.people.to_string(),
                submitted(submissions, &own.method),
            ]);
        }
        blocks.push(Block::Table(table));
    }
    blocks
}

/// A method's name, the recorded performance named as such.
fn name(submissions: &[&Submission], method: &str) -> String {
    let own = submissions.iter().find(|own| own.details.name == method);
    let is_reference = own.is_some_and(|own| own.details.reference);
    if is_reference { format!("{method} (reference)") } else { method.to_owned() }
}

pub(super) fn submitted(submissions: &[&Submission], method: &str) -> String {
    let own = submissions.iter().find(|own| own.details.name == method);
    own.map_or_else(String::new, |own| own.details.submitted.clone())
}

fn ends([low, high]: [f64; 2]) -> String {
    format!("{low:.2} to {high:.2}")
}

/// What may be said of the bands, in words.
fn said(bands: &[Band], differences: &[Difference]) -> String {
    let told = differences.iter().filter(|difference| difference.separated).count();
    let all = differences.len();
    if let [only] = bands {
        return format!(
            "No ranking: the intervals of {} overlap. {told} of {all} pairs of methods are told apart.",
            listed(&only.methods)
        );
    }
    let place = |band: &Band| {
        let names = listed(&band.methods);
        match band.ranks {
            [first, last] if first == last => format!("rank {first}: {names}"),
            ranks => format!("ranks {}, not told apart as a whole: {names}", span(ranks)),
        }
    };
    let places: Vec<String> = bands.iter().map(place).collect();
    format!(
        "From the best: {}. Every method of a band is told apart from every method below it; {told} of {all} pairs are told apart in all.",
        places.join("; ")
    )
}

fn no_ranking(why: &NotRanked, ranking: &Ranking) -> String {
    match why {
        NotRanked::TooFewVotes => format!(
            "No ranking yet: {} in all, and fewer than two methods have {FEWEST_VOTES} votes of {FEWEST_PEOPLE} people each. More votes are needed.",
            counted(ranking.votes, "vote")
        ),
        NotRanked::Disconnected { parts } => {
            let parts: Vec<String> = parts.iter().map(|part| listed(part)).collect();
            format!(
                "No ranking: no vote compares the methods of {}. Run a study that shows pairs between them.",
                parts.join(" with those of ")
            )
        }
        NotRanked::Separated { undefeated, winless, group } => {
            let mut reasons = Vec::new();
            if !undefeated.is_empty() {
                reasons.push(format!("nobody chose another over {}", listed(undefeated)));
            }
            if !winless.is_empty() {
                reasons.push(format!("nobody chose {}", listed(winless)));
            }
            if reasons.is_empty() {
                reasons.push(format!("nobody chose another over those of {}", listed(group)));
            }
            format!(
                "No ranking: {}, so how much they differ cannot be told. More votes may tell it.",
                reasons.join(", and ")
            )
        }
        NotRanked::TooFewPeople { people, wanted } => format!(
            "No ranking yet: {} voted, and intervals that know that a person's votes belong together need {wanted}.",
            counted_as(*people, "person", "people")
        ),
        NotRanked::NoErrors => {
            "No ranking: the errors of the worths cannot be estimated from these votes. More votes are needed.".to_owned()
        }
    }
}

fn differences(ranking: &Ranking) -> Vec<Block> {
    if ranking.differences.is_empty() {
        return Vec::new();
    }
    let mut table = DataTable::new(
        "differences",
        "Every two methods: intervals that hold together with 95 % (Bonferroni)",
        [
            "chosen more",
            "chosen less",
            "difference (JND)",
            "interval",
            "chosen by",
            "p (corrected)",
            "told apart",
        ],
    );
    for own in &ranking.differences {
        table.row([
            own.a.clone(),
            own.b.clone(),
            format!("{:.2}", own.difference),
            ends(own.interval),
            format!("{:.0} %", 100.0 * own.preferred),
            p_of(own.p).trim_start_matches("= ").to_owned(),
            if own.separated { "yes" } else { "no" }.to_owned(),
        ]);
    }
    vec![
        Block::Heading(2, "Differences".to_owned()),
        Block::Paragraph(
            "Two methods are told apart where the interval of their difference leaves 0 out. Bradley and Terry's worths \
             with Davidson's ties and a position bias; errors clustered by participant; one just noticeable difference \
             (JND) is chosen in 75 %."
                .to_owned(),
        ),
        Block::Table(table),
    ]
}

/// Laboratories, agreement, position bias, fit.
fn people(ranking: &Ranking, laboratories: &[Laboratory]) -> Vec<Block> {
    let mut blocks = vec![Block::Heading(2, "People and laboratories".to_owned())];
    if let Some(own) = &ranking.heterogeneity {
        let verdict = if own.p < 0.05 {
            "laboratories differ: read each for itself"
        } else {
            "no difference between laboratories is told"
        };
        blocks.push(Block::Reading(format!(
            "Between laboratories: chi-square {:.1} summed over pairs of methods, p {} by {} permutations of people over laboratories; {verdict}.",
            own.statistic, p_of(own.p), own.permutations
        )));
    }
    let mut sentences = Vec::new();
    if let Some(own) = &ranking.agreement {
        let interval =
            own.interval.map_or_else(String::new, |ends_of| format!(" ({})", ends(ends_of)));
        sentences.push(format!(
            "Agreement on {} that two people or more chose between: Krippendorff's alpha {:.2}{interval}, 0 being chance.",
            counted_as(own.pairs, "pair of clips", "pairs of clips"),
            own.alpha
        ));
    }
    if let Some([bias, se]) = ranking.left_bias {
        sentences.push(format!(
            "Position: standing on the left adds {bias:.2} (standard error {se:.2}) to the log odds, which the worths are free of."
        ));
    }
    sentences.push(format!("{} of {} votes saw no difference.", ranking.same, ranking.votes));
    if let Some(p) = ranking.lack_of_fit.and_then(|fit| fit.p_drawn.map(|p| p[0]).or(fit.p_G2)) {
        let fits = if p < 0.05 {
            "one worth per method does not describe the votes well: read the differences with care"
        } else {
            "one worth per method describes the votes"
        };
        sentences.push(format!("Fit of the model: p {}; {fits}.", p_of(p)));
    }
    blocks.push(Block::Paragraph(sentences.join(" ")));
    let mut table = DataTable::new(
        "laboratories",
        "Laboratories",
        ["laboratory", "people", "votes", "votes left out", "versions of the stage"],
    );
    for own in laboratories {
        let left_out: usize = own.left_out.iter().map(|left| left.votes).sum();
        table.row([
            own.name.clone(),
            own.sessions.to_string(),
            own.votes.to_string(),
            left_out.to_string(),
            own.renderers.len().to_string(),
        ]);
    }
    blocks.push(Block::Table(table));
    blocks.extend(worths_by_laboratory(ranking).map(Block::Table));
    blocks
}

fn worths_by_laboratory(ranking: &Ranking) -> Option<DataTable> {
    let own: Vec<_> = ranking.laboratories.iter().filter(|own| !own.worths.is_empty()).collect();
    if own.len() < 2 {
        return None;
    }
    let columns =
        std::iter::once("method".to_owned()).chain(own.iter().map(|own| own.laboratory.clone()));
    let caption = "Worths (JND) in each laboratory, with the 95 % interval of each alone";
    let mut table = DataTable::new("worths-by-laboratory", caption, columns);
    for placed in &ranking.placed {
        let method = &placed.standing.method;
        let cell = |laboratory: &&super::LaboratoryWorths| match laboratory.worths.get(method) {
            Some((worth, Some(interval))) => format!("{worth:.2} ({})", ends(*interval)),
            Some((worth, None)) => format!("{worth:.2}"),
            None => String::new(),
        };
        table.row(std::iter::once(method.clone()).chain(own.iter().map(cell)));
    }
    Some(table)
}

fn methods(submissions: &[&Submission]) -> Vec<Block> {
    let mut table = DataTable::new(
        "methods",
        "What was submitted",
        ["method", "authors", "citation", "licence", "code", "kind", "submitted", "SHA-256"],
    );
    for own in submissions {
        let details = &own.details;
        let kind = match (own.kind, &own.avatar) {
            (SubmittedKind::Weights, _) => "weights".to_owned(),
            (SubmittedKind::Vertices, Some(avatar)) => format!(
                "vertices ({} shapes, {:.3} mm at most)",
                avatar.shapes, avatar.largest_error_mm
            ),
            (SubmittedKind::Vertices, None) => "vertices".to_owned(),
        };
        table.row([
            details.name.clone(),
            listed(&details.authors),
            details.citation.clone().unwrap_or_default(),
            details.licence.clone(),
            details.code.clone().unwrap_or_default(),
            kind,
            details.submitted.clone(),
            own.hash[..12].to_owned(),
        ]);
    }
    vec![Block::Heading(2, "Methods".to_owned()), Block::Table(table)]
}

/// What was pooled, and what was not.
fn sources(arena: &Arena, laboratories: &[Laboratory]) -> Vec<Block> {
    let mut blocks = vec![
        Block::Heading(2, "What was pooled".to_owned()),
        Block::Paragraph(format!(
            "A vote counts where the hashes (provenance) of both clips are those of the arena {}, opened {}: the same head, \
             weights and sound. A session counts once.",
            arena.id, arena.opened
        )),
    ];
    let mut table =
        DataTable::new("left-out", "Votes that are not pooled", ["laboratory", "why", "votes"]);
    for laboratory in laboratories {
        for own in &laboratory.left_out {
            table.row([laboratory.name.clone(), own.reason.to_string(), own.votes.to_string()]);
        }
    }
    if table.rows.is_empty() {
        blocks.push(Block::Paragraph("No vote was left out.".to_owned()));
    } else {
        blocks.push(Block::Table(table));
    }
    blocks
}
