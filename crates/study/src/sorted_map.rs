//! The map of the study's own types: pairs in the order of their keys, in one vector.
//!
//! The participant's page holds a dozen types of map of a few entries each; a tree would be compiled
//! anew for every one of them (a sixth of the module). Answers stay `BTreeMap`s of values: that one is
//! `serde_json`'s.

use std::borrow::{Borrow, Cow};
use std::collections::BTreeMap;
use std::ops::{Deref, DerefMut, Index};

use litemap::LiteMap;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A map of few entries, in the order of their keys; it is searched by halves, and an insertion moves
/// what is behind it. As JSON it is an object.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SortedMap<K, V>(LiteMap<K, V>);

impl<K, V> SortedMap<K, V> {
    /// No entries.
    pub const fn new() -> Self {
        Self(LiteMap::new_vec())
    }

    /// Whether there are no entries.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The values, to be changed, in the order of their keys.
    pub fn values_mut(&mut self) -> impl Iterator<Item = &mut V> {
        self.0.iter_mut().map(|(_, value)| value)
    }

    /// The keys, taken.
    pub fn into_keys(self) -> impl Iterator<Item = K> {
        self.0.into_tuple_vec().into_iter().map(|(key, _)| key)
    }
}

// Not `LiteMap`'s own way, which writes an empty map as a list.
impl<K: Serialize, V: Serialize> Serialize for SortedMap<K, V> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self)
    }
}

impl<'de, K: Ord + Deserialize<'de>, V: Deserialize<'de>> Deserialize<'de> for SortedMap<K, V> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        BTreeMap::deserialize(deserializer).map(|map| map.into_iter().collect())
    }
}

impl<K, V> From<LiteMap<K, V>> for SortedMap<K, V> {
    fn from(map: LiteMap<K, V>) -> Self {
        Self(map)
    }
}

impl<K, V> Default for SortedMap<K, V> {
    fn default() -> Self {
        Self::new()
    }
}

impl<K, V> Deref for SortedMap<K, V> {
    type Target = LiteMap<K, V>;

    fn deref(&self) -> &LiteMap<K, V> {
        &self.0
    }
}

impl<K, V> DerefMut for SortedMap<K, V> {
    fn deref_mut(&mut self) -> &mut LiteMap<K, V> {
        &mut self.0
    }
}

impl<Q: Ord + ?Sized, K: Borrow<Q> + Ord, V> Index<&Q> for SortedMap<K, V> {
    type Output = V;

    /// # Panics
    /// Where the key is not there.
    #[expect(clippy::expect_used, reason = "indexing is for keys that are known to be there")]
    fn index(&self, key: &Q) -> &V {
        self.0.get(key).expect("a key of the map")
    }
}

impl<K: Ord, V> Extend<(K, V)> for SortedMap<K, V> {
    /// A later value of a key replaces the earlier one.
    fn extend<I: IntoIterator<Item = (K, V)>>(&mut self, pairs: I) {
        pairs.into_iter().for_each(|(key, value)| drop(self.0.insert(key, value)));
    }
}

impl<K: Ord, V> FromIterator<(K, V)> for SortedMap<K, V> {
    fn from_iter<I: IntoIterator<Item = (K, V)>>(pairs: I) -> Self {
        let mut map = Self::new();
        map.extend(pairs);
        map
    }
}

impl<K: Ord, V, const N: usize> From<[(K, V); N]> for SortedMap<K, V> {
    fn from(pairs: [(K, V); N]) -> Self {
        pairs.into_iter().collect()
    }
}

impl<K, V> IntoIterator for SortedMap<K, V> {
    type Item = (K, V);
    type IntoIter = std::vec::IntoIter<(K, V)>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_tuple_vec().into_iter()
    }
}

impl<'a, K, V> IntoIterator for &'a SortedMap<K, V> {
    type Item = (&'a K, &'a V);
    type IntoIter = <&'a LiteMap<K, V> as IntoIterator>::IntoIter;

    fn into_iter(self) -> Self::IntoIter {
        (&self.0).into_iter()
    }
}

impl<V: JsonSchema> JsonSchema for SortedMap<String, V> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        BTreeMap::<String, V>::schema_name()
    }

    fn schema_id() -> Cow<'static, str> {
        BTreeMap::<String, V>::schema_id()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        BTreeMap::<String, V>::json_schema(generator)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Whatever is inserted, taken out and read, it is what a tree would be.
        #[test]
        fn it_is_a_tree_map_in_a_vector(
            pairs in prop::collection::vec(("[a-c]{0,3}", 0u8..9), 0..30),
            taken in prop::collection::vec("[a-c]{0,3}", 0..9),
        ) {
            let mut tree: BTreeMap<String, u8> = pairs.iter().cloned().collect();
            let mut map: SortedMap<String, u8> = pairs.into_iter().collect();
            for key in &taken {
                prop_assert_eq!(map.get(key.as_str()), tree.get(key));
                prop_assert_eq!(map.remove(key.as_str()), tree.remove(key));
            }
            prop_assert!(map.iter().eq(tree.iter()));
            let text = serde_json::to_string(&map).unwrap();
            prop_assert_eq!(&text, &serde_json::to_string(&tree).unwrap());
            prop_assert_eq!(serde_json::from_str::<SortedMap<String, u8>>(&text).unwrap(), map.clone());
            map.values_mut().for_each(|value| *value += 1);
            prop_assert!(map.values().copied().eq(tree.values().map(|value| value + 1)));
            prop_assert!(map.into_keys().eq(tree.into_keys()));
        }
    }
}
