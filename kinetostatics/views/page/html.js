// Elements of a page; texts from a case are only ever text.
export function made(parent, name, attributes = {}, text = "") {
  const found = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) found.setAttribute(key, value);
  if (text) found.textContent = text;
  parent.append(found);
  return found;
}

export function button(parent, text, onclick, attributes = {}) {
  const found = made(parent, "button", { type: "button", ...attributes }, text);
  found.addEventListener("click", onclick);
  return found;
}

// A box to tick, with its words.
export function checkbox(parent, text, checked, onchange) {
  const label = made(parent, "label", { class: "check" }), input = made(label, "input", { type: "checkbox" });
  made(label, "span", {}, text);
  input.checked = checked;
  input.addEventListener("change", () => onchange(input.checked));
  return input;
}
