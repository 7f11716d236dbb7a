//! Camera, film and integrator.

use super::xml::Element;
use crate::engine::Job;
use crate::math::Vec3;

/// From this edge on Mitsuba would play roulette: never.
const NO_ROULETTE: u32 = 1_000_000;

/// What may be changed at the top of the file, or by `-D name=value`.
pub fn defaults(job: &Job, spp: u32, lets_through: bool) -> Vec<Element> {
    let default = |name: &str, value: String| Element::new("default").named(name).with("value", value);
    let [width, height] = job.size;
    vec![
        // `path` counts what alpha lets through as an edge, and its shadow rays stop there.
        default("integrator", if lets_through { "volpath" } else { "path" }.to_owned()),
        default("max_depth", job.settings.max_edges.to_string()),
        default("rr_depth", NO_ROULETTE.to_string()),
        default("spp", spp.to_string()),
        default("width", width.to_string()),
        default("height", height.to_string()),
    ]
}

/// The integrator: paths of at most K edges.
pub fn integrator() -> Element {
    Element::plugin("integrator", "$integrator").property("integer", "max_depth", "$max_depth").property("integer", "rr_depth", "$rr_depth")
}

/// The camera with its lens, and a film of box-filtered 32-bit radiance.
pub fn sensor(job: &Job) -> Element {
    let (camera, lens) = (job.posed_camera(), job.lens());
    let far = job.scene.sphere.radius + camera.position.length();
    let kind = if lens.radius > 0.0 { "thinlens" } else { "perspective" };
    let mut sensor = Element::plugin("sensor", kind)
        .property("string", "fov_axis", "y")
        .property("float", "fov", f64::from(camera.yfov).to_degrees())
        .property("float", "near_clip", 1e-4 * far)
        .property("float", "far_clip", 1e3 * far);
    if lens.radius > 0.0 {
        sensor = sensor
            .property("float", "aperture_radius", lens.radius)
            // What lies at infinity is sharp from there on too.
            .property("float", "focus_distance", lens.focus_distance.min(1e6 * far));
    }
    let film = Element::plugin("film", "hdrfilm")
        .property("integer", "width", "$width")
        .property("integer", "height", "$height")
        .property("string", "pixel_format", "rgb")
        .property("string", "component_format", "float32")
        .child(Element::plugin("rfilter", "box"));
    sensor.placed(looking(camera.axis, camera.up), camera.position).child(film).child(Element::plugin("sampler", "independent").property(
        "integer",
        "sample_count",
        "$spp",
    ))
}

/// Mitsuba's axes of what looks along `axis`: its +Z looks, its +X is to the left.
pub fn looking(axis: Vec3, up: Vec3) -> [Vec3; 3] {
    [up.cross(axis), up, axis]
}
