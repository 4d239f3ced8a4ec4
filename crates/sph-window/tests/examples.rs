//! The examples run and find what they expect.

#[path = "../examples/body_in_stream.rs"]
mod body_in_stream;
#[path = "../examples/solid_copper.rs"]
mod solid_copper;

#[test]
fn a_plastic_shock_in_solid_copper() {
    solid_copper::main().unwrap();
}

#[test]
fn a_body_in_a_stream() {
    body_in_stream::main().unwrap();
}
