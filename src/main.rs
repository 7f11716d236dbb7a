//! The program: a window, or the command line; in a page, a canvas.

#[cfg(not(target_arch = "wasm32"))]
fn main() -> std::process::ExitCode {
    use bdpt_explorer::cli::{self, Wanted};
    use bdpt_explorer::ui;
    let open = |wanted: &Wanted| {
        let source = match wanted {
            Wanted::Scene(scene) => scene.clone().map(ui::SceneSource::Named),
            Wanted::Link(link) => Some(ui::SceneSource::Link(link.clone())),
        };
        ui::run(source).map_err(|error| match error {
            ui::WindowError::NotOpened(why) => cli::NoWindow::NotOpened(why),
            ui::WindowError::Ended(why) => cli::NoWindow::Ended(why),
        })
    };
    cli::main(cli::Windows { open, follow: ui::link::still })
}

#[cfg(target_arch = "wasm32")]
fn main() {
    bdpt_explorer::ui::run();
}
