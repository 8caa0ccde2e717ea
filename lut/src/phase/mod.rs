//! Phase functions: how scattered light is spread over directions.
//!
//! Each is normalised, ∫P dω = 1, and takes cos θ, where θ is the angle between the directions in which the light
//! travels before and after: cos θ = 1 is forward.

mod cornette_shanks;
mod double_henyey_greenstein;
mod draine;
mod henyey_greenstein;
mod henyey_greenstein_draine;
mod inversion;
mod isotropic;
mod lobe;
mod monotone_cubic;
mod quadrature;
mod rayleigh;
mod schlick;
mod tabulated;

use std::sync::Arc;

pub use henyey_greenstein_draine::DropletFit;
pub use lobe::PhaseLobe;
pub use tabulated::TabulatedPhase;

/// A phase function P(cos θ), 1/sr.
#[derive(Debug, Clone, PartialEq)]
pub enum PhaseFunction {
    /// 1/4π (Premože 2003, eq. 1).
    Isotropic,
    /// Molecules (Premože 2003, eq. 5 without its λ⁻⁴, which belongs to b).
    Rayleigh,
    /// Henyey & Greenstein 1941 (Premože 2003, eq. 2).
    HenyeyGreenstein {
        /// Mean cosine, in ]-1, 1[.
        g: f64,
    },
    /// Two Henyey-Greenstein lobes, Kattawar 1975 (Premože 2003, eq. 3).
    DoubleHenyeyGreenstein {
        /// Share of the first lobe, in [0, 1]; Premože's f is 1 - weight.
        weight: f64,
        /// Mean cosine of the first lobe, in ]-1, 1[.
        g1: f64,
        /// Mean cosine of the second lobe, in ]-1, 1[.
        g2: f64,
    },
    /// Blasi, Le Saëc & Schlick 1993 (Premože 2003, eq. 4, with the sign of k turned: k > 0 is forward).
    Schlick {
        /// Asymmetry parameter, in ]-1, 1[; the mean cosine is smaller.
        k: f64,
    },
    /// Cornette & Shanks 1992 (Premože 2003, eq. 6).
    CornetteShanks {
        /// Asymmetry parameter, in ]-1, 1[; the mean cosine is larger.
        g: f64,
    },
    /// Draine 2003.
    Draine {
        /// Asymmetry parameter, in ]-1, 1[.
        g: f64,
        /// Strength of the 1 + α cos²θ term, at least 0.
        alpha: f64,
    },
    /// Water droplets by size, Jendersie & d'Eon 2023.
    HenyeyGreensteinDraine {
        /// Diameter of the droplets, in [5, 50] µm.
        droplet_diameter_um: f64,
    },
    /// A table, for instance from Mie theory.
    Tabulated(Arc<TabulatedPhase>),
}

/// Why a phase function cannot exist.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PhaseError {
    /// A parameter lies outside its domain.
    #[error("{parameter} is {value}; it must lie in {allowed}")]
    Domain {
        /// Name of the parameter.
        parameter: &'static str,
        /// The value refused.
        value: f64,
        /// The domain in words.
        allowed: &'static str,
    },
    /// One point of a table is impossible.
    #[error("phase function table, point {point}: {problem}")]
    TablePoint {
        /// Number of the point, from 1.
        point: usize,
        /// What is wrong and what is allowed.
        problem: String,
    },
    /// One line of a table's text is impossible.
    #[error("phase function table, line {line}: {problem}")]
    TableLine {
        /// Number of the line, from 1.
        line: usize,
        /// What is wrong and what is allowed.
        problem: String,
    },
    /// A table as a whole is impossible.
    #[error("phase function table: {problem}")]
    Table {
        /// What is wrong and what is allowed.
        problem: String,
    },
}

impl PhaseFunction {
    /// P(cos θ), 1/sr. `cos_theta` lies in [-1, 1].
    pub fn value(&self, cos_theta: f64) -> f64 {
        match *self {
            Self::Isotropic => isotropic::value(),
            Self::Rayleigh => rayleigh::value(cos_theta),
            Self::HenyeyGreenstein { g } => henyey_greenstein::value(g, cos_theta),
            Self::DoubleHenyeyGreenstein { weight, g1, g2 } => {
                double_henyey_greenstein::value(weight, g1, g2, cos_theta)
            }
            Self::Schlick { k } => schlick::value(k, cos_theta),
            Self::CornetteShanks { g } => cornette_shanks::value(g, cos_theta),
            Self::Draine { g, alpha } => draine::value(g, alpha, cos_theta),
            Self::HenyeyGreensteinDraine { droplet_diameter_um } => {
                DropletFit::new(droplet_diameter_um).value(cos_theta)
            }
            Self::Tabulated(ref table) => table.value(cos_theta),
        }
    }

    /// Draws cos θ in proportion to P, from a uniform `u` in [0, 1[.
    ///
    /// Every function is inverted exactly (in closed form, or to rounding where there is none), so a path's weight
    /// is unchanged by it. A single lobe rises with u from -1 to 1; two lobes share u between them.
    pub fn sample(&self, u: f64) -> f64 {
        match *self {
            Self::Isotropic => isotropic::sample(u),
            Self::Rayleigh => rayleigh::sample(u),
            Self::HenyeyGreenstein { g } => henyey_greenstein::sample(g, u),
            Self::DoubleHenyeyGreenstein { weight, g1, g2 } => double_henyey_greenstein::sample(weight, g1, g2, u),
            Self::Schlick { k } => schlick::sample(k, u),
            Self::CornetteShanks { g } => cornette_shanks::sample(g, u),
            Self::Draine { g, alpha } => draine::sample(g, alpha, u),
            Self::HenyeyGreensteinDraine { droplet_diameter_um } => DropletFit::new(droplet_diameter_um).sample(u),
            Self::Tabulated(ref table) => table.sample(u),
        }
    }

    /// Density per solid angle of the directions that [`Self::sample`] draws (with a uniform azimuth), 1/sr: P itself.
    pub fn pdf(&self, cos_theta: f64) -> f64 {
        self.value(cos_theta)
    }

    /// ∫P cos θ dω, in [-1, 1].
    pub fn mean_cosine(&self) -> f64 {
        self.legendre_moment(1)
    }

    /// χ_l = ∫P P_l(cos θ) dω with the Legendre polynomial P_l: 1 for l = 0, the mean cosine for l = 1.
    pub fn legendre_moment(&self, l: usize) -> f64 {
        match *self {
            Self::Isotropic => henyey_greenstein::legendre_moment(0.0, l),
            Self::Rayleigh => draine::legendre_moment(0.0, 1.0, l),
            Self::HenyeyGreenstein { g } => henyey_greenstein::legendre_moment(g, l),
            Self::DoubleHenyeyGreenstein { weight, g1, g2 } => {
                double_henyey_greenstein::legendre_moment(weight, g1, g2, l)
            }
            Self::Schlick { k } => schlick::legendre_moment(k, l),
            Self::CornetteShanks { g } => cornette_shanks::legendre_moment(g, l),
            Self::Draine { g, alpha } => draine::legendre_moment(g, alpha, l),
            Self::HenyeyGreensteinDraine { droplet_diameter_um } => {
                DropletFit::new(droplet_diameter_um).legendre_moment(l)
            }
            Self::Tabulated(ref table) => table.legendre_moment(l),
        }
    }

    /// Checks the parameters, so that what follows never has to. A table was checked when it was made.
    ///
    /// # Errors
    /// [`PhaseError::Domain`] with the parameter, its value and what is allowed.
    pub fn validate(&self) -> Result<(), PhaseError> {
        match *self {
            Self::Isotropic | Self::Rayleigh | Self::Tabulated(_) => Ok(()),
            Self::HenyeyGreenstein { g } | Self::CornetteShanks { g } => asymmetry("g", g),
            Self::DoubleHenyeyGreenstein { weight, g1, g2 } => {
                let weight_fits = (0.0..=1.0).contains(&weight);
                domain(weight_fits, "weight", weight, "[0, 1]")?;
                asymmetry("g1", g1)?;
                asymmetry("g2", g2)
            }
            Self::Schlick { k } => asymmetry("k", k),
            Self::Draine { g, alpha } => {
                asymmetry("g", g)?;
                domain(alpha >= 0.0 && alpha.is_finite(), "alpha", alpha, "[0, ∞[")
            }
            Self::HenyeyGreensteinDraine { droplet_diameter_um: d } => {
                domain((5.0..=50.0).contains(&d), "droplet_diameter_um", d, "[5, 50]")
            }
        }
    }
}

fn asymmetry(parameter: &'static str, value: f64) -> Result<(), PhaseError> {
    domain(value.abs() < 1.0, parameter, value, "]-1, 1[")
}

fn domain(fits: bool, parameter: &'static str, value: f64, allowed: &'static str) -> Result<(), PhaseError> {
    if fits { Ok(()) } else { Err(PhaseError::Domain { parameter, value, allowed }) }
}
