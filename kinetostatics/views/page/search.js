// A search for a better machine: parameters to vary, the goal, limits; steps while it runs, and the result.
import { button, checkbox, made } from "./html.js";
import { OutputChoice } from "./output.js";

const RESULT_DIGITS = 6;

export class Search {
  constructor(parent, explore) {
    Object.assign(this, { explore, fields: new Map(), stop: null });
    this.root = made(parent, "form", { class: "search" });
    this.root.addEventListener("submit", (event) => { event.preventDefault(); this.start(); });
    this.goal = document.createElement("select");
    this.goal.setAttribute("aria-label", "goal");
    for (const goal of ["minimise", "maximise"]) made(this.goal, "option", { value: goal }, goal);
    this.output = new OutputChoice(this.root, () => {});
    this.output.line.prepend(this.goal, " ");
    const limits = made(this.root, "label", {}, "Limits, one a line");
    this.limits = made(limits, "textarea", { rows: 2, placeholder: "largest O <= 40 kN" });
    const varied = made(this.root, "fieldset");
    made(varied, "legend", {}, "Parameters to vary, between the ends of their sliders");
    this.ticks = made(varied, "div", { class: "ticks" });
    const tools = made(this.root, "p");
    this.starter = made(tools, "button", { type: "submit" }, "Start");
    this.canceller = button(tools, "Cancel", () => explore.requests.ask("cancel", {}, () => {}), { disabled: "" });
    this.progress = made(this.root, "p", { class: "progress", role: "status" });
    this.result = made(this.root, "div", { class: "result wide" });
  }

  // Parameters and quantities of another machine: a search of the one before ends, and its result goes.
  describe(fields, quantities) {
    this.result.replaceChildren();
    this.progress.textContent = this.stop ? "Cancelled, as another machine is shown." : "";
    if (this.stop) this.explore.requests.ask("cancel", {}, () => {});
    this.ended();
    const ticked = new Set(this.ticked);
    this.fields = fields;
    this.output.describe(quantities);
    this.ticks.replaceChildren();
    for (const [path, { group, label }] of fields) {
      checkbox(this.ticks, `${group}: ${label}`, ticked.has(path), () => {}).value = path;
    }
  }

  get ticked() { return [...this.ticks.querySelectorAll("input:checked")].map(({ value }) => value); }

  // A number of a parameter in its shown unit.
  text(path, value) {
    const { factor, unit } = this.fields.get(path);
    return `${Number((value * factor).toPrecision(RESULT_DIGITS))} ${unit}`.trim();
  }

  named(path) {
    const { group, label } = this.fields.get(path);
    return `${group}: ${label}`;
  }

  start() {
    const paths = this.ticked;
    if (!paths.length) { this.progress.textContent = "Tick the parameters to vary."; return; }
    const vary = Object.fromEntries(paths.map((path) => [path, this.explore.parameters.ends(path)]));
    const limits = this.limits.value.split("\n").map((line) => line.trim()).filter(Boolean);
    const goal = { goal: this.goal.value, output: this.output.text };
    const { shown, reference, requests } = this.explore;
    if (!shown) { this.progress.textContent = "A machine that cannot be assembled has no numbers."; return; }
    const machine = { state: shown.state, reference: reference ? reference.state : null };
    this.stop = requests.ask("optimise", { ...machine, ...goal, vary, limits }, (answer) => this.receive(answer, shown));
    this.result.replaceChildren();
    this.progress.textContent = "The search starts …";
    this.starter.disabled = true;
    this.canceller.disabled = false;
  }

  // No search runs any more: await no answers.
  ended() {
    this.stop?.();
    this.stop = null;
    this.starter.disabled = false;
    this.canceller.disabled = true;
  }

  // `searched`: the answer to a look of the machine from which the search started.
  receive(answer, searched) {
    const { step, goal, unit, best, kept } = answer;
    if (step) {
      const numbers = Object.entries(best).map(([path, value]) => `${this.named(path)} ${this.text(path, value)}`);
      const missed = kept ? "" : ", which does not keep all limits yet";
      this.progress.textContent = `Step ${step}, best so far ${goal} ${unit}${missed}: ${numbers.join(", ")}`;
      return;
    }
    if (answer.problem) this.progress.textContent = answer.problem;
    else if (answer.cancelled) this.progress.textContent = "Cancelled.";
    else if (answer.values) this.finish(answer, searched);
    else return;
    this.ended();
  }

  finish({ goal, values, rows, active, notes }, { state, values: now }) {
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
    for (const [path, value] of Object.entries(values)) {
      line(this.named(path), this.text(path, now[path]), this.text(path, value));
    }
    const taken = { ...state, values: { ...state.values, ...values } };
    button(this.result, "Take these values", () => this.explore.change(taken), { class: "take" });
  }
}
