//! All queries of a view and one light at once: the one place where `bench` asks a tester.

use super::{Answers, Question, answer};
use crate::error::Result;
use crate::shadow::ShadowTester;
use crate::visibility::SurfacePoint;

/// Who is occluded, on all threads of the pool that this is called in.
///
/// # Errors
/// The first error of the tester.
pub fn answer_view(tester: &dyn ShadowTester, points: &[SurfacePoint]) -> Result<Answers> {
    answer(tester, points, Question::Occlusion, &|_| {})
}
