// Questions about the machine that is shown: its numbers, what to change, tolerance bands, a search for a better one.
import { made } from "./html.js";
import { Search } from "./search.js";
import { OutputChoice } from "./output.js";
import { SensitivityBars } from "./bars.js";
import { Uncertainties } from "./uncertainties.js";

const DELAY = 120; // ms without a change, until questions follow
const EXTREMES = {
  smallest: "smallest", smallest_at: "at [°]", largest: "largest", largest_at: "at [°]", range: "range",
  reference: "largest size, reference", ratio: "ratio",
};
const FIGURES = { value: "now", reference: "reference", ratio: "ratio" };

// A table of texts, rows by label and unit.
class Numbers {
  constructor(parent, caption, columns) {
    this.columns = columns;
    this.table = made(made(parent, "div", { class: "wide" }), "table");
    made(this.table, "caption", {}, caption);
    const head = made(made(this.table, "thead"), "tr");
    for (const title of ["", "unit", ...Object.values(columns)]) made(head, "th", { scope: "col" }, title);
    this.body = made(this.table, "tbody");
  }

  show(rows) {
    this.body.replaceChildren();
    for (const row of rows) {
      const line = made(this.body, "tr");
      made(line, "th", { scope: "row" }, row.label);
      for (const text of [row.unit, ...Object.keys(this.columns).map((name) => row[name])]) made(line, "td", {}, text);
    }
  }
}

// `page`: {ask(kind, fields, onanswer) -> stop, state(), reference(), shown(), ends(path), values(), focus(path),
// take(values), band(name, band or null)}: state of the reference or null, names of the quantities that are shown,
// ends and values of parameters in SI.
export class Ask {
  constructor(parent, page) {
    Object.assign(this, { page, timer: null, stops: [] });
    this.root = made(parent, "div", { class: "ask" });
    const numbers = this.section("Numbers", true);
    this.extremes = new Numbers(numbers, "Extremes over the period", EXTREMES);
    this.figures = new Numbers(numbers, "Means and torque extrema", FIGURES);
    this.notes = made(numbers, "p", { class: "notes" });
    const change = this.section("What should I change?");
    this.choice = new OutputChoice(change, "of", () => this.follow());
    this.bars = new SensitivityBars(change, (path) => page.focus(path));
    const tolerances = this.section("Tolerances");
    this.uncertainties = new Uncertainties(tolerances, () => this.follow());
    const search = this.section("Optimise");
    this.search = new Search(search, page);
  }

  section(title, open = false) {
    const details = made(this.root, "details", open ? { open: "" } : {});
    made(details, "summary", {}, title);
    details.addEventListener("toggle", () => { if (details.open) this.follow(); });
    return made(details, "div");
  }

  // Parameters and quantities of another machine, as the answer to "describe" has them.
  describe({ parameters, quantities }) {
    this.fields = new Map(parameters.map((field) => [field.path, field]));
    this.choice.describe(quantities);
    this.bars.describe(this.fields);
    this.uncertainties.describe(this.fields);
    this.search.describe(this.fields, quantities);
  }

  // Another machine is shown: numbers are grey until they belong to it.
  changed() {
    this.stops.splice(0).forEach((stop) => stop());
    this.stale(true);
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.follow(), DELAY);
  }

  // Nothing is shown that numbers could belong to.
  blank() {
    this.changed();
    clearTimeout(this.timer);
  }

  stale(wanted) {
    const answers = [this.extremes.table, this.figures.table, this.bars.root];
    for (const answer of answers) answer.classList.toggle("stale", wanted);
    if (wanted) for (const name of this.page.shown()) this.page.band(name, null);
  }

  isOpen(item) { return item.closest("details").open; }

  follow() {
    clearTimeout(this.timer);
    this.stops.splice(0).forEach((stop) => stop());
    const state = this.page.state();
    if (!state || !this.fields) return;
    const show = this.page.shown();
    if (this.isOpen(this.notes)) this.askNumbers(state, show);
    if (this.isOpen(this.bars.root)) this.askBars(state);
    if (this.isOpen(this.uncertainties.root)) this.askBands(state, show);
  }

  // Ask and collect the parts of the answer; `ondone(parts, problem)` after the last.
  collect(kind, fields, ondone) {
    const parts = [];
    this.stops.push(this.page.ask(kind, fields, (answer) => {
      if (answer.problem) ondone(parts, answer.problem);
      else if (answer.more) parts.push(answer);
      else ondone(parts, "");
    }));
  }

  askNumbers(state, show) {
    this.collect("ask", { state, reference: this.page.reference(), show }, (parts, problem) => {
      const [extremes, figures] = ["extremes", "figure"].map((kind) => parts.map((part) => part[kind]).filter(Boolean));
      this.notes.textContent = [...new Set([problem, ...extremes.flatMap(({ notes }) => notes),
        ...figures.map((figure) => figure.problem)])].filter(Boolean).join("\n");
      if (problem) return;
      this.extremes.show(extremes);
      this.figures.show(figures);
      for (const { table } of [this.extremes, this.figures]) table.classList.remove("stale");
    });
  }

  askBars(state) {
    this.collect("sensitivities", { state, output: this.choice.text }, ([found], problem) => {
      this.bars.show(found, problem);
      this.bars.root.classList.toggle("stale", Boolean(problem));
    });
  }

  askBands(state, show) {
    const { spreads, wanted } = this.uncertainties;
    if (!wanted && spreads) {
      for (const name of show) this.page.band(name, null);
      return;
    }
    this.collect("tolerances", { state, spreads, show: wanted ? show : [] }, ([first, ...parts], problem) => {
      const bands = parts.map(({ band }) => band);
      this.uncertainties.say(problem, bands.map(({ note }) => note));
      if (problem) return;
      this.uncertainties.show(first.spreads);
      for (const band of bands) this.page.band(band.name, band);
    });
  }
}
