//! Zoom around the cursor or between two fingers, pan, and the click or tap that picks a pixel.

use super::super::edit;
use super::super::live::Live;
use super::super::mark_pick;
use super::super::state::{Placement, State};
use super::super::touch::{self, Click};
use eframe::egui::{Rect, Response, Ui, Vec2, vec2};
use std::ops::RangeInclusive;

/// How large a pixel can be made, points.
pub const ZOOMS: RangeInclusive<f32> = 0.05..=200.0;

/// Zoom, pan and pick; where the film ends up.
pub fn show(ui: &Ui, state: &mut State, live: &Live, response: &Response, panel: Rect) -> Rect {
    let size = vec2(state.size[0] as f32, state.size[1] as f32);
    let (mut zoom, mut centre) = match state.placement {
        Placement::Fit => (fit_zoom(size, panel), size * 0.5),
        Placement::Free { zoom, centre } => (zoom, centre),
    };
    let mut moved = std::mem::take(&mut state.view.one_to_one);
    if moved {
        zoom = 1.0 / ui.pixels_per_point();
    }
    // The camera's hand comes first: what it takes does not move the picture.
    let image = Rect::from_min_size(panel.center() - centre * zoom, size * zoom);
    let steered = edit::hand::steer(ui, state, live, response, image);
    let pinch = touch::pinch(ui, response).filter(|_| !steered);
    if let Some(pinch) = pinch {
        let under = centre + (pinch.about - pinch.pan - panel.center()) / zoom;
        zoom = (zoom * pinch.zoom).clamp(*ZOOMS.start(), *ZOOMS.end());
        centre = under - (pinch.about - panel.center()) / zoom;
        moved = true;
    } else if response.dragged() && !steered && !state.fingers.several() {
        centre -= response.drag_delta() / zoom;
        moved |= response.drag_delta() != Vec2::ZERO;
    }
    if let Some(cursor) = ui.input(|input| input.pointer.hover_pos()).filter(|_| response.contains_pointer() && !steered && pinch.is_none())
    {
        let factor = ui.input(|input| input.zoom_delta() * (input.smooth_scroll_delta().y * 0.004).exp());
        if factor != 1.0 {
            let under = centre + (cursor - panel.center()) / zoom;
            zoom = (zoom * factor).clamp(*ZOOMS.start(), *ZOOMS.end());
            centre = under - (cursor - panel.center()) / zoom;
            moved = true;
        }
    }
    if moved {
        // Some of the image stays in sight, whatever happens.
        centre = centre.clamp(Vec2::ZERO, size);
        state.placement = Placement::Free { zoom, centre };
    }
    let image = Rect::from_min_size(panel.center() - centre * zoom, size * zoom);
    if let (Some(cursor), Some(click)) = (response.interact_pointer_pos(), touch::click(ui, state, response)) {
        if !state.picking_focus && click == Click::Plain && mark_pick::click(state, live, [image, panel], cursor) {
            return image;
        }
        let at = (cursor - image.min) / zoom;
        if at.x >= 0.0 && at.y >= 0.0 && at.x < size.x && at.y < size.y {
            if state.picking_focus {
                (state.picking_focus, state.focus_on) = (false, Some([at.x as u32, at.y as u32]));
            } else {
                state.select_pixel(at.x as i64, at.y as i64);
            }
        }
    }
    image
}

fn fit_zoom(size: Vec2, panel: Rect) -> f32 {
    let room = (panel.size() - vec2(16.0, 16.0)).max(vec2(16.0, 16.0));
    let zoom = (room.x / size.x).min(room.y / size.y);
    // Whole multiples keep the pixels even, where they cost little room.
    if zoom > 3.0 { zoom.floor() } else { zoom }
}
