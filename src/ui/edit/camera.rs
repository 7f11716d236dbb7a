//! Where the camera stands: in numbers, by hand, and at views one wants to come back to.

use super::hand;
use super::rows::{self, Named, Scale};
use crate::math::DVec3;
use crate::scene::pose::YFOVS;
use crate::scene::{Lens, Pose, Scene};
use crate::ui::camera_bar;
use crate::ui::live::Live;
use crate::ui::state::State;
use crate::ui::text::{EditText, fill};
use crate::ui::widgets::finite;
use eframe::egui::{Button, RichText, Role, TextEdit, Ui, WidgetInfo};
use serde::{Deserialize, Serialize};

/// Most bookmarks of a scene.
const MOST: usize = 50;

/// A view to come back to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bookmark {
    /// What the person calls it.
    pub name: String,
    /// Which of the scene's cameras.
    pub camera: usize,
    /// Where it stands.
    pub pose: Pose,
    /// Its lens; `None` = its own.
    pub lens: Option<Lens>,
}

/// Shows the section.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live) {
    let Some(scene) = live.scene() else { return };
    camera_bar::show(ui, state, live);
    numbers(ui, state, live, scene);
    bookmarks(ui, state, live, scene);
}

/// The switch that lets plain drags move the camera.
pub fn move_button(ui: &mut Ui, state: &mut State) {
    let button = ui.add(Button::new(state.say(EditText::MoveCamera)).selected(state.edit.moving));
    if button.on_hover_text(state.say(EditText::HelpMoveCamera)).clicked() {
        state.edit.moving = !state.edit.moving;
    }
}

/// Back to where the file has the camera.
pub fn to_file(ui: &mut Ui, state: &mut State) {
    let button = ui.add_enabled(state.pose.is_some(), Button::new(state.say(EditText::CameraOfFile)));
    if button.on_hover_text(state.say(EditText::HelpCameraOfFile)).clicked() {
        state.pose = None;
    }
}

fn numbers(ui: &mut Ui, state: &mut State, live: &Live, scene: &Scene) {
    let (Some(own), Some(camera)) = (scene.cameras.get(state.camera), live.camera(state)) else { return };
    let (own, old, lang) = (Pose::of(scene, own), Pose::of(scene, &camera), state.prefs.lang);
    let (mut pose, item) = (old, camera.name.clone());
    let named = |name: EditText, help: EditText| Named { lang, item: &item, name, help };
    rows::grid(ui, |ui| {
        let texts = named(EditText::Position, EditText::HelpCameraPosition);
        let help = texts.help.in_language(lang);
        let speed = 0.005 * f64::from(scene.sphere.radius);
        if rows::row(ui, texts, own.position != old.position, |ui, spoken| {
            rows::vector(ui, (spoken, help), &mut pose.position, speed, -1e9..=1e9);
        }) {
            pose.position = own.position;
        }
        let texts = named(EditText::Aim, EditText::HelpAim);
        let help = texts.help.in_language(lang);
        let aimed = (own.right, own.up, own.axis) != (old.right, old.up, old.axis);
        if rows::row(ui, texts, aimed, |ui, spoken| pose = aim(ui, (spoken, help), pose)) {
            pose = Pose { position: pose.position, yfov: pose.yfov, ..own };
        }
        let texts = named(EditText::Yfov, EditText::HelpYfov);
        let help = texts.help.in_language(lang);
        let [least, most] = YFOVS.map(f32::to_degrees);
        let scale = Scale { slider: [5.0, 120.0], range: [least, most], smallest: None, unit: "°" };
        let shown = pose.yfov.to_degrees();
        let mut degrees = shown;
        if rows::row(ui, texts, own.yfov != old.yfov, |ui, spoken| rows::number(ui, (spoken, help), &mut degrees, scale)) {
            pose.yfov = own.yfov;
        } else if degrees != shown {
            pose.yfov = degrees.to_radians().clamp(YFOVS[0], YFOVS[1]);
        }
    });
    if pose != old && pose.position.iter().all(|x| x.is_finite()) {
        hand::set(state, live, pose);
    }
}

/// Turns a camera on the spot by two angles: about the vertical, and up.
fn aim(ui: &mut Ui, (spoken, help): (&str, &str), pose: Pose) -> Pose {
    let [x, y, z] = pose.axis.map(f64::from);
    let old = [x.atan2(-z).to_degrees(), y.atan2(x.hypot(z)).to_degrees()];
    let mut angles = old;
    for (angle, (letter, range)) in angles.iter_mut().zip([("↔", -360.0..=360.0), ("↕", -88.0..=88.0)]) {
        let field = eframe::egui::DragValue::new(angle)
            .custom_parser(finite)
            .range(range)
            .speed(0.3)
            .max_decimals(1)
            .suffix("°")
            .prefix(format!("{letter} "));
        let field = ui.add(field.update_while_editing(false));
        rows::speak(&field, &format!("{spoken} {letter}"));
        field.on_hover_text(help);
    }
    if angles == old {
        return pose;
    }
    // Seen from above, a turn to the right is clockwise.
    let turn = (old[0] - angles[0]).to_radians();
    pose.orbit(DVec3::from(pose.position), turn, (angles[1] - old[1]).to_radians())
}

fn bookmarks(ui: &mut Ui, state: &mut State, live: &Live, scene: &Scene) {
    // Every scene in a file has its own.
    let inside = scene.scene.filter(|_| scene.scene_names.len() > 1).map_or(String::new(), |index| format!("#{index}"));
    let Some(key) = live.opened().map(|opening| format!("{}{inside}", opening.scene)) else { return };
    ui.add_space(4.0);
    ui.label(RichText::new(state.say(EditText::Bookmarks)).strong()).on_hover_text(state.say(EditText::HelpBookmarks));
    let count = state.prefs.bookmarks.get(&key).map_or(0, Vec::len);
    ui.horizontal(|ui| {
        let hint = state.say(EditText::BookmarkName);
        let field = ui.add(TextEdit::singleline(&mut state.edit.bookmark_name).hint_text(hint).desired_width(130.0));
        rows::speak(&field, hint);
        let button = ui.add_enabled(count < MOST, Button::new(state.say(EditText::BookmarkKeep)));
        if button.on_hover_text(state.say(EditText::HelpBookmarks)).clicked()
            && let Some(camera) = live.camera(state)
        {
            let typed = std::mem::take(&mut state.edit.bookmark_name);
            let name = match typed.trim() {
                "" => fill(state.say(EditText::BookmarkDefault), &[&(count + 1).to_string()]),
                name => name.to_owned(),
            };
            let bookmark = Bookmark { name, camera: state.camera, pose: Pose::of(scene, &camera), lens: state.lens };
            state.prefs.bookmarks.entry(key.clone()).or_default().push(bookmark);
        }
    });
    for index in 0..count {
        ui.push_id(("bookmark", index), |ui| bookmark(ui, state, live, (&key, index)));
    }
}

/// A bookmark: go there, call it something else, forget it.
fn bookmark(ui: &mut Ui, state: &mut State, live: &Live, (key, index): (&str, usize)) {
    let Some(kept) = state.prefs.bookmarks.get(key).and_then(|list| list.get(index)).cloned() else { return };
    ui.horizontal(|ui| {
        if let Some((_, name)) = state.edit.renaming.as_mut().filter(|(other, _)| *other == index) {
            let field = ui.add(TextEdit::singleline(name).desired_width(150.0));
            rows::speak(&field, EditText::BookmarkRename.in_language(state.prefs.lang));
            if field.lost_focus() {
                let name = std::mem::take(name);
                state.edit.renaming = None;
                if let Some(kept) = state.prefs.bookmarks.get_mut(key).and_then(|list| list.get_mut(index))
                    && !name.trim().is_empty()
                {
                    name.trim().clone_into(&mut kept.name);
                }
            } else {
                field.request_focus();
            }
        } else if ui.add(Button::new(kept.name.as_str())).on_hover_text(state.say(EditText::HelpBookmarkGo)).clicked() {
            go(state, live, &kept);
        }
        let named = |response: &eframe::egui::Response, text: EditText| {
            let spoken = fill(text.in_language(state.prefs.lang), &[&kept.name]);
            response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &spoken));
        };
        let rename = ui.small_button(state.say(EditText::BookmarkRename));
        named(&rename, EditText::BookmarkRenameOne);
        let delete = ui.small_button(state.say(EditText::BookmarkDelete));
        named(&delete, EditText::BookmarkDeleteOne);
        if rename.clicked() {
            state.edit.renaming = Some((index, kept.name.clone()));
        }
        if delete.clicked() {
            state.edit.renaming = None;
            if let Some(list) = state.prefs.bookmarks.get_mut(key) {
                list.remove(index);
            }
            state.prefs.bookmarks.retain(|_, list| !list.is_empty());
        }
    });
}

/// Goes to a bookmark, as far as the scene still has its camera.
fn go(state: &mut State, live: &Live, kept: &Bookmark) {
    let cameras = live.scene().map_or(0, |scene| scene.cameras.len());
    state.choose_camera(kept.camera.min(cameras.saturating_sub(1)));
    state.lens = kept.lens;
    hand::set(state, live, kept.pose);
}
