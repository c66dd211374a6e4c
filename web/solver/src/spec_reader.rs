//! A method as the study file says it, from its tree. Names and meanings are those of
//! [`MethodSpec`]; the tests compare both readers field for field.

use mimique_solver::{Association, Hold, Inference, LaplacianKind, Method, MethodSpec, Unit};

use crate::tree::Tree;

const LAPLACIANS: [(&str, LaplacianKind); 4] = [
    ("uniform", LaplacianKind::Uniform),
    ("umbrella", LaplacianKind::Umbrella),
    ("cotan-clamped", LaplacianKind::CotanClamped),
    ("cotan-literal", LaplacianKind::CotanLiteral),
];
const ASSOCIATIONS: [(&str, Association); 3] = [
    ("points", Association::Points),
    ("zones", Association::Zones),
    ("triangles", Association::Triangles),
];
const UNITS: [(&str, Unit); 3] = [("m", Unit::M), ("cm", Unit::Cm), ("mm", Unit::Mm)];
const HOLDS: [(&str, Hold); 2] = [("unmoved", Hold::Unmoved), ("nothing", Hold::Nothing)];
const INFERENCES: [(&str, Inference); 2] =
    [("sparse", Inference::Sparse), ("exact", Inference::Exact)];

/// Reads a method.
///
/// # Errors
/// A sentence that names the field: one that is not known, or is not what it should be; no method.
pub fn read_spec(tree: &Tree) -> Result<MethodSpec, String> {
    let fields = object("method", tree)?;
    let method = fields.iter().find(|(key, _)| key == "method");
    let name = method.ok_or("method: it is missing; name one, e.g. lsts")?;
    let methods = Method::ALL.map(|method| (method.name(), method));
    let mut spec = MethodSpec::new(one_of("method", &name.1, &methods)?);
    for (key, value) in fields {
        if *value == Tree::Null {
            continue;
        }
        let number = || number(key, value).map(Some);
        match key.as_str() {
            "method" => {}
            "alpha" => spec.alpha = number()?,
            "kappa" => spec.kappa = number()?,
            "kS" => spec.k_s = number()?,
            "kB" => spec.k_b = number()?,
            "laplacian" => spec.laplacian = Some(one_of(key, value, &LAPLACIANS)?),
            "softBounds" => spec.soft_bounds = Some(interval(key, value)?),
            "s" => spec.s = number()?,
            "eps" => spec.eps = number()?,
            "association" => spec.association = Some(one_of(key, value, &ASSOCIATIONS)?),
            "sigma" => spec.sigma = number()?,
            "boundsWeight" => spec.bounds_weight = number()?,
            "unit" => spec.unit = Some(one_of(key, value, &UNITS)?),
            "stiffness" => spec.stiffness = number()?,
            "hold" => spec.hold = Some(one_of(key, value, &HOLDS)?),
            "inference" => spec.inference = Some(one_of(key, value, &INFERENCES)?),
            "basisVectors" => spec.basis_vectors = Some(whole(key, value)?),
            "lengthScale" => spec.length_scale = number()?,
            "signal" => spec.signal = number()?,
            "noise" => spec.noise = number()?,
            "locked" => spec.locked = texts(key, value)?,
            "importance" => {
                for (name, value) in object(key, value)? {
                    spec.importance.insert(name.clone(), self::number(key, value)?);
                }
            }
            "bounds" => {
                for (name, value) in object(key, value)? {
                    spec.bounds.insert(name.clone(), interval(key, value)?);
                }
            }
            "headLowpassHz" => spec.head_lowpass_hz = number()?,
            _ => return Err(["method: '", key, "' is not known; remove it"].concat()),
        }
    }
    Ok(spec)
}

fn wrong<T>(key: &str, expected: &str) -> Result<T, String> {
    Err(["method: ", key, ": give ", expected].concat())
}

fn object<'t>(key: &str, tree: &'t Tree) -> Result<&'t [(String, Tree)], String> {
    match tree {
        Tree::Object(entries) => Ok(entries),
        _ => wrong(key, "an object"),
    }
}

fn number(key: &str, tree: &Tree) -> Result<f64, String> {
    match tree {
        Tree::Number(number) => Ok(*number),
        _ => wrong(key, "a number"),
    }
}

fn whole(key: &str, tree: &Tree) -> Result<u32, String> {
    let number = number(key, tree)?;
    if number == f64::from(number as u32) {
        Ok(number as u32)
    } else {
        wrong(key, "a whole number")
    }
}

fn interval(key: &str, tree: &Tree) -> Result<[f64; 2], String> {
    match tree {
        Tree::List(ends) if ends.len() == 2 => Ok([number(key, &ends[0])?, number(key, &ends[1])?]),
        _ => wrong(key, "two numbers"),
    }
}

fn texts(key: &str, tree: &Tree) -> Result<Vec<String>, String> {
    let Tree::List(items) = tree else { return wrong(key, "a list of names") };
    let text = |item: &Tree| match item {
        Tree::Text(text) => Ok(text.clone()),
        _ => wrong(key, "a list of names"),
    };
    items.iter().map(text).collect()
}

fn one_of<T: Copy>(key: &str, tree: &Tree, known: &[(&str, T)]) -> Result<T, String> {
    let found = known.iter().find(|(name, _)| matches!(tree, Tree::Text(text) if text == name));
    match found {
        Some((_, value)) => Ok(*value),
        None => {
            let names: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
            wrong(key, &["one of ", &names.join(", ")].concat())
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    fn tree(value: &Value) -> Tree {
        match value {
            Value::Null => Tree::Null,
            Value::Bool(truth) => Tree::Truth(*truth),
            Value::Number(number) => Tree::Number(number.as_f64().expect("a number")),
            Value::String(text) => Tree::Text(text.clone()),
            Value::Array(items) => Tree::List(items.iter().map(tree).collect()),
            Value::Object(entries) => {
                Tree::Object(entries.iter().map(|(k, v)| (k.clone(), tree(v))).collect())
            }
        }
    }

    /// Both readers: this one, and serde's.
    fn both(value: &Value) -> (Result<MethodSpec, String>, Option<MethodSpec>) {
        (read_spec(&tree(value)), serde_json::from_value(value.clone()).ok())
    }

    /// Every field of a method, with values that it may have.
    fn fields() -> Vec<(&'static str, Vec<Value>)> {
        let number = || vec![json!(0.25), json!(3), json!(-1e-9)];
        vec![
            ("alpha", number()),
            ("kappa", number()),
            ("kS", number()),
            ("kB", number()),
            ("laplacian", LAPLACIANS.map(|(name, _)| json!(name)).to_vec()),
            ("softBounds", vec![json!([-0.2, 1.3])]),
            ("s", number()),
            ("eps", number()),
            ("association", ASSOCIATIONS.map(|(name, _)| json!(name)).to_vec()),
            ("sigma", number()),
            ("boundsWeight", number()),
            ("unit", UNITS.map(|(name, _)| json!(name)).to_vec()),
            ("stiffness", number()),
            ("hold", HOLDS.map(|(name, _)| json!(name)).to_vec()),
            ("inference", INFERENCES.map(|(name, _)| json!(name)).to_vec()),
            ("basisVectors", vec![json!(10), json!(4_000_000_000u32)]),
            ("lengthScale", number()),
            ("signal", number()),
            ("noise", number()),
            ("locked", vec![json!([]), json!(["jawOpen", "browInnerUp"])]),
            ("importance", vec![json!({}), json!({ "M3": 0, "A": 2.5 })]),
            ("bounds", vec![json!({}), json!({ "jawOpen": [0, 0.5], "a": [-1, 1] })]),
            ("headLowpassHz", number()),
        ]
    }

    #[test]
    fn every_field_is_read_as_serde_reads_it() {
        for method in Method::ALL {
            let spec = json!({ "method": method.name() });
            let (ours, theirs) = both(&spec);
            assert_eq!(ours.ok(), theirs, "{spec}");
            assert_eq!(read_spec(&tree(&spec)).map(|spec| spec.method), Ok(method));
        }
        let mut whole = json!({ "method": "lsts" });
        for (field, values) in fields() {
            for value in values {
                let spec = json!({ "method": "lsts", field: value });
                let (ours, theirs) = both(&spec);
                let theirs = theirs.unwrap_or_else(|| panic!("serde reads {spec}"));
                assert_eq!(ours.as_ref(), Ok(&theirs), "{spec}");
                whole[field] = value;
            }
        }
        let (ours, theirs) = both(&whole);
        let theirs = theirs.expect("serde reads all fields at once");
        assert_eq!(ours, Ok(theirs.clone()));
        // A field that is new in `MethodSpec` has to come here, too.
        let written = serde_json::to_value(&theirs).expect("written");
        assert_eq!(written.as_object().map(serde_json::Map::len), Some(fields().len() + 1));
        let debug = format!("{theirs:?}");
        assert!(!debug.contains("None"), "a field that is not set above: {debug}");
    }

    #[test]
    fn what_serde_refuses_is_refused_with_its_field() {
        let wrong = [json!(true), json!("x"), json!([1]), json!({ "a": "b" }), json!(-1.5)];
        for (field, _) in fields() {
            for value in &wrong {
                let spec = json!({ "method": "lsts", field: value });
                let (ours, theirs) = both(&spec);
                assert_eq!(ours.is_ok(), theirs.is_some(), "{spec}: {ours:?}");
                if let Err(error) = ours {
                    assert!(error.starts_with(&format!("method: {field}: give ")), "{error}");
                }
            }
        }
        for spec in [
            json!({ "method": "lsts", "beta": 1 }),
            json!({ "alpha": 1 }),
            json!({ "method": "lst" }),
            json!({ "method": null }),
            json!([]),
            json!(null),
        ] {
            let (ours, theirs) = both(&spec);
            assert!(ours.is_err() && theirs.is_none(), "{spec}: {ours:?}");
        }
    }
}
