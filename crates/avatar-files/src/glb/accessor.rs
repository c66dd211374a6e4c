//! Numbers out of a glTF accessor: any component type, normalised integers, strides, sparse parts.

use gltf_json::accessor::sparse::Sparse;
use gltf_json::accessor::{ComponentType, Type};
use gltf_json::validation::Checked;
use gltf_json::{Accessor, Index};

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
        // Zeros that lie nowhere: no more of them than the file could give other vertices numbers.
        let all: usize = self.buffers.iter().map(Vec::len).sum();
        if accessor.buffer_view.is_none() && accessor.count.0 > all as u64 {
            let what = format!("{} elements declared, the file has {all} bytes", accessor.count.0);
            return Err(ReadError::damaged(place, what));
        }
        let count = accessor.count.0 as usize;
        let dense = match accessor.buffer_view {
            Some(view) => {
                let offset = accessor.byte_offset.map_or(0, |o| o.0);
                Some(self.window(view.value(), offset, count, N * component.size(), place)?)
            }
            None => None,
        };
        // Room is made only for what the file is known to hold.
        let mut out = vec![[0f32; N]; count];
        if let Some(window) = dense {
            for (i, value) in out.iter_mut().enumerate() {
                *value = element(&window.bytes[i * window.stride..], component, normalised);
            }
        }
        if let Some(sparse) = &accessor.sparse {
            self.replace_sparse(accessor, sparse, component, &mut out, place)?;
        }
        if let Some(bad) = out.iter().position(|v| v.iter().any(|x| !x.is_finite())) {
            return Err(ReadError::damaged(
                format!("{place}, element {bad}"),
                format!("{:?} is not a finite number", out[bad]),
            ));
        }
        Ok(out)
    }

    /// The elements that the sparse part of an accessor puts in the place of others.
    fn replace_sparse<const N: usize>(
        &self,
        accessor: &Accessor,
        sparse: &Sparse,
        component: ComponentType,
        out: &mut [[f32; N]],
        place: &str,
    ) -> Result<(), ReadError> {
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
            *slot = element(&values.bytes[i * values.stride..], component, accessor.normalized);
        }
        Ok(())
    }

    /// How many numbers each element has; nothing where the accessor does not exist or does not say.
    pub fn components(&self, index: Index<Accessor>) -> Option<usize> {
        match self.root.accessors.get(index.value())?.type_ {
            Checked::Valid(kind) => Some(kind.multiplicity()),
            Checked::Invalid => None,
        }
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

    /// The bytes of a plain buffer view.
    pub fn view_bytes(&self, index: usize, place: &str) -> Result<&[u8], ReadError> {
        let outside = |what: String| ReadError::damaged(place, what);
        let view = self.root.buffer_views.get(index);
        let view = view.ok_or_else(|| outside(format!("bufferViews[{index}] does not exist")))?;
        let (buffer, start) = (view.buffer.value(), view.byte_offset.map_or(0, |o| o.0));
        self.buffer_bytes(buffer, start, view.byte_length.0, &format!("bufferViews[{index}]"))
            .map_err(outside)
    }

    /// `length` bytes of a buffer at `start`, or why they are not there.
    pub fn buffer_bytes(
        &self,
        buffer: usize,
        start: u64,
        length: u64,
        who: &str,
    ) -> Result<&[u8], String> {
        let bytes =
            self.buffers.get(buffer).ok_or_else(|| format!("buffer {buffer} does not exist"))?;
        let at = |x: u64| usize::try_from(x).unwrap_or(usize::MAX);
        let end = at(start).checked_add(at(length));
        end.and_then(|end| bytes.get(at(start)..end)).ok_or_else(|| {
            format!("{who} asks for {length} bytes at {start} of a buffer of {}", bytes.len())
        })
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
        let index = view;
        let view_place = format!("bufferViews[{index}]");
        let view = self
            .root
            .buffer_views
            .get(index)
            .ok_or_else(|| outside(format!("{view_place} does not exist")))?;
        let unpacked = self.unpacked.get(&index);
        // Unpacked views say themselves how far apart their elements are.
        let own = unpacked.map(|u| u.stride).or(view.byte_stride.map(|s| s.0));
        let stride = own.unwrap_or(size);
        let needed = match count {
            0 => 0,
            n => (n - 1)
                .checked_mul(stride)
                .and_then(|bytes| bytes.checked_add(size))
                .ok_or_else(|| outside(format!("{count} elements of {stride} bytes")))?,
        };
        let offset = usize::try_from(offset).unwrap_or(usize::MAX);
        let bytes = match unpacked {
            Some(unpacked) => &unpacked.bytes[..],
            None => self.view_bytes(index, place)?,
        };
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

/// The numbers of an element.
fn element<const N: usize>(bytes: &[u8], component: ComponentType, normalised: bool) -> [f32; N] {
    std::array::from_fn(|a| number(&bytes[a * component.size()..], component, normalised) as f32)
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
