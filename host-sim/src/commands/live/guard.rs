//! Who may ask: the headers of a request enter; a refusal leaves for a page of another origin, and for a name that is not this computer's.
//!
//! Any page in the user's browser can send requests to this computer. The browser names the page's origin in each that could do something,
//! and the name that the page used for this computer; a page of another origin can forge neither.

use std::net::IpAddr;

use axum::http::HeaderMap;
use axum::http::header::{HOST, ORIGIN};

/// Whether the request may be answered.
///
/// # Errors
/// Why not, and what to do.
pub fn check(headers: &HeaderMap, is_loopback: bool) -> Result<(), String> {
    let host = headers.get(HOST).and_then(|host| host.to_str().ok()).unwrap_or_default();
    if !is_ours(host, is_loopback) {
        let name: String = host.chars().take(60).collect();
        return Err(format!(
            "refused: \"{name}\" is not a name of this server; open it by its address, such as 127.0.0.1"
        ));
    }
    match headers.get(ORIGIN).map(|origin| origin.to_str().unwrap_or_default()) {
        Some(origin) if origin != format!("http://{host}") => {
            let origin: String = origin.chars().take(60).collect();
            Err(format!("refused: a page of {origin} drives nothing here; open http://{host}/ itself"))
        }
        _ => Ok(()),
    }
}

/// Whether a `Host` is an address of this computer, so that no name server can have led here.
fn is_ours(host: &str, is_loopback: bool) -> bool {
    let name = match host.rsplit_once(':') {
        Some((name, port)) if port.parse::<u16>().is_ok() => name,
        _ => host,
    };
    let address = name.trim_start_matches('[').trim_end_matches(']').parse::<IpAddr>();
    name == "localhost" || address.is_ok_and(|address| address.is_loopback() || !is_loopback)
}

#[cfg(test)]
mod tests {
    use super::*;
    use axum::http::HeaderValue;

    fn said(host: &str, origin: Option<&str>, is_loopback: bool) -> Result<(), String> {
        let mut headers = HeaderMap::new();
        headers.insert(HOST, HeaderValue::from_str(host).unwrap());
        if let Some(origin) = origin {
            headers.insert(ORIGIN, HeaderValue::from_str(origin).unwrap());
        }
        check(&headers, is_loopback)
    }

    #[test]
    fn own_pages_and_programs_may_ask() {
        for host in ["127.0.0.1:8137", "localhost:8137", "[::1]:8137", "localhost"] {
            assert_eq!(said(host, None, true), Ok(()));
            assert_eq!(said(host, Some(&format!("http://{host}")), true), Ok(()));
        }
        assert_eq!(said("192.168.0.7:8137", Some("http://192.168.0.7:8137"), false), Ok(()));
    }

    #[test]
    fn other_pages_and_other_names_may_not() {
        for origin in ["http://evil.example", "null", "http://127.0.0.1:9999", "https://127.0.0.1:8137"] {
            let said = said("127.0.0.1:8137", Some(origin), true).unwrap_err();
            assert!(said.starts_with(&format!("refused: a page of {origin} drives nothing here; open ")), "{said}");
        }
        for host in ["evil.example:8137", "192.168.0.7:8137", ""] {
            assert!(said(host, None, true).unwrap_err().contains("is not a name of this server"), "{host}");
        }
        assert!(said("evil.example:8137", None, false).is_err());
    }
}
