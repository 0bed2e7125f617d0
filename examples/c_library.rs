//! The archive behind `liblightbuffer.a` and `liblightbuffer.so`: nothing but the functions of `include/lightbuffer.h`.
//!
//! An example, since Cargo makes those out of the library as it is for everybody else: a library that is an archive too
//! would be compiled once more. `make c-library` builds it and makes both libraries of it.

pub use lightbuffer::c_interface::*;
