//! A journal of finished work: records in sections, appended now and then by a thread of its own, so that whoever
//! finishes work never waits for a disk. What is in it survives any death of the program; a torn end is cut off.

mod frame;
mod writer;

use frame::{Contents, Frame, Placed};
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use writer::Writer;

/// Payload at which a frame is closed, bytes.
const FRAME: usize = 4 << 20;
/// Records that wait for a slow disk, bytes; more are not kept.
const MOST_WAITING: usize = 64 << 20;

/// What stood in the file when a journal was opened.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Found {
    /// Nothing.
    Nothing,
    /// Records about the same thing.
    Records(u64),
    /// A journal about something else, or none at all: it counts as empty.
    Other,
}

/// A journal that is open for reading what was there and appending what comes.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    header: Vec<u8>,
    frames: Vec<Placed>,
    shared: Arc<Shared>,
    thread: Mutex<Option<JoinHandle<()>>>,
}

#[derive(Debug, Default)]
struct Shared {
    state: Mutex<State>,
    /// To the writer: there is something to do at once.
    wake: Condvar,
    /// From the writer: everything is in the file.
    idle: Condvar,
}

#[derive(Debug, Default)]
struct State {
    waiting: Vec<Frame>,
    /// Bytes in `waiting`.
    bytes: usize,
    /// Records in the file for good.
    kept: u64,
    /// Why no more are kept.
    trouble: Option<String>,
    writing: bool,
    hurry: bool,
    stop: bool,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Journal {
    /// Opens the journal at `path` about `key` (one line that says all that the records depend on).
    ///
    /// # Errors
    /// If a file is there that cannot be read and changed. A file that is not there is made with the first records.
    pub fn open(path: &Path, key: &str) -> io::Result<(Self, Found)> {
        let header = frame::header(key);
        let (contents, found) = look(path, key, &header)?;
        let kept = contents.frames.iter().map(|f| u64::from(f.records)).sum();
        let shared = Arc::new(Shared::default());
        shared.lock().kept = kept;
        let writer = Writer::new(path, header.clone(), &contents);
        let thread = {
            let shared = shared.clone();
            std::thread::Builder::new().name("journal".into()).spawn(move || writer.run(&shared))?
        };
        let journal =
            Self { path: path.into(), header, frames: contents.frames, shared, thread: Mutex::new(Some(thread)) };
        Ok((journal, found))
    }

    /// Removes a journal about `key`; leaves anything else.
    ///
    /// # Errors
    /// If there is a file that cannot be read or removed.
    pub fn forget(path: &Path, key: &str) -> io::Result<()> {
        let about = File::open(path).and_then(|file| frame::key(&file));
        match about {
            Ok(found) if found.as_deref() == Some(key) => fs::remove_file(path),
            Err(e) if e.kind() != io::ErrorKind::NotFound => Err(e),
            _ => Ok(()),
        }
    }

    /// Hands every record of a section that was there at the beginning to `take`. Frames that cannot be read any
    /// more are passed over.
    pub fn restore(&self, section: u64, take: &mut dyn FnMut(&[u8])) {
        let Ok(file) = File::open(&self.path) else { return };
        for placed in self.frames.iter().filter(|f| f.section == section) {
            if let Ok(Some(frame)) = frame::read_at(&file, &self.header, *placed) {
                frame::records(&frame.payload).for_each(&mut *take);
            }
        }
    }

    /// Keeps a record, soon. Never waits for the disk; a disk that cannot follow loses records.
    pub fn append(&self, section: u64, record: &[u8]) {
        let mut state = self.shared.lock();
        if state.trouble.is_some() || state.bytes + record.len() > MOST_WAITING {
            return;
        }
        match state.waiting.last_mut() {
            Some(f) if f.section == section && f.payload.len() < FRAME => f.push(record),
            _ => {
                let mut frame = Frame { section, ..Frame::default() };
                frame.push(record);
                state.waiting.push(frame);
            }
        }
        state.bytes += record.len();
        if state.bytes > MOST_WAITING / 4 && !state.hurry {
            state.hurry = true;
            self.shared.wake.notify_one();
        }
    }

    /// Brings everything into the file; returns how many records it holds.
    pub fn flush(&self) -> u64 {
        let mut state = self.shared.lock();
        state.hurry = true;
        self.shared.wake.notify_one();
        while !state.stop && (state.writing || !state.waiting.is_empty()) {
            state = self.shared.idle.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        state.kept
    }

    /// Why records are no longer kept, if so.
    pub fn trouble(&self) -> Option<String> {
        self.shared.lock().trouble.clone()
    }

    /// Ends the journal and removes its file: the work is done.
    pub fn discard(&self) {
        {
            let mut state = self.shared.lock();
            state.waiting.clear();
            state.bytes = 0;
        }
        self.end();
        let _ = fs::remove_file(&self.path);
    }

    /// Ends the writer after what is waiting is written.
    fn end(&self) {
        self.shared.lock().stop = true;
        self.shared.wake.notify_one();
        let thread = self.thread.lock().unwrap_or_else(PoisonError::into_inner).take();
        // A writer that panicked has told so already.
        let _ = thread.map(JoinHandle::join);
        self.shared.idle.notify_all();
    }
}

impl Drop for Journal {
    fn drop(&mut self) {
        self.end();
    }
}

/// The valid part of what is there; anything behind it is cut off, a foreign file is removed.
fn look(path: &Path, key: &str, header: &[u8]) -> io::Result<(Contents, Found)> {
    let file = match File::options().read(true).write(true).open(path) {
        Ok(file) => file,
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok((Contents::default(), Found::Nothing)),
        Err(e) => return Err(e),
    };
    if frame::key(&file)?.as_deref() != Some(key) {
        drop(file);
        fs::remove_file(path)?;
        return Ok((Contents::default(), Found::Other));
    }
    let contents = frame::scan(&file, header)?;
    file.set_len(contents.end)?;
    let records = contents.frames.iter().map(|f| u64::from(f.records)).sum();
    Ok((contents, if records == 0 { Found::Nothing } else { Found::Records(records) }))
}

#[cfg(test)]
mod tests;
