//! Why the GPU does not render: what happened, and what it means for the user.

use std::fmt;

/// Why the GPU does not render. Every message is one sentence that ends before what is done instead.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum GpuError {
    /// There is no adapter at all.
    NoAdapter(String),
    /// There is one, but it cannot run compute shaders of this size.
    CannotCompute {
        /// Its name.
        adapter: String,
        /// What it lacks.
        lacks: String,
    },
    /// Only a software adapter is there, and nobody asked for it.
    SoftwareOnly(String),
    /// The adapter gives no device.
    NoDevice(String),
    /// A shader does not compile: where and why.
    Shader(String),
    /// There is no thread to compile kernels on.
    NoThread,
    /// Something needs more than the device allows or has.
    TooLarge {
        /// What.
        what: &'static str,
        /// Bytes needed.
        need: u64,
        /// Bytes allowed.
        have: u64,
    },
    /// The device ran out of memory.
    OutOfMemory(&'static str),
    /// The device is gone.
    Lost(String),
    /// A traversal needed a deeper stack than the tree promised, or the driver stopped a loop: the result is not to be used.
    WrongResult(&'static str),
    /// The graphics interface refused a call.
    Refused(String),
}

impl fmt::Display for GpuError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoAdapter(why) => write!(f, "there is no graphics adapter for compute shaders ({why})"),
            Self::CannotCompute { adapter, lacks } => write!(f, "the graphics adapter {adapter} lacks {lacks}"),
            Self::SoftwareOnly(adapter) => {
                write!(f, "the only graphics adapter is {adapter}, which runs on the processor: the CPU renderer is faster")
            }
            Self::NoDevice(why) => write!(f, "the graphics adapter gives no device: {why}"),
            Self::Shader(message) => write!(f, "a shader does not compile: {message}"),
            Self::NoThread => write!(f, "there is no thread to compile its kernels on"),
            Self::TooLarge { what, need, have } => {
                let mib = |bytes: &u64| bytes.div_ceil(1 << 20);
                write!(f, "{what} would take {} MiB of graphics memory, {} MiB are allowed", mib(need), have >> 20)
            }
            Self::OutOfMemory(what) => write!(f, "the graphics adapter has no memory left for {what}"),
            Self::Lost(why) => write!(f, "the graphics device was lost ({why})"),
            Self::WrongResult(what) => write!(f, "the graphics adapter computed wrongly: {what}"),
            Self::Refused(message) => {
                write!(f, "the graphics interface refused a call: {}", message.split_whitespace().collect::<Vec<_>>().join(" "))
            }
        }
    }
}

impl std::error::Error for GpuError {}
