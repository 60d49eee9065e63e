// Keep what is shown: a case file, Python text, a report; of the state at the press of the button.
export class Keep {
  // `requests` asks the library, `shown()` gives {state, reference}; `name` is the first name of files.
  constructor(element, requests, shown, name) {
    Object.assign(this, { element, requests, shown });
    element.classList.add("keep");
    const label = this.add(element, "label", "Name of files ");
    this.name = this.add(label, "input");
    Object.assign(this.name, { type: "text", maxLength: 80, value: name });
    this.name.addEventListener("input", () => this.ask(null));
    this.button("Save case", () => this.write("save"));
    this.button("Copy Python", () => this.copy());
    this.button("Report", () => this.write("report"));
    this.overwrite = this.button("Replace it", () => this.confirmed());
    this.told = this.add(element, "p");
    this.told.setAttribute("role", "status");
    this.text = this.add(element, "textarea");
    Object.assign(this.text, { readOnly: true, rows: 8, spellcheck: false });
    this.text.setAttribute("aria-label", "Python text");
    this.text.hidden = true;
    this.ask(null);
  }

  add(parent, name, text = "") {
    const element = document.createElement(name);
    element.textContent = text;
    parent.append(element);
    return element;
  }

  button(text, onclick) {
    const button = this.add(this.element, "button", text);
    button.type = "button";
    button.addEventListener("click", onclick);
    return button;
  }

  // Ask whether an existing file is to be replaced: `confirmed` does so; null asks nothing.
  ask(confirmed) {
    this.confirmed = confirmed;
    this.overwrite.hidden = confirmed === null;
  }

  tell(...parts) { this.told.replaceChildren(...parts); }

  // Write a file, "save" or "report", of this state and name; an existing one after a confirmation.
  write(kind, fields = { ...this.shown(), name: this.name.value }) {
    this.ask(null);
    this.tell(kind === "report" ? "The report is being written ..." : "");
    this.requests.ask(kind, fields, (answer) => {
      if (answer.problem) {
        this.tell(answer.problem);
      } else if (answer.exists) {
        this.tell(`${answer.exists} exists already. `);
        this.ask(() => this.write(kind, { ...fields, overwrite: true }));
      } else if (answer.saved) {
        this.tell(`Saved as ${answer.saved}. `, ...this.link(answer));
      }
    });
  }

  // Link to a report that a server shows.
  link({ link }) {
    if (!link) return [];
    const found = document.createElement("a");
    Object.assign(found, { href: link, target: "_blank", rel: "noopener", textContent: "Open it" });
    return [found];
  }

  // Show the Python text, chosen, and copy it where the browser allows it.
  copy() {
    this.ask(null);
    this.requests.ask("python", this.shown(), (answer) => {
      this.text.hidden = Boolean(answer.problem);
      if (answer.problem) { this.tell(answer.problem); return; }
      this.text.value = answer.text;
      this.text.select();
      const copied = navigator.clipboard ? navigator.clipboard.writeText(answer.text) : Promise.reject(new Error());
      copied.then(() => this.tell("Copied."), () => this.tell("Copy the chosen text."));
    });
  }
}
