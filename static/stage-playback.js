// One play of a clip in the display's clock, and its log.
//
// Each animation frame is told the time at which the display's frame began; the picture drawn in it
// is the clip at (that time - the first frame's time). A frame is late when it began more than 1.5
// refresh periods after the one before.
import { refreshPeriod } from "./stage-clock.js";

const LATE = 1.5;

export class Playback {
  #draw;
  #frames = [];
  #refreshMs = 1000 / 60;
  #endMs = null;
  #aborted = null;
  #failure = null;
  #finish = null;

  /// `draw(clipMs)` draws and answers whether the frame goes to the display.
  constructor(draw) {
    this.#draw = draw;
  }

  /// Plays from 0 to `durationMs`; resolves with the log.
  async run(durationMs) {
    this.#refreshMs = await refreshPeriod();
    if (this.#aborted !== null) return this.log(this.#aborted);
    const onHidden = () => {
      if (document.hidden) this.abort("page hidden");
    };
    document.addEventListener("visibilitychange", onHidden);
    try {
      onHidden();
      if (this.#aborted === null) await new Promise((resolve) => this.#loop(durationMs, resolve));
    } finally {
      document.removeEventListener("visibilitychange", onHidden);
    }
    return this.log(this.#aborted);
  }

  /// Ends the play; the log keeps the first reason.
  abort(reason) {
    this.#aborted ??= reason;
    this.#finish?.();
  }

  /// What was shown so far.
  log(aborted) {
    const frames = this.#frames;
    const onset = frames.length > 0 ? frames[0][0] : null;
    let longest = 0;
    for (let i = 1; i < frames.length; i++) longest = Math.max(longest, frames[i][0] - frames[i - 1][0]);
    return {
      onset_ms: onset,
      end_ms: this.#endMs ?? (frames.length > 0 ? frames[frames.length - 1][0] : null),
      refresh_hz: 1000 / this.#refreshMs,
      frames,
      late: frames.reduce((sum, frame) => sum + frame[2], 0),
      longest_ms: longest,
      aborted,
      failure: this.#failure,
    };
  }

  #loop(durationMs, resolve) {
    let request = 0;
    this.#finish = () => {
      cancelAnimationFrame(request);
      resolve();
    };
    const tick = (now) => {
      if (this.#aborted !== null) return;
      const frames = this.#frames;
      const clipMs = frames.length === 0 ? 0 : Math.min(now - frames[0][0], durationMs);
      try {
        if (this.#draw(clipMs)) {
          const since = frames.length === 0 ? 0 : now - frames[frames.length - 1][0];
          frames.push([now, clipMs, since > LATE * this.#refreshMs ? 1 : 0]);
        }
      } catch (error) {
        this.#failure = String(error?.message ?? error);
        this.abort(`renderer lost: ${this.#failure}`);
        return;
      }
      if (clipMs >= durationMs && frames.length > 0) {
        this.#endMs = now;
        resolve();
        return;
      }
      request = requestAnimationFrame(tick);
    };
    request = requestAnimationFrame(tick);
  }
}
