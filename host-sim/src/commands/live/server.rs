//! The server: requests enter; the files of the page, scenes as server-sent events and answers leave.
//!
//! A page gets the newest scene whenever it is ready for one. So a page that is slow or stalled misses scenes, and holds nothing up.
//! Whoever does not finish a request goes, so that nobody takes all the connections there are.

use std::convert::Infallible;
use std::net::TcpListener;
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::Duration;

use axum::Router;
use axum::body::to_bytes;
use axum::extract::rejection::QueryRejection;
use axum::extract::{Query, Request, State};
use axum::http::header::{CACHE_CONTROL, CONTENT_DISPOSITION, CONTENT_SECURITY_POLICY, CONTENT_TYPE};
use axum::http::{HeaderValue, StatusCode};
use axum::middleware::{Next, from_fn_with_state};
use axum::response::sse::{Event as Sent, KeepAlive, Sse};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use futures_util::stream::{Stream, unfold};
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use serde::Deserialize;
use tokio::sync::{Semaphore, oneshot, watch};
use tokio::time::{sleep, timeout};

use super::archive::Archive;
use super::engine::Ask;
use super::guard;
use super::order::Order;
use super::page::FILES;

/// An order is no longer than this, in bytes.
const LONGEST_ORDER: usize = 4096;
/// Connections at once. More wait until one of them ends. A system may let a program have no more than 1024 files.
const MOST_CONNECTIONS: usize = 256;
/// The head of a request has to come within this, and then an order within this.
const WITHIN: Duration = Duration::from_secs(10);

/// What every request needs.
#[derive(Clone)]
pub struct Desk {
    asks: Sender<Ask>,
    scenes: watch::Receiver<Arc<str>>,
    archive: Arc<Archive>,
    is_loopback: bool,
    /// A run is played again for one log at a time, so that many do not take the computer from the run that goes on.
    replays: Arc<Semaphore>,
}

impl Desk {
    /// A desk before an engine.
    #[must_use]
    pub fn new(asks: Sender<Ask>, scenes: watch::Receiver<Arc<str>>, archive: Arc<Archive>, is_loopback: bool) -> Self {
        Self { asks, scenes, archive, is_loopback, replays: Arc::new(Semaphore::new(1)) }
    }

    async fn ask<T>(&self, ask: impl FnOnce(oneshot::Sender<T>) -> Ask) -> Result<T, Refused> {
        let (to, from) = oneshot::channel();
        self.asks.send(ask(to)).map_err(|_| ended())?;
        from.await.map_err(|_| ended())
    }
}

type Refused = (StatusCode, String);

fn ended() -> Refused {
    (StatusCode::SERVICE_UNAVAILABLE, "the simulation has ended; start `holdover-sim live` again".into())
}

/// Serves until the program ends, on a thread of its own.
///
/// # Errors
/// Errors of the system.
pub fn serve(listener: TcpListener, desk: Desk) -> std::io::Result<()> {
    listener.set_nonblocking(true)?;
    let runtime = tokio::runtime::Builder::new_current_thread().enable_io().enable_time().build()?;
    std::thread::Builder::new().name("server".into()).spawn(move || {
        runtime.block_on(async move {
            if let Ok(listener) = tokio::net::TcpListener::from_std(listener) {
                accept(&listener, &routes(desk)).await;
            }
        });
    })?;
    Ok(())
}

/// Serves whoever connects, for ever.
async fn accept(listener: &tokio::net::TcpListener, router: &Router) {
    let seats = Arc::new(Semaphore::new(MOST_CONNECTIONS));
    while let Ok(seat) = Arc::clone(&seats).acquire_owned().await {
        let Ok((stream, _)) = listener.accept().await else {
            sleep(Duration::from_millis(50)).await; // the system has no connection left for now
            continue;
        };
        let service = TowerToHyperService::new(router.clone());
        tokio::spawn(async move {
            let mut connection = http1::Builder::new();
            connection.timer(TokioTimer::new()).header_read_timeout(WITHIN);
            let _ = connection.serve_connection(TokioIo::new(stream), service).await; // whoever has gone needs no answer
            drop(seat);
        });
    }
}

fn routes(desk: Desk) -> Router {
    let mut router = Router::new();
    for (path, kind, content) in FILES {
        router = router.route(path, get(move || async move { ([(CONTENT_TYPE, *kind)], *content) }));
    }
    router
        .route("/cast", get(cast))
        .route("/scenes", get(scenes))
        .route("/frames", get(frames))
        .route("/order", post(order))
        .route("/scenario.toml", get(scenario))
        .route("/bus.log", get(candump))
        .route("/holdover.dbc", get(dbc))
        .fallback(|| async { (StatusCode::NOT_FOUND, "there is nothing of that name; the page is at /") })
        .method_not_allowed_fallback(|| async {
            (StatusCode::METHOD_NOT_ALLOWED, "orders are sent by POST to /order, and all else is read by GET")
        })
        .layer(from_fn_with_state(desk.clone(), guarded))
        .with_state(desk)
}

/// Refuses what others ask, and lets the page load nothing from elsewhere.
async fn guarded(State(desk): State<Desk>, request: Request, next: Next) -> Response {
    if let Err(refusal) = guard::check(request.headers(), desk.is_loopback) {
        return (StatusCode::FORBIDDEN, refusal).into_response();
    }
    let mut response = next.run(request).await;
    let headers = response.headers_mut();
    headers.insert(CACHE_CONTROL, HeaderValue::from_static("no-store"));
    headers.insert(
        CONTENT_SECURITY_POLICY,
        HeaderValue::from_static("default-src 'self'; img-src 'self' data:; frame-ancestors 'none'"),
    );
    response
}

async fn order(State(desk): State<Desk>, request: Request) -> Response {
    let Ok(body) = timeout(WITHIN, to_bytes(request.into_body(), LONGEST_ORDER)).await else {
        return (StatusCode::REQUEST_TIMEOUT, "the order did not come whole within 10 s; send it at once")
            .into_response();
    };
    let Ok(body) = body else {
        let refusal =
            format!("the order is longer than {LONGEST_ORDER} bytes; see docs/LIVE.md for the orders and their values");
        return (StatusCode::BAD_REQUEST, refusal).into_response();
    };
    let order = match Order::read(&body) {
        Ok(order) => order,
        Err(error) => return (StatusCode::BAD_REQUEST, error.to_string()).into_response(),
    };
    match desk.ask(|to| Ask::Do(order, to)).await {
        Ok(Ok(())) => StatusCode::NO_CONTENT.into_response(),
        Ok(Err(error)) => (StatusCode::BAD_REQUEST, error.to_string()).into_response(),
        Err(refused) => refused.into_response(),
    }
}

async fn scenes(State(desk): State<Desk>) -> Sse<impl Stream<Item = Result<Sent, Infallible>>> {
    let mut scenes = desk.scenes.clone();
    scenes.mark_changed(); // the first one at once
    let stream = unfold(scenes, |mut scenes| async move {
        scenes.changed().await.ok()?;
        let scene = Arc::clone(&scenes.borrow_and_update());
        Some((Ok(Sent::default().data(&*scene)), scenes))
    });
    Sse::new(stream).keep_alive(KeepAlive::default())
}

async fn cast(State(desk): State<Desk>) -> Response {
    ([(CONTENT_TYPE, "application/json")], desk.archive.cast().to_owned()).into_response()
}

/// Of which vehicle.
#[derive(Deserialize)]
struct Which {
    vehicle: usize,
}

/// The vehicle that a request asks about, if it names one.
type Wanted = Result<Query<Which>, QueryRejection>;

fn no_vehicle() -> Refused {
    (StatusCode::NOT_FOUND, "there is no such vehicle; give ?vehicle= and an index of the scenario".into())
}

async fn frames(State(desk): State<Desk>, wanted: Wanted) -> Result<Response, Refused> {
    let Query(which) = wanted.map_err(|_| no_vehicle())?;
    let rows = desk.ask(|to| Ask::Frames(which.vehicle, to)).await?.ok_or_else(no_vehicle)?;
    Ok(([(CONTENT_TYPE, "application/json")], rows).into_response())
}

async fn scenario(State(desk): State<Desk>) -> Result<Response, Refused> {
    let (events, ticks) = desk.ask(Ask::Journal).await?;
    let text = desk.archive.scenario(&events, ticks).map_err(|error| (StatusCode::CONFLICT, error.to_string()))?;
    Ok(download("drive.toml", "application/toml", text))
}

/// The log of a bus from the beginning: the run is played once more beside the one that goes on.
async fn candump(State(desk): State<Desk>, wanted: Wanted) -> Result<Response, Refused> {
    let Query(which) = wanted.map_err(|_| no_vehicle())?;
    if desk.archive.is_device(which.vehicle) {
        let cause = "a device drives this vehicle; log its bus with `holdover-sim record --bus INTERFACE`";
        return Err((StatusCode::CONFLICT, cause.into()));
    }
    let (events, ticks) = desk.ask(Ask::Journal).await?;
    let turn = Arc::clone(&desk.replays).acquire_owned().await.map_err(|_| ended())?;
    let archive = Arc::clone(&desk.archive);
    let played = tokio::task::spawn_blocking(move || {
        let log = archive.candump(events, ticks, which.vehicle);
        drop(turn);
        log
    });
    let played = played.await;
    let log = played.ok().flatten().ok_or_else(no_vehicle)?;
    Ok(download(&format!("bus-{}.log", which.vehicle), "text/plain; charset=utf-8", log))
}

async fn dbc(State(desk): State<Desk>) -> Response {
    ([(CONTENT_TYPE, "text/plain; charset=utf-8")], desk.archive.dbc()).into_response()
}

fn download(name: &str, kind: &str, text: String) -> Response {
    let disposition = format!("attachment; filename=\"{name}\"");
    ([(CONTENT_TYPE, kind.to_owned()), (CONTENT_DISPOSITION, disposition)], text).into_response()
}
