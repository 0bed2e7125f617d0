//! FLIP of low dynamic range: what an eye notices that flips between two pictures (Andersson, Nilsson, Akenine-Möller,
//! Oskarsson, Åström and Fairchild, FLIP: A Difference Evaluator for Alternating Images, HPG 2020).
//!
//! Section numbers are those of the paper.

use super::Picture;
use super::colour::{hunt_lab, opponent, shown_of_opponent};
use super::filter::Kernel;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Pixels a degree of the field of view: a screen 0.7 m wide, of 3840 pixels, seen from 0.7 m.
const PIXELS_A_DEGREE: f64 = 0.7 * 3840.0 / 0.7 * PI / 180.0;

/// Exponents of colour and of feature differences.
const COLOUR_EXPONENT: f64 = 0.7;
const FEATURE_EXPONENT: f64 = 0.5;

/// Where large colour differences begin, as a share of the largest, and what becomes of the smaller ones.
const LARGE: [f64; 2] = [0.4, 0.95];

/// Width of the feature detectors in degrees.
const FEATURE_WIDTH: f64 = 0.082;

/// A Gaussian of a contrast sensitivity function: its weight and its width.
type Sensitivity = (f64, f64);

/// Of achromatic, red-green and blue-yellow contrast (4.1.1); the last is a sum of two.
const SENSITIVITIES: [&[Sensitivity]; 3] =
    [&[(1.0, 0.0047)], &[(1.0, 0.0053)], &[(34.1, 0.04), (13.5, 0.025)]];

/// The mean over all pixels.
pub(super) fn mean_flip(test: &Picture, reference: &Picture) -> f64 {
    let width = test.width();
    let seen = [test, reference].map(Seen::new);
    let (colours, features) = (colour_scale(), std::f64::consts::SQRT_2);
    let row = |y: usize| -> f64 {
        let value = |at: usize| {
            let [test, reference] = [&seen[0], &seen[1]];
            let colour = colours.difference(test.lab[at], reference.lab[at]);
            let edge = (test.edges[at] - reference.edges[at]).abs();
            let point = (test.points[at] - reference.points[at]).abs();
            let feature = libm::pow(f64::from(edge.max(point)) / features, FEATURE_EXPONENT).min(1.0);
            // 4.3: a difference of features makes that of colours larger.
            libm::pow(colour, 1.0 - feature)
        };
        (y * width..(y + 1) * width).map(value).sum()
    };
    let rows: Vec<f64> = (0..test.size.height as usize).into_par_iter().map(row).collect();
    rows.iter().sum::<f64>() / test.size.pixels() as f64
}

/// What an eye makes of a picture.
struct Seen {
    /// Filtered colours in Hunt-adjusted CIELAB.
    lab: Vec<[f64; 3]>,
    /// Lengths of the gradient of edges and of points.
    edges: Vec<f32>,
    points: Vec<f32>,
}

impl Seen {
    fn new(picture: &Picture) -> Seen {
        let width = picture.width();
        let opponents: Vec<[f32; 3]> =
            (0..picture.size.pixels()).into_par_iter().map(|at| opponent(picture.shown(at))).collect();
        let plane = |k: usize| opponents.iter().map(|colour| colour[k]).collect::<Vec<f32>>();
        let [y, cx, cz] = [0, 1, 2].map(|k| filtered(&plane(k), width, SENSITIVITIES[k]));
        let lab = (0..y.len()).into_par_iter().map(|at| hunt_lab(shown_of_opponent([y[at], cx[at], cz[at]])));
        let lab = lab.collect();
        // 4.2: features are those of lightness alone, and not filtered.
        let grey: Vec<f32> = opponents.iter().map(|colour| (colour[0] + 16.0) / 116.0).collect();
        Seen { lab, edges: gradient(&grey, width, edge_weight), points: gradient(&grey, width, point_weight) }
    }
}

/// By the sum of Gaussians of a contrast sensitivity function.
fn filtered(plane: &[f32], width: usize, sensitivity: &[Sensitivity]) -> Vec<f32> {
    // All channels are filtered as far as the widest of them reaches.
    let widest = SENSITIVITIES.iter().flat_map(|s| s.iter()).map(|s| s.1).fold(0.0, f64::max);
    let radius = (3.0 * (widest / (2.0 * PI * PI)).sqrt() * PIXELS_A_DEGREE).ceil();
    let gaussian = |b: f64| {
        move |distance: f64| {
            libm::exp(-PI * PI * (distance / PIXELS_A_DEGREE) * (distance / PIXELS_A_DEGREE) / b)
        }
    };
    // The sum of Gaussians is normalised as a whole, so each has the share of its own sum.
    let share = |&(a, b): &Sensitivity| {
        let sum: f64 = (-radius as i64..=radius as i64).map(|i| gaussian(b)(i as f64)).sum();
        a * (PI / b).sqrt() * sum * sum
    };
    let whole: f64 = sensitivity.iter().map(share).sum();
    let mut out = vec![0.0; plane.len()];
    for one in sensitivity {
        let kernel = Kernel::of(radius as usize, gaussian(one.1)).normalised();
        let part = kernel.along_columns(&kernel.along_rows(plane, width), width);
        let share = (share(one) / whole) as f32;
        out.iter_mut().zip(part).for_each(|(out, part)| *out += share * part);
    }
    out
}

/// Standard deviation of the feature detectors in pixels.
fn feature_deviation() -> f64 {
    0.5 * FEATURE_WIDTH * PIXELS_A_DEGREE
}

fn gaussian(x: f64) -> f64 {
    let deviation = feature_deviation();
    libm::exp(-x * x / (2.0 * deviation * deviation))
}

/// The first derivative of a Gaussian.
fn edge_weight(x: f64) -> f64 {
    -x * gaussian(x)
}

/// The second.
fn point_weight(x: f64) -> f64 {
    let deviation = feature_deviation();
    (x * x / (deviation * deviation) - 1.0) * gaussian(x)
}

/// Lengths of what a detector and its transpose find.
fn gradient(plane: &[f32], width: usize, weight: fn(f64) -> f64) -> Vec<f32> {
    let radius = (3.0 * feature_deviation()).ceil() as usize;
    let across = Kernel::of(radius, gaussian).normalised();
    let along = Kernel::of(radius, weight).balanced();
    let x = across.along_columns(&along.along_rows(plane, width), width);
    let y = along.along_columns(&across.along_rows(plane, width), width);
    x.into_iter().zip(y).map(|(x, y)| x.hypot(y)).collect()
}

/// How colour differences are spread over [0, 1] (4.1.4).
struct ColourScale {
    largest: f64,
}

/// By the largest difference that a screen can show in this measure: green against blue.
fn colour_scale() -> ColourScale {
    let [green, blue] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(hunt_lab);
    ColourScale { largest: libm::pow(hyab(green, blue), COLOUR_EXPONENT) }
}

/// City-block distance of lightness and Euclidean one of chroma.
fn hyab(one: [f64; 3], other: [f64; 3]) -> f64 {
    let [l, a, b] = [0, 1, 2].map(|k| one[k] - other[k]);
    l.abs() + (a * a + b * b).sqrt()
}

impl ColourScale {
    fn difference(&self, one: [f64; 3], other: [f64; 3]) -> f64 {
        let [share, kept] = LARGE;
        let difference = libm::pow(hyab(one, other), COLOUR_EXPONENT);
        let limit = share * self.largest;
        match difference < limit {
            true => kept / limit * difference,
            false => kept + (difference - limit) / (self.largest - limit) * (1.0 - kept),
        }
    }
}
