//! Where the froxels of a host's lie.

/// Columns over the picture, and slices at distances before the camera, of froxels that a host asks for. Slices lie along each column's
/// ray: the first at the camera, the last at the far end, evenly near the camera and by a factor far from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FroxelGrid {
    /// Columns, rows and slices; at least two slices.
    pub size: [u32; 3],
    /// The distance up to which slices lie about evenly, m: above 0.
    pub near_m: f64,
    /// The distance of the last slice, m: above 0. What lies behind it is not known.
    pub far_m: f64,
}

impl FroxelGrid {
    /// The binary logarithm of the factor between slices that are far: slice k lies at near (2^(k times this) - 1).
    pub fn log_growth(&self) -> f64 {
        (1.0 + self.far_m / self.near_m).log2() / f64::from(self.size[2] - 1)
    }

    /// The distance of a slice, m.
    pub fn distance_m(&self, slice: u32) -> f64 {
        self.near_m * ((f64::from(slice) * self.log_growth()).exp2() - 1.0)
    }

    /// Where a distance along a ray, m, lies in the images: their third texture coordinate, in ]0, 1[. Between two slices it is in
    /// proportion to the distance, as light is that even air sends.
    pub fn coordinate(&self, distance_m: f64) -> f64 {
        let growth = self.log_growth();
        let at = (1.0 + distance_m.clamp(0.0, self.far_m) / self.near_m).log2() / growth;
        let between = ((growth * at.fract()).exp2() - 1.0) / (growth.exp2() - 1.0);
        (at.floor() + between + 0.5) / f64::from(self.size[2])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRID: FroxelGrid = FroxelGrid { size: [8, 4, 32], near_m: 20.0, far_m: 50_000.0 };

    #[test]
    fn slices_go_from_the_camera_to_the_far_end_and_coordinates_are_their_texels_middles() {
        assert_eq!(GRID.distance_m(0), 0.0);
        assert!((GRID.distance_m(31) / 50_000.0 - 1.0).abs() < 1e-12);
        for slice in 0..32 {
            let middle = (f64::from(slice) + 0.5) / 32.0;
            assert!((GRID.coordinate(GRID.distance_m(slice)) - middle).abs() < 1e-12, "{slice}");
        }
    }

    #[test]
    fn between_two_slices_coordinates_are_in_proportion_to_the_distance() {
        let [before, behind] = [GRID.distance_m(7), GRID.distance_m(8)];
        let expected = (7.25 + 0.5) / 32.0;
        assert!((GRID.coordinate(before + 0.25 * (behind - before)) - expected).abs() < 1e-12);
    }

    #[test]
    fn what_lies_behind_the_last_slice_is_read_from_it() {
        assert_eq!(GRID.coordinate(1e9), GRID.coordinate(50_000.0));
        assert_eq!(GRID.coordinate(-1.0), GRID.coordinate(0.0));
    }
}
