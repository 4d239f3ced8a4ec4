//! The examples run.

#[path = "../examples/kernel_sum.rs"]
mod kernel_sum;

#[test]
fn kernel_sum_runs() {
    kernel_sum::main();
}
