//! In what order queries are asked: along the rows of the image, or so that neighbours in both directions follow each
//! other.

use crate::scene::ImageSize;

/// An order of the pixels of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Order {
    /// Rows from the top.
    Rows,
    /// Along the curve of Morton (1966): squares of 2, of 4, of 8 pixels and so on, each before the next.
    Tiles,
}

impl Order {
    /// Both.
    pub const ALL: [Order; 2] = [Order::Rows, Order::Tiles];

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Order::Rows => "rows",
            Order::Tiles => "tiles",
        }
    }

    /// Places in a list of pixels, which are in rows, in this order.
    pub fn of(self, pixels: &[u32], size: ImageSize) -> Vec<u32> {
        let mut places: Vec<u32> = (0..pixels.len() as u32).collect();
        if self == Order::Tiles {
            let key = |place: &u32| {
                let pixel = pixels[*place as usize];
                spread(pixel % size.width) | (spread(pixel / size.width) << 1)
            };
            places.sort_by_cached_key(key);
        }
        places
    }
}

/// The bits of a number, each followed by a zero.
fn spread(number: u32) -> u64 {
    [
        (16, 0x0000_ffff_0000_ffff),
        (8, 0x00ff_00ff_00ff_00ff),
        (4, 0x0f0f_0f0f_0f0f_0f0f),
        (2, 0x3333_3333_3333_3333),
        (1, 0x5555_5555_5555_5555),
    ]
    .into_iter()
    .fold(u64::from(number), |bits, (shift, mask)| (bits | (bits << shift)) & mask)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_squares_of_squares_and_rows_stay() {
        let size = ImageSize { width: 4, height: 4 };
        let pixels: Vec<u32> = (0..16).collect();
        assert_eq!(Order::Rows.of(&pixels, size), pixels);
        assert_eq!(Order::Tiles.of(&pixels, size), [0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15]);
        // Places in the list, and not pixels.
        assert_eq!(Order::Tiles.of(&[2, 4, 5, 15], size), [1, 2, 0, 3]);
        assert_eq!(spread(u32::MAX), 0x5555_5555_5555_5555);
    }
}
