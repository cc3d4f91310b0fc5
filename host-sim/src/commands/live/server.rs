//! The server: requests enter; the files of the page, scenes as server-sent events and answers leave.
//!
//! A page gets the newest scene whenever it is ready for one. So a page that is slow or stalled misses scenes, and holds nothing up.

use std::convert::Infallible;
use std::net::TcpListener;
use std::sync::Arc;
use std::sync::mpsc::Sender;

use axum::Router;
use axum::body::Bytes;
use axum::extract::rejection::{BytesRejection, QueryRejection};
use axum::extract::{DefaultBodyLimit, Query, Request, State};
use axum::http::header::{CACHE_CONTROL, CONTENT_DISPOSITION, CONTENT_SECURITY_POLICY, CONTENT_TYPE};
use axum::http::{HeaderValue, StatusCode};
use axum::middleware::{Next, from_fn_with_state};
use axum::response::sse::{Event as Sent, KeepAlive, Sse};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use futures_util::stream::{Stream, unfold};
use serde::Deserialize;
use tokio::sync::{oneshot, watch};

use super::archive::Archive;
use super::engine::Ask;
use super::guard;
use super::order::Order;
use super::page::FILES;

/// An order is no longer than this, in bytes.
const LONGEST_ORDER: usize = 4096;

/// What every request needs.
#[derive(Clone)]
pub struct Desk {
    asks: Sender<Ask>,
    scenes: watch::Receiver<Arc<str>>,
    archive: Arc<Archive>,
    is_loopback: bool,
}

impl Desk {
    /// A desk before an engine.
    #[must_use]
    pub fn new(asks: Sender<Ask>, scenes: watch::Receiver<Arc<str>>, archive: Arc<Archive>, is_loopback: bool) -> Self {
        Self { asks, scenes, archive, is_loopback }
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
                let _ = axum::serve(listener, routes(desk)).await; // it never returns
            }
        });
    })?;
    Ok(())
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
        .layer(DefaultBodyLimit::max(LONGEST_ORDER))
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

async fn order(State(desk): State<Desk>, body: Result<Bytes, BytesRejection>) -> Response {
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
    let archive = Arc::clone(&desk.archive);
    let played = tokio::task::spawn_blocking(move || archive.candump(events, ticks, which.vehicle)).await;
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
