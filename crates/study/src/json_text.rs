//! JSON as text, read and written for the participant's page: strict RFC 8259, with the standard
//! library's numbers. `serde_json` brings a second reader and a second writer of numbers with tables
//! of their own; here it lends its tree alone.

use serde_json::{Map, Number, Value};

use crate::from_json::Mistake;

/// Deepest nesting; the reader calls itself for each.
const DEEPEST: usize = 120;

/// Reads a text.
pub fn read(text: &str) -> Result<Value, Mistake> {
    read_with(text, |number| number.parse().ok())
}

/// Reads a text; numbers that are not whole are read by `number`, which must give the nearest one.
/// (The browser has such a reader, and the page does without the tables of ours.)
pub fn read_with(text: &str, number: fn(&str) -> Option<f64>) -> Result<Value, Mistake> {
    let mut reader = Reader { text, at: 0, real: number };
    let value = reader.value(0)?;
    reader.blank();
    if reader.at < text.len() { Err(reader.wrong()) } else { Ok(value) }
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    real: fn(&str) -> Option<f64>,
}

impl Reader<'_> {
    fn wrong(&self) -> Mistake {
        Mistake::new(&["not JSON at byte ", &self.at.to_string()].concat())
    }

    fn peek(&self) -> u8 {
        self.text.as_bytes().get(self.at).copied().unwrap_or(0)
    }

    fn blank(&mut self) {
        while matches!(self.peek(), b' ' | b'\t' | b'\n' | b'\r') {
            self.at += 1;
        }
    }

    /// The next sign that is not blank, if it is this one.
    fn takes(&mut self, sign: u8) -> bool {
        self.blank();
        let there = self.peek() == sign;
        self.at += usize::from(there);
        there
    }

    fn expect(&mut self, sign: u8) -> Result<(), Mistake> {
        if self.takes(sign) { Ok(()) } else { Err(self.wrong()) }
    }

    fn value(&mut self, depth: usize) -> Result<Value, Mistake> {
        self.blank();
        match self.peek() {
            _ if depth > DEEPEST => Err(self.wrong()),
            b'"' => self.string().map(Value::String),
            b'{' => self.object(depth),
            b'[' => self.array(depth),
            b't' => self.word("true", Value::Bool(true)),
            b'f' => self.word("false", Value::Bool(false)),
            b'n' => self.word("null", Value::Null),
            _ => self.number(),
        }
    }

    fn word(&mut self, word: &str, value: Value) -> Result<Value, Mistake> {
        if !self.text.as_bytes()[self.at..].starts_with(word.as_bytes()) {
            return Err(self.wrong());
        }
        self.at += word.len();
        Ok(value)
    }

    fn object(&mut self, depth: usize) -> Result<Value, Mistake> {
        self.at += 1;
        let mut map = Map::new();
        if self.takes(b'}') {
            return Ok(Value::Object(map));
        }
        loop {
            self.blank();
            if self.peek() != b'"' {
                return Err(self.wrong());
            }
            let key = self.string()?;
            self.expect(b':')?;
            let value = self.value(depth + 1)?;
            map.insert(key, value);
            if !self.takes(b',') {
                self.expect(b'}')?;
                return Ok(Value::Object(map));
            }
        }
    }

    fn array(&mut self, depth: usize) -> Result<Value, Mistake> {
        self.at += 1;
        let mut items = Vec::new();
        if self.takes(b']') {
            return Ok(Value::Array(items));
        }
        loop {
            items.push(self.value(depth + 1)?);
            if !self.takes(b',') {
                self.expect(b']')?;
                return Ok(Value::Array(items));
            }
        }
    }

    /// A string; the quotation mark that begins it stands here.
    fn string(&mut self) -> Result<String, Mistake> {
        self.at += 1;
        let mut read = String::new();
        loop {
            let from = self.at;
            while !matches!(self.peek(), b'"' | b'\\' | 0..0x20) {
                self.at += 1;
            }
            read.push_str(&self.text[from..self.at]);
            match self.peek() {
                b'"' => {
                    self.at += 1;
                    return Ok(read);
                }
                b'\\' => {
                    self.at += 1;
                    let letter = self.escaped()?;
                    read.push(letter);
                }
                _ => return Err(self.wrong()),
            }
        }
    }

    /// What stands behind a backslash.
    fn escaped(&mut self) -> Result<char, Mistake> {
        let sign = self.peek();
        self.at += 1;
        Ok(match sign {
            b'"' | b'\\' | b'/' => char::from(sign),
            b'b' => '\u{8}',
            b'f' => '\u{c}',
            b'n' => '\n',
            b'r' => '\r',
            b't' => '\t',
            b'u' => {
                let mut code = self.four()?;
                if (0xd800..0xdc00).contains(&code) {
                    // The first half of a pair.
                    if self.peek() != b'\\' {
                        return Err(self.wrong());
                    }
                    self.at += 1;
                    if self.peek() != b'u' {
                        return Err(self.wrong());
                    }
                    self.at += 1;
                    let second = self.four()?;
                    if !(0xdc00..0xe000).contains(&second) {
                        return Err(self.wrong());
                    }
                    code = 0x1_0000 + ((code - 0xd800) << 10) + (second - 0xdc00);
                }
                char::from_u32(code).ok_or_else(|| self.wrong())?
            }
            _ => return Err(self.wrong()),
        })
    }

    fn four(&mut self) -> Result<u32, Mistake> {
        let mut code = 0;
        for _ in 0..4 {
            let digit = char::from(self.peek()).to_digit(16).ok_or_else(|| self.wrong())?;
            code = code * 16 + digit;
            self.at += 1;
        }
        Ok(code)
    }

    fn digits(&mut self) -> Result<(), Mistake> {
        let from = self.at;
        while self.peek().is_ascii_digit() {
            self.at += 1;
        }
        if self.at == from { Err(self.wrong()) } else { Ok(()) }
    }

    fn number(&mut self) -> Result<Value, Mistake> {
        let from = self.at;
        self.at += usize::from(self.peek() == b'-');
        if self.peek() == b'0' {
            self.at += 1
        } else {
            self.digits()?
        }
        let whole = !matches!(self.peek(), b'.' | b'e' | b'E');
        if self.peek() == b'.' {
            self.at += 1;
            self.digits()?;
        }
        if matches!(self.peek(), b'e' | b'E') {
            self.at += 1;
            self.at += usize::from(matches!(self.peek(), b'+' | b'-'));
            self.digits()?;
        }
        let text = &self.text[from..self.at];
        if whole && let Ok(number) = text.parse::<u64>() {
            return Ok(number.into());
        }
        // -0 is a number with a sign that no whole number has.
        if whole
            && text != "-0"
            && let Ok(number) = text.parse::<i64>()
        {
            return Ok(number.into());
        }
        let number = (self.real)(text).and_then(Number::from_f64);
        number.map(Value::Number).ok_or_else(|| self.wrong())
    }
}

/// Writes a value, without blanks.
pub fn write(value: &Value) -> String {
    let mut text = String::new();
    put(&mut text, value);
    text
}

fn put(text: &mut String, value: &Value) {
    match value {
        Value::Null => text.push_str("null"),
        Value::Bool(truth) => text.push_str(if *truth { "true" } else { "false" }),
        Value::Number(number) => text.push_str(&number_text(number)),
        Value::String(words) => put_string(text, words),
        Value::Array(items) => {
            let mut sign = '[';
            for item in items {
                text.push(sign);
                put(text, item);
                sign = ',';
            }
            text.push_str(if items.is_empty() { "[]" } else { "]" });
        }
        Value::Object(map) => {
            let mut sign = '{';
            for (key, item) in map {
                text.push(sign);
                put_string(text, key);
                text.push(':');
                put(text, item);
                sign = ',';
            }
            text.push_str(if map.is_empty() { "{}" } else { "}" });
        }
    }
}

/// An object of these keys and values. Where `json!` would do, this is for the participant's page: the
/// macro brings the errors of writers along.
pub fn object<const N: usize>(pairs: [(&str, Value); N]) -> Value {
    let mut map = Map::new();
    pairs.into_iter().for_each(|(key, value)| drop(map.insert(key.to_owned(), value)));
    Value::Object(map)
}

/// A number as JSON: the shortest digits that are read as the same number; 1.0 keeps its point.
fn number_text(number: &Number) -> String {
    if let Some(whole) = number.as_u64() {
        return whole.to_string();
    }
    if let Some(whole) = number.as_i64() {
        return whole.to_string();
    }
    let mut text = crate::number_text(number.as_f64().unwrap_or(0.0));
    if !text.contains('.') {
        text.push_str(".0");
    }
    text
}

fn put_string(text: &mut String, words: &str) {
    text.push('"');
    for letter in words.chars() {
        match letter {
            '"' => text.push_str("\\\""),
            '\\' => text.push_str("\\\\"),
            '\n' => text.push_str("\\n"),
            '\r' => text.push_str("\\r"),
            '\t' => text.push_str("\\t"),
            '\u{8}' => text.push_str("\\b"),
            '\u{c}' => text.push_str("\\f"),
            '\0'..'\u{20}' => {
                text.push_str("\\u00");
                for digit in [u32::from(letter) >> 4, u32::from(letter) & 15] {
                    text.extend(char::from_digit(digit, 16));
                }
            }
            _ => text.push(letter),
        }
    }
    text.push('"');
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn any_value() -> impl Strategy<Value = Value> {
        let leaf = prop_oneof![
            Just(Value::Null),
            any::<bool>().prop_map(Value::from),
            any::<u64>().prop_map(Value::from),
            any::<i64>().prop_map(Value::from),
            any::<f64>().prop_map(Value::from),
            (-1e6..1e6).prop_map(Value::from),
            any::<String>().prop_map(Value::from),
        ];
        leaf.prop_recursive(4, 40, 5, |inner| {
            prop_oneof![
                prop::collection::vec(inner.clone(), 0..5).prop_map(Value::from),
                prop::collection::btree_map(any::<String>(), inner, 0..5)
                    .prop_map(|map| Value::Object(map.into_iter().collect())),
            ]
        })
    }

    proptest! {
        /// What is written is the same value again, to serde_json and to us; and so the other way.
        #[test]
        fn says_what_serde_json_says(value in any_value()) {
            let text = write(&value);
            prop_assert_eq!(&serde_json::from_str::<Value>(&text).unwrap(), &value);
            prop_assert_eq!(&read(&text).unwrap(), &value);
            prop_assert_eq!(&read(&serde_json::to_string_pretty(&value).unwrap()).unwrap(), &value);
        }

        /// Texts that are nearly JSON: taken and refused alike.
        #[test]
        fn takes_what_serde_json_takes(text in "[\\[\\]{}:,\"\\\\/ub0-9a-fnrtl.eE+\\- \n\t]{0,14}") {
            let (ours, theirs) = (read(&text).ok(), serde_json::from_str::<Value>(&text).ok());
            prop_assert_eq!(ours, theirs, "{}", text);
        }
    }

    #[test]
    fn takes_and_refuses() {
        for text in [
            r#""\ud83d\ude00 \u00e9 \/""#,
            "-0",
            "-0.0",
            "1e400",
            "1E5",
            "1e-7",
            "01",
            "1.",
            ".5",
            "+1",
            "-",
            r#""\ud83d""#,
            r#""\ude00""#,
            r#""\ud83d\u0041""#,
            "\"\u{1}\"",
            "[1,]",
            "{\"a\":1,}",
            "{\"a\" :1 , \"a\":2}",
            "18446744073709551616",
            "-9223372036854775808",
            "-9223372036854775809",
            "nul",
            "truefalse",
            "",
            " ",
            "1 2",
            "\u{feff}1",
            "\"\0\"",
            "{1:2}",
            "[",
            "\"",
            "\"\\",
            "\"\\u12",
        ] {
            assert_eq!(read(text).ok(), serde_json::from_str::<Value>(text).ok(), "{text:?}");
        }
        assert!(read(&"[".repeat(100_000)).is_err(), "deep nesting is refused");
        assert_eq!(
            write(&serde_json::json!({ "a": [1.0, 0.1, -2, "é\u{1}\""] })),
            "{\"a\":[1.0,0.1,-2,\"é\\u0001\\\"\"]}"
        );
    }
}
