//! Detection, equivalence, agreement, and several clips on one scale.

use mimique_stats::{
    Blocks, DetectedCategory, EquivalenceOptions, MeasurementLevel, Outcome, PanelOptions,
    PanelRatings, Reversed, UnitValues, equivalence_of_groups, equivalence_of_pairs,
    paired_differences,
};
use serde_json::{Map, Value, json};

use super::{Given, Stop, defined, or_null};

/// d' and criterion of each emotion against all others.
pub(super) fn detection(given: &Given<'_>) -> Result<Value, Stop> {
    let table = given.table(0)?;
    let [participant, truth, answer] =
        ["participant", "truth", "answer"].map(|name| table.factor(name));
    let found = mimique_stats::detection(&participant?, &truth?, &answer?)?;
    let emotion = |own: &DetectedCategory| {
        json!({
            "emotion": own.category,
            "hits": own.counts.hits,
            "signals": own.counts.signals,
            "false_alarms": own.counts.false_alarms,
            "noise": own.counts.noise,
            "pooled_loglinear": or_null(&own.pooled_loglinear),
            "pooled_uncorrected": match &own.pooled_uncorrected {
                Outcome::Ok(found) => json!(found),
                Outcome::Undefined { .. } => json!({ "undefined": "a rate of 0 or 1" }),
            },
            "d_prime_mean": own.d_prime_mean,
            "d_prime_sd": own.d_prime_sd,
            "d_prime_interval_95": own.d_prime_interval_95,
            "criterion_mean": own.criterion_mean,
            "first_participant": own.people.first().map(|person| person.sensitivity),
        })
    };
    Ok(json!({ "emotions": found.categories.iter().map(emotion).collect::<Vec<_>>() }))
}

/// Two one-sided tests of pairs and of groups.
pub(super) fn equivalence(given: &Given<'_>) -> Result<Value, Stop> {
    let bounds = given.options.get("bounds")?;
    let options = EquivalenceOptions {
        bounds: <[f64; 2]>::try_from(bounds.numbers()?).map_err(|_| bounds.wrong("two numbers"))?,
        alpha: given.options.get("alpha")?.number()?,
    };
    let table = given.table(0)?;
    let (a, b) = (table.numbers("a")?, table.numbers("b")?);
    let pairs = equivalence_of_pairs(&paired_differences(&a, &b), &options)?;
    let groups = equivalence_of_groups(&a, &b, &options)?;
    let mut told = json!({
        "paired_t": or_null(&pairs.paired_t),
        "welch": or_null(&groups.welch),
        "pooled": or_null(&groups.pooled),
        "wilcoxon": or_null(&pairs.wilcoxon),
        "mann_whitney_normal": or_null(&groups.mann_whitney_normal),
    });
    // The cases' own names of the variants.
    for (test, own, theirs) in [
        (
            "wilcoxon",
            "exact conditional on the ranks, zeros by Pratt",
            "exact conditional, zeros by Pratt",
        ),
        (
            "mann_whitney_normal",
            "normal, corrected for ties, with continuity correction",
            "normal, ties and continuity corrected (R, exact = FALSE)",
        ),
    ] {
        if told[test]["variant"] == own {
            told[test]["variant"] = json!(theirs);
        }
    }
    Ok(told)
}

/// Six forms of the intraclass correlation.
pub(super) fn intraclass_correlation(given: &Given<'_>) -> Result<Value, Stop> {
    let table = given.table(0)?;
    let ratings =
        Blocks::of(&table.numbers("rating")?, &table.factor("rater")?, &table.factor("clip")?)?;
    Ok(json!(defined(mimique_stats::intraclass_correlation(&ratings)?)?))
}

/// Cronbach's alpha of all columns but the participants'.
pub(super) fn cronbach(given: &Given<'_>) -> Result<Value, Stop> {
    let table = given.table(0)?;
    let names = table.names().iter().filter(|name| *name != "participant");
    let questions = names.map(|name| table.numbers(name)).collect::<Result<Vec<_>, _>>()?;
    let reversed = given.texts("reversed")?;
    let reversed = if reversed.is_empty() {
        None
    } else {
        let range = given.options.get("range")?;
        let ends =
            <[f64; 2]>::try_from(range.numbers()?).map_err(|_| range.wrong("two numbers"))?;
        Some(Reversed { questions: reversed, range: ends })
    };
    let found = defined(mimique_stats::cronbach(&questions, reversed.as_ref())?)?;
    let list = |own: &mimique_stats::Labelled<Option<f64>>| {
        json!(own.iter().map(|(_, v)| *v).collect::<Vec<_>>())
    };
    let mut told = json!(found);
    told["alpha_if_dropped"] = list(&found.alpha_if_dropped);
    told["item_rest_correlation"] = list(&found.item_rest_correlation);
    Ok(told)
}

/// Krippendorff's alpha at every level.
pub(super) fn krippendorff(given: &Given<'_>) -> Result<Value, Stop> {
    let table = given.table(0)?;
    let factor = |name: &str| table.factor(name);
    let values = UnitValues::of(&factor("clip")?, &factor("rater")?, &factor("value")?)?;
    let found = mimique_stats::krippendorff(&values, &MeasurementLevel::ALL, 0, 1)?;
    let alpha: Map<String, Value> = found
        .levels
        .iter()
        .map(|(level, own)| (level.to_owned(), or_null(&own.clone().map(|own| own.alpha))))
        .collect();
    Ok(json!({
        "alpha": alpha,
        "pairable_values": found.pairable_values,
        "clips_with_two_or_more": found.units_with_two_or_more,
        "clips": found.units,
    }))
}

/// Screening by BS.1534 and Friedman's test on all conditions.
pub(super) fn panel(given: &Given<'_>) -> Result<Value, Stop> {
    let table = given.table(0)?;
    let factor = |name: &str| table.factor(name);
    let factors = [&factor("participant")?, &factor("segment")?, &factor("condition")?];
    let ratings = PanelRatings::of(&table.numbers("rating")?, factors)?;
    let option = |name: &str| given.options.get(name);
    let anchor = given.options.find("anchor").filter(|anchor| !anchor.value().is_null());
    let options = PanelOptions {
        reference: option("reference")?.text()?.to_owned(),
        anchor: anchor.map(|anchor| anchor.text().map(str::to_owned)).transpose()?,
        score: option("score")?.number()?,
        share: option("share")?.number()?,
        segment_share: option("segment_share")?.number()?,
        compared: given.texts("conditions")?,
    };
    let found = mimique_stats::panel(&ratings, &options)?;
    let mut told = json!(found);
    told["friedman"] = match &found.friedman {
        Outcome::Undefined { .. } => Value::Null,
        Outcome::Ok(test) => {
            let f = test.iman_davenport;
            json!({
                "statistic": test.statistic,
                "df": test.df,
                "p": test.p_value,
                "iman_davenport_F": f.map(|f| f.F),
                "df1": test.k - 1,
                "df2": (test.k - 1) * (test.n_blocks - 1),
                // All blocks agree: F is without bound.
                "p_F": f.map_or(0.0, |f| f.p_value),
            })
        }
    };
    Ok(told)
}
