//! Why a strategy of a sample contributes nothing.

use serde::Serialize;

/// Why a strategy of a sample contributes nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// The light subpath has fewer than s vertices.
    LightSubpathTooShort,
    /// The eye subpath has fewer than t vertices.
    EyeSubpathTooShort,
    /// t ≥ 2: the eye subpath meets another light subpath of its pass.
    NotMet,
    /// y_{s−1} scatters into single directions only.
    LightVertexIsDirac,
    /// z_{t−1} scatters into single directions only.
    EyeVertexIsDirac,
    /// s = 0: z_{t−1} does not lie on a light.
    NotOnALight,
    /// s = 0 or 1: the light does not shine this way.
    BackOfTheLight,
    /// t = 1: the point lies behind the camera.
    BehindTheCamera,
    /// t = 1: the point lies outside the picture.
    OutsideTheFilm,
    /// y_{s−1} scatters nothing along the connection edge (it leaves on the other side, or the surface is black).
    LightVertexScattersNothing,
    /// z_{t−1} scatters nothing along the connection edge.
    EyeVertexScattersNothing,
    /// The ends coincide, or the edge lies in a surface's plane: no geometry term.
    DegenerateEdge,
    /// z_{t−1} is the environment, at infinity.
    EyeVertexAtInfinity,
    /// t = 0: this edge of the light subpath does not cross the lens.
    LightMissesTheLens,
    /// k = 1: a light without extent is not shown directly.
    LightNotShown,
    /// Something stands between y_{s−1} and z_{t−1}.
    Blocked,
    /// The scene has no light.
    NoLight,
    /// The strategy was removed: it is not evaluated.
    Removed,
}

impl Reason {
    /// All of them, in order: the index of one is itself as a number.
    pub const ALL: [Self; 18] = [
        Self::LightSubpathTooShort,
        Self::EyeSubpathTooShort,
        Self::NotMet,
        Self::LightVertexIsDirac,
        Self::EyeVertexIsDirac,
        Self::NotOnALight,
        Self::BackOfTheLight,
        Self::BehindTheCamera,
        Self::OutsideTheFilm,
        Self::LightVertexScattersNothing,
        Self::EyeVertexScattersNothing,
        Self::DegenerateEdge,
        Self::EyeVertexAtInfinity,
        Self::LightMissesTheLens,
        Self::LightNotShown,
        Self::Blocked,
        Self::NoLight,
        Self::Removed,
    ];

    /// One plain sentence.
    pub fn text(self) -> &'static str {
        match self {
            Self::LightSubpathTooShort => "the light subpath ended before it had s vertices",
            Self::EyeSubpathTooShort => "the eye subpath ended before it had t vertices",
            Self::NotMet => "the eye subpath meets the first light subpath of its pass alone",
            Self::LightVertexIsDirac => {
                "the last light vertex is a mirror or glass: it scatters into single directions, none of them along the edge"
            }
            Self::EyeVertexIsDirac => {
                "the last eye vertex is a mirror or glass: it scatters into single directions, none of them along the edge"
            }
            Self::NotOnALight => "the eye subpath's last vertex does not lie on a light",
            Self::BackOfTheLight => "the light does not shine from here this way",
            Self::BehindTheCamera => "the light vertex lies behind the camera",
            Self::OutsideTheFilm => "the light vertex lies outside the picture",
            Self::LightVertexScattersNothing => "the edge leaves the last light vertex behind its surface, where nothing is scattered",
            Self::EyeVertexScattersNothing => "the edge reaches the last eye vertex from behind its surface, where nothing is scattered",
            Self::DegenerateEdge => "the ends of the edge coincide, or the edge lies in a surface's plane",
            Self::EyeVertexAtInfinity => "the eye subpath left the scene: its last vertex is the environment",
            Self::LightMissesTheLens => "this edge of the light subpath does not cross the lens from the front",
            Self::LightNotShown => "a point, spot or directional light has no extent and is not shown directly",
            Self::Blocked => "something stands between the ends of the edge",
            Self::NoLight => "the scene has no light",
            Self::Removed => "the strategy was removed, so it is not evaluated",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_index_of_a_reason_is_itself() {
        assert!(Reason::ALL.iter().enumerate().all(|(index, reason)| *reason as usize == index));
    }
}
