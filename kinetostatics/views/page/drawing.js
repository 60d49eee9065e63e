// One machine in one <svg>, at a chosen crank angle. Its data are those of `movement.py`, with typed arrays:
//   strokes [{kind, filled, points, poses?, shapes?}], joints {name: places}, moving and named joints, masses [places],
//   arrows {reaction: joint}, forces {reaction: vectors}, torque, centre (joint at which the torque is drawn), pose
//   (index of the crank angle, if it has one pose alone),
//   and its frame: box [left, low, right, high], scale (m per N), longest arrow, largest_torque, force_unit.
import { element, put, short } from "./svg.js";

const PAD = 26, HEAD = 9, TURN_RADIUS = 26, WIDEST_TURN = 290, FOOT = 14;
export const TORQUE = " torque"; // its name among the hidden arrows: no reaction begins with a blank

// Lines, pins and mass centres of a machine in a group.
class Machine {
  constructor(parent, name) {
    this.group = element("g", parent, { class: name });
    this.form = "";
  }

  // Elements stay while the structure is the same.
  update(data, view) {
    Object.assign(this, { data, view, count: data.torque.length });
    const strokes = data.strokes.map(({ kind, filled }) => [kind, filled]);
    const form = JSON.stringify([strokes, data.moving, data.named, data.masses.length]);
    if (form !== this.form) this.build();
    this.form = form;
    data.strokes.forEach((stroke, number) => {
      const path = this.paths[number];
      if (!stroke.shapes) path.setAttribute("d", this.outline(stroke, stroke.points, 0, Boolean(stroke.poses)));
      if (!stroke.poses) path.removeAttribute("transform");
    });
    this.fixed.forEach(({ pin, name }) => this.centre(pin, this.at(data.joints[name], 0)));
  }

  build() {
    const { data, group } = this;
    group.replaceChildren();
    this.paths = data.strokes.map(({ kind, filled }) => element("path", group, {
      class: `${filled ? "" : "line "}${kind === "line" ? "line-load" : kind}`,
    }));
    const pin = (name) => ({ name, pin: element("circle", group, { class: "pin", r: 4 }) });
    this.pins = data.moving.map(pin);
    this.fixed = data.named.filter((name) => !data.moving.includes(name)).map(pin);
    this.centres = data.masses.map(() => {
      const mass = element("g", group, { class: "centre" });
      element("circle", mass, { class: "mass", r: 5.5 });
      element("path", mass, { class: "mass-dark", d: "M0 0V-5.5A5.5 5.5 0 0 1 5.5 0ZM0 0V5.5A5.5 5.5 0 0 1 -5.5 0Z" });
      return mass;
    });
  }

  at(places, row) { return this.view.pixel(places[2 * row], places[2 * row + 1]); }

  centre(pin, [x, y]) { put(pin, { cx: short(x), cy: short(y) }); }

  // A line through points from a place on; `own` in the stroke's own axes.
  outline({ points, filled }, places, from, own) {
    const { scale, originX, originY } = this.view, end = from + points.length;
    let text = "", pen = "M";
    for (let place = from; place < end; place += 2) {
      const x = scale * places[place], y = -scale * places[place + 1];
      if (Number.isNaN(x)) { pen = "M"; continue; }
      text += own ? `${pen}${short(x)} ${short(y)}` : `${pen}${short(originX + x)} ${short(originY + y)}`;
      pen = "L";
    }
    return filled && text ? `${text}Z` : text;
  }

  show(row) {
    const { data, group } = this;
    const open = data.moving.some((name) => Number.isNaN(data.joints[name][2 * row]));
    group.setAttribute("visibility", open ? "hidden" : "visible");
    if (open) return;
    data.strokes.forEach((stroke, number) => {
      const { points, poses, shapes } = stroke, path = this.paths[number];
      if (poses) {
        const [x, y] = this.view.pixel(poses[3 * row], poses[3 * row + 1]);
        const angle = (-180 / Math.PI * poses[3 * row + 2]).toFixed(3);
        path.setAttribute("transform", `translate(${short(x)} ${short(y)}) rotate(${angle})`);
      } else if (shapes) {
        path.setAttribute("d", this.outline(stroke, shapes, row * points.length, false));
      }
    });
    this.pins.forEach(({ pin, name }) => this.centre(pin, this.at(data.joints[name], row)));
    this.centres.forEach((mass, number) => {
      mass.setAttribute("transform", `translate(${this.at(data.masses[number], row).map(short).join(" ")})`);
    });
  }
}

export class Drawing {
  // `tallest` limits the height, in pixels; `height` sets it.
  constructor(svg, { tallest = 560, height = 0 } = {}) {
    Object.assign(this, { svg, tallest, height, hidden: new Set(), longer: 1, index: 0, onview: () => {} });
    svg.classList.add("drawing");
    this.root = element("g", svg);
    this.other = new Machine(this.root, "reference");
    this.machine = new Machine(this.root, "machine");
    this.turning = element("path", this.root, { class: "turning" });
    this.pointers = element("g", this.root);
    this.names = element("g", this.root);
    this.rule = element("path", this.root, { class: "rule" });
    this.size = element("text", this.root, { class: "scale" });
    this.arrows = {};
    this.width = this.measured();
    new ResizeObserver(() => {
      if (this.measured() === this.width) return;
      this.width = this.measured();
      this.draw();
    }).observe(svg);
  }

  measured() { return Math.max(240, Math.round(this.svg.clientWidth || 480)); }

  // New numbers or another machine; the frame may be that of other data, so that it stays while a point is dragged.
  update(data, frame = data) {
    Object.assign(this, { data, frame });
    this.draw();
  }

  // A second machine as thin lines below the first, or null.
  reference(data) {
    this.otherData = data;
    this.draw();
  }

  // A ghost is pale and without forces: the last machine that could be assembled.
  ghost(wanted) { this.root.classList.toggle("ghost", wanted); }

  hide(name, wanted) {
    this.hidden[wanted ? "add" : "delete"](name);
    this.show(this.index);
  }

  lengthen(times) {
    this.longer = times;
    this.draw();
  }

  // Scale and place of the box; letters and lines keep their size.
  fit() {
    const [left, low, right, high] = this.frame.box, { width } = this;
    const most = this.height || this.tallest, room = [width - 2 * PAD, most - 2 * PAD - FOOT];
    const scale = Math.min(room[0] / (right - left || 1), room[1] / (high - low || 1));
    const height = this.height || Math.max(150, Math.round(scale * (high - low) + 2 * PAD + FOOT));
    const originX = width / 2 - scale * (left + right) / 2, originY = (height - FOOT) / 2 + scale * (low + high) / 2;
    if (this.scale === scale && this.originX === originX && this.originY === originY && this.tall === height) return;
    Object.assign(this, { scale, originX, originY, tall: height });
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.onview();
  }

  pixel(x, y) { return [this.originX + this.scale * x, this.originY - this.scale * y]; }

  metres(x, y) { return [(x - this.originX) / this.scale, (this.originY - y) / this.scale]; }

  draw() {
    if (!this.data) return;
    this.fit();
    this.machine.update(this.data, this);
    this.other.group.classList.toggle("absent", !this.otherData);
    if (this.otherData) this.other.update(this.otherData, this);
    const names = Object.keys(this.data.arrows);
    if (names.join("\n") !== Object.keys(this.arrows).join("\n")) {
      this.pointers.replaceChildren();
      this.arrows = Object.fromEntries(names.map((name) => [name, this.arrow(name)]));
    }
    this.measure();
    this.show(this.index);
  }

  arrow(name) {
    const group = element("g", this.pointers, { "data-reaction": name });
    const path = element("path", group, { class: "arrow" });
    return { group, path, text: element("text", group, { class: "force" }, name) };
  }

  // A force of a round size as long as its arrow.
  measure() {
    const { factor, unit } = this.frame.force_unit, pixels = this.longer * this.frame.scale * this.scale;
    const most = 0.28 * this.width / pixels * factor, power = 10 ** Math.floor(Math.log10(most));
    const size = [5, 2, 1].map((step) => step * power).find((value) => value <= most);
    const seen = pixels > 0 && Number.isFinite(size), length = seen ? size / factor * pixels : 0;
    put(this.rule, { d: seen ? `M12 ${this.tall - 15}v6m0 -3h${short(length)}m0 -3v6` : "" });
    put(this.size, { x: short(18 + length), y: this.tall - 8 });
    this.size.textContent = seen ? `${+size.toPrecision(3)} ${unit}` : "";
  }

  show(index) {
    this.index = index;
    if (!this.data) return;
    const row = index % this.machine.count;
    this.machine.show(row);
    if (this.otherData) this.other.show(index % this.other.count);
    this.label(row);
    for (const [name, joint] of Object.entries(this.data.arrows)) this.point(name, joint, row);
    this.turn(row);
  }

  // Joints that coincide have one label.
  label(row) {
    const found = [], { data, names } = this;
    for (const name of data.named) {
      const [x, y] = this.machine.at(data.joints[name], row);
      if (Number.isNaN(x)) continue;
      const near = found.find((item) => Math.hypot(item.x - x, item.y - y) < 7);
      const aside = data.moving.includes(name) ? 8 : -10 - 7 * name.length;
      if (near) near.text += `, ${name}`;
      else found.push({ x, y, text: name, aside });
    }
    while (names.childElementCount < found.length) element("text", names, { class: "name" });
    [...names.children].forEach((text, number) => {
      const item = found[number], wanted = item ? item.text : "";
      if (text.textContent !== wanted) text.textContent = wanted;
      if (item) put(text, { x: short(item.x + item.aside), y: short(item.y - 8) });
    });
  }

  point(name, joint, row) {
    const { group, path, text } = this.arrows[name], forces = this.data.forces[name];
    const [x, y] = this.machine.at(this.data.joints[joint], row), pixels = this.longer * this.frame.scale * this.scale;
    let [alongX, alongY] = [pixels * forces[2 * row], -pixels * forces[2 * row + 1]];
    let length = Math.hypot(alongX, alongY);
    const longest = this.frame.longest * this.scale;
    if (length > longest) {
      [alongX, alongY] = [alongX / length * longest, alongY / length * longest];
      length = longest;
    }
    const seen = length > 2.5 && Number.isFinite(alongX + alongY + x) && !this.hidden.has(name);
    group.setAttribute("visibility", seen ? "visible" : "hidden");
    if (!seen) return;
    const [unitX, unitY] = [alongX / length, alongY / length], head = Math.min(HEAD, 0.6 * length), half = 0.38 * head;
    const [tipX, tipY] = [x + alongX, y + alongY], [footX, footY] = [tipX - head * unitX, tipY - head * unitY];
    const corners = [[x, y], [footX, footY], [footX - half * unitY, footY + half * unitX], [tipX, tipY],
      [footX + half * unitY, footY - half * unitX], [footX, footY]];
    path.setAttribute("d", `M${corners.map(([cornerX, cornerY]) => `${short(cornerX)} ${short(cornerY)}`).join("L")}`);
    put(text, {
      x: short(tipX + 7 * unitX + (unitX < -0.3 ? -6 * name.length : 2)), y: short(tipY + 9 * unitY + 4),
      visibility: length > 16 ? "inherit" : "hidden",
    });
  }

  // The torque as an arc about the crank's axis, longer the larger it is.
  turn(row) {
    const { largest_torque: largest } = this.frame, share = largest ? this.data.torque[row] / largest : 0;
    const seen = Math.abs(share) > 0.01 && !this.hidden.has(TORQUE);
    this.turning.setAttribute("visibility", seen ? "visible" : "hidden");
    if (!seen) return;
    const [x, y] = this.machine.at(this.data.joints[this.data.centre], row), sense = Math.sign(share);
    const swept = Math.min(1, Math.abs(share)) * WIDEST_TURN * Math.PI / 180, start = -Math.PI / 2;
    const on = (angle, radius) => `${short(x + radius * Math.cos(angle))} ${short(y - radius * Math.sin(angle))}`;
    const end = start + sense * swept, back = end - sense * Math.min(0.32, swept), tip = on(end, TURN_RADIUS);
    const arc = `A${TURN_RADIUS} ${TURN_RADIUS} 0 ${swept > Math.PI ? 1 : 0} ${sense > 0 ? 0 : 1} ${tip}`;
    const head = `M${on(back, TURN_RADIUS - 5)}L${tip}L${on(back, TURN_RADIUS + 5)}`;
    this.turning.setAttribute("d", `M${on(start, TURN_RADIUS)}${arc}${head}`);
  }
}
