// Choice of a number of a curve: a reduction and a quantity, as the text that searches and sensitivities take.
import { made } from "./html.js";

const REDUCTIONS = {
  largest_absolute: "largest size", largest: "largest", smallest: "smallest", range: "range", mean: "mean",
  mean_absolute: "mean size", rms: "root mean square", swing: "energy stored (swing)",
};

export class OutputChoice {
  constructor(parent, onchange) {
    this.line = made(parent, "p", { class: "output" });
    this.reduction = made(this.line, "select", { "aria-label": "which number" });
    for (const [name, title] of Object.entries(REDUCTIONS)) made(this.reduction, "option", { value: name }, title);
    this.line.append(" of ");
    this.quantity = made(this.line, "select", { "aria-label": "of which quantity" });
    for (const select of [this.reduction, this.quantity]) select.addEventListener("change", onchange);
  }

  // Quantities of another machine; the chosen one stays if the machine has it.
  describe(quantities) {
    const chosen = this.quantity.value;
    this.quantity.replaceChildren();
    for (const { name, label } of quantities) made(this.quantity, "option", { value: name }, label);
    if (quantities.some(({ name }) => name === chosen)) this.quantity.value = chosen;
  }

  get text() { return `${this.reduction.value} ${this.quantity.value}`; }
}
