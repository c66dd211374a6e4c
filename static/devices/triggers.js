// Tells another program on this machine what is shown when: a WebSocket to 127.0.0.1, for EEG, eye trackers and
// whatever records beside the page. Loaded by studies with triggers alone. docs/guide/triggers.md has the messages.

// A program that was not there is looked for again after so long, ms.
const AGAIN_MS = 2000;

/// Milliseconds since 1970 on the page's clock, as every event of the log has them.
const at = (ms) => performance.timeOrigin + ms;

export class Triggers {
  #port;
  #frames;
  #socket = null;
  #number = 0;

  /// `settings`: {port, frames: whether every frame is told}.
  constructor({ port, frames }) {
    this.#port = port;
    this.#frames = frames ?? false;
    this.#open();
  }

  #open() {
    const socket = new WebSocket(`ws://127.0.0.1:${this.#port}/`);
    socket.onopen = () => {
      this.#socket = socket;
    };
    socket.onclose = () => {
      this.#socket = null;
      setTimeout(() => this.#open(), AGAIN_MS);
    };
    // Its clock is compared with ours by what it asks.
    socket.onmessage = ({ data }) => this.#send("pong", { ping: String(data).slice(0, 100), timeMs: at(performance.now()) });
  }

  // Whether the message was handed to the socket: nothing waits for a program that is not there.
  #send(trigger, more) {
    if (this.#socket?.readyState !== WebSocket.OPEN) return false;
    const message = { trigger, number: this.#number, ...more, sentMs: at(performance.now()) };
    this.#socket.send(JSON.stringify(message));
    this.#number += 1;
    return true;
  }

  /// What a play tells: `frame(now, clipMs)` of each frame of the display, in its callback, the first being the onset;
  /// `end(now)`; `sent()`, how many messages of it went out, null where the program was not there at the onset.
  play(shown) {
    let sent = null;
    const count = (went) => {
      if (sent !== null && went) sent += 1;
    };
    let first = true;
    return {
      frame: (now, clipMs) => {
        if (first) sent = this.#send("onset", { ...shown, timeMs: at(now) }) ? 1 : null;
        else if (this.#frames) count(this.#send("frame", { clipMs, timeMs: at(now) }));
        first = false;
      },
      end: (now) => count(this.#send("end", { ...shown, timeMs: at(now) })),
      sent: () => sent,
    };
  }

  /// Tells events of the log: what participant and page do. How a clip was played has been told frame by frame.
  tell(events) {
    for (const { at_ms: timeMs, body } of events) {
      if (body.type !== "trial_played") this.#send("event", { event: body, timeMs });
    }
  }
}
