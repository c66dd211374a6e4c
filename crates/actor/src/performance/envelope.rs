//! How an action rises, stays and falls.

/// Minimum-jerk rise from 0 to 1 (Flash & Hogan 1985), `t` in seconds from its start.
pub(super) fn rise(t: f64, duration: f64) -> f64 {
    let x = (t / duration).clamp(0.0, 1.0);
    x * x * x * (10.0 + x * (6.0 * x - 15.0))
}

/// Rest, attack, apex, release, rest.
#[derive(Debug, Clone, Copy)]
pub(super) struct Envelope {
    pub start: f64,
    pub attack: f64,
    pub release_at: f64,
    pub release: f64,
}

impl Envelope {
    pub(super) fn at(&self, t: f64) -> f64 {
        rise(t - self.start, self.attack) * (1.0 - rise(t - self.release_at, self.release))
    }
}

/// A blink that begins at `start`: lids fall in 90 ms, rest 30 ms, rise in 170 ms.
pub(super) fn blink(t: f64, start: f64) -> f64 {
    Envelope { start, attack: 0.09, release_at: start + 0.12, release: 0.17 }.at(t)
}
