//! A figure as PDF: an SVG that stands alone comes in, a page of its size goes out, the same on every machine.
//!
//! Text stays text. Its font, DejaVu Sans Condensed, stands in the binary: it is about as wide as the fonts for which
//! the figures are laid out, and has Latin, Greek and Cyrillic letters and the signs of mathematics.

use std::collections::BTreeSet;
use std::sync::Arc;

use krilla::Document;
use krilla::geom::Size;
use krilla::metadata::Metadata;
use krilla::page::PageSettings;
use krilla_svg::{SurfaceExt, SvgSettings};
use mimique_report::ReportFile;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use usvg::{Group, Node, Tree, fontdb, roxmltree};

/// Why a figure is no PDF.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
enum FigurePdfError {
    /// What came in is no SVG that can be drawn.
    #[error("this is no SVG ({0})")]
    NoSvg(String),
    /// The text has signs for which the font has no glyph.
    #[error("the font of PDFs does not have {}", signs.join(" "))]
    MissingSigns {
        /// Each once, in order.
        signs: Vec<String>,
    },
    /// The drawing could not be written.
    #[error("the PDF cannot be written: {0}")]
    Unwritten(String),
}

/// A figure of a report as PDF.
#[derive(Debug)]
struct Made {
    /// Path of the SVG among the report's files.
    svg: String,
    /// The PDF, or why there is none.
    pdf: Result<Vec<u8>, FigurePdfError>,
}

impl Made {
    /// Path of the PDF: beside the SVG.
    fn path(&self) -> String {
        format!("{}.pdf", self.svg.trim_end_matches(".svg"))
    }
}

/// The files of a report by their paths, the PDF of each figure behind them. `told` hears in a sentence of each figure
/// that has none.
pub fn with_pdfs(files: &[ReportFile], told: impl Fn(&str)) -> Vec<(String, Vec<u8>)> {
    let texts = files.iter().map(|file| (file.path.clone(), file.text.clone().into_bytes()));
    let mut all: Vec<_> = texts.collect();
    for made in figures(files) {
        let path = made.path();
        match made.pdf {
            Ok(bytes) => all.push((path, bytes)),
            Err(error) => told(&format!("{}: {error}; take the SVG, it has no PDF", made.svg)),
        }
    }
    all
}

/// The PDF of each figure among the files of a report, in their order.
fn figures(files: &[ReportFile]) -> Vec<Made> {
    let figures: Vec<(&str, &ReportFile)> = (files.iter())
        .filter_map(|file| Some((file.path.strip_prefix("figures/")?.strip_suffix(".svg")?, file)))
        .collect();
    let maker = FigurePdf::new();
    figures
        .into_par_iter()
        .map(|(name, file)| Made { svg: file.path.clone(), pdf: maker.of_svg(name, &file.text) })
        .collect()
}

/// Points of PDF per pixel of SVG: 96 pixels are an inch, and so are 72 points.
const POINTS_PER_PIXEL: f32 = 0.75;

/// Makes PDFs with the fonts of the binary.
struct FigurePdf {
    options: usvg::Options<'static>,
}

impl FigurePdf {
    /// Reads the fonts, which takes some milliseconds.
    fn new() -> Self {
        let mut fonts = fontdb::Database::new();
        for font in [dejavu::sans_condensed::regular(), dejavu::sans_condensed::bold()] {
            fonts.load_font_source(fontdb::Source::Binary(Arc::new(font)));
        }
        let family = fonts.faces().next().and_then(|face| face.families.first());
        let family = family.map(|(name, _)| name.clone()).unwrap_or_default();
        fonts.set_sans_serif_family(family.clone());
        let fontdb = Arc::new(fonts);
        Self { options: usvg::Options { font_family: family, fontdb, ..usvg::Options::default() } }
    }

    /// The PDF of a figure; its title is the name.
    ///
    /// # Errors
    /// What is no SVG, and text with signs that the font does not have.
    fn of_svg(&self, name: &str, svg: &str) -> Result<Vec<u8>, FigurePdfError> {
        let no_svg = |why: &dyn ToString| FigurePdfError::NoSvg(why.to_string());
        let parsed = roxmltree::Document::parse(svg).map_err(|error| no_svg(&error))?;
        let tree = Tree::from_xmltree(&parsed, &self.options).map_err(|error| no_svg(&error))?;
        let mut missing = BTreeSet::new();
        collect_missing(tree.root(), &mut missing);
        if !missing.is_empty() {
            return Err(FigurePdfError::MissingSigns { signs: missing.into_iter().collect() });
        }
        let [width, height] =
            [tree.size().width(), tree.size().height()].map(|pixels| pixels * POINTS_PER_PIXEL);
        let size = Size::from_wh(width, height).ok_or_else(|| no_svg(&"it has no size"))?;
        let mut document = Document::new();
        let mut metadata = Metadata::new().title(name.to_owned());
        if let Some(label) = parsed.root_element().attribute("aria-label") {
            metadata = metadata.description(label.to_owned());
        }
        document.set_metadata(metadata);
        let mut page = document.start_page_with(PageSettings::new(size));
        let mut surface = page.surface();
        surface
            .draw_svg(&tree, size, SvgSettings::default())
            .ok_or_else(|| no_svg(&"it cannot be drawn"))?;
        surface.finish();
        page.finish();
        document.finish().map_err(|error| FigurePdfError::Unwritten(format!("{error:?}")))
    }
}

/// Signs of texts for which the fonts have no glyph.
fn collect_missing(group: &Group, missing: &mut BTreeSet<String>) {
    for node in group.children() {
        match node {
            Node::Group(inner) => collect_missing(inner, missing),
            Node::Text(text) => {
                let glyphs = text.layouted().iter().flat_map(|span| &span.positioned_glyphs);
                missing
                    .extend(glyphs.filter(|glyph| glyph.id.0 == 0).map(|glyph| glyph.text.clone()));
            }
            Node::Path(_) | Node::Image(_) => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use lopdf::{Document as Read, Object};
    use mimique_report::svg::{Anchor, Svg};

    use super::*;

    fn figure(text: &str) -> String {
        let mut svg = Svg::new("Répartition: 50 % & <plus>", 100.0);
        svg.text(10.0, 20.0, "strong", Anchor::Start, text);
        svg.text(10.0, 60.0, "small", Anchor::Start, "p = 0.03, −0.5 ± 1 µ");
        svg.class_rect([200.0, 40.0, 100.0, 20.0], "box");
        svg.finish()
    }

    #[test]
    fn a_page_of_the_figures_size_whose_text_can_be_read_back() {
        let pdf = FigurePdf::new().of_svg("shares", &figure("Crédibilité")).unwrap();
        let read = Read::load_mem(&pdf).unwrap();
        let pages = read.get_pages();
        assert_eq!(pages.len(), 1);
        let page = read.get_dictionary(pages[&1]).unwrap();
        let ends: Vec<f32> = page
            .get(b"MediaBox")
            .and_then(Object::as_array)
            .unwrap()
            .iter()
            .map(|end| end.as_float().unwrap())
            .collect();
        assert_eq!(ends, [0.0, 0.0, 330.0, 75.0]);
        // The reader puts each glyph on a line of its own.
        let text = read.extract_text(&[1]).unwrap();
        let text: String = text.chars().filter(|c| !c.is_whitespace()).collect();
        assert!(text.contains("Crédibilité") && text.contains("p=0.03,−0.5±1µ"), "{text}");
        // Both weights are the binary's own, cut to the signs that are used.
        let fonts: BTreeSet<String> = read
            .objects
            .values()
            .filter_map(|object| object.as_dict().ok()?.get(b"BaseFont").ok()?.as_name().ok())
            .map(|name| String::from_utf8_lossy(name).into_owned())
            .collect();
        let cut = |end: &str| fonts.iter().any(|name| name.ends_with(end) && name.contains('+'));
        assert!(cut("DejaVuSansCondensed") && cut("DejaVuSansCondensed-Bold"), "{fonts:?}");
        assert!(pdf.len() < 40_000, "{} bytes", pdf.len());
    }

    #[test]
    fn colours_are_those_of_paper() {
        let pdf = FigurePdf::new().of_svg("shares", &figure("A")).unwrap();
        let read = Read::load_mem(&pdf).unwrap();
        let drawn = read.get_page_content(read.get_pages()[&1]);
        let drawn = String::from_utf8_lossy(&drawn).into_owned();
        // The fill of .box, #cfe1f2, and not that of a dark screen.
        assert!(drawn.contains("0.8117647 0.88235295 0.9490196"), "{drawn}");
        assert!(!drawn.contains("0.12156863 0.26666668"), "{drawn}");
    }

    #[test]
    fn the_same_figure_gives_the_same_bytes() {
        let made = || FigurePdf::new().of_svg("shares", &figure("Believability")).unwrap();
        assert_eq!(made(), made());
    }

    #[test]
    fn signs_that_the_font_lacks_are_named() {
        let refused = FigurePdf::new().of_svg("shares", &figure("信 and 実")).unwrap_err();
        assert_eq!(refused.to_string(), "the font of PDFs does not have 信 実");
        let refused = FigurePdf::new().of_svg("shares", "no drawing").unwrap_err();
        assert!(refused.to_string().starts_with("this is no SVG ("), "{refused}");
    }
}
