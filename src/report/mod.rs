//! What a rendering is told as: the labelled sheet of strategy images, the names it goes by, whether it is right, and how fast.

pub mod axis;
#[cfg(not(target_arch = "wasm32"))]
pub mod bench;
pub mod canvas;
pub mod check;
pub mod contact_sheet;
pub mod export;
#[cfg(not(target_arch = "wasm32"))]
pub mod growth;
#[cfg(not(target_arch = "wasm32"))]
pub mod loglog;
#[cfg(not(target_arch = "wasm32"))]
pub mod mitsuba;

pub use canvas::Canvas;
pub use contact_sheet::{ContactSheet, Heading};

use crate::bdpt::{Role, Strategy};

/// What a strategy does, in the words of the field: "next event", "connect 2+3". The program names it so, (s,t) second.
pub fn role_name(strategy: Strategy) -> String {
    match strategy.role() {
        Role::EyeHitsLight => "eye path hits light".to_owned(),
        Role::NextEvent => "next event".to_owned(),
        Role::LightTracer => "light tracer".to_owned(),
        Role::LightHitsLens => "light hits lens".to_owned(),
        Role::Connect => format!("connect {}+{}", strategy.s, strategy.t),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roles_by_name() {
        let names = [(0, 2), (1, 2), (2, 1), (1, 1), (2, 2), (3, 0)].map(|(s, t)| role_name(Strategy::new(s, t)));
        assert_eq!(names, ["eye path hits light", "next event", "light tracer", "light tracer", "connect 2+2", "light hits lens"]);
    }
}
