//! Streams packed with LZ4 and Zstandard.

use std::io::{self, Read};

#[cfg(any(feature = "arrow", feature = "mcap"))]
use lz4_flex::frame::FrameDecoder;
use ruzstd::decoding::StreamingDecoder;

/// The window of every usual setting of Zstandard, in bytes.
const USUAL_WINDOW: u64 = 8 << 20;

/// Unpacks an LZ4 frame, whose blocks have 4 MiB at most.
#[cfg(any(feature = "arrow", feature = "mcap"))]
pub(crate) fn lz4<'a>(packed: impl Read + 'a) -> impl Read + 'a {
    FrameDecoder::new(packed)
}

/// Unpacks a Zstandard frame of which this many bytes are wanted. The decoder holds as much as the frame says that it looks
/// back, all of it in the worst case, and that is no more than is wanted.
pub(crate) fn zstd<'a>(packed: impl Read + 'a, wanted: u64) -> io::Result<impl Read + 'a> {
    let window = wanted.saturating_add(64).max(USUAL_WINDOW);
    StreamingDecoder::new_with_max_window_size(packed, window).map_err(io::Error::other)
}
