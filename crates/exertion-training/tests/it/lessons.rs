//! Made people, whose faces follow the rules: a model learns them back, and their expressivity.

use mimique_exertion::{
    Accumulated, Clip, Expression, ExpressionModel, Expressivity, Face, Feature, Features, Heart,
    Part, Person, PersonSpec, Plan, Series, ShapeTable, Start, Window, rules,
};
use mimique_exertion_training::{Grid, Lesson, LessonTake, TrainingError, train};

/// Rest, runs and recoveries of a person whose face follows the rules.
fn take(who: &str, level: f64, expressivity: Expressivity) -> LessonTake {
    let person = Person::new(PersonSpec { level, expressivity, ..PersonSpec::default() }).unwrap();
    let phases = [
        (1.0, 20.0),
        (14.0, 90.0),
        (2.0, 40.0),
        (26.0, 50.0),
        (6.0, 40.0),
        (34.0, 30.0),
        (0.5, 60.0),
    ];
    let seconds = phases.iter().map(|(_, seconds)| seconds).sum();
    let work = Accumulated::of_phases(&phases).unwrap();
    let plan = Plan::of(Part { work, seconds, rcn: None }).unwrap();
    let series = Series::of(&person, &plan, Heart::default(), Start::default()).unwrap();
    let window = Window { seconds: [0.0, seconds], rate_hz: 30.0 };
    let weights = Clip::of(&person, &plan, &series, &window, &Face::default()).unwrap().table();
    LessonTake { who: who.to_owned(), person, plan, weights }
}

fn features() -> Vec<Feature> {
    Feature::ALL.map(|(feature, ..)| feature).to_vec()
}

#[test]
fn a_model_learns_the_rules_back_and_finds_expressivity() {
    let loud = Expressivity { eyes: 0.9, mouth_stretch: 0.8, ..Expressivity::default() };
    let quiet = Expressivity { eyes: 0.45, mouth_stretch: 0.8, ..Expressivity::default() };
    let takes = [take("a", 5.0, loud), take("b", 5.0, quiet), take("a", 4.0, loud)];
    let lesson = Lesson::of(&takes, &features(), &ShapeTable::default(), 3.0).unwrap();
    assert_eq!(lesson.people.len(), 2);
    assert!(lesson.rows.len() > 300, "{}", lesson.rows.len());
    let eyes = [0, 1].map(|person| lesson.people[person].expressivity[2]);
    assert!((eyes[0] / eyes[1] - 2.0).abs() < 0.05, "{eyes:?}");
    for (curve, own) in lesson.targets.iter().enumerate() {
        let most = own.iter().fold(0.0f64, |most, value| most.max(value.abs()));
        assert!((most - 100.0).abs() < 1e-9, "curve {curve}: {most}");
    }

    let grid = Grid { c: [0.0, 3.0], gamma: [-2.0, 1.0], ..Grid::default() };
    let mut heard = Vec::new();
    let trained = train(&lesson, &grid, &mut |curve| heard.push(curve.name)).unwrap();
    assert_eq!(heard, ["mouthOpen", "mouthStretch", "eyes", "brows"]);
    for curve in &trained.curves {
        assert!(curve.rmse < 12.0, "{curve:?}");
        assert_eq!(curve.rmse_of_people.len(), 2);
        assert!(curve.rmse_of_people.iter().all(|rmse| *rmse < 15.0), "{curve:?}");
        assert!(curve.vectors > 3 && curve.vectors < lesson.rows.len(), "{curve:?}");
    }

    // What is written is what a chain reads, and it follows the rules.
    let model = ExpressionModel::of_text(&trained.file.to_string()).unwrap();
    let LessonTake { person, plan, .. } = &takes[0];
    let series = Series::of(person, plan, Heart::default(), Start::default()).unwrap();
    let states: Vec<Features> = [15, 60, 100, 140, 180, 225, 260, 320]
        .map(|second| Features {
            w: series.w[second],
            p: series.p[second],
            rcn: series.rcn[second],
            epoc: series.metabolism.epoc[second],
        })
        .to_vec();
    let learnt = Expression::Model(Box::new(model)).curves(&states, 5.0);
    for (state, learnt) in states.iter().zip(&learnt) {
        let taught = rules(state, 5.0);
        // Per cent of the largest value that the rules had in the lesson.
        let most = lesson.people[0].expressivity;
        let factors = [loud.mouth_open, loud.mouth_stretch, loud.eyes, loud.brows];
        for (k, own) in taught.to_array().into_iter().enumerate() {
            let got = learnt.to_array()[k] * most[k] / factors[k];
            assert!((got - own).abs() < 12.0, "{state:?} curve {k}: {got}, taught {own}");
        }
    }
}

#[test]
fn a_face_that_never_moves_is_refused_by_name() {
    let still = Expressivity { brows: 0.0, ..Expressivity::default() };
    let refused = Lesson::of(
        &[take("a", 5.0, Expressivity::default()), take("b", 5.0, still)],
        &features(),
        &ShapeTable::default(),
        2.0,
    );
    assert_eq!(refused, Err(TrainingError::Still { person: "b".to_owned(), curve: "brows" }));
}

#[test]
fn too_few_rows_are_refused() {
    let takes = [take("a", 5.0, Expressivity::default())];
    let of = |every| Lesson::of(&takes, &features(), &ShapeTable::default(), every);
    assert!(matches!(of(300.0), Err(TrainingError::Rows { .. })));
    assert!(matches!(of(0.0), Err(TrainingError::Setting { .. })));
    assert!(matches!(of(0.01), Err(TrainingError::Rows { .. })));
}
