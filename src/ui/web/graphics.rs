//! What the browser can draw with, and how the window is told to.

use super::page;
use crate::ui::drawn::{Drawn, Draws, Why, Wish};
use eframe::wgpu::{self, Backends};
use eframe::{WebOptions, egui_wgpu};
use js_sys::{Function, Promise, Reflect};
use std::sync::Arc;
use wasm_bindgen::{JsCast, JsValue};
use wasm_bindgen_futures::JsFuture;

/// What to draw the window with.
pub async fn choose(wish: Wish) -> Drawn {
    let why = if wish == Wish::WebGl { Some(Why::Asked) } else { webgpu().await.err() };
    let by = if why.is_none() { Draws::WebGpu } else { Draws::WebGl };
    Drawn::new(by, why, wish)
}

/// Does the browser give an adapter?
async fn webgpu() -> Result<(), Why> {
    let window = page::window().ok_or(Why::NoWebGpu)?;
    let gpu = Reflect::get(&window.navigator(), &"gpu".into()).unwrap_or(JsValue::UNDEFINED);
    if gpu.is_undefined() || gpu.is_null() {
        return Err(if window.is_secure_context() { Why::NoWebGpu } else { Why::NotSecure });
    }
    let request = Reflect::get(&gpu, &"requestAdapter".into()).ok().and_then(|value| value.dyn_into::<Function>().ok());
    let promise = request.and_then(|request| request.call0(&gpu).ok()).and_then(|value| value.dyn_into::<Promise>().ok());
    let adapter = JsFuture::from(promise.ok_or(Why::NoWebGpu)?).await.unwrap_or(JsValue::NULL);
    if adapter.is_null() || adapter.is_undefined() { Err(Why::Refused) } else { Ok(()) }
}

/// The options of a window that is drawn with `by`.
pub fn options(by: Draws) -> WebOptions {
    let mut setup = egui_wgpu::WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.backends = match by {
        Draws::WebGpu => Backends::BROWSER_WEBGPU,
        Draws::WebGl => Backends::GL,
    };
    setup.device_descriptor = Arc::new(|adapter| wgpu::DeviceDescriptor {
        label: Some("window"),
        required_limits: limits(adapter.get_info().backend, &adapter.limits()),
        ..Default::default()
    });
    let wgpu_options = egui_wgpu::WgpuConfiguration { wgpu_setup: setup.into(), ..Default::default() };
    WebOptions { wgpu_options, ..Default::default() }
}

/// No more than the adapter has: a phone's largest texture may be smaller than a desktop's.
fn limits(backend: wgpu::Backend, adapter: &wgpu::Limits) -> wgpu::Limits {
    let usual = if backend == wgpu::Backend::Gl { wgpu::Limits::downlevel_webgl2_defaults() } else { wgpu::Limits::default() };
    wgpu::Limits { max_texture_dimension_2d: 8192, ..usual }.or_worse_values_from(adapter)
}
