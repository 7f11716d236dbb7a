//! WGSL that carries a shared struct from or to the words of a table's row, written from its declaration.

use bdpt_explorer::gpu::shader::Source;
use naga::{Handle, Module, ScalarKind, Type, TypeInner};
use std::sync::LazyLock;

static MODULE: LazyLock<Module> = LazyLock::new(|| naga::front::wgsl::parse_str(&Source::kernels(1).text).unwrap());

fn named(name: &str) -> Handle<Type> {
    MODULE.types.iter().find(|(_, t)| t.name.as_deref() == Some(name)).unwrap_or_else(|| panic!("no struct {name}")).0
}

/// The scalars of a value: what to append to its name, its word, is it an f32.
fn scalars(of: Handle<Type>, at: u32, path: &str, out: &mut Vec<(String, u32, bool)>) {
    match &MODULE.types[of].inner {
        TypeInner::Scalar(scalar) => out.push((path.to_owned(), at / 4, scalar.kind == ScalarKind::Float)),
        TypeInner::Vector { size, scalar } => {
            let one = |c: usize| (format!("{path}.{}", &"xyzw"[c..=c]), at / 4 + c as u32, scalar.kind == ScalarKind::Float);
            out.extend((0..*size as usize).map(one));
        }
        TypeInner::Struct { members, .. } => {
            for member in members {
                scalars(member.ty, at + member.offset, &format!("{path}.{}", member.name.as_deref().unwrap_or_default()), out);
            }
        }
        other => panic!("no scalars in {other:?}"),
    }
}

/// Statements that write every field of `value`, a struct of this name, from word `at` of the outputs on.
pub fn store(name: &str, value: &str, at: usize) -> String {
    let mut list = Vec::new();
    scalars(named(name), 0, value, &mut list);
    list.iter().map(|(path, word, _)| format!("out_u(row, {}u, bitcast<u32>({path}));\n", at + *word as usize)).collect()
}

/// Statements that read every field of the variable `value`, a struct of this name, from word `at` of the inputs on.
pub fn load(name: &str, value: &str, at: usize) -> String {
    let mut list = Vec::new();
    scalars(named(name), 0, value, &mut list);
    let one = |(path, word, float): &(String, u32, bool)| {
        format!("{path} = in_{}(row, {}u);\n", if *float { "f" } else { "u" }, at + *word as usize)
    };
    list.iter().map(one).collect()
}
