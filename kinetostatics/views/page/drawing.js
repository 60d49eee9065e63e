"use strict";
// A machine drawn at one crank angle: what was packed by `movement.py`, in pixels of its panel.
const SVG = "http://www.w3.org/2000/svg";
const PAD = 26, TALLEST = 560, TALLEST_BESIDE_WIDE = 300, HEAD = 9, TURN_RADIUS = 26, WIDEST_TURN = 290;

function unpacked(text, Kind) {
  const bytes = Uint8Array.from(atob(text), (sign) => sign.charCodeAt(0));
  return new Kind(bytes.buffer);
}

function element(name, parent, attributes = {}, text = "") {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text) made.textContent = text;
  parent.appendChild(made);
  return made;
}

const short = (value) => value.toFixed(2);

class Drawing {
  constructor(svg, data, row, forces) {
    Object.assign(this, { svg, data, row, forces, machine: data.drawings[row], count: data.counts[row] });
    const machine = this.machine;
    this.joints = Object.fromEntries(Object.entries(machine.joints).map(([name, text]) => [name, unpacked(text, Float32Array)]));
    this.masses = machine.masses.map((text) => unpacked(text, Float32Array));
    this.strokes = machine.strokes.map((stroke) => ({
      ...stroke,
      points: unpacked(stroke.points, Float32Array),
      poses: stroke.poses && unpacked(stroke.poses, Float32Array),
      shapes: stroke.shapes && unpacked(stroke.shapes, Float32Array),
    }));
    this.hidden = new Set();
    this.longer = 1;
    this.build();
  }

  // Scale and frame follow the width of the panel, so that letters and lines keep their size.
  build() {
    const [left, low, right, high] = this.machine.box;
    const tallest = this.svg.closest(".wide") ? TALLEST_BESIDE_WIDE : TALLEST;
    const width = Math.max(240, Math.round(this.svg.clientWidth || 480));
    const scale = Math.min((width - 2 * PAD) / (right - left || 1), (tallest - 2 * PAD) / (high - low || 1));
    const height = Math.max(150, Math.round(scale * (high - low) + 2 * PAD + 14));
    this.scale = scale;
    this.originX = width / 2 - (scale * (left + right)) / 2;
    this.originY = height / 2 - 7 + (scale * (low + high)) / 2;
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.svg.replaceChildren();
    this.paths = this.strokes.map((stroke) => this.stroke(stroke));
    this.pins = this.machine.moving.map(() => element("circle", this.svg, { class: "pin", r: 4 }));
    for (const name of this.machine.named) {
      if (!this.machine.moving.includes(name)) {
        const [x, y] = this.at(this.joints[name], 0);
        element("circle", this.svg, { class: "pin", r: 4, cx: x, cy: y });
      }
    }
    this.centres = this.masses.map(() => this.mass());
    this.turning = element("path", this.svg, { class: "turning" });
    this.arrows = Object.fromEntries(Object.keys(this.machine.arrows).map((name) => [name, this.arrow(name)]));
    this.names = this.machine.named.map(() => element("text", this.svg, { class: "name" }));
    this.rule(width, height);
    if (this.index !== undefined) this.show(this.index);
  }

  pixel(x, y) { return [this.originX + this.scale * x, this.originY - this.scale * y]; }

  at(places, row) { return this.pixel(places[2 * row], places[2 * row + 1]); }

  stroke(stroke) {
    const name = stroke.kind === "line" ? "line-load" : stroke.kind;
    return element("path", this.svg, { class: `${stroke.filled ? "" : "line "}${name}`, d: stroke.poses ? this.outline(stroke, true) : this.outline(stroke) });
  }

  outline(stroke, own = false, from = 0) {
    const points = stroke.shapes && !own ? stroke.shapes : stroke.points;
    const count = stroke.points.length;
    let text = "", pen = "M";
    for (let place = from; place < from + count; place += 2) {
      if (Number.isNaN(points[place])) { pen = "M"; continue; }
      const [x, y] = own ? [this.scale * points[place], -this.scale * points[place + 1]] : this.pixel(points[place], points[place + 1]);
      text += `${pen}${short(x)} ${short(y)}`;
      pen = "L";
    }
    return stroke.filled && text ? `${text}Z` : text;
  }

  mass() {
    const group = element("g", this.svg);
    element("circle", group, { class: "mass", r: 5.5 });
    element("path", group, { class: "mass-dark", d: "M0 0V-5.5A5.5 5.5 0 0 1 5.5 0ZM0 0V5.5A5.5 5.5 0 0 1 -5.5 0Z" });
    return group;
  }

  arrow(name) {
    const group = element("g", this.svg, { "data-reaction": name });
    return { group, path: element("path", group, { class: "arrow" }), text: element("text", group, { class: "force" }, name) };
  }

  // A force of a round size as long as its arrow.
  rule(width, height) {
    const { forceUnit } = this.data, scale = this.longer * this.machine.scale;
    if (!scale) return;
    const most = 0.28 * width / (scale * this.scale) * forceUnit.factor;
    const power = 10 ** Math.floor(Math.log10(most));
    const size = [5, 2, 1].map((step) => step * power).find((value) => value <= most);
    const length = size / forceUnit.factor * scale * this.scale;
    element("path", this.svg, { class: "rule", d: `M12 ${height - 15}v6m0 -3h${short(length)}m0 -3v6` });
    element("text", this.svg, { class: "scale", x: 18 + length, y: height - 8 }, `${+size.toPrecision(3)} ${forceUnit.unit}`);
  }

  show(index) {
    this.index = index;
    const row = index % this.count;
    this.strokes.forEach((stroke, number) => {
      if (stroke.poses) {
        const [x, y, angle] = stroke.poses.subarray(3 * row, 3 * row + 3);
        this.paths[number].setAttribute("transform", `translate(${short(this.originX + this.scale * x)} ${short(this.originY - this.scale * y)}) rotate(${(-180 / Math.PI * angle).toFixed(3)})`);
      } else if (stroke.shapes) {
        this.paths[number].setAttribute("d", this.outline(stroke, false, row * stroke.points.length));
      }
    });
    this.machine.moving.forEach((name, number) => {
      const [x, y] = this.at(this.joints[name], row);
      this.pins[number].setAttribute("cx", short(x));
      this.pins[number].setAttribute("cy", short(y));
    });
    this.masses.forEach((places, number) => {
      this.centres[number].setAttribute("transform", `translate(${this.at(places, row).map(short).join(" ")})`);
    });
    this.label(row);
    for (const [name, joint] of Object.entries(this.machine.arrows)) this.point(name, this.at(this.joints[joint], row), row);
    this.turn(row);
  }

  // Joints that coincide have one label.
  label(row) {
    const found = [];
    for (const name of this.machine.named) {
      const [x, y] = this.at(this.joints[name], row);
      const near = found.find((item) => Math.hypot(item.x - x, item.y - y) < 7);
      if (near) near.text += `, ${name}`; else found.push({ x, y, text: name, aside: this.machine.moving.includes(name) ? 8 : -10 - 7 * name.length });
    }
    this.names.forEach((text, number) => {
      const item = found[number];
      text.textContent = item ? item.text : "";
      if (item) { text.setAttribute("x", short(item.x + item.aside)); text.setAttribute("y", short(item.y - 8)); }
    });
  }

  point(name, [x, y], row) {
    const { group, path, text } = this.arrows[name];
    const [forceX, forceY] = this.forces(name, this.row, row);
    let [alongX, alongY] = [forceX, -forceY].map((part) => this.longer * this.machine.scale * this.scale * part);
    let length = Math.hypot(alongX, alongY);
    const longest = this.machine.longest * this.scale;
    if (length > longest) { [alongX, alongY] = [alongX / length * longest, alongY / length * longest]; length = longest; }
    const seen = length > 2.5 && Number.isFinite(length) && !this.hidden.has(name);
    group.setAttribute("visibility", seen ? "visible" : "hidden");
    if (!seen) return;
    const [unitX, unitY] = [alongX / length, alongY / length], head = Math.min(HEAD, 0.6 * length);
    const [tipX, tipY] = [x + alongX, y + alongY], [footX, footY] = [tipX - head * unitX, tipY - head * unitY];
    const half = 0.38 * head;
    path.setAttribute("d", `M${short(x)} ${short(y)}L${short(footX)} ${short(footY)}L${short(footX - half * unitY)} ${short(footY + half * unitX)}L${short(tipX)} ${short(tipY)}L${short(footX + half * unitY)} ${short(footY - half * unitX)}L${short(footX)} ${short(footY)}`);
    text.setAttribute("x", short(tipX + 7 * unitX + (unitX < -0.3 ? -6 * name.length : 2)));
    text.setAttribute("y", short(tipY + 9 * unitY + 4));
    text.setAttribute("visibility", length > 16 ? "inherit" : "hidden");
  }

  // The torque as an arc about the crank's axis, longer the larger it is.
  turn(row) {
    const share = this.data.torque ? this.torque(row) / this.data.torque : 0;
    const seen = Math.abs(share) > 0.01 && !this.hidden.has(" torque");
    this.turning.setAttribute("visibility", seen ? "visible" : "hidden");
    if (!seen) return;
    const [x, y] = this.at(this.joints[this.machine.centre], row), sense = Math.sign(share);
    const swept = Math.min(1, Math.abs(share)) * WIDEST_TURN * Math.PI / 180, start = -Math.PI / 2;
    const on = (angle, radius = TURN_RADIUS) => [short(x + radius * Math.cos(angle)), short(y - radius * Math.sin(angle))].join(" ");
    const end = start + sense * swept, back = end - sense * Math.min(0.32, swept);
    const sweep = sense > 0 ? 0 : 1;
    this.turning.setAttribute("d", `M${on(start)}A${TURN_RADIUS} ${TURN_RADIUS} 0 ${swept > Math.PI ? 1 : 0} ${sweep} ${on(end)}M${on(back, TURN_RADIUS - 5)}L${on(end)}L${on(back, TURN_RADIUS + 5)}`);
  }

  torque(row) { return this.forces("balancing_torque", this.row, row)[0]; }
}
