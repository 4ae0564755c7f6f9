//! The thread that owns the journal's file.

use super::Shared;
use super::frame::{Contents, Frame};
use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::PoisonError;
use std::time::Duration;

/// Time between two visits to the disk: what is lost at most, beside what a slow disk still has to do.
const INTERVAL: Duration = Duration::from_secs(1);

pub(super) struct Writer {
    path: PathBuf,
    header: Vec<u8>,
    /// Made with the first frame.
    file: Option<File>,
    /// Bytes of the valid part.
    end: u64,
    /// Frames in it.
    frames: u32,
}

impl Writer {
    pub(super) fn new(path: &Path, header: Vec<u8>, contents: &Contents) -> Self {
        Self { path: path.into(), header, file: None, end: contents.end, frames: contents.frames.len() as u32 }
    }

    /// Writes what is waiting, now and then, until told to stop.
    pub(super) fn run(mut self, shared: &Shared) {
        loop {
            let (frames, stop) = next_work(shared);
            let result = self.append(&frames);
            let mut state = shared.lock();
            state.writing = false;
            match result {
                Ok(()) => state.kept += frames.iter().map(|f| u64::from(f.records)).sum::<u64>(),
                Err(e) => {
                    state.trouble = Some(format!("{}: {e}", self.path.display()));
                    state.waiting.clear();
                    state.bytes = 0;
                }
            }
            if state.waiting.is_empty() {
                shared.idle.notify_all();
                if stop {
                    return;
                }
            }
        }
    }

    /// Appends frames and waits until they are on the disk. After a failure the file ends where it ended before; a
    /// file without any frame is removed.
    fn append(&mut self, frames: &[Frame]) -> io::Result<()> {
        if frames.is_empty() {
            return Ok(());
        }
        let result = self.try_append(frames);
        if result.is_err() {
            let file = self.file.take();
            if self.frames == 0 {
                let _ = std::fs::remove_file(&self.path);
            } else if let Some(file) = file {
                file.set_len(self.end)?;
            }
        }
        result
    }

    fn try_append(&mut self, frames: &[Frame]) -> io::Result<()> {
        let header = &self.header;
        let file = match &mut self.file {
            Some(file) => file,
            none => {
                let mut file = File::options().create(true).truncate(false).write(true).open(&self.path)?;
                if self.end == 0 {
                    file.set_len(0)?;
                    file.write_all(header)?;
                    self.end = header.len() as u64;
                }
                file.seek(SeekFrom::Start(self.end))?;
                none.insert(file)
            }
        };
        let (mut end, mut number) = (self.end, self.frames);
        for frame in frames {
            let head = frame.head(header, number);
            file.write_all(&head)?;
            file.write_all(&frame.payload)?;
            end += (head.len() + frame.payload.len()) as u64;
            number += 1;
        }
        file.sync_data()?;
        (self.end, self.frames) = (end, number);
        Ok(())
    }
}

/// Waits until it is time to write, and takes what is waiting; true if it is the last time.
fn next_work(shared: &Shared) -> (Vec<Frame>, bool) {
    let mut state = shared.lock();
    while !(state.stop || state.hurry) {
        let (s, waited) = shared.wake.wait_timeout(state, INTERVAL).unwrap_or_else(PoisonError::into_inner);
        state = s;
        if waited.timed_out() && !state.waiting.is_empty() {
            break;
        }
    }
    state.hurry = false;
    state.writing = true;
    state.bytes = 0;
    (std::mem::take(&mut state.waiting), state.stop)
}
