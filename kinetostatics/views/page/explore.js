// The explore page: the mechanism, its forces and its numbers, all of one state; in a page or in a notebook.
//
// For the parts of the page that other modules build, `explore` has:
//   requests, clock, drawing  the requests to the library, the chosen crank angle, the drawing
//   state     the state that is asked for: {variant, values, ...}
//   compared  the state of the reference
//   known     the last answer to "describe": {parameters, quantities, drive}; null before
//   shown     the last answer to a look, with its own `state`; null while that state cannot be assembled
//   names     names of the quantities that are shown
//   change(state, still)  show another state; `still` while a hand moves something: one step of undo for all of it
//   drag(fields, still)   the same by a request "drag", whose answer has the new state
//   focus(path), band(name, area)  bring a parameter into view; a tolerance band in a chart, or null
//   onknown(f), onchanged(f), onshown(f), oncompared(f)  call f(answer or state): after each description, change,
//             answer to a look, answer to a look of the reference
import { Ask } from "./ask.js";
import { Requests } from "./connection.js";
import { Curves } from "./curves.js";
import { Handles } from "./handles.js";
import { Groups } from "./groups.js";
import { History, keyOf, parsed } from "./history.js";
import { button, checkbox, made } from "./html.js";
import { Keep } from "./keep.js";
import { Mechanism } from "./mechanism.js";
import { Parameters } from "./parameters.js";

const COUNT = 360; // crank angles of a period
const FIRST_CURVES = 3;
const REST = 150; // ms without a change, until the motor's speed is asked for
const REMEMBER = 300; // ms between a change and its place in the address
const LONG_NOTE = 90; // characters of a note that stands open

export class Explore {
  // `transport` sends requests; `address` keeps what is shown, {read(), write(fields)}, all texts.
  constructor(root, transport, address) {
    Object.assign(this, { root, address, known: null, shown: null, last: null, reference: null, frozen: null, answered: null });
    Object.assign(this, { moving: false, ready: false, described: null, presented: 0, kept: new Map(), timer: null });
    this.listeners = { known: [], changed: [], shown: [], compared: [] };
    this.requests = new Requests(transport);
    this.requests.onlook = (answer, asked) => this.receive(answer, asked);
    this.requests.onlost = (reason) => this.lost(reason);
    root.explore = this;
    this.build();
    const { token, state, show } = address.read();
    this.requests.ask("open", { token, address: { state, show } }, (answer) => this.open(answer));
  }

  onknown(listener) { this.listeners.known.push(listener); }

  onchanged(listener) { this.listeners.changed.push(listener); }

  onshown(listener) { this.listeners.shown.push(listener); }

  oncompared(listener) { this.listeners.compared.push(listener); }

  notify(kind, item) { this.listeners[kind].forEach((listener) => listener(item)); }

  get state() { return this.history?.now; }

  get names() { return this.curves.names; }

  get clock() { return this.mechanism.clock; }

  get drawing() { return this.mechanism.drawing; }

  // Does all that is shown belong to the state that is asked for, and to its reference?
  get settled() {
    if (!this.known || this.moving || this.requests.busy) return false;
    const { answered, reference } = this, same = (answer, state) => keyOf(answer.state) === keyOf(state);
    return Boolean(answered) && same(answered, this.state) && (!reference || same(reference, this.compared));
  }

  get compared() {
    const own = this.variants.find(({ name }) => name === this.state.variant);
    return this.frozen ? this.frozen.state : { variant: own ? own.reference : this.state.variant, values: {} };
  }

  build() {
    this.root.replaceChildren();
    this.sheet = made(this.root, "div", { class: "sheet" });
    const head = made(this.sheet, "header");
    this.title = made(head, "h1");
    const tools = made(head, "div", { class: "tools" });
    this.undo = button(tools, "↶ Undo", () => this.move(-1), { title: "Ctrl+Z" });
    this.redo = button(tools, "↷ Redo", () => this.move(1), { title: "Ctrl+Shift+Z" });
    this.freeze = button(tools, "Compare with now", () => this.compare(true));
    this.thaw = button(tools, "Compare with", () => this.compare(false));
    this.both = checkbox(tools, "reference in the drawing", false, () => this.redraw());
    this.tabs = made(head, "div", { class: "tabs", role: "tablist", "aria-label": "variants" });
    this.keeping = made(head, "div", { class: "keep" });
    this.problem = made(this.sheet, "p", { class: "problem", role: "alert", hidden: "" });
    this.notes = made(this.sheet, "div", { class: "notes", role: "status" });
    const body = made(this.sheet, "div", { class: "body" });
    this.left = made(body, "section", { class: "machine", "aria-label": "mechanism" });
    this.mechanism = new Mechanism(this.left, (index) => this.follow(index));
    this.handles = new Handles(this.drawing, {
      ondrag: (wanted) => this.drag(wanted), ondrop: (wanted) => this.drag(wanted, false),
    });
    this.asking = made(body, "section", { class: "ask", "aria-label": "questions" });
    const figures = made(body, "section", { class: "curves", "aria-label": "curves" });
    this.curves = new Curves(figures, {
      onchosen: () => this.lookAnew(), onchoose: (degrees) => this.clock.choose(degrees / this.clock.step),
    });
    this.clock.keys(figures);
    const side = made(body, "section", { class: "numbers", "aria-label": "parameters" });
    this.grouping = made(side, "div", { class: "groups" });
    this.parameters = new Parameters(side, (path, value, still) => this.set(path, value, still));
    this.questions = new Ask(this.asking, this);
    this.root.addEventListener("keydown", (event) => this.press(event));
  }

  // Ctrl+Z and its like, but in texts that are typed.
  press(event) {
    const target = event.composedPath()[0], { key: letter } = event;
    if (!(event.ctrlKey || event.metaKey) || event.altKey || /^(text|search|textarea)$/.test(target.type)) return;
    const steps = { z: event.shiftKey ? 1 : -1, y: 1 }[letter.toLowerCase()];
    if (!steps) return;
    event.preventDefault();
    this.move(steps);
  }

  open(answer) {
    if (answer.problem) { this.say(answer.problem); return; }
    const kept = this.address.read();
    const frozen = parsed(kept.compared), planes = parsed(kept.planes);
    Object.assign(this, { opened: answer, variants: answer.variants, at: Number(kept.angle) || 0 });
    if (typeof frozen?.label === "string" && frozen.state) this.frozen = frozen;
    if (answer.token) this.address.write({ token: answer.token });
    this.title.textContent = answer.title;
    this.keeper = new Keep(this.keeping, this, answer.file);
    for (const { name } of answer.variants) this.tab(name);
    if (answer.start.chain) this.groups = new Groups(this.grouping, this);
    this.history = new History(this.whole(answer.start));
    this.curves.chosen = answer.show; // null: the first curves of the machine
    if (Array.isArray(planes)) this.curves.planes = new Set(planes);
    this.present();
  }

  // Tabs of the variants: each keeps its own numbers.
  tab(name) {
    const tab = button(this.tabs, name, () => this.turnTo(name), { role: "tab", "aria-selected": "false" });
    tab.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (!step) return;
      const all = [...this.tabs.children], next = all[(all.indexOf(tab) + step + all.length) % all.length];
      next.focus();
      next.click();
      event.preventDefault();
    });
  }

  turnTo(variant) {
    if (variant !== this.state.variant) this.change(this.kept.get(variant) ?? { variant, values: {} });
  }

  // A parameter's number, SI; null: that of the variant.
  set(path, value, still) {
    const { [path]: before, ...values } = this.state.values;
    const own = this.known.parameters.find((field) => field.path === path)?.value;
    if (value !== null && value !== own) values[path] = value;
    this.change({ ...this.state, values }, still);
  }

  // A state as an address or a notebook may give it, with all its keys.
  whole(state) { return { variant: this.state?.variant ?? this.variants[0].name, ...state, values: state.values ?? {} }; }

  change(state, still = false) {
    this.opened.notes = []; // on the address
    this.record(this.whole(state), still);
    this.present();
  }

  // A movement begins with the first state that differs: it must not replace the state before it.
  record(state, still) {
    const kept = this.history.keep(state, this.moving);
    this.moving = still && (kept || this.moving);
  }

  drag(fields, still = true) {
    this.clock.run(false);
    const { state, names: show, presented } = this;
    this.requests.look("drag", { state, show, count: COUNT, ...fields, still, presented });
  }

  move(steps) {
    this.moving = false;
    if (this.history?.move(steps)) this.present();
  }

  // Show the present state: describe it first if it is of another structure.
  present() {
    this.presented += 1;
    this.handles.dropped = null;
    const { state } = this, structure = keyOf({ ...state, values: {} });
    this.kept.set(state.variant, state);
    this.remember();
    this.notify("changed", state);
    this.asked = structure;
    if (structure === this.described) this.look(); else this.describe(structure);
  }

  describe(structure) {
    this.requests.ask("describe", { state: { ...this.state, values: {} } }, (answer) => {
      if (structure !== this.asked) return;
      if (answer.problem) { this.refuse(answer); return; }
      Object.assign(this, { described: structure, known: answer, shown: null });
      this.curves.chosen ??= firstCurves(answer.quantities);
      this.curves.offer(answer.quantities, answer.drive);
      this.parameters.describe(answer.parameters);
      this.handles.describe(answer.parameters);
      for (const tab of this.tabs.children) {
        const chosen = tab.textContent === this.state.variant;
        tab.setAttribute("aria-selected", chosen);
        tab.tabIndex = chosen ? 0 : -1;
      }
      this.notify("known", answer);
      this.look();
      this.askReference();
    });
  }

  look() { this.requests.look("look", { state: this.state, show: this.names, count: COUNT }); }

  // Other quantities, of the machine and of the reference.
  lookAnew() {
    this.remember();
    this.askReference();
    this.look();
  }

  // The reference is the state shown now, or that of the variant.
  compare(now) {
    const time = new Date().toTimeString().slice(0, 5);
    this.frozen = now ? { state: this.state, label: `${this.state.variant} at ${time}` } : null;
    this.lookAnew();
  }

  askReference() {
    const { compared: state, frozen } = this, label = frozen ? frozen.label : state.variant;
    this.forgetReference?.();
    this.thaw.textContent = `Compare with ${frozen ? this.ownReference() : label}`;
    this.thaw.disabled = !frozen;
    this.forgetReference = this.requests.ask("look", { state, show: this.names, count: COUNT }, (answer) => {
      this.reference = answer.problem ? null : { ...answer, label };
      this.redraw();
      this.notify("compared", answer);
    });
  }

  // The motor's speed, once the hand rests.
  askRunning() {
    clearTimeout(this.rest);
    this.forgetRunning?.();
    if (!this.curves.running) return;
    this.rest = setTimeout(() => {
      const found = {}, { state, compared: reference } = this;
      this.forgetRunning = this.requests.ask("running", { state, reference }, (answer) => {
        if (answer.more) { found[answer.running] = answer; return; }
        this.curves.run(found.state, found.reference, found.state ? "" : answer.problem);
        this.follow(this.clock.index);
      });
    }, REST);
  }

  ownReference() { return this.variants.find(({ name }) => name === this.state.variant)?.reference ?? ""; }

  receive(answer, asked) {
    if (answer.kind === "drag" && !asked.still) this.handles.dropped = null;
    if (answer.kind === "drag" && !this.follows(answer, asked)) return;
    if (keyOf({ ...answer.state, values: {} }) !== this.described) return; // of the tab before
    this.answered = answer;
    if (answer.problem) { this.refuse(answer); return; }
    const first = !this.ready;
    this.askRunning();
    Object.assign(this, { shown: answer, ready: true });
    this.say("");
    this.note([...this.opened.notes, ...answer.notes]);
    this.redraw();
    if (first) this.clock.choose(this.at / this.clock.step);
    this.root.dataset.shown = answer.id;
    this.notify("shown", answer);
  }

  // Take the state of a drag. Whether the answer is to be shown: not if another state was chosen meanwhile, nor if
  // the point is dropped where its numbers are impossible; then the machine before is asked for again.
  follows(answer, { state: before, still, presented }) {
    if (presented !== this.presented) return false;
    const impossible = answer.problem && keyOf(answer.state) === keyOf(before);
    const state = impossible ? this.state : answer.state;
    this.record(state, still);
    this.kept.set(state.variant, state);
    this.remember();
    this.notify("changed", state);
    if (impossible && !still) this.look();
    return still || !impossible;
  }

  // A state without numbers: the last machine stays as a ghost.
  refuse(answer) {
    this.last = this.shown ?? this.last;
    this.shown = null;
    this.say(answer.problem);
    this.note([]);
    this.mechanism.ghost();
    if (this.last?.drawing.pose !== undefined && !this.moving) this.askGhost();
    this.curves.stale();
    if (this.known) this.showFields(this.state);
    this.root.dataset.shown = answer.id;
    this.notify("shown", answer);
  }

  // All poses of the ghost, if it has one alone.
  askGhost() {
    this.requests.ask("look", { state: this.last.state, show: [], count: COUNT }, (answer) => {
      if (!this.shown && !answer.problem) this.mechanism.ghost(answer);
    });
  }

  showFields(state) {
    const own = Object.fromEntries(this.known.parameters.map(({ path, value }) => [path, value]));
    const values = { ...own, ...state.values };
    this.parameters.show(values);
    this.handles.setValues(values);
  }

  redraw() {
    const { shown, reference } = this;
    if (!shown) return;
    this.parameters.show(shown.values);
    this.mechanism.show(shown, this.both.checked ? reference : null, this.moving);
    this.handles.update(shown.handles, shown.values, shown.snap);
    this.curves.show(shown, reference);
    this.follow(this.clock.index);
  }

  follow(index) {
    this.handles?.show(index);
    if (!this.shown) return;
    this.curves.follow(this.shown.angle[index % this.shown.angle.length]);
    // drawn in another pose alone; a request under way brings this call again, and must not be replaced
    if ((this.shown.drawing.pose ?? index) !== index && !this.requests.busy) this.look();
    if (!this.clock.running) this.remember();
  }

  focus(path) { this.parameters.focus(path); }

  band(name, area) { this.curves.band(name, area); }

  // The address reopens what is shown.
  remember() {
    this.undo.disabled = this.history.first;
    this.redo.disabled = this.history.last;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.address.write({
      state: JSON.stringify(this.state), show: JSON.stringify(this.curves.chosen),
      planes: JSON.stringify([...this.curves.planes]),
      angle: String(this.clock.degrees), compared: JSON.stringify(this.frozen),
    }), REMEMBER);
  }

  say(text) {
    this.problem.textContent = text;
    this.problem.hidden = !text;
  }

  // Hints of the library; long ones are folded.
  note(texts) {
    const joined = texts.join("\n");
    if (joined === this.noted) return;
    this.noted = joined;
    this.notes.replaceChildren();
    for (const text of texts) {
      if (text.length <= LONG_NOTE) { made(this.notes, "p", {}, text); continue; }
      const details = made(this.notes, "details");
      made(details, "summary", {}, `${text.slice(0, LONG_NOTE)} …`);
      made(details, "p", {}, text);
    }
  }

  lost(reason) {
    this.root.classList.add("lost");
    this.root.querySelector(".body").inert = true; // nothing answers any more
    if (this.ready) { this.mechanism.ghost(); this.curves.stale(); }
    this.say(reason || "The library has ended. Start it again, and open the address that it prints.");
  }
}

// The torque, and the reactions of the first and the last joint.
function firstCurves(quantities) {
  const reactions = quantities.filter(({ kind }) => kind === "reaction").map(({ name }) => name);
  const torque = quantities.filter(({ kind }) => kind === "force").map(({ name }) => name).slice(0, 1);
  return [...new Set([...torque, ...reactions.slice(-1), ...reactions, ...quantities.map(({ name }) => name)])]
    .slice(0, FIRST_CURVES);
}
