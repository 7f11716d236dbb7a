//! Reading a file whole, if it is one.

use std::io::{Error, Result};
use std::path::Path;

/// Longest file that is read, bytes.
const LONGEST: u64 = 4 << 30;

/// The bytes of a regular file: a device or a pipe might never end.
///
/// # Errors
/// If it cannot be read, is no regular file, or is longer than 4 GiB.
pub fn whole(path: &Path) -> Result<Vec<u8>> {
    let metadata = std::fs::metadata(path)?;
    if !metadata.is_file() {
        return Err(Error::other("it is no regular file"));
    }
    if metadata.len() > LONGEST {
        return Err(Error::other("it is longer than 4 GiB"));
    }
    std::fs::read(path)
}
