// The page of a report: drawings, figures and values that follow the crank angle.
import { fromBase64, restored, shown } from "./arrays.js";
import { Chart } from "./chart.js";
import { Clock } from "./clock.js";
import { Drawing } from "./drawing.js";

const TALLEST_BESIDE_WIDE = 300;

// Arrays of equal length, of which a typed array holds one after another.
const parted = (all, length) => Array.from({ length: length ? all.length / length : 0 },
  (_, part) => all.subarray(part * length, (part + 1) * length));

class Report {
  constructor(root) {
    const all = (selector) => [...root.querySelectorAll(selector)];
    const json = (name) => JSON.parse(root.querySelector(`script.${name}`).textContent);
    this.data = restored(json("data"), fromBase64(json("arrays")));
    const { counts, step, sense, start } = this.data;
    Object.assign(this, { root, all, hidden: new Set(), period: Math.max(...counts) * step });
    for (const item of Object.values(this.data.quantities)) {
      item.parts = item.values.map((values, row) => values && parted(values, counts[row]));
    }
    this.sorted = counts.map((_, row) => this.angles(row));
    this.cells = all("td[data-quantity]");
    this.drawings = all(".panel svg").map((svg, row) => this.drawing(svg, row));
    this.charts = Object.fromEntries(all("[data-figure]").map((place) => [place.dataset.figure, this.chart(place)]));
    this.choices();
    this.clock = new Clock(root, { count: Math.max(...counts), step, sense });
    this.clock.turnTo(start);
    this.clock.follow((index) => this.show(index));
    this.clock.keys(root);
    const choose = (degrees) => this.clock.choose(degrees / step);
    for (const chart of Object.values(this.charts)) chart.onchoose = choose;
    window.addEventListener("beforeprint", () => {
      for (const part of all("details[data-printed]")) part.open = true;
    });
    document.documentElement.dataset.ready = Math.round(performance.now());
  }

  drawing(svg, row) {
    const drawing = new Drawing(svg, svg.closest(".wide") ? { tallest: TALLEST_BESIDE_WIDE } : {});
    drawing.update(this.data.drawings[row]);
    return drawing;
  }

  chart(place) {
    const item = this.data.figures[place.dataset.figure], { plane = false, height } = item;
    const chart = new Chart(place, { plane, height, period: this.period });
    this.fill(chart, item);
    return chart;
  }

  // Degrees of a machine over its period, with those of extremes, kinks and jumps between its angles, and their order.
  angles(row) {
    const degrees = Array.from({ length: this.data.counts[row] }, (_, place) => place * this.data.step);
    degrees.push(...this.data.between[row]);
    const order = [...degrees.keys()].sort((one, other) => degrees[one] - degrees[other]);
    return { order, degrees: order.map((place) => degrees[place]) };
  }

  // A quantity of a machine at these angles, or null.
  curve(name, row) {
    const { between, quantities } = this.data, parts = quantities[name].parts[row];
    if (!parts) return null;
    const { degrees, order } = this.sorted[row], others = parted(quantities[name].between[row], between[row].length);
    const all = parts.map((part, place) => [...part, ...(others[place] || [])]);
    return { angle: degrees, parts: all.map((part) => order.map((place) => part[place])) };
  }

  // Curves of all machines that are not hidden, of a quantity or of what the figure holds itself.
  fill(chart, { quantity, curves, label, unit }) {
    const { drawings, counts, step, colours, dashes, quantities } = this.data, item = quantity && quantities[quantity];
    const found = drawings.map(({ name }, row) => {
      const curve = quantity ? this.points(chart, quantity, row) : curves[row];
      const style = { colour: colours[row % colours.length], dash: dashes[row % dashes.length] };
      return curve && !this.hidden.has(row) && { name, period: counts[row] * step, ...style, ...curve };
    });
    const size = item && item.vector && !chart.plane;
    chart.shown = { quantity, curves, label, unit };
    chart.set(found.filter(Boolean), item
      ? { label: size ? `|${item.label}|` : item.label, unit: item.unit, sight: item.sight } : { label, unit });
  }

  points(chart, quantity, row) {
    const curve = this.curve(quantity, row);
    if (!curve) return null;
    const { angle, parts: [x, y] } = curve;
    if (chart.plane) return { x, y, angle };
    return { x: angle, y: y ? x.map((part, place) => Math.hypot(part, y[place])) : x };
  }

  choices() {
    for (const key of this.all("[data-machine]")) {
      key.addEventListener("click", () => this.appear(Number(key.dataset.machine)));
    }
    for (const box of this.all("select[data-chooses]")) {
      const chart = this.charts[box.dataset.chooses], choose = () => this.fill(chart, { quantity: box.value });
      box.addEventListener("change", choose);
      choose(); // a browser may keep what was chosen before
    }
    for (const box of this.all("[data-arrow]")) {
      const hide = (drawing) => drawing.hide(box.dataset.arrow, !box.checked);
      box.addEventListener("change", () => this.drawings.forEach(hide));
    }
    const longer = this.root.querySelector(".longer");
    longer.addEventListener("change", () => this.drawings.forEach((drawing) => drawing.lengthen(Number(longer.value))));
  }

  // Hide a machine in all figures, or show it again.
  appear(row) {
    const wanted = this.hidden.has(row);
    this.hidden[wanted ? "delete" : "add"](row);
    for (const key of this.all(`[data-machine="${row}"]`)) key.setAttribute("aria-pressed", wanted);
    for (const chart of Object.values(this.charts)) this.fill(chart, chart.shown);
  }

  reading({ quantity, row }, chosen) {
    const { decimals, vector, parts: { [row]: parts } } = this.data.quantities[quantity];
    const index = chosen % this.data.counts[row];
    if (!parts) return "";
    if (!vector) return shown(parts[0][index], decimals);
    const [x, y] = parts.map((part) => part[index]), size = Math.hypot(x, y), direction = Math.atan2(y, x) * 180 / Math.PI;
    return shown(size, decimals) + (size > 0 && Number.isFinite(size) ? ` ∠ ${shown(direction, 1)}°` : "");
  }

  show(index) {
    const degrees = index * this.data.step;
    this.root.querySelector(".chosen").textContent = degrees;
    for (const drawing of this.drawings) drawing.show(index);
    for (const cell of this.cells) cell.textContent = this.reading(cell.dataset, index);
    for (const chart of Object.values(this.charts)) chart.cursor(degrees);
  }
}

document.body.report = new Report(document.body);
