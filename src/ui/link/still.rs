//! What a link is about where there is no window: what would be rendered there, and how it would be shown.

use super::ignored::{Ignored, Why, sentence};
use super::{Link, MOST_BYTES, Shared, arrive};
use crate::engine::{Job, Still};
use crate::scene::environment::EnvironmentSource;
use crate::scene::{Overrides, Progress, builtin, edit};
use crate::ui::state::{Preferences, State};
use crate::ui::text::Lang;
use std::sync::Arc;

/// The picture of a link.
///
/// # Errors
/// If the link is too long, or shows a file; in a sentence.
pub fn still(text: &str) -> Result<Still, String> {
    let (link, mut ignored) = Link::parse(text).map_err(|length| format!("it has {length} letters, and at most {MOST_BYTES} are read"))?;
    let name = match &link.scene {
        Shared::Known(name) => name,
        Shared::File(name) => return Err(format!("it shows {name}, a file that does not travel with it; use `render` on that file")),
    };
    let radiance = match &link.environment {
        Some(Shared::Known(radiance)) => Some(EnvironmentSource::Constant((*radiance).into())),
        Some(Shared::File(file)) => {
            return Err(format!("it needs {file}, a file that does not travel with it; use `render --environment`"));
        }
        None => None,
    };
    let overrides =
        Overrides { environment_rotation: radiance.is_some().then_some(link.turn), environment: radiance, scene: link.inside.clone() };
    if builtin::list().iter().all(|own| own.name != name) {
        let names: Vec<&str> = builtin::list().iter().map(|own| own.name).collect();
        return Err(format!("there is no scene '{name}'; there are {}", names.join(", ")));
    }
    let file = Arc::new(builtin::open_with(name, &overrides, &Progress::default()).map_err(|error| error.to_string())?);
    let mut state = State::new(Preferences::default(), link.size);
    ignored.extend(arrive(&link, &mut state, &file, false));
    if state.view.offset != 0.0 {
        ignored.push(Ignored::new("offset", Why::Refused("a file has none".to_owned())));
    }
    let scene = edit::apply(&file, &state.edit.edits).map_err(|error| error.to_string())?;
    let (State { camera, pose, lens, size, settings, hidden, .. }, look) = {
        let look = state.look();
        (state, look)
    };
    let job = Job { camera, pose, lens, size, settings, ..Job::new(Arc::new(scene)) };
    Ok(Still { job, hidden, look, note: sentence(&ignored, Lang::En) })
}
