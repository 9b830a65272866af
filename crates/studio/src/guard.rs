//! Who may ask: the page that was opened with the token of this run, and nobody else.
//!
//! The token is good once: it is exchanged for both secrets of the session, and afterwards says nothing to whoever finds it.
//! Every request must name this server as its host (a name that was made to point here names itself), must not come from a page
//! of another origin, and but for the page itself and the exchange of the token must carry both secrets of the session: the
//! cookie, which the browser sends by itself, and the key, which only a page of this origin can read. The cookie alone would not
//! do, since browsers send it to every port of this machine, and another user may listen on one of them.

use crate::forward::Forward;
use crate::held::held;
use crate::refused::Refused;
use crate::secret::{same, secret};
use crate::server::Shared;
use axum::extract::{Request, State};
use axum::http::header::{HOST, ORIGIN};
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use std::sync::{Arc, Mutex};

/// Header of the key.
pub const KEY: HeaderName = HeaderName::from_static("x-stiction-key");
const FETCH_SITE: HeaderName = HeaderName::from_static("sec-fetch-site");
const FETCH_DEST: HeaderName = HeaderName::from_static("sec-fetch-dest");
/// How long a browser keeps the cookie, s: the token does not give it another one after it was closed.
const COOKIE_AGE: u32 = 30 * 24 * 3600;

/// What pages of this origin may do: what comes from here, no script but that of the files of the page.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; \
                      base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
/// What a report may do: be seen.
pub const SHOWN: &str = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'; \
                         frame-ancestors 'none'; sandbox allow-popups";

/// A token that is good once, and the file that holds it, if one does.
#[derive(Debug)]
struct Token {
    token: String,
    file: Option<Forward>,
}

/// The secrets of a run.
#[derive(Debug)]
pub struct Keys {
    /// In addresses that were not opened yet.
    tokens: Mutex<Vec<Token>>,
    cookie_name: String,
    cookie: String,
    key: String,
    hosts: [String; 2],
}

impl Keys {
    /// New ones, for a port of this machine.
    pub fn new(port: u16) -> std::io::Result<Self> {
        Ok(Self {
            tokens: Mutex::default(),
            cookie_name: format!("stiction-{port}"),
            cookie: secret()?,
            key: secret()?,
            hosts: [format!("127.0.0.1:{port}"), format!("localhost:{port}")],
        })
    }

    /// The address that opens the page with a token.
    pub fn address(&self, token: &str) -> String {
        format!("http://{}/#token={token}", self.hosts[0])
    }

    /// Takes a token of an address that is given away, which goes with the file that holds it, if one does.
    pub fn add(&self, token: String, file: Option<Forward>) {
        held(&self.tokens).push(Token { token, file });
    }

    /// Forgets the tokens of files that no browser has opened, and the files.
    pub fn forget_files(&self) {
        held(&self.tokens).retain(|own| own.file.is_none());
    }

    /// Exchanges a token, once, for the cookie and the key; `None` for any other text.
    pub fn exchange(&self, token: &str) -> Option<(HeaderValue, &str)> {
        let mut tokens = held(&self.tokens);
        let at = tokens.iter().position(|own| same(token, &own.token))?;
        tokens.remove(at);
        let (name, value) = (&self.cookie_name, &self.cookie);
        let cookie =
            format!("{name}={value}; Path=/; HttpOnly; SameSite=Strict; Max-Age={COOKIE_AGE}");
        Some((HeaderValue::try_from(cookie).ok()?, &self.key))
    }

    fn is_host(&self, host: &str) -> bool {
        self.hosts.iter().any(|own| own == host)
    }

    fn has_cookie(&self, headers: &HeaderMap) -> bool {
        let all = headers.get_all("cookie").iter();
        let mut pairs = all
            .filter_map(|value| value.to_str().ok())
            .flat_map(|value| value.split(';'))
            .filter_map(|pair| pair.trim().split_once('='));
        pairs.any(|(name, value)| name == self.cookie_name && same(value, &self.cookie))
    }

    fn has_key(&self, headers: &HeaderMap) -> bool {
        let key = headers.get(KEY).and_then(|value| value.to_str().ok());
        key.is_some_and(|key| same(key, &self.key))
    }

    /// Refuses who may not ask; of others, whether they have shown the cookie.
    fn check(&self, request: &Request) -> Result<bool, Refused> {
        let headers = request.headers();
        let mut hosts = headers.get_all(HOST).iter();
        let host = hosts.next().and_then(|host| host.to_str().ok());
        let authority = request.uri().authority().map(|own| own.as_str());
        let named = host.is_some_and(|host| self.is_host(host)) && hosts.next().is_none();
        if !named || authority.is_some_and(|own| Some(own) != host) {
            return Err(Refused::forbidden("this host name is not served"));
        }
        let reads = [Method::GET, Method::HEAD].contains(request.method());
        let mut origins = headers.get_all(ORIGIN).iter();
        let origin = origins.next();
        let from_here = match origin {
            None => reads,
            // The host is one of ours already.
            Some(origin) => host_of(origin) == host && origins.next().is_none(),
        };
        let site = headers.get(FETCH_SITE).map(HeaderValue::as_bytes);
        let is_tab = headers.get(FETCH_DEST).is_some_and(|own| own == "document");
        let path = request.uri().path();
        let by_hand = reads && !path.starts_with("/api/");
        let same_site = match site {
            None | Some(b"same-origin") => true,
            // Typed, or opened by another program: a page is behind neither.
            Some(b"none") => by_hand,
            // Forwarded by a file. The page is the same for everybody, and asks for the rest by itself.
            Some(_) => reads && path == "/" && is_tab,
        };
        if !from_here || !same_site {
            return Err(Refused::forbidden(
                "pages of other origins are not answered",
            ));
        }
        let cookie = self.has_cookie(headers);
        let known = match path {
            "/api/session" => true,
            path if path.starts_with("/api/") => cookie && self.has_key(headers),
            path if path.starts_with("/open/") => cookie,
            _ => true,
        };
        match known {
            true => Ok(cookie),
            false => Err(Refused::forbidden(
                "open the address that stiction studio printed: this browser has no session",
            )),
        }
    }
}

/// The host of a plain origin.
fn host_of(origin: &HeaderValue) -> Option<&str> {
    origin.to_str().ok()?.strip_prefix("http://")
}

/// Lets through who may ask, as many at once as are taken, and says to the browser what the answer may do.
pub async fn guard(State(shared): State<Arc<Shared>>, request: Request, next: Next) -> Response {
    let mut response = match shared.keys.check(&request) {
        Err(refused) => refused.into_response(),
        // Strangers ask for little, and their connections are few.
        Ok(false) => next.run(request).await,
        Ok(true) => {
            shared.strangers.leave();
            match shared.requests.try_acquire() {
                Err(_) => Refused::busy("too many requests at once").into_response(),
                Ok(_one) => next.run(request).await,
            }
        }
    };
    let headers = response.headers_mut();
    let plain = [
        ("content-security-policy", POLICY),
        ("x-content-type-options", "nosniff"),
        ("referrer-policy", "no-referrer"),
        ("cross-origin-opener-policy", "same-origin"),
        ("cross-origin-resource-policy", "same-origin"),
        ("cache-control", "no-store"),
    ];
    for (name, value) in plain {
        let name = HeaderName::from_static(name);
        headers
            .entry(name)
            .or_insert(HeaderValue::from_static(value));
    }
    response
}
