// States that were shown: undo, redo, and the fields of an address that reopen one.
const MOST_STATES = 1000; // that can be undone

// Equal for equal states, in whatever order their values come.
export const keyOf = ({ values, ...others }) => JSON.stringify([others, Object.entries(values ?? {}).sort()]);

export class History {
  constructor(first) { Object.assign(this, { states: [first], place: 0 }); }

  get now() { return this.states[this.place]; }

  get first() { return this.place === 0; }

  get last() { return this.place === this.states.length - 1; }

  // Keep a state after the present one; with `still`, in place of the present one (a movement that goes on). Whether it
  // differs from the present one.
  keep(state, still = false) {
    if (keyOf(state) === keyOf(this.now)) return false;
    this.states.length = this.place + 1;
    if (still) this.states[this.place] = state; else this.states.push(state);
    if (this.states.length > MOST_STATES) this.states.shift();
    this.place = this.states.length - 1;
    return true;
  }

  move(steps) {
    const wanted = this.place + steps;
    if (wanted < 0 || wanted >= this.states.length) return null;
    this.place = wanted;
    return this.now;
  }
}

// Value of a JSON text of an address; `otherwise` if it has none.
export function parsed(text, otherwise = null) {
  try { return JSON.parse(text) ?? otherwise; } catch { return otherwise; }
}

const LONGEST = 100001; // characters of a field: one more than the library reads

// Fields of the address's fragment, "#token=...&state=...", as texts.
export function fragment() {
  const fields = [...new URLSearchParams(location.hash.slice(1))];
  return Object.fromEntries(fields.map(([name, text]) => [name, text.slice(0, LONGEST)]));
}

export function setFragment(fields) {
  history.replaceState(null, "", `#${new URLSearchParams(fields)}`);
}
