//! Parse, run, exit code.

fn main() -> std::process::ExitCode {
    lightbuffer::cli::run()
}
