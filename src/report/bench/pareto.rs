//! Whom nobody beats in both time and error.

/// The places of those points for which no other is better in one coordinate and not worse in the other, from left to
/// right. Smaller is better in both; of equal points all are on the front.
pub fn front(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> =
        (0..points.len()).filter(|&i| !points[i].0.is_nan() && !points[i].1.is_nan()).collect();
    order.sort_by(|&i, &j| points[i].0.total_cmp(&points[j].0).then(points[i].1.total_cmp(&points[j].1)));
    let mut front: Vec<usize> = Vec::new();
    for i in order {
        let beaten =
            front.last().is_some_and(|&last| points[last] != points[i] && points[last].1 <= points[i].1);
        if !beaten {
            front.push(i);
        }
    }
    front
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn those_that_are_beaten_are_not_on_it() {
        let points = [(3.0, 0.0), (1.0, 9.0), (2.0, 9.0), (2.0, 4.0), (5.0, 0.0), (3.0, 0.0), (1.0, 10.0)];
        assert_eq!(front(&points), [1, 3, 0, 5]);
        assert!(front(&[]).is_empty());
        assert_eq!(front(&[(f64::NAN, 0.0), (1.0, 1.0)]), [1]);
    }

    proptest! {
        #[test]
        fn it_is_the_definition(points in prop::collection::vec((0_u8..6, 0_u8..6), 0..12)) {
            let points: Vec<(f64, f64)> = points.into_iter().map(|(x, y)| (x.into(), y.into())).collect();
            let beats = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
            let mut wanted: Vec<usize> =
                (0..points.len()).filter(|&i| !points.iter().any(|&other| beats(other, points[i]))).collect();
            let mut found = front(&points);
            found.sort_unstable();
            wanted.sort_unstable();
            prop_assert_eq!(found, wanted);
        }
    }
}
