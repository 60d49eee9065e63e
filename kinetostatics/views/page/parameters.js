// A slider and a number field with unit for each parameter, in groups.
export class Parameters {
  // `onchange(path, value, still)`: a number in SI; `still` while the slider is under the hand.
  constructor(element, fields, onchange) {
    Object.assign(this, { element, onchange, rows: new Map() });
    element.replaceChildren();
    for (const field of fields) this.row(field);
  }

  row(field) {
    const row = document.createElement("label");
    const slider = document.createElement("input"), number = document.createElement("input");
    row.append(`${field.group}: ${field.label} `, slider, number, ` ${field.unit}`);
    slider.type = "range";
    number.type = "number";
    Object.assign(slider, { min: field.low * field.factor, max: field.high * field.factor, step: "any" });
    number.step = "any";
    slider.addEventListener("input", () => this.onchange(field.path, this.rounded(slider.value, field), true));
    slider.addEventListener("change", () => this.onchange(field.path, this.rounded(slider.value, field), false));
    number.addEventListener("change", () => this.onchange(field.path, Number(number.value) / field.factor, false));
    this.element.append(row);
    this.rows.set(field.path, { field, slider, number });
  }

  rounded(text, { factor, decimals }) { return Number(Number(text).toFixed(decimals)) / factor; }

  show(values) {
    for (const [path, { field, slider, number }] of this.rows) {
      if (!(path in values)) continue;
      slider.value = values[path] * field.factor;
      if (document.activeElement !== number) number.value = Number((values[path] * field.factor).toPrecision(10));
    }
  }
}
