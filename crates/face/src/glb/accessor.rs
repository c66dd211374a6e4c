//! Numbers out of a glTF accessor: any component type, normalised integers, strides, sparse parts.

use gltf::json::accessor::{ComponentType, Type};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index};

use super::container::Container;
use crate::ReadError;

/// More elements than this in one accessor are taken for a damaged file, not for a head.
const MOST_ELEMENTS: u64 = 1 << 24;

/// Where the elements of a view lie.
struct Window<'a> {
    bytes: &'a [u8],
    stride: usize,
}

impl Container {
    /// Elements of `N` numbers each, as f32; integers are scaled to 0..1 or -1..1 when normalised.
    ///
    /// A number that is not finite is refused with its element.
    pub fn floats<const N: usize>(
        &self,
        index: Index<Accessor>,
        place: &str,
    ) -> Result<Vec<[f32; N]>, ReadError> {
        let accessor = self.accessor(index, N, place)?;
        let component = component(accessor, place)?;
        let normalised = accessor.normalized;
        let mut out = vec![[0f32; N]; accessor.count.0 as usize];
        let element = |bytes: &[u8]| -> [f32; N] {
            std::array::from_fn(|a| {
                number(&bytes[a * component.size()..], component, normalised) as f32
            })
        };
        if let Some(view) = accessor.buffer_view {
            let offset = accessor.byte_offset.map_or(0, |o| o.0);
            let window =
                self.window(view.value(), offset, out.len(), N * component.size(), place)?;
            for (i, value) in out.iter_mut().enumerate() {
                *value = element(&window.bytes[i * window.stride..]);
            }
        }
        if let Some(sparse) = &accessor.sparse {
            let count = sparse.count.0 as usize;
            let Checked::Valid(index_type) = sparse.indices.component_type else {
                return Err(ReadError::damaged(place, "sparse indices of an unknown type"));
            };
            let size = index_type.0.size();
            let indices = self.window(
                sparse.indices.buffer_view.value(),
                sparse.indices.byte_offset.0,
                count,
                size,
                place,
            )?;
            let values = self.window(
                sparse.values.buffer_view.value(),
                sparse.values.byte_offset.0,
                count,
                N * component.size(),
                place,
            )?;
            for i in 0..count {
                let at = number(&indices.bytes[i * indices.stride..], index_type.0, false) as usize;
                let length = out.len();
                let slot = out.get_mut(at).ok_or_else(|| {
                    ReadError::damaged(place, format!("sparse index {at} of {length} elements"))
                })?;
                *slot = element(&values.bytes[i * values.stride..]);
            }
        }
        if let Some(bad) = out.iter().position(|v| v.iter().any(|x| !x.is_finite())) {
            return Err(ReadError::damaged(
                format!("{place}, element {bad}"),
                format!("{:?} is not a finite number", out[bad]),
            ));
        }
        Ok(out)
    }

    /// Unsigned integers of a scalar accessor (triangle indices).
    pub fn indices(&self, index: Index<Accessor>, place: &str) -> Result<Vec<u32>, ReadError> {
        let accessor = self.accessor(index, 1, place)?;
        let component = component(accessor, place)?;
        if !matches!(component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32) {
            return Err(ReadError::damaged(place, format!("indices of type {component:?}")));
        }
        let (Some(view), None) = (accessor.buffer_view, &accessor.sparse) else {
            return Err(ReadError::damaged(place, "indices without a plain buffer view"));
        };
        let count = accessor.count.0 as usize;
        let offset = accessor.byte_offset.map_or(0, |o| o.0);
        let window = self.window(view.value(), offset, count, component.size(), place)?;
        Ok((0..count)
            .map(|i| number(&window.bytes[i * window.stride..], component, false) as u32)
            .collect())
    }

    fn accessor(
        &self,
        index: Index<Accessor>,
        numbers: usize,
        place: &str,
    ) -> Result<&Accessor, ReadError> {
        let accessor = self.root.accessors.get(index.value()).ok_or_else(|| {
            ReadError::damaged(place, format!("accessor {} does not exist", index.value()))
        })?;
        let found = match accessor.type_ {
            Checked::Valid(Type::Scalar) => 1,
            Checked::Valid(Type::Vec2) => 2,
            Checked::Valid(Type::Vec3) => 3,
            Checked::Valid(Type::Vec4 | Type::Mat2) => 4,
            Checked::Valid(Type::Mat3) => 9,
            Checked::Valid(Type::Mat4) => 16,
            Checked::Invalid => 0,
        };
        if found != numbers {
            return Err(ReadError::damaged(
                place,
                format!(
                    "accessor {} has {found} numbers an element, {numbers} expected",
                    index.value()
                ),
            ));
        }
        if accessor.count.0 > MOST_ELEMENTS {
            return Err(ReadError::damaged(
                place,
                format!("accessor {} declares {} elements", index.value(), accessor.count.0),
            ));
        }
        Ok(accessor)
    }

    /// Bytes of `count` elements of `size` bytes, checked to lie inside view and buffer.
    fn window(
        &self,
        view: usize,
        offset: u64,
        count: usize,
        size: usize,
        place: &str,
    ) -> Result<Window<'_>, ReadError> {
        let outside = |what: String| ReadError::damaged(place, what);
        let view_place = format!("bufferViews[{view}]");
        let view = self
            .root
            .buffer_views
            .get(view)
            .ok_or_else(|| outside(format!("{view_place} does not exist")))?;
        let stride = view.byte_stride.map_or(size, |s| s.0);
        let needed = match count {
            0 => 0,
            n => (n - 1)
                .checked_mul(stride)
                .and_then(|bytes| bytes.checked_add(size))
                .ok_or_else(|| outside(format!("{count} elements of {stride} bytes")))?,
        };
        let offset = usize::try_from(offset).unwrap_or(usize::MAX);
        let buffer = self
            .buffers
            .get(view.buffer.value())
            .ok_or_else(|| outside(format!("buffer {} does not exist", view.buffer.value())))?;
        let start = usize::try_from(view.byte_offset.map_or(0, |o| o.0)).unwrap_or(usize::MAX);
        let length = usize::try_from(view.byte_length.0).unwrap_or(usize::MAX);
        let bytes =
            start.checked_add(length).and_then(|end| buffer.get(start..end)).ok_or_else(|| {
                outside(format!(
                    "{view_place} asks for {length} bytes at {start} of a buffer of {}",
                    buffer.len()
                ))
            })?;
        let bytes = offset
            .checked_add(needed)
            .and_then(|end| bytes.get(offset..end))
            .ok_or_else(|| {
                outside(format!(
                    "{count} elements need {needed} bytes at {offset} of {view_place}, which has {}",
                    bytes.len()
                ))
            })?;
        Ok(Window { bytes, stride })
    }
}

fn component(accessor: &Accessor, place: &str) -> Result<ComponentType, ReadError> {
    match accessor.component_type {
        Checked::Valid(generic) => Ok(generic.0),
        Checked::Invalid => Err(ReadError::damaged(place, "an unknown component type")),
    }
}

/// One number; normalised integers as the glTF specification (3.11) scales them.
fn number(bytes: &[u8], component: ComponentType, normalised: bool) -> f64 {
    let (value, most) = match component {
        ComponentType::I8 => (f64::from(bytes[0] as i8), 127.0),
        ComponentType::U8 => (f64::from(bytes[0]), 255.0),
        ComponentType::I16 => (f64::from(i16::from_le_bytes([bytes[0], bytes[1]])), 32767.0),
        ComponentType::U16 => (f64::from(u16::from_le_bytes([bytes[0], bytes[1]])), 65535.0),
        ComponentType::U32 => {
            let word = u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
            (f64::from(word), f64::from(u32::MAX))
        }
        ComponentType::F32 => {
            let word = f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
            return f64::from(word);
        }
    };
    if normalised { (value / most).max(-1.0) } else { value }
}
