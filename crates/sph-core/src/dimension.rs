//! Two and three dimensions from one source.
//!
//! [`Dimension`] is a sealed trait with the associated types that differ between plane strain ([`Dim2`]) and space
//! ([`Dim3`]). Everything that depends on the number of dimensions is written against it; there is no `cfg` by
//! dimension anywhere. Binaries match the dimension once, at the top.
//!
//! Two views of a vector exist side by side: the `glam` vector of the public interface ([`Dimension::Vector`]) and the
//! plain array of components ([`Dimension::Axes`]), generic in what a component is: a number, a column of numbers
//! (structure of arrays) or eight lanes of a register.
//!
//! Symmetric 3 × 3 tensors keep the components that can differ from zero: `xx, yy, zz, xy` in plane strain and
//! `xx, yy, zz, xy, yz, zx` in space ([`Dimension::Tensor`]).

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Index, IndexMut, Mul, Neg, Sub, SubAssign};

use glam::{DVec2, DVec3};

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Dim2 {}
    impl Sealed for super::Dim3 {}
}

/// What a component can be: a number, or lanes of a register.
pub trait Value: Copy + Debug + Send + Sync {}
impl<T: Copy + Debug + Send + Sync> Value for T {}

/// A fixed number of equal things, one per axis or one per tensor component.
pub trait Components<T>:
    Index<usize, Output = T> + IndexMut<usize, Output = T> + AsRef<[T]> + AsMut<[T]> + Sized
{
    /// Number of components.
    const COUNT: usize;
    /// Builds the components from their index.
    fn from_fn(component: impl FnMut(usize) -> T) -> Self;
    /// The same in every component. Pair loops start from this and fill components in plain loops: closures would not
    /// always be compiled into them.
    fn splat(value: T) -> Self
    where
        T: Copy;
}

impl<T, const N: usize> Components<T> for [T; N] {
    const COUNT: usize = N;
    #[inline(always)]
    fn from_fn(component: impl FnMut(usize) -> T) -> Self {
        std::array::from_fn(component)
    }
    #[inline(always)]
    fn splat(value: T) -> Self
    where
        T: Copy,
    {
        [value; N]
    }
}

/// What the code needs of a vector: `glam::DVec2` and `glam::DVec3` fit. Write `v * s`, not `s * v`.
pub trait Vector:
    Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Mul<f64, Output = Self>
    + AddAssign
    + SubAssign
    + Index<usize, Output = f64>
    + IndexMut<usize, Output = f64>
{
    /// Scalar product.
    fn dot(self, other: Self) -> f64;
    /// Euclidean length.
    fn length(self) -> f64 {
        self.dot(self).sqrt()
    }
}

impl Vector for DVec2 {
    #[inline]
    fn dot(self, other: Self) -> f64 {
        DVec2::dot(self, other)
    }
}

impl Vector for DVec3 {
    #[inline]
    fn dot(self, other: Self) -> f64 {
        DVec3::dot(self, other)
    }
}

/// Plane strain or space. Sealed: [`Dim2`] and [`Dim3`] are the only ones.
pub trait Dimension:
    sealed::Sealed + Copy + Clone + Debug + Default + PartialEq + Send + Sync + 'static
{
    /// Number of space dimensions.
    const COUNT: usize;
    /// Number of stored components of a symmetric 3 × 3 tensor: 4 in plane strain, 6 in space.
    const TENSOR_COUNT: usize;
    /// Axes (row, column) of each stored tensor component, in storage order.
    const TENSOR_AXES: &'static [(usize, usize)];
    /// A vector of the public interface.
    type Vector: Vector;
    /// One `T` per axis.
    type Axes<T: Value>: Components<T> + Value;
    /// One `T` per stored component of a symmetric 3 × 3 tensor.
    type Tensor<T: Value>: Components<T> + Value;
    /// One column of numbers per axis.
    type AxisColumns: Components<Vec<f64>> + Clone + Debug + PartialEq + Send + Sync;
    /// One column of numbers per stored component of a symmetric 3 × 3 tensor.
    type TensorColumns: Components<Vec<f64>> + Clone + Debug + PartialEq + Send + Sync;

    /// Vector from a function of the axis.
    fn vector(component: impl FnMut(usize) -> f64) -> Self::Vector;
    /// Storage index of tensor component (a, b), `a` and `b` in 0..3; `None` where it is zero in plane strain.
    fn tensor_index(a: usize, b: usize) -> Option<usize> {
        Self::TENSOR_AXES.iter().position(|&(r, c)| (r, c) == (a, b) || (r, c) == (b, a))
    }
}

/// Plane strain in (x, y).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dim2;

/// Space (x, y, z).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dim3;

impl Dimension for Dim2 {
    const COUNT: usize = 2;
    const TENSOR_COUNT: usize = 4;
    const TENSOR_AXES: &'static [(usize, usize)] = &[(0, 0), (1, 1), (2, 2), (0, 1)];
    type Vector = DVec2;
    type Axes<T: Value> = [T; 2];
    type Tensor<T: Value> = [T; 4];
    type AxisColumns = [Vec<f64>; 2];
    type TensorColumns = [Vec<f64>; 4];

    #[inline(always)]
    fn vector(mut component: impl FnMut(usize) -> f64) -> DVec2 {
        DVec2::new(component(0), component(1))
    }
}

impl Dimension for Dim3 {
    const COUNT: usize = 3;
    const TENSOR_COUNT: usize = 6;
    const TENSOR_AXES: &'static [(usize, usize)] = &[(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)];
    type Vector = DVec3;
    type Axes<T: Value> = [T; 3];
    type Tensor<T: Value> = [T; 6];
    type AxisColumns = [Vec<f64>; 3];
    type TensorColumns = [Vec<f64>; 6];

    #[inline(always)]
    fn vector(mut component: impl FnMut(usize) -> f64) -> DVec3 {
        DVec3::new(component(0), component(1), component(2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tensor_components_are_found_by_either_order_of_axes() {
        for (k, &(a, b)) in Dim3::TENSOR_AXES.iter().enumerate() {
            assert_eq!(Dim3::tensor_index(a, b), Some(k));
            assert_eq!(Dim3::tensor_index(b, a), Some(k));
        }
        assert_eq!(Dim2::tensor_index(0, 2), None, "no shear out of the plane in plane strain");
    }
}
