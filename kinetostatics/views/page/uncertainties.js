// Standard uncertainties of parameters, for tolerance bands around the curves.
import { checkbox, made } from "./html.js";

export class Uncertainties {
  constructor(parent, onchange) {
    Object.assign(this, { onchange, spreads: null, fields: new Map() });
    this.root = made(parent, "div", { class: "uncertainties" });
    const words = "Show bands: two standard uncertainties on both sides, of first order";
    this.box = checkbox(this.root, words, false, onchange);
    this.list = made(this.root, "div", { class: "inputs" });
    this.adding = made(this.root, "select", { "aria-label": "add an uncertain parameter" });
    this.adding.addEventListener("change", () => this.add(this.adding.value));
    this.notes = made(this.root, "p", { class: "notes", role: "status" });
  }

  get wanted() { return this.box.checked; }

  // Parameters of another machine; null asks for the uncertainties of the case file.
  describe(fields) {
    const same = [...fields.keys()].join() === [...this.fields.keys()].join();
    this.fields = fields;
    if (same) return;
    this.spreads = null;
    this.list.replaceChildren();
    this.adding.replaceChildren();
    made(this.adding, "option", { value: "" }, "add an uncertain parameter …");
    for (const [path, { group, label }] of fields) made(this.adding, "option", { value: path }, `${group}: ${label}`);
  }

  show(spreads) {
    if (this.spreads) return;
    this.spreads = {};
    for (const [path, deviation] of Object.entries(spreads)) this.row(path, deviation);
  }

  add(path) {
    this.adding.value = "";
    this.spreads ??= {};
    if (path && !(path in this.spreads)) this.row(path, 0).focus();
  }

  row(path, deviation) {
    const field = this.fields.get(path), line = made(this.list, "label");
    line.append(`${field.group}: ${field.label} ± `);
    const number = made(line, "input", { type: "number", min: 0, step: "any", "data-path": path });
    number.value = Number((deviation * field.factor).toPrecision(6));
    line.append(` ${field.unit}`);
    this.spreads[path] = deviation;
    number.addEventListener("change", () => {
      this.spreads[path] = Math.max(0, Number(number.value)) / field.factor;
      this.onchange();
    });
    return number;
  }

  say(problem, notes) { this.notes.textContent = problem || [...new Set(notes)].filter(Boolean).join("\n"); }
}
