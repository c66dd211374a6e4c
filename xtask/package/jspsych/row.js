// The clips of a trial: elements <mimique-stage> beside each other. They are kept from trial to trial, so that their
// canvases open once.

const LOADED_MS = 20_000;

// Elements that no trial shows, in a place of the page that is not seen.
let parked = null;

export class Row {
  #elements;
  #trial;
  #grid = document.createElement("div");
  #display;

  /** The element's class, once the page has loaded it. */
  static async element() {
    const late = new Promise((_, fail) => {
      const why = "plugin-mimique: <mimique-stage> is not there; load element.js of @mimique/stage by a script of type module";
      setTimeout(() => fail(new Error(why)), LOADED_MS);
    });
    return Promise.race([customElements.whenDefined("mimique-stage"), late]);
  }

  constructor(display, trial) {
    [this.#display, this.#trial] = [display, trial];
    this.#grid.className = "mimique-clips";
    const size = `minmax(0, ${trial.clip_size}px)`;
    const columns = trial.columns ?? Math.min(trial.clips.length, trial.clips.length > 4 ? 3 : trial.clips.length);
    Object.assign(this.#grid.style, {
      display: "grid",
      gridTemplateColumns: `repeat(${columns}, ${size})`,
      gap: "12px",
      justifyContent: "center",
      margin: "0 auto 1em",
    });
    display.append(this.#grid);
  }

  /** Resolves once every clip's first frame stands. */
  async ready() {
    await Row.element();
    const kept = parked ? [...parked.children] : [];
    this.#elements = this.#trial.clips.map((clip, k) => {
      const element = kept[k] ?? document.createElement("mimique-stage");
      const label = this.#trial.clip_labels[k];
      const figure = document.createElement("figure");
      Object.assign(figure.style, { margin: "0" });
      if (label) {
        const caption = document.createElement("figcaption");
        caption.textContent = label;
        figure.append(caption);
      }
      element.style.width = "100%";
      element.setAttribute("background", this.#trial.background);
      element.setAttribute("label", label ?? `Clip ${k + 1}`);
      put(element, clip);
      figure.append(element);
      this.#grid.append(figure);
      element.view({ yaw: 0, pitch: 0, zoom: 1, ...this.#trial.view });
      return element;
    });
    await Promise.all(this.#elements.map((element) => element.seek(0)));
  }

  /** Milliseconds from the first frame to the last. */
  get duration() {
    const each = this.#elements.map((element) => element.duration);
    return this.#trial.in_turn ? each.reduce((sum, ms) => sum + ms, 0) : Math.max(...each);
  }

  /** Plays them; `onset` is told when the first frame is shown. */
  play(onset) {
    let isShown = false;
    const told = {
      frame: (now) => {
        if (isShown) return;
        isShown = true;
        onset(now);
      },
    };
    const [first, ...beside] = this.#elements;
    return first.play({ beside, inTurn: this.#trial.in_turn, heard: this.#trial.sound, told });
  }

  stop(why) {
    this.#elements[0].stop(why);
  }

  /** Resolves when the person asks for another play. */
  again(label) {
    const button = document.createElement("button");
    button.className = "jspsych-btn mimique-again";
    button.textContent = label;
    this.#grid.after(button);
    button.focus();
    return new Promise((done) => button.addEventListener("click", () => (button.remove(), done()), { once: true }));
  }

  data(log, saveFrames) {
    const each = log.panel ?? [];
    const provenance = [log.provenance, log.beside_provenance, ...each.slice(2).map((clip) => clip.provenance)];
    const hashes = this.#elements.map((element) => element.summary.weights_hash);
    return {
      clips: log.clips,
      provenance: provenance.slice(0, this.#elements.length),
      weights_hash: hashes,
      onset_ms: log.onset_ms,
      end_ms: log.end_ms,
      frames: saveFrames ? log.frames : null,
      late: log.late,
      longest_ms: log.longest_ms,
      drift_ms: log.drift_ms,
      refresh_hz: log.refresh_hz,
      backend: log.backend,
      renderer: log.renderer,
      // What ended the trial is no fault of the play.
      aborted: log.aborted,
    };
  }

  /** Parks the elements. */
  close() {
    if (!parked?.isConnected) {
      parked = document.createElement("div");
      parked.hidden = true;
      document.body.append(parked);
    }
    // One that failed is not used again.
    for (const element of this.#elements ?? []) if (element.state !== "failed") parked.append(element);
    this.#display.replaceChildren();
  }
}

// Gives an element a clip: nothing where it has this clip, so that it keeps its picture.
function put(element, clip) {
  for (const name of ["src", "source", "clip", "packs", "avatar", "settings", "capture", "unit", "rate", "map", "method", "frames"]) {
    const value = clip[name] ?? null;
    if (JSON.stringify(element[name] ?? null) !== JSON.stringify(value)) element[name] = value;
  }
}
