// Numbers of a message: {"array": k, "kind": "f4" | "f8"} in its JSON stands for the array number k beside it.
const KINDS = { f4: Float32Array, f8: Float64Array };

// The value with typed arrays in place; `read(k, kind)` gives them. Objects are changed in place.
export function restored(value, read) {
  if (value === null || typeof value !== "object") return value;
  if (typeof value.kind === "string" && Number.isInteger(value.array)) return read(value.array, value.kind);
  for (const key of Object.keys(value)) value[key] = restored(value[key], read);
  return value;
}

// Reads arrays from base64 texts.
export function fromBase64(texts) {
  return (number, kind) => {
    const signs = atob(texts[number]), bytes = new Uint8Array(signs.length);
    for (let place = 0; place < bytes.length; place += 1) bytes[place] = signs.charCodeAt(place);
    return new KINDS[kind](bytes.buffer);
  };
}

// Reads arrays from ArrayBuffers or views of bytes at any offset.
export function fromBuffers(buffers) {
  return (number, kind) => {
    const bytes = buffers[number];
    const whole = bytes instanceof ArrayBuffer ? bytes
      : bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
    return new KINDS[kind](whole);
  };
}

// A number with some decimals; "" for NaN, and no sign on 0.
export function shown(value, decimals) {
  if (Number.isNaN(value)) return "";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "-∞";
  if (Math.abs(value) >= 1e9) return value.toExponential(5);
  const text = value.toFixed(decimals);
  return Number(text) === 0 ? (0).toFixed(decimals) : text;
}
