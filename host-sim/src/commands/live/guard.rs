//! Who may ask: the headers of a request enter; a refusal leaves for a page of another origin, and for a name that is not this computer's.
//!
//! Any page in the user's browser can send requests to this computer. The browser names the page's origin in each that could do something,
//! and the name that the page used for this computer; a page of another origin can forge neither. Of requests without an origin, such as
//! those for pictures, it says whether they are for a page of another one.

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
    let origin = headers.get(ORIGIN).map(|origin| origin.to_str().unwrap_or_default());
    if let Some(origin) = origin.filter(|origin| *origin != format!("http://{host}")) {
        let origin: String = origin.chars().take(60).collect();
        return Err(format!("refused: a page of {origin} drives nothing here; open http://{host}/ itself"));
    }
    // Whoever follows a link comes from elsewhere too. He gets a page of ours, and the other page gets nothing.
    let said = |name: &str| headers.get(name).and_then(|said| said.to_str().ok());
    let is_for_another = matches!(said("sec-fetch-site"), Some("cross-site" | "same-site"));
    if is_for_another && said("sec-fetch-mode") != Some("navigate") {
        return Err(format!("refused: this is for no page of another origin; open http://{host}/ itself"));
    }
    Ok(())
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
    use axum::http::{HeaderName, HeaderValue};

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
    fn a_page_of_another_origin_loads_nothing_and_links_to_this_one() {
        let said = |site: &'static str, mode: &'static str| {
            let mut headers = HeaderMap::new();
            let pairs = [("host", "127.0.0.1:8137"), ("sec-fetch-site", site), ("sec-fetch-mode", mode)];
            headers.extend(pairs.map(|(name, said)| (HeaderName::from_static(name), HeaderValue::from_static(said))));
            check(&headers, true)
        };
        for site in ["cross-site", "same-site"] {
            assert!(said(site, "no-cors").unwrap_err().contains("for no page of another origin"), "{site}");
            assert_eq!(said(site, "navigate"), Ok(()));
        }
        assert_eq!(said("same-origin", "cors"), Ok(()));
        assert_eq!(said("none", "navigate"), Ok(()));
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
