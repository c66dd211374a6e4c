//! Researchers as browsers and scripts: log in, read pages, send their forms.

use axum::body::Body;
use axum::http::{Method, Request, StatusCode, header};
use mimique_storage::Role;

use crate::client::{Answer, TestServer};

/// The server's name in these tests.
pub const HOST: &str = "mimique.test";
/// A page of this server as the origin of a form.
pub const ORIGIN: &str = "http://mimique.test";
/// Everybody's password.
pub const PASSWORD: &str = "four words are good";

/// A browser: its cookies and the token of its forms.
#[derive(Debug, Clone, Default)]
pub struct Browser {
    pub cookies: Vec<(String, String)>,
    pub csrf: String,
}

impl Browser {
    /// Opens a page; its cookies and the token of its forms are kept.
    pub async fn open(&mut self, server: &TestServer, path: &str) -> Answer {
        let request = Request::get(path)
            .header(header::HOST, HOST)
            .header(header::ACCEPT, "text/html,*/*;q=0.8")
            .header(header::COOKIE, self.cookie())
            .body(Body::empty())
            .unwrap();
        let answer = server.send(request).await;
        self.keep(&answer);
        answer
    }

    /// Sends a form of the page that is open.
    pub async fn send(
        &mut self,
        server: &TestServer,
        path: &str,
        fields: &[(&str, &str)],
    ) -> Answer {
        let csrf = self.csrf.clone();
        let fields: Vec<_> = fields.iter().copied().chain([("csrf", csrf.as_str())]).collect();
        self.send_from(server, path, &fields, Some(ORIGIN)).await
    }

    /// Sends fields as they are, from a page of this origin.
    pub async fn send_from(
        &mut self,
        server: &TestServer,
        path: &str,
        fields: &[(&str, &str)],
        origin: Option<&str>,
    ) -> Answer {
        let mut request = Request::post(path)
            .header(header::HOST, HOST)
            .header(header::COOKIE, self.cookie())
            .header(header::CONTENT_TYPE, "application/x-www-form-urlencoded");
        if let Some(origin) = origin {
            request = request.header(header::ORIGIN, origin);
        }
        let answer = server.send(request.body(Body::from(encoded(fields))).unwrap()).await;
        self.keep(&answer);
        answer
    }

    pub fn cookie(&self) -> String {
        self.cookies
            .iter()
            .map(|(name, value)| format!("{name}={value}"))
            .collect::<Vec<_>>()
            .join("; ")
    }

    pub fn cookie_value(&self, name: &str) -> Option<&str> {
        self.cookies.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }

    fn keep(&mut self, answer: &Answer) {
        for cookie in answer.headers.get_all(header::SET_COOKIE) {
            let text = cookie.to_str().unwrap();
            let (name, value) = text.split(';').next().unwrap().split_once('=').unwrap();
            self.cookies.retain(|(known, _)| known != name);
            if !value.is_empty() {
                self.cookies.push((name.to_owned(), value.to_owned()));
            }
        }
        let text = answer.text();
        if let Some((_, rest)) = text.split_once("name=\"csrf\" value=\"") {
            self.csrf = rest.split('"').next().unwrap().to_owned();
        }
    }
}

/// Fields as a form's body.
pub fn encoded(fields: &[(&str, &str)]) -> String {
    let escaped = |text: &str| -> String {
        text.bytes()
            .map(|byte| match byte {
                b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' => char::from(byte).to_string(),
                _ => format!("%{byte:02X}"),
            })
            .collect()
    };
    let pairs: Vec<_> = fields
        .iter()
        .map(|(name, value)| format!("{}={}", escaped(name), escaped(value)))
        .collect();
    pairs.join("&")
}

/// The first owner, logged in.
pub async fn owner(server: &TestServer) -> Browser {
    let link = server.app.first_owner_link().await.unwrap().expect("there is no account yet");
    let mut browser = Browser::default();
    assert_eq!(browser.open(server, &link).await.status, StatusCode::OK);
    let fields = [("email", "Owner@Example.org"), ("password", PASSWORD)];
    let made = browser.send(server, &link, &fields).await;
    assert_eq!(made.status, StatusCode::SEE_OTHER, "{}", made.text());
    browser.open(server, "/researcher/account").await;
    browser
}

/// Somebody invited by the owner, logged in.
pub async fn invited(server: &TestServer, owner: &mut Browser, role: Role) -> Browser {
    // The first owner has the name already.
    let name = if role == Role::Owner { "second" } else { role.word() };
    let email = format!("{name}@example.org");
    let fields = [("email", email.as_str()), ("role", role.word())];
    let page = owner.send(server, "/researcher/people/invite", &fields).await;
    let link = link_in(&page);
    let mut browser = Browser::default();
    browser.open(server, &link).await;
    let fields = [("email", email.as_str()), ("password", PASSWORD)];
    let made = browser.send(server, &link, &fields).await;
    assert_eq!(made.status, StatusCode::SEE_OTHER, "{}", made.text());
    browser.open(server, "/researcher/account").await;
    browser
}

/// The path of the link that a page shows.
pub fn link_in(page: &Answer) -> String {
    let text = page.text();
    let start = text.find("/researcher/link/").unwrap_or_else(|| panic!("no link in {text}"));
    text[start..].split('<').next().unwrap().to_owned()
}

/// Asks as a script does, with a token.
pub async fn script(server: &TestServer, method: Method, path: &str, token: &str) -> Answer {
    let request = Request::builder()
        .method(method)
        .uri(path)
        .header(header::AUTHORIZATION, format!("Bearer {token}"))
        .header(header::CONTENT_TYPE, "application/x-www-form-urlencoded")
        .body(Body::empty())
        .unwrap();
    server.send(request).await
}

/// A token of this role, made by one who is logged in.
pub async fn token(server: &TestServer, browser: &mut Browser, role: Role) -> String {
    let fields = [("name", "nightly"), ("role", role.word())];
    let page = browser.send(server, "/researcher/tokens", &fields).await.text();
    let start = page.find("mimique_").unwrap_or_else(|| panic!("no token in {page}"));
    page[start..].split('<').next().unwrap().to_owned()
}
