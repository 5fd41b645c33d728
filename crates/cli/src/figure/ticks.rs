//! Round numbers along an axis and how they are written.

use super::Scale;

/// The marks of one axis, in the axis' own coordinate (on a logarithmic axis the decimal logarithm).
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ticks {
    /// Where numbers are written.
    pub bold: Vec<f64>,
    /// Where only a thin line is drawn.
    pub light: Vec<f64>,
    format: Format,
    /// The coordinate is a logarithm, and numbers are written as on a linear axis.
    powers: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Format {
    Decimals(usize),
    Exponent(usize),
    Power,
}

impl Ticks {
    /// At most `most` numbers between `low` and `high`.
    pub fn new(scale: Scale, low: f64, high: f64, most: usize) -> Self {
        match scale {
            Scale::Linear => Self::linear(low, high, most),
            Scale::Log => Self::log(low, high, most),
        }
    }

    fn linear(low: f64, high: f64, most: usize) -> Self {
        let step = nice_step(high - low, most);
        let first = (low / step - 1e-9).ceil();
        let last = (high / step + 1e-9).floor();
        let bold: Vec<f64> = (0..)
            .map(|i| first + f64::from(i))
            .take_while(|i| *i <= last)
            .take(100)
            .map(|i| i * step)
            .collect();
        let largest = low.abs().max(high.abs());
        // Decimals that tell two neighbouring numbers apart.
        let decimals = (-(step.log10() + 1e-9).floor()).max(0.0) as usize;
        let format = if (1e-4..1e6).contains(&largest) && decimals <= 6 {
            Format::Decimals(decimals)
        } else {
            let digits = (largest.log10() + 1e-9).floor() - (step.log10() + 1e-9).floor();
            Format::Exponent(digits.clamp(0.0, 15.0) as usize)
        };
        Self {
            bold,
            light: Vec::new(),
            format,
            powers: false,
        }
    }

    fn log(low: f64, high: f64, most: usize) -> Self {
        if high - low < 1.0 {
            // Less than a decade: round numbers as on a linear axis, at their logarithms.
            let linear = Self::linear(10f64.powf(low), 10f64.powf(high), most);
            return Self {
                bold: linear.bold.iter().map(|x| x.log10()).collect(),
                powers: true,
                ..linear
            };
        }
        let every = ((high - low) / most as f64).ceil().max(1.0);
        let decades = |every: f64| {
            let first = (low / every - 1e-9).ceil() * every;
            (0..1000)
                .map(move |i| first + f64::from(i) * every)
                .take_while(move |d| *d <= high + 1e-9)
        };
        let light = if every == 1.0 {
            (0..1000)
                .map(|i| low.floor() + f64::from(i))
                .take_while(|d| *d <= high)
                .flat_map(|d| (2..10).map(move |k| d + f64::from(k).log10()))
                .filter(|x| (low..=high).contains(x))
                .collect()
        } else {
            decades(1.0).collect()
        };
        Self {
            bold: decades(every).collect(),
            light,
            format: Format::Power,
            powers: false,
        }
    }

    /// How the number at `x` is written.
    pub fn label(&self, x: f64) -> String {
        let x = if self.powers { 10f64.powf(x) } else { x };
        let text = match self.format {
            Format::Decimals(n) => format!("{x:.n$}"),
            Format::Exponent(_) if x == 0.0 => "0".to_owned(),
            Format::Exponent(n) => {
                let text = format!("{x:.n$e}");
                let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
                return format!("{}·10{}", minus(mantissa), superscript(exponent));
            }
            Format::Power => return format!("10{}", superscript(&format!("{}", x.round()))),
        };
        // There is no negative zero on an axis.
        if text.bytes().all(|b| matches!(b, b'-' | b'0' | b'.')) {
            text.replace('-', "")
        } else {
            minus(&text)
        }
    }
}

/// The smallest of 1, 2, 5 times a power of ten that divides `span` at most `most` times.
fn nice_step(span: f64, most: usize) -> f64 {
    let rough = span / most.max(1) as f64;
    let power = 10f64.powf(rough.log10().floor());
    [1.0, 2.0, 5.0]
        .into_iter()
        .map(|k| k * power)
        .find(|step| *step >= rough * (1.0 - 1e-9))
        .unwrap_or(10.0 * power)
}

fn minus(text: &str) -> String {
    text.replace('-', "−")
}

fn superscript(number: &str) -> String {
    number
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            '0' => '⁰',
            '4'..='9' => char::from_u32('⁴' as u32 + (c as u32 - '4' as u32)).unwrap_or(c),
            other => other,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn labels(scale: Scale, low: f64, high: f64, most: usize) -> Vec<String> {
        let ticks = Ticks::new(scale, low, high, most);
        ticks.bold.iter().map(|x| ticks.label(*x)).collect()
    }

    #[test]
    fn linear_numbers_are_round() {
        assert_eq!(labels(Scale::Linear, 0.0, 5.0, 6), ["0", "1", "2", "3", "4", "5"]);
        assert_eq!(
            labels(Scale::Linear, -0.11, 0.09, 4),
            ["−0.10", "−0.05", "0.00", "0.05"]
        );
        assert_eq!(labels(Scale::Linear, -30.0, 30.0, 3), ["−20", "0", "20"]);
        assert_eq!(labels(Scale::Linear, 0.0, 3e-7, 3), ["0", "1·10⁻⁷", "2·10⁻⁷", "3·10⁻⁷"]);
        assert_eq!(labels(Scale::Linear, 0.0, 2e6, 2), ["0", "1·10⁶", "2·10⁶"]);
        assert_eq!(labels(Scale::Linear, 100.000_01, 100.000_05, 5)[0], "100.00001");
    }

    #[test]
    fn logarithmic_numbers_are_decades() {
        assert_eq!(labels(Scale::Log, -3.2, 1.0, 6), ["10⁻³", "10⁻²", "10⁻¹", "10⁰", "10¹"]);
        assert_eq!(
            labels(Scale::Log, -12.0, 0.0, 4),
            ["10⁻¹²", "10⁻⁹", "10⁻⁶", "10⁻³", "10⁰"]
        );
        assert_eq!(labels(Scale::Log, 0.0, 0.5, 4), ["1", "2", "3"]);
    }

    proptest! {
        #[test]
        fn linear_numbers_are_few_inside_and_distinct(low in -1e9..1e9f64, span in 1e-3..1e9f64, most in 2usize..12) {
            let high = low + span;
            let ticks = Ticks::new(Scale::Linear, low, high, most);
            prop_assert!(ticks.bold.len() <= most + 1);
            prop_assert!(ticks.bold.iter().all(|x| *x >= low - 1e-6 * span && *x <= high + 1e-6 * span));
            let mut labels: Vec<String> = ticks.bold.iter().map(|x| ticks.label(*x)).collect();
            let count = labels.len();
            labels.dedup();
            prop_assert_eq!(labels.len(), count);
        }
    }
}
