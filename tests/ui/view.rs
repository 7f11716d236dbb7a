//! The image view: what it shows, in colours and in numbers.

use super::*;
