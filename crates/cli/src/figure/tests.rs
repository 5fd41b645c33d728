use std::f64::consts::TAU;

use super::*;

fn grid(n: usize) -> impl Iterator<Item = f64> {
    (0..n).map(move |i| 5.0 * i as f64 / (n - 1) as f64)
}

fn curve(n: usize, f: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    grid(n).map(|t| (t, f(t))).collect()
}

/// Coordinates and speeds of four joints, ideal and with friction, like Fig. 11 of the paper.
fn coordinates_and_speeds(n: usize) -> Figure {
    let names = ["₁₁", "₂₁", "₂₂", "₂₃"];
    let mut figure = Figure::new("RSRRR: joint coordinates and speeds");
    for (k, name) in names.iter().enumerate() {
        let (amplitude, shift) = (1.0 / (k + 1) as f64, 0.7 * k as f64);
        let angle =
            move |t: f64, slow: f64| amplitude * (9.0 * slow * (t - 0.8 * (1.0 - (-t).exp())) + shift).sin() + shift;
        let speed = move |t: f64, slow: f64| (angle(t + 1e-5, slow) - angle(t - 1e-5, slow)) / 2e-5;
        let panel = |label: String, f: &dyn Fn(f64, f64) -> f64| {
            Panel::new("", Axis::linear("t (s)"), Axis::linear(label))
                .series(Series::line("ideal joints", 0, curve(n, |t| f(t, 1.0))))
                .series(Series::line("with friction", 1, curve(n, |t| f(t, 0.97))))
        };
        figure = figure
            .panel(panel(format!("ψ{name} (rad)"), &angle))
            .panel(panel(format!("dψ{name}/dt (rad/s)"), &speed));
    }
    figure
}

/// Error against run time and a phase plot.
fn log_and_phase() -> Figure {
    let work = |factor: f64, order: f64| {
        (0..9)
            .map(|i| 10f64.powi(-3 - i))
            .map(|tol| (factor * tol.powf(-1.0 / order), 0.3 * tol))
            .collect::<Vec<_>>()
    };
    let circle = |r: f64| {
        (0..=5000)
            .map(|i| TAU * f64::from(i) / 5000.0)
            .map(|a| (r * a.cos(), r * a.sin()))
            .collect()
    };
    let spiral = (0..=20000)
        .map(|i| f64::from(i) / 200.0)
        .map(|a| (a * a.cos() * 1e-5, a * a.sin() * 1e-5))
        .collect();
    Figure::new("Error against run time, and the journal in its bearing")
        .legend(Legend::Panels)
        .size(900, 360)
        .panel(
            Panel::new("work and precision", Axis::log("run time (s)"), Axis::log("error"))
                .series(Series::new("Radau 5", 0, Mark::LineAndDots, work(1e-3, 5.0)))
                .series(Series::new("DOPRI 5", 1, Mark::LineAndDots, work(3e-4, 4.0)))
                .series(Series::new("BDF", 2, Mark::Dots, work(2e-3, 3.0))),
        )
        .panel(
            Panel::new("path of the journal", Axis::linear("x (m)"), Axis::linear("y (m)"))
                .equal_axes()
                .series(Series::line("clearance", 5, circle(1e-3)))
                .series(Series::line("journal", 0, spiral)),
        )
}

#[test]
fn size_is_bounded_whatever_the_data() {
    let svg = coordinates_and_speeds(5001).to_svg().unwrap();
    assert!(svg.len() < 300_000, "{}", svg.len());
    let mut noisy = Figure::new("noise");
    for k in 0..8 {
        let hash = move |t: f64| ((t * 12_345.678 + f64::from(k)).sin() * 43_758.545).fract();
        let panel = Panel::new("", Axis::linear("t (s)"), Axis::linear("f (N)"))
            .series(Series::line("a", 0, curve(50_001, hash)))
            .series(Series::new("b", 1, Mark::Dots, curve(20_001, |t| 2.0 * hash(t))));
        noisy = noisy.panel(panel);
    }
    let svg = noisy.to_svg().unwrap();
    assert!(svg.len() < 300_000, "{}", svg.len());
}

#[test]
fn series_are_told_apart_and_named_once() {
    let svg = coordinates_and_speeds(501).to_svg().unwrap();
    assert_eq!(svg.matches("with friction").count(), 1);
    // Eight panels and the legend.
    assert_eq!(svg.matches("stroke-dasharray").count(), 9);
    // The time axis is written once for each column.
    assert_eq!(svg.matches("t (s)").count(), 2);
}

#[test]
fn svg_is_well_formed_with_awkward_text() {
    let text = "a < b & \"c\" > 'd' \u{0} \u{1b}[0m \n ψ̈";
    let figure = Figure::new(text).panel(
        Panel::new(text, Axis::linear(text), Axis::linear(text)).series(Series::line(text, 7, curve(11, f64::sin))),
    );
    let png = figure.to_png(1.0).expect("parsed as XML");
    assert_eq!(&png[1..4], b"PNG");
}

#[test]
fn a_legend_in_a_panel_keeps_clear_of_the_curves() {
    let place = |f: fn(f64) -> f64| {
        let panel = one(curve(101, f)).series(Series::line("other", 1, curve(101, f)));
        let svg = Figure::new("").legend(Legend::Panels).panel(panel).to_svg().unwrap();
        let ground = svg
            .lines()
            .find(|l| l.contains("fill-opacity"))
            .expect("a legend")
            .to_owned();
        let of = |name: &str| -> f64 {
            let rest = ground.split(&format!(" {name}=\"")).nth(1).expect("an attribute");
            rest.split('"').next().and_then(|x| x.parse().ok()).expect("a number")
        };
        (of("x") > 500.0, of("y") > 100.0)
    };
    // Right and at the bottom?
    assert_eq!(place(|t| -t), (true, false));
    assert_eq!(place(|t| t), (false, false));
    assert_eq!(place(|t| (t - 2.5).abs()), (true, true));
}

#[test]
fn same_data_gives_the_same_bytes() {
    let (a, b) = (coordinates_and_speeds(501), coordinates_and_speeds(501));
    assert_eq!(a.to_svg().unwrap(), b.to_svg().unwrap());
    assert_eq!(a.to_png(1.0).unwrap(), b.to_png(1.0).unwrap());
}

#[test]
fn png_has_the_size_asked_for() {
    let png = log_and_phase().to_png(2.0).unwrap();
    let width = u32::from_be_bytes([png[16], png[17], png[18], png[19]]);
    assert_eq!(width, 1800);
}

fn one(points: Vec<(f64, f64)>) -> Panel {
    Panel::new("p", Axis::linear("x"), Axis::linear("y")).series(Series::line("s", 0, points))
}

#[test]
fn flat_single_and_huge_data_can_be_drawn() {
    for points in [
        vec![(0.0, 0.0)],
        vec![(0.0, 5.0), (1.0, 5.0)],
        vec![(0.0, 1.0), (1.0, 1.0 + 1e-15)],
        vec![(1e9, -1e300), (1e9 + 1.0, 1e300)],
        vec![(0.0, 5e-324), (1.0, -0.0)],
    ] {
        let svg = Figure::new("")
            .panel(one(points.clone()))
            .to_svg()
            .unwrap_or_else(|e| panic!("{points:?}: {e}"));
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{points:?}");
    }
}

#[test]
fn curves_are_cut_off_at_a_given_range() {
    let mut panel = one(curve(101, |t| 1e12 * (t - 2.5)));
    panel.y = panel.y.range(-1.0, 1.0);
    let svg = Figure::new("").columns(1).panel(panel).to_svg().unwrap();
    let line = svg.lines().find(|l| l.contains("<polyline")).expect("a curve");
    let points = line
        .split("points=\"")
        .nth(1)
        .and_then(|p| p.split('"').next())
        .expect("its points");
    for y in points
        .split_whitespace()
        .filter_map(|p| p.split(',').nth(1)?.parse::<f64>().ok())
    {
        assert!((0.0..2200.0).contains(&y), "{y}");
    }
}

#[test]
fn what_cannot_be_drawn_is_refused_by_name() {
    let draw = |panel: Panel| Figure::new("f").panel(panel).to_svg().expect_err("refused");
    assert!(matches!(Figure::new("f").to_svg(), Err(FigureError::NoPanel { figure }) if figure == "f"));
    assert!(matches!(draw(one(vec![])), FigureError::NoPoint { panel } if panel == "p"));
    assert!(matches!(
        draw(one(vec![(0.0, 0.0), (1.0, f64::NAN)])),
        FigureError::NotFinite { index: 1, .. }
    ));
    assert!(matches!(
        draw(one(vec![(f64::INFINITY, 0.0)])),
        FigureError::NotFinite { index: 0, .. }
    ));
    let mut log = one(vec![(1.0, 1.0), (2.0, 0.0)]);
    log.y = Axis::log("y");
    assert!(matches!(
        draw(log),
        FigureError::NotPositive {
            index: 1,
            value: 0.0,
            ..
        }
    ));
    assert!(matches!(
        draw(one(vec![(0.0, -1e308), (1.0, 1e308)])),
        FigureError::Range { .. }
    ));
    for (low, high) in [(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::INFINITY)] {
        let mut panel = one(vec![(0.0, 0.0)]);
        panel.x = panel.x.range(low, high);
        assert!(matches!(draw(panel), FigureError::Range { .. }), "{low} {high}");
    }
}

#[test]
fn impossible_sizes_are_refused() {
    for (width, height) in [(0, 0), (10, 100), (1000, 0), (u32::MAX, 100), (1000, u32::MAX)] {
        let figure = Figure::new("f")
            .size(width, height)
            .panel(one(vec![(0.0, 0.0), (1.0, 1.0)]));
        assert!(
            matches!(figure.to_svg(), Err(FigureError::Size { .. })),
            "{width} x {height}"
        );
    }
}

/// Every picture renders both ways; with the environment variable `LINKDYN_PICTURES` they are written to that folder, to be looked at.
#[test]
fn pictures_render() {
    let folder = std::env::var_os("LINKDYN_PICTURES").map(std::path::PathBuf::from);
    for (name, figure) in [
        ("coordinates", coordinates_and_speeds(5001)),
        ("log-and-phase", log_and_phase()),
    ] {
        let (svg, png) = (figure.to_svg().unwrap(), figure.to_png(2.0).unwrap());
        if let Some(folder) = &folder {
            std::fs::write(folder.join(format!("{name}.svg")), svg).unwrap();
            std::fs::write(folder.join(format!("{name}.png")), png).unwrap();
        }
    }
}
