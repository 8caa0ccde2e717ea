//! How readily the plan leaves out what hardly shows.

/// The bounds of the rules that leave something out. Rules for what is not there at all need none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Skipping {
    /// A light counts as faint when what it lights is below this share of what another lights: only its disc is drawn.
    pub faint_share: f64,
    /// A light is not seen when it stands this many times lower than the lowest from which it could light air in view.
    pub unseen_depressions: f64,
    /// Discs narrower than this count as beams, rad.
    pub narrowest_disc_rad: f64,
    /// A disc counts as a beam where it stands more of its angular radii than this above the horizon: 1° for the sun.
    pub beam_above_radii: f64,
    /// Mountains, clouds and air are out of the picture where its lowest ray stays above this share of their height.
    pub out_of_view_share: f64,
    /// Optical depth of the air behind which nothing is seen of mountains: e^-18 is a fifty-millionth, and a layer as thick
    /// sends at least a few ten-thousandths of the light that falls on it back, or is black itself.
    pub hidden_depth: f64,
    /// The largest share of a pixel's light that was scattered more than once and is left out.
    pub thin_share: f64,
    /// How far light in a pixel may lag behind a moving light, relative; 0 where every frame is for itself.
    pub lag_share: f64,
}

impl Skipping {
    /// What no picture shows: `tests/skipping.rs` holds it against [`Skipping::NONE`].
    pub const USUAL: Self = Self {
        faint_share: 1e-4,
        unseen_depressions: 1.0,
        narrowest_disc_rad: 0.02 * std::f64::consts::PI / 180.0,
        beam_above_radii: 3.75,
        out_of_view_share: 1.0,
        hidden_depth: 18.0,
        thin_share: 0.005,
        lag_share: 0.0,
    };

    /// The same in sequences of frames: tables lag behind moving lights by what changes no pixel by more than half a per cent.
    pub const IN_SEQUENCE: Self = Self { lag_share: 0.005, ..Self::USUAL };

    /// Everything that is there is computed.
    pub const NONE: Self = Self {
        faint_share: 0.0,
        unseen_depressions: f64::INFINITY,
        narrowest_disc_rad: f64::MIN_POSITIVE,
        beam_above_radii: f64::INFINITY,
        out_of_view_share: f64::INFINITY,
        hidden_depth: f64::INFINITY,
        thin_share: 0.0,
        lag_share: 0.0,
    };
}
