// Requests to the library and their answers, over a socket of the server or the model of a notebook.
import { fromBuffers, restored } from "./arrays.js";

const ALIGNMENT = 8, LENGTH_BYTES = 4; // as in messages.py

// Header and arrays of a binary message, as `messages.py` frames them.
function unframed(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const text = new TextDecoder().decode(new Uint8Array(buffer, LENGTH_BYTES, length));
  const [header, lengths] = JSON.parse(text);
  let end = LENGTH_BYTES + length;
  const parts = lengths.map((bytes) => {
    const part = new Uint8Array(buffer, end, bytes);
    end += Math.ceil(bytes / ALIGNMENT) * ALIGNMENT;
    return part;
  });
  return restored(header, fromBuffers(parts));
}

// A socket as a transport: `send(request)`; calls `onanswer(answer)` and `onlost()`.
export class Socket {
  constructor(address) {
    this.early = [];
    this.socket = new WebSocket(address);
    this.socket.binaryType = "arraybuffer";
    this.socket.addEventListener("open", () => this.early.splice(0).forEach((text) => this.socket.send(text)));
    this.socket.addEventListener("message", (event) => this.onanswer(unframed(event.data)));
    this.socket.addEventListener("close", (event) => this.onlost(event.reason));
  }

  send(request) {
    const text = JSON.stringify(request);
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(text); else this.early.push(text);
  }
}

// Numbered requests. Of looks and drags one is under way and only the newest waits; others are answered each.
export class Requests {
  constructor(transport) {
    Object.assign(this, { transport, number: 0, waiting: new Map(), underway: null, next: null });
    transport.onanswer = (answer) => this.receive(answer);
    transport.onlost = (reason) => this.onlost(reason);
    this.onlook = this.onlost = () => {};
  }

  // Ask once: `onanswer(answer)` is called for each answer, the returned function stops listening.
  ask(kind, fields, onanswer) {
    const id = this.send(kind, fields);
    this.waiting.set(id, onanswer);
    return () => this.waiting.delete(id);
  }

  // Ask for the machine of a state, or of a drag: `onlook(answer, fields)` gets the answers, in order.
  look(kind, fields) {
    if (this.underway !== null) { this.next = [kind, fields]; return; }
    this.asked = fields;
    this.underway = this.send(kind, fields);
  }

  // Is a look or a drag under way?
  get busy() { return this.underway !== null; }

  send(kind, fields) {
    this.number += 1;
    this.transport.send({ id: this.number, kind, ...fields });
    return this.number;
  }

  receive(answer) {
    if (answer.id === this.underway) {
      const { asked, next } = this;
      this.underway = this.next = null;
      if (next) this.look(...next);
      this.onlook(answer, asked);
    } else if (this.waiting.has(answer.id)) {
      const onanswer = this.waiting.get(answer.id);
      if (!answer.more) this.waiting.delete(answer.id);
      onanswer(answer);
    }
  }
}
