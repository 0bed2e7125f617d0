//! What is drawn together.

use super::band::Band;
use super::bins::{self, Bins, Touched};
use super::cast::{Casts, GROUP};
use super::curved_cast::CurvedCast;
use super::draw::{draw, hides};
use super::places::Place;
use super::view::View;
use crate::geometry::batch::InstructionSet;
use crate::geometry::dispatch::for_instruction_sets;

/// Some of a scene's primitives, prepared to be drawn in any band.
pub(super) enum Portion {
    Flat(Vec<Bins>),
    Curved(Vec<CurvedCast>),
}

impl Portion {
    /// All that a camera may see; one after the other is prepared.
    pub fn all<'a>(
        set: InstructionSet,
        view: &'a View<'a>,
        places: &'a [Place],
    ) -> impl Iterator<Item = Portion> + use<'a> {
        let flat = bins::portions(set, view, places).map(Portion::Flat);
        flat.chain(CurvedCast::portions(view).map(Portion::Curved))
    }

    /// Draws what is in a band; `sorted` is room to work in.
    pub fn draw(&self, set: InstructionSet, view: &View, band: &mut Band, sorted: &mut Vec<Touched>) {
        match self {
            Portion::Flat(bins) => {
                bins::front_to_back(view, bins, band.number(), sorted);
                draw_sorted(set, view, sorted, band);
            }
            Portion::Curved(casts) => casts.iter().for_each(|cast| cast.draw(view, band)),
        }
    }
}

for_instruction_sets! {
    /// Draws what is in a band.
    fn draw_sorted = draw_sorted_body, (view: &View, sorted: &[Touched], band: &mut Band)
}

#[inline(always)]
fn draw_sorted_body(set: InstructionSet, view: &View, sorted: &[Touched], band: &mut Band) {
    let mut group = [Touched::NOTHING; GROUP];
    let mut next = 0;
    while next < sorted.len() {
        let mut count = 0;
        while count < GROUP && next < sorted.len() {
            group[count] = sorted[next];
            band.fetch(&sorted[next]);
            count += usize::from(!band.hides(&sorted[next]) && !hides(set, band, &sorted[next]));
            next += 1;
        }
        let casts = Casts::new(view, band.first_row, &group);
        for (i, touched) in group[..count].iter().enumerate() {
            if let Some(cast) = casts.get(view, i) {
                draw(set, view, band, &cast, touched);
            }
        }
    }
}
