//! The tests that a hypothesis may name are tests of `mimique test`, by the same names: `study` lists them
//! without knowing how they are computed.

use mimique_stats::PROCEDURES;

#[test]
fn every_test_of_a_hypothesis_is_one_of_mimique_test() {
    let schema = serde_json::to_value(mimique_study::json_schema()).unwrap();
    let names = schema["$defs"]["TestName"]["oneOf"].as_array().unwrap();
    assert!(names.len() >= 8, "{names:?}");
    for name in names {
        let name = name["const"].as_str().unwrap();
        assert!(PROCEDURES.iter().any(|procedure| procedure.name == name), "{name}");
    }
}
