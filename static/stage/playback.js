// One play of a clip, or of several in step, in the display's clock, and its log; and such logs put one behind the other,
// of clips in turn.
//
// Each animation frame is told the time at which the display's frame began; the picture drawn in it
// is the clip at (that time - the first frame's time). A frame is late when it began more than 1.5
// refresh periods after the one before. The first is one that the display began after the play: on a page
// that was busy, the frame that it is told of may have begun long before. Where one of several is a video,
// the video sets the time, the first of several videos; of a video alone the log has its own frames.
import { refreshPeriod } from "./clock.js";

const LATE = 1.5;
// So long an adapter that is busy at the end may take for the last frame.
const LAST_FRAME_MS = 500;
// A play that shows nothing for so long is lost: its adapter, or its video, gives no frames any more.
const SILENT_MS = 10_000;
// About what a video that is loaded takes from being started to its first frame.
const VIDEO_START_MS = 30;

/// The logs of clips in turn as one; `durationsMs`: how long each clip is, in the log they follow each other.
export function joined(logs, durationsMs) {
  const last = logs[logs.length - 1];
  const most = (name) => Math.max(...logs.map((log) => log[name]));
  let before = 0;
  const frames = logs.flatMap((log, k) => {
    const own = log.frames.map(([now, ms, late]) => [now, before + ms, late]);
    before += durationsMs[k];
    return own;
  });
  return {
    ...last,
    onset_ms: logs[0].onset_ms,
    end_ms: last.end_ms ?? logs.findLast((log) => log.end_ms !== null)?.end_ms ?? null,
    frames,
    late: logs.reduce((sum, log) => sum + log.late, 0),
    longest_ms: most("longest_ms"),
    drift_ms: most("drift_ms"),
  };
}

export class Playback {
  #parts;
  #sound;
  #told;
  #clock;
  // Of further videos.
  #followers;
  #drift = 0;
  #drawn = new Map();
  #frames = [];
  #refreshMs = 1000 / 60;
  #endMs = null;
  #aborted = null;
  #failure = null;
  #finish = null;

  /// `parts`: {draw(clipMs): whether the frame goes to the display} each, or {clock: a video's}. `sound`: heard with the
  /// first frame. `told`: {frame(now, ms), end(now)} in each frame's callback.
  constructor(parts, sound, told) {
    this.#parts = parts;
    this.#sound = sound;
    this.#told = told;
    [this.#clock = null, ...this.#followers] = parts.flatMap((part) => part.clock ?? []);
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
      const due = (this.#aborted === null && (await this.#sound?.start())) || 0;
      // A video takes some time to start, which nobody knows beforehand.
      if (due && this.#clock) await new Promise((resolve) => setTimeout(resolve, due - VIDEO_START_MS - performance.now()));
      if (this.#aborted === null) await Promise.all(this.#clocks().map((clock) => clock.start()));
      if (this.#aborted === null) await new Promise((resolve) => this.#loop(durationMs, due, resolve));
    } finally {
      this.#sound?.stop();
      for (const clock of this.#clocks()) clock.stop();
      document.removeEventListener("visibilitychange", onHidden);
    }
    return this.log(this.#aborted);
  }

  #clocks() {
    return this.#clock ? [this.#clock, ...this.#followers] : [];
  }

  /// Ends the play; the log keeps the first reason.
  abort(reason) {
    this.#aborted ??= reason;
    this.#finish?.();
  }

  /// What was shown so far.
  log(aborted) {
    const frames = this.#judged();
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
      drift_ms: this.#drift,
      aborted,
      failure: this.#failure,
    };
  }

  // A video's frames come at the video's own rate: they are late by that.
  #judged() {
    const frames = this.#frames;
    if (!this.#clock || this.#parts.length > 1 || frames.length < 3) return frames;
    const steps = frames.slice(1).map((frame, k) => frame[1] - frames[k][1]).sort((a, b) => a - b);
    const period = Math.max(this.#refreshMs, steps[steps.length >> 1]);
    return frames.map(([now, ms], k) => [now, ms, k > 0 && now - frames[k - 1][0] > LATE * period ? 1 : 0]);
  }

  // Shows every part at `ms`; the clip time of the frame that this completes, or null. A part whose
  // adapter is busy is drawn in a later frame of the display, before the other one is drawn again.
  #show(ms, now) {
    const video = this.#clock?.takeFrame() ?? null;
    for (const follower of this.#followers) follower.takeFrame();
    const followed = this.#followers.map((follower) => follower.at(now));
    if (followed.includes(null)) return null;
    if (this.#parts.length === 1 && this.#clock) return video;
    for (const part of this.#parts) {
      if (!part.clock && !this.#drawn.has(part) && part.draw(ms)) this.#drawn.set(part, ms);
    }
    const times = [...this.#drawn.values()];
    if (times.length < this.#parts.filter((part) => !part.clock).length) return null;
    // Between two frames of a video the drawn clip goes on.
    if (video !== null) times.push(video);
    if (followed.length > 0) times.push(this.#clock.at(now), ...followed);
    if (times.length === 0) return ms;
    this.#drift = Math.max(this.#drift, Math.max(...times) - Math.min(...times));
    this.#drawn.clear();
    return ms;
  }

  #loop(durationMs, due, resolve) {
    // The first frame is the one nearest to its sound.
    const began = Math.max(performance.now(), due - this.#refreshMs / 2);
    let request = 0;
    const lost = (why) => {
      this.#failure = why;
      this.abort(`renderer lost: ${why}`);
    };
    const watch = setInterval(() => {
      const frame = this.#frames[this.#frames.length - 1];
      if (performance.now() - (frame ? frame[0] : began) > SILENT_MS) lost("no frame for 10 s");
    }, 1000);
    this.#finish = () => {
      cancelAnimationFrame(request);
      clearInterval(watch);
      resolve();
    };
    const tick = (now) => {
      if (this.#aborted !== null) return;
      const frames = this.#frames;
      const sinceOnset = () => (frames.length > 0 ? now - frames[0][0] : now < began ? null : 0);
      const time = this.#clock ? this.#clock.at(now) : sinceOnset();
      if (time === null) {
        request = requestAnimationFrame(tick);
        return;
      }
      const clipMs = Math.min(time, durationMs);
      let shown;
      try {
        shown = this.#show(clipMs, now);
        if (shown !== null) {
          const since = frames.length === 0 ? 0 : now - frames[frames.length - 1][0];
          frames.push([now, shown, since > LATE * this.#refreshMs ? 1 : 0]);
          this.#told?.frame(now, shown);
          this.#sound?.frame(shown);
        }
      } catch (error) {
        lost(String(error?.message ?? error));
        return;
      }
      // A video has no frame for the end.
      const ended = shown !== null || this.#clock || time >= durationMs + LAST_FRAME_MS;
      if (clipMs >= durationMs && frames.length > 0 && ended) {
        this.#endMs = now;
        this.#told?.end(now);
        this.#finish();
        return;
      }
      request = requestAnimationFrame(tick);
    };
    request = requestAnimationFrame(tick);
  }
}
