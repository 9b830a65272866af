//! Locks that outlive a panic: whatever they guard is written whole or not at all.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// Waits for what a lock guards.
pub fn held<T>(lock: &Mutex<T>) -> MutexGuard<'_, T> {
    lock.lock().unwrap_or_else(PoisonError::into_inner)
}
