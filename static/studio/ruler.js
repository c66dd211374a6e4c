// The time of the take above everything that follows it: its face in small pictures, its segments, its seconds,
// and the play head, which goes down over the curves.
import { openStage } from "../stage/host.js";
import { LEFT, fitted, timeAxis } from "../drawing/lines.js";
import { made } from "../stage/player.js";

const $ = (id) => document.getElementById(id);
/// Size of a small picture, CSS pixels.
const SMALL = 40;
/// Heights of the segments and of the seconds below the pictures.
const SEGMENTS = 6;
const SECONDS = 20;

export class Ruler {
  #page;
  #pictures = { key: "", all: [] };
  #segments = [];
  #run = 0;
  #timer = null;

  /// `page`: {first(), durationMs(), report(error)}
  constructor(page) {
    this.#page = page;
    new ResizeObserver(() => (this.#draw(), this.#lookSoon())).observe($("ruler"));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.#draw());
  }

  /// Another take, another way to solve it, other segments.
  put(segments) {
    this.#segments = segments;
    const nothing = this.#page.durationMs() === 0;
    $("ruler").hidden = $("playline").hidden = nothing;
    this.#draw();
    this.#lookSoon();
  }

  /// Moves the play head.
  at(timeMs) {
    const part = timeMs / Math.max(1, this.#page.durationMs());
    $("playline").style.insetInlineStart = `calc(${LEFT}px + ${part} * (100% - ${LEFT}px))`;
  }

  #lookSoon() {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#look().catch(this.#page.report), 600);
  }

  // Small pictures of the first face, made on a canvas of their own.
  async #look() {
    const panel = this.#page.first();
    const width = $("ruler").clientWidth - LEFT;
    const count = Math.max(0, Math.floor(width / SMALL));
    if (!panel?.facts || count === 0) return;
    const key = `${panel.facts.weights_hash} ${count} ${this.#page.avatarKey()}`;
    if (key === this.#pictures.key) return;
    const run = ++this.#run;
    const canvas = document.createElement("canvas");
    const pixels = SMALL * 2;
    const stage = await openStage(canvas, { background: "#808080", width: pixels / devicePixelRatio, height: pixels / devicePixelRatio });
    try {
      stage.setView({ zoom: 1.25 });
      const all = [];
      const { duration_ms: duration } = panel.clip();
      for (let i = 0; i < count && run === this.#run && panel.facts; i++) {
        await stage.show(panel.clipId, (duration * (i + 0.5)) / count);
        const copy = made("canvas", { width: pixels, height: pixels });
        copy.getContext("2d").drawImage(canvas, 0, 0, pixels, pixels);
        all.push(copy);
        // The page goes on in between.
        await new Promise((done) => setTimeout(done, 0));
      }
      if (run !== this.#run) return;
      this.#pictures = { key, all };
      this.#draw();
    } finally {
      stage.close();
    }
  }

  #draw() {
    const canvas = $("ruler-canvas");
    const duration = this.#page.durationMs();
    if (duration === 0 || canvas.getClientRects().length === 0) return;
    const { context, width, height } = fitted(canvas);
    const css = getComputedStyle(canvas);
    const x = (part) => LEFT + part * (width - LEFT);
    const top = height - SECONDS - SEGMENTS;
    const { all } = this.#pictures;
    const each = (width - LEFT) / Math.max(1, all.length);
    all.forEach((picture, i) => {
      const size = Math.min(each, top);
      context.drawImage(picture, x(i / all.length) + (each - size) / 2, 0, size, size);
    });
    context.fillStyle = css.getPropertyValue("--accent");
    for (const { clip_s: [from, to] } of this.#segments) {
      const [left, right] = [from, to].map((s) => x((1000 * s) / duration));
      context.fillRect(left, top + 1, Math.max(2, right - left - 1), SEGMENTS - 2);
    }
    context.font = "12px system-ui, sans-serif";
    context.textBaseline = "middle";
    timeAxis(context, { from: 0, to: duration / 1000, unit: "s" }, x, height, css.getPropertyValue("--ink"));
  }
}
