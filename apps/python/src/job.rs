//! A job on the threads of the pool, while the calling thread follows it: it makes the caller's callback, and
//! looks whether Python has received a signal (Ctrl-C).
//!
//! The calling thread goes on as soon as the job is cancelled and has had a moment to stop. What a face or a
//! reader still does then ends by itself, and its result is dropped.

use crate::errors::of_input;
use crate::pool::pool;
use chordal::{Cancel, Error, Phase};
use pyo3::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

/// How often the calling thread looks for signals.
const LOOK: Duration = Duration::from_millis(20);

/// How long a cancelled job may take to stop before the calling thread goes on without it.
const PATIENCE: Duration = Duration::from_millis(100);

/// Steps of a phase that the callback can tell apart.
const STEPS: f64 = 1000.0;

enum Message<T> {
    Progress(&'static str, f64),
    Done(Result<T, Error>),
}

/// What a job tells of itself.
pub struct Listener<T> {
    sender: Sender<Message<T>>,
    /// The latest phase and step, so that a step is told once.
    latest: AtomicU64,
    listens: bool,
}

impl<T> Listener<T> {
    /// A phase of the mesher is done to this fraction.
    pub fn tell(&self, phase: Phase, fraction: f64) {
        let name = match phase {
            Phase::Sewing => "sewing",
            Phase::Measuring => "measuring",
            Phase::Meshing => "meshing",
            Phase::Auditing => "auditing",
            _ => "working",
        };
        let step = ((phase as u64) << 32) | (fraction.clamp(0.0, 1.0) * STEPS) as u64;
        // Faces may be told out of order: an earlier step is no news.
        if self.listens && self.latest.fetch_max(step + 1, Ordering::Relaxed) < step + 1 {
            let _ = self.sender.send(Message::Progress(name, fraction));
        }
    }
}

/// Who starts a job and how.
pub struct Caller<'py> {
    pub py: Python<'py>,
    /// The name of the input in messages.
    pub input: String,
    /// `progress(phase, fraction)`; `False` cancels.
    pub progress: Option<Bound<'py, PyAny>>,
    /// Threads of the job's own; `None`: the pool of the process.
    pub threads: Option<usize>,
}

impl<'py> Caller<'py> {
    /// A job without progress.
    pub fn quiet(py: Python<'py>, input: &str) -> Self {
        Self { py, input: input.to_owned(), progress: None, threads: None }
    }

    /// Runs a job on the pool.
    ///
    /// # Errors
    /// Those of the job, those of the callback, `Cancelled`, and what a handler of signals raises.
    pub fn run<T: Send + 'static>(
        &self,
        cancel: &Cancel,
        work: impl FnOnce(Listener<T>) -> Result<T, Error> + Send + 'static,
    ) -> PyResult<T> {
        let (sender, receiver) = channel();
        let latest = AtomicU64::new(0);
        let listener = Listener { sender: sender.clone(), latest, listens: self.progress.is_some() };
        let pool = pool(self.threads)?;
        pool.spawn(move || {
            let done = catch_unwind(AssertUnwindSafe(|| work(listener))).unwrap_or_else(|panic| {
                let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
                let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
                Err(Error::Bug { message: text.unwrap_or_else(|| "a panic without a message".into()) })
            });
            let _ = sender.send(Message::Done(done));
        });
        self.follow(&Mutex::new(receiver), cancel)
    }

    fn follow<T: Send>(&self, receiver: &Mutex<Receiver<Message<T>>>, cancel: &Cancel) -> PyResult<T> {
        let receive = |wait| {
            self.py.detach(|| match receiver.lock() {
                Ok(receiver) => receiver.recv_timeout(wait),
                Err(_) => Err(RecvTimeoutError::Disconnected),
            })
        };
        loop {
            let event = match receive(LOOK) {
                Ok(Message::Done(done)) => return done.map_err(|error| of_input(&self.input, &error)),
                Ok(Message::Progress(phase, fraction)) => self.tell(phase, fraction),
                Err(RecvTimeoutError::Timeout) => self.py.check_signals(),
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(crate::errors::internal("a job ended without a result"));
                }
            };
            if let Err(error) = event {
                cancel.cancel();
                let until = Instant::now() + PATIENCE;
                let goes_on =
                    |event| matches!(event, Ok(Message::Progress(..)) | Err(RecvTimeoutError::Timeout));
                while Instant::now() < until && goes_on(receive(LOOK)) {}
                return Err(error);
            }
        }
    }

    /// Calls the callback.
    ///
    /// # Errors
    /// What it raises, and `Cancelled` where it returns `False`.
    pub fn tell(&self, phase: &str, fraction: f64) -> PyResult<()> {
        self.py.check_signals()?;
        let Some(progress) = &self.progress else { return Ok(()) };
        let goes_on = progress.call1((phase, fraction))?;
        let is_false = goes_on.extract::<bool>().is_ok_and(|goes_on| !goes_on);
        if is_false { Err(of_input(&self.input, &Error::Cancelled)) } else { Ok(()) }
    }
}
