// The participant's face while clips play, for those who have agreed: camera, the worker that measures, the bar that
// switches the camera off. Loaded by studies that measure faces alone. Numbers are all that it gives.
import { fetchPack } from "../stage/host.js";

// The views of the page at which the camera goes off by itself.
const OVER = ["receipt", "end", "declined", "withdrawn"];
const SIZE = { width: { ideal: 640 }, height: { ideal: 480 } };

/// Why there is no camera; a word of `session::tracked_face`.
export class NoCamera extends Error {
  constructor(why, detail) {
    super(detail ?? why);
    this.why = why;
  }
}

// Kept by this browser where the participant has switched the camera off: a reload does not switch it on again.
const STOPPED = `mimique${location.pathname}mimicry`;

const link = document.createElement("link");
link.rel = "stylesheet";
link.href = new URL("./mimicry.css", import.meta.url);
document.head.append(link);

/// The tracker after a reload: it opens by itself, unless the participant has switched the camera off.
export function resumed(pages) {
  const tracker = new Tracker(pages);
  if (keeps(() => localStorage.getItem(STOPPED)) !== null) {
    tracker.close();
    return tracker;
  }
  tracker.showResuming();
  tracker.open().then(() => tracker.showBar(), (error) => console.warn(`mimicry: ${error.message}`));
  return tracker;
}

/// Somebody is asked anew: what was switched off before counts no more.
export function askedAnew() {
  keeps(() => localStorage.removeItem(STOPPED));
}

export class Tracker {
  #pages;
  #words;
  #stream = null;
  #video = null;
  #worker = null;
  #onMeasured = () => {};
  #busy = false;
  // What plays say as long as nothing is measured.
  #status = "starting";
  #lastMs = -Infinity;
  #clock = "presented";
  #play = null;
  #bar = null;
  #watch = null;

  /// `pages`: study::MimicryPages.
  constructor(pages) {
    this.#pages = pages;
    this.#words = wordsOf(pages);
  }

  /// Opens camera and worker; `onStep("asking" | "loading")`. Throws a NoCamera.
  async open(onStep = () => {}) {
    this.#status = "starting";
    if (!navigator.mediaDevices?.getUserMedia) throw this.#failed(new NoCamera("insecure"));
    try {
      onStep("asking");
      this.#stream = await navigator.mediaDevices.getUserMedia({ audio: false, video: { ...SIZE, facingMode: "user", frameRate: { ideal: this.#pages.rateHz } } });
      onStep("loading");
      this.#video = Object.assign(document.createElement("video"), { srcObject: this.#stream, muted: true, playsInline: true });
      await this.#video.play();
      this.#stream.getVideoTracks()[0].onended = () => this.#close("lost");
      await this.#startWorker();
    } catch (error) {
      const why = { NotAllowedError: "refused", NotFoundError: "no_camera", OverconstrainedError: "no_camera", NotReadableError: "no_camera" }[error?.name];
      throw this.#failed(error instanceof NoCamera ? error : new NoCamera(why ?? "failed", error?.message));
    }
    this.#status = "tracked";
    this.#watch = new MutationObserver(() => {
      if (OVER.includes(document.querySelector("main[data-view]")?.dataset.view)) this.#close("stopped");
    });
    this.#watch.observe(document.getElementById("app"), { subtree: true, childList: true, attributes: true, attributeFilter: ["data-view"] });
    this.#next();
  }

  /// The participant's own picture, for the page on which the camera is tried. What is measured is another element, which
  /// never stands on a page: browsers pause a video that is taken off one.
  ownPicture() {
    return Object.assign(document.createElement("video"), { srcObject: this.#stream, muted: true, playsInline: true, autoplay: true });
  }

  /// Calls back with whether each measured picture has a face.
  onFace(callback) {
    this.#onMeasured = callback;
  }

  /// What a play measures: `frame(now)` of each frame of the display, the first being the onset; `log()` afterwards.
  play() {
    const play = (this.#play = { onset: null, frames: [], clock: null });
    return {
      frame: (now) => (play.onset ??= now),
      log: () => {
        if (this.#play === play) this.#play = null;
        const { onset, frames, clock } = play;
        const { model } = this.#pages.files;
        const after = ([at, scores]) => [Math.round((at - onset) * 1000) / 1000, ...scores];
        // What was taken before the onset, or waits for its play in vain, is not sent.
        const seen = onset === null ? [] : frames.filter(([at]) => at >= onset).map(after);
        return { status: this.#status, clock: clock ?? "", model, frames: seen };
      },
    };
  }

  /// Shows, at the foot of the page, that the camera is on, with the button that switches it off.
  showBar() {
    const stop = made("button", { type: "button", className: "quiet", textContent: this.#words.mimicry_stop });
    stop.dataset.action = "mimicry-stop";
    stop.onclick = () => {
      keeps(() => localStorage.setItem(STOPPED, ""));
      this.#close("stopped");
      this.#say(this.#words.mimicry_stopped);
    };
    this.#setBar(made("p", { textContent: this.#words.mimicry_bar }), stop);
  }

  /// Says at the foot of the page that the camera is being switched on again.
  showResuming() {
    this.#setBar(made("p", { textContent: this.#words.mimicry_resuming }));
  }

  /// Gives the camera back.
  close() {
    this.#close("stopped");
  }

  #failed(error) {
    this.#close(error.why === "failed" ? "failed" : "lost");
    return error;
  }

  #close(status) {
    this.#status = status;
    this.#watch?.disconnect();
    this.#stream?.getTracks().forEach((track) => track.stop());
    this.#worker?.terminate();
    if (this.#video) this.#video.srcObject = null;
    [this.#stream, this.#worker, this.#video] = [null, null, null];
    if (status !== "stopped" && this.#bar) this.#say(this.#words.mimicry_lost);
    else this.#bar?.remove();
  }

  #say(text) {
    const close = made("button", { type: "button", className: "quiet", textContent: this.#words.mimicry_close });
    close.onclick = () => this.#bar.remove();
    this.#setBar(made("p", { textContent: text }), close);
  }

  #setBar(...parts) {
    this.#bar?.remove();
    this.#bar = made("div", { className: "mimicry-bar", role: "status" }, ...parts);
    document.body.append(this.#bar);
  }

  async #startWorker() {
    const { bundle, loader, module, model } = this.#pages.files;
    const address = (hash, ending) => new URL(`/packs/${hash}.${ending}`, location.href).href;
    const worker = (this.#worker = new Worker(new URL("./worker.js", import.meta.url), { type: "module" }));
    const bytes = await fetchPack(model);
    const begin = { bundle: address(bundle, "js"), loader: address(loader, "js"), module: address(module, "wasm"), model: bytes, shapes: this.#pages.shapes };
    await new Promise((resolve, reject) => {
      const fail = (detail) => reject(new NoCamera("failed", detail));
      worker.onerror = (event) => (fail(event.message), this.#close("failed"));
      worker.onmessage = ({ data }) => {
        if (data.ready) resolve();
        else if (data.failed) (fail(data.failed), this.#close("failed"));
        else this.#measured(data);
      };
      worker.postMessage({ begin });
    });
  }

  // Waits for the camera's next picture. One is measured at a time: what comes meanwhile is passed over.
  #next() {
    const video = this.#video;
    if (!video) return;
    const take = (now, { captureTime } = {}) => {
      if (this.#video !== video) return;
      this.#take(video, captureTime ?? now, captureTime === undefined ? "presented" : "capture");
      this.#next();
    };
    if (video.requestVideoFrameCallback) video.requestVideoFrameCallback(take);
    else setTimeout(() => take(performance.now()), 1000 / this.#pages.rateHz);
  }

  async #take(video, atMs, clock) {
    const wanted = this.#play || this.#onMeasured.isOpen;
    // A camera's clock is never quite even: a tenth of a period early is on time.
    if (this.#busy || !wanted || atMs - this.#lastMs < 900 / this.#pages.rateHz) return;
    this.#busy = true;
    this.#lastMs = atMs;
    this.#clock = clock;
    try {
      const picture = await createImageBitmap(video);
      this.#worker.postMessage({ picture, atMs }, [picture]);
    } catch {
      this.#busy = false;
    }
  }

  #measured({ atMs, scores }) {
    this.#busy = false;
    if (this.#play) {
      this.#play.clock ??= this.#clock;
      this.#play.frames.push([atMs, scores]);
    }
    this.#onMeasured(scores.length > 0);
  }
}

/// The words of the page in its language.
export function wordsOf({ words }) {
  return words[document.documentElement.lang] ?? Object.values(words)[0];
}

export function made(tag, properties, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  if (properties.role) element.setAttribute("role", properties.role);
  element.append(...children);
  return element;
}

// Where all cookies are blocked nothing is kept.
function keeps(act) {
  try {
    return act();
  } catch {
    return null;
  }
}
