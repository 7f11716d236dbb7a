//! The scene files opened last.

use crate::scene::builtin;
use crate::ui::state::Preferences;
use std::path::Path;

/// So many are remembered.
const MOST: usize = 8;

/// A scene's one name: of a file the whole path, however it was given.
pub fn whole(scene: &str) -> String {
    let path = Path::new(scene);
    // A built-in scene is opened even where a file of its name lies about.
    let file = path.is_file() && builtin::list().iter().all(|own| own.name != scene);
    let path = if file { std::path::absolute(path).ok() } else { None };
    path.map_or_else(|| scene.to_owned(), |path| path.display().to_string())
}

/// Remembers a scene as the one opened last, if it is a file; built-in ones are at hand anyway.
pub fn remember(preferences: &mut Preferences, scene: &str) {
    let path = Path::new(scene);
    if !path.is_file() {
        return;
    }
    let path = whole(scene);
    preferences.recent.retain(|other| *other != path);
    preferences.recent.insert(0, path);
    preferences.recent.truncate(MOST);
}

/// Those that are still there.
pub fn existing(preferences: &Preferences) -> Vec<String> {
    preferences.recent.iter().filter(|path| Path::new(path).is_file()).cloned().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_one_name_and_a_built_in_scene_its_own() {
        let whole_name = std::path::absolute("Cargo.toml").unwrap().display().to_string();
        assert_eq!([whole("Cargo.toml"), whole("./Cargo.toml"), whole(&whole_name)], [(); 3].map(|()| whole_name.clone()));
        assert_eq!([whole("cornell"), whole("no such file.glb")], ["cornell", "no such file.glb"]);
    }

    #[test]
    fn the_last_eight_files_are_remembered_while_they_exist() {
        let folder = tempfile::tempdir().unwrap();
        let path = |i: usize| folder.path().join(format!("{i}.glb")).display().to_string();
        let mut preferences = Preferences::default();
        for i in 0..10 {
            std::fs::write(path(i), b"x").unwrap();
            remember(&mut preferences, &path(i));
        }
        remember(&mut preferences, &path(5));
        remember(&mut preferences, "cornell");
        assert_eq!(preferences.recent, [5, 9, 8, 7, 6, 4, 3, 2].map(path));
        std::fs::remove_file(path(9)).unwrap();
        assert_eq!(existing(&preferences), [5, 8, 7, 6, 4, 3, 2].map(path));
    }
}
