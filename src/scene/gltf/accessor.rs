//! Reading accessors, every index and every byte checked: an error says which accessor and what is wrong with it.

use super::container::Document;
use ::gltf::json::accessor::{Accessor, ComponentType, Type};
use ::gltf::json::validation::Checked;
use std::ops::Range;

/// More elements than this in an accessor without bytes (all zeros, or sparse) is a slip or an attack.
const MAX_IMPLICIT: u64 = 1 << 22;

/// The elements of an accessor: where each begins, and how to read a component.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    component: ComponentType,
    normalized: bool,
}

impl Elements<'_> {
    /// Component `c` of element `i` as a number; the bounds were checked when this was made.
    fn number(&self, i: usize, c: usize) -> f64 {
        let at = i * self.stride + c * self.component.size();
        let b = &self.bytes[at..at + self.component.size()];
        let (value, largest) = match self.component {
            ComponentType::I8 => (f64::from(b[0] as i8), f64::from(i8::MAX)),
            ComponentType::U8 => (f64::from(b[0]), f64::from(u8::MAX)),
            ComponentType::I16 => (f64::from(i16::from_le_bytes([b[0], b[1]])), f64::from(i16::MAX)),
            ComponentType::U16 => (f64::from(u16::from_le_bytes([b[0], b[1]])), f64::from(u16::MAX)),
            ComponentType::U32 => (f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])), f64::from(u32::MAX)),
            ComponentType::F32 => return f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])),
        };
        if self.normalized { (value / largest).max(-1.0) } else { value }
    }
}

impl Document<'_> {
    /// How many elements an accessor declares.
    pub fn count(&self, index: usize) -> Result<usize, String> {
        Ok(self.accessor(index)?.count.0.try_into().unwrap_or(usize::MAX))
    }

    /// The elements `range` of positions, normals, texture coordinates …: `N` finite numbers each, f32 or quantised.
    pub fn vectors<const N: usize>(&self, index: usize, range: &Range<usize>) -> Result<Vec<[f32; N]>, String> {
        self.finite(index, range, false)
    }

    /// The elements `range` of colours: three or four finite numbers, integers always as parts of their largest; alpha is 1
    /// where it is missing.
    pub fn colors(&self, index: usize, range: &Range<usize>) -> Result<Vec<[f32; 4]>, String> {
        if self.accessor(index)?.type_ == Checked::Valid(Type::Vec3) {
            let opaque = |[r, g, b]: [f32; 3]| [r, g, b, 1.0];
            return Ok(self.finite(index, range, true)?.into_iter().map(opaque).collect());
        }
        self.finite(index, range, true)
    }

    fn finite<const N: usize>(&self, index: usize, range: &Range<usize>, parts: bool) -> Result<Vec<[f32; N]>, String> {
        let wanted = match N {
            2 => Type::Vec2,
            3 => Type::Vec3,
            _ => Type::Vec4,
        };
        let vectors = self.read(index, wanted, range, parts, |e, i| std::array::from_fn(|c| e.number(i, c) as f32))?;
        match vectors.iter().position(|v: &[f32; N]| !v.iter().all(|x| x.is_finite())) {
            Some(bad) => {
                let bad = range.start + bad;
                Err(format!("accessor {index}, element {bad} is not a finite number; repair the mesh and export it again"))
            }
            None => Ok(vectors),
        }
    }

    /// Vertex indices: unsigned integers of any size.
    pub fn indices(&self, index: usize) -> Result<Vec<u32>, String> {
        let accessor = self.accessor(index)?;
        match component(accessor, index)? {
            ComponentType::U8 | ComponentType::U16 | ComponentType::U32 if !accessor.normalized => {}
            _ => return Err(format!("accessor {index} holds indices that are not plain unsigned integers; export it again")),
        }
        self.read(index, Type::Scalar, &(0..self.count(index)?), false, |e, i| e.number(i, 0) as u32)
    }

    fn accessor(&self, index: usize) -> Result<&Accessor, String> {
        let count = self.root.accessors.len();
        self.root.accessors.get(index).ok_or_else(|| format!("accessor {index} does not exist, there are {count}; export the file again"))
    }

    /// The elements `range` (not beyond the count) of an accessor of type `wanted`, the sparse ones replaced; `parts` takes
    /// integers as parts of their largest even if the accessor does not say so.
    fn read<T: Copy>(
        &self,
        index: usize,
        wanted: Type,
        range: &Range<usize>,
        parts: bool,
        get: impl Fn(&Elements, usize) -> T,
    ) -> Result<Vec<T>, String> {
        let accessor = self.accessor(index)?;
        if accessor.type_ != Checked::Valid(wanted) {
            return Err(format!("accessor {index} is not of type {wanted:?}; export the file again"));
        }
        let (component, normalized) = (component(accessor, index)?, accessor.normalized || parts);
        let size = component.size() * wanted.multiplicity();
        let what = format!("accessor {index}");
        if accessor.count.0 == 0 {
            return Err(format!("{what} is empty; export the file again"));
        }
        let mut values = match accessor.buffer_view {
            Some(view) => {
                let (bytes, stride) = self.span(&what, view.value(), accessor.byte_offset.unwrap_or_default().0, accessor.count.0, size)?;
                let elements = Elements { bytes, stride, component, normalized };
                range.clone().map(|i| get(&elements, i)).collect()
            }
            None if accessor.count.0 > MAX_IMPLICIT => {
                return Err(format!("{what} has {} elements but no data; export the file again", accessor.count.0));
            }
            None => vec![get(&Elements { bytes: &[0; 16], stride: 0, component, normalized }, 0); range.len()],
        };
        if let Some(sparse) = &accessor.sparse {
            let Checked::Valid(index_type) = sparse.indices.component_type else {
                return Err(format!("{what} has sparse indices of an unknown type; export the file again"));
            };
            let (n, size_i) = (sparse.count.0, index_type.0.size());
            let (bytes, stride) = self.span(&what, sparse.indices.buffer_view.value(), sparse.indices.byte_offset.0, n, size_i)?;
            let targets = Elements { bytes, stride, component: index_type.0, normalized: false };
            let (bytes, stride) = self.span(&what, sparse.values.buffer_view.value(), sparse.values.byte_offset.0, n, size)?;
            let replacements = Elements { bytes, stride, component, normalized };
            for i in 0..n as usize {
                let target = targets.number(i, 0) as usize;
                if target as u64 >= accessor.count.0 {
                    return Err(format!("{what} replaces element {target} of {}; export the file again", accessor.count.0));
                }
                if let Some(value) = target.checked_sub(range.start).and_then(|place| values.get_mut(place)) {
                    *value = get(&replacements, i);
                }
            }
        }
        Ok(values)
    }

    /// The bytes of `count` elements of `size` bytes in a buffer view, from `offset` in it, and their distance.
    fn span(&self, what: &str, view: usize, offset: u64, count: u64, size: usize) -> Result<(&[u8], usize), String> {
        let bytes = self.view(view).map_err(|reason| format!("{what}: {reason}"))?;
        let stride = self.root.buffer_views.get(view).and_then(|json| json.byte_stride).map_or(size, |s| s.0);
        if stride < size {
            return Err(format!("buffer view {view} has a stride of {stride} bytes for elements of {size}; export the file again"));
        }
        let needed = match count {
            0 => Some(0),
            _ => (count - 1).checked_mul(stride as u64).and_then(|n| n.checked_add(size as u64)).and_then(|n| n.checked_add(offset)),
        };
        if needed.is_none_or(|n| n > bytes.len() as u64) {
            return Err(format!("{what} reaches beyond the end of buffer view {view}; export the file again"));
        }
        Ok((bytes.get(offset as usize..).unwrap_or_default(), stride))
    }
}

/// The component type, if it is one.
fn component(accessor: &Accessor, index: usize) -> Result<ComponentType, String> {
    match accessor.component_type {
        Checked::Valid(component) => Ok(component.0),
        Checked::Invalid => Err(format!("accessor {index} has an unknown component type; export the file again")),
    }
}
