// The mechanism in its place on the explore page: drawing, crank angle, forces to show, frame.
import { Clock } from "./clock.js";
import { Drawing, TORQUE } from "./drawing.js";
import { button, checkbox, made } from "./html.js";
import { element } from "./svg.js";

const SMALLEST = 0.5; // of the frame: a smaller machine or arrow gets a new frame
const LARGEST = 1.2; // of the longest arrow
const SLACK = 0.02; // of the frame, by which a machine may leave it
const NEAR = 16; // pixels from the crank's pin, at which the pointer takes it
const TURNS = 1e-3; // radians by which the direction to a joint on the crank may miss the crank angle
const ONE_COLUMN = 720; // pixels, as in explore.css
const PACES = { "2 s": 2, "6 s": 6, "15 s": 15, "40 s": 40 };

const union = (one, other) => one.map((end, place) => (place < 2 ? Math.min : Math.max)(end, other[place]));

// Does a machine stay inside a frame, and its forces on the frame's scale, without becoming much smaller?
function fits(data, frame) {
  const spans = ([left, low, right, high]) => Math.max(right - left, high - low);
  const whole = spans(frame.box), slack = SLACK * whole, all = union(data.box, frame.box);
  const inside = all.every((end, place) => Math.abs(end - frame.box[place]) <= slack);
  const share = (mine, other) => (mine === other ? 1 : mine / other);
  const arrow = share(data.longest * frame.scale, data.scale * frame.longest);
  const torque = share(data.largest_torque, frame.largest_torque);
  const forces = [arrow, torque].every((size) => size >= SMALLEST && size <= LARGEST);
  return inside && forces && spans(data.box) >= SMALLEST * whole;
}

export class Mechanism {
  // `onturn(index)` is called when another crank angle is chosen.
  constructor(parent, onturn) {
    Object.assign(this, { parent, shown: null, reference: null, frame: null, hidden: new Set(), arrows: "" });
    const stage = made(parent, "div", { class: "stage" });
    this.svg = element("svg", stage, { tabindex: 0, role: "group", "aria-label": "drawing" });
    this.drawing = new Drawing(this.svg, { tallest: this.tallest() });
    this.controls();
    const options = made(parent, "div", { class: "options" });
    this.chips = made(options, "fieldset", { class: "chips" });
    this.clock.keys(this.svg);
    this.clock.follow((index) => {
      this.drawing.show(index);
      onturn(index);
    });
    this.crank();
    new ResizeObserver(() => this.fit()).observe(parent);
  }

  // Height limit of the drawing: in one column all else scrolls below it.
  tallest() {
    const share = this.parent.closest(".explore").clientWidth < ONE_COLUMN ? 0.32 : 0.56;
    return Math.round(Math.max(180, Math.min(560, share * window.innerHeight)));
  }

  fit() {
    const tallest = this.tallest();
    if (tallest === this.drawing.tallest) return;
    this.drawing.tallest = tallest;
    this.drawing.draw();
  }

  controls() {
    const bar = made(this.parent, "div", { class: "clock" });
    made(bar, "button", { type: "button", class: "play", "aria-label": "play" }, "▶");
    made(bar, "input", { type: "range", class: "angle", min: 0, "aria-label": "crank angle" });
    const label = made(bar, "label", { class: "at" });
    made(label, "input", { type: "number", class: "degrees", min: 0, value: 0, "aria-label": "crank angle, degrees" });
    label.append(" °");
    const pace = made(bar, "select", { class: "pace", "aria-label": "time of a turn" });
    for (const [text, seconds] of Object.entries(PACES)) made(pace, "option", { value: seconds }, `${text} a turn`);
    pace.value = PACES["6 s"];
    this.clock = new Clock(bar);
  }

  // Machines of two answers, the second or both may be null. While a hand moves something (`still`) the frame stays.
  show(shown, reference, still) {
    const first = !this.shown;
    Object.assign(this, { shown, reference });
    const { angle, period, sense } = shown, data = shown.drawing, { length } = angle;
    if (this.clock.count !== length || this.clock.step !== period / length || this.clock.sense !== sense) {
      this.clock.span({ count: length, step: period / length, sense });
    }
    if (!this.frame || (!still && !fits(data, this.frame))) {
      this.frame = reference ? { ...data, box: union(data.box, reference.drawing.box) } : data;
    }
    this.drawing.otherData = reference ? reference.drawing : null;
    this.drawing.update(data, this.frame);
    this.drawing.ghost(false);
    if (first) this.drawing.show(this.clock.index);
    this.switches();
  }

  // The last machine as a ghost, or another one in its place.
  ghost(shown = null) {
    if (shown) this.drawing.update(shown.drawing, this.frame);
    this.drawing.ghost(true);
  }

  // A box to tick for each force.
  switches() {
    const names = [TORQUE, ...Object.keys(this.shown.drawing.arrows)], { chips, hidden } = this;
    if (names.join("\n") === this.arrows) return;
    this.arrows = names.join("\n");
    chips.replaceChildren();
    made(chips, "legend", {}, "Forces");
    const boxes = names.map((name) => {
      const input = checkbox(chips, name === TORQUE ? "torque" : name, !hidden.has(name), (wanted) => {
        hidden[wanted ? "delete" : "add"](name);
        this.drawing.hide(name, !wanted);
      });
      this.drawing.hide(name, hidden.has(name));
      return input;
    });
    const all = (wanted) => boxes.filter((box) => box.checked !== wanted).forEach((box) => box.click());
    button(chips, "all", () => all(true), { class: "plain" });
    button(chips, "none", () => all(false), { class: "plain" });
  }

  // Joints that turn with the crank.
  pins() {
    const { joints, moving, centre } = this.shown.drawing, { angle } = this.shown, count = angle.length;
    const rows = Array.from({ length: 8 }, (_, place) => Math.floor(place * count / 8));
    const gap = (name, row) => this.direction(name, row) - angle[row] * Math.PI / 180;
    return moving.filter((name) => name !== centre && joints[name] && rows.every((row) => {
      const turned = gap(name, row) - gap(name, 0);
      return !(Math.abs(Math.sin(turned / 2)) > TURNS);
    }));
  }

  direction(name, row) {
    const { joints, centre } = this.shown.drawing, [places, pivot] = [joints[name], joints[centre]];
    return Math.atan2(places[2 * row + 1] - pivot[2 * row + 1], places[2 * row] - pivot[2 * row]);
  }

  pixelOf(event) {
    const box = this.svg.getBoundingClientRect(), shrunk = box.width / this.drawing.width || 1;
    return [(event.clientX - box.left) / shrunk, (event.clientY - box.top) / shrunk];
  }

  // The crank's pin under the pointer turns the crank.
  crank() {
    const { svg } = this;
    let pin = null;
    const under = (event) => {
      if (!this.shown || this.shown.drawing.pose !== undefined) return null; // a point is held
      const [x, y] = this.pixelOf(event), { joints } = this.shown.drawing, row = this.clock.index;
      return this.pins().find((name) => {
        const [pinX, pinY] = this.drawing.pixel(joints[name][2 * row], joints[name][2 * row + 1]);
        return Math.hypot(pinX - x, pinY - y) < NEAR;
      });
    };
    svg.addEventListener("pointerdown", (event) => {
      pin = event.defaultPrevented || event.button !== 0 ? null : under(event);
      if (!pin) return;
      svg.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    svg.addEventListener("pointermove", (event) => {
      if (pin) this.turnTo(pin, this.drawing.metres(...this.pixelOf(event)));
      else if (!event.buttons) svg.classList.toggle("takes", Boolean(under(event)));
    });
    for (const name of ["pointerup", "pointercancel"]) svg.addEventListener(name, () => { pin = null; });
  }

  // The crank angle nearest to the chosen one at which a pin of the crank lies in the direction of a point.
  turnTo(pin, [x, y]) {
    const { joints, centre } = this.shown.drawing, { count, step, index } = this.clock, pivot = joints[centre];
    const wanted = Math.atan2(y - pivot[1], x - pivot[0]);
    const turned = (wanted - this.direction(pin, index)) * 180 / Math.PI;
    const least = ((turned + 540) % 360) - 180;
    if (Number.isFinite(least)) this.clock.choose((index + Math.round(least / step) + count) % count);
  }
}
