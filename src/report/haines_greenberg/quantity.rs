//! The rows of the paper's tables: what each is called, measured here and printed there.

use super::document::{ColumnReport, Environment};
use super::paper::{Printed, Table};

/// A row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Time to answer all shadow rays.
    ShadowTesting,
    /// Time to build light buffers.
    Preprocess,
    /// Time for first hits and ray trees.
    TreeGeneration,
    /// Time to shade.
    Colour,
    /// Time for all the rest.
    Miscellaneous,
    /// All times together.
    Total,
    /// Surfaces tested a shadow ray.
    TestsPerRay,
    /// Items in all lists of all light buffers.
    Items,
    /// Of these a square.
    ItemsPerSquare,
    /// Squares with a list.
    NonEmpty,
    /// Mean length of the longest list of a light.
    AverageMaximum,
}

impl Quantity {
    /// All rows in the paper's order.
    pub const ALL: [Quantity; 11] = [
        Quantity::ShadowTesting,
        Quantity::Preprocess,
        Quantity::TreeGeneration,
        Quantity::Colour,
        Quantity::Miscellaneous,
        Quantity::Total,
        Quantity::TestsPerRay,
        Quantity::Items,
        Quantity::ItemsPerSquare,
        Quantity::NonEmpty,
        Quantity::AverageMaximum,
    ];

    /// Its name for programs.
    pub fn key(self) -> &'static str {
        match self {
            Quantity::ShadowTesting => "shadow_testing",
            Quantity::Preprocess => "preprocess",
            Quantity::TreeGeneration => "tree_generation",
            Quantity::Colour => "colour",
            Quantity::Miscellaneous => "miscellaneous",
            Quantity::Total => "total",
            Quantity::TestsPerRay => "tests_per_ray",
            Quantity::Items => "items",
            Quantity::ItemsPerSquare => "items_per_square",
            Quantity::NonEmpty => "non_empty_percent",
            Quantity::AverageMaximum => "average_maximum",
        }
    }

    /// Its name for people.
    pub fn label(self) -> &'static str {
        match self {
            Quantity::ShadowTesting => "shadow testing",
            Quantity::Preprocess => "light buffer preprocess",
            Quantity::TreeGeneration => "tree generation",
            Quantity::Colour => "colour calculation",
            Quantity::Miscellaneous => "miscellaneous",
            Quantity::Total => "total time",
            Quantity::TestsPerRay => "shadow tests per ray",
            Quantity::Items => "total list items",
            Quantity::ItemsPerSquare => "list items per square",
            Quantity::NonEmpty => "non-empty squares, %",
            Quantity::AverageMaximum => "average maximum of items",
        }
    }

    /// Whether it is a time: in seconds here, in minutes there.
    pub fn is_time(self) -> bool {
        matches!(
            self,
            Quantity::ShadowTesting
                | Quantity::Preprocess
                | Quantity::TreeGeneration
                | Quantity::Colour
                | Quantity::Miscellaneous
                | Quantity::Total
        )
    }

    /// As measured in a column of an environment.
    pub fn measured(self, environment: &Environment, column: &ColumnReport) -> Option<f64> {
        let lists = column.lists.as_ref();
        match self {
            Quantity::ShadowTesting => Some(column.shadow_testing_seconds),
            Quantity::Preprocess => Some(column.preprocess_seconds),
            Quantity::TreeGeneration => Some(environment.tree_seconds),
            Quantity::Colour => Some(environment.colour_seconds),
            Quantity::Miscellaneous => Some(environment.miscellaneous_seconds),
            Quantity::Total => Some(column.total_seconds),
            Quantity::TestsPerRay => Some(column.tests_per_ray),
            Quantity::Items => lists.map(|lists| lists.items as f64),
            Quantity::ItemsPerSquare => lists.map(|lists| lists.items_per_square),
            Quantity::NonEmpty => lists.map(|lists| lists.non_empty_percent),
            Quantity::AverageMaximum => lists.map(|lists| lists.average_maximum),
        }
    }

    /// As printed for a resolution of the paper, or for its control.
    pub fn printed(self, table: &Table, resolution: Option<u32>) -> Option<Printed> {
        // The rows that no column changes are printed in each.
        let same =
            |value: f64| table.shadow_testing.at(resolution).map(|_| Printed { value, best_reading: false });
        match self {
            Quantity::ShadowTesting => table.shadow_testing.at(resolution),
            Quantity::Preprocess => table.preprocess.at(resolution),
            Quantity::TreeGeneration => same(table.tree_generation),
            Quantity::Colour => same(table.colour?),
            Quantity::Miscellaneous => same(table.miscellaneous?),
            Quantity::Total => table.total.at(resolution),
            Quantity::TestsPerRay => table.tests_per_ray.at(resolution),
            Quantity::Items => table.items.at(resolution),
            Quantity::ItemsPerSquare => table.items_per_square.at(resolution),
            Quantity::NonEmpty => table.non_empty.at(resolution),
            Quantity::AverageMaximum => table.average_maximum.at(resolution),
        }
    }
}
