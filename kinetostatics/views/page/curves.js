// Curves over the crank angle and hodographs on the explore page: charts of chosen quantities, values at the angle.
import { shown } from "./arrays.js";
import { Chart } from "./chart.js";
import { button, checkbox, made } from "./html.js";

export const NOW = "#1f4e79", BEFORE = "#5b6873";
const DASHES = "5 3", HEIGHT = 205, PLANE_HEIGHT = 290;
const CAPTION_DIGITS = 4; // of the largest value of a curve in its caption
const RUNNING = "motor speed"; // of a case with a drive; it comes after the curves

// Values of a quantity in its shown unit, of a vector its magnitude.
function magnitudes({ values, vector, factor }) {
  if (!vector) return values.map((value) => factor * value);
  const count = values.length / 2;
  return Float64Array.from({ length: count }, (_, place) => factor * Math.hypot(values[place], values[count + place]));
}

function parts({ values, factor }) {
  const count = values.length / 2;
  return [values.subarray(0, count), values.subarray(count)].map((part) => part.map((value) => factor * value));
}

// Decimals that give the largest value of a curve, of those in sight, four significant digits.
function decimalsOf(values, sight) {
  let largest = 0;
  for (const value of values) {
    const size = Math.abs(value);
    if (size > largest && size <= sight) largest = size;
  }
  return largest ? Math.min(12, Math.max(0, CAPTION_DIGITS - 1 - Math.floor(Math.log10(largest)))) : 0;
}

// One chart with its name, values at the crank angle, and buttons.
class Figure {
  constructor(parent, name, plane, { onchoose, onremove, onplane }) {
    Object.assign(this, { name, plane, element: made(parent, "figure", { class: "figure" }) });
    const caption = made(this.element, "figcaption");
    this.label = made(caption, "b");
    this.values = made(caption, "span", { class: "values" });
    this.before = made(caption, "span", { class: "values before" });
    this.turns = button(caption, plane ? "over the angle" : "hodograph", onplane, { class: "plain" });
    this.remove = button(caption, "×", onremove, { class: "plain remove" });
    const place = made(this.element, "div", { class: "place" });
    this.chart = new Chart(place, { plane, height: plane ? PLANE_HEIGHT : HEIGHT });
    this.words = made(this.element, "p", { class: "words" });
    this.chart.onchoose = onchoose;
  }

  // Curves of two answers; the reference may be without this quantity.
  show(shown, reference) {
    const item = shown.quantities[this.name], other = reference?.quantities[this.name], { chart, plane } = this;
    this.element.hidden = !item;
    if (!item) return;
    const label = item.vector && !plane ? `|${item.label}|` : item.label;
    this.item = { ...item, label };
    this.label.textContent = `${label} [${item.unit || "1"}]`;
    this.turns.hidden = !item.vector;
    this.remove.setAttribute("aria-label", `remove ${item.label}`);
    this.turns.setAttribute("aria-label", `${item.label}: ${plane ? "magnitude over the crank angle" : "hodograph"}`);
    const curve = (answer, quantity, style) => {
      const before = this.curves?.find((other) => other.quantity === quantity && other.factor === item.factor);
      if (before && before.name === style.name) return before;
      const own = { ...quantity, factor: item.factor }, { angle, period } = answer;
      const sizes = magnitudes(own), decimals = decimalsOf(sizes, item.sight ?? Number.MAX_VALUE);
      const [x, y] = plane ? parts(own) : [angle, sizes];
      return { ...style, x, y, period, angle, quantity, factor: item.factor, decimals };
    };
    const curves = [curve(shown, item, { name: "shown", colour: NOW })];
    if (other && other.vector === item.vector) {
      curves.unshift(curve(reference, other, { name: reference.label, colour: BEFORE, dash: DASHES, thin: true }));
    }
    Object.assign(this, { curves });
    chart.period = shown.period;
    chart.set(curves, { label, unit: item.unit, sight: item.sight === undefined ? null : item.sight });
    chart.stale(false);
  }

  say(text) {
    if (text) this.stale();
    this.words.textContent = text;
  }

  stale() {
    this.chart.stale(true);
    for (const values of [this.values, this.before]) values.textContent = "";
  }

  // Values at a crank angle, from the same answer as the curves.
  follow(degrees) {
    if (!this.item || this.element.hidden) return;
    this.chart.cursor(degrees);
    const texts = this.curves.map(({ x, y, period, decimals }) => {
      const place = Math.round((degrees % period) * y.length / period) % y.length;
      const value = this.plane ? [x[place], y[place]] : [y[place]];
      return value.map((part) => shown(part, decimals)).join(", ") || "none";
    });
    const [now, before] = texts.reverse();
    this.values.textContent = now;
    this.before.textContent = before ?? "";
  }
}

export class Curves {
  // `onchosen()` is called when other quantities are chosen, `onchoose(degrees)` when a crank angle is.
  constructor(parent, { onchosen, onchoose }) {
    Object.assign(this, { onchosen, onchoose, figures: new Map(), chosen: null, planes: new Set() });
    Object.assign(this, { answers: [null, null], runs: [null, null] });
    const bar = made(parent, "div", { class: "bar" });
    this.choice = made(bar, "details", { class: "choice" });
    made(this.choice, "summary", {}, "Curves");
    this.legend = made(bar, "p", { class: "legend" });
    this.element = made(parent, "div", { class: "figures" });
    this.choice.addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      this.choice.open = false;
      this.choice.querySelector("summary").focus();
    });
  }

  // Names of the library's quantities that are shown.
  get names() { return (this.chosen ?? []).filter((name) => name !== RUNNING); }

  get running() { return this.drive && this.chosen.includes(RUNNING); }

  // Quantities that can be chosen, with a box to search them; the motor's speed with a drive.
  offer(known, drive) {
    this.drive = drive;
    const quantities = drive ? [...known, { name: RUNNING, label: RUNNING }] : known;
    const { choice } = this, panel = document.createElement("div");
    panel.className = "panel";
    const words = "search quantities";
    const search = made(panel, "input", { type: "search", placeholder: words, "aria-label": words });
    const list = made(panel, "div", { class: "list" });
    this.boxes = new Map(quantities.map(({ name, label }) => {
      const input = checkbox(list, label, this.chosen.includes(name), (wanted) => this.choose(name, wanted));
      return [name, input];
    }));
    search.addEventListener("input", () => {
      const wanted = search.value.toLowerCase();
      for (const row of list.children) row.hidden = !row.textContent.toLowerCase().includes(wanted);
    });
    choice.querySelector(".panel")?.remove();
    choice.append(panel);
  }

  choose(name, wanted) {
    this.chosen = this.chosen.filter((other) => other !== name).concat(wanted ? [name] : []);
    const box = this.boxes.get(name);
    if (box) box.checked = wanted;
    this.onchosen();
  }

  turn(name) {
    this.planes[this.planes.has(name) ? "delete" : "add"](name);
    this.onchosen();
  }

  // Curves of two answers; the motor's speed is grey until it belongs to them.
  show(shown, reference) {
    this.answers = [shown, reference];
    for (const [name, figure] of this.figures) {
      if (this.chosen.includes(name) && figure.plane === this.planes.has(name)) continue;
      figure.element.remove();
      this.figures.delete(name);
    }
    for (const [place, name] of this.chosen.entries()) {
      if (!this.figures.has(name)) this.add(name, place);
      if (name !== RUNNING) this.figures.get(name).show(shown, reference);
      else if (this.runs[0]) this.figures.get(name).stale();
      else this.figures.get(name).element.hidden = true;
    }
    this.key(reference);
  }

  // Motor speeds of the machine that is shown and of the reference, or the reason why there is none.
  run(shown, reference, problem) {
    const figure = this.figures.get(RUNNING), [answer] = this.answers;
    if (!figure || !answer) return;
    this.runs = [shown, reference];
    const label = this.answers[1]?.label;
    if (shown) figure.show(shown, reference && label ? { ...reference, label } : null);
    figure.element.hidden = false;
    figure.say(problem);
  }

  add(name, place) {
    const figure = new Figure(this.element, name, this.planes.has(name), {
      onchoose: this.onchoose, onremove: () => this.choose(name, false), onplane: () => this.turn(name),
    });
    this.element.insertBefore(figure.element, this.element.children[place]);
    this.figures.set(name, figure);
  }

  // What the lines are.
  key(reference) {
    const wanted = reference ? reference.label : "";
    if (this.legend.dataset.reference === wanted) return;
    this.legend.dataset.reference = wanted;
    this.legend.replaceChildren();
    made(this.legend, "span", { class: "now" }, "shown");
    if (wanted) made(this.legend, "span", { class: "before" }, wanted);
  }

  stale() { this.figures.forEach((figure) => figure.stale()); }

  // A grey area in the chart of a quantity, {x, low, high} in its shown unit, or null.
  band(name, area) {
    const figure = this.figures.get(name);
    if (figure && !figure.plane) figure.chart.band(area);
  }

  follow(degrees) { this.figures.forEach((figure) => figure.follow(degrees)); }
}
