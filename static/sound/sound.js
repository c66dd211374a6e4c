// The sound of clips: decoded ahead, started by the audio clock so that what belongs to the first frame is heard with
// it, measured against the display's clock while the clip is played; and the captions below the clip.
// Loaded by studies with sound alone.

// So long before the first frame a sound is scheduled, beside the output's own latency, ms.
const LEAD_MS = 120;
// A context that does not run after so long is suspended, ms.
const WAKE_MS = 1200;
// Sounds that begin or end in the middle of a file do so without a click, s.
const FADE_S = 0.004;
// Most frames over which the mapping of the clocks is taken, at the beginning and at the end.
const FRAMES = 15;
const KEPT = "mimique-captions";

let shared = null;
let missing = false;

/// The one audio context, asked to run: browsers let it after a press alone. Null where there is none.
export function wake() {
  try {
    shared ??= new AudioContext({ latencyHint: "interactive" });
  } catch {
    missing = true;
    return null;
  }
  if (shared.state !== "running") shared.resume().catch(() => {});
  return shared;
}

for (const press of ["click", "keydown", "touchend"]) addEventListener(press, wake, true);

const link = Object.assign(document.createElement("link"), { rel: "stylesheet" });
link.href = new URL("./sound.css", import.meta.url);
document.head.append(link);

/// The context once its clock runs; null where the browser does not let it.
export async function running() {
  const context = wake();
  if (!context) return null;
  const until = performance.now() + WAKE_MS;
  const runs = () => context.state === "running" && context.currentTime > 0;
  while (!runs() && performance.now() < until) await pause(20);
  return runs() ? context : null;
}

/// Which of the audio clock's times (s) is heard at which of the page's (ms, performance.now), the output's latency
/// (ms) that lies in it, and where that is from.
export function outputClock(context) {
  const now = performance.now();
  const current = context.currentTime;
  const stamp = context.getOutputTimestamp?.();
  if (stamp?.performanceTime > 0 && stamp.contextTime > 0) {
    const zero = stamp.performanceTime - stamp.contextTime * 1000;
    return { zero, latency: zero + current * 1000 - now, source: "timestamp" };
  }
  const source = context.outputLatency > 0 ? "outputLatency" : context.baseLatency > 0 ? "baseLatency" : "none";
  const latency = source === "none" ? 0 : context[source] * 1000;
  return { zero: now + latency - current * 1000, latency, source };
}

/// A clip's sound (`wire.ClipSource.sound`) of the bytes of its file. What cannot be decoded is said by its log.
export async function loadSound(source, bytes) {
  // Decoding asks for no press, unlike playing.
  const decoder = new OfflineAudioContext(1, 1, 48_000);
  const buffer = await decoder.decodeAudioData(bytes.slice().buffer).catch(() => null);
  return new ClipSound(source, buffer);
}

class ClipSound {
  #source;
  #buffer;
  #context = null;
  #node = null;
  #gain = null;
  #status = "not_started";
  // When the sound of the first frame is heard, audio clock, s.
  #reference = 0;
  // Of each drawn frame: the page's time at which the audio clock's 0 is heard.
  #zeros = [];
  #clock = { latency: null, source: "none" };
  #captions = false;
  #watch = () => {
    if (this.#context.state !== "running") this.#status = "interrupted";
  };

  constructor(source, buffer) {
    this.#source = source;
    this.#buffer = buffer;
  }

  /// Schedules the sound; resolves with the time (performance.now) at which that of the first frame is heard without
  /// a delay, or with 0 where nothing is.
  async start() {
    this.stop();
    this.#zeros = [];
    this.#clock = { latency: null, source: "none" };
    this.#captions = captionsShown();
    this.#status = "undecodable";
    if (!this.#buffer) return 0;
    this.#status = missing ? "no_audio" : "suspended";
    const context = await running();
    if (!context) return 0;
    const clock = outputClock(context);
    const due = performance.now() + LEAD_MS + Math.max(clock.latency, 0);
    this.#clock = clock;
    this.#context = context;
    this.#schedule((due - clock.zero) / 1000);
    context.addEventListener("statechange", this.#watch);
    this.#status = "played";
    return due;
  }

  /// Plays from `clipMs` on, at once and unmeasured: for the preview.
  async playFrom(clipMs) {
    this.stop();
    const context = this.#buffer ? await running() : null;
    if (context) {
      this.#context = context;
      this.#schedule(context.currentTime + 0.02, clipMs / 1000);
    }
  }

  // `at`: audio clock, s; the clip stands at `clipS` then.
  #schedule(at, clipS = 0) {
    const { from_s, length_s, delay_ms } = this.#source;
    const delay = delay_ms / 1000;
    this.#reference = at - clipS + delay;
    const skipped = Math.max(clipS - delay, 0);
    const end = Math.min(length_s ?? Infinity, this.#buffer.duration - from_s);
    if (skipped >= end) return;
    const begins = at + Math.max(delay - clipS, 0);
    this.#gain = this.#context.createGain();
    this.#gain.connect(this.#context.destination);
    const level = this.#gain.gain;
    if (from_s + skipped > 0) level.setValueAtTime(0, begins).linearRampToValueAtTime(1, begins + FADE_S);
    if (length_s != null) {
      const ends = begins + end - skipped;
      level.setValueAtTime(1, Math.max(ends - FADE_S, begins + FADE_S)).linearRampToValueAtTime(0, ends);
    }
    this.#node = this.#context.createBufferSource();
    this.#node.buffer = this.#buffer;
    this.#node.connect(this.#gain);
    this.#node.start(begins, from_s + skipped, end - skipped);
  }

  /// A frame was drawn: the clocks are compared, and the caption of this time is shown.
  frame(clipMs) {
    if (this.#context && this.#node) this.#zeros.push(outputClock(this.#context).zero);
    this.caption(clipMs);
  }

  /// Shows the caption of a time of the clip.
  caption(clipMs) {
    showCaption(this.captionAt(clipMs));
  }

  /// What is said at a time of the clip, in the language of the page.
  captionAt(clipMs) {
    const seconds = (clipMs - this.#source.delay_ms) / 1000;
    const now = this.#source.captions?.find(({ fromS, toS }) => fromS <= seconds && seconds < toS);
    return now ? inLanguage(now.text) : "";
  }

  stop() {
    showCaption("");
    this.#context?.removeEventListener("statechange", this.#watch);
    const [node, gain] = [this.#node, this.#gain];
    this.#node = null;
    if (!node) return;
    const now = this.#context.currentTime;
    gain.gain.cancelScheduledValues(now);
    gain.gain.setTargetAtTime(0, now, FADE_S / 3);
    node.stop(now + FADE_S * 2);
  }

  /// What was heard (`session::SoundLog`); `onset`: when the first frame was drawn, performance.now.
  log(onset) {
    const part = Math.min(FRAMES, Math.ceil(this.#zeros.length / 3));
    const first = median(this.#zeros.slice(0, part));
    const last = median(this.#zeros.slice(this.#zeros.length - part));
    const heard = first !== null && onset !== null;
    const { latency, source } = this.#clock;
    return {
      status: this.#status,
      offset_ms: heard ? thousandth(first + this.#reference * 1000 - onset) : null,
      delay_ms: this.#source.delay_ms,
      drift_ms: heard ? thousandth(last - first) : null,
      latency_ms: latency === null ? null : thousandth(latency),
      latency_source: source,
      captions: this.#captions,
      file: this.#source.file,
    };
  }
}

// Captions ------------------------------------------------------------------

let shown = sessionStorageGet();
let place = null;

/// Takes the place below the clip for captions: `data-captions` is "on", "off" or "offered", `data-label` what the
/// button says.
export function attachCaptions(node) {
  const { captions, label } = node.dataset;
  place = captions === "off" ? null : { node, line: document.createElement("p"), rule: captions };
  if (!place) return;
  place.line.className = "caption-line";
  place.line.hidden = !captionsShown();
  node.append(place.line);
  if (captions === "offered") {
    const button = Object.assign(document.createElement("button"), { type: "button", textContent: label });
    button.dataset.action = "captions";
    button.setAttribute("aria-pressed", String(shown));
    button.onclick = () => {
      shown = !shown;
      keep(shown);
      button.setAttribute("aria-pressed", String(shown));
      place.line.hidden = !captionsShown();
    };
    node.append(button);
  }
}

function captionsShown() {
  return place !== null && (place.rule === "on" || shown);
}

function showCaption(text) {
  if (place && place.line.textContent !== text) place.line.textContent = text;
}

function inLanguage(text) {
  if (typeof text === "string") return text;
  return text[document.documentElement.lang] ?? text.en ?? Object.values(text)[0] ?? "";
}

// A reload keeps the choice; where the browser keeps nothing, the page does.
function sessionStorageGet() {
  try {
    return sessionStorage.getItem(KEPT) === "on";
  } catch {
    return false;
  }
}

function keep(on) {
  try {
    sessionStorage.setItem(KEPT, on ? "on" : "off");
  } catch {
    // Kept in memory.
  }
}

function median(numbers) {
  if (numbers.length === 0) return null;
  const sorted = [...numbers].sort((a, b) => a - b);
  return sorted[sorted.length >> 1];
}

function thousandth(ms) {
  return Math.round(ms * 1000) / 1000;
}

function pause(ms) {
  return new Promise((resolve) => setTimeout(resolve, ms));
}
