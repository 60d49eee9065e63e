// Questions about the machine that is shown: its numbers, what to change, tolerance bands, a search for a better one.
import { made } from "./html.js";
import { Search } from "./search.js";
import { OutputChoice } from "./output.js";
import { SensitivityBars } from "./bars.js";
import { Uncertainties } from "./uncertainties.js";

const DELAY = 120; // ms without a change, until questions follow
const EXTREMES = { smallest: "smallest", largest: "largest", reference: "reference", ratio: "ratio", range: "range" };
const FIGURES = { value: "now", reference: "reference", ratio: "ratio" };

// A table of texts; below an extreme stands its crank angle.
class Numbers {
  constructor(parent, caption, columns) {
    this.columns = columns;
    this.table = made(made(parent, "div", { class: "wide" }), "table");
    made(this.table, "caption", {}, caption);
    const head = made(made(this.table, "thead"), "tr");
    for (const title of ["", ...Object.values(columns)]) made(head, "th", { scope: "col" }, title);
    this.body = made(this.table, "tbody");
  }

  show(rows) {
    this.body.replaceChildren();
    for (const row of rows) {
      const line = made(this.body, "tr");
      made(line, "th", { scope: "row" }, row.unit ? `${row.label} [${row.unit}]` : row.label);
      for (const name of Object.keys(this.columns)) {
        const cell = made(line, "td", { "data-column": name }, row[name]), at = row[`${name}_at`];
        if (at) made(cell, "small", {}, `at ${at}°`);
      }
    }
  }
}

export class Ask {
  // `explore`: the page, as explore.js describes it.
  constructor(parent, explore) {
    Object.assign(this, { root: parent, explore, timer: null, stops: [], banded: new Set() });
    const numbers = this.section("Numbers", true);
    this.extremes = new Numbers(numbers, "Extremes, and largest size in the reference", EXTREMES);
    this.figures = new Numbers(numbers, "Means and torque extrema", FIGURES);
    this.notes = made(numbers, "p", { class: "notes" });
    const change = this.section("What should I change?");
    this.choice = new OutputChoice(change, () => this.changed());
    this.bars = new SensitivityBars(change, (path) => explore.focus(path));
    this.uncertainties = new Uncertainties(this.section("Tolerances"), () => this.changed());
    this.search = new Search(this.section("Optimise"), explore);
    explore.onknown((answer) => this.describe(answer));
    explore.onshown(() => this.changed());
    explore.oncompared(() => this.changed());
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

  // Another machine is shown, or none: numbers are grey until they belong to it.
  changed() {
    this.drop();
    for (const answer of [this.extremes.table, this.figures.table, this.bars.root]) answer.classList.add("stale");
    this.notes.textContent = "";
    this.clearBands();
    this.timer = setTimeout(() => this.follow(), DELAY);
  }

  clearBands() {
    for (const name of this.banded) this.explore.band(name, null);
    this.banded.clear();
  }

  // Await no answers any more.
  drop() {
    clearTimeout(this.timer);
    this.stops.splice(0).forEach((stop) => stop());
  }

  follow() {
    this.drop();
    const { shown, names, reference } = this.explore, isOpen = (item) => item.closest("details").open;
    if (!shown || !this.fields) return;
    const { state } = shown, show = names.filter((name) => name in shown.quantities);
    if (isOpen(this.notes)) this.askNumbers({ state, show, reference: reference ? reference.state : null });
    if (isOpen(this.bars.root)) this.askBars(state);
    if (isOpen(this.uncertainties.root)) this.askBands(state, show);
  }

  // Ask and collect the parts of the answer; `ondone(parts, problem)` after the last.
  collect(kind, fields, ondone) {
    const parts = [];
    this.stops.push(this.explore.requests.ask(kind, fields, (answer) => {
      if (answer.problem) ondone(parts, answer.problem);
      else if (answer.more) parts.push(answer);
      else ondone(parts, "");
    }));
  }

  askNumbers(fields) {
    this.collect("ask", fields, (parts, problem) => {
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
    const { spreads, wanted } = this.uncertainties, { shown } = this.explore;
    if (!wanted) this.clearBands();
    if (!wanted && spreads) return;
    this.collect("tolerances", { state, spreads, show: wanted ? show : [] }, ([first, ...parts], problem) => {
      this.uncertainties.say(problem, parts.map(({ band }) => band.note));
      if (problem) return;
      this.uncertainties.show(first.spreads);
      for (const { band } of parts) {
        const { factor } = shown.quantities[band.name], scaled = (side) => side.map((value) => factor * value);
        this.explore.band(band.name, { x: shown.angle, low: scaled(band.low), high: scaled(band.high) });
        this.banded.add(band.name);
      }
    });
  }
}
