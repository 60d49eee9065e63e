// Elements and numbers of SVG.
const SVG = "http://www.w3.org/2000/svg";

export function element(name, parent, attributes = {}, text = "") {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text) made.textContent = text;
  if (parent) parent.appendChild(made);
  return made;
}

// Equal values are not set again: that would cost a layout.
export function put(target, attributes) {
  for (const [key, value] of Object.entries(attributes)) {
    if (target.getAttribute(key) !== `${value}`) target.setAttribute(key, value);
  }
}

export const short = (value) => Math.round(100 * value) / 100;

const MOST_TEXTS = 20000;
const texts = []; // of tenths: to make them anew takes longer than all else in a path

// A number of pixels as text, to a tenth.
export function tenths(value) {
  const count = Math.round(10 * value);
  return count >= 0 && count < MOST_TEXTS ? texts[count] ??= `${count / 10}` : `${count / 10}`;
}
