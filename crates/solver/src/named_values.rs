//! Values by name, as a JSON object: for `#[serde(with = "named_values")]`. A `LiteMap` of its own accord
//! writes an empty map as a list, and reads lists.

use std::fmt;
use std::marker::PhantomData;

use litemap::LiteMap;
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde::ser::{Serialize, Serializer};

pub(crate) fn serialize<S: Serializer, V: Serialize>(
    map: &LiteMap<String, V>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(map)
}

pub(crate) fn deserialize<'de, D: Deserializer<'de>, V: Deserialize<'de>>(
    deserializer: D,
) -> Result<LiteMap<String, V>, D::Error> {
    struct Named<V>(PhantomData<V>);

    impl<'de, V: Deserialize<'de>> Visitor<'de> for Named<V> {
        type Value = LiteMap<String, V>;

        fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
            formatter.write_str("a map")
        }

        fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Self::Value, A::Error> {
            let mut map = LiteMap::new();
            while let Some((name, value)) = entries.next_entry()? {
                map.insert(name, value);
            }
            Ok(map)
        }
    }

    deserializer.deserialize_map(Named(PhantomData))
}
