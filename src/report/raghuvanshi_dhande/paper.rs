//! What the t-buffer paper (Raghuvanshi and Dhande 2004) says in words about its figures. Its curves are drawn and
//! not printed as numbers, so nothing is read from them.

/// The figures that are reproduced, each with what it shows.
pub const FIGURES: [(u32, &str); 10] = [
    (9, "Shadows alone: textures, reflections and shadow-buffer off"),
    (10, "Shadows and reflections: textures and shadow-buffer off"),
    (11, "Everything on, shadow-buffer among it"),
    (12, "The procedural scene: objects of a kind that fill the viewport"),
    (13, "Running times of the classical tracer and of the t-buffer, shadow-buffer off"),
    (14, "The gain of the t-buffer, shadow-buffer off"),
    (15, "The gain of the t-buffer with a shadow-buffer of 400 x 800"),
    (16, "The gain with a shadow-buffer of 1000 x 2000"),
    (17, "Running time against the resolution of the shadow-buffer"),
    (18, "Shadow-buffers of rising resolution, after pure ray tracing"),
];

/// Objects in the pictures of figure 12.
pub const PICTURED_OBJECTS: [u32; 3] = [3, 50, 100];

/// The range of figures 13 to 16 is 10 to 6000 objects; which of them were measured is not said.
pub const OBJECTS: [u32; 12] = [10, 20, 50, 100, 200, 500, 1000, 2000, 3000, 4000, 5000, 6000];

/// The gain of figure 14 "saturates somewhere close to" this.
pub const SATURATED_GAIN: f64 = 2.2;

/// And does so when the number of objects "approaches" this.
pub const SATURATED_AT: u32 = 5000;

/// Rows of the shadow-buffer of figure 15, with twice as many columns.
pub const COARSE_ROWS: u32 = 400;

/// Rows of that of figure 16.
pub const FINE_ROWS: u32 = 1000;

/// Objects of figure 17.
pub const OBJECTS_OF_17: u32 = 500;

/// Rows of figure 17: ten steps of its range.
pub const ROWS_OF_17: [u32; 10] = [200, 400, 600, 800, 1000, 1200, 1400, 1600, 1800, 2000];

/// The correlation of the quadratic curve of figure 17 with the times.
pub const CORRELATION: f64 = 0.9996;

/// Rows of figure 18.
pub const ROWS_OF_18: [u32; 5] = [400, 800, 1200, 1600, 2000];

/// Where the quality of figure 18 saturates.
pub const SATURATED_ROWS: u32 = 1200;

/// What a figure shows.
pub fn title(figure: u32) -> &'static str {
    FIGURES.iter().find(|(number, _)| *number == figure).map_or("", |(_, title)| title)
}
