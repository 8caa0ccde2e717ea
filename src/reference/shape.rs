//! Where matter can be and where rays end: a planet, an infinite slab or a box in empty space.

use glam::DVec3;

use super::line::Line;

/// The outline of a world. Coordinates are (east, north, up) in metres from a point on the ground (or any point).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A solid sphere that touches the origin from below, under a shell of air.
    Sphere {
        /// Distance from the centre to the ground, m.
        radius_m: f64,
        /// Altitude of the shell's top, m.
        height_m: f64,
    },
    /// An infinite horizontal ground at z = 0 under a layer of air.
    Plane {
        /// Thickness of the layer, m.
        height_m: f64,
    },
    /// A box without any ground.
    Box {
        /// Lowest corner, m.
        min_m: DVec3,
        /// Highest corner, m.
        max_m: DVec3,
    },
}

/// What a ray meets where it leaves the matter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The solid ground.
    Ground,
    /// Empty space.
    Space,
}

/// The part of a ray that lies in the shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Distance at which it enters, m.
    pub start_m: f64,
    /// Distance at which it leaves, m.
    pub end_m: f64,
    /// What is there.
    pub end: End,
}

impl Span {
    /// The part within a distance of the ray's start, at which a black surface stands; `None` when it stands before
    /// all matter.
    pub fn within(self, reach_m: f64) -> Option<Self> {
        if reach_m > self.end_m {
            return Some(self);
        }
        (reach_m > self.start_m).then_some(Self { end_m: reach_m, end: End::Space, ..self })
    }
}

impl Shape {
    /// Radius of curvature of the ground, m; infinite where there is no sphere.
    pub fn radius_m(&self) -> f64 {
        match *self {
            Self::Sphere { radius_m, .. } => radius_m,
            _ => f64::INFINITY,
        }
    }

    /// Height above the ground, m; above the lower face in a box.
    pub fn altitude(&self, p: DVec3) -> f64 {
        match *self {
            Self::Sphere { radius_m, .. } => {
                let growth = p.length_squared() + 2.0 * radius_m * p.z;
                growth / ((growth + radius_m * radius_m).max(0.0).sqrt() + radius_m)
            }
            Self::Plane { .. } => p.z,
            Self::Box { min_m, .. } => p.z - min_m.z,
        }
    }

    /// Unit vector to the zenith.
    pub fn up(&self, p: DVec3) -> DVec3 {
        match *self {
            Self::Sphere { radius_m, .. } => (p + DVec3::new(0.0, 0.0, radius_m)).normalize_or(DVec3::Z),
            _ => DVec3::Z,
        }
    }

    /// The ray from `p` along `d` as altitude against distance.
    pub fn line(&self, p: DVec3, d: DVec3) -> Line {
        Line::new(self.radius_m(), self.altitude(p), self.up(p).dot(d))
    }

    /// The part of the ray from `p` along the unit vector `d` inside the shape, or `None` when it misses.
    pub fn span(&self, p: DVec3, d: DVec3) -> Option<Span> {
        match *self {
            Self::Sphere { height_m, .. } | Self::Plane { height_m } => self.span_of_layer(p, d, height_m),
            Self::Box { min_m, max_m } => {
                let (start_m, end_m) = clip(p, d, min_m, max_m)?;
                Some(Span { start_m, end_m, end: End::Space })
            }
        }
    }

    fn span_of_layer(&self, p: DVec3, d: DVec3, height_m: f64) -> Option<Span> {
        let line = self.line(p, d);
        let above = self.altitude(p) > height_m;
        let start_m = if above { line.fall(height_m)? } else { 0.0 };
        if let Some(t) = line.fall(0.0) {
            return Some(Span { start_m, end_m: t.max(start_m), end: End::Ground });
        }
        let end_m = line.rise(height_m)?;
        (end_m > start_m).then_some(Span { start_m, end_m, end: End::Space })
    }

    /// Whether the ground stands between `p` and infinity along `d`.
    pub fn blocked(&self, p: DVec3, d: DVec3) -> bool {
        match self {
            Self::Box { .. } => false,
            _ => self.line(p, d).fall(0.0).is_some(),
        }
    }
}

/// Distances (≥ 0) between which the ray from `p` along `d` lies inside an axis-aligned box.
pub fn clip(p: DVec3, d: DVec3, min_m: DVec3, max_m: DVec3) -> Option<(f64, f64)> {
    let (mut start, mut end) = (0.0_f64, f64::INFINITY);
    for axis in 0..3 {
        if d[axis] == 0.0 {
            if p[axis] < min_m[axis] || p[axis] > max_m[axis] {
                return None;
            }
            continue;
        }
        let (a, b) = ((min_m[axis] - p[axis]) / d[axis], (max_m[axis] - p[axis]) / d[axis]);
        start = start.max(a.min(b));
        end = end.min(a.max(b));
    }
    (end > start).then_some((start, end))
}
