//! The elements of a dataset as a stream of bytes, unpacked a window of rows at a time.

use std::io::{self, Read};

use super::tree::Dataset;

/// Bytes of one window; more where a single chunk is larger.
const WINDOW_BYTES: u64 = 1 << 20;

pub(super) struct Window<'a> {
    dataset: &'a dyn Dataset,
    rows: u64,
    at: u64,
    at_once: u64,
    bytes: Vec<u8>,
    used: usize,
}

impl<'a> Window<'a> {
    /// Of a dataset with these lengths of axes and of chunks, and elements of `width` bytes.
    pub(super) fn new(dataset: &'a dyn Dataset, dims: &[u64], chunk: &[u64], width: usize) -> Self {
        let (rows, row) = match dims {
            [] => (1, width as u64),
            [rows, row @ ..] => (
                *rows,
                row.iter().fold(width as u64, |n, &d| n.saturating_mul(d)),
            ),
        };
        // Whole chunks, so that none is unpacked twice.
        let chunk = chunk.first().copied().unwrap_or(1).max(1);
        let chunks = (WINDOW_BYTES / row.max(1) / chunk).max(1);
        Self {
            dataset,
            rows,
            at: 0,
            at_once: chunks.saturating_mul(chunk),
            bytes: Vec::new(),
            used: 0,
        }
    }
}

impl Read for Window<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.used == self.bytes.len() && self.at < self.rows {
            let now = self.at_once.min(self.rows - self.at);
            // Freed before the next window is made.
            self.bytes = Vec::new();
            self.bytes = self.dataset.rows(self.at, now).map_err(io::Error::other)?;
            self.used = 0;
            self.at += now;
        }
        let left = &self.bytes[self.used..];
        let now = left.len().min(buffer.len());
        buffer[..now].copy_from_slice(&left[..now]);
        self.used += now;
        Ok(now)
    }
}
