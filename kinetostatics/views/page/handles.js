// Points of a drawing that can be dragged: grips over it, by pointer, touch or keys.
// A handle: {name, label, kind, paths, position (x, y of each pose), row}; it moves to where the library puts it.
import { element, put, short } from "./svg.js";

const GRIPS = { // forms by kind, about (0, 0)
  joint: "M-6 0A6 6 0 1 0 6 0A6 6 0 1 0 -6 0Z",
  point: "M-5.5 -5.5H5.5V5.5H-5.5Z",
  mass: "M0 -7.5L7.5 0L0 7.5L-7.5 0Z",
  guide: "M-7 0L-3.5 -6H3.5L7 0L3.5 6H-3.5Z",
  turn: "M0 -7.5L7 5.5H-7Z",
};
const REACH = 13; // radius, in pixels, within which a grip is held
const ASIDE = 17; // pixels between grips of points that coincide
const TIP_LINE = 15, TIP_ASIDE = 14;
// Where a browser has it: it comes at once, not with the next frame.
const MOVED = "onpointerrawupdate" in window ? "pointerrawupdate" : "pointermove";
const NUDGES = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
const HINT = "Arrow keys move it by a step, with Shift by ten; Alt moves it without snapping.";

export class Handles {
  // `ondrag(wanted)` is called at most once a frame while a point moves, `ondrop(wanted)` at its end: {handle, x, y, index,
  // snap, step}, the place and the snapping step in m at the crank angle of an index.
  constructor(drawing, { ondrag, ondrop }) {
    Object.assign(this, { drawing, ondrag, ondrop, fields: new Map(), grips: new Map(), values: {}, index: 0 });
    Object.assign(this, { held: null, dropped: null }); // `dropped`: {grip, place} of a drop that has no answer yet
    drawing.onview = () => this.show(this.index);
    this.layer = element("g", drawing.svg, { class: "handles" });
    this.mark = element("path", this.layer, { class: "target", d: "M-9 0H9M0 -9V9", visibility: "hidden" });
    this.tip = element("text", drawing.svg, { class: "tip", visibility: "hidden" });
  }

  // Names and units of the parameters, [{path, group, label, unit, factor}].
  describe(fields) { this.fields = new Map(fields.map((field) => [field.path, field])); }

  // New points and values, with the step of lengths, m.
  update(items, values, snap) {
    Object.assign(this, { values, snap });
    const names = new Set(items.map(({ name }) => name));
    for (const [name, grip] of this.grips) {
      if (names.has(name)) continue;
      grip.group.remove();
      this.grips.delete(name);
    }
    for (const item of [...items].reverse()) { // the first lie on top
      if (!this.grips.has(item.name)) this.grips.set(item.name, this.grip(item));
      Object.assign(this.grips.get(item.name), { item });
    }
    this.show(this.index);
  }

  // Other values beside the points, where no machine can be shown.
  setValues(values) {
    this.values = values;
    if (this.tipped) this.showTip(this.tipped);
  }

  grip({ name, label, kind }) {
    const group = element("g", this.layer, {
      class: `grip grip-${kind}`, tabindex: 0, role: "button", "aria-label": label, "aria-description": HINT,
      "aria-roledescription": "point to drag", "data-handle": name,
    });
    const grip = { group, name, leader: element("path", group, { class: "leader" }) };
    element("circle", group, { class: "reach", r: REACH });
    element("path", group, { class: "form", d: GRIPS[kind] });
    const on = (kinds, listener) => kinds.split(" ").forEach((word) => group.addEventListener(word, listener));
    on("pointerdown", (event) => this.grab(grip, event));
    on("keydown", (event) => this.nudge(grip, event));
    on("keyup blur", () => this.held?.grip === grip && this.held.keys && this.drop());
    on("pointerenter focus", () => { if (!this.held) this.showTip(grip); });
    on("pointerleave blur", () => { if (!this.held) this.showTip(null); });
    return grip;
  }

  show(index) {
    this.index = index;
    for (const grip of this.grips.values()) this.place(grip);
    if (this.tipped) this.showTip(this.tipped);
    if (this.held) this.aim();
  }

  at({ position }) {
    const row = this.index % (position.length / 2);
    return [position[2 * row], position[2 * row + 1]];
  }

  place(grip) {
    const { group, item, leader } = grip, [x, y] = this.drawing.pixel(...this.at(item)), aside = item.row * ASIDE;
    const [left, top] = [x + aside, y - aside];
    put(group, { visibility: Number.isNaN(x) ? "hidden" : "visible", transform: `translate(${short(left)} ${short(top)})` });
    put(leader, { d: aside ? `M0 0L${-aside} ${aside}` : "" });
    Object.assign(grip, { left, top });
  }

  // Name and values beside a grip, or null.
  showTip(grip) {
    const { tip, drawing } = this;
    this.tipped = this.grips.has(grip?.name) ? grip : null;
    tip.setAttribute("visibility", this.tipped ? "visible" : "hidden");
    if (!this.tipped) return;
    const lines = [grip.item.label, ...grip.item.paths.map((path) => this.value(path))];
    grip.group.setAttribute("aria-label", lines.join(", "));
    const toLeft = grip.left > 0.6 * drawing.width, x = short(grip.left + (toLeft ? -TIP_ASIDE : TIP_ASIDE));
    put(tip, { "text-anchor": toLeft ? "end" : "start", y: short(Math.max(TIP_LINE, grip.top + 4)) });
    tip.replaceChildren();
    lines.forEach((line, place) => element("tspan", tip, { x, dy: place ? TIP_LINE : 0 }, line));
  }

  value(path) {
    const field = this.fields.get(path), value = this.values[path];
    if (!field || value === undefined) return path;
    const number = Number((value * field.factor).toPrecision(6));
    return `${field.group} ${field.label} = ${number} ${field.unit}`;
  }

  grab(grip, event) {
    if (event.button !== 0 || this.held) return;
    event.preventDefault(); // no text is selected
    grip.group.focus({ preventScroll: true });
    grip.group.setPointerCapture(event.pointerId);
    const { drawing } = this, [x, y] = this.start(grip), listening = new AbortController();
    const perPixel = drawing.width / drawing.svg.getBoundingClientRect().width / drawing.scale;
    this.held = { grip, x, y, index: this.index, step: this.snap, listening };
    for (const element of [this.layer, grip.group]) element.classList.add("held");
    const on = (name, listener) => window.addEventListener(name, (next) => {
      if (next.pointerId === event.pointerId) listener(next);
    }, { signal: listening.signal });
    on(MOVED, ({ clientX, clientY, altKey }) => {
      this.move(x + perPixel * (clientX - event.clientX), y - perPixel * (clientY - event.clientY), !altKey);
    });
    on("pointerup", () => this.drop());
    on("pointercancel", () => this.drop());
  }

  nudge(grip, event) {
    const step = NUDGES[event.key];
    if (!step || event.ctrlKey || event.metaKey || (this.held && !this.held.keys)) return;
    event.preventDefault();
    event.stopPropagation(); // the crank stands
    const [x, y] = this.start(grip);
    this.held ??= { grip, x, y, index: this.index, step: this.snap, keys: true };
    const times = (event.shiftKey ? 10 : 1) * (event.altKey ? 0.1 : 1) * this.snap;
    this.move(this.held.x + times * step[0], this.held.y + times * step[1], !event.altKey);
  }

  // Where a movement of a point begins.
  start(grip) { return this.dropped?.grip === grip ? this.dropped.place : this.at(grip.item); }

  // Ask for the point at a place: at once, or at the next frame if this one has asked.
  move(x, y, snap) {
    Object.assign(this.held, { x, y, snap, asked: false });
    if (!this.frame) this.ask();
  }

  ask() {
    this.held.asked = true;
    this.aim();
    this.showTip(this.held.grip);
    this.ondrag(this.wanted);
    this.frame = requestAnimationFrame(() => {
      this.frame = null;
      if (!this.held.asked) this.ask();
    });
  }

  // Request of the present place.
  get wanted() {
    const { grip, x, y, index, snap, step } = this.held;
    return { handle: grip.name, x, y, index, snap, step };
  }

  // A cross where the pointer wants the point.
  aim() {
    const [x, y] = this.drawing.pixel(this.held.x, this.held.y);
    put(this.mark, { visibility: "visible", transform: `translate(${short(x)} ${short(y)})` });
  }

  drop() {
    cancelAnimationFrame(this.frame);
    this.frame = null;
    const { grip, x, y, snap, listening } = this.held, { wanted } = this;
    listening?.abort();
    this.held = null;
    for (const group of [this.layer, grip.group]) group.classList.remove("held");
    this.mark.setAttribute("visibility", "hidden");
    if (snap === undefined) return; // it was not moved
    this.dropped = { grip, place: [x, y] };
    this.ondrop(wanted);
  }
}
