//! The command `usar`.

use std::process::ExitCode;

fn main() -> ExitCode {
    usar::main()
}
