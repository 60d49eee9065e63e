// Groups, loads and friction of a chain that is built on the page: a list with a form for each part, Add and Remove.
import { keyOf } from "./history.js";
import { button, made } from "./html.js";

const LISTS = { groups: "Group", loads: "Load", gravity: "Load", friction: "Friction at" };
const HEADINGS = { groups: "Groups", gravity: "Loads", loads: "Loads", friction: "Friction" };

const words = (key) => key.replaceAll("_", " ").replaceAll(".", " ");

export class Groups {
  // Under an element of the explore page, whose state has a chain.
  constructor(element, explore) {
    Object.assign(this, { element, explore, state: null, open: new Set(), titles: null });
    this.build();
    explore.onchanged((state) => { if (!explore.moving) this.show(state); });
  }

  build() {
    const whole = made(this.element, "details", { open: "" });
    made(whole, "summary", {}, "Groups and loads");
    const adding = made(whole, "div", { class: "adding" });
    this.kinds = made(adding, "select", { "aria-label": "group or load to add" });
    this.kinds.addEventListener("change", () => this.about());
    button(adding, "Add", () => this.act({ do: "add", at: this.chosen.at, kind: this.chosen.kind }, this.refusal));
    this.help = made(whole, "p", { class: "help" });
    this.refusal = made(whole, "p", { class: "fault", role: "alert" });
    this.note = made(whole, "p", { class: "help", role: "status" });
    this.list = made(whole, "div", { class: "parts" });
  }

  // Do the forms belong to the state that is asked for?
  get settled() { return this.shown === this.state && this.state === this.explore.state; }

  get chosen() { return this.known[this.kinds.selectedIndex]; }

  about() { this.help.textContent = this.chosen.about; }

  // Show the parts of the chain of a state; forms that are open stay so, and one of a new part is opened.
  show(state) {
    this.state = state;
    this.explore.requests.ask("groups", { state }, (answer) => {
      if (answer.problem || keyOf(answer.state) !== keyOf(this.state)) return;
      this.offer(answer.kinds);
      this.fill(answer.parts);
      this.shown = state;
    });
  }

  offer(kinds) {
    const before = this.known?.[this.kinds.selectedIndex]?.kind;
    this.known = kinds;
    this.kinds.replaceChildren();
    let group = null;
    for (const { at: [name], kind } of kinds) {
      if (group?.label !== LISTS[name]) group = made(this.kinds, "optgroup", { label: LISTS[name] });
      made(group, "option", {}, kind);
    }
    this.kinds.selectedIndex = Math.max(0, kinds.findIndex(({ kind }) => kind === before));
    this.about();
  }

  fill(parts) {
    const focused = this.focus();
    const before = this.titles;
    this.titles = new Set(parts.map(({ title }) => title));
    this.list.replaceChildren();
    let list = null;
    this.parts = parts.map((part) => {
      const heading = HEADINGS[part.at[0]];
      if (heading && heading !== list) made(this.list, "h3", {}, heading);
      list = heading;
      if (before && !before.has(part.title)) this.open.add(part.title);
      return new Part(this, part);
    });
    this.parts.find(({ title }) => title === focused?.title)?.focus(focused.key);
  }

  // Part and key of the field that has the keyboard's focus.
  focus() {
    for (const { title, inputs } of this.parts ?? []) {
      for (const [key, { input }] of inputs) if (input.matches(":focus")) return { title, key };
    }
    return null;
  }

  // Ask for an action; `place` shows a fault, or `onfault(answer)` where it is given.
  act(action, place, onfault = () => {}) {
    const { state } = this;
    place.replaceChildren();
    this.explore.requests.ask("edit", { state, action }, (answer) => {
      if (this.state !== state) { this.act(action, place, onfault); return; } // changed meanwhile
      if (!answer.problem) {
        this.refusal.replaceChildren();
        this.note.textContent = answer.notes.join(" ");
        this.explore.change(answer.state);
        return;
      }
      place.textContent = answer.problem;
      onfault(answer);
    });
  }
}

// One part: a line with its title, which opens to its form.
class Part {
  constructor(groups, { at, title, about, fields }) {
    Object.assign(this, { groups, at, title, inputs: new Map() });
    const details = made(groups.list, "details", { class: "part" });
    details.open = groups.open.has(title);
    details.addEventListener("toggle", () => groups.open[details.open ? "add" : "delete"](title));
    made(details, "summary", {}, title);
    if (about) made(details, "p", { class: "help" }, about);
    const given = fields.filter(({ required, value }) => required || value);
    for (const field of given) this.field(details, field);
    const others = fields.filter((field) => !given.includes(field));
    if (others.length) {
      const more = made(details, "details", { class: "more" });
      const name = `${title} more`;
      more.open = groups.open.has(name);
      more.addEventListener("toggle", () => groups.open[more.open ? "add" : "delete"](name));
      made(more, "summary", {}, "more keys");
      for (const field of others) this.field(more, field);
    }
    this.fault = made(details, "p", { class: "fault", role: "alert" });
    if (at.length) button(details, "Remove", () => this.remove());
  }

  field(parent, field) {
    const label = made(parent, "label", { class: "field", title: field.text });
    made(label, "span", { class: "name" }, words(field.key));
    const input = field.choices.length ? this.choice(label, field) : made(label, "input", { type: "text" });
    if (!field.choices.length) {
      input.value = field.value;
      input.placeholder = field.default;
      input.spellcheck = false;
    }
    const fault = made(label, "span", { class: "fault", role: "alert" });
    made(label, "small", { class: "help" }, field.unit ? `${field.text} [${field.unit}]` : field.text);
    input.addEventListener("change", () => this.change());
    this.inputs.set(field.key, { input, fault, value: field.value });
  }

  choice(label, { choices, value, required, default: usual }) {
    const select = made(label, "select");
    if (!required) made(select, "option", { value: "" }, usual ? `${usual} (default)` : "");
    if (value && !choices.includes(value)) made(select, "option", { value }, value);
    for (const text of choices) made(select, "option", { value: text }, text);
    select.value = value;
    return select;
  }

  focus(key) { this.inputs.get(key)?.input.focus(); }

  // Send all texts of the form that differ from the chain; a part that needs several keys waits for the last one.
  change() {
    const changed = [...this.inputs].filter(([, { input, value }]) => input.value.trim() !== value);
    this.clear();
    if (!changed.length) return;
    const keys = Object.fromEntries(changed.map(([key, { input }]) => [key, input.value]));
    this.groups.act({ do: "change", at: this.at, keys }, this.fault, ({ faults }) => this.mark(faults));
  }

  clear() {
    this.fault.replaceChildren();
    for (const { input, fault } of this.inputs.values()) {
      fault.replaceChildren();
      input.removeAttribute("aria-invalid");
    }
  }

  // Show faults beside the fields that they name, others below the form.
  mark(faults) {
    const left = [];
    for (const { key, text } of faults ?? []) {
      const place = this.inputs.get(key) ?? this.inputs.get(key.slice(0, key.lastIndexOf(".")));
      if (!place) { left.push(text); continue; }
      place.fault.textContent = text;
      place.input.setAttribute("aria-invalid", "true");
      place.input.closest("details.more")?.setAttribute("open", "");
    }
    if (faults?.length) this.fault.textContent = left.join("; ");
  }

  remove(attached = false) {
    this.groups.act({ do: "remove", at: this.at, attached }, this.fault, ({ carried }) => {
      if (attached || !carried?.length) return;
      button(this.fault, "Remove all", () => this.remove(true));
    });
  }
}
