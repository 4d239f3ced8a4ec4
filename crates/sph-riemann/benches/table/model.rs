//! How many operations the pair loops do: counted in the source, a fused multiply-add as two.
//!
//! d axes, s components of a symmetric matrix, d + s reconstructed fields; a product of a symmetric matrix and a vector
//! takes d (2d - 1). Divisions and roots count as one: what they take longer is part of what is measured.

/// Operations of the pair loops of a particle-step with the given number of listed neighbors: gradients once for each of
/// two particles, contacts once a pair. Without reconstruction, contacts alone.
pub fn operations(d: usize, neighbors: f64, reconstructs: bool) -> f64 {
    if reconstructs {
        neighbors * gradient(d) + 0.5 * neighbors * contact(d, true)
    } else {
        0.5 * neighbors * contact(d, false)
    }
}

fn symmetric(d: usize) -> usize {
    d * (d + 1) / 2
}

/// One neighbor of one particle in the first pass.
fn gradient(d: usize) -> f64 {
    let (s, dot) = (symmetric(d), 2 * d - 1);
    let geometry = d + dot + 2 + 6 + 2 + d;
    (geometry + 2 * s + (d + s) + 2 * d * (d + s)) as f64
}

/// One pair in the contact pass, for both of its particles.
fn contact(d: usize, reconstructs: bool) -> f64 {
    let (s, dot) = (symmetric(d), 2 * d - 1);
    let times = d * dot;
    let spin = d * (d - 1) / 2;
    let cross = if d == 2 { 4 } else { 12 };
    let geometry = d + dot + 2 + 6 + 3 + 1 + 3 * d;
    let reconstruction = (d + s) * (4 * d + 17) + d + 2 * times + 2 * d;
    let star = d + s + 7 + times + 2 * dot + 7 + 6 * d + times + 2 + 4 * d;
    let adjoint = 2 + 3 * s + 3 * spin + cross + times + 2 * d;
    let sums = 1 + d + dot + 3 * d + 3 * d * d + dot + 1 + d * d + d + 2;
    let always = geometry + star + sums;
    (if reconstructs { always + reconstruction + adjoint } else { always }) as f64
}
