//! The program: a window, or the command line; in a page, a canvas.

#[cfg(not(target_arch = "wasm32"))]
fn main() -> std::process::ExitCode {
    use bdpt_explorer::{cli, ui};
    cli::main(|scene| {
        ui::run(scene).map_err(|error| match error {
            ui::WindowError::NotOpened(why) => cli::NoWindow::NotOpened(why),
            ui::WindowError::Ended(why) => cli::NoWindow::Ended(why),
        })
    })
}

#[cfg(target_arch = "wasm32")]
fn main() {
    bdpt_explorer::ui::run();
}
