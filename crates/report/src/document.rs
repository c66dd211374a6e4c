//! A report as blocks: headings, paragraphs, tables, figures. HTML, Markdown and files are made of it.

/// A report.
#[derive(Debug, Clone, PartialEq)]
pub struct Document {
    /// Its title.
    pub title: String,
    /// What it is about, in a line.
    pub subtitle: String,
    /// Its parts, in order.
    pub blocks: Vec<Block>,
}

/// One part of a report.
#[derive(Debug, Clone, PartialEq)]
pub enum Block {
    /// Level 2 or 3.
    Heading(u8, String),
    /// Running text.
    Paragraph(String),
    /// What a result means, in plain words.
    Reading(String),
    /// What to mind.
    Caution(String),
    /// A table.
    Table(DataTable),
    /// A drawing.
    Figure(Figure),
    /// What every hypothesis found, a row each.
    Decisions(DecisionTable),
    /// What stands behind a heading, to be opened: tables, and figures that go with them. Print leaves it out.
    Folded(String, Vec<Block>),
    /// Words to be copied into a paper.
    Paper(String),
}

/// What every hypothesis found.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DecisionTable {
    /// A row per hypothesis: its words, the decision, effects with their intervals, p, people.
    pub data: DataTable,
    /// The effects of each row.
    pub effects: Vec<RowEffects>,
    /// How the intervals are drawn.
    pub scale: String,
}

/// The effects of a row.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RowEffects {
    /// A line each.
    pub lines: Vec<String>,
    /// Their intervals drawn, a line each; none where there are none.
    pub drawing: Option<String>,
}

/// A table of text cells; `id` names its file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DataTable {
    /// Name of its file, a letter, digit or hyphen each.
    pub id: String,
    /// What it shows.
    pub caption: String,
    /// Headings of the columns.
    pub columns: Vec<String>,
    /// Cells, a row each.
    pub rows: Vec<Vec<String>>,
    /// A first line of headings over groups of columns: text and number of columns.
    pub groups: Vec<(String, usize)>,
}

/// A drawing with its caption, its description for those who do not see it, and its data.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Name of its file, a letter, digit or hyphen each.
    pub id: String,
    /// What it shows.
    pub caption: String,
    /// The same for those who do not see it.
    pub alt: String,
    /// The drawing.
    pub svg: String,
    /// What it is drawn of.
    pub data: DataTable,
}

impl Block {
    /// A figure whose own label is its description.
    pub fn figure(mut figure: Figure) -> Self {
        let label = |text: &str| format!("aria-label=\"{}\"", escape(text));
        figure.svg = figure.svg.replacen(&label(&figure.caption), &label(&figure.alt), 1);
        Self::Figure(figure)
    }
}

impl DataTable {
    /// A table without rows.
    pub fn new(
        id: impl Into<String>,
        caption: impl Into<String>,
        columns: impl IntoIterator<Item = impl Into<String>>,
    ) -> Self {
        Self {
            id: id.into(),
            caption: caption.into(),
            columns: columns.into_iter().map(Into::into).collect(),
            ..Self::default()
        }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl IntoIterator<Item = impl Into<String>>) {
        self.rows.push(cells.into_iter().map(Into::into).collect());
    }

    /// Whether every cell of a column is a number or blank.
    pub(crate) fn is_number_column(&self, place: usize) -> bool {
        let mut cells = self.rows.iter().filter_map(|row| row.get(place));
        cells.all(|cell| is_number(cell) || cell.is_empty())
    }

    /// Columns with the heading of their group in front, where there are groups.
    pub(crate) fn full_columns(&self) -> Vec<String> {
        let groups = self.groups.iter().flat_map(|(text, columns)| vec![text.as_str(); *columns]);
        self.columns
            .iter()
            .zip(groups.chain(std::iter::repeat("")))
            .map(|(column, group)| match (group, column.as_str()) {
                ("", _) => column.clone(),
                (_, "") => group.to_owned(),
                _ => format!("{group}: {column}"),
            })
            .collect()
    }

    /// As CSV with commas.
    pub fn to_csv(&self) -> String {
        csv_text(std::iter::once(&self.full_columns()).chain(&self.rows))
    }
}

/// Whether people read a cell as a number.
pub(crate) fn is_number(cell: &str) -> bool {
    cell.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '-' | '−' | '<' | '–'))
        && cell.chars().filter(|c| c.is_alphabetic() && *c != 'e').count() == 0
}

/// Rows as CSV with commas; they may be of different lengths.
pub fn csv_text<R>(rows: impl IntoIterator<Item = R>) -> String
where
    R: IntoIterator,
    R::Item: AsRef<[u8]>,
{
    let mut writer = csv::WriterBuilder::new().flexible(true).from_writer(Vec::new());
    for row in rows {
        writer.write_record(row).expect("a vector takes every row");
    }
    let bytes = writer.into_inner().expect("a vector takes every row");
    String::from_utf8(bytes).expect("cells of text are text")
}

/// Letters, digits and hyphens: part of a file name.
pub fn slug(text: &str) -> String {
    let mut slug = String::new();
    for c in text.chars() {
        if c.is_ascii_alphanumeric() {
            slug.push(c.to_ascii_lowercase());
        } else if !slug.ends_with('-') && !slug.is_empty() {
            slug.push('-');
        }
    }
    slug.trim_end_matches('-').to_owned()
}

/// Text that is safe between tags and in quoted attributes.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            _ => escaped.push(c),
        }
    }
    escaped
}
