//! Statements for a number of rows that is known only when they are made.

use sqlx::SqlSafeStr as _;

use super::{Statement, Value};

/// A statement that is put together piece by piece, for a number of rows known only then.
pub(crate) struct Builder<'v> {
    text: String,
    values: Vec<Value<'v>>,
}

impl<'v> Builder<'v> {
    pub fn new(text: impl Into<String>) -> Self {
        Self { text: text.into(), values: Vec::new() }
    }

    pub fn push(&mut self, text: &str) {
        self.text.push_str(text);
    }

    /// Adds values with commas between them; `{}` in the form stands for a value's place.
    pub fn push_list(&mut self, form: &str, values: impl IntoIterator<Item = Value<'v>>) {
        for (index, value) in values.into_iter().enumerate() {
            if index > 0 {
                self.text.push_str(", ");
            }
            self.values.push(value);
            self.text.push_str(&form.replace("{}", &format!("${}", self.values.len())));
        }
    }

    /// Adds `VALUES (…), (…)`, a bracket for each row.
    pub fn push_rows<const WIDTH: usize>(
        &mut self,
        form: &str,
        rows: impl IntoIterator<Item = [Value<'v>; WIDTH]>,
    ) {
        self.text.push_str("VALUES ");
        for (index, row) in rows.into_iter().enumerate() {
            self.text.push_str(if index > 0 { ", (" } else { "(" });
            self.push_list(form, row);
            self.text.push(')');
        }
    }

    pub fn finish(self) -> Statement<'v> {
        let text = sqlx::AssertSqlSafe(self.text).into_sql_str();
        Statement { text, values: self.values, is_kept: true }
    }
}
