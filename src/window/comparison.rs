//! A view beside its truth: starts the exposure, brings the real-time frame to it, and its pictures to the device.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use winit::event_loop::EventLoopProxy;

use super::app::Event;
use super::session::{Session, Tone};
use super::sky::Sky;
use super::truth::{Exposed, Truth};
use crate::gpu::{Gpu, GpuError, GpuImage, ImageShape, NextUse, ScreenEncoding};
use crate::output::{display, screen};
use crate::plan::{Outputs, Settings};
use crate::scene::Scene;
use welkin_lut::Bands;

static NUMBER: AtomicU64 = AtomicU64::new(0);

/// The exposure of one view.
pub struct Comparison {
    scene: Arc<Scene>,
    size: [u32; 2],
    settings: Settings,
    /// How the screen wants its pictures.
    pub encoding: ScreenEncoding,
    /// Tells its news from those of earlier ones.
    pub number: u64,
    /// Truth and difference, as far as they have come.
    pub images: Option<[GpuImage; 2]>,
    _truth: Truth,
}

impl Comparison {
    /// Whether it is of this view.
    pub fn is_of(&self, scene: &Arc<Scene>, size: [u32; 2], settings: Settings) -> bool {
        (&self.scene, self.size, self.settings) == (scene, size, settings)
    }

    /// Starts the exposure of what a window of so many pixels shows.
    pub fn start(session: &Session, size: [u32; 2], sky: &Sky, proxy: &EventLoopProxy<Event>) -> Self {
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let traced = session.scene_of_size(size, session.kept.truth_scale);
        let upload = sky.handle();
        let to_window = proxy.clone();
        let encoding = session.encoding;
        let headroom = if encoding == ScreenEncoding::Srgb { 1.0 } else { screen::HEADROOM };
        let truth = Truth::start(traced.clone(), headroom, move |exposed| {
            let to_window = to_window.clone();
            let exposed = match exposed {
                Ok(exposed) => exposed,
                Err(error) => return drop(to_window.send_event(Event::NoTruth(number, error.to_string()))),
            };
            upload.between(move |renderer| {
                let event = match images(renderer.gpu(), &exposed, encoding) {
                    Ok(images) => Event::Truth(number, images, exposed.state),
                    Err(error) => Event::Said(Tone::Failed, error.to_string()),
                };
                let _ = to_window.send_event(event);
            });
        });
        let (real_time, settings) = (truth.real_time(), session.settings());
        sky.capture(traced, settings, Outputs::default(), move |rendered| {
            if let (Ok(rendered), Ok(mut slot)) = (rendered, real_time.lock()) {
                *slot = Some(rendered.frame);
            }
        });
        let scene = session.document.scene().clone();
        Self { scene, size, settings, encoding, number, images: None, _truth: truth }
    }
}

/// Truth and difference on the device; before there is a difference, the truth stands for it.
fn images(gpu: &Gpu, exposed: &Exposed, encoding: ScreenEncoding) -> Result<[GpuImage; 2], GpuError> {
    let [width, height] = exposed.size;
    let upload = |name: &str, linear: &[Bands]| {
        let image = gpu.image(name, ImageShape::D2(width, height), encoding.image_format())?;
        gpu.write_image(&image, &texels(linear, encoding))?;
        let mut commands = gpu.record("upload")?;
        commands.leave_for(&image, NextUse::Copy);
        commands.submit_and_wait()?;
        Ok(image)
    };
    let truth = upload("truth", &exposed.truth)?;
    let difference = match &exposed.difference {
        Some(linear) => upload("difference", linear)?,
        None => truth.clone(),
    };
    Ok([truth, difference])
}

/// Linear sRGB as the bytes of texels.
fn texels(linear: &[Bands], encoding: ScreenEncoding) -> Vec<u8> {
    let half = |band: f64| half::f16::from_f64(band).to_ne_bytes();
    let halves = |encoded: Bands| encoded.into_iter().chain([1.0]).flat_map(half).collect::<Vec<u8>>();
    let texel = |&linear: &Bands| match encoding {
        ScreenEncoding::Srgb => {
            let [red, green, blue] = linear.map(|band| (255.0 * display::srgb_encoded(band)).round() as u8);
            vec![red, green, blue, 255]
        }
        ScreenEncoding::ExtendedLinear => halves(screen::extended_linear(linear)),
        ScreenEncoding::Hdr10 => halves(screen::hdr10(linear)),
    };
    linear.iter().flat_map(texel).collect()
}
