// Curves with axes in an <svg> of their own: over the crank angle, or in the plane with equal scales.
// A curve: {name, colour, dash, thin, x, y, period?, angle?}. Over the turn x is in degrees, rising over its own period
// (by default the chart's); in the plane `angle` holds the degrees of its points (by default even ones).
import { element, put, short, tenths } from "./svg.js";

const LEFT = 58, RIGHT = 16, TOP = 26, BOTTOM = 38;
const CLOSEST_TICKS = [45, 24]; // pixels, along x and y
const AIR = 0.06; // of the range, beyond the curves
const USED = 0.6; // share of the range below which it shrinks
const TURN_STEPS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 45, 90, 180, 360];
const CLOSEST = 1e-4; // smallest share of the range that a zoom shows
const FARTHEST = 20; // pixels from the pointer to a point that is read
const LONGEST_NAME = 30;
const LARGEST_VALUE = 1e300, SMALLEST_VALUE = 1e-300; // sizes of values: larger ones are gaps, smaller ones zero

// 1, 2 or 5 times a power of ten, not below a number.
function roundStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((step) => step * power).find((step) => step >= 0.999999 * least);
}

function multiples(step, [low, high]) {
  const first = Math.ceil(low / step - 1e-9), count = Math.floor(high / step + 1e-9) - first + 1;
  return Array.from({ length: Math.max(0, count) }, (_, place) => (first + place) * step);
}

function tickText(value, step) {
  const decimals = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
  const size = Math.abs(value), fixed = size < 1e21 ? (value || 0).toFixed(Math.min(100, decimals)) : "";
  if (size < 1e6 && decimals <= 5) return fixed;
  if (size < step / 2) return "0";
  const [most, least] = [size, step].map((number) => Math.floor(Math.log10(number) + 1e-9));
  const scientific = value.toExponential(Math.min(15, Math.max(0, most - least)));
  return fixed && fixed.length < scientific.length ? fixed : scientific;
}

const spanOf = ([low, high]) => high - low;

const crosses = ([low, high]) => low <= 0 && high >= 0;

const significant = (value) => (Number.isFinite(value) ? String(Number(value.toPrecision(6))) : "");

export class Chart {
  constructor(parent, { label = "", unit = "", plane = false, period = 360, height = 220 } = {}) {
    Object.assign(this, { parent, label, unit, plane, period, height, sight: LARGEST_VALUE, curves: [], area: null });
    Object.assign(this, { range: null, zoom: null, angle: null, tips: null, drag: null, onchoose: null, drawn: [] });
    this.svg = element("svg", parent, { class: `chart ${plane ? "plane" : "turn"}`, role: "img", tabindex: 0 });
    this.build();
    this.listen();
    this.width = this.measured();
    new ResizeObserver(() => {
      if (this.measured() === this.width) return;
      this.width = this.measured();
      this.draw();
    }).observe(parent);
  }

  measured() { return Math.max(200, Math.round(this.parent.clientWidth || 480)); }

  build() {
    const { svg } = this, layer = (name) => element("path", svg, { class: name });
    [this.grid, this.zero, this.rim] = ["grid", "zero", "rim"].map(layer);
    this.texts = element("g", svg, { class: "ticks" });
    this.labels = element("g", svg, { class: "labels" });
    this.inner = element("svg", svg, { x: LEFT, y: TOP, overflow: "hidden" }); // cuts what lies beyond the axes
    this.bands = element("path", this.inner, { class: "band" });
    this.lines = element("g", this.inner, { class: "curves" });
    this.needle = element("path", this.inner, { class: "cursor" });
    this.dots = element("g", this.inner);
    this.frame = element("rect", this.inner, { class: "zoom", visibility: "hidden" });
    this.reading = element("g", svg, { class: "reading", visibility: "hidden" });
    this.plate = element("rect", this.reading, { rx: 3 });
    this.values = element("g", this.reading);
  }

  // Curves, and another label, unit or limit of what is drawn: larger values are gaps.
  set(curves, { label = this.label, unit = this.unit, sight = Infinity } = {}) {
    if (label !== this.label || unit !== this.unit) Object.assign(this, { range: null, zoom: null });
    Object.assign(this, { curves, label, unit, sight: Math.min(sight ?? LARGEST_VALUE, LARGEST_VALUE) });
    this.draw();
  }

  // A grey area between two curves, or null.
  band(area) {
    this.area = area;
    this.draw();
  }

  stale(wanted) { this.svg.classList.toggle("stale", wanted); }

  // Points of a curve one after another, over all its periods and closed; `gap` instead of those out of sight.
  visit({ x, y, period = this.period }, point, gap = () => {}) {
    const turns = this.plane ? 1 : Math.max(1, Math.round(this.period / period)), { length } = x;
    if (!length) return;
    for (let turn = 0, shift = 0; turn <= turns; turn += 1, shift = this.plane ? 0 : turn * period) {
      for (let place = 0; place < (turn === turns ? 1 : length); place += 1) {
        const size = this.plane ? Math.hypot(x[place], y[place]) : Math.abs(y[place]);
        if (size <= this.sight) point(x[place] + shift, y[place], place); else gap();
      }
    }
  }

  // Least and largest values of all curves: [[left, right], [low, high]]; null without any.
  needed() {
    let [left, right, low, high] = [Infinity, -Infinity, Infinity, -Infinity];
    const grow = (x, y) => {
      if (x < left) left = x;
      if (x > right) right = x;
      if (y < low) low = y;
      if (y > high) high = y;
    };
    for (const curve of this.curves) this.visit(curve, grow);
    if (this.area) for (const side of ["low", "high"]) this.visit({ x: this.area.x, y: this.area[side] }, grow);
    if (low > high) return null;
    const wide = ([least, most]) => {
      const size = Math.max(Math.abs(least), Math.abs(most)), span = most - least;
      if (size < SMALLEST_VALUE) return [-0.1, 0.1];
      if (span <= 1e-9 * size) return [least - size * 0.1, most + size * 0.1];
      return [least - AIR * span, most + AIR * span];
    };
    return [this.plane ? wide([left, right]) : [0, this.period], wide([low, high])];
  }

  // It grows at once and shrinks only when little of it is used, so that it is calm under a dragged point.
  settle() {
    const needed = this.needed(), { range } = this;
    if (!needed || !range) { this.range = needed; return; }
    const used = this.plane ? Math.max(...needed.map(spanOf)) / Math.max(...range.map(spanOf))
      : spanOf(needed[1]) / spanOf(range[1]);
    const grown = ([low, high], axis) => [Math.min(low, range[axis][0]), Math.max(high, range[axis][1])];
    this.range = used < USED ? needed : needed.map(grown);
  }

  draw() {
    const { width, height } = this;
    this.settle();
    let [across, up] = this.zoom || this.range || [this.plane ? [-1, 1] : [0, this.period], [-1, 1]];
    const [wide, tall] = [width - LEFT - RIGHT, height - TOP - BOTTOM];
    if (this.plane) { // equal scales
      const unit = Math.max(spanOf(across) / wide, spanOf(up) / tall);
      const about = ([low, high], pixels) => [(low + high - unit * pixels) / 2, (low + high + unit * pixels) / 2];
      [across, up] = [about(across, wide), about(up, tall)];
    }
    Object.assign(this, { across, up, wide, tall, scaleX: wide / spanOf(across), scaleY: tall / spanOf(up) });
    const seen = [...across, ...up, width, this.label, this.unit, this.period].join("\n");
    if (seen !== this.seen) this.axes();
    this.seen = seen; // what the axes show
    this.strokes();
    this.point();
  }

  get title() { return this.plane ? `hodograph of ${this.label}` : `${this.label} over the crank angle`; }

  x(value) { return this.scaleX * (value - this.across[0]); }

  y(value) { return this.scaleY * (this.up[1] - value); }

  // Steps of the ticks along both axes.
  steps() {
    const { across, plane, period } = this, step = roundStep(CLOSEST_TICKS[1] / this.scaleY);
    if (plane) return [roundStep(CLOSEST_TICKS[0] / this.scaleX), step];
    const turn = TURN_STEPS.find((degrees) => degrees >= spanOf(across) / 4.5);
    return [turn && spanOf(across) < period ? turn : period / 4, step];
  }

  axes() {
    const { across, up, wide, tall, plane } = this, [stepX, stepY] = this.steps(), corner = `translate(${LEFT} ${TOP})`;
    put(this.svg, { viewBox: `0 0 ${this.width} ${this.height}`, "aria-label": this.title });
    put(this.inner, { width: wide, height: tall });
    const columns = multiples(stepX, across), rows = multiples(stepY, up);
    const column = (value) => `M${short(this.x(value))} 0v${tall}`;
    const row = (value) => `M0 ${short(this.y(value))}h${wide}`;
    put(this.grid, { transform: corner, d: columns.map(column).join("") + rows.map(row).join("") });
    put(this.zero, { transform: corner, d: (crosses(up) ? row(0) : "") + (plane && crosses(across) ? column(0) : "") });
    put(this.rim, { d: `M${LEFT} ${TOP}v${tall}h${wide}` });
    this.write(this.texts, [
      ...columns.map((value) => [LEFT + this.x(value), TOP + tall + 15, tickText(value, stepX), "middle"]),
      ...rows.map((value) => [LEFT - 6, TOP + this.y(value) + 4, tickText(value, stepY), "end"]),
    ]);
    const quantity = (axis) => `${this.label}${axis} [${this.unit || "1"}]`;
    this.write(this.labels, [
      [LEFT + wide / 2, this.height - 6, plane ? quantity(", x") : "crank angle [°]", "middle"],
      [4, 15, quantity(plane ? ", y" : ""), "start"],
    ]);
  }

  // Texts in a group: elements stay, those too many are empty.
  write(group, items) {
    while (group.childElementCount < items.length) element("text", group);
    [...group.children].forEach((text, number) => {
      const [x, y, words, anchor] = items[number] || [0, 0, "", "start"];
      if (text.textContent !== words) text.textContent = words;
      if (words) put(text, { x: short(x), y: short(y), "text-anchor": anchor });
    });
  }

  trace(curve) {
    let text = "", pen = "M";
    const { scaleX, scaleY, across: [left], up: [, high] } = this;
    this.visit(curve, (x, y) => {
      text += `${pen}${tenths(scaleX * (x - left))} ${tenths(scaleY * (high - y))}`;
      pen = "L";
    }, () => { pen = "M"; });
    return text;
  }

  // One path for each curve.
  strokes() {
    const { curves, lines, dots, area } = this;
    while (lines.childElementCount < curves.length) {
      element("path", lines);
      element("circle", dots, { r: 3.5 });
    }
    const place = [this.scaleX, this.scaleY, this.across[0], this.up[1], this.sight, this.period].join();
    [...lines.children].forEach((path, number) => {
      const curve = curves[number], before = this.drawn[number];
      if (before && before.curve === curve && before.place === place) return; // the reference, mostly
      this.drawn[number] = { curve, place };
      put(path, { d: curve ? this.trace(curve) : "" });
      if (!curve) return;
      const { thin, colour, dash } = curve;
      put(path, { class: thin ? "curve thin" : "curve", stroke: colour, "stroke-dasharray": dash || "none" });
      put(dots.children[number], { fill: curve.colour });
    });
    put(this.bands, { d: area ? this.between(area) : "" });
  }

  // Closed paths around an area: one for each run of points without a gap.
  between({ x, low, high }) {
    let text = "", above = [], below = [];
    const corner = (left, up) => `${short(this.x(left))} ${short(this.y(up))}`;
    const end = () => {
      if (above.length > 1) text += `M${[...above, ...below.reverse()].join("L")}Z`;
      [above, below] = [[], []];
    };
    this.visit({ x, y: high }, (left, up, place) => {
      if (!(Math.abs(low[place]) <= this.sight)) { end(); return; }
      above.push(corner(left, up));
      below.push(corner(left, low[place]));
    }, end);
    end();
    return text;
  }

  // The chosen crank angle: a line over the turn and a point on each curve, at `tips` [[x, y], ...] if given.
  cursor(degrees, tips = null) {
    Object.assign(this, { angle: degrees, tips });
    this.point();
  }

  point() {
    const { angle, curves, dots, needle, tips } = this;
    const across = angle === null || this.plane ? "" : `M${short(this.x(angle))} 0v${this.tall}`;
    put(needle, { d: across });
    [...dots.children].forEach((dot, number) => {
      const curve = curves[number];
      const found = angle === null || !curve ? null : tips ? tips[number] : this.at(curve, angle);
      const seen = Boolean(found) && Number.isFinite(found[0] + found[1]);
      put(dot, seen ? { cx: short(this.x(found[0])), cy: short(this.y(found[1])), visibility: "visible" }
        : { visibility: "hidden" });
    });
  }

  // Point of a curve at a crank angle, between its neighbours, or null.
  at({ x, y, angle, period = this.period }, degrees) {
    const { length } = y, own = ((degrees % period) + period) % period, places = this.plane ? angle : x;
    if (!length) return null;
    let place = 0, share = 0;
    if (places) {
      let last = length - 1;
      while (place < last) { // the last point not after the angle
        const middle = (place + last + 1) >> 1;
        if (places[middle] <= own) place = middle; else last = middle - 1;
      }
      const before = places[place], after = place + 1 < length ? places[place + 1] : places[0] + period;
      share = after > before ? Math.min(1, Math.max(0, (own - before) / (after - before))) : 0;
    } else {
      place = Math.floor(own / period * length);
      share = own / period * length - place;
    }
    const next = (place + 1) % length;
    const [left, up] = [x, y].map((all) => (share ? all[place] + share * (all[next] - all[place]) : all[place]));
    const size = this.plane ? Math.hypot(left, up) : Math.abs(up);
    return size <= this.sight ? [this.plane ? left : degrees, up] : null;
  }

  // Pointer: choose the angle; with Shift frame a part to zoom; Ctrl and wheel; double click shows all. Keys: + - 0.
  listen() {
    const { svg } = this, on = (name, work, options) => svg.addEventListener(name, work, options);
    on("pointerdown", (event) => {
      if (event.button !== 0) return;
      svg.setPointerCapture(event.pointerId);
      this.drag = event.shiftKey ? this.place(event) : "choose";
      if (event.shiftKey) event.preventDefault();
      this.dragged(event);
    });
    on("pointermove", (event) => { this.dragged(event); this.read(this.place(event)); });
    on("pointerup", (event) => this.dropped(event));
    on("pointercancel", () => { this.drag = null; });
    on("pointerleave", () => this.read(null));
    on("dblclick", () => this.show(null));
    on("wheel", (event) => {
      if (!event.ctrlKey) return;
      event.preventDefault();
      this.scaled(event.deltaY > 0 ? 1.25 : 0.8, this.place(event));
    }, { passive: false });
    on("keydown", (event) => {
      const times = { "+": 0.8, "-": 1.25 }[event.key];
      if (event.ctrlKey || event.altKey || event.metaKey || !(times || event.key === "0")) return;
      const x = this.angle === null || this.plane ? this.wide / 2 : this.x(this.angle);
      if (times) this.scaled(times, [x, this.tall / 2]); else this.show(null);
      event.preventDefault();
    });
  }

  // Pixels of an event from the corner of the axes.
  place(event) {
    const box = this.svg.getBoundingClientRect(), shrunk = box.width / this.width || 1;
    return [(event.clientX - box.left) / shrunk - LEFT, (event.clientY - box.top) / shrunk - TOP];
  }

  value([x, y]) { return [this.across[0] + x / this.scaleX, this.up[1] - y / this.scaleY]; }

  dragged(event) {
    const [x, y] = this.place(event);
    if (this.drag === "choose") {
      const degrees = Math.min(this.period, Math.max(0, this.value([x, y])[0]));
      if (this.onchoose && !this.plane) this.onchoose(degrees);
    } else if (this.drag) {
      const [startX, startY] = this.drag;
      put(this.frame, {
        x: short(Math.min(x, startX)), y: short(Math.min(y, startY)), width: short(Math.abs(x - startX)),
        height: short(Math.abs(y - startY)), visibility: "visible",
      });
    }
  }

  dropped(event) {
    const start = this.drag, end = this.place(event);
    this.drag = null;
    put(this.frame, { visibility: "hidden" });
    if (!Array.isArray(start) || Math.abs(start[0] - end[0]) < 4 || Math.abs(start[1] - end[1]) < 4) return;
    const corners = [this.value(start), this.value(end)];
    this.show([0, 1].map((axis) => corners.map((corner) => corner[axis]).sort((one, other) => one - other)));
  }

  // Range times a factor about a place.
  scaled(times, place) {
    const about = this.value(place);
    this.show([this.across, this.up].map((ends, axis) => ends.map((end) => about[axis] + times * (end - about[axis]))));
  }

  // A part of the range, or all of it.
  show(wanted) {
    const { plane, range } = this;
    const cut = ([low, high], axis) => [Math.max(low, range[axis][0]), Math.min(high, range[axis][1])];
    const part = wanted && range && (plane ? wanted : wanted.map(cut));
    const shares = part ? part.map((ends, axis) => spanOf(ends) / spanOf(range[axis])) : [1];
    if (Math.min(...shares) < CLOSEST) return;
    this.zoom = shares.every((share) => share >= 1) ? null : part;
    this.draw();
  }

  // Values at the pointer: of all curves at its angle; in the plane of the nearest point.
  read(place) {
    const [x, y] = Array.isArray(this.drag) || !place ? [-1, -1] : place;
    const inside = x >= 0 && x <= this.wide && y <= this.tall;
    const lines = !inside ? [] : this.plane ? this.nearest(place) : this.crossed(place);
    this.reading.setAttribute("visibility", lines.length ? "visible" : "hidden");
    if (!lines.length) return;
    this.write(this.values, lines.map((words, row) => [0, 15 * row, words, "start"]));
    const box = this.values.getBBox(), beside = LEFT + x + 14;
    put(this.plate, { x: box.x - 6, y: box.y - 4, width: box.width + 12, height: box.height + 8 });
    const left = beside + box.width + 8 < this.width ? beside : Math.max(8, beside - 28 - box.width);
    const top = Math.max(16, TOP + y - 15 * lines.length);
    put(this.reading, { transform: `translate(${short(left)} ${short(top)})` });
  }

  named(name, words) {
    const called = name.length > LONGEST_NAME ? `${name.slice(0, LONGEST_NAME)}…` : name;
    return this.curves.length > 1 ? `${called}: ${words} ${this.unit}` : `${words} ${this.unit}`;
  }

  crossed(place) {
    const [degrees] = this.value(place);
    const found = this.curves.map(({ name, ...curve }) => [name, this.at(curve, degrees)]).filter(([, point]) => point);
    const lines = found.map(([name, [, value]]) => this.named(name, significant(value)));
    return lines.length ? [`${degrees.toFixed(1)}°`, ...lines] : [];
  }

  nearest([left, top]) {
    let best = FARTHEST ** 2, lines = [];
    for (const curve of this.curves) {
      const { name, period = this.period, angle } = curve;
      this.visit(curve, (x, y, place) => {
        const far = (this.x(x) - left) ** 2 + (this.y(y) - top) ** 2;
        if (far >= best) return;
        best = far;
        const degrees = angle ? angle[place] : place * period / curve.x.length;
        lines = [`${degrees.toFixed(1)}°`, this.named(name, `${significant(x)}, ${significant(y)}`)];
      });
    }
    return lines;
  }
}
