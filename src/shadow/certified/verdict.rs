//! What is certain of all points that a triangle has in a cell.

use super::cell_lists::Item;

/// Whether a light is seen from the points of a triangle in a cell.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Verdict {
    /// Each has to be asked.
    #[default]
    Open,
    /// From all of them.
    Lit,
    /// From none.
    Dark,
}

/// A triangle of the scene in the list of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Listed(u32);

impl Listed {
    const VERDICT: u32 = 3;

    /// A triangle by its number in the scene, with what is left of the flags of its item.
    #[inline(always)]
    pub fn new(triangle: u32, flags: u32, verdict: Verdict) -> Listed {
        Listed(Item::new(triangle, flags & Item::IN_SPACE | verdict as u32).0)
    }

    #[inline(always)]
    pub fn triangle(self) -> u32 {
        Item(self.0).triangle()
    }

    /// Whether it does not lie on one side as a whole.
    #[inline(always)]
    pub fn is_in_space(self) -> bool {
        Item(self.0).has(Item::IN_SPACE)
    }

    /// The verdict on its points in this cell, or nothing if it is another triangle.
    #[inline(always)]
    pub fn verdict_on(self, triangle: u32) -> u32 {
        if self.triangle() == triangle { self.0 & Listed::VERDICT } else { 0 }
    }
}

/// The verdict on the points that a triangle has in the cell of a list: open too if it is not there.
#[inline(always)]
pub(super) fn find<'a>(list: impl Iterator<Item = &'a Listed>, triangle: u32) -> Verdict {
    // It is there once, or as its own duplicate with the same verdict or none.
    let mut found = 0;
    for listed in list {
        found |= listed.verdict_on(triangle);
    }
    match found {
        found if found == Verdict::Lit as u32 => Verdict::Lit,
        found if found == Verdict::Dark as u32 => Verdict::Dark,
        _ => Verdict::Open,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_verdict_is_found_by_the_number_of_its_triangle() {
        let list = [
            Listed::new(7, Item::IN_SPACE | Item::COVERS | Item::IRREGULAR, Verdict::Lit),
            Listed::new(9, 0, Verdict::Dark),
            Listed::new(Item::MOST as u32 - 1, Item::MAY_COVER, Verdict::Open),
        ];
        let find = |triangle| find(list.iter(), triangle);
        assert_eq!([7, 9, 8].map(find), [Verdict::Lit, Verdict::Dark, Verdict::Open]);
        assert_eq!(find(Item::MOST as u32 - 1), Verdict::Open);
        assert_eq!(list.map(Listed::is_in_space), [true, false, false]);
        assert_eq!(list.map(Listed::triangle), [7, 9, Item::MOST as u32 - 1]);
    }
}
