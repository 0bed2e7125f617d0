//! What the 1986 paper printed: figures 5 to 11, the tables mended where the print is damaged.
//!
//! Times are minutes of a VAX 11/780, images 512 x 480 but for the kitchen's 436 x 479.

/// The resolutions of the paper's light buffers.
pub const RESOLUTIONS: [u32; 4] = [10, 20, 50, 100];

/// A row of a table: the control, then light buffers of [`RESOLUTIONS`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// The control's, if it has one.
    pub control: Option<f64>,
    /// The light buffers'.
    pub buffers: [f64; 4],
    /// Which of the light buffers' are a best reading of damaged print, a bit each.
    pub best_readings: u8,
}

/// A figure as printed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Printed {
    /// Its value.
    pub value: f64,
    /// Whether it is a best reading of damaged print.
    pub best_reading: bool,
}

/// The table and caption of one environment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Table {
    /// The figure of the paper.
    pub figure: u32,
    /// The built-in scene.
    pub name: &'static str,
    /// Its title.
    pub title: &'static str,
    /// Objects, polygons, spheres, cylinders, quadrics, lights.
    pub counts: [u32; 6],
    /// Intersections a ray from the eye.
    pub average_tree_size: f64,
    /// Minutes.
    pub tree_generation: f64,
    /// Minutes; not known where the print gives it together with the next.
    pub colour: Option<f64>,
    /// Minutes.
    pub miscellaneous: Option<f64>,
    /// Minutes of the two together.
    pub colour_and_miscellaneous: f64,
    /// Minutes.
    pub shadow_testing: Row,
    /// Minutes.
    pub preprocess: Row,
    /// Minutes.
    pub total: Row,
    /// Shadow tests per light ray.
    pub tests_per_ray: Row,
    /// Total number of list items.
    pub items: Row,
    /// List items per square.
    pub items_per_square: Row,
    /// Per cent of squares with a list.
    pub non_empty: Row,
    /// Average maximum of list items.
    pub average_maximum: Row,
}

const fn row(control: f64, buffers: [f64; 4]) -> Row {
    Row { control: Some(control), buffers, best_readings: 0 }
}

const fn buffers(buffers: [f64; 4]) -> Row {
    Row { control: None, buffers, best_readings: 0 }
}

/// The row with a cell whose print is damaged.
const fn damaged(row: Row, column: usize) -> Row {
    Row { best_readings: row.best_readings | 1 << column, ..row }
}

const COUNTER_TOP_ITEMS: Row = damaged(buffers([8075.0, 16548.0, 50499.0, 102063.0]), 2);
const COUNTER_TOP_PER_SQUARE: Row = buffers([2.69, 1.38, 0.67, 0.34]);
const COUNTER_TOP_NON_EMPTY: Row = buffers([44.9, 42.6, 39.5, 38.0]);
const COUNTER_TOP_MAXIMUM: Row = buffers([79.0, 56.0, 43.0, 37.0]);

/// All tables, in the paper's order.
#[expect(clippy::approx_constant, reason = "what is printed happens to be near pi")]
pub const TABLES: [Table; 7] = [
    Table {
        figure: 5,
        name: "chessboard",
        title: "Chessboard",
        counts: [132, 4944, 0, 0, 0, 4],
        average_tree_size: 1.02,
        tree_generation: 32.0,
        colour: Some(30.0),
        miscellaneous: Some(16.0),
        colour_and_miscellaneous: 46.0,
        shadow_testing: row(216.0, [125.0, 75.0, 45.0, 41.0]),
        preprocess: buffers([4.0, 6.0, 35.0, 109.0]),
        total: row(294.0, [207.0, 159.0, 158.0, 228.0]),
        tests_per_ray: row(99.0, [20.9, 8.9, 2.9, 1.5]),
        items: buffers([10613.0, 14608.0, 27857.0, 50768.0]),
        items_per_square: buffers([4.42, 1.52, 0.46, 0.21]),
        non_empty: buffers([11.8, 8.7, 6.9, 5.5]),
        average_maximum: buffers([512.0, 282.0, 145.0, 83.0]),
    },
    Table {
        figure: 6,
        name: "house-of-cards",
        title: "House of Cards",
        counts: [41, 3286, 0, 0, 0, 5],
        average_tree_size: 1.38,
        tree_generation: 62.0,
        colour: None,
        miscellaneous: None,
        colour_and_miscellaneous: 76.0,
        shadow_testing: row(466.0, [160.0, 112.0, 69.0, 58.0]),
        preprocess: buffers([3.0, 5.0, 17.0, 40.0]),
        total: row(604.0, [301.0, 255.0, 224.0, 236.0]),
        tests_per_ray: row(392.0, [7.0, 2.5, 0.6, 0.3]),
        items: buffers([9443.0, 11158.0, 17134.0, 30730.0]),
        items_per_square: buffers([3.14, 0.93, 0.23, 0.10]),
        non_empty: buffers([5.9, 4.6, 3.6, 3.4]),
        average_maximum: buffers([234.0, 130.0, 81.0, 59.0]),
    },
    Table {
        figure: 7,
        name: "highchair",
        title: "Sarah's Highchair",
        counts: [33, 6702, 0, 2, 8, 3],
        average_tree_size: 1.26,
        tree_generation: 215.0,
        colour: Some(25.0),
        miscellaneous: Some(16.0),
        colour_and_miscellaneous: 41.0,
        shadow_testing: damaged(row(950.0, [90.0, 60.0, 34.0, 30.0]), 0),
        preprocess: buffers([5.0, 10.0, 26.0, 89.0]),
        total: damaged(row(1206.0, [351.0, 326.0, 316.0, 375.0]), 0),
        tests_per_ray: row(1270.0, [17.2, 8.3, 2.6, 1.2]),
        items: buffers([12897.0, 15721.0, 25492.0, 48484.0]),
        items_per_square: buffers([7.17, 2.18, 0.57, 0.27]),
        non_empty: buffers([8.2, 6.3, 5.5, 5.2]),
        average_maximum: buffers([638.0, 385.0, 219.0, 128.0]),
    },
    Table {
        figure: 8,
        name: "gazebo",
        title: "Gazebo at Night",
        counts: [80, 3222, 0, 0, 0, 8],
        average_tree_size: 1.03,
        tree_generation: 52.0,
        colour: Some(45.0),
        miscellaneous: Some(14.0),
        colour_and_miscellaneous: 59.0,
        shadow_testing: row(888.0, [237.0, 172.0, 100.0, 61.0]),
        preprocess: buffers([5.0, 14.0, 39.0, 93.0]),
        total: row(999.0, [353.0, 297.0, 250.0, 265.0]),
        tests_per_ray: row(182.0, [19.0, 11.6, 4.9, 1.3]),
        items: buffers([20526.0, 29544.0, 61485.0, 130_778.0]),
        items_per_square: buffers([4.27, 1.54, 0.51, 0.27]),
        non_empty: buffers([7.0, 6.0, 5.1, 4.8]),
        average_maximum: buffers([391.0, 242.0, 98.0, 57.0]),
    },
    Table {
        figure: 9,
        name: "glass-leaved-tree",
        title: "Glass-Leaved Tree",
        counts: [768, 6, 256, 0, 511, 3],
        average_tree_size: 2.02,
        tree_generation: 281.0,
        colour: Some(39.0),
        miscellaneous: Some(16.0),
        colour_and_miscellaneous: 55.0,
        shadow_testing: row(975.0, [149.0, 91.0, 70.0, 68.0]),
        preprocess: buffers([1.0, 2.0, 6.0, 34.0]),
        total: row(1311.0, [486.0, 429.0, 412.0, 438.0]),
        tests_per_ray: row(427.0, [185.0, 162.0, 153.0, 145.0]),
        items: buffers([3912.0, 5886.0, 14208.0, 35595.0]),
        items_per_square: buffers([2.17, 0.82, 0.32, 0.20]),
        non_empty: buffers([5.4, 4.4, 3.8, 3.4]),
        average_maximum: buffers([113.0, 68.0, 33.0, 20.0]),
    },
    Table {
        figure: 10,
        name: "counter-top",
        title: "Counter-top",
        counts: [224, 1298, 4, 76, 35, 5],
        average_tree_size: 1.69,
        tree_generation: 124.0,
        colour: Some(51.0),
        miscellaneous: Some(15.0),
        colour_and_miscellaneous: 66.0,
        shadow_testing: row(503.0, [131.0, 96.0, 70.0, 58.0]),
        preprocess: buffers([4.0, 11.0, 33.0, 88.0]),
        total: row(693.0, [325.0, 297.0, 293.0, 336.0]),
        tests_per_ray: row(62.0, [25.4, 23.9, 22.7, 21.7]),
        items: COUNTER_TOP_ITEMS,
        items_per_square: COUNTER_TOP_PER_SQUARE,
        non_empty: COUNTER_TOP_NON_EMPTY,
        average_maximum: COUNTER_TOP_MAXIMUM,
    },
    Table {
        figure: 11,
        name: "kitchen",
        title: "Kitchen",
        counts: [224, 1298, 4, 76, 35, 5],
        average_tree_size: 1.25,
        tree_generation: 86.0,
        colour: Some(44.0),
        miscellaneous: Some(16.0),
        colour_and_miscellaneous: 60.0,
        shadow_testing: row(456.0, [123.0, 94.0, 67.0, 54.0]),
        preprocess: buffers([0.0; 4]),
        total: row(602.0, [269.0, 240.0, 213.0, 200.0]),
        tests_per_ray: buffers([27.2, 11.8, 4.2, 1.5]),
        items: COUNTER_TOP_ITEMS,
        items_per_square: COUNTER_TOP_PER_SQUARE,
        non_empty: COUNTER_TOP_NON_EMPTY,
        average_maximum: COUNTER_TOP_MAXIMUM,
    },
];

impl Row {
    /// The light buffer's of one of [`RESOLUTIONS`]; without a resolution the control's.
    pub fn at(&self, resolution: Option<u32>) -> Option<Printed> {
        let Some(resolution) = resolution else {
            return self.control.map(|value| Printed { value, best_reading: false });
        };
        let column = RESOLUTIONS.iter().position(|&r| r == resolution)?;
        Some(Printed { value: self.buffers[column], best_reading: self.best_readings >> column & 1 == 1 })
    }
}

impl Table {
    /// The table of a built-in scene.
    pub fn of(name: &str) -> Option<&'static Table> {
        TABLES.iter().find(|table| table.name == name)
    }

    /// How many times fewer shadow tests a ray needs with the finest buffer than with the control.
    pub fn fall_from_control(&self) -> Option<f64> {
        Some(self.tests_per_ray.control? / self.tests_per_ray.buffers[3])
    }

    /// The same from the coarsest buffer to the finest.
    pub fn fall_from_coarsest(&self) -> f64 {
        self.tests_per_ray.buffers[0] / self.tests_per_ray.buffers[3]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_follow_from_items_per_square() {
        // Some are rounded there, some cut off, such as 9443 / 3000 = 3.147 to 3.14.
        for table in TABLES {
            let lights = f64::from(table.counts[5]);
            for (column, resolution) in RESOLUTIONS.into_iter().enumerate() {
                let squares = 6.0 * f64::from(resolution).powi(2) * lights;
                let (items, each) = (table.items.buffers[column], table.items_per_square.buffers[column]);
                assert!((items - each * squares).abs() < 0.01 * squares, "{} {resolution}", table.name);
            }
        }
    }

    #[test]
    fn totals_are_the_sums_of_their_parts() {
        for table in TABLES {
            let others = table.tree_generation + table.colour_and_miscellaneous;
            assert_eq!(table.total.control.unwrap(), table.shadow_testing.control.unwrap() + others);
            for column in 0..4 {
                let sum = table.shadow_testing.buffers[column] + table.preprocess.buffers[column] + others;
                assert_eq!(table.total.buffers[column], sum, "{} column {column}", table.name);
            }
            if let (Some(colour), Some(miscellaneous)) = (table.colour, table.miscellaneous) {
                assert_eq!(colour + miscellaneous, table.colour_and_miscellaneous);
            }
        }
    }

    #[test]
    fn everything_falls_with_the_resolution() {
        for table in TABLES {
            for row in [table.tests_per_ray, table.items_per_square, table.non_empty, table.average_maximum] {
                assert!(row.buffers.is_sorted_by(|a, b| a > b), "{}", table.name);
            }
            assert!(table.items.buffers.is_sorted());
        }
    }

    #[test]
    fn cells_are_found_by_their_resolution() {
        let highchair = Table::of("highchair").unwrap();
        let printed = |resolution| highchair.shadow_testing.at(resolution);
        assert_eq!(printed(None), Some(Printed { value: 950.0, best_reading: false }));
        assert_eq!(printed(Some(10)), Some(Printed { value: 90.0, best_reading: true }));
        assert_eq!(printed(Some(20)), Some(Printed { value: 60.0, best_reading: false }));
        assert_eq!(printed(Some(200)), None);
        assert!(Table::of("kitchen").unwrap().fall_from_control().is_none());
    }
}
