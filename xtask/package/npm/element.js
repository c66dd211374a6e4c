// <mimique-stage>: a clip of an avatar's face in anybody's page. Attributes or properties say which clip (clip.js); methods
// play, seek, stop and turn it; events tell what happens, among them the log of every frame (element.d.ts).
import { openStage } from "./modules/stage/host.js";
import { prepared } from "./clip.js";
import { StageProblem } from "./problem.js";
import { sheet } from "./sheet.js";
import { VERSION } from "./version.js";

export { StageProblem };

// What says which clip: another value of one of them is another clip.
const SOURCES = ["src", "clip", "packs", "avatar", "settings", "capture", "unit", "rate", "map", "method", "frames"];
// May be files or objects, which no attribute can be.
const OBJECTS = ["source", "avatar", "settings", "capture", "map", "method"];

export class MimiqueStage extends HTMLElement {
  static observedAttributes = [...SOURCES, "background", "label"];

  /** Prepares a clip before an element shows it; resolves with its summary. `given`: as `clip.js` has it. */
  static async prepare(given, onProgress) {
    return (await prepared(given, onProgress).catch((error) => Promise.reject(StageProblem.of(error)))).summary;
  }

  #objects = {};
  #frame;
  #words;
  #stage = null;
  #opening = null;
  #clip = null;
  #loading = null;
  // Counts loads: of those that overtake each other the last one counts.
  #load = 0;
  #scheduled = false;
  #state = "empty";
  #time = 0;
  // Whether size or view changed during a play, which draws with what it began with.
  #stale = false;
  #view = { yaw: 0, pitch: 0, zoom: 1 };
  #sizes = new ResizeObserver(() => this.#redraw());

  constructor() {
    super();
    const root = this.attachShadow({ mode: "open" });
    root.adoptedStyleSheets = [sheet];
    this.#frame = document.createElement("div");
    this.#frame.className = "stage-frame";
    this.#frame.part = "frame";
    this.#words = document.createElement("p");
    this.#words.part = "words";
    this.#words.hidden = true;
    root.append(this.#frame, this.#words);
  }

  connectedCallback() {
    // Properties that were set before this class was there.
    for (const name of OBJECTS) {
      if (!Object.hasOwn(this, name)) continue;
      const value = this[name];
      delete this[name];
      this[name] = value;
    }
    this.#sizes.observe(this);
    if (!this.#loading) this.#changed();
  }

  disconnectedCallback() {
    this.stop("removed from the page");
    // An element that is moved is connected again in the same task.
    queueMicrotask(() => this.isConnected || this.#close());
  }

  attributeChangedCallback(name, before, now) {
    if (before === now) return;
    if (name === "background") this.#stage?.setLook({ background: now ?? "" });
    if (name === "label") this.#frame.firstElementChild?.setAttribute("aria-label", this.#label());
    if (SOURCES.includes(name)) this.#changed();
    else this.#redraw();
  }

  /** "empty", "loading", "ready", "playing" or "failed". */
  get state() {
    return this.#state;
  }

  /** What is known of the clip, or null. */
  get summary() {
    return this.#clip?.summary ?? null;
  }

  /** Milliseconds. */
  get duration() {
    return this.#clip?.summary.duration_ms ?? 0;
  }

  /** Where in the clip the picture is, milliseconds. */
  get time() {
    return this.#time;
  }

  /** Resolves with the summary once the clip stands on the stage. Rejects with what is wrong. */
  get ready() {
    if (!this.isConnected) return Promise.reject(detached());
    if (this.#scheduled || !this.#loading) this.#start();
    return this.#loading;
  }

  /**
   * Plays the clip once from its first frame; resolves with the log whatever happens, once the clip is there. `beside`: other
   * elements, in step, or with `inTurn` after this one; `heard`: with its sound; `told`: {frame(now, ms), end(now)}.
   */
  async play({ beside = [], inTurn = false, heard = false, told } = {}) {
    const all = [this, ...beside];
    await Promise.all(all.map((element) => element.ready));
    const busy = all.find((element) => element.#state === "playing");
    if (busy) throw new StageProblem("playing", `mimique-stage: clip ${busy.#clip.name} is playing; stop it first, or await its log`);
    let onset = null;
    const tell = {
      frame: (now, ms) => {
        for (const element of all) element.#time = Math.min(ms, element.duration);
        if (onset === null) this.#tell("stage-onset", { onset_ms: (onset = now) });
        told?.frame?.(now, ms);
      },
      end: (now) => told?.end?.(now),
    };
    const clips = all.map((element) => element.#clip.name);
    for (const element of all) element.#become("playing");
    try {
      const others = beside.map((element) => ({ stage: element.#stage, clipId: element.#clip.id }));
      const log = await this.#stage.play(this.#clip.id, { beside: others, inTurn, heard, told: tell });
      const whole = { ...log, renderer: log.renderer || `@mimique/stage@${VERSION}`, clips };
      for (const element of all) element.#played(whole);
      return whole;
    } finally {
      for (const element of all) if (element.#state === "playing") element.#become("ready");
    }
  }

  /** Ends the play in progress; the log keeps why. The picture stays where it is. */
  stop(why = "stopped") {
    if (this.#state === "playing") this.#stage?.stop(why);
  }

  /** Ends the play in progress, for the log by a pause. The next play begins at the first frame again, so that a log is of a whole play. */
  pause() {
    this.stop("paused");
  }

  /** Shows the frame at `ms` of the clip; resolves when it is drawn. */
  async seek(ms) {
    await this.ready;
    if (!Number.isFinite(ms)) throw new StageProblem("time", `mimique-stage: seek(${ms}): no time; give milliseconds from 0 to ${this.duration.toFixed(0)}`);
    if (this.#state === "playing") throw new StageProblem("playing", "mimique-stage: seek: the clip is playing; stop or pause it first");
    this.#time = Math.min(Math.max(ms, 0), this.duration);
    await this.#stage.show(this.#clip.id, this.#time);
  }

  /** Turns the camera: {yaw, pitch} in radians, {zoom} 1 for the standard portrait. What is left out stays. */
  view(view) {
    this.#view = { ...this.#view, ...view };
    this.#stage?.setView(this.#view);
    this.#redraw();
  }

  // Attributes that are set one after the other are one change.
  #changed() {
    if (!this.isConnected) this.#loading = null;
    if (!this.isConnected || this.#scheduled) return;
    this.#scheduled = true;
    queueMicrotask(() => this.#scheduled && this.#start());
  }

  #start() {
    this.#scheduled = false;
    const number = ++this.#load;
    this.stop("another clip");
    const given = this.#given();
    const nothing = !["src", "source", "avatar", "capture"].some((name) => given[name]);
    if (nothing) this.#say("");
    this.#become(nothing ? "empty" : "loading");
    // Of nothing `prepared` says what may be given.
    this.#loading = (nothing ? prepared(given) : this.#show(given, number)).catch((error) => {
      const problem = StageProblem.of(error);
      if (number === this.#load && !nothing && problem.code !== "detached") this.#failed(problem);
      throw problem;
    });
    // Who does not await it hears the event.
    this.#loading.catch(() => {});
  }

  async #show(given, number) {
    const progress = (part) => number === this.#load && this.#tell("stage-progress", { part });
    const [clip, stage] = await Promise.all([prepared(given, progress), this.#opened(given)]);
    if (number !== this.#load) return this.#overtaken();
    this.#clip = clip;
    this.#time = 0;
    await stage.show(clip.id, 0);
    if (number !== this.#load) return this.#overtaken();
    this.#say("");
    this.#become("ready");
    this.#tell("stage-ready", clip.summary);
    return clip.summary;
  }

  // Another clip was given meanwhile, or the element left the page.
  #overtaken() {
    if (!this.#loading) throw detached();
    return this.#loading;
  }

  #given() {
    const given = { ...this.#objects };
    for (const name of SOURCES) given[name] ??= this.getAttribute(name) ?? "";
    return given;
  }

  // The stage, once there is something to show.
  #opened() {
    if (this.#opening) return this.#opening;
    const canvas = document.createElement("canvas");
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", this.#label());
    this.#frame.replaceChildren(canvas);
    const { width, height } = this.getBoundingClientRect();
    const look = { background: this.getAttribute("background") ?? "", width: width || 480, height: height || 480 };
    const opening = openStage(canvas, look).then((stage) => {
      // Taken out of the page meanwhile.
      if (this.#opening !== opening) {
        released(stage, canvas);
        throw detached();
      }
      stage.setView(this.#view);
      return (this.#stage = stage);
    });
    this.#opening = opening;
    opening.catch(() => this.#opening === opening && (this.#opening = null));
    return opening;
  }

  // Gives the canvas back; the clip stays prepared, and is shown again on a new one.
  #close() {
    this.#sizes.disconnect();
    this.#load += 1;
    this.#scheduled = false;
    this.#loading = null;
    if (this.#stage) released(this.#stage, this.#frame.firstElementChild);
    this.#stage = this.#opening = this.#clip = null;
    this.#frame.replaceChildren();
    this.#become("empty");
  }

  #redraw() {
    this.#stale = this.#state === "playing";
    const isSeen = this.getClientRects().length > 0;
    if (this.#state !== "ready" || !isSeen) return;
    // A stage that was lost opens itself again.
    this.#stage.show(this.#clip.id, this.#time).catch((error) => this.#failed(StageProblem.of(error)));
  }

  #played(log) {
    // One that left the page meanwhile stays as it is.
    if (this.#state === "playing") {
      if (log.aborted === null) this.#time = this.duration;
      this.#become("ready");
      if (this.#stale) this.#redraw();
    }
    this.#tell("stage-played", log);
  }

  #failed(problem) {
    this.#become("failed");
    this.#say(problem.message);
    this.#tell("stage-error", problem);
  }

  #become(state) {
    this.#state = state;
    this.setAttribute("state", state);
  }

  #say(words) {
    this.#words.textContent = words;
    this.#words.hidden = words === "";
    if (words) this.#words.setAttribute("role", "alert");
  }

  #label() {
    return this.getAttribute("label") ?? "An animated face";
  }

  #tell(name, detail) {
    this.dispatchEvent(new CustomEvent(name, { detail, bubbles: true, composed: true }));
  }

  static {
    for (const name of OBJECTS) {
      Object.defineProperty(this.prototype, name, {
        configurable: true,
        enumerable: true,
        get() {
          return this.#objects[name] ?? (name === "source" ? null : this.getAttribute(name));
        },
        set(value) {
          // A text is an attribute, so that the page shows what it says.
          if (name !== "source" && (typeof value === "string" || value == null)) {
            delete this.#objects[name];
            if (value == null) this.removeAttribute(name);
            else this.setAttribute(name, value);
          } else if (value == null) delete this.#objects[name];
          else this.#objects[name] = value;
          this.#changed();
        },
      });
    }
    for (const name of [...SOURCES, "background", "label"].filter((name) => !OBJECTS.includes(name))) {
      Object.defineProperty(this.prototype, name, {
        configurable: true,
        enumerable: true,
        get() {
          return this.getAttribute(name);
        },
        set(value) {
          if (value == null) this.removeAttribute(name);
          else this.setAttribute(name, value);
        },
      });
    }
  }
}

function detached() {
  return new StageProblem("detached", "mimique-stage: the element is not in a page; append it first");
}

// A closed stage's canvas, whose context browsers count (Chromium keeps 16) until it is collected.
function released(stage, canvas) {
  const { backend } = stage.state();
  stage.close();
  if (backend === "webgl2") canvas?.getContext("webgl2")?.getExtension("WEBGL_lose_context")?.loseContext();
}

if (!customElements.get("mimique-stage")) customElements.define("mimique-stage", MimiqueStage);
