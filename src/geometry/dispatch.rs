//! One body of code, compiled for every instruction set and chosen at run time.

/// Defines a function that runs an `#[inline(always)]` body as it is compiled for an [`InstructionSet`]. Nothing is
/// fused or reordered in any of them, so that all give the same bits. The body is told which set it is compiled for, for
/// the few things that no compiler finds by itself.
///
/// [`InstructionSet`]: crate::geometry::batch::InstructionSet
macro_rules! for_instruction_sets {
    (
        $(#[$attribute:meta])*
        $visibility:vis fn $name:ident = $body:path, ($($argument:ident: $type:ty),* $(,)?)
    ) => {
        $(#[$attribute])*
        $visibility fn $name(set: $crate::geometry::batch::InstructionSet, $($argument: $type),*) {
            use $crate::geometry::batch::InstructionSet;
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2")]
                fn avx2($($argument: $type),*) {
                    $body(InstructionSet::Avx2, $($argument),*);
                }
                #[target_feature(enable = "avx512f,avx512vl,avx512bw,avx512dq")]
                fn avx512($($argument: $type),*) {
                    $body(InstructionSet::Avx512, $($argument),*);
                }
                assert!(set.is_available(), "{set:?} on a machine without it");
                match set {
                    InstructionSet::Portable => $body(InstructionSet::Portable, $($argument),*),
                    // SAFETY: the machine has the instructions, as asserted above.
                    InstructionSet::Avx2 => unsafe { avx2($($argument),*) },
                    // SAFETY: the machine has the instructions, as asserted above.
                    InstructionSet::Avx512 => unsafe { avx512($($argument),*) },
                }
            }
            #[cfg(not(target_arch = "x86_64"))]
            {
                assert_eq!(set, InstructionSet::Portable);
                $body(set, $($argument),*);
            }
        }
    };
}

pub(crate) use for_instruction_sets;
