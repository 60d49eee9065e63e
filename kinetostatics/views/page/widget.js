// The explore page in a notebook: the widget's model carries requests and answers, and keeps the state.
import { fromBuffers, restored } from "./arrays.js";
import { Explore } from "./explore.js";
import { keyOf } from "./history.js";

// The model as a transport of one of the pages that show it.
class Kernel {
  constructor(model) {
    Object.assign(this, { model, page: `${Date.now()}-${Math.random()}` });
    this.receive = ({ page, answer }, buffers) => {
      if (page === this.page) this.onanswer(restored(answer, fromBuffers(buffers)));
    };
    this.end = () => this.onlost("The kernel has ended. Start it again, and run this cell.");
    model.on("msg:custom", this.receive);
    model.on("comm_live_update comm:close", this.end);
  }

  send(request) { this.model.send({ page: this.page, request }); }

  close() {
    this.model.off("msg:custom", this.receive);
    this.model.off("comm_live_update comm:close", this.end);
    this.model.send({ page: this.page });
  }
}

function render({ model, el }) {
  const root = document.createElement("div");
  root.className = "explore";
  // keys belong to the page: of the element that has the focus, JupyterLab asks whether they are shortcuts
  root.addEventListener("focusin", ({ target }) => target.setAttribute("data-lm-suppress-shortcuts", ""));
  el.append(root);
  const kernel = new Kernel(model);
  const address = {
    read: () => ({ ...model.get("address"), state: JSON.stringify(model.get("state")) }),
    write({ state, ...others }) {
      model.set({ state: JSON.parse(state), address: { ...model.get("address"), ...others } });
      model.save_changes();
    },
  };
  const explore = new Explore(root, kernel, address);
  const follow = () => {
    const state = model.get("state");
    if (explore.history && keyOf(state) !== keyOf(explore.history.now)) explore.change(state);
  };
  model.on("change:state", follow);
  return () => {
    model.off("change:state", follow);
    explore.clock.run(false);
    kernel.close();
  };
}

export default { render };
