//! The thread that owns the renderer: the sky is computed here, and never waited for.

use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crate::gpu::{Gpu, GpuImage, ImageShape, NextUse, Pace, ScreenEncoding, give_back_freed_memory};
use crate::passes::RenderError;
use crate::plan::{Outputs, Settings};
use crate::renderer::{Rendered, Renderer, Targets, Timings};
use crate::scene::Scene;

/// How long a submission may keep the queue from the panel.
const PIECE: Duration = Duration::from_millis(8);

/// What is to be seen.
#[derive(Clone)]
pub struct View {
    /// The scene, with the camera's size as it is to be computed.
    pub scene: Scene,
    /// What its accuracy is worth.
    pub settings: Settings,
    /// Share of the window's side that this is.
    pub scale: f64,
    /// How the window's screen wants it.
    pub encoding: ScreenEncoding,
    /// Whether something newer may stop it before it is done.
    pub may_stop: bool,
}

/// A finished picture.
pub struct Picture {
    /// Left to be copied from.
    pub image: GpuImage,
    /// What each pass took.
    pub timings: Timings,
    /// From the request to the end, on the host's clock.
    pub took: Duration,
    /// As asked for.
    pub scale: f64,
    /// As asked for.
    pub encoding: ScreenEncoding,
}

/// What the thread has to say.
pub enum News {
    /// A view is done.
    Picture(Box<Picture>),
    /// A view cannot be rendered: the last picture stays.
    Failed(String),
}

/// What is done between two views, with the renderer.
type Task = Box<dyn FnOnce(&mut Renderer) + Send>;

#[derive(Default)]
struct Orders {
    view: Option<View>,
    tasks: VecDeque<Task>,
    /// Whether a view that waits comes before the next task: pictures go on while a list of tasks is worked off.
    view_first: bool,
    /// Whether the view that is being computed may be stopped.
    stoppable: bool,
    quit: bool,
}

struct Shared {
    orders: Mutex<Orders>,
    wake: Condvar,
    pace: Pace,
}

/// The thread, which ends when this is dropped.
pub struct Sky {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl Sky {
    /// Starts the thread; `tell` is called on it.
    ///
    /// # Errors
    /// As [`Renderer::on`].
    pub fn start(gpu: Gpu, tell: impl Fn(News) + Send + 'static) -> Result<Self, RenderError> {
        let mut renderer = Renderer::on(gpu)?;
        let pace = Pace::new(PIECE);
        renderer.set_pace(Some(pace.clone()));
        let shared = Arc::new(Shared { orders: Mutex::default(), wake: Condvar::new(), pace });
        let worker = Worker { shared: shared.clone(), renderer, images: Vec::new(), compiled: 0 };
        let thread = std::thread::Builder::new().name("sky".to_owned()).spawn(move || worker.work(tell));
        Ok(Self { shared, thread: thread.ok() })
    }

    /// Asks for a view, in place of an earlier one that is not begun yet.
    pub fn show(&self, view: View) {
        let mut orders = lock(&self.shared.orders);
        if orders.stoppable {
            self.shared.pace.stop();
        }
        orders.view = Some(view);
        self.shared.wake.notify_one();
    }

    /// Has the renderer do something between two views.
    pub fn between(&self, task: impl FnOnce(&mut Renderer) + Send + 'static) {
        self.handle().between(task);
    }

    /// For other threads that need the renderer.
    pub fn handle(&self) -> Handle {
        Handle(self.shared.clone())
    }

    /// Renders a scene to the host's memory, in its own size, and hands over the result on the sky's thread.
    pub fn capture(
        &self,
        scene: Scene,
        settings: Settings,
        outputs: Outputs,
        then: impl FnOnce(Result<Rendered, RenderError>) + Send + 'static,
    ) {
        self.between(move |renderer| then(renderer.render(&scene, settings, outputs)));
    }
}

/// Gives the sky's thread tasks from any other. What is given after its end is dropped.
#[derive(Clone)]
pub struct Handle(Arc<Shared>);

impl Handle {
    /// Has the renderer do something between two views; a view that is being computed is finished first.
    pub fn between(&self, task: impl FnOnce(&mut Renderer) + Send + 'static) {
        lock(&self.0.orders).tasks.push_back(Box::new(task));
        self.0.wake.notify_one();
    }
}

impl Drop for Sky {
    fn drop(&mut self) {
        lock(&self.shared.orders).quit = true;
        self.shared.pace.stop();
        self.shared.wake.notify_one();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn lock(orders: &Mutex<Orders>) -> MutexGuard<'_, Orders> {
    orders.lock().unwrap_or_else(PoisonError::into_inner)
}

enum Next {
    View(Box<View>),
    Task(Task),
}

struct Worker {
    shared: Arc<Shared>,
    renderer: Renderer,
    /// Images of earlier views, to be drawn into again once nobody looks at them.
    images: Vec<GpuImage>,
    /// Pipelines whose compilation has left nothing behind.
    compiled: u64,
}

impl Worker {
    fn work(mut self, tell: impl Fn(News)) {
        while let Some(next) = self.next() {
            match next {
                Next::Task(task) => task(&mut self.renderer),
                Next::View(view) => match self.render(&view) {
                    Ok(picture) => tell(News::Picture(Box::new(picture))),
                    Err(RenderError::Gpu(error)) if error.is_stopped() => {}
                    Err(error) => tell(News::Failed(error.to_string())),
                },
            }
            self.tidy();
        }
    }

    /// Gives back what compilers have left.
    fn tidy(&mut self) {
        let compiled = self.renderer.compiled_pipelines();
        if std::mem::replace(&mut self.compiled, compiled) != compiled {
            give_back_freed_memory();
            tracing::debug!("{compiled} pipelines compiled; {:?}", self.renderer.gpu().population());
        }
    }

    /// Waits for something to do; `None` at the end.
    fn next(&self) -> Option<Next> {
        let mut orders = lock(&self.shared.orders);
        loop {
            if orders.quit {
                return None;
            }
            let view_first = orders.view_first && orders.view.is_some();
            if let Some(task) = (!view_first).then(|| orders.tasks.pop_front()).flatten() {
                (orders.stoppable, orders.view_first) = (false, true);
                self.shared.pace.resume();
                return Some(Next::Task(task));
            }
            if let Some(view) = orders.view.take() {
                (orders.stoppable, orders.view_first) = (view.may_stop, false);
                self.shared.pace.resume();
                return Some(Next::View(Box::new(view)));
            }
            orders.stoppable = false;
            orders = self.shared.wake.wait(orders).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn render(&mut self, view: &View) -> Result<Picture, RenderError> {
        let started = Instant::now();
        let image = self.image(view.scene.camera.width, view.scene.camera.height, view.encoding)?;
        let targets = Targets { picture: Some(image.clone()), encoding: view.encoding, ..Targets::default() };
        let timings = match view.may_stop {
            // At rest every pixel is computed, however long that takes.
            true => self.renderer.render_to(&view.scene, view.settings, &targets, NextUse::Copy)?,
            false => self.renderer.render_next_to(&view.scene, view.settings, &targets, NextUse::Copy)?,
        };
        Ok(Picture { image, timings, took: started.elapsed(), scale: view.scale, encoding: view.encoding })
    }

    /// An image that nobody else holds.
    fn image(&mut self, width: u32, height: u32, encoding: ScreenEncoding) -> Result<GpuImage, RenderError> {
        let (shape, format) = (ImageShape::D2(width, height), encoding.image_format());
        let fits = |image: &GpuImage| (image.shape(), image.format()) == (shape, format);
        self.images.retain(|image| fits(image) || image.is_shared());
        if let Some(free) = self.images.iter().find(|image| fits(image) && !image.is_shared()) {
            return Ok(free.clone());
        }
        let image = self.renderer.gpu().image("view", shape, format)?;
        self.images.push(image.clone());
        Ok(image)
    }
}
