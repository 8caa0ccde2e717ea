//! The window's events.

mod actions;
mod demands;
mod input;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use demands::Asked;
use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoopProxy};
use winit::keyboard::ModifiersState;
use winit::window::{Window, WindowId};

use super::aim::Load;
use super::comparison::Comparison;
use super::document::Document;
use super::held::Held;
use super::interface::Interface;
use super::panel::{self, Schema};
use super::session::{PICTURE_FAULT, Session, Tone};
use super::settings::{self, Settings as Kept};
use super::sky::{News, Picture, Sky};
use super::watch::{Changed, Watch};
use super::wipe::Shown;
use super::{Options, WindowError};
use crate::goal::PassTimes;
use crate::gpu::{Gpu, GpuImage, Placed, Presenter};
use crate::passes::FRAME;
use crate::plan::LadderStep;

/// Time between two steps of a flight.
const TICK: Duration = Duration::from_millis(16);

/// Longest step: after a pause one does not jump.
const LONGEST_STEP_S: f64 = 0.1;

/// What other threads tell the window.
pub enum Event {
    /// From the sky.
    Sky(News),
    /// Files have been edited.
    Changed(Changed),
    /// Shaders were compiled, or not.
    Shaders(Result<(), String>),
    /// The truth has come further: its images, and its state in words.
    Truth(u64, [GpuImage; 2], String),
    /// There is none of this view.
    NoTruth(u64, String),
    /// What a step of the ladder takes on the device; none where it could not be measured.
    Measured(Load, LadderStep, Option<PassTimes>),
    /// Something was done or failed.
    Said(Tone, String),
}

/// The application, before and while its window is open.
pub struct App {
    options: Option<Options>,
    proxy: EventLoopProxy<Event>,
    /// Until the window is open.
    session: Option<Session>,
    open: Option<Open>,
    pictures: PathBuf,
    shaders: Option<PathBuf>,
    kept_in: Option<PathBuf>,
    /// Why it has to end.
    pub failure: Option<WindowError>,
}

/// An open window.
struct Open {
    session: Session,
    schema: Schema,
    held: Held,
    modifiers: ModifiersState,
    drag: Option<[f64; 2]>,
    pointer: [f64; 2],
    last_tick: Instant,
    /// When egui wants to be drawn again.
    panel_at: Option<Instant>,
    /// What was asked of the sky last.
    asked: Option<Asked>,
    picture: Option<Box<Picture>>,
    hidden: bool,
    /// Before this the panel leaves the device to the sky.
    draw_after: Instant,
    /// Whether the line between two pictures follows the pointer.
    drags_line: bool,
    comparison: Option<Comparison>,
    shaders: Option<PathBuf>,
    proxy: EventLoopProxy<Event>,
    watch: Watch,
    interface: Interface,
    presenter: Presenter,
    sky: Sky,
    window: Arc<Window>,
}

impl App {
    /// For a document; the window opens when the loop runs.
    pub fn new(options: Options, document: Document, proxy: EventLoopProxy<Event>) -> Self {
        let kept_in = settings::folder(options.settings.clone());
        let session = Session::new(document, Kept::load(kept_in.as_deref()), Instant::now());
        let (pictures, shaders) = (options.pictures.clone(), options.shaders.clone());
        let (options, session) = (Some(options), Some(session));
        Self { options, proxy, session, open: None, pictures, shaders, kept_in, failure: None }
    }

    fn open(&mut self, events: &ActiveEventLoop) -> Result<(), WindowError> {
        let (Some(options), Some(mut session)) = (self.options.take(), self.session.take()) else { return Ok(()) };
        let [width, height] = session.kept.size;
        let attributes = Window::default_attributes()
            .with_title(session.title())
            .with_inner_size(LogicalSize::new(width, height))
            .with_min_inner_size(LogicalSize::new(200.0, 120.0));
        let window = events.create_window(attributes).map_err(|error| WindowError::NoDisplay(error.to_string()))?;
        let window = Arc::new(window);
        let gpu = Gpu::for_window(&options.request, window.clone())?;
        (options.opened)(&gpu);
        session.device = gpu.info().name.clone();
        session.resolution.touch(Instant::now());
        let presenter = Presenter::new(&gpu)?;
        session.offers_above_white = presenter.offers_above_white()?;
        let proxy = self.proxy.clone();
        // After the loop has ended nobody listens.
        let sky = Sky::start(gpu, move |news| drop(proxy.send_event(Event::Sky(news))))?;
        let proxy = self.proxy.clone();
        let watch = Watch::start(session.document.path(), self.shaders.clone(), move |changed| {
            drop(proxy.send_event(Event::Changed(changed)));
        });
        let mut open = Open {
            draw_after: Instant::now(),
            drags_line: false,
            comparison: None,
            shaders: self.shaders.clone(),
            proxy: self.proxy.clone(),
            watch,
            interface: Interface::new(&window),
            session,
            schema: Schema::default(),
            held: Held::default(),
            modifiers: ModifiersState::empty(),
            drag: None,
            pointer: [0.0; 2],
            last_tick: Instant::now(),
            panel_at: None,
            asked: None,
            picture: None,
            hidden: false,
            presenter,
            sky,
            window,
        };
        open.take_shaders();
        self.open = Some(open);
        Ok(())
    }

    /// Gives up the device while the window is still there, and keeps the settings.
    pub fn close(&mut self) {
        let Some(mut open) = self.open.take() else { return };
        let size = open.window.inner_size().to_logical::<f64>(open.window.scale_factor());
        if open.window.fullscreen().is_none() && size.width >= 200.0 {
            open.session.kept.size = [size.width, size.height];
        }
        if let Err(error) = open.session.kept.save(self.kept_in.as_deref()) {
            tracing::warn!("settings are not kept: {error}");
        }
        // The sky ends with the piece at hand; nobody should have to look at that.
        open.window.set_visible(false);
        let _ = open.presenter.wait_idle();
        open.interface.close();
    }

    fn fail(&mut self, events: &ActiveEventLoop, error: WindowError) {
        self.failure.get_or_insert(error);
        events.exit();
    }
}

impl ApplicationHandler<Event> for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.open.is_none()
            && let Err(error) = self.open(events)
        {
            self.fail(events, error);
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, event: Event) {
        let Some(open) = &mut self.open else { return };
        match event {
            Event::Sky(News::Picture(picture)) => open.receive(picture),
            Event::Sky(News::Failed(problem)) => open.session.fault(PICTURE_FAULT, problem),
            Event::Measured(load, step, times) => open.session.chooser.learn(load, step, times),
            Event::Said(tone, text) => open.session.say(tone, text),
            Event::Changed(Changed::Scene) => open.reload(false),
            Event::Changed(Changed::Shaders) => open.take_shaders(),
            Event::Shaders(result) => open.shaders_taken(result),
            Event::NoTruth(number, problem) => {
                if open.comparison.as_ref().is_some_and(|comparison| comparison.number == number) {
                    (open.comparison, open.session.truth) = (None, None);
                    open.session.say(Tone::Failed, problem);
                }
            }
            Event::Truth(number, images, state) => {
                if let Some(comparison) = open.comparison.as_mut().filter(|comparison| comparison.number == number) {
                    comparison.images = Some(images);
                    open.session.truth = Some(state);
                }
            }
        }
        open.window.request_redraw();
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else { return };
        if let WindowEvent::RedrawRequested = event {
            if let Err(error) = open.draw() {
                return self.fail(events, error);
            }
        } else if open.on_event(&event) {
            events.exit();
        }
        let asked = std::mem::take(&mut open.session.asked);
        for action in asked {
            if open.act(action, &self.pictures, &self.proxy) {
                events.exit();
            }
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let Some(open) = &mut self.open else { return };
        events.set_control_flow(open.tick());
    }
}

impl Open {
    /// A picture is done.
    fn receive(&mut self, picture: Box<Picture>) {
        let pixels = |name: &str| name == "clouds" || FRAME.iter().any(|pass| pass.declaration.name == name);
        let sum = |of_pixels: bool| -> f64 {
            picture.timings.milliseconds.iter().filter(|(name, _)| pixels(name) == of_pixels).map(|(_, ms)| ms).sum()
        };
        self.session.resolution.learn(picture.scale, sum(true), sum(false));
        tracing::debug!("a picture at {:.3} of the side: {:.1} ms", picture.scale, picture.took.as_secs_f64() * 1e3);
        self.session.graph.add_sky(picture.took.as_secs_f64() * 1e3);
        self.session.timings = Some(picture.timings.clone());
        self.session.faults[PICTURE_FAULT] = None;
        self.picture = Some(picture);
    }

    fn size(&self) -> [u32; 2] {
        self.window.inner_size().into()
    }

    /// Lets time pass, asks for the next view, and says when to wake up.
    fn tick(&mut self) -> ControlFlow {
        let now = Instant::now();
        let seconds = now.duration_since(self.last_tick).as_secs_f64();
        let motion = self.motion();
        let moving = !motion.is_still() || self.session.playing;
        if moving && seconds >= 0.9 * TICK.as_secs_f64() {
            self.session.advance(seconds.min(LONGEST_STEP_S), motion);
            self.last_tick = now;
        } else if !moving {
            self.last_tick = now;
        }
        self.choose(now);
        self.ask(now);
        self.compare(now);
        if self.panel_at.is_some_and(|at| at <= now) {
            self.panel_at = None;
            self.window.request_redraw();
        }
        let rests_at = (!self.session.resolution.is_at_rest(now)).then(|| self.session.resolution.rests_at());
        let tick_at = moving.then_some(self.last_tick + TICK);
        match [tick_at, rests_at, self.panel_at].into_iter().flatten().min() {
            Some(at) => ControlFlow::WaitUntil(at),
            None => ControlFlow::Wait,
        }
    }

    fn motion(&self) -> super::fly::Motion {
        // Keys belong to the panel while one of its fields has the focus.
        match self.interface.context().memory(|memory| memory.focused().is_some()) {
            true => super::fly::Motion::default(),
            false => self.held.motion(),
        }
    }

    fn draw(&mut self) -> Result<(), WindowError> {
        let started = Instant::now();
        if started < self.draw_after {
            self.panel_at = Some(self.draw_after);
            return Ok(());
        }
        let (session, schema) = (&mut self.session, &self.schema);
        let delay_s = self.interface.run(&self.window, |context| panel::show(context, session, schema));
        self.panel_at = (delay_s < 3600.0).then(|| started + Duration::from_secs_f64(delay_s.max(TICK.as_secs_f64())));
        self.window.set_title(&self.session.title());
        self.watch.follow(self.session.document.path());
        self.presenter.want_above_white(self.session.kept.above_white);
        if self.hidden || !self.presenter.prepare(self.size())? {
            return Ok(());
        }
        let encoding = self.presenter.encoding();
        self.session.encoding = encoding;
        let whole = [0.0, 0.0, 1.0, 1.0];
        let laid_out = started.elapsed();
        // Pictures for another screen than the window has moved to are not shown.
        let real_time =
            self.picture.as_ref().filter(|picture| picture.encoding == encoding).map(|picture| &picture.image);
        let compared = self.comparison.as_ref().filter(|comparison| comparison.encoding == encoding);
        let traced = compared.and_then(|comparison| comparison.images.as_ref());
        let at = self.session.wipe.at;
        let sides = [[0.0, 0.0, at, 1.0], [at, 0.0, 1.0, 1.0]];
        let image = |shown: Shown| match (shown, traced) {
            (Shown::Truth, Some([truth, _])) => Some(truth),
            (Shown::Difference, Some([_, difference])) => Some(difference),
            _ => real_time,
        };
        let pictures: Vec<_> = match traced {
            None => real_time.map(|image| Placed { image, from: whole, to: whole }).into_iter().collect(),
            Some(_) => {
                let pairs =
                    self.session.wipe.pair.into_iter().zip(sides).filter(|(_, [left, _, right, _])| right > left);
                pairs.filter_map(|(shown, side)| Some(Placed { image: image(shown)?, from: side, to: side })).collect()
            }
        };
        let shown = self.interface.present(&mut self.presenter, &pictures)?;
        // The sky has at least half of the device's time.
        self.draw_after = started + 2 * (laid_out + self.presenter.cost()).min(Duration::from_millis(100));
        if shown {
            let took_ms = started.elapsed().as_secs_f64() * 1e3;
            tracing::debug!("the panel: {took_ms:.1} ms");
            self.session.graph.add_panel(took_ms);
        } else {
            self.panel_at = Some(started + TICK);
        }
        Ok(())
    }
}
