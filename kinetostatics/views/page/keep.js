// Keep what is shown: a case file, Python text, a report; of the state at the press of the button.
import { button, made } from "./html.js";

export class Keep {
  // `name` is the first name of files.
  constructor(element, explore, name) {
    Object.assign(this, { explore, requests: explore.requests });
    const label = made(element, "label", {}, "Name of the file ");
    this.name = made(label, "input", { type: "text", maxlength: 80, spellcheck: "false" });
    this.name.value = name;
    this.name.addEventListener("input", () => this.ask(null));
    button(element, "Save case", () => this.write("save"), { title: "a case file for kinetostatics run" });
    button(element, "Copy Python", () => this.copy(), { title: "Python text that builds this machine" });
    button(element, "Report", () => this.write("report"), { title: "one page with figures and tables" });
    this.overwrite = button(element, "Replace it", () => this.confirmed());
    this.message = made(element, "span", { class: "message", role: "status" });
    this.text = made(element, "textarea", { readonly: "", rows: 8, spellcheck: "false", "aria-label": "Python text", hidden: "" });
    this.text.addEventListener("keydown", ({ key }) => { if (key === "Escape") this.say(); });
    this.ask(null);
  }

  // Offer to replace an existing file: `confirmed` does so; null offers nothing.
  ask(confirmed) {
    this.confirmed = confirmed;
    this.overwrite.hidden = confirmed === null;
  }

  say(...parts) {
    this.ask(null);
    this.text.hidden = true;
    this.message.replaceChildren(...parts);
  }

  // Write a file, "save" or "report", of this state and name; an existing one after a confirmation.
  write(kind, fields = { ...this.shown, name: this.name.value }) {
    this.say(kind === "report" ? "The report is being written …" : "");
    this.requests.ask(kind, fields, (answer) => {
      if (answer.problem) {
        this.say(answer.problem);
      } else if (answer.exists) {
        this.say(`${answer.exists} exists already.`);
        this.ask(() => this.write(kind, { ...fields, overwrite: true }));
      } else if (answer.saved) {
        this.say([`Saved as ${answer.saved}.`, ...answer.notes ?? [], ""].join(" "));
        if (answer.link) made(this.message, "a", { href: answer.link, target: "_blank", rel: "noopener" }, "Open it");
      }
    });
  }

  // State, and that of the reference if it was frozen.
  get shown() { return { state: this.explore.state, reference: this.explore.frozen?.state ?? null }; }

  // Show the Python text, chosen, and copy it where the browser allows it.
  copy() {
    this.requests.ask("python", this.shown, (answer) => {
      this.say(answer.problem ?? "");
      if (answer.problem) return;
      Object.assign(this.text, { value: answer.text, hidden: false });
      this.text.select();
      const copied = navigator.clipboard ? navigator.clipboard.writeText(answer.text) : Promise.reject(new Error());
      copied.then(() => { this.message.textContent = "Copied."; }, () => { this.message.textContent = "Copy the chosen text."; });
    });
  }
}
