//! What a run tells of its progress, and whether it shall stop.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::error::ValidateError;

/// Told of the share of a run that is done; says when the user has interrupted.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    tell: &'a (dyn Fn(f64) + Sync),
    interrupt: &'a AtomicBool,
}

static NEVER: AtomicBool = AtomicBool::new(false);

impl<'a> Watch<'a> {
    /// Tells `tell` and stops once `interrupt` is set.
    pub fn new(tell: &'a (dyn Fn(f64) + Sync), interrupt: &'a AtomicBool) -> Self {
        Self { tell, interrupt }
    }

    /// Tells nobody and never stops.
    pub fn silent() -> Watch<'static> {
        Watch { tell: &|_| (), interrupt: &NEVER }
    }

    /// Tells the share that is done, 0 to 1.
    pub fn tell(&self, share: f64) {
        (self.tell)(share);
    }

    /// An error once the user has interrupted: looked at in each step.
    ///
    /// # Errors
    /// [`ValidateError::Interrupted`].
    pub fn check(&self) -> Result<(), ValidateError> {
        if self.interrupt.load(Ordering::Relaxed) { Err(ValidateError::Interrupted) } else { Ok(()) }
    }
}
