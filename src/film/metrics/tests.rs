//! Against numbers of others: FLIP by NVIDIA's own evaluator (flip-evaluator 1.7, LDR, linear input, 67.02 pixels a degree)
//! and SSIM by scikit-image 0.26 (Gaussian window, deviation 1.5, no sample covariance, range 1), of the same pictures.

use super::*;
use approx::assert_relative_eq;

const SIZE: ImageSize = ImageSize { width: 96, height: 64 };

/// Waves in red and green, a chessboard in blue, each as a function of the pixel.
fn picture(channels: impl Fn(f64, f64) -> [f64; 3]) -> ImagePlanes {
    let mut planes = ImagePlanes::new(SIZE);
    for (k, name) in ["R", "G", "B"].into_iter().enumerate() {
        let sample = |at: usize| {
            let (x, y) = (at % SIZE.width as usize, at / SIZE.width as usize);
            channels(x as f64, y as f64)[k] as f32
        };
        planes.add_channel(name, (0..SIZE.pixels()).map(sample).collect()).unwrap();
    }
    planes
}

fn pattern(x: f64, y: f64, phase: f64, shift: f64) -> [f64; 3] {
    let board = (((x + shift) / 8.0).floor() + (y / 8.0).floor()) % 2.0;
    [
        0.5 + 0.5 * libm::sin(0.31 * x + 0.07 * y + phase),
        0.5 + 0.5 * libm::sin(0.05 * x - 0.23 * y + 1.0),
        0.8 * board + 0.1,
    ]
}

fn reference() -> ImagePlanes {
    picture(|x, y| pattern(x, y, 0.0, 0.0))
}

#[test]
fn a_moved_and_darkened_picture_has_the_numbers_that_others_give_it() {
    let test = picture(|x, y| pattern(x, y, 0.2, 1.0).map(|v| 0.95 * v));
    let metrics = ImageMetrics::new(&test, &reference()).unwrap();
    assert_relative_eq!(metrics.mse, 0.027_875_078, max_relative = 1e-5);
    assert_relative_eq!(metrics.mrse, 1.063_625_27, max_relative = 1e-5);
    assert_relative_eq!(metrics.psnr.unwrap(), 15.547_84, max_relative = 1e-5);
    assert_relative_eq!(metrics.ssim.unwrap(), 0.967_185_92, max_relative = 1e-4);
    assert_relative_eq!(metrics.flip, 0.248_770_34, max_relative = 1e-3);
}

#[test]
fn one_black_pixel_has_them_too() {
    let test = picture(|x, y| if (x, y) == (40.0, 30.0) { [0.0; 3] } else { pattern(x, y, 0.0, 0.0) });
    let metrics = ImageMetrics::new(&test, &reference()).unwrap();
    assert_relative_eq!(metrics.mse, 8.995_732e-5, max_relative = 1e-5);
    assert_relative_eq!(metrics.mrse, 1.509_767_9e-4, max_relative = 1e-5);
    assert_relative_eq!(metrics.ssim.unwrap(), 0.992_412_91, max_relative = 1e-4);
    assert_relative_eq!(metrics.flip, 0.001_232_154_8, max_relative = 2e-3);
}

#[test]
fn equal_pictures_are_the_same_by_every_measure() {
    let same = ImageMetrics::new(&reference(), &reference()).unwrap();
    assert_eq!((same.mse, same.mrse, same.psnr, same.flip), (0.0, 0.0, None, 0.0));
    assert_relative_eq!(same.ssim.unwrap(), 1.0, epsilon = 1e-9);
    assert_eq!(ImageMetrics { ssim: Some(1.0), ..same }, ImageMetrics::SAME);
}

#[test]
fn green_against_blue_is_the_most_that_flip_can_be() {
    let even = |colour: [f64; 3]| picture(move |_, _| colour);
    let most = ImageMetrics::new(&even([0.0, 1.0, 0.0]), &even([0.0, 0.0, 1.0])).unwrap();
    assert_relative_eq!(most.flip, 1.0, epsilon = 1e-4);
    // Of what a screen cannot show SSIM and FLIP know nothing; squared errors do.
    let bright = ImageMetrics::new(&even([3.0; 3]), &even([2.0; 3])).unwrap();
    assert_eq!((bright.mse, bright.flip), (1.0, 0.0));
    assert_relative_eq!(bright.mrse, 1.0 / (2.01 * 2.01), epsilon = 1e-6);
    assert_eq!(bright.psnr, Some(-0.0));
}

#[test]
fn what_has_no_metrics_is_refused() {
    let mut small = ImagePlanes::new(ImageSize { width: 8, height: 20 });
    assert!(ImageMetrics::new(&small, &small).unwrap_err().to_string().contains("`R`"));
    for name in ["R", "G", "B"] {
        small.add_channel(name, vec![0.5; 160]).unwrap();
    }
    assert_eq!(ImageMetrics::new(&small, &small).unwrap().ssim, None);
    assert!(ImageMetrics::new(&small, &reference()).unwrap_err().to_string().contains("different sizes"));
    let broken = picture(|x, _| if x == 5.0 { [f64::NAN; 3] } else { [0.0; 3] });
    assert!(ImageMetrics::new(&broken, &reference()).unwrap_err().to_string().contains("not finite"));
}
