// Elements of a page; texts from a case are only ever text.
export function made(parent, name, attributes = {}, text = "") {
  const found = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) found.setAttribute(key, value);
  if (text) found.textContent = text;
  parent.append(found);
  return found;
}
