//! Curves in a grid of panels, as SVG and as PNG.
//!
//! Curves are written in tenths of a pixel, so that slow ones have no steps, and with no more points than the eye can
//! tell. The PNG is rendered from the same SVG with the font that the program carries.
//!
//! Of the plotting libraries, plotters knows only whole pixels, no dash patterns and no logarithmic grid that one could
//! print, and kuva takes longer to build than all the rest of the program; so the layout is ours and the `svg` crate writes it.
//!
//! ```
//! use linkdyn_cli::figure::{Axis, Figure, Panel, Series};
//!
//! let points: Vec<(f64, f64)> = (0..=500).map(|i| f64::from(i) * 0.01).map(|t| (t, t.sin())).collect();
//! let figure = Figure::new("Pendulum")
//!     .columns(1)
//!     .panel(Panel::new("", Axis::linear("t (s)"), Axis::linear("ψ (rad)")).series(Series::line("ideal", 0, points)));
//! let svg = figure.to_svg()?;
//! assert!(svg.starts_with("<svg"));
//! # Ok::<(), linkdyn_cli::figure::FigureError>(())
//! ```

mod draw;
mod layout;
mod raster;
mod simplify;
mod strokes;
mod ticks;

pub(crate) use draw::clean;
pub(crate) use layout::text_width;
pub(crate) use raster::FONT;
pub use raster::svg_to_png;

/// A title, a legend and panels in a grid.
#[derive(Clone, Debug)]
pub struct Figure {
    title: String,
    columns: usize,
    panels: Vec<Panel>,
    legend: Legend,
    width: u32,
    panel_height: u32,
}

/// Where the names of the series are told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Legend {
    /// Once for the whole figure, below the title. Series of the same name must have the same style.
    #[default]
    Figure,
    /// In every panel that has more than one series.
    Panels,
    /// Nowhere.
    None,
}

/// One pair of axes with its curves.
#[derive(Clone, Debug)]
pub struct Panel {
    title: String,
    x: Axis,
    y: Axis,
    equal: bool,
    series: Vec<Series>,
}

/// An axis: its label with the unit, its scale and, if wished, its range.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    label: String,
    scale: Scale,
    range: Option<(f64, f64)>,
}

/// How an axis places its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// In proportion.
    Linear,
    /// By their decimal logarithm; all numbers must be greater than zero.
    Log,
}

/// A curve or a set of points.
#[derive(Clone, Debug)]
pub struct Series {
    label: String,
    style: usize,
    mark: Mark,
    points: Vec<(f64, f64)>,
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A line through the points.
    Line,
    /// A dot at each point.
    Dots,
    /// Both.
    LineAndDots,
}

/// Why a figure cannot be drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FigureError {
    /// There is nothing to draw.
    #[error("figure `{figure}` has no panel")]
    NoPanel {
        /// Title of the figure.
        figure: String,
    },
    /// A panel has no point, so that its axes have no range.
    #[error("panel `{panel}` has no point to draw")]
    NoPoint {
        /// Title or label of the panel.
        panel: String,
    },
    /// A coordinate is NaN or infinite.
    #[error("panel `{panel}`, series `{series}`: point {index} is ({x}, {y}), which is not finite")]
    NotFinite {
        /// Title or label of the panel.
        panel: String,
        /// Label of the series.
        series: String,
        /// Index of the point.
        index: usize,
        /// Its first coordinate.
        x: f64,
        /// Its second coordinate.
        y: f64,
    },
    /// A coordinate on a logarithmic axis is zero or negative.
    #[error(
        "panel `{panel}`, series `{series}`: point {index} has {value} on a logarithmic axis, which needs numbers greater than zero"
    )]
    NotPositive {
        /// Title or label of the panel.
        panel: String,
        /// Label of the series.
        series: String,
        /// Index of the point.
        index: usize,
        /// The coordinate.
        value: f64,
    },
    /// The range given for an axis is empty, not finite or, on a logarithmic axis, not positive.
    #[error("panel `{panel}`: {low} to {high} is no range for an axis")]
    Range {
        /// Title or label of the panel.
        panel: String,
        /// Given lower end.
        low: f64,
        /// Given upper end.
        high: f64,
    },
    /// The figure would have no area, or so much that no memory could hold it.
    #[error("a figure of {width} x {height} pixels cannot be drawn")]
    Size {
        /// Width in pixels.
        width: f64,
        /// Height in pixels.
        height: f64,
    },
    /// The SVG cannot be read back, or the PNG cannot be encoded.
    #[error("no PNG can be made: {0}")]
    Png(String),
}

impl Figure {
    /// A figure with two columns, a legend below its title, and no panel yet.
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            columns: 2,
            panels: Vec::new(),
            legend: Legend::default(),
            width: 1000,
            panel_height: 170,
        }
    }

    /// Adds a panel; panels fill the grid row by row.
    ///
    /// Panels of one column that have the same axis of abscissae (label, scale and range) share the numbers below the
    /// lowest of them.
    #[must_use]
    pub fn panel(mut self, panel: Panel) -> Self {
        self.panels.push(panel);
        self
    }

    /// Sets the number of columns; zero counts as one.
    #[must_use]
    pub fn columns(mut self, columns: usize) -> Self {
        self.columns = columns.max(1);
        self
    }

    /// Sets where the names of the series are told.
    #[must_use]
    pub fn legend(mut self, legend: Legend) -> Self {
        self.legend = legend;
        self
    }

    /// Sets the width of the figure and the height of one panel's plot area, in pixels (1000 and 170 at first).
    #[must_use]
    pub fn size(mut self, width: u32, panel_height: u32) -> Self {
        self.width = width;
        self.panel_height = panel_height;
        self
    }

    /// Draws the figure as an SVG of less than 300 kB, however many points it has.
    ///
    /// # Errors
    /// If there is nothing to draw, a coordinate is not finite or does not fit its axis, or the size is impossible.
    pub fn to_svg(&self) -> Result<String, FigureError> {
        draw::svg(self)
    }

    /// Draws the figure as a PNG with `scale` times as many pixels as the SVG has units in each direction.
    ///
    /// # Errors
    /// As [`Figure::to_svg`], and if the size is impossible.
    pub fn to_png(&self, scale: f64) -> Result<Vec<u8>, FigureError> {
        svg_to_png(&self.to_svg()?, scale)
    }
}

impl Panel {
    /// A panel without curves. The title may be empty.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self {
            title: title.into(),
            x,
            y,
            equal: false,
            series: Vec::new(),
        }
    }

    /// Adds a curve.
    #[must_use]
    pub fn series(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Gives both axes the same scale, so that a circle looks like one.
    #[must_use]
    pub fn equal_axes(mut self) -> Self {
        self.equal = true;
        self
    }

    /// What an error calls this panel.
    fn name(&self) -> String {
        if self.title.is_empty() {
            self.y.label.clone()
        } else {
            self.title.clone()
        }
    }
}

impl Axis {
    /// A linear axis that covers its points.
    pub fn linear(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            scale: Scale::Linear,
            range: None,
        }
    }

    /// A logarithmic axis that covers its points.
    pub fn log(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            scale: Scale::Log,
            range: None,
        }
    }

    /// Sets the range. Curves are cut off outside of it.
    #[must_use]
    pub fn range(mut self, low: f64, high: f64) -> Self {
        self.range = Some((low, high));
        self
    }
}

impl Series {
    /// A series of any kind. Each `style` has a colour and a dash pattern of its own: 0 is a full blue line, 1 a dashed
    /// red one; after the last style they begin again.
    pub fn new(label: impl Into<String>, style: usize, mark: Mark, points: Vec<(f64, f64)>) -> Self {
        Self {
            label: label.into(),
            style,
            mark,
            points,
        }
    }

    /// A line through the points.
    pub fn line(label: impl Into<String>, style: usize, points: Vec<(f64, f64)>) -> Self {
        Self::new(label, style, Mark::Line, points)
    }
}

#[cfg(test)]
mod tests;
