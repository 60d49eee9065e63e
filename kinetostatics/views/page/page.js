// The page of the server: the socket beside it, what is shown in the fragment of its address.
import { Socket } from "./connection.js";
import { Explore } from "./explore.js";
import { fragment, setFragment } from "./history.js";

const address = { read: fragment, write: (fields) => setFragment({ ...fragment(), ...fields }) };
document.querySelectorAll(".explore").forEach((root) => {
  const explore = new Explore(root, new Socket(`ws://${location.host}/socket`), address);
  document.addEventListener("keydown", (event) => { if (event.target === document.body) explore.press(event); });
});
