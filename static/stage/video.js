// A video in the place of the canvas, and the clock that it sets while it plays.
import { StageFailure } from "./failure.js";

/// A video laid over a canvas. It is there only while a video is shown.
export class VideoLayer {
  #canvas;
  #video = null;
  #address = null;

  constructor(canvas) {
    this.#canvas = canvas;
  }

  /// Stands at `ms` of a clip's video, still.
  async show(clip, ms) {
    const video = this.#element(clip);
    video.pause();
    await seek(video, Math.min(ms, clip.duration_ms) / 1000);
  }

  /// Makes room for the canvas.
  hide() {
    if (!this.#video) return;
    this.#video.pause();
    this.#video.hidden = true;
  }

  /// The clock of one play of a clip's video.
  clock(clip) {
    return new VideoClock(this.#element(clip), clip.duration_ms);
  }

  close() {
    this.#video?.remove();
    this.#video = null;
  }

  #element(clip) {
    if (!this.#video) {
      this.#video = document.createElement("video");
      Object.assign(this.#video, { muted: true, playsInline: true, preload: "auto", className: "video", tabIndex: -1 });
      this.#video.setAttribute("aria-hidden", "true");
      this.#canvas.after(this.#video);
    }
    if (this.#address !== clip.video) {
      this.#address = clip.video;
      this.#video.src = clip.video;
    }
    this.#video.hidden = false;
    return this.#video;
  }
}

/// What a browser can play of a video: its duration in ms, or a thrown Error.
export async function videoDuration(address) {
  const video = document.createElement("video");
  video.preload = "auto";
  video.muted = true;
  const loaded = new Promise((resolve, reject) => {
    video.onloadeddata = resolve;
    video.onerror = () => reject(new StageFailure("video", `video: this browser cannot play it (${video.error?.message || "unknown format"})`));
  });
  video.src = address;
  await loaded;
  if (video.duration === Infinity) {
    // Videos that a browser recorded do not say how long they are: their end does.
    const known = new Promise((resolve) => video.addEventListener("seeked", resolve, { once: true }));
    video.currentTime = 1e6;
    await known;
  }
  const ms = (Number.isFinite(video.duration) ? video.duration : video.currentTime) * 1000;
  video.removeAttribute("src");
  if (!(Number.isFinite(ms) && ms > 0)) throw new StageFailure("video", "video: its duration is not known; export it anew");
  return ms;
}

// Frames as they are presented (requestVideoFrameCallback), and the video's time between them.
class VideoClock {
  #video;
  #durationMs;
  #presented = null;
  #fresh = false;
  #endedAt = null;
  #request = 0;

  constructor(video, durationMs) {
    this.#video = video;
    this.#durationMs = durationMs;
  }

  async start() {
    await seek(this.#video, 0);
    if (this.#video.requestVideoFrameCallback) this.#listen();
    await this.#video.play();
  }

  stop() {
    this.#video.cancelVideoFrameCallback?.(this.#request);
    this.#video.pause();
  }

  /// Video time (ms) of what is on the display at `now`; null before the first frame. What stands
  /// beside it may last longer: the time goes on after the video's end.
  at(now) {
    const video = this.#video;
    // The last frame may come together with the end: it is what is on the display now.
    if (video.ended && !this.#fresh) {
      this.#endedAt ??= now;
      return this.#durationMs + (now - this.#endedAt);
    }
    if (!video.requestVideoFrameCallback) {
      this.#fresh = true;
      return video.currentTime * 1000;
    }
    if (this.#presented === null) return null;
    // A video that stalls does not run on.
    const since = Math.min(Math.max(now - this.#presented.at, 0), 100);
    return this.#presented.media + since;
  }

  /// The time of a video frame that came with this frame of the display; null if none came.
  takeFrame() {
    if (!this.#fresh) return null;
    this.#fresh = false;
    return this.#presented?.media ?? this.#video.currentTime * 1000;
  }

  #listen() {
    this.#request = this.#video.requestVideoFrameCallback((now, { mediaTime }) => {
      this.#presented = { at: now, media: mediaTime * 1000 };
      this.#fresh = true;
      this.#listen();
    });
  }
}

async function seek(video, seconds) {
  if (video.readyState < 2) await new Promise((resolve) => video.addEventListener("loadeddata", resolve, { once: true }));
  if (Math.abs(video.currentTime - seconds) < 1e-4 && !video.ended) return;
  const done = new Promise((resolve) => video.addEventListener("seeked", resolve, { once: true }));
  video.currentTime = seconds;
  await done;
}
