//! Sparse accessors: a few elements that stand in for those of the accessor.

use super::accessors::{Accessors, Packed};
use super::components::Component;
use super::schema::{Accessor, SparseEntry};

/// Replaced elements, in strictly increasing order of their indices.
#[derive(Clone, Copy)]
pub(super) struct Sparse<'a> {
    component: Component,
    indices: Packed<'a>,
    values: Packed<'a>,
    count: usize,
}

impl<'a> Sparse<'a> {
    /// Finds the bytes of a sparse accessor's indices and values, and checks the order of the indices.
    ///
    /// # Errors
    /// A line if a view does not hold them, or the indices do not increase or reach past the accessor.
    pub(super) fn read(
        accessors: &Accessors<'a>,
        index: u64,
        accessor: &Accessor,
        entry: &SparseEntry,
        value_size: usize,
    ) -> Result<Sparse<'a>, String> {
        let unsigned = [Component::UnsignedByte, Component::UnsignedShort, Component::UnsignedInt];
        let component =
            Component::from_code(entry.indices.component_type).filter(|found| unsigned.contains(found));
        let Some(component) = component else {
            let found = entry.indices.component_type;
            return Err(format!(
                "indices: expected UNSIGNED_BYTE, UNSIGNED_SHORT or UNSIGNED_INT, found componentType {found}"
            ));
        };
        let packed = |view: u64, offset: u64, size: usize, what: &str| {
            let packed = accessors.packed(view, offset, entry.count, size);
            packed.map_err(|why| format!("{what}: {why}"))
        };
        let (from, to) = (&entry.indices, &entry.values);
        let sparse = Sparse {
            component,
            indices: packed(from.buffer_view, from.byte_offset, component.size(), "indices")?,
            values: packed(to.buffer_view, to.byte_offset, value_size, "values")?,
            // That many indices were just found in memory.
            count: entry.count as usize,
        };
        // Primitives share accessors; the order of a long list is looked at once.
        if accessors.is_first_look(index) {
            sparse.check_order(accessor.count)?;
        }
        Ok(sparse)
    }

    fn check_order(&self, elements: u64) -> Result<(), String> {
        let mut least = 0;
        for position in 0..self.count {
            let index = self.index(position);
            if index < least {
                return Err(format!("indices: element {position} is {index}, expected at least {least}"));
            }
            if index >= elements {
                return Err(format!("indices: element {position} is {index} of {elements}"));
            }
            least = index + 1;
        }
        Ok(())
    }

    fn index(&self, position: usize) -> u64 {
        // A 32-bit integer, which f64 holds exactly.
        self.component.decode(self.indices.element(position)) as u64
    }

    /// The bytes that stand in for an element.
    pub(super) fn find(&self, element: usize) -> Option<&'a [u8]> {
        let (mut low, mut high) = (0, self.count);
        while low < high {
            let middle = low + (high - low) / 2;
            match self.index(middle).cmp(&(element as u64)) {
                std::cmp::Ordering::Less => low = middle + 1,
                std::cmp::Ordering::Greater => high = middle,
                std::cmp::Ordering::Equal => return Some(self.values.element(middle)),
            }
        }
        None
    }
}
