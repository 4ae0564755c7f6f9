//! Ctrl-C and SIGTERM at any moment: what is unfinished goes, what can be kept is kept, one message says so.

use super::console::Console;
use super::exit::Failure;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Keeps what can be kept, and says what that is.
type LastAct = Box<dyn Fn() -> String + Send>;

static LAST_ACT: Mutex<Option<LastAct>> = Mutex::new(None);
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// While this lives, an interruption begins with the act given to [`before_dying`].
pub struct Armed(());

/// What is to be done first when the program is interrupted; the answer follows "interrupted: ".
pub fn before_dying(act: impl Fn() -> String + Send + 'static) -> Armed {
    *LAST_ACT.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(act));
    Armed(())
}

impl Drop for Armed {
    fn drop(&mut self) {
        LAST_ACT.lock().unwrap_or_else(PoisonError::into_inner).take();
    }
}

/// Returns at once, or never if the program is being interrupted: the thread that does that has the last word.
pub fn give_way() {
    while INTERRUPTED.load(Ordering::SeqCst) {
        std::thread::park();
    }
}

/// The last moments: `signal` as the system numbers it; returns the exit code.
#[cfg_attr(not(unix), allow(dead_code))]
fn end(signal: i32, console: &Console) -> u8 {
    INTERRUPTED.store(true, Ordering::SeqCst);
    crate::io::abandon();
    let act = LAST_ACT.lock().unwrap_or_else(PoisonError::into_inner).take();
    let kept = act.map_or("nothing was written".into(), |act| act());
    crate::io::end_claims();
    let code = 128 + u8::try_from(signal).unwrap_or(0);
    console.failure(&Failure { code, ..Failure::input(format!("interrupted: {kept}")) });
    code
}

/// Watches for signals from now on. A second one ends the program at once, whatever it is doing.
#[cfg(unix)]
pub fn watch(console: Arc<Console>) {
    use signal_hook::consts::{SIGINT, SIGTERM, SIGXFSZ};
    use signal_hook::{flag, iterator::Signals, low_level};

    static ONCE: std::sync::Once = std::sync::Once::new();
    ONCE.call_once(|| {
        let second = Arc::new(AtomicBool::new(false));
        let register = || -> std::io::Result<Signals> {
            for signal in [SIGINT, SIGTERM] {
                flag::register_conditional_shutdown(signal, 128 + signal, second.clone())?;
                flag::register(signal, second.clone())?;
            }
            // A file that grows too large is an error of writing, not the end.
            flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)))?;
            Signals::new([SIGINT, SIGTERM])
        };
        // Where signals cannot be watched they end the program as they always do.
        let Ok(mut signals) = register() else { return };
        let wait = move || {
            if let Some(signal) = signals.forever().next() {
                // Whatever goes wrong in the last moments, they have to end.
                let last = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| end(signal, &console)));
                low_level::exit(last.map_or(128 + signal, i32::from));
            }
        };
        let _ = std::thread::Builder::new().name("signals".into()).spawn(wait);
    });
}

/// Elsewhere the system ends the program; the next run clears up and goes on.
#[cfg(not(unix))]
pub fn watch(_: Arc<Console>) {}
