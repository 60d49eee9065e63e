// States that were shown: undo, redo, and the address that reopens one.
export class History {
  constructor(first) { Object.assign(this, { states: [first], place: 0 }); }

  get now() { return this.states[this.place]; }

  // Keep a state after the present one; with `still`, in place of the present one (a drag that goes on).
  keep(state, still = false) {
    if (JSON.stringify(state) === JSON.stringify(this.now)) return;
    this.states.length = this.place + 1;
    if (still) this.states[this.place] = state; else this.states.push(state);
    this.place = this.states.length - 1;
  }

  move(steps) {
    const wanted = this.place + steps;
    if (wanted < 0 || wanted >= this.states.length) return null;
    this.place = wanted;
    return this.now;
  }
}

// Fields of the address's fragment, "#token=...&state=...", as texts.
export function fragment() { return Object.fromEntries(new URLSearchParams(location.hash.slice(1))); }

export function setFragment(fields) {
  history.replaceState(null, "", `#${new URLSearchParams(fields)}`);
}
