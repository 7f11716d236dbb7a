//! The program: a window, or the command line.

#[cfg(not(target_arch = "wasm32"))]
fn main() -> std::process::ExitCode {
    bdpt_explorer::cli::main(bdpt_explorer::ui::run)
}

#[cfg(target_arch = "wasm32")]
fn main() {}
