//! A report as one HTML file: no network, light, dark and print, for wide and narrow screens.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::language::Language;
use crate::report::document::{Block, DataTable, Document, Figure, is_number};

pub(crate) fn html(document: &Document, language: Language) -> String {
    let code = language.code();
    let title = typeset(&document.title);
    let page = html! {
        (DOCTYPE)
        html lang=(code) {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header {
                    h1 { (title) }
                    p.subtitle { (typeset(&document.subtitle)) }
                    nav aria-label=(language.pick("Contents", "Sommaire")) {
                        @for (section, block) in document.blocks.iter().enumerate() {
                            @if let Block::Heading(2, text) = block {
                                a href={ "#s" (section) } { (typeset(text)) }
                            }
                        }
                    }
                }
                main {
                    @for (section, block) in document.blocks.iter().enumerate() {
                        (block_in_html(section, block, language))
                        "\n"
                    }
                }
            }
        }
    };
    page.into_string() + "\n"
}

/// A block; `section` is its place, by which headings are named.
fn block_in_html(section: usize, block: &Block, language: Language) -> Markup {
    html! {
        @match block {
            Block::Heading(2, text) => h2 id={ "s" (section) } { (typeset(text)) },
            Block::Heading(_, text) => h3 id={ "s" (section) } { (typeset(text)) },
            Block::Paragraph(text) => p { (typeset(text)) },
            Block::Reading(text) => p.reading { (typeset(text)) },
            Block::Caution(text) => p.caution { (typeset(text)) },
            Block::Table(data) => (table(data)),
            Block::Figure(drawing) => (figure(drawing, language)),
        }
    }
}

/// Text for people, without line breaks inside `p = 0.01`, `95 %` or before French marks.
fn typeset(text: &str) -> String {
    const JOINED: [(&str, &str); 11] = [
        (" = ", "\u{a0}=\u{a0}"),
        (" < ", "\u{a0}<\u{a0}"),
        (" %", "\u{a0}%"),
        (" :", "\u{a0}:"),
        (" ;", "\u{a0};"),
        (" ?", "\u{a0}?"),
        (" !", "\u{a0}!"),
        (" »", "\u{a0}»"),
        ("« ", "«\u{a0}"),
        (" − ", "\u{a0}−\u{a0}"),
        (" – ", "\u{a0}–\u{a0}"),
    ];
    let joined = JOINED.iter().fold(text.to_owned(), |text, (from, to)| text.replace(from, to));
    degrees_joined(&joined)
}

/// Without a line break inside the degrees of freedom of `F(2, 48)`.
fn degrees_joined(text: &str) -> String {
    let mut parts = text.split(", ");
    let mut joined = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let after_digits = part.trim_start_matches(|c: char| c.is_ascii_digit());
        let inside = joined.ends_with(|c: char| c.is_ascii_digit())
            && after_digits.len() < part.len()
            && after_digits.starts_with(')');
        joined.push_str(if inside { ",\u{a0}" } else { ", " });
        joined.push_str(part);
    }
    joined
}

fn table(data: &DataTable) -> Markup {
    // Rows of tests are read across: they scroll rather than break.
    let of_tests = !data.groups.is_empty() || data.id.ends_with("-pairs");
    let caption = typeset(&data.caption);
    html! {
        // The caption stands outside, so that it does not scroll away on a narrow screen.
        p.caption aria-hidden="true" { (caption) }
        div.scroll role="region" tabindex="0" aria-label=(caption) {
            table.tests[of_tests] aria-label=(caption) {
                thead {
                    @if !data.groups.is_empty() {
                        tr {
                            @for (text, columns) in &data.groups {
                                @if text.is_empty() {
                                    td.group colspan=(columns) {}
                                } @else {
                                    th.group colspan=(columns) { (typeset(text)) }
                                }
                            }
                        }
                        "\n"
                    }
                    tr {
                        @for (place, column) in data.columns.iter().enumerate() {
                            // Headings stand where the cells below them stand.
                            @let numbers = place > 0 && data.is_number_column(place);
                            th.number[numbers] scope="col" { (typeset(column)) }
                        }
                    }
                }
                tbody {
                    @for row in &data.rows {
                        tr {
                            @for (place, cell) in row.iter().enumerate() {
                                @if place == 0 {
                                    th scope="row" { (typeset(cell)) }
                                } @else {
                                    td.number[is_number(cell)] { (typeset(cell)) }
                                }
                            }
                        }
                        "\n"
                    }
                }
            }
        }
    }
}

fn figure(drawing: &Figure, language: Language) -> Markup {
    html! {
        figure {
            (PreEscaped(&drawing.svg))
            figcaption { (typeset(&drawing.caption)) }
            details {
                summary { (language.pick("Data of this figure", "Données de cette figure")) }
                (table(&drawing.data))
            }
        }
    }
}

const STYLE: &str = "\
:root{--ink:#1c2126;--soft:#555e68;--paper:#fff;--panel:#f4f6f8;--rule:#d5dae0;--link:#0a4f86;--warn:#8a4b00;--warn-bg:#fff6e8;--ok-bg:#eef5fb}
@media screen and (prefers-color-scheme:dark){:root{--ink:#e8ebee;--soft:#a9b2bc;--paper:#15191e;--panel:#1d2329;--rule:#3a434d;--link:#8cc4f2;--warn:#f0b35e;--warn-bg:#2b2317;--ok-bg:#18242f}}
*{box-sizing:border-box}
html{-webkit-text-size-adjust:100%}
body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.55 system-ui,-apple-system,'Segoe UI',Roboto,'Helvetica Neue',Arial,sans-serif}
header,main{max-width:72rem;margin:0 auto;padding:0 1.25rem}
header{padding-top:2.5rem}
main{padding-bottom:4rem}
h1{font-size:1.9rem;line-height:1.2;margin:0 0 .4rem}
h2{font-size:1.35rem;margin:2.8rem 0 .6rem;padding-top:1rem;border-top:1px solid var(--rule)}
h3{font-size:1.08rem;margin:2rem 0 .4rem}
.subtitle{color:var(--soft);margin:0 0 1rem}
nav{display:flex;flex-wrap:wrap;gap:.3rem 1.1rem}
a{color:var(--link)}
nav a{padding:.2rem 0;min-height:1.75rem}
p{max-width:42rem;margin:.6rem 0}
.reading{background:var(--ok-bg);border-left:4px solid var(--link);padding:.7rem 1rem;border-radius:0 4px 4px 0}
.caution{background:var(--warn-bg);border-left:4px solid var(--warn);padding:.7rem 1rem;border-radius:0 4px 4px 0}
.scroll{overflow-x:auto;margin:0 0 1.2rem;max-width:100%}
.scroll:focus-visible,summary:focus-visible,a:focus-visible{outline:2px solid var(--link);outline-offset:2px}
table{border-collapse:separate;border-spacing:0;font-size:.9rem;font-variant-numeric:tabular-nums}
p.caption{color:var(--soft);font-size:.9rem;margin:1rem 0 .3rem}
th,td{padding:.32rem .7rem;text-align:left;border-bottom:1px solid var(--rule);vertical-align:top}
thead th{border-bottom:2px solid var(--rule);font-weight:600;vertical-align:bottom}
tbody th{font-weight:500}
td.number,th.number{text-align:right}
.tests{font-size:.86rem}
.tests th,.tests td{padding:.3rem .5rem}
td.number,.tests td,.tests tbody th{white-space:nowrap}
.scroll tbody th{position:sticky;left:0;background:var(--paper)}
.group{font-weight:600;background:var(--panel);border-left:2px solid var(--paper)}
td.group{background:none}
figure{margin:1.5rem 0;padding:0}
figure svg{display:block;max-width:100%;height:auto}
figcaption{color:var(--soft);font-size:.9rem;max-width:36rem;margin:.4rem 0}
summary{cursor:pointer;color:var(--link);font-size:.9rem;padding:.2rem 0}
@media (min-width:40rem){figure svg{width:34rem}}
@media print{body{font-size:10.5pt}header,main{max-width:none;padding:0}nav,details{display:none}p{max-width:none}h2,h3,.caption{break-after:avoid}figure,tr,.scroll,.reading,.caution{break-inside:avoid}.scroll{overflow:visible}}
";
