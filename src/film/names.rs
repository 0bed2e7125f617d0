//! Light names that can stand inside channel names.

use std::collections::HashSet;

/// The most characters of a light's name that a channel name keeps; the rest of its 255 bytes is for the
/// layer, the tester and a number.
const LONGEST: usize = 64;

/// A light's name as part of a channel name: ASCII letters, digits, `-` and `_`, 1 to 64 of them.
///
/// Every other character becomes `_`: a dot would open a new layer, the rest is trouble in one reader or
/// another. An empty name becomes `light`. Different names may become the same; see [`unique_safe_names`].
pub fn safe_light_name(name: &str) -> String {
    let safe = |c: char| if c.is_ascii_alphanumeric() || c == '-' || c == '_' { c } else { '_' };
    match name {
        "" => "light".into(),
        _ => name.chars().take(LONGEST).map(safe).collect(),
    }
}

/// Safe names, one for each name and in the same order, all different.
///
/// Names that are safe already stay as they are, whatever the others become; those that collide get `-2`,
/// `-3` and so on.
pub fn unique_safe_names<S: AsRef<str>>(names: &[S]) -> Vec<String> {
    let mut taken = HashSet::new();
    let mut unique: Vec<Option<String>> = names
        .iter()
        .map(|name| {
            let safe = safe_light_name(name.as_ref());
            (safe == name.as_ref() && taken.insert(safe.clone())).then_some(safe)
        })
        .collect();
    for (slot, name) in unique.iter_mut().zip(names) {
        if slot.is_none() {
            *slot = Some(first_free(&safe_light_name(name.as_ref()), &mut taken));
        }
    }
    unique.into_iter().flatten().collect()
}

fn first_free(wanted: &str, taken: &mut HashSet<String>) -> String {
    let mut name = wanted.to_string();
    let mut number = 2;
    while !taken.insert(name.clone()) {
        name = format!("{wanted}-{number}");
        number += 1;
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trouble_becomes_an_underscore() {
        assert_eq!(safe_light_name("key"), "key");
        assert_eq!(safe_light_name("Lamp.001 (left)"), "Lamp_001__left_");
        assert_eq!(safe_light_name("Führungslicht\n"), "F_hrungslicht_");
        assert_eq!(safe_light_name(""), "light");
        assert_eq!(safe_light_name(&"long".repeat(100)).len(), 64);
    }

    #[test]
    fn collisions_are_numbered_and_safe_names_keep_theirs() {
        assert_eq!(unique_safe_names(&["a b", "a_b", "a.b", "a_b-2"]), ["a_b-3", "a_b", "a_b-4", "a_b-2"]);
        assert_eq!(unique_safe_names(&["", "light", "light"]), ["light-2", "light", "light-3"]);
    }
}
