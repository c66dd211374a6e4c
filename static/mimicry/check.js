// The page on which the measuring of the face is agreed to, and the camera is tried. Its result goes into the hidden field
// that stands for it on the page, as the answers of that page. Nothing is asked of the camera before somebody agrees.
import { NoCamera, Tracker, askedAnew, made, wordsOf } from "./tracker.js";

// So many pictures with a face in a row are a face that is seen.
const SEEN_PICTURES = 5;

/// Begins after `field`, whose `data-pages` is what the study says of it (`study::MimicryPages`). Resolves with the tracker
/// of those who agree and have a camera, else with nothing.
export function begin(field) {
  askedAnew();
  return new Promise((resolve) => new Consent(field, resolve).ask());
}

class Consent {
  #field;
  #pages;
  #words;
  #resolve;
  #box = made("div", { className: "mimicry" });
  #body = made("div", {});
  #status = made("p", { className: "trial-message", role: "status" });
  #tracker = null;

  constructor(field, resolve) {
    this.#field = field;
    this.#resolve = resolve;
    this.#pages = JSON.parse(field.dataset.pages);
    this.#words = wordsOf(this.#pages);
    this.#box.append(this.#body, this.#status);
    field.after(this.#box);
  }

  ask() {
    const w = this.#words;
    const rate = Number(this.#pages.rateHz).toLocaleString(document.documentElement.lang);
    const paragraph = (text) => made("p", { textContent: text });
    // Neither answer looks like the one that is wanted.
    const agree = this.#button("mimicry-agree", w.mimicry_agree);
    const decline = this.#button("mimicry-decline", w.mimicry_decline);
    agree.onclick = () => this.#try();
    decline.onclick = () => this.#finish("declined", "off");
    this.#show(
      made("h2", { textContent: w.mimicry_sent_heading }),
      paragraph(w.mimicry_sent.replace("{rate}", rate)),
      paragraph(w.mimicry_not_sent),
      paragraph(w.mimicry_free),
      row(agree, decline),
    );
  }

  async #try() {
    const w = this.#words;
    this.#show(row(this.#without("off")));
    const tracker = (this.#tracker = new Tracker(this.#pages));
    try {
      await tracker.open((step) => this.#say(w[`mimicry_${step}`]));
    } catch (error) {
      if (this.#tracker !== tracker) return;
      const why = error instanceof NoCamera ? error.why : "failed";
      console.warn(`mimicry: ${error.message}`);
      const again = this.#button("mimicry-again", w.mimicry_again, "primary");
      again.onclick = () => this.#try();
      this.#show(row(again, this.#without(why)));
      this.#say(w[`mimicry_${why}`]);
      again.focus();
      return;
    }
    if (this.#tracker !== tracker) return tracker.close();
    this.#look(tracker);
  }

  // Whether a face is seen, beside the participant's own picture.
  #look(tracker) {
    const w = this.#words;
    const next = this.#button("mimicry-next", w.mimicry_next, "primary");
    next.disabled = this.#pages.needsFace;
    let inARow = 0;
    let seen = false;
    const told = (face) => {
      inARow = face ? inARow + 1 : 0;
      if (face && inARow < SEEN_PICTURES) return;
      seen ||= face;
      if (face) next.disabled = false;
      const text = face ? w.mimicry_seen : w.mimicry_looking;
      if (this.#status.textContent !== text) this.#say(text);
    };
    told.isOpen = true;
    tracker.onFace(told);
    next.onclick = () => {
      told.isOpen = false;
      tracker.onFace(() => {});
      tracker.showBar();
      this.#answer("agreed", seen ? "seen" : "not_seen", tracker);
    };
    const own = made("figure", { className: "mimicry-own" }, tracker.ownPicture(), made("figcaption", { textContent: w.mimicry_own }));
    this.#show(own, row(next, this.#without("off")));
    this.#say(w.mimicry_looking);
    next.focus();
  }

  // Goes on without the camera, though its use was agreed to.
  #without(why) {
    const without = this.#button("mimicry-without", this.#words.mimicry_without);
    without.onclick = () => this.#finish("agreed", why);
    return without;
  }

  #finish(consent, camera) {
    this.#tracker?.close();
    this.#tracker = null;
    this.#answer(consent, camera, null);
  }

  #answer(consent, camera, tracker) {
    this.#resolve(tracker);
    this.#field.value = JSON.stringify({ mimicry_consent: consent, mimicry_version: this.#pages.version, mimicry_camera: camera });
    this.#field.dispatchEvent(new Event("change"));
  }

  #button(action, label, kind = "") {
    const button = made("button", { type: "button", className: kind, textContent: label });
    button.dataset.action = action;
    return button;
  }

  #say(text) {
    this.#status.textContent = text;
  }

  #show(...parts) {
    this.#body.replaceChildren(...parts);
    this.#say("");
  }
}

function row(...buttons) {
  return made("div", { className: "actions" }, ...buttons);
}
