// A search for a better machine: parameters to vary, the goal, limits; steps while it runs, and the result.
import { made } from "./html.js";
import { OutputChoice } from "./output.js";

const DIGITS = 6;

export class Search {
  // `page` as for `Ask`.
  constructor(parent, page) {
    Object.assign(this, { page, stop: null, fields: new Map(), found: null });
    this.root = made(parent, "form", { class: "search" });
    this.root.addEventListener("submit", (event) => { event.preventDefault(); this.start(); });
    this.goal = document.createElement("select");
    this.goal.setAttribute("aria-label", "goal");
    for (const goal of ["minimise", "maximise"]) made(this.goal, "option", { value: goal }, goal);
    this.output = new OutputChoice(this.root, "of", () => {});
    this.output.line.prepend(this.goal, " ");
    const limits = made(this.root, "label", {}, "Limits, one a line");
    this.limits = made(limits, "textarea", { rows: 2, placeholder: "largest O <= 40 kN" });
    const varied = made(this.root, "fieldset");
    made(varied, "legend", {}, "Parameters to vary, between the ends of their sliders");
    this.ticks = made(varied, "div", { class: "ticks" });
    const tools = made(this.root, "p");
    this.starter = made(tools, "button", { type: "submit" }, "Start");
    this.canceller = made(tools, "button", { type: "button", disabled: "" }, "Cancel");
    this.canceller.addEventListener("click", () => this.page.ask("cancel", { state: this.page.state() }, () => {}));
    this.progress = made(this.root, "p", { class: "progress", role: "status" });
    this.result = made(this.root, "div", { class: "result wide" });
  }

  describe(fields, quantities) {
    const ticked = new Set(this.ticked);
    this.fields = fields;
    this.output.describe(quantities);
    this.ticks.replaceChildren();
    for (const [path, { group, label }] of fields) {
      const line = made(this.ticks, "label"), box = made(line, "input", { type: "checkbox", value: path });
      box.checked = ticked.has(path);
      line.append(` ${group}: ${label}`);
    }
  }

  get ticked() { return [...this.ticks.querySelectorAll("input:checked")].map(({ value }) => value); }

  // A number of a parameter in its shown unit.
  text(path, value) {
    const { factor, unit } = this.fields.get(path);
    return `${Number((value * factor).toPrecision(DIGITS))} ${unit}`.trim();
  }

  named(path) {
    const { group, label } = this.fields.get(path);
    return `${group}: ${label}`;
  }

  start() {
    const paths = this.ticked;
    if (!paths.length) { this.progress.textContent = "Tick the parameters to vary."; return; }
    const vary = Object.fromEntries(paths.map((path) => [path, this.page.ends(path)]));
    const limits = this.limits.value.split("\n").map((line) => line.trim()).filter(Boolean);
    this.result.replaceChildren();
    this.progress.textContent = "The search starts …";
    this.running(true);
    const goal = { goal: this.goal.value, output: this.output.text };
    const machine = { state: this.page.state(), reference: this.page.reference() };
    this.page.ask("optimise", { ...machine, ...goal, vary, limits }, (answer) => this.told(answer));
  }

  running(now) {
    this.starter.disabled = now;
    this.canceller.disabled = !now;
  }

  told(answer) {
    const { step, goal, unit, best, kept } = answer;
    if (step) {
      const numbers = Object.entries(best).map(([path, value]) => `${this.named(path)} ${this.text(path, value)}`);
      const missed = kept ? "" : ", which does not keep all limits yet";
      this.progress.textContent = `Step ${step}, best so far ${goal} ${unit}${missed}: ${numbers.join(", ")}`;
      return;
    }
    if (answer.problem) this.progress.textContent = answer.problem;
    else if (answer.cancelled) this.progress.textContent = "Cancelled.";
    else if (answer.values) this.finish(answer);
    if (!answer.more) this.running(false);
  }

  finish({ goal, values, rows, active, notes }) {
    const binds = active.length ? `${active.join(", ")} binds.` : "No limit binds.";
    this.progress.textContent = [`Found the ${goal}. ${binds}`, ...notes].join(" ");
    const table = made(this.result, "table"), head = made(table, "tr");
    for (const title of ["", "before", "after"]) made(head, "th", { scope: "col" }, title);
    const line = (title, before, after) => {
      const row = made(table, "tr");
      made(row, "th", { scope: "row" }, title);
      for (const text of [before, after]) made(row, "td", {}, text);
    };
    for (const { output, unit, before, after } of rows) line(unit ? `${output} [${unit}]` : output, before, after);
    const now = this.page.values();
    for (const [path, value] of Object.entries(values)) {
      line(this.named(path), this.text(path, now[path]), this.text(path, value));
    }
    const take = made(this.result, "button", { type: "button", class: "take" }, "Take these values");
    take.addEventListener("click", () => this.page.take(values));
  }
}
