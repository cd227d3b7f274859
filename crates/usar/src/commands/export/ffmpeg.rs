//! Films, made by the program ffmpeg.

use std::io::{ErrorKind, Read};
use std::process::{Child, Command, Stdio};

use pictures::Pixels;

use crate::prelude::*;

/// Name of the program.
const PROGRAM: &str = "ffmpeg";

/// Fails at once if the program is missing.
pub(super) fn check_program() -> Result<(), Failure> {
    let tried = Command::new(PROGRAM).arg("-version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    match tried {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(Failure::input(format!("--out: `{PROGRAM} -version` ended with {status}"))),
        Err(error) if error.kind() == ErrorKind::NotFound => Err(Failure::input(format!(
            "--out: needs the program {PROGRAM}, which is not installed (or not on PATH); a .gif needs \
             nothing"
        ))),
        Err(error) => Err(Failure::input(format!("--out: {PROGRAM} cannot be run: {error}"))),
    }
}

/// Writes pictures as a film with this name and this number of pictures in a second.
pub(super) fn write(
    folder: &Path,
    name: &str,
    fps: u16,
    mut pictures: impl Iterator<Item = Result<Pixels, Failure>>,
) -> Result<(), Failure> {
    let Some(first) = pictures.next().transpose()? else { return Ok(()) };
    let (path, underway) = (folder.join(name), folder.join(format!("{name}.new")));
    let mut ffmpeg = start(&first, fps, &underway)?;
    let fed = feed(&mut ffmpeg, std::iter::once(Ok(first)).chain(pictures));
    let ended = end(ffmpeg);
    let done = fed.and(ended).and_then(|()| {
        let placed = std::fs::rename(&underway, &path);
        placed.map_err(|error| Failure::storage(format!("cannot write {}: {error}", path.display())))
    });
    if done.is_err() {
        let _ = std::fs::remove_file(&underway);
    }
    done
}

fn start(first: &Pixels, fps: u16, out: &Path) -> Result<Child, Failure> {
    let size = format!("{}x{}", first.width, first.height);
    let rate = fps.to_string();
    let input = ["-f", "rawvideo", "-pix_fmt", "rgba", "-s", &size, "-r", &rate, "-i", "-"];
    // Players require an even number of pixels on each side.
    let even = "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white";
    let output =
        ["-vf", even, "-c:v", "libx264", "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4", "-y"];
    let started = Command::new(PROGRAM)
        .args(["-hide_banner", "-loglevel", "error"])
        .args(input)
        .args(output)
        .arg(out)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn();
    started.map_err(|error| Failure::run(format!("--out: {PROGRAM} cannot be run: {error}")))
}

fn feed(ffmpeg: &mut Child, pictures: impl Iterator<Item = Result<Pixels, Failure>>) -> Result<(), Failure> {
    let Some(mut pipe) = ffmpeg.stdin.take() else { return Ok(()) };
    for picture in pictures {
        match pipe.write_all(&picture?.rgba) {
            Ok(()) => {}
            Err(error) if error.kind() == ErrorKind::BrokenPipe => return Ok(()), // its exit status says why
            Err(error) => return Err(Failure::run(format!("--out: {PROGRAM} takes no pictures: {error}"))),
        }
    }
    Ok(())
}

fn end(mut ffmpeg: Child) -> Result<(), Failure> {
    let mut said = String::new();
    if let Some(mut pipe) = ffmpeg.stderr.take() {
        let _ = pipe.read_to_string(&mut said);
    }
    let status = ffmpeg.wait().map_err(|error| Failure::run(format!("--out: {PROGRAM}: {error}")))?;
    if status.success() {
        return Ok(());
    }
    let said = said.lines().last().unwrap_or("it said nothing").trim();
    Err(Failure::run(format!("--out: {PROGRAM} ended with {status}: {said}")))
}
