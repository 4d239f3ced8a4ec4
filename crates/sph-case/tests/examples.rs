//! The example runs and finds what it expects.

#[path = "../examples/own_schema.rs"]
mod own_schema;

#[test]
fn a_schema_of_ones_own() {
    own_schema::main().unwrap();
}
