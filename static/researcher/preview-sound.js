// The sound of the clip in panel A while the preview plays it at full speed. It follows the face; how near, only
// plays of the participant's page measure.

// So far beside the clip's clock a sound may be before it is started anew, ms.
const APART_MS = 80;

export class PreviewSound {
  #player;
  #check;
  #captions;
  #sound = null;
  // The clip's time that corresponds to the page's 0.
  #zero = null;

  /// `check`: the box that switches it on; `captions`: where they stand.
  constructor(player, check, captions) {
    this.#player = player;
    this.#check = check;
    this.#captions = captions;
  }

  /// The clip of the panel that is heard.
  put(clip) {
    this.#stop();
    this.#sound = clip?.sound ?? null;
    this.#check.closest("label").hidden = this.#sound === null;
    this.#captions.textContent = "";
  }

  /// The preview has drawn this time of the clip.
  at(timeMs) {
    if (!this.#sound) return;
    this.#captions.textContent = this.#sound.captionAt(timeMs);
    const plays = this.#player.playing && this.#check.checked && document.getElementById("speed").value === "1";
    if (!plays) return this.#stop();
    const zero = performance.now() - timeMs;
    if (this.#zero !== null && Math.abs(zero - this.#zero) < APART_MS) return;
    this.#zero = zero;
    this.#sound.playFrom(timeMs);
  }

  #stop() {
    if (this.#zero !== null) this.#sound?.stop();
    this.#zero = null;
  }
}
