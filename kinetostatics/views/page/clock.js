"use strict";
// The crank angle that is chosen, and all that follows it but the figures.
window.report = (() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const byId = (name) => document.getElementById(name);
  const count = Math.max(...data.counts);
  const found = {};

  // Values of a quantity of a machine, (parts, angles) in its display unit, or null.
  function values(name, row) {
    const key = `${name} ${row}`;
    if (!(key in found)) {
      const text = data.quantities[name].values[row];
      const all = text && unpacked(text, Float64Array);
      const length = data.counts[row];
      found[key] = all && Array.from({ length: all.length / length }, (_, part) => all.subarray(part * length, (part + 1) * length));
    }
    return found[key];
  }

  // Angles in degrees and values of a quantity of a machine over its period, with extremes, kinks and jumps between the angles to choose; or null.
  function curve(name, row) {
    const parts = values(name, row);
    if (!parts) return null;
    const more = unpacked(data.between[row], Float64Array), others = unpacked(data.quantities[name].between[row], Float64Array);
    const angle = [...Array.from(parts[0], (_, place) => place * data.step), ...more];
    const order = [...angle.keys()].sort((one, other) => angle[one] - angle[other]);
    const all = parts.map((part, place) => [...part, ...others.subarray(place * more.length, (place + 1) * more.length)]);
    return { angle: order.map((place) => angle[place]), parts: all.map((part) => order.map((place) => part[place])) };
  }

  // Values in SI at an angle.
  function atRow(name, machine, row) {
    const parts = values(name, machine), factor = data.quantities[name].factor;
    return parts ? parts.map((part) => part[row] / factor) : [NaN, NaN];
  }

  function shown(value, decimals) {
    if (Number.isNaN(value)) return "";
    if (!Number.isFinite(value)) return value > 0 ? "∞" : "-∞";
    if (Math.abs(value) >= 1e9) return value.toExponential(5);
    const text = value.toFixed(decimals);
    return Number(text) === 0 ? (0).toFixed(decimals) : text;
  }

  function reading(name, machine, row) {
    const parts = values(name, machine), { decimals, vector } = data.quantities[name];
    if (!parts) return "";
    if (!vector) return shown(parts[0][row], decimals);
    const size = Math.hypot(parts[0][row], parts[1][row]);
    const way = Math.atan2(parts[1][row], parts[0][row]) * 180 / Math.PI;
    return shown(size, decimals) + (size > 0 && Number.isFinite(size) ? ` ∠ ${shown(way, 1)}°` : "");
  }

  const drawings = [...document.querySelectorAll(".panel svg")].map((svg, row) => new Drawing(svg, data, row, atRow));
  const cells = [...document.querySelectorAll("td[data-quantity]")].map((cell) => ({ cell, name: cell.dataset.quantity, machine: Number(cell.dataset.row) }));
  const [slider, degrees, play, pace] = ["angle", "degrees", "play", "pace"].map(byId);
  const followers = [];
  let index = -1, running = false, place = 0, before = 0;

  function choose(wanted, follow = true) {
    const next = ((Math.round(wanted) % count) + count) % count;
    if (follow) place = next;
    if (next === index) return;
    index = next;
    const angle = index * data.step;
    slider.value = angle;
    if (document.activeElement !== degrees || running) degrees.value = angle;
    slider.setAttribute("aria-valuetext", `${angle} degrees`);
    byId("chosen").textContent = angle;
    drawings.forEach((drawing) => drawing.show(index));
    cells.forEach(({ cell, name, machine }) => { cell.textContent = reading(name, machine, index % data.counts[machine]); });
    followers.forEach((follower) => follower(index));
  }

  function step(time) {
    if (!running) return;
    const past = Math.min(0.1, (time - before) / 1000);
    before = time;
    place += data.way * past * 360 / data.step / Number(pace.value);
    choose(Math.floor(place), false);
    requestAnimationFrame(step);
  }

  function run(wanted) {
    running = wanted;
    play.textContent = running ? "❚❚" : "▶";
    play.setAttribute("aria-label", running ? "pause" : "play");
    if (running) { place = index; before = performance.now(); requestAnimationFrame(step); }
  }

  slider.max = (count - 1) * data.step;
  slider.step = data.step;
  degrees.max = slider.max;
  slider.addEventListener("input", () => { run(false); choose(slider.value / data.step); });
  degrees.addEventListener("input", () => { if (degrees.value !== "") { run(false); choose(degrees.value / data.step); } });
  play.addEventListener("click", () => run(!running));
  const STEPS = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 10, PageDown: -10 };
  document.addEventListener("keydown", (event) => {
    const kind = event.target.type || event.target.localName;
    const own = ["number", "select-one", "summary"].includes(kind) || event.ctrlKey || event.altKey || event.metaKey;
    if (own) return;
    const vertical = /Up|Down/.test(event.key) && kind !== "range"; // else these scroll the page
    if (event.key === " " && !["button", "checkbox"].includes(kind)) run(!running);
    else if (event.key in STEPS && !vertical) { run(false); choose(index + STEPS[event.key] * (event.shiftKey && /Left|Right/.test(event.key) ? 10 : 1)); }
    else if (event.key === "Home" && kind !== "text") { run(false); choose(0); }
    else return;
    event.preventDefault();
  });
  document.querySelectorAll("[data-arrow]").forEach((box) => box.addEventListener("change", () => {
    drawings.forEach((drawing) => {
      drawing.hidden[box.checked ? "delete" : "add"](box.dataset.arrow);
      drawing.show(index);
    });
  }));
  byId("longer").addEventListener("change", (event) => drawings.forEach((drawing) => {
    drawing.longer = Number(event.target.value);
    drawing.build();
  }));
  new ResizeObserver(() => drawings.forEach((drawing) => drawing.build())).observe(document.querySelector(".panels"));
  choose(data.start);
  document.documentElement.dataset.ready = Math.round(performance.now());
  return { data, values, curve, followers, drawings, get index() { return index; } };
})();
