// The chosen crank angle, an index into even angles over a period: controls, keyboard, play at a pace, followers.
const SECONDS = 6; // a turn
const STEPS = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 10, PageDown: -10 };

export class Clock {
  // Controls under the root, each optional: .play (button), .angle (range), .degrees (number), .pace (seconds a turn).
  constructor(root, { count = 360, step = 1, sense = 1 } = {}) {
    const find = (name) => root.querySelector(name);
    const [play, slider, number, pace] = [".play", ".angle", ".degrees", ".pace"].map(find);
    Object.assign(this, { play, slider, number, pace, running: false, index: 0, place: 0, followers: [] });
    this.span({ count, step, sense });
    for (const input of [slider, number]) {
      if (input) input.addEventListener("input", () => input.value !== "" && this.choose(input.value / this.step));
    }
    if (play) play.addEventListener("click", () => this.run(!this.running));
  }

  // `count` angles in steps of `step` degrees; the crank plays in a `sense`, 1 or -1.
  span({ count, step, sense }) {
    Object.assign(this, { count, step, sense });
    for (const input of [this.slider, this.number]) if (input) Object.assign(input, { max: (count - 1) * step, step });
    const { index } = this;
    this.index = -1;
    this.turnTo(index);
  }

  get degrees() { return this.index * this.step; }

  // `follower(index)` is called at each change, and now.
  follow(follower) {
    this.followers.push(follower);
    follower(this.index);
  }

  choose(index) {
    if (!Number.isFinite(index)) return;
    this.run(false);
    this.turnTo(Math.round(index));
    this.place = this.index;
  }

  turnTo(index) {
    const next = ((index % this.count) + this.count) % this.count;
    if (next === this.index) return;
    const { slider, number, degrees } = Object.assign(this, { index: next });
    if (slider) { slider.value = degrees; slider.setAttribute("aria-valuetext", `${degrees} degrees`); }
    if (number && (this.running || number.getRootNode().activeElement !== number)) number.value = degrees;
    for (const follower of this.followers) follower(next);
  }

  run(wanted) {
    if (wanted === this.running) return;
    this.running = wanted;
    if (this.play) {
      this.play.textContent = wanted ? "❚❚" : "▶";
      this.play.setAttribute("aria-label", wanted ? "pause" : "play");
    }
    if (!wanted) return;
    Object.assign(this, { place: this.index, before: performance.now() });
    requestAnimationFrame((time) => this.frame(time));
  }

  frame(time) {
    if (!this.running) return;
    const past = Math.max(0, Math.min(0.1, (time - this.before) / 1000));
    const turn = this.pace ? Number(this.pace.value) : SECONDS;
    this.before = time;
    this.place += this.sense * past * 360 / this.step / turn;
    this.turnTo(Math.floor(this.place));
    requestAnimationFrame((next) => this.frame(next));
  }

  // Keys pressed in an element: arrows a step, with Shift ten, Home to the start, space to play.
  keys(target) {
    target.addEventListener("keydown", (event) => {
      const place = event.composedPath()[0], kind = place.type || place.localName, { key } = event;
      const own = ["number", "text", "search", "textarea", "select-one", "summary"].includes(kind);
      if (own || event.defaultPrevented || event.ctrlKey || event.altKey || event.metaKey) return;
      const vertical = /Up|Down/.test(key) && kind !== "range"; // else these scroll the page
      const times = event.shiftKey && /Left|Right/.test(key) ? 10 : 1;
      if (key === " " && !["button", "checkbox", "radio"].includes(kind)) this.run(!this.running);
      else if (Object.hasOwn(STEPS, key) && !vertical) this.choose(this.index + times * STEPS[key]);
      else if (key === "Home") this.choose(0);
      else return;
      event.preventDefault();
    });
  }
}
