// The answers of a trial: buttons and keys, timed by the events' own clock from the first frame.

export class Response {
  #jsPsych;
  #trial;
  #buttons = [];
  #onset = null;
  #isOpen = false;
  #answer = null;
  #give;
  #onKey = (event) => this.#key(event);
  /** Resolves with the first answer. */
  given = new Promise((give) => (this.#give = give));

  constructor(jsPsych, display, trial) {
    [this.#jsPsych, this.#trial] = [jsPsych, trial];
    if (trial.prompt !== null) {
      const prompt = document.createElement("div");
      prompt.className = "mimique-prompt";
      prompt.innerHTML = trial.prompt;
      display.append(prompt);
    }
    const group = document.createElement("div");
    group.className = "mimique-choices jspsych-btn-group-flex";
    for (const [index, choice] of trial.choices.entries()) {
      group.insertAdjacentHTML("beforeend", trial.button_html(choice, index));
      const button = group.lastElementChild;
      button.dataset.choice = index;
      button.disabled = true;
      button.addEventListener("click", (event) => this.#take(index, "button", null, event.timeStamp));
      this.#buttons.push(button);
    }
    if (this.#buttons.length > 0) display.append(group);
    jsPsych.getDisplayContainerElement().addEventListener("keydown", this.#onKey);
  }

  get isPossible() {
    return this.#trial.choices.length + this.#trial.keys.length > 0;
  }

  /** Times are from here on. */
  from(onset) {
    this.#onset = onset;
  }

  /** Answers count. */
  open() {
    this.#isOpen = this.#answer === null;
    for (const button of this.#buttons) button.disabled = !this.#isOpen;
  }

  /** The play was interrupted: what was answered to it does not count. */
  withdraw() {
    this.#isOpen = false;
    this.#onset = null;
    this.#answer = null;
    this.given = new Promise((give) => (this.#give = give));
    for (const button of this.#buttons) button.disabled = true;
  }

  #key(event) {
    if (event.repeat) return;
    const index = this.#trial.keys.findIndex((key) => this.#jsPsych.pluginAPI.compareKeys(key, event.key));
    if (index < 0 || !this.#isOpen) return;
    event.preventDefault();
    this.#take(index, "key", event.key, event.timeStamp);
  }

  #take(index, source, key, at) {
    if (!this.#isOpen || this.#onset === null) return;
    this.#isOpen = false;
    this.#answer = { rt: Math.max(0, at - this.#onset), response: index, response_source: source, response_key: key };
    for (const button of this.#buttons) button.disabled = true;
    this.#buttons[index]?.classList.add("responded");
    this.#give(this.#answer);
  }

  data() {
    return this.#answer ?? { rt: null, response: null, response_source: null, response_key: null };
  }

  /** Answers as `data` says, `rt` after the first frame. */
  simulate({ rt, response, response_source: source }) {
    const delay = Math.max(1, this.#onset + rt - performance.now());
    if (source === "key") this.#jsPsych.pluginAPI.pressKey(this.#trial.keys[response], delay);
    else this.#jsPsych.pluginAPI.clickTarget(this.#buttons[response], delay);
  }

  close() {
    this.#isOpen = false;
    this.#jsPsych.getDisplayContainerElement().removeEventListener("keydown", this.#onKey);
  }
}
