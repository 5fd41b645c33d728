//! SVG to PNG with the font that the program carries.

use std::sync::{Arc, LazyLock};

use resvg::{tiny_skia, usvg};

use super::FigureError;

/// The typeface of all pictures; the program carries it.
pub(crate) const FONT: &str = "DejaVu Sans";

/// Largest number of pixels of a PNG: 400 MB in memory.
const MOST_PIXELS: f64 = 1e8;

static FONTS: LazyLock<Arc<usvg::fontdb::Database>> = LazyLock::new(|| {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_source(usvg::fontdb::Source::Binary(Arc::new(dejavu::sans::regular())));
    fonts.set_sans_serif_family(FONT);
    Arc::new(fonts)
});

/// Renders an SVG with `scale` pixels per unit of its size. Only the carried font is used, never one of the machine's, so that
/// the result is the same everywhere.
///
/// # Errors
/// If the text is no SVG, or the size is not positive or too large for the memory.
pub fn svg_to_png(svg: &str, scale: f64) -> Result<Vec<u8>, FigureError> {
    let options = usvg::Options {
        fontdb: Arc::clone(&FONTS),
        font_family: FONT.to_owned(),
        ..usvg::Options::default()
    };
    let tree = usvg::Tree::from_str(svg, &options).map_err(|error| FigureError::Png(error.to_string()))?;
    let (width, height) = (
        f64::from(tree.size().width()) * scale,
        f64::from(tree.size().height()) * scale,
    );
    let impossible = FigureError::Size { width, height };
    if !(width >= 1.0 && height >= 1.0 && width * height <= MOST_PIXELS) {
        return Err(impossible);
    }
    let mut pixels = tiny_skia::Pixmap::new(width.round() as u32, height.round() as u32).ok_or(impossible)?;
    let transform = tiny_skia::Transform::from_scale(scale as f32, scale as f32);
    resvg::render(&tree, transform, &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| FigureError::Png(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_rendered_without_fonts_of_the_machine() {
        let with = |text: &str| {
            let svg = format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"60\" height=\"20\"><text x=\"2\" y=\"15\" font-family=\"No Such Font, sans-serif\" font-size=\"12\">{text}</text></svg>"
            );
            svg_to_png(&svg, 1.0).unwrap()
        };
        let empty = with("");
        for text in ["a", "ψ", "θ", "₁", "⁻", "·", "−"] {
            assert_ne!(with(text), empty, "{text}");
            // A missing glyph would look like the box for any other missing one.
            assert_ne!(with(text), with("\u{10fffd}"), "{text}");
        }
    }

    #[test]
    fn no_svg_and_impossible_sizes_are_refused() {
        assert!(matches!(svg_to_png("<html/>", 1.0), Err(FigureError::Png(_))));
        assert!(matches!(svg_to_png("", 1.0), Err(FigureError::Png(_))));
        let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"60\" height=\"20\"/>";
        for scale in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e9] {
            assert!(
                matches!(svg_to_png(svg, scale), Err(FigureError::Size { .. })),
                "{scale}"
            );
        }
    }
}
