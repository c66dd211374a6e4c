//! A value of JavaScript as a tree, there and back. The browser reads and writes JSON; serde's way
//! between the two was a tenth of the module.

use wasm_bindgen::prelude::*;

/// What JSON can say.
#[derive(Debug, Clone, PartialEq)]
pub enum Tree {
    /// `null`, and what JSON cannot say.
    Null,
    /// `true` or `false`.
    Truth(bool),
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
    /// An array.
    List(Vec<Tree>),
    /// An object, in its order.
    Object(Vec<(String, Tree)>),
}

impl Tree {
    /// A list of texts.
    pub fn texts(texts: &[String]) -> Self {
        Self::List(texts.iter().map(|text| Self::Text(text.clone())).collect())
    }
}

impl From<&JsValue> for Tree {
    fn from(value: &JsValue) -> Self {
        if let Some(number) = value.as_f64() {
            Self::Number(number)
        } else if let Some(text) = value.as_string() {
            Self::Text(text)
        } else if let Some(truth) = value.as_bool() {
            Self::Truth(truth)
        } else if js_sys::Array::is_array(value) {
            let items = js_sys::Array::from(value);
            Self::List(items.iter().map(|item| Self::from(&item)).collect())
        } else if value.is_object() {
            let entries = js_sys::Object::entries(value.unchecked_ref());
            let entry = |entry: JsValue| {
                let entry: js_sys::Array = entry.unchecked_into();
                (entry.get(0).as_string().unwrap_or_default(), Self::from(&entry.get(1)))
            };
            Self::Object(entries.iter().map(entry).collect())
        } else {
            Self::Null
        }
    }
}

impl From<&Tree> for JsValue {
    fn from(tree: &Tree) -> Self {
        match tree {
            Tree::Null => Self::NULL,
            Tree::Truth(truth) => (*truth).into(),
            Tree::Number(number) => (*number).into(),
            Tree::Text(text) => text.as_str().into(),
            Tree::List(items) => {
                let list = js_sys::Array::new();
                items.iter().for_each(|item| {
                    list.push(&item.into());
                });
                list.into()
            }
            Tree::Object(entries) => {
                let object = js_sys::Object::new();
                for (key, value) in entries {
                    // A new object takes every key.
                    let _ = js_sys::Reflect::set(&object, &key.as_str().into(), &value.into());
                }
                object.into()
            }
        }
    }
}
