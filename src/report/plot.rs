//! Panels of plots: points of several kinds over one axis.

use crate::film::grouped;
use plotters::coord::Shift;
use plotters::coord::combinators::{LogCoord, WithKeyPoints};
use plotters::coord::ranged1d::ValueFormatter;
use plotters::prelude::*;
use std::ops::Range;

/// Points of one kind, joined by a line.
pub struct Series {
    /// In the legend.
    pub name: String,
    /// Of marks and line.
    pub colour: RGBColor,
    /// How they are joined.
    pub stroke: Stroke,
    /// What is 0 cannot be shown on a logarithmic axis.
    pub points: Vec<(f64, f64)>,
}

/// How points are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    /// With a mark at each.
    Solid,
    /// Not at all: a mark at each, of this shape.
    Marks(Mark),
    /// Dotted, with hollow marks.
    Dotted,
    /// Dashed, without marks.
    Dashed,
    /// A step down at each, in a ring: the border of what is beaten in both coordinates.
    Steps,
    /// Dashed from side to side at the height of each.
    Level,
}

/// The shape of a mark: colours alone do not reach everyone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// Filled.
    Disc,
    /// Filled, pointing up.
    Triangle,
    /// Two strokes.
    Cross,
}

/// How values are spread.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axes {
    /// Both from 0.
    Linear,
    /// Both by powers of ten.
    Logarithmic,
}

/// Where the legend is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Corner {
    /// Of curves that fall.
    UpperRight,
    /// Of curves that rise.
    UpperLeft,
}

/// One plot.
pub struct Panel {
    /// Above it.
    pub title: String,
    /// Below it.
    pub x: String,
    /// Beside it; may be empty.
    pub y: String,
    /// How values are spread.
    pub axes: Axes,
    /// Where the legend is.
    pub legend: Corner,
    /// What it shows.
    pub series: Vec<Series>,
}

/// Whether something could be drawn.
pub type Drawn = std::result::Result<(), DrawingAreaErrorKind<std::io::Error>>;

impl Panel {
    /// Draws it over a range of its x axis.
    ///
    /// # Errors
    /// Those of the backend.
    pub fn draw(&self, area: &DrawingArea<SVGBackend, Shift>, x: Range<f64>) -> Drawn {
        let values = || self.series.iter().flat_map(|series| &series.points).map(|&(_, y)| y);
        let (low, high) = (values().fold(f64::MAX, f64::min), values().fold(0.0, f64::max));
        let mut builder = ChartBuilder::on(area);
        builder
            .caption(&self.title, ("sans-serif", 17))
            .margin(8)
            .x_label_area_size(36)
            .y_label_area_size(58);
        // Room above for the legend, on logarithmic axes in proportion to the decades shown.
        match self.axes {
            Axes::Linear => {
                let high = if high > 0.0 { high } else { 1.0 };
                let chart = builder.build_cartesian_2d(0.0..x.end, 0.0..high * 1.35)?;
                self.fill(chart, 0.0..x.end)
            }
            Axes::Logarithmic => {
                let y = if low > high { 0.1..10.0 } else { low / 1.5..high * 1.5 * (high / low).powf(0.35) };
                let chart = builder.build_cartesian_2d(by_decades(x.clone()), by_decades(y))?;
                self.fill(chart, x)
            }
        }
    }

    fn fill<'a, X, Y>(
        &self,
        mut chart: ChartContext<'a, SVGBackend<'a>, Cartesian2d<X, Y>>,
        x: Range<f64>,
    ) -> Drawn
    where
        X: Ranged<ValueType = f64> + ValueFormatter<f64>,
        Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
    {
        chart
            .configure_mesh()
            .x_desc(&self.x)
            .y_desc(&self.y)
            .x_label_formatter(&|x| label(*x))
            .y_label_formatter(&|y| label(*y))
            .max_light_lines(3)
            .light_line_style(RGBColor(238, 238, 238))
            .bold_line_style(RGBColor(214, 214, 214))
            .label_style(("sans-serif", 14))
            .draw()?;
        for series in &self.series {
            let colour = series.colour;
            let drawn = match series.stroke {
                Stroke::Solid => {
                    let marks = series.points.iter().map(|&point| Circle::new(point, 3, colour.filled()));
                    chart.draw_series(marks)?;
                    chart.draw_series(LineSeries::new(series.points.clone(), colour.stroke_width(2)))?
                }
                Stroke::Marks(mark) => {
                    let at = || series.points.iter().copied();
                    match mark {
                        Mark::Disc => {
                            chart.draw_series(at().map(|p| Circle::new(p, 4, colour.mix(0.65).filled())))?
                        }
                        Mark::Triangle => chart.draw_series(
                            at().map(|p| TriangleMarker::new(p, 6, colour.mix(0.65).filled())),
                        )?,
                        Mark::Cross => {
                            chart.draw_series(at().map(|p| Cross::new(p, 4, colour.stroke_width(2))))?
                        }
                    }
                }
                Stroke::Steps => {
                    let corners = series.points.windows(2).flat_map(|pair| [pair[0], (pair[1].0, pair[0].1)]);
                    let steps: Vec<_> = corners.chain(series.points.last().copied()).collect();
                    let rings = series.points.iter().map(|&p| Circle::new(p, 8, colour.stroke_width(2)));
                    chart.draw_series(rings)?;
                    chart.draw_series(LineSeries::new(steps, colour.stroke_width(2)))?
                }
                Stroke::Dotted => {
                    let marks = series.points.iter().map(|&point| TriangleMarker::new(point, 5, colour));
                    chart.draw_series(marks)?;
                    let thin = colour.mix(0.7).stroke_width(1);
                    chart.draw_series(DashedLineSeries::new(series.points.clone(), 3, 4, thin))?
                }
                Stroke::Dashed => {
                    let line = DashedLineSeries::new(series.points.clone(), 8, 5, colour.stroke_width(1));
                    chart.draw_series(line)?
                }
                Stroke::Level => {
                    let ends: Vec<_> =
                        series.points.iter().flat_map(|&(_, y)| [(x.start, y), (x.end, y)]).collect();
                    chart.draw_series(DashedLineSeries::new(ends, 8, 5, colour.stroke_width(1)))?
                }
            };
            let stroke = series.stroke;
            drawn.label(&series.name).legend(move |at| key(stroke, colour, at));
        }
        let position = match self.legend {
            Corner::UpperRight => SeriesLabelPosition::UpperRight,
            Corner::UpperLeft => SeriesLabelPosition::UpperLeft,
        };
        chart
            .configure_series_labels()
            .position(position)
            .background_style(WHITE.mix(0.85))
            .label_font(("sans-serif", 14))
            .draw()
    }
}

/// What stands for a series in the legend.
fn key<DB: DrawingBackend>(stroke: Stroke, colour: RGBColor, (x, y): (i32, i32)) -> Key<DB> {
    let line =
        |length: i32, width: u32| PathElement::new([(x, y), (x + length, y)], colour.stroke_width(width));
    let middle = (x + 9, y);
    match stroke {
        Stroke::Marks(Mark::Disc) => Circle::new(middle, 4, colour.mix(0.65).filled()).into_dyn(),
        Stroke::Marks(Mark::Triangle) => TriangleMarker::new(middle, 6, colour.mix(0.65).filled()).into_dyn(),
        Stroke::Marks(Mark::Cross) => Cross::new(middle, 4, colour.stroke_width(2)).into_dyn(),
        Stroke::Solid => line(18, 3).into_dyn(),
        Stroke::Steps => line(18, 2).into_dyn(),
        Stroke::Dotted => line(10, 1).into_dyn(),
        Stroke::Dashed | Stroke::Level => line(18, 1).into_dyn(),
    }
}

type Key<DB> = plotters::element::DynElement<'static, DB, (i32, i32)>;

/// A number on an axis.
fn label(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    if rounded >= 10_000.0 && rounded.fract() == 0.0 { grouped(rounded as u64) } else { format!("{rounded}") }
}

/// A logarithmic axis whose lines and numbers stand at one, two and five times powers of ten, of many decades at those
/// alone; fine lines stand at the others.
fn by_decades(range: Range<f64>) -> WithKeyPoints<LogCoord<f64>> {
    const FEW_DECADES: f64 = 3.5;
    let decades = libm::log10(range.end / range.start);
    let with_number: &[u32] = if decades < FEW_DECADES { &[1, 2, 5] } else { &[1] };
    let (numbers, others) =
        lines(&range).into_iter().partition::<Vec<_>, _>(|line| with_number.contains(&line.0));
    let places = |lines: Vec<(u32, f64)>| lines.into_iter().map(|line| line.1).collect::<Vec<_>>();
    let axis: LogCoord<f64> = range.log_scale().into();
    axis.with_key_points(places(numbers)).with_light_points(places(others))
}

/// One to nine times powers of ten within a range, with that digit.
fn lines(range: &Range<f64>) -> Vec<(u32, f64)> {
    let power = |value: f64| libm::floor(libm::log10(value)) as i32;
    let line = |exponent: i32, digit: u32| {
        // Divided where that is exact: 0.2 and not 0.2 and a bit.
        let ten = libm::pow(10.0, f64::from(exponent.abs()));
        (digit, if exponent < 0 { f64::from(digit) / ten } else { f64::from(digit) * ten })
    };
    let all =
        (power(range.start)..=power(range.end)).flat_map(|exponent| (1..=9).map(move |d| line(exponent, d)));
    all.filter(|line| range.contains(&line.1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithmic_axes_have_lines_at_one_to_nine_of_each_decade_in_range() {
        let places: Vec<f64> = lines(&(0.25..4.0)).into_iter().map(|line| line.1).collect();
        assert_eq!(places, [0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 2.0, 3.0]);
        assert_eq!(lines(&(14.0..31.0)), [(2, 20.0), (3, 30.0)]);
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!([0.1, 1.0, 5000.0, 20_000.0].map(label), ["0.1", "1", "5000", "20,000"]);
    }
}
