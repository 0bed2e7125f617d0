//! What `extras` say about shadows.
//!
//! glTF has no words for an object that casts or receives none; three.js and its exporters write
//! `castShadow` and `receiveShadow`, both booleans. `extras` may be any JSON, and all the rest of it is passed
//! over.

use crate::scene::Shadowing;
use serde::de::{Deserialize, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use std::fmt;

/// The switches of a node or mesh.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Extras {
    /// `castShadow`.
    casts: Option<bool>,
    /// `receiveShadow`.
    receives: Option<bool>,
}

impl Extras {
    /// The part in shadows of a mesh as a node shows it: what the node says, else what the mesh says.
    pub(super) fn shadowing(node: Extras, mesh: Extras) -> Shadowing {
        let usual = Shadowing::default();
        Shadowing {
            casts: node.casts.or(mesh.casts).unwrap_or(usual.casts),
            receives: node.receives.or(mesh.receives).unwrap_or(usual.receives),
        }
    }
}

impl<'de> Deserialize<'de> for Extras {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Extras, D::Error> {
        deserializer.deserialize_any(Anything)
    }
}

/// Takes any JSON and looks into objects only.
struct Anything;

impl<'de> Visitor<'de> for Anything {
    type Value = Extras;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("extras")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Extras, A::Error> {
        let mut extras = Extras::default();
        while let Some(key) = map.next_key::<String>()? {
            let (switch, name) = match key.as_str() {
                "castShadow" => (&mut extras.casts, "castShadow"),
                "receiveShadow" => (&mut extras.receives, "receiveShadow"),
                _ => {
                    map.next_value::<IgnoredAny>()?;
                    continue;
                }
            };
            if switch.replace(map.next_value()?).is_some() {
                return Err(A::Error::duplicate_field(name));
            }
        }
        Ok(extras)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Extras, A::Error> {
        while seq.next_element::<IgnoredAny>()?.is_some() {}
        Ok(Extras::default())
    }

    fn visit_bool<E>(self, _: bool) -> Result<Extras, E> {
        Ok(Extras::default())
    }

    fn visit_i64<E>(self, _: i64) -> Result<Extras, E> {
        Ok(Extras::default())
    }

    fn visit_u64<E>(self, _: u64) -> Result<Extras, E> {
        Ok(Extras::default())
    }

    fn visit_f64<E>(self, _: f64) -> Result<Extras, E> {
        Ok(Extras::default())
    }

    fn visit_str<E>(self, _: &str) -> Result<Extras, E> {
        Ok(Extras::default())
    }

    fn visit_unit<E>(self) -> Result<Extras, E> {
        Ok(Extras::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_switches_are_read() {
        let read = |json: &str| serde_json::from_str::<Extras>(json).unwrap();
        for json in ["null", "true", "-1", "7", "0.5", "\"castShadow\"", "[[], {\"castShadow\": 3}]", "{}"] {
            assert_eq!(read(json), Extras::default(), "{json}");
        }
        let extras = read(r#"{"a": {"castShadow": 3}, "castShadow": false, "receiveShadow": true}"#);
        assert_eq!(extras, Extras { casts: Some(false), receives: Some(true) });
        for json in
            [r#"{"castShadow": 0}"#, r#"{"receiveShadow": null}"#, r#"{"castShadow":true,"castShadow":true}"#]
        {
            assert!(serde_json::from_str::<Extras>(json).is_err(), "{json}");
        }
    }

    #[test]
    fn the_node_speaks_before_the_mesh() {
        let all = Extras { casts: Some(false), receives: Some(false) };
        let node = Extras { casts: Some(true), receives: None };
        assert_eq!(Extras::shadowing(node, all), Shadowing { casts: true, receives: false });
        assert_eq!(Extras::shadowing(Extras::default(), Extras::default()), Shadowing::default());
    }
}
