//! Bidirectional path tracing (Veach 1997, chapter 10): the definitions, and the CPU renderer made of them.
//!
//! | symbol | name here | meaning |
//! |---|---|---|
//! | x̄ = x₀…x_k | `x` | a path of k edges, x₀ on the light, x_k on the lens; s + t = k + 1 |
//! | y_i, z_i | `y`, `z` | vertices of the light and the eye subpath |
//! | α^L_s, α^E_t | `alpha` | f over density of a subpath |
//! | p_{s,t} | `p_light[..s]` · `p_eye[s..]` | density of the path under strategy (s,t), product area measure |
//! | c_{s,t} | `connection_term` | what the connection edge adds to f |
//! | C*_{s,t} | `contribution_unweighted` | f / (n p) |
//! | w_{s,t} | `mis_weight` | share of the strategy in the path |
//! | C_{s,t} | `contribution` | w C* |

pub mod blur;
pub mod connect;
pub mod context;
pub mod crossing;
pub mod ends;
pub mod existence;
pub mod joint;
pub mod kinds;
pub mod mis;
pub mod path;
pub mod pilot;
pub mod reason;
pub mod record;
pub mod render;
pub mod replay;
pub mod settings;
pub mod strategy;
pub mod survey;
pub mod vertex;
pub mod visibility;
pub mod walk;

pub use existence::{Absence, Existence};
pub use kinds::Kind;
pub use reason::Reason;
pub use record::PathRecord;
pub use settings::{Heuristic, HeuristicKind, Settings};
pub use strategy::{MAX_EDGES, Role, Strategy, StrategySet};
pub use vertex::{End, Subpath, Vertex};
