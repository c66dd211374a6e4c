// The sound check: the volume is set by a test sound, then tones are counted, round by round. Its result goes into
// the hidden field that stands for it on the page, as the answers of that page.
import { running } from "./sound.js";

// A tone and the time to the next, s; level of the tones: a sine of 0.2 has -17 dB of full scale (rms).
const TONE_S = 0.25;
const STEP_S = 0.55;
const LEVEL = 0.2;
const TONE_HZ = 587.33;
const TEST_HZ = [440, 554.37, 659.26, 880];

/// Begins the check after `field`, whose `data-pages` is what the study says of sound (`study::SoundPages`).
export function begin(field) {
  new Check(field).test();
}

class Check {
  #field;
  #words;
  #rules;
  #box = document.createElement("div");
  #status = made("p", { className: "trial-message", role: "status" });
  #body = document.createElement("div");
  #attempt = 1;
  #correct = 0;
  #rounds = [];
  // Numbers a play, so that only the last one says that it is over.
  #plays = 0;

  constructor(field) {
    this.#field = field;
    const { words, check } = JSON.parse(field.dataset.pages);
    this.#words = words[document.documentElement.lang] ?? Object.values(words)[0];
    this.#rules = check;
    this.#box.className = "sound-check";
    this.#box.append(this.#body, this.#status);
    field.after(this.#box);
  }

  // The test sound, by which the volume is set.
  test(again = false) {
    const w = this.#words;
    const play = this.#button("sound-test", w.sound_test, "primary");
    const on = this.#button("sound-continue", w.sound_continue);
    on.hidden = true;
    play.onclick = async () => {
      const played = await this.#play(TEST_HZ, 0.3, w.sound_test_playing);
      play.textContent = w.sound_test_again;
      if (!played || !on.hidden) return;
      play.classList.remove("primary");
      on.classList.add("primary");
      on.hidden = false;
    };
    on.onclick = () => {
      this.#correct = 0;
      this.#round(1);
    };
    const notice = again ? [made("p", { className: "notice warn", textContent: w.sound_again })] : [];
    this.#show(again ? w.sound_again : "", ...notice, row(play, on, this.#none()));
    if (again) play.focus();
  }

  // One round: some tones, and how many they were.
  #round(number) {
    const w = this.#words;
    const { rounds, correct, mostTones: tones, attempts } = this.#rules;
    const played = 1 + random(tones);
    let heard = false;
    const fill = (text) => text.replace("{round}", number).replace("{of}", rounds);
    const heading = made("h2", { textContent: fill(w.sound_round), tabIndex: -1 });
    const play = this.#button("sound-tones", w.sound_tones, "primary");
    const choices = made("div", { className: "likert" });
    choices.style.setProperty("--points", tones);
    for (let count = 1; count <= tones; count++) {
      const radio = made("input", { type: "radio", name: "tones", value: count });
      choices.append(made("label", { className: "point" }, radio, made("span", { textContent: count })));
    }
    const problem = made("p", { className: "problem", hidden: true, id: "tones-problem" });
    const field = made("fieldset", { className: "question", disabled: true }, made("legend", { textContent: w.sound_question }), choices, problem);
    const next = this.#button("sound-next", w.sound_next);
    play.onclick = async () => {
      const all = await this.#play(Array(played).fill(TONE_HZ), STEP_S, w.sound_tones_playing);
      if (!all) return;
      heard = true;
      field.disabled = false;
      problem.hidden = true;
      field.removeAttribute("aria-describedby");
      play.textContent = w.sound_tones_again;
      play.classList.remove("primary");
      next.classList.add("primary");
      this.#say(w.sound_count_now);
    };
    field.onchange = () => (problem.hidden = true);
    next.onclick = () => {
      const chosen = field.querySelector(":checked");
      if (!heard || !chosen) {
        problem.textContent = heard ? w.sound_missing_answer : w.sound_missing_play;
        problem.hidden = false;
        field.setAttribute("aria-describedby", problem.id);
        this.#say(problem.textContent);
        (heard ? field.querySelector("input") : play).focus();
        return;
      }
      const counted = Number(chosen.value);
      this.#rounds.push([played, counted]);
      this.#correct += Number(counted === played);
      if (number < rounds) return this.#round(number + 1);
      if (this.#correct >= correct) return this.#finish("heard");
      if (this.#attempt >= attempts) return this.#finish("miscounted");
      this.#attempt += 1;
      this.test(true);
    };
    this.#show("", heading, made("p", { textContent: w.sound_listen }), row(play), field, row(next, this.#none()));
    heading.focus();
  }

  // For those who do not hear it; asked twice, since it may end the study.
  #none() {
    const w = this.#words;
    const button = this.#button("sound-none", w.sound_none, "quiet");
    button.onclick = () => {
      const yes = this.#button("sound-none-yes", w.sound_none_yes);
      const no = this.#button("sound-none-no", w.sound_none_no, "primary");
      yes.onclick = () => this.#finish("not_heard");
      no.onclick = () => this.test();
      this.#plays += 1;
      const question = made("p", { textContent: w.sound_none_question, tabIndex: -1 });
      this.#show("", question, row(no, yes));
      question.focus();
    };
    return button;
  }

  #finish(outcome) {
    this.#plays += 1;
    this.#field.value = JSON.stringify({
      sound_check: outcome,
      sound_check_correct: this.#correct,
      sound_check_attempts: this.#attempt,
      // Each round: how many tones were played, and how many counted.
      sound_check_rounds: this.#rounds,
    });
    this.#field.dispatchEvent(new Event("change"));
  }

  // Plays tones; resolves with whether all of them were played, once they are over.
  async #play(tones, step, playing) {
    const own = ++this.#plays;
    this.#say(playing);
    const context = await running();
    if (!context) {
      this.#say(this.#words.sound_blocked);
      return false;
    }
    const begin = context.currentTime + 0.08;
    tones.forEach((hertz, at) => tone(context, hertz, begin + at * step));
    const ends = begin + (tones.length - 1) * step + TONE_S;
    while (context.currentTime < ends) {
      await new Promise((resolve) => setTimeout(resolve, 30));
      if (this.#plays !== own) return false;
      if (context.state !== "running") {
        this.#say(this.#words.sound_blocked);
        return false;
      }
    }
    this.#say("");
    return true;
  }

  #button(action, label, kind = "") {
    const button = made("button", { type: "button", className: kind, textContent: label });
    button.dataset.action = action;
    return button;
  }

  #say(text) {
    this.#status.textContent = text;
  }

  #show(status, ...parts) {
    this.#body.replaceChildren(...parts);
    this.#say(status);
  }
}

// A sine that rises and falls within 20 ms: no click tells it from silence.
function tone(context, hertz, at) {
  const [oscillator, gain] = [context.createOscillator(), context.createGain()];
  oscillator.frequency.value = hertz;
  gain.gain.setValueAtTime(0, at);
  gain.gain.linearRampToValueAtTime(LEVEL, at + 0.02);
  gain.gain.setValueAtTime(LEVEL, at + TONE_S - 0.02);
  gain.gain.linearRampToValueAtTime(0, at + TONE_S);
  oscillator.connect(gain).connect(context.destination);
  oscillator.start(at);
  oscillator.stop(at + TONE_S);
}

// 0 to `below` - 1, each as likely: 2^32 divided by 9 leaves a bias of 2e-9.
function random(below) {
  return crypto.getRandomValues(new Uint32Array(1))[0] % below;
}

function row(...buttons) {
  return made("div", { className: "actions" }, ...buttons);
}

function made(tag, properties, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  if (properties.role) element.setAttribute("role", properties.role);
  element.append(...children);
  return element;
}
