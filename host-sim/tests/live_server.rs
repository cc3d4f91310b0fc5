//! The page of `live` over its socket: who may ask, and what nobody can do to the simulation.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// A running `live`, which ends with this.
struct Live {
    child: Child,
    address: String,
}

impl Drop for Live {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn live(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_holdover-sim"));
    command.arg("live").args(arguments).args(["--no-browser"]).stdin(Stdio::null());
    command
}

impl Live {
    fn begin() -> Self {
        let mut child = live(&["--port", "0"]).stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let address = line.trim().strip_prefix("http://").and_then(|rest| rest.strip_suffix('/')).unwrap().to_owned();
        Self { child, address }
    }

    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(&self.address).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        stream
    }

    /// The whole answer to a request with these further header lines.
    fn ask(&self, line: &str, headers: &str, body: &str) -> String {
        let mut stream = self.connect();
        let host = &self.address;
        let length = body.len();
        write!(
            stream,
            "{line} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\nContent-Length: {length}\r\n{headers}\r\n{body}"
        )
        .unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        answer
    }

    fn order(&self, body: &str) -> String {
        self.ask("POST /order", "", body)
    }

    /// A page that looks on: the scenes, as they come.
    fn look_on(&self) -> impl Iterator<Item = serde_json::Value> {
        let mut stream = self.connect();
        write!(stream, "GET /scenes HTTP/1.1\r\nHost: {}\r\n\r\n", self.address).unwrap();
        let lines = BufReader::new(stream).lines().map_while(Result::ok);
        lines
            .filter_map(|line| serde_json::from_str(line.strip_prefix("data: ")?).ok())
            .filter(|scene: &serde_json::Value| scene["vehicles"].is_array())
    }

    fn ticks(&self) -> u64 {
        self.look_on().next().unwrap()["ticks"].as_u64().unwrap()
    }

    /// That the simulation goes on.
    fn goes_on(&self) {
        let before = self.ticks();
        std::thread::sleep(Duration::from_millis(300));
        assert!(self.ticks() > before);
    }
}

#[test]
fn the_page_and_all_that_it_needs_are_served() {
    let live = Live::begin();
    let page = live.ask("GET /", "", "");
    assert!(
        page.starts_with("HTTP/1.1 200 OK") && page.contains("content-security-policy: default-src 'self'"),
        "{page}"
    );
    for part in page.split('"').filter(|part| part.ends_with(".js") || part.ends_with(".css")) {
        assert!(live.ask(&format!("GET {part}"), "", "").starts_with("HTTP/1.1 200 OK"), "{part}");
    }
    assert!(live.ask("GET /holdover.dbc", "", "").contains("BO_ "));
    assert!(live.ask("GET /frames?vehicle=1", "", "").contains("\"cycle_s\""));
    for which in ["?vehicle=99", "?vehicle=-1", "?vehicle=x", ""] {
        for path in ["/frames", "/bus.log"] {
            let answer = live.ask(&format!("GET {path}{which}"), "", "");
            assert!(
                answer.starts_with("HTTP/1.1 404") && answer.contains("there is no such vehicle; give ?vehicle="),
                "{answer}"
            );
        }
    }
    assert!(live.ask("GET /nothing", "", "").contains("the page is at /"));
}

#[test]
fn a_page_of_another_origin_does_not_drive() {
    let live = Live::begin();
    let drive = r#"{"do":"drive","vehicle":0,"mps2":-8}"#;
    let answer = live.ask("POST /order", "Origin: http://evil.example\r\n", drive);
    assert!(
        answer.starts_with("HTTP/1.1 403") && answer.contains("a page of http://evil.example drives nothing here"),
        "{answer}"
    );
    let mut stream = live.connect();
    write!(stream, "GET /cast HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n").unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    assert!(answer.starts_with("HTTP/1.1 403") && answer.contains("is not a name of this server"), "{answer}");
    assert_eq!(live.look_on().next().unwrap()["vehicles"][0]["is_driven"], false);
    live.goes_on();
}

#[test]
fn an_order_that_cannot_be_is_refused_with_its_cause_and_the_simulation_goes_on() {
    let live = Live::begin();
    for (order, cause) in [
        ("", "the order is none"),
        (r#"{"do":"drive","vehicle":9,"mps2":1}"#, "there is no vehicle 9; give an index from 0 to 4"),
        (r#"{"do":"drive","vehicle":1,"mps2":99}"#, "`mps2` is 99; give m/s² from -12 to 12"),
        (r#"{"do":"outage","seconds":-1}"#, "`seconds` is -1; give seconds from 0 to 600"),
    ] {
        let answer = live.order(order);
        assert!(answer.starts_with("HTTP/1.1 400") && answer.contains(cause), "{order}: {answer}");
    }
    let long = live.order(&"x".repeat(5000));
    assert!(long.starts_with("HTTP/1.1 400") && long.contains("the order is longer than 4096 bytes; "), "{long}");
    live.goes_on();
}

#[test]
fn garbage_a_stalled_page_and_one_that_hangs_up_do_not_matter() {
    let live = Live::begin();
    let mut garbage = live.connect();
    let noise: Vec<u8> = (0..20_000_u32).map(|n| (n.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
    let _ = garbage.write_all(&noise);
    // Pages that never read: their buffers are soon full.
    let stalled: Vec<TcpStream> = (0..20)
        .map(|_| {
            let mut stream = live.connect();
            write!(stream, "GET /scenes HTTP/1.1\r\nHost: {}\r\n\r\n", live.address).unwrap();
            stream
        })
        .collect();
    drop(live.connect());
    let (mut one, mut other) = (live.look_on(), live.look_on());
    for _ in 0..30 {
        assert!(one.next().is_some() && other.next().is_some());
    }
    live.goes_on();
    assert_eq!(stalled.len(), 20);
}

#[test]
fn whoever_never_ends_a_request_goes_and_keeps_nobody_out() {
    let live = Live::begin();
    // More than are served at once, and more than a system may let a program have of files.
    let slow: Vec<TcpStream> = (0..300)
        .map(|_| {
            let mut stream = live.connect();
            write!(stream, "GET / HTTP/1.1\r\nHost: {}\r\nX", live.address).unwrap();
            stream
        })
        .collect();
    let mut half = live.connect();
    write!(half, "POST /order HTTP/1.1\r\nHost: {}\r\nContent-Length: 99\r\n\r\n{{", live.address).unwrap();
    live.goes_on(); // which looks on over a connection of its own
    let mut answer = String::new();
    half.read_to_string(&mut answer).unwrap();
    assert!(answer.starts_with("HTTP/1.1 408") && answer.contains("did not come whole within 10 s"), "{answer}");
    for mut stream in slow {
        let _ = stream.read_to_string(&mut answer); // it ends, or the connection is reset
    }
    live.goes_on();
}

#[test]
fn a_request_in_another_way_is_refused_with_what_is_right() {
    let live = Live::begin();
    for line in ["PUT /order", "GET /order", "DELETE /cast"] {
        let answer = live.ask(line, "", "");
        assert!(answer.starts_with("HTTP/1.1 405") && answer.contains("orders are sent by POST to /order"), "{answer}");
    }
    let answer = live.ask("GET /bus.log?vehicle=0", "Sec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: no-cors\r\n", "");
    assert!(answer.starts_with("HTTP/1.1 403") && answer.contains("for no page of another origin"), "{answer}");
}

#[test]
fn what_was_set_of_the_links_is_told_to_every_page() {
    let live = Live::begin();
    assert_eq!(live.look_on().next().unwrap()["links"], serde_json::json!([]));
    live.order(r#"{"do":"links","delay_mean_s":0.3,"delay_std_s":0.01,"loss":0.2}"#);
    live.order(r#"{"do":"links","vehicle":2,"delay_mean_s":0,"delay_std_s":0,"loss":1}"#);
    let is_told = |scene: &serde_json::Value| {
        scene["links"] == serde_json::json!([[null, [0.3, 0.01, 0.2]], [2, [0.0, 0.0, 1.0]]])
    };
    assert!(live.look_on().take(100).any(|scene| is_told(&scene)));
    live.order(r#"{"do":"restart"}"#);
    assert!(live.look_on().take(100).any(|scene| scene["links"] == serde_json::json!([])));
}

#[test]
fn a_port_in_use_is_named_with_the_remedy() {
    let live = Live::begin();
    let port = live.address.rsplit(':').next().unwrap();
    let output = self::live(&["--port", port]).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(said.lines().count(), 1);
    let wanted =
        format!("error: --port: port {port} of 127.0.0.1 is in use; give another one, --port 0 for any that is free");
    assert!(said.starts_with(&wanted), "{said}");
}

#[test]
fn what_was_driven_is_saved_and_run_shows_the_same() {
    let live = Live::begin();
    let of_body = |answer: String| answer.split_once("\r\n\r\n").unwrap().1.to_owned();
    live.order(r#"{"do":"pause"}"#);
    live.order(r#"{"do":"restart"}"#);
    for order in [
        r#"{"do":"step","ticks":200}"#,
        r#"{"do":"drive","vehicle":0,"mps2":-2.5}"#,
        r#"{"do":"step","ticks":150}"#,
        r#"{"do":"release","vehicle":0}"#,
        r#"{"do":"outage","vehicle":2,"seconds":2}"#,
        r#"{"do":"step","ticks":250}"#,
    ] {
        assert!(live.order(order).starts_with("HTTP/1.1 204"), "{order}");
    }
    let folder = tempfile::tempdir().unwrap();
    let [saved, log, trace] = ["drive.toml", "bus.log", "trace.csv"].map(|name| folder.path().join(name));
    std::fs::write(&saved, of_body(live.ask("GET /scenario.toml", "", ""))).unwrap();
    let run = Command::new(env!("CARGO_BIN_EXE_holdover-sim"))
        .args(["run", "--no-report", "--candump-vehicle", "2"])
        .args([saved.as_os_str(), "--candump".as_ref(), log.as_os_str(), "--trace".as_ref(), trace.as_os_str()])
        .output()
        .unwrap();
    assert!(run.status.code().is_some_and(|code| code < 2), "{}", String::from_utf8_lossy(&run.stderr));
    assert_eq!(of_body(live.ask("GET /bus.log?vehicle=2", "", "")), std::fs::read_to_string(&log).unwrap());
    let scene = live.look_on().next().unwrap();
    let trace = std::fs::read_to_string(&trace).unwrap();
    let last: Vec<f64> = trace.lines().last().unwrap().split(',').take(3).map(|field| field.parse().unwrap()).collect();
    assert!((scene["at_s"].as_f64().unwrap() - last[0]).abs() < 1e-9);
    assert!((scene["vehicles"][2]["position_m"].as_f64().unwrap() - last[1]).abs() < 1e-4);
    assert!((scene["vehicles"][2]["speed_mps"].as_f64().unwrap() - last[2]).abs() < 1e-4);
}
