//! How to run things: validation, benches, documentation, tidiness.

fn main() {}
