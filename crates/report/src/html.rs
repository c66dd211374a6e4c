//! A report as one HTML file: no network, light, dark and print, for wide and narrow screens.

use maud::{DOCTYPE, Markup, PreEscaped, html};
use mimique_locale::Language;

use crate::document::{Block, DataTable, DecisionTable, Document, Figure, is_number};

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
                }
                nav aria-label=(language.pick("Contents", "Sommaire")) {
                    @for (section, block) in document.blocks.iter().enumerate() {
                        @if let Block::Heading(2, text) = block {
                            a href={ "#s" (section) } { (typeset(text)) }
                        }
                    }
                }
                main { (blocks_in_html(&document.blocks, Some(0), "", language)) }
            }
        }
    };
    page.into_string() + "\n"
}

/// Blocks one after the other; figures that follow each other stand side by side where there is room, and a figure alone
/// beside the text before it. `first`: the place of the first one, by which headings are named. `heading`: what stands
/// over them.
fn blocks_in_html(
    blocks: &[Block],
    first: Option<usize>,
    heading: &str,
    language: Language,
) -> Markup {
    let is_figure = |block: &Block| matches!(block, Block::Figure(_));
    let is_text = |block: &Block| matches!(block, Block::Paragraph(_) | Block::Reading(_));
    let one =
        |at: usize| block_in_html(&blocks[at], first.map(|first| first + at), heading, language);
    let mut parts = Vec::new();
    let mut at = 0;
    while at < blocks.len() {
        let figures = |from: usize| blocks[from..].iter().take_while(|own| is_figure(own)).count();
        if is_text(&blocks[at]) && figures(at + 1) == 1 {
            parts.push(html! { div.beside { (one(at)) (one(at + 1)) } });
            at += 2;
        } else if is_figure(&blocks[at]) {
            let run = at..at + figures(at);
            at = run.end;
            parts.push(html! { div.figures { @for figure in run { (one(figure)) } } });
        } else {
            parts.push(one(at));
            at += 1;
        }
    }
    html! { @for part in parts { (part) "\n" } }
}

fn block_in_html(
    block: &Block,
    section: Option<usize>,
    heading: &str,
    language: Language,
) -> Markup {
    let id = section.map(|section| format!("s{section}"));
    html! {
        @match block {
            Block::Heading(2, text) => h2 id=[id] { (typeset(text)) },
            Block::Heading(_, text) => h3 id=[id] { (typeset(text)) },
            Block::Paragraph(text) => p { (typeset(text)) },
            Block::Reading(text) => p.reading { (typeset(text)) },
            Block::Caution(text) => p.caution { (typeset(text)) },
            Block::Paper(text) => p.paper { (typeset(text)) },
            Block::Table(data) => (table(data, data.caption != heading)),
            Block::Figure(drawing) => (figure(drawing, language)),
            Block::Decisions(decisions) => (decision_table(decisions, language)),
            Block::Folded(heading, own) => details.folded {
                summary { (typeset(heading)) }
                (blocks_in_html(own, None, heading, language))
            },
        }
    }
}

/// A row per hypothesis, its intervals drawn beside their numbers.
fn decision_table(decisions: &DecisionTable, language: Language) -> Markup {
    let data = &decisions.data;
    let drawn = language.pick("drawn", "dessin");
    html! {
        div.scroll role="region" tabindex="0" aria-label=(typeset(&data.caption)) {
            table.decisions aria-label=(typeset(&data.caption)) {
                thead {
                    tr {
                        @for (place, column) in data.columns.iter().enumerate() {
                            th.number[place > 2] scope="col" { (typeset(column)) }
                            @if place == 2 { th scope="col" { (drawn) } }
                        }
                    }
                }
                tbody {
                    @for (cells, effects) in data.rows.iter().zip(&decisions.effects) {
                        tr {
                            @for (place, cell) in cells.iter().enumerate() {
                                @match place {
                                    0 => th scope="row" { (typeset(cell)) },
                                    1 => td { (typeset(cell)) },
                                    2 => {
                                        td.effects {
                                            @for line in &effects.lines {
                                                div { (typeset(line)) }
                                            }
                                        }
                                        td.drawn {
                                            @if let Some(drawing) = &effects.drawing {
                                                (PreEscaped(drawing))
                                            }
                                        }
                                    },
                                    _ => td.number { (typeset(cell)) },
                                }
                            }
                        }
                        "\n"
                    }
                }
            }
        }
        @if !decisions.scale.is_empty() {
            p.caption { (typeset(&decisions.scale)) }
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

fn table(data: &DataTable, with_caption: bool) -> Markup {
    // Rows of tests are read across: they scroll rather than break.
    let of_tests = !data.groups.is_empty() || data.id.ends_with("-pairs");
    let caption = typeset(&data.caption);
    html! {
        // The caption stands outside, so that it does not scroll away on a narrow screen.
        @if with_caption {
            p.caption aria-hidden="true" { (caption) }
        }
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
                (table(&drawing.data, true))
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
header,main{max-width:76rem;margin:0 auto;padding:0 1.25rem;width:100%}
header{padding-top:1.6rem}
main{padding-bottom:4rem}
main>h2:first-child{border-top:0;margin-top:.4rem;padding-top:0}
h1{font-size:1.9rem;line-height:1.2;margin:0 0 .4rem}
h2{font-size:1.35rem;margin:2.8rem 0 .6rem;padding-top:1rem;border-top:1px solid var(--rule)}
h3{font-size:1.08rem;margin:2rem 0 .4rem}
.subtitle{color:var(--soft);margin:0 0 1rem}
nav{display:flex;gap:.3rem 1.1rem;overflow-x:auto;white-space:nowrap;max-width:76rem;margin:0 auto;padding:.3rem 1.25rem;width:100%}
a{color:var(--link)}
nav a{padding:.2rem 0;min-height:1.75rem}
@media screen and (min-width:80rem){body{display:grid;grid-template-columns:15rem minmax(0,1fr);grid-template-rows:auto 1fr}header,main{grid-column:2;margin:0}nav{grid-column:1;grid-row:1/3;flex-direction:column;white-space:normal;position:sticky;top:0;align-self:start;max-height:100vh;overflow-y:auto;padding:1.8rem 1rem 1.8rem 1.25rem;font-size:.9rem;line-height:1.35}}
p{max-width:46rem;margin:.6rem 0}
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
.figures{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(28rem,100%),1fr));gap:.5rem 2.5rem;align-items:start;margin:1rem 0}
figure{margin:.6rem 0;padding:0;max-width:40rem;min-width:0}
figure svg{display:block;width:100%;max-width:100%;height:auto}
.beside{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(28rem,100%),1fr));gap:.5rem 2.5rem;align-items:start;margin:.6rem 0}
.beside>p{margin:.6rem 0}
.decisions{width:100%}
.decisions th,.decisions td{padding:.38rem .42rem;line-height:1.35;vertical-align:middle}
.decisions tbody th{min-width:11rem;font-weight:500}
.decisions th.number{max-width:9rem}
.decisions td:nth-child(2){min-width:8rem}
@media (max-width:40rem){.decisions tbody th{min-width:9rem}}
.decisions .effects{white-space:nowrap;font-size:.83rem}
.decisions .effects div{height:22px;line-height:22px}
.decisions .drawn{padding-left:0;padding-right:0}
.forest{display:block;min-width:180px}
.forest .interval{stroke:var(--link);stroke-width:2}
.forest .estimate{fill:var(--link)}
.forest .none{stroke:var(--soft);stroke-dasharray:3 3}
.forest .zone{fill:var(--rule);fill-opacity:.6}
.folded{margin:.5rem 0}
.folded>summary{font-size:.95rem;padding:.3rem 0;min-height:1.75rem}
.folded[open]{border-left:2px solid var(--rule);padding-left:1rem}
.paper{border:1px solid var(--rule);border-radius:4px;padding:.8rem 1rem;max-width:52rem}
figcaption{color:var(--soft);font-size:.9rem;max-width:36rem;margin:.4rem 0}
summary{cursor:pointer;color:var(--link);font-size:.9rem;padding:.2rem 0}
@media print{@page{margin:11mm 11mm}html{font-size:10.6px}body{font-size:8.4pt;line-height:1.27}header,main{max-width:none;padding:0}nav,details,.folded{display:none}p,.paper{max-width:none;margin:.35rem 0}h1{font-size:16pt}h2{font-size:12pt;margin:.8rem 0 .2rem;padding-top:.4rem}h3{font-size:9.6pt;margin:.5rem 0 .1rem}h2,h3,.caption{break-after:avoid}figure,tr,.reading,.caution{break-inside:avoid}.reading,.caution{padding:.3rem .7rem}.scroll{overflow:visible;margin:0 0 .5rem}th,td,.decisions th,.decisions td{padding:.15rem .4rem}table{font-size:8pt}.forest{width:84px;min-width:84px;height:auto}.decisions tbody th{min-width:0;width:27%}.decisions .effects{white-space:normal;min-width:62mm;font-size:7.6pt}.decisions th.number{max-width:20mm}.decisions td:nth-child(2){min-width:24mm}.decisions .effects div{height:auto;line-height:1.35}.figures,.beside{grid-template-columns:1fr 1fr;gap:.2rem 1.2rem;margin:.3rem 0}.beside{break-inside:avoid}figure{margin:.2rem 0}figure svg{max-height:5cm}figcaption{font-size:8pt;margin:.1rem 0;max-width:none}}
";
