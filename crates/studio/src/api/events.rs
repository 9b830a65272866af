//! What becomes of work, as server-sent events.

use super::App;
use crate::refused::Refused;
use axum::extract::State;
use axum::response::sse::{Event, KeepAlive, Sse};
use futures_core::Stream;
use std::convert::Infallible;
use std::pin::Pin;
use std::task::{Context, Poll};
use tokio::sync::mpsc::Receiver;

/// The messages of one tab.
pub struct Messages(Receiver<String>);

impl Stream for Messages {
    type Item = Result<Event, Infallible>;

    fn poll_next(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        let message = self.0.poll_recv(cx);
        message.map(|text| text.map(|text| Ok(Event::default().data(text))))
    }
}

/// All work as it is, then every change.
pub async fn events(
    State(shared): App,
) -> Result<Sse<impl Stream<Item = Result<Event, Infallible>>>, Refused> {
    let messages = Messages(shared.jobs.watch()?);
    Ok(Sse::new(messages).keep_alive(KeepAlive::default()))
}
