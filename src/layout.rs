//! Structs that cross borders as bytes: declared once here, uploaded as they are, mirrored in WGSL and compared by a test.

/// One field of a shared struct: its name and its offset in bytes.
pub type Field = (&'static str, usize);

/// Declares a `#[repr(C)]` Pod struct together with its field table, so that a test can hold another declaration of the
/// same struct (WGSL's) against it. A `Vec3` must be followed by a four-byte field: then Rust and WGSL pack alike.
#[macro_export]
macro_rules! shared_struct {
    ($(#[$doc:meta])* pub struct $name:ident { $($(#[$field_doc:meta])* pub $field:ident : $type:ty,)* }) => {
        $(#[$doc])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
        pub struct $name { $($(#[$field_doc])* pub $field: $type,)* }

        impl $name {
            /// Name, size in bytes, and fields with their offsets.
            pub fn layout() -> (&'static str, usize, Vec<$crate::layout::Field>) {
                (stringify!($name), size_of::<$name>(), vec![$((stringify!($field), std::mem::offset_of!($name, $field)),)*])
            }
        }
    };
}
