#!/usr/bin/env bash
# Plants bugs one at a time in a copy of the sources and demands that the tests named for each of them fail.
# A suite that stays green on a planted bug proves nothing; this proves that ours bites.
#
#   make planted-bugs            all of them, some minutes
#   tests/planted_bugs.sh NAME   one of them
#   tests/planted_bugs.sh --where    whether each still has its place in the sources, in a second
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
copy=$root/target/planted
export CARGO_TARGET_DIR=$root/target/planted-build
# What fails is enough; making it smaller takes most of the time.
export PROPTEST_MAX_SHRINK_ITERS=0
only=${1:-}
survived=0
planted=0

# plant NAME FILE SEARCH REPLACEMENT TEST...: the text SEARCH, literally and once in FILE, becomes REPLACEMENT.
plant() {
    local name=$1 file=$2 search=$3 replacement=$4
    shift 4
    if [ -n "$only" ] && [ "$only" != "$name" ] && [ "$only" != --where ]; then return; fi
    planted=$((planted + 1))
    local places
    places=$(SEARCH=$search perl -0ne 'my $n = () = /\Q$ENV{SEARCH}\E/g; print $n' "$file" 2>/dev/null) || true
    if [ "$places" != 1 ]; then
        echo "$name: ${places:-no} places in $file to plant it, expected 1"
        survived=$((survived + 1))
        return
    fi
    if [ "$only" = --where ]; then return; fi
    rm -rf "$copy"
    mkdir -p "$copy"
    git ls-files -z | xargs -0 cp --parents -t "$copy"
    SEARCH=$search REPLACEMENT=$replacement perl -0pi -e 's/\Q$ENV{SEARCH}\E/$ENV{REPLACEMENT}/' "$copy/$file"
    local log
    log=$(cd "$copy" && cargo test --quiet --no-default-features --no-fail-fast --lib --test cross_check 2>&1) || true
    if ! grep -q '^test result' <<<"$log"; then
        echo "$name: no test ran"
        grep -m 3 '^error' <<<"$log"
        exit 2
    fi
    local failed
    failed=$(grep -oE '^    [a-z_:]+$' <<<"$log" | sort -u | sed 's/^ *//') || true
    local missing=()
    for wanted in "$@"; do
        grep -qE "(^|::)$wanted\$" <<<"$failed" || missing+=("$wanted")
    done
    if [ ${#missing[@]} -eq 0 ]; then
        echo "$name: caught by $(tr '\n' ' ' <<<"$failed")"
    else
        echo "$name: NOT caught by ${missing[*]} (failed: $(tr '\n' ' ' <<<"$failed"))"
        survived=$((survived + 1))
    fi
}

buffer=src/shadow/light_buffer

plant cell-too-few $buffer/build/mod.rs \
    'entries.extend((first..=first + (right - left))' 'entries.extend((first..first + (right - left))' \
    every_cell_that_a_triangle_meets_lists_it_or_lies_behind_a_cover \
    every_exact_tester_is_right_in_every_case_at_every_resolution \
    all_exact_testers_agree_with_the_definition_on_random_scenes

plant cell-bound-shrunk $buffer/cells.rs \
    'half: [0.5 * cell * (1.0 + 1e-12) + 1e-14; 2]' 'half: [0.5 * cell * (1.0 - 1e-9); 2]' \
    every_cell_that_a_triangle_meets_lists_it_or_lies_behind_a_cover

plant depth-towards-the-light $buffer/sheet.rs \
    '> 0.0 { -along } else { along }' '> 0.0 { along } else { -along }' \
    cells_count_along_the_axes_and_depth_grows_away_from_the_light \
    every_exact_tester_is_right_in_every_case_at_every_resolution

plant offset-of-a-parallel-edge-dropped src/geometry/light_triangle.rs \
    'if offset != (0.0, 0.0)' 'if lane == 3' \
    no_filter_contradicts_exact_arithmetic

plant pruned-one-too-many $buffer/cell.rs \
    'c.near <= cover_depth' 'c.near < cover_depth' \
    what_lies_behind_a_cover_is_cut_off_and_what_begins_on_it_stays

plant last-record-dropped $buffer/cell.rs \
    'candidates.truncate(kept);' 'candidates.truncate(kept.max(2) - 1);' \
    what_lies_behind_a_cover_is_cut_off_and_what_begins_on_it_stays \
    every_exact_tester_is_right_in_every_case_at_every_resolution

plant depth-the-wrong-way $buffer/walk.rs \
    'f64::from(record.near) >= z_high' 'f64::from(record.near) <= z_high' \
    every_exact_tester_is_right_in_every_case_at_every_resolution \
    all_exact_testers_agree_with_the_definition_on_random_scenes

plant full-occlusion-the-wrong-way $buffer/mod.rs \
    'f64::from(full_occlusion) < at.z_low' 'f64::from(full_occlusion) > at.z_low' \
    every_exact_tester_is_right_in_every_case_at_every_resolution

plant culled-with-the-light-inside src/shadow/solids.rs \
    'self.is_outside[solid as usize]' 'solid < u32::MAX' \
    far_sides_are_culled_unless_the_light_is_inside \
    every_exact_tester_is_right_in_every_case_at_every_resolution

plant near-sides-culled src/shadow/solids.rs \
    '* outer_side == Sign::Negative' '* outer_side == Sign::Positive' \
    every_exact_tester_is_right_in_every_case_at_every_resolution \
    all_exact_testers_agree_with_the_definition_on_random_scenes

plant crossing-meshes-are-solids src/geometry/solid/mod.rs \
    'Search::Found => return Err(Refusal::Crossing),' 'Search::Found => {}' \
    meshes_that_cross_themselves_are_refused

plant first-hits-of-two-sides src/geometry/solid/outside.rs \
    'Ordering::Equal if common_side != Some(*side) => common_side = None' \
    'Ordering::Equal if common_side != Some(*side) => common_side = Some(*side)' \
    what_rays_cannot_tell_is_not_outside

plant receivers-that-cast-nothing-forgotten $buffer/roles.rs \
    'primitives.filter(may_be_asked).collect()' \
    'primitives.filter(may_be_asked).take(0).collect()' \
    every_exact_tester_is_right_in_every_case_at_every_resolution

plant culled-sides-looked-up $buffer/mod.rs \
    'is_some_and(|culled| culled.hold(point))' 'is_some_and(|culled| culled.hold(point) && false)' \
    from_inside_of_a_solid_its_far_sides_are_dark_but_for_edges_that_the_light_grazes

plant duplicates-of-culled-sides-looked-up $buffer/culled_receivers.rs \
    '(0..scene.triangles.len() as u32).into_par_iter().map(is_culled).collect()' \
    '(0..scene.triangles.len() as u32).into_par_iter().map(|t| is_culled(t) && culled.contains(&t)).collect()' \
    from_inside_of_a_solid_its_far_sides_are_dark_but_for_edges_that_the_light_grazes

plant receivers-ignored-in-a-cell $buffer/cell.rs \
    'candidates.sort_unstable_by' 'candidates.retain(|c| c.role != Role::ReceivesOnly);
    candidates.sort_unstable_by' \
    what_only_receives_keeps_what_can_shadow_it_and_has_no_record \
    every_exact_tester_is_right_in_every_case_at_every_resolution

plant group-ends-the-walk $buffer/walk.rs \
    'Walk::Behind | Walk::Through => {}' 'Walk::Through => {}' \
    what_follows_a_group_is_looked_at_when_a_member_lies_behind_the_point

plant base-surface-rule-dropped $buffer/walk.rs \
    'if asked.untested == Some(primitive) || asked' 'if asked' \
    the_base_surface_is_not_tested

plant depth-not-rounded-down $buffer/build/mod.rs \
    'if f64::from(rounded) > value { rounded.next_down() } else { rounded }' 'rounded.next_up()' \
    depths_bound_the_triangle_from_both_sides

plant filter-without-slack src/geometry/light_triangle.rs \
    'values.iter().any(|&v| v < -p.slack)' 'values.iter().any(|&v| v < 0.0)' \
    no_filter_contradicts_exact_arithmetic

plant closed-triangle-opened src/geometry/occlusion.rs \
    'self.exact_edge(corners, i).sign() != Sign::Negative' 'self.exact_edge(corners, i).sign() == Sign::Positive' \
    all_exact_testers_agree_with_the_definition_on_random_scenes

plant hole-at-the-wrong-corner src/geometry/texel.rs \
    'if as_they_are { [a, b, c] } else { [a, c, b] }' 'if as_they_are { [a, b, c] } else { [a, b, c] }' \
    every_exact_tester_is_right_in_every_case_at_every_resolution

plant footprint-of-a-ray-too-narrow src/visibility/t_buffer/view.rs \
    'let half = half * half / 1_048_576.0;' 'let half = -half * half / 1_024.0;' \
    equals_classical_ray_tracing_in_any_object_order

plant tie-by-index src/visibility/hit.rs \
    'order.then_with(|| tie_order(scene, new.primitive, old.primitive)) == Ordering::Less' 'order == Ordering::Less' \
    coplanar_faces_are_drawn_the_same_in_any_object_order

plant hull-too-small src/geometry/curved/hull.rs \
    'unit * (1.0 + MARGIN + ' 'unit * (0.8 + MARGIN + ' \
    all_exact_testers_agree_on_curved_and_transparent_surfaces

plant shared-edge-crossed-twice src/geometry/occlusion.rs \
    'Sign::Zero => self.perturbed_edge(corners, i) == Sign::Positive' 'Sign::Zero => true' \
    panes_that_share_edges_are_crossed_once

plant own-curved-surface-not-tested $buffer/walk.rs \
    'untested: base.filter(|&base| !self.scene.is_curved(base))' 'untested: base' \
    all_exact_testers_agree_on_curved_and_transparent_surfaces

cells=src/shadow/certified

plant surface-beyond-the-horizon $cells/certificate.rs \
    '== Item::COVERS && only.far > horizon' '== Item::COVERS' \
    irregular_edges_uncertain_centres_and_what_is_withheld_void_a_certificate

plant covered-twice-and-lit $cells/certificate.rs \
    'first.is_certain && first.covers == 1 && depth' 'first.is_certain && first.covers >= 1 && depth' \
    intervals_that_touch_are_one_surface

plant surfaces-that-touch-are-two $cells/certificate.rs \
    'let overlaps = (near >= end) & (near <= from);' 'let overlaps = (near > end) & (near <= from) | (near == nearest);' \
    intervals_that_touch_are_one_surface

plant irregular-edges-ignored $cells/certificate.rs \
    'let is_certain = flags & Item::DOUBTS == 0;' 'let is_certain = flags & Item::MAY_COVER == 0;' \
    irregular_edges_uncertain_centres_and_what_is_withheld_void_a_certificate \
    every_exact_tester_is_right_in_every_case_at_every_resolution \
    all_exact_testers_agree_with_the_definition_on_random_scenes

plant edge-beside-the-cell-by-its-rounding $cells/second_look.rs \
    'let slack = 1.25 * self.projector.delta;' 'let slack = -0.2;' \
    what_is_no_longer_in_doubt_is_so

plant centre-on-an-edge-is-covered $cells/second_look.rs \
    'is_certain &= value.abs() > error;' 'is_certain &= value.abs() >= 0.0;' \
    what_is_no_longer_in_doubt_is_so

plant cover-with-a-border-that-goes-through $cells/judge.rs \
    'if may_be_irregular {' 'if false {' \
    every_point_of_every_triangle_gets_the_exact_answer

plant touching-is-apart $cells/pyramids.rs \
    'beyond[edge][c][i] = u64::from(at < -slack)' 'beyond[edge][c][i] = u64::from(at < slack)' \
    what_is_certain_of_two_triangles_is_so

plant plane-that-touches-is-before $cells/pyramids.rs \
    'other_before &= u64::from(other_at < -of_one);' 'other_before &= u64::from(other_at < of_one);' \
    what_is_certain_of_two_triangles_is_so

plant one-cell-speaks-for-the-triangle $cells/by_triangle.rs \
    'Verdict::Open => NOT_LIT | NOT_DARK,' 'Verdict::Open => 0,' \
    only_what_all_cells_agree_on_is_answered \
    every_point_of_every_triangle_gets_the_exact_answer

plant rounding-of-a-query-forgotten $cells/pairs.rs \
    '(16.0 * ROUNDOFF) + of[2].abs() * (4.0 * ROUNDOFF),' '(16.0 * ROUNDOFF) * 0.0,' \
    what_is_certain_is_true \
    every_exact_tester_is_right_in_every_case_at_every_resolution

plant last-row-of-tiles-forgotten $cells/windows.rs \
    'high.wrapping_add(1).min(start + count)' 'high.min(start + count)' \
    every_tile_has_a_number_and_rows_find_those_within \
    every_exact_tester_is_right_in_every_case_at_every_resolution

plant part-of-a-tile-forgotten $cells/levels.rs \
    'flat_map(move |y| (0..FINER).map' 'flat_map(move |y| (1..FINER).map' \
    every_exact_tester_is_right_in_every_case_at_every_resolution

plant small-cell-by-its-rounding $cells/levels.rs \
    '(du.abs() > error)' '(du.abs() > -error)' \
    places_in_f32_are_those_of_exact_points

plant third-owner-forgotten $cells/edges.rs \
    'mark(second as usize - 1);' 'let _ = second;' \
    a_third_and_a_fourth_owner_make_it_irregular_for_all

plant any-two-owners-are-regular $cells/edges.rs \
    '0 if (one == other) == (a != c) =>' '0 if one == other || a != c || a == c =>' \
    an_edge_of_two_is_regular_if_they_lie_on_different_sides_of_it \
    every_exact_tester_is_right_in_every_case_at_every_resolution

plant link-lost $cells/bins.rs \
    'let mut link = Link { next: head.link, ..Link::default() };' 'let mut link = Link { next: 0, ..Link::default() };' \
    long_lists_are_whole

plant receiver-in-the-cell-of-its-rounding $cells/receivers.rs \
    '& (du.abs() > delta)' '& (du.abs() > -delta)' \
    every_exact_tester_is_right_in_every_case_at_every_resolution

plant walk-without-slack $cells/blockers.rs \
    'let d = 1.25 * delta;' 'let d = -1.25 * delta;' \
    what_is_certain_is_true

plant left-over-from-a-longer-list $cells/blockers.rs \
    'blocked: bits(set, &blocked) & self.present' 'blocked: bits(set, &blocked)' \
    what_is_certain_is_true

plant query-on-the-wrong-side-of-a-seam $cells/open.rs \
    'let is_known = (a.abs() <= depth)' 'let is_known = (a.abs() <= 4.0 * depth.abs())' \
    queries_beyond_the_edge_of_their_side_are_lost

first_hits=src/visibility/t_buffer

plant ray-along-an-edge-by-its-rounding $first_hits/cast.rs \
    '* 1.000_002 + 1e-37) as f32' '* 1e-30) as f32' \
    corners_on_rays_are_seen_as_by_classical_ray_tracing

plant nearest-by-its-rounding $first_hits/draw.rs \
    'let around = here.abs() * ALLOWANCE + slack[3];' 'let around = 0.0 * slack[3];' \
    corners_on_rays_are_seen_as_by_classical_ray_tracing

plant spans-a-column-too-narrow $first_hits/cast.rs \
    'low: if is_known & (per_step > 0.0) { at - margin }' 'low: if is_known & (per_step > 0.0) { at + 1.0 }' \
    equals_classical_ray_tracing_in_any_object_order

plant hidden-without-its-last-column $first_hits/draw.rs \
    '((i % COLUMNS) < columns as usize));' '((i % COLUMNS) + 1 < columns as usize));' \
    equals_classical_ray_tracing_in_any_object_order

plant hidden-by-its-farthest-corner $first_hits/bins.rs \
    'nearest[i] = larger(larger(a, b), c);' 'nearest[i] = smaller(smaller(a, b), c);' \
    equals_classical_ray_tracing_in_any_object_order

frames=kept_testers_answer_as_those_that_are_built_for_the_frame

plant motion-of-objects-ignored src/scene/animation/mod.rs \
    'Some(joint) => same(' 'Some(joint) => joint < u32::MAX || same(' \
    $frames

plant light-of-a-kept-tester-ignored src/shadow/keeper.rs \
    'light: [x, y, z, w].map(f32::to_bits)' 'light: [x, z, z, w].map(f32::to_bits)' \
    $frames

plant pose-of-the-frame-before src/scene/animation/stills.rs \
    'scene: self.animation.objects(&pose)?, moments' \
    'scene: self.animation.objects(&self.animation.pose(first.time - 1.0 / 24.0)?)?, moments' \
    $frames

[ "$planted" -gt 0 ] || { echo "no planted bug is called $only"; exit 2; }
rm -rf "$copy"
echo "$((planted - survived)) passed, $survived failed"
[ "$survived" -eq 0 ]
