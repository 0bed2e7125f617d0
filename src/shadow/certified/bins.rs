//! Which triangles each tile has to look at: a linked list for each tile, in one array for each worker.

use super::large::Large;
use super::windows::Windows;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// How many bytes all workers may take together.
pub(super) struct Budget {
    left: AtomicUsize,
}

impl Budget {
    /// Takes are of so many bytes, so that they are few.
    pub const PORTION: usize = 1 << 14;

    pub fn new(bytes: usize) -> Budget {
        Budget { left: AtomicUsize::new(bytes) }
    }

    /// Takes portions until there are at least `needed` bytes; whether there were.
    pub fn grant(&self, granted: &mut usize, needed: usize) -> bool {
        let more = needed.saturating_sub(*granted).next_multiple_of(Budget::PORTION);
        let is_there = self.left.fetch_update(Relaxed, Relaxed, |left| left.checked_sub(more)).is_ok();
        *granted += if is_there { more } else { 0 };
        is_there
    }

    /// Ends what was granted.
    pub fn give_back(&self, granted: usize) {
        self.left.fetch_add(granted, Relaxed);
    }
}

/// What a tile looks at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Caller {
    /// A triangle of the scene that lies on one side and is small.
    Small(u32),
    /// One that is not small, by its place in [`Bins`].
    Large(u32),
}

/// A caller in four bytes; there are at most 2^28 triangles.
#[derive(Debug, Clone, Copy, Default)]
struct Packed(u32);

impl Packed {
    const LARGE: u32 = 1 << 31;

    #[inline(always)]
    fn caller(self) -> Caller {
        match self.0 & Packed::LARGE {
            0 => Caller::Small(self.0),
            _ => Caller::Large(self.0 & !Packed::LARGE),
        }
    }
}

impl From<Caller> for Packed {
    #[inline(always)]
    fn from(caller: Caller) -> Packed {
        match caller {
            Caller::Small(triangle) => Packed(triangle),
            Caller::Large(place) => Packed(place | Packed::LARGE),
        }
    }
}

/// A cache line of callers, so that few reads depend on each other.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C, align(64))]
struct Link {
    callers: [Packed; Link::MOST],
    /// Where the next link of the tile is; 0 ends the list.
    next: u32,
}

impl Link {
    const MOST: usize = 15;
}

/// The list of a tile: its first link, and how many callers that has.
#[derive(Debug, Clone, Copy, Default)]
struct Head {
    link: u32,
    count: u32,
}

/// What one worker found.
pub(super) struct Bins<'b> {
    heads: Vec<Head>,
    links: Vec<Link>,
    large: Vec<Large>,
    budget: &'b Budget,
    granted: usize,
    /// It ends where it has more callers and wants to grow.
    most_callers: usize,
    /// Whether memory was asked for in vain: what follows is missing.
    pub overflowed: bool,
}

impl<'b> Bins<'b> {
    /// Nothing yet.
    pub fn new(windows: &Windows, budget: &'b Budget, most_callers: usize) -> Bins<'b> {
        // The list of a tile without any is the link at 0, of which it has none.
        let links = vec![Link::default()];
        let heads = vec![Head::default(); windows.count()];
        Bins { heads, links, large: Vec::new(), budget, granted: 0, most_callers, overflowed: false }
    }

    /// Enters something in a tile.
    #[inline(always)]
    pub fn push(&mut self, tile: u32, caller: Caller) {
        let head = self.heads[tile as usize];
        if head.link == 0 || head.count as usize == Link::MOST {
            if self.links.len() == self.links.capacity() && !self.may_grow() {
                return;
            }
            self.heads[tile as usize] = Head { link: self.links.len() as u32, count: 1 };
            let mut link = Link { next: head.link, ..Link::default() };
            link.callers[0] = caller.into();
            self.links.push(link);
        } else {
            self.links[head.link as usize].callers[head.count as usize] = caller.into();
            self.heads[tile as usize].count += 1;
        }
    }

    /// The place that the next triangle that is not small has.
    pub fn next_large(&self) -> Caller {
        Caller::Large(self.large.len() as u32)
    }

    /// Keeps a triangle that is not small.
    pub fn push_large(&mut self, large: Large) {
        if self.large.len() < self.large.capacity() || self.may_grow() {
            self.large.push(large);
        }
    }

    /// A triangle that is not small.
    pub fn large(&self, place: u32) -> &Large {
        &self.large[place as usize]
    }

    #[cold]
    fn may_grow(&mut self) -> bool {
        if self.overflowed {
            return false;
        }
        let needed = 2 * self.bytes();
        self.overflowed = self.callers() > self.most_callers || !self.budget.grant(&mut self.granted, needed);
        !self.overflowed
    }

    /// Whether a tile looks at nothing.
    #[inline(always)]
    pub fn is_empty(&self, tile: u32) -> bool {
        self.heads[tile as usize].link == 0
    }

    /// Calls for what a tile looks at.
    #[inline(always)]
    pub fn each_of(&self, tile: u32, mut call: impl FnMut(Caller)) {
        let Head { mut link, mut count } = self.heads[tile as usize];
        while link != 0 {
            let of_link = &self.links[link as usize];
            of_link.callers[..count as usize].iter().for_each(|caller| call(caller.caller()));
            (link, count) = (of_link.next, Link::MOST as u32);
        }
    }

    /// How many callers a tile has.
    pub fn callers_of(&self, tile: u32) -> usize {
        let mut count = 0;
        self.each_of(tile, |_| count += 1);
        count
    }

    /// How many callers all tiles have.
    pub fn callers(&self) -> usize {
        let count = |head: &Head| head.count as usize;
        let are_full = self.links.len() - 1 - self.heads.iter().filter(|head| head.link != 0).count();
        are_full * Link::MOST + self.heads.iter().map(count).sum::<usize>()
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.links.capacity() * size_of::<Link>()
            + self.large.capacity() * size_of::<Large>()
            + size_of_val(&self.heads[..])
    }
}

impl Drop for Bins<'_> {
    fn drop(&mut self) {
        self.budget.give_back(self.granted);
    }
}

/// The tiles at which one of several workers found something to look at.
pub(super) fn touched(bins: &[Bins], windows: &Windows) -> impl Iterator<Item = u32> {
    (0..windows.count() as u32).filter(|&tile| bins.iter().any(|bins| !bins.is_empty(tile)))
}

#[cfg(test)]
mod tests {
    use super::super::tiles::TileGrid;
    use super::*;

    fn of(bins: &Bins, tile: u32) -> Vec<Caller> {
        let mut found = Vec::new();
        bins.each_of(tile, |caller| found.push(caller));
        found
    }

    #[test]
    fn lists_are_by_tile() {
        let budget = Budget::new(1 << 30);
        let mut bins = Bins::new(&Windows::whole(&TileGrid::new(8)), &budget, usize::MAX);
        (0..5).for_each(|i| bins.push(i % 2, Caller::Small(i)));
        bins.push(1, Caller::Large(0));
        assert_eq!(of(&bins, 0), [0, 2, 4].map(Caller::Small));
        assert_eq!(of(&bins, 1), [Caller::Small(1), Caller::Small(3), Caller::Large(0)]);
        assert_eq!([0, 1, 2].map(|tile| bins.is_empty(tile)), [false, false, true]);
        assert_eq!(of(&bins, 2), []);
    }

    #[test]
    fn long_lists_are_whole() {
        let budget = Budget::new(1 << 30);
        let mut bins = Bins::new(&Windows::whole(&TileGrid::new(8)), &budget, usize::MAX);
        let count = 3 * Link::MOST as u32 + 1;
        (0..count).for_each(|i| bins.push(i % 2, Caller::Small(i)));
        for tile in 0..2 {
            let mut found = of(&bins, tile);
            found.sort_by_key(|caller| Packed::from(*caller).0);
            assert_eq!(found, (0..count).filter(|i| i % 2 == tile).map(Caller::Small).collect::<Vec<_>>());
        }
        assert_eq!(bins.callers(), count as usize);
    }

    #[test]
    fn it_ends_soon_after_the_most_callers() {
        let budget = Budget::new(1 << 30);
        let mut bins = Bins::new(&Windows::whole(&TileGrid::new(8)), &budget, 1000);
        let entered = (0..).take_while(|_| {
            bins.push(0, Caller::Small(7));
            !bins.overflowed
        });
        assert!((1000..4000).contains(&entered.count()));
    }

    #[test]
    fn nothing_is_entered_beyond_the_budget_and_it_says_so() {
        let budget = Budget::new(Budget::PORTION);
        let mut bins = Bins::new(&Windows::whole(&TileGrid::new(8)), &budget, usize::MAX);
        let mut entered = 0;
        while !bins.overflowed {
            bins.push(0, Caller::Small(7));
            entered += 1;
        }
        assert!(bins.bytes() <= Budget::PORTION);
        assert_eq!(of(&bins, 0).len(), entered - 1);
        drop(bins);
        assert!(budget.grant(&mut 0, Budget::PORTION), "what was granted is given back");
    }
}
