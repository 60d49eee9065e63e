// Bars of sensitivities: change of a number in percent for one percent of each parameter, the largest first.
import { button, made } from "./html.js";
import { element } from "./svg.js";

const SHOWN = 12, LEAST = 1e-3; // bars at first; share of the largest below which a bar is no use
const WIDE = 100, HIGH = 12; // of a bar's drawing; 0 is in the middle

const named = (field, path) => (field ? `${field.group}: ${field.label}` : path);

const percent = (share) => `${share > 0 ? "+" : "−"}${Math.abs(Number(share.toPrecision(3)))} %`;

export class SensitivityBars {
  constructor(parent, onchoose) {
    Object.assign(this, { onchoose, all: false, fields: new Map() });
    this.root = made(parent, "div", { class: "bars" });
    this.head = made(this.root, "p", { role: "status" });
    this.list = made(this.root, "ul");
    this.more = button(this.root, "", () => { this.all = !this.all; this.draw(); });
    const zero = made(this.root, "details", { class: "zero" });
    made(zero, "summary", {}, "Parameters that are zero now");
    this.zeros = made(zero, "ul");
  }

  describe(fields) { this.fields = fields; }

  show(found, problem) {
    this.found = problem ? null : found;
    const now = problem ? "" : `Now ${found.value} ${found.unit}.`;
    this.head.textContent = problem || `${now} One percent more of a parameter changes it by:`;
    this.draw();
  }

  draw() {
    const { found } = this, rows = found ? found.rows : [];
    const ranked = rows.filter(({ share }) => share !== null), most = Math.abs(ranked[0]?.share ?? 0);
    const useful = ranked.filter(({ share }) => most && Math.abs(share) > LEAST * most);
    this.list.replaceChildren();
    for (const row of this.all ? useful : useful.slice(0, SHOWN)) this.bar(row, row.share / most);
    this.more.hidden = useful.length <= SHOWN;
    this.more.textContent = this.all ? "Fewer" : `All ${useful.length}`;
    this.zeros.replaceChildren();
    for (const row of rows) {
      if (row.share === null && !row.slope.startsWith("0 ")) this.entry(this.zeros, row, row.slope);
    }
  }

  // A parameter as a button that leads to its slider.
  entry(list, { path }, text) {
    const words = { "data-path": path, title: "Go to its slider" };
    const found = button(made(list, "li"), "", () => this.onchoose(path), words);
    made(found, "span", { class: "name" }, named(this.fields.get(path), path));
    made(found, "span", { class: "amount" }, text);
    return found;
  }

  // Full to the right of the middle for more, hollow to the left for less.
  bar(row, length) {
    const found = this.entry(this.list, row, percent(row.share)), size = Math.abs(length) * WIDE / 2;
    found.title = `${row.slope}. Go to its slider`;
    const svg = element("svg", found, { viewBox: `0 0 ${WIDE} ${HIGH}`, "aria-hidden": "true" });
    svg.setAttribute("preserveAspectRatio", "none");
    element("rect", svg, {
      x: length > 0 ? WIDE / 2 : WIDE / 2 - size, y: 2, width: size, height: HIGH - 4,
      class: length > 0 ? "more" : "less",
    });
    element("path", svg, { d: `M${WIDE / 2} 0V${HIGH}` });
    found.insertBefore(svg, found.children[1]);
  }
}
