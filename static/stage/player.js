// Plays the clips of several panels in step, by the clock of the display: scrub, loop, slow motion.
// A panel has: clip() -> {duration_ms, rate_hz} or null, draw(timeMs) -> whether it was drawn, drawn
// (frames, ever), turn().

const $ = (id) => document.getElementById(id);

/// What keys do and the page's buttons `play`, `back`, `forth`, `loop`, `speed`, `view`, `scrub`, `clock`.
export class Player {
  panels = [];
  timeMs = 0;
  playing = false;
  /// Part that is played, ms; null = all.
  part = null;
  /// Called with the time after each draw.
  onDraw = () => {};
  /// Called each second with frames per second and the longest frame, ms.
  onRate = () => {};
  /// What the button says that plays and pauses.
  words = { play: "Play", pause: "Pause" };
  /// How seconds are written.
  written = (seconds) => seconds.toFixed(2);
  #last = null;
  #drawn = 0;
  #since = null;
  #longest = 0;

  durationMs() {
    return Math.max(0, ...this.panels.map((panel) => panel.clip()?.duration_ms ?? 0));
  }

  frameMs() {
    const rates = this.panels.map((panel) => panel.clip()?.rate_hz ?? 0);
    return 1000 / Math.max(...rates, 1);
  }

  /// One frame on (1) or back (-1).
  step(by) {
    this.pause();
    this.seek(this.timeMs + by * this.frameMs());
  }

  #range() {
    return this.part ?? [0, this.durationMs()];
  }

  seek(timeMs) {
    this.timeMs = Math.min(Math.max(timeMs, 0), this.durationMs());
    this.draw();
  }

  draw() {
    const drawn = this.panels.map((panel) => panel.draw(this.timeMs));
    // A busy adapter takes the frame later; a play draws anew anyway.
    if (!this.playing && drawn.includes(false)) requestAnimationFrame(() => this.playing || this.draw());
    const duration = this.durationMs();
    const scrub = $("scrub");
    scrub.max = Math.max(1, Math.round(duration));
    scrub.value = Math.round(this.timeMs);
    const text = `${this.written(this.timeMs / 1000)} / ${this.written(duration / 1000)} s`;
    $("clock").textContent = text;
    scrub.setAttribute("aria-valuetext", text);
    this.onDraw(this.timeMs);
  }

  toggle() {
    if (this.playing) return this.pause();
    if (this.durationMs() === 0) return;
    const [from, to] = this.#range();
    if (this.timeMs >= to || this.timeMs < from) this.timeMs = from;
    this.playing = true;
    this.#last = null;
    this.#since = null;
    $("play").textContent = this.words.pause;
    requestAnimationFrame((now) => this.#tick(now));
  }

  pause() {
    this.playing = false;
    $("play").textContent = this.words.play;
  }

  #tick(now) {
    if (!this.playing) return;
    if (this.#last !== null) this.timeMs += (now - this.#last) * Number($("speed").value);
    this.#count(now);
    this.#last = now;
    const [from, to] = this.#range();
    if (this.timeMs >= to) {
      if ($("loop").checked && to > from) this.timeMs = from + ((this.timeMs - from) % (to - from));
      else {
        this.timeMs = to;
        this.draw();
        return this.pause();
      }
    }
    this.draw();
    requestAnimationFrame((next) => this.#tick(next));
  }

  // Frames a second and the longest frame, over each second.
  #count(now) {
    if (this.#since === null) {
      [this.#since, this.#drawn, this.#longest] = [now, this.#framesDrawn(), 0];
      return;
    }
    this.#longest = Math.max(this.#longest, now - this.#last);
    if (now - this.#since < 1000) return;
    this.onRate((1000 * (this.#framesDrawn() - this.#drawn)) / (now - this.#since), this.#longest);
    [this.#since, this.#drawn, this.#longest] = [now, this.#framesDrawn(), 0];
  }

  // Of the panel that drew most.
  #framesDrawn() {
    return Math.max(0, ...this.panels.map((panel) => panel.drawn));
  }

  /// Joins the page's controls with the list of views; `more` are further keys.
  wire(more = {}) {
    this.wireControls();
    $("view").addEventListener("change", () => {
      for (const panel of this.panels) panel.turn();
      this.draw();
    });
    this.wireKeys({ v: () => cycle($("view")), ...more });
  }

  /// Joins keys and the window's size, for a page without views.
  wireKeys(more = {}) {
    const keys = {
      " ": () => this.toggle(),
      ",": () => this.step(-1),
      ".": () => this.step(1),
      l: () => ($("loop").checked = !$("loop").checked),
      s: () => cycle($("speed")),
      ...more,
    };
    addEventListener("keydown", (event) => onKey(event, keys));
    addEventListener("resize", () => this.playing || this.draw());
  }

  /// Joins the controls alone, for a page with keys and views of its own.
  wireControls() {
    $("play").addEventListener("click", () => this.toggle());
    $("back").addEventListener("click", () => this.step(-1));
    $("forth").addEventListener("click", () => this.step(1));
    $("scrub").addEventListener("input", () => (this.pause(), this.seek(Number($("scrub").value))));
  }
}

function cycle(select) {
  select.selectedIndex = (select.selectedIndex + 1) % select.options.length;
  select.dispatchEvent(new Event("change"));
}

function onKey(event, keys) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const inControl = event.target.closest("select, button, input, a, summary, [tabindex='0']");
  // A control keeps its own keys: typing chooses in a list, Space presses a button.
  if (inControl?.matches("select, input:not([type=range]):not([type=checkbox])") || (inControl && event.key === " ")) return;
  const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!act) return;
  event.preventDefault();
  act();
}

/// A new element.
export function made(tag, properties, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name in element) element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}
