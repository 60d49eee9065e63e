"use strict";
// Bokeh's figures: put in their places, their cursors led by the crank angle, other quantities shown when chosen.
(() => {
  const items = JSON.parse(document.getElementById("plots").textContent);
  const { data } = report;
  const period = Math.max(...data.counts) * data.step;
  const figures = {}, seen = new Set(), hidden = new Set();
  const vector = document.getElementById("hodograph"), other = document.getElementById("explore");
  const model = (name) => figures[name] && figures[name].model;
  const renderer = (name, wanted) => model(name).renderers.find((item) => item.name === wanted);
  const closed = (values) => [...values, values[0]];
  const named = (row, length) => Array(length).fill(data.drawings[row].name);
  const title = (item, text) => `${text} [${item.unit || "1"}]`;

  async function draw(place) {
    const name = place.dataset.figure;
    if (name in figures) return;
    figures[name] = null;
    const manager = await Bokeh.embed.embed_item(items[name], place.id);
    const [view] = manager.roots;
    if (matchMedia("(pointer: coarse)").matches) view.model.toolbar.tools.forEach((tool) => { tool.active = false; }); // a finger scrolls
    figures[name] = { view, place, model: view.model, cursor: view.model.center.find((item) => item.name === "cursor") };
    hidden.forEach((row) => appear(figures[name], row, false));
    if (name === "hodograph") chooseVector();
    if (name === "explore") chooseQuantity();
    follow(report.index);
  }

  // Figures in sight are drawn first and follow the crank as it turns; others when there is time.
  const places = [...document.querySelectorAll("[data-figure]")];
  const watch = new IntersectionObserver((entries) => entries.forEach(({ isIntersecting, target }) => {
    seen[isIntersecting ? "add" : "delete"](target);
    if (isIntersecting) draw(target).then(() => follow(report.index));
  }), { rootMargin: "200px" });
  places.forEach((place) => watch.observe(place));
  const spare = window.requestIdleCallback || ((work) => setTimeout(work, 50));
  async function rest() {
    const next = places.find((place) => !(place.dataset.figure in figures));
    if (!next) { document.documentElement.dataset.figures = Math.round(performance.now()); return; }
    await draw(next);
    spare(rest);
  }
  spare(rest);

  function follow(index) {
    for (const [name, figure] of Object.entries(figures)) {
      if (!figure || !seen.has(figure.place)) continue;
      if (figure.cursor) figure.cursor.location = index * data.step;
      tips(name, index);
    }
  }

  // Points of a hodograph; that of a chosen vector has a name of its own, others that of their quantity.
  function tips(name, index) {
    data.counts.forEach((count, row) => {
      const tip = renderer(name, `tip ${row}`);
      if (!tip) return;
      const parts = report.values(name === "hodograph" ? vector.value : name, row);
      tip.data_source.data = parts ? { x: [parts[0][index % count]], y: [parts[1][index % count]] } : { x: [], y: [] };
    });
  }

  // What grows without bound is left out, so that all else can be seen.
  const inSight = ({ sight }, size) => sight === null || size <= sight;

  function chooseVector() {
    if (!model("hodograph")) return; // it is drawn as chosen
    const item = data.quantities[vector.value];
    data.counts.forEach((_, row) => {
      const line = renderer("hodograph", `line ${row}`), curve = report.curve(vector.value, row);
      const seen = curve && curve.parts[0].map((x, place) => inSight(item, Math.hypot(x, curve.parts[1][place])));
      const [x, y] = curve ? curve.parts.map((part) => closed(part.map((value, place) => seen[place] ? value : NaN))) : [[], []];
      line.data_source.data = { angle: curve ? closed(curve.angle) : [], x, y, variant: named(row, x.length) };
    });
    [model("hodograph").below[0], model("hodograph").left[0]].forEach((axis, place) => {
      axis.axis_label.text = title(item, `${item.label}, ${"xy"[place]}`);
    });
    tips("hodograph", report.index);
  }

  function chooseQuantity() {
    if (!model("explore")) return;
    const item = data.quantities[other.value];
    data.counts.forEach((count, row) => {
      const curve = report.curve(other.value, row), angle = [], value = [];
      if (curve) {
        const sizes = curve.parts.length > 1 ? curve.parts[0].map((x, place) => Math.hypot(x, curve.parts[1][place])) : curve.parts[0];
        const shown = sizes.map((size) => inSight(item, Math.abs(size)) ? size : NaN);
        for (let start = 0; start < period; start += count * data.step) {
          angle.push(...curve.angle.map((own) => start + own));
          value.push(...shown);
        }
        angle.push(period);
        value.push(shown[0]);
      }
      renderer("explore", `line ${row}`).data_source.data = { angle, value, variant: named(row, angle.length) };
    });
    model("explore").left[0].axis_label.text = title(item, item.vector ? `|${item.label}|` : item.label);
  }

  function appear(figure, row, wanted) {
    for (const item of figure.model.renderers) if ([`line ${row}`, `tip ${row}`].includes(item.name)) item.visible = wanted;
  }

  document.querySelectorAll("[data-machine]").forEach((key) => key.addEventListener("click", () => {
    const row = Number(key.dataset.machine), wanted = hidden.has(row);
    hidden[wanted ? "delete" : "add"](row);
    document.querySelectorAll(`[data-machine="${row}"]`).forEach((other) => other.setAttribute("aria-pressed", wanted));
    Object.values(figures).forEach((figure) => figure && appear(figure, row, wanted));
  }));
  if (vector) vector.addEventListener("change", chooseVector);
  other.addEventListener("change", chooseQuantity);
  report.followers.push(follow);

  // On paper figures stand as drawings of lines, as wide as their place there, and the case file stands open.
  window.addEventListener("beforeprint", () => {
    document.querySelectorAll("details[data-printed]").forEach((part) => { part.open = true; });
    for (const figure of Object.values(figures).filter(Boolean)) {
      if (figure.cursor) figure.cursor.location = report.index * data.step;
      const drawn = figure.view.export("svg", false).canvas;
      const [width, height] = ["width", "height"].map((name) => parseFloat(drawn.getAttribute(name)));
      const parent = figure.place.parentElement;
      const printed = parent.querySelector(".printed") || parent.appendChild(document.createElement("div"));
      printed.className = "printed";
      printed.replaceChildren(drawn);
      drawn.setAttribute("viewBox", `0 0 ${width} ${height}`);
      ["width", "height"].forEach((name) => drawn.removeAttribute(name));
    }
  });
  Object.assign(report, { figures });
})();
