//! An engine of `live` on a thread of its own, which is heard until it is asked to end. A play enters; orders go in, and what the page is
//! shown comes out.

use std::sync::{Arc, mpsc};
use std::thread::JoinHandle;
use std::time::Duration;

use holdover_sim::commands::interruption::Interruption;
use holdover_sim::commands::live::engine::{Ask, Engine};
use holdover_sim::commands::live::order::Order;
use holdover_sim::commands::live::stage::Play;
use holdover_sim::input::scenario::Event;
use tokio::sync::{oneshot, watch};

pub struct Heard {
    asks: mpsc::Sender<Ask>,
    scenes: watch::Receiver<Arc<str>>,
    end: Interruption,
    thread: JoinHandle<(Vec<Event>, u64)>,
}

impl Heard {
    /// At rest at the beginning of a play.
    pub fn begin(play: impl Play + Send + 'static) -> Self {
        let ((asks, asked), (show, scenes)) = (mpsc::channel(), watch::channel("{}".into()));
        let end = Interruption::default();
        let flag = end.clone();
        let run = move || Engine::new(&play, asked, show).run(&flag).unwrap();
        let heard = Self { asks, scenes, end, thread: std::thread::spawn(run) };
        heard.order(Order::Pause {}).unwrap();
        heard.order(Order::Restart {}).unwrap();
        heard
    }

    pub fn order(&self, order: Order) -> Result<(), String> {
        let (to, from) = oneshot::channel();
        self.asks.send(Ask::Do(order, to)).unwrap();
        from.blocking_recv().unwrap().map_err(|error| error.to_string())
    }

    /// What was done so far, and the tick that it is.
    pub fn journal(&self) -> (Vec<Event>, u64) {
        let (to, from) = oneshot::channel();
        self.asks.send(Ask::Journal(to)).unwrap();
        from.blocking_recv().unwrap()
    }

    pub fn step_to(&self, tick: u64) {
        let now = self.journal().1;
        self.order(Order::Step { ticks: u32::try_from(tick - now).unwrap() }).unwrap();
    }

    /// The vehicles at this tick, once they are shown.
    pub fn vehicles(&self, tick: u64) -> serde_json::Value {
        for _ in 0..2000 {
            let scene: serde_json::Value = serde_json::from_str(&self.scenes.borrow()).unwrap();
            if scene["ticks"] == tick {
                return scene["vehicles"].clone();
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        panic!("tick {tick} is not shown: {}", *self.scenes.borrow());
    }

    pub fn end(self) -> (Vec<Event>, u64) {
        self.end.ask();
        self.thread.join().unwrap()
    }
}
