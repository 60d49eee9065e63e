// A slider and a number field with unit for each parameter, in groups; a box to search them.
import { button, made } from "./html.js";

const DIGITS = 7; // of a number in a field
const WIDER = 1.5; // times a number beyond the ends of its slider is the new end

// One parameter. Numbers are shown in its unit; `onchange(path, value, still)` gets them in SI, null for the first one.
class Row {
  constructor(parent, field, onchange) {
    Object.assign(this, { field, onchange, moving: false, typing: false });
    const { path, group, label, unit, low, high, step, factor } = field, name = `${group}: ${label}`;
    this.element = made(parent, "div", { class: "row", title: path });
    made(this.element, "span", { class: "label" }, label);
    this.slider = made(this.element, "input", { type: "range", "aria-label": name });
    Object.assign(this.slider, { min: this.text(low), max: this.text(high), step: this.text(step) });
    this.number = made(this.element, "input", { type: "number", step: "any", "aria-label": `${name} in ${unit}` });
    made(this.element, "span", { class: "unit" }, unit === "1" ? "" : unit);
    this.back = button(this.element, "↺", () => onchange(path, null, false), { class: "plain back" });
    const words = `back to ${this.text(field.value)} ${unit}`;
    this.back.title = words;
    this.back.setAttribute("aria-label", `${name}: ${words}`);
    const set = (text, still) => {
      if (text === this.text(field.value)) onchange(path, null, still);
      else if (text !== "" && Number.isFinite(Number(text))) onchange(path, Number(text) / factor, still);
    };
    this.slider.addEventListener("input", () => { this.moving = true; set(this.slider.value, true); });
    const rest = () => { this.moving = false; set(this.slider.value, false); };
    this.slider.addEventListener("change", rest);
    this.slider.addEventListener("blur", () => { if (this.moving) rest(); });
    this.number.addEventListener("input", () => { this.typing = true; });
    this.number.addEventListener("change", () => { this.typing = false; set(this.number.value, false); });
    this.number.addEventListener("blur", () => this.reset());
    this.number.addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.reset();
      if (this.typing && (event.ctrlKey || event.metaKey)) event.stopPropagation(); // undo in the text
    });
  }

  reset() {
    this.typing = false;
    this.show(this.value, true);
  }

  text(value) { return String(Number((value * this.field.factor).toPrecision(DIGITS))); }

  // Ends of its slider, SI.
  get ends() { return [this.slider.min, this.slider.max].map((end) => Number(end) / this.field.factor); }

  get changed() { return this.value !== this.field.value; }

  // Its number, SI; what is under the hand stays.
  show(value, anew = false) {
    if (value === this.value && !anew) return;
    const { slider, number, field, element } = this, text = this.text(value);
    this.value = value;
    if (!this.moving) {
      const { low, high, step } = field, wide = WIDER * value / step;
      Object.assign(slider, {
        min: this.text(value < low ? Math.floor(wide) * step : low),
        max: this.text(value > high ? Math.ceil(wide) * step : high),
        value: text,
      });
    }
    if (!this.typing && number.value !== text) number.value = text;
    slider.setAttribute("aria-valuetext", `${text} ${field.unit}`);
    element.classList.toggle("changed", this.changed);
    this.back.disabled = !this.changed;
  }
}

export class Parameters {
  // `onchange(path, value, still)`: a number in SI, null for the variant's own; `still` while a slider is moved.
  constructor(element, onchange) {
    Object.assign(this, { element, onchange, rows: new Map(), groups: new Map(), folded: new Map() });
    this.search = made(element, "input", {
      type: "search", placeholder: "search parameters", "aria-label": "search parameters",
    });
    this.search.addEventListener("input", () => this.find());
    this.list = made(element, "div", { class: "list" });
  }

  // Rows of another machine; groups stay folded as they are, at first those of zeros are.
  describe(fields) {
    this.rows.clear();
    this.groups.clear();
    this.list.replaceChildren();
    for (const field of fields) {
      const zeros = fields.every(({ group, value }) => group !== field.group || value === 0);
      if (!this.groups.has(field.group)) this.group(field.group, this.folded.get(field.group) ?? !zeros);
      const { body, rows } = this.groups.get(field.group), row = new Row(body, field, this.onchange);
      rows.push(row);
      this.rows.set(field.path, row);
    }
    this.find();
  }

  group(name, open) {
    const details = made(this.list, "details", open ? { open: "" } : {}), summary = made(details, "summary", {}, name);
    const count = made(summary, "span", { class: "count" });
    summary.addEventListener("click", () => this.folded.set(name, !details.open));
    this.groups.set(name, { details, count, body: made(details, "div", { class: "rows" }), rows: [] });
  }

  // Show the rows with the words that are searched, in their groups.
  find() {
    const words = this.search.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const [name, { details, rows }] of this.groups) {
      for (const { element, field } of rows) {
        const text = `${name} ${field.label} ${field.path}`.toLowerCase();
        element.hidden = !words.every((word) => text.includes(word));
      }
      details.hidden = rows.every(({ element }) => element.hidden);
      if (words.length) details.open = true; else if (this.folded.has(name)) details.open = this.folded.get(name);
    }
  }

  // Numbers by path, SI.
  show(values) {
    for (const [path, row] of this.rows) if (path in values) row.show(values[path]);
    for (const { count, rows } of this.groups.values()) {
      const changed = rows.filter((row) => row.changed).length;
      const text = changed ? `${changed} changed` : "";
      if (count.textContent !== text) count.textContent = text;
    }
  }

  ends(path) { return this.rows.get(path).ends; }

  // Bring a parameter into view, with the focus on its slider.
  focus(path) {
    const row = this.rows.get(path);
    if (!row) return;
    this.search.value = "";
    this.find();
    this.groups.get(row.field.group).details.open = true;
    row.slider.focus();
    row.element.scrollIntoView({ block: "nearest" });
  }
}
