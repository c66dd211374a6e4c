//! The researcher's pages.

use axum::http::{StatusCode, header};

use crate::client::TestServer;

pub async fn the_page_needs_the_printed_address(server: &TestServer) {
    let denied = server.get("/researcher").await;
    assert_eq!(denied.status, StatusCode::FORBIDDEN);
    let wrong = server.get("/researcher?key=00112233445566778899aabbccddeeff").await;
    assert_eq!(wrong.status, StatusCode::FORBIDDEN);

    let link = server.app.researcher_link().await.unwrap();
    let admitted = server.get(&link).await;
    assert_eq!(admitted.status, StatusCode::SEE_OTHER);
    assert_eq!(admitted.header(header::LOCATION), "/researcher");
    let cookie = admitted.header(header::SET_COOKIE);
    assert!(cookie.contains("HttpOnly") && cookie.contains("SameSite=Strict"), "{cookie}");
    let cookie = cookie.split(';').next().unwrap();
    let page = server.get_with("/researcher", &[(header::COOKIE, cookie)]).await;
    assert_eq!(page.status, StatusCode::OK);
    // The key of the address is no cookie.
    let key = link.split('=').nth(1).unwrap();
    let forged = format!("mimique_researcher={key}");
    let answer = server.get_with("/researcher", &[(header::COOKIE, &forged)]).await;
    assert_eq!(answer.status, StatusCode::FORBIDDEN);
}
