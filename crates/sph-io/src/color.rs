//! Colors, and the order in which curves take them.

/// A color of eight bits a channel (sRGB).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Color {
    /// Red.
    pub red: u8,
    /// Green.
    pub green: u8,
    /// Blue.
    pub blue: u8,
}

impl Color {
    /// Black.
    pub const BLACK: Self = Self::rgb(0, 0, 0);
    /// White.
    pub const WHITE: Self = Self::rgb(255, 255, 255);
    /// A gray for what stands behind the data.
    pub const GRAY: Self = Self::rgb(120, 120, 120);

    /// Colors of successive curves, told apart by color-blind readers too: the palette of Okabe and Ito (2002),
    /// without its yellow, which is hard to see on white.
    pub const CYCLE: [Self; 7] = [
        Self::rgb(0, 114, 178),
        Self::rgb(213, 94, 0),
        Self::rgb(0, 158, 115),
        Self::rgb(204, 121, 167),
        Self::rgb(86, 180, 233),
        Self::rgb(230, 159, 0),
        Self::BLACK,
    ];

    /// A color from its three channels.
    #[must_use]
    pub const fn rgb(red: u8, green: u8, blue: u8) -> Self {
        Self { red, green, blue }
    }

    /// The color of the `idx`-th curve.
    #[must_use]
    pub const fn cycle(idx: usize) -> Self {
        Self::CYCLE[idx % Self::CYCLE.len()]
    }
}
