// The explore page: the mechanism, its forces and its numbers, all of one state; in a page or a notebook.
import { Chart } from "./chart.js";
import { Clock } from "./clock.js";
import { Requests } from "./connection.js";
import { Drawing } from "./drawing.js";
import { History } from "./history.js";
import { Parameters } from "./parameters.js";

const COUNT = 360, FIRST_CHARTS = 3;
const NOW = "#1f4e79", BEFORE = "#6b7280";

function made(parent, name, attributes = {}, text = "") {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text) element.textContent = text;
  parent.append(element);
  return element;
}

export class Explore {
  // `transport` sends requests; `address` keeps what is shown, {read(), write(fields)}.
  constructor(root, transport, address) {
    Object.assign(this, { root, address, charts: new Map(), shown: null, reference: null, known: null });
    this.requests = new Requests(transport);
    this.requests.onlook = (answer) => this.show(answer);
    this.requests.onlost = (reason) => this.lost(reason);
    this.build();
    this.requests.ask("open", { token: address.read().token }, (answer) => this.open(answer));
  }

  build() {
    this.root.replaceChildren();
    this.head = made(this.root, "header");
    this.title = made(this.head, "h1");
    this.tabs = made(this.head, "div", { class: "tabs", role: "tablist" });
    this.tools = made(this.head, "div", { class: "tools" });
    this.undo = this.button("Undo", () => this.move(-1));
    this.redo = this.button("Redo", () => this.move(1));
    this.freeze = this.button("Compare with now", () => this.compareWith(this.history.now));
    this.problem = made(this.root, "p", { class: "problem", role: "status" });
    const body = made(this.root, "div", { class: "body" });
    this.machine = made(body, "section", { class: "machine", "aria-label": "mechanism" });
    this.figures = made(body, "section", { class: "charts", "aria-label": "curves" });
    this.side = made(body, "section", { class: "numbers", "aria-label": "parameters" });
    this.below = made(this.root, "section", { class: "below" });
  }

  button(text, onclick) {
    const button = made(this.tools, "button", { type: "button" }, text);
    button.addEventListener("click", onclick);
    return button;
  }

  open(answer) {
    if (answer.problem) { this.say(answer.problem); return; }
    this.title.textContent = answer.title;
    this.variants = answer.variants;
    for (const { name } of answer.variants) {
      const tab = made(this.tabs, "button", { type: "button", role: "tab" }, name);
      tab.addEventListener("click", () => this.change({ variant: name, values: {} }));
    }
    const kept = this.address.read();
    this.history = new History(kept.state ? JSON.parse(kept.state) : answer.start);
    this.names = kept.show ? JSON.parse(kept.show) : null;
    this.describe();
  }

  // Fields and quantities of the machine that is shown, then the machine.
  describe() {
    const state = this.history.now;
    this.requests.ask("describe", { state }, (answer) => {
      if (answer.problem) { this.say(answer.problem); return; }
      this.known = answer;
      this.describedFor = state.variant;
      this.names ??= answer.quantities.slice(0, FIRST_CHARTS).map(({ name }) => name);
      this.parameters = new Parameters(this.side, answer.parameters, (path, value, still) => this.set(path, value, still));
      for (const [place, tab] of [...this.tabs.children].entries()) {
        tab.setAttribute("aria-selected", this.variants[place].name === state.variant);
      }
      this.askReference();
      this.look();
    });
  }

  get drawn() { return [...new Set(this.names)]; }

  set(path, value, still) {
    const { variant, values } = this.history.now;
    this.change({ variant, values: { ...values, [path]: value } }, still);
  }

  // Show another state; `still` while a hand moves a slider or a point: one step of undo for the whole movement.
  change(state, still = false) {
    this.history.keep(state, still && this.moving);
    this.moving = still;
    if (state.variant === this.describedFor) this.look(); else this.describe();
    this.remember();
  }

  move(steps) {
    const state = this.history.move(steps);
    if (!state) return;
    if (state.variant === this.describedFor) this.look(); else this.describe();
    this.remember();
  }

  remember() {
    this.undo.disabled = this.history.place === 0;
    this.redo.disabled = this.history.place === this.history.states.length - 1;
    this.address.write({ state: JSON.stringify(this.history.now), show: JSON.stringify(this.names) });
  }

  look() {
    this.requests.look("look", { state: this.history.now, show: this.drawn, count: COUNT });
  }

  compareWith(state) {
    this.compared = state;
    this.askReference();
  }

  askReference() {
    const own = this.variants.find(({ name }) => name === this.history.now.variant);
    const state = this.compared ?? { variant: own.reference, values: {} };
    this.requests.ask("look", { state, show: this.drawn, count: COUNT }, (answer) => {
      this.reference = answer.problem ? null : answer;
      if (this.shown) this.redraw();
    });
  }

  say(text) { this.problem.textContent = text; }

  lost(reason) {
    this.root.classList.add("lost");
    this.say(`${reason || "The library has ended."} Start it again, and load this page anew.`);
  }

  show(answer) {
    this.root.dataset.shown = answer.id;
    if (answer.problem) {
      this.say(answer.problem);
      this.drawing?.setGhost(true);
      this.charts.forEach((chart) => chart.stale(true));
      return;
    }
    this.say(answer.notes.join(" "));
    this.shown = answer;
    this.redraw();
  }

  redraw() {
    const { shown } = this;
    this.parameters.show(shown.values);
    if (this.drawing) {
      this.drawing.update(shown.drawing);
    } else {
      const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
      this.machine.append(svg);
      this.drawing = new Drawing(svg, shown.drawing);
      this.clock = new Clock(made(this.machine, "div", { class: "clock" }), { count: shown.angle.length, period: shown.period, way: shown.way });
      this.clock.listen((index) => this.follow(index));
    }
    this.drawing.setGhost(false);
    for (const name of this.names) this.chart(name);
    this.follow(this.clock.index);
  }

  chart(name) {
    const item = this.shown.quantities[name];
    if (!item) return;
    if (!this.charts.has(name)) {
      const chart = new Chart(made(this.figures, "div", { class: "chart" }), { period: this.shown.period });
      chart.onchoose = (degrees) => this.clock.choose(degrees);
      this.charts.set(name, chart);
    }
    const curves = [];
    const before = this.reference?.quantities[name];
    if (before) curves.push({ name: "reference", colour: BEFORE, dash: "5 3", thin: true, x: this.reference.angle, y: size(before, item.factor) });
    curves.push({ name: "now", colour: NOW, x: this.shown.angle, y: size(item, item.factor) });
    this.charts.get(name).set(curves, { label: item.vector ? `|${item.label}|` : item.label, unit: item.unit });
    this.charts.get(name).stale(false);
  }

  follow(index) {
    this.drawing.show(index);
    this.charts.forEach((chart) => chart.cursor(this.shown.angle[index % this.shown.angle.length]));
  }
}

// Values of a quantity in its shown unit; of a vector its size.
function size(item, factor) {
  const { values } = item;
  if (!item.vector) return values.map((value) => factor * value);
  const count = values.length / 2;
  return Float64Array.from({ length: count }, (_, place) => factor * Math.hypot(values[place], values[count + place]));
}
