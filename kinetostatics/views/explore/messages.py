"""Answers as messages: JSON with places for arrays, and the bytes of the arrays behind it."""

import json
import math

import numpy as np

LENGTH_BYTES = 4
"""Bytes in front of a message with the length of its JSON, little-endian."""
ALIGNMENT = 8
"""The JSON ends and arrays begin at multiples of this, as typed arrays in browsers must."""
KINDS = {np.dtype(np.float32): "f4", np.dtype(np.float64): "f8"}


def packed(answer):
    """An answer as (header, buffers): an array becomes {"array": its number, "kind": "f4" or "f8"}, NaN becomes None."""
    buffers: list[bytes] = []

    def plain(item):
        if isinstance(item, dict):
            return {str(key): plain(value) for key, value in item.items()}
        if isinstance(item, list | tuple):
            return [plain(value) for value in item]
        if isinstance(item, np.ndarray):
            if item.dtype not in KINDS:
                item = item.astype(np.float64)
            buffers.append(np.ascontiguousarray(item).astype(item.dtype.newbyteorder("<"), copy=False).tobytes())
            return {"array": len(buffers) - 1, "kind": KINDS[item.dtype]}
        if isinstance(item, np.generic):
            item = item.item()
        return None if isinstance(item, float) and not math.isfinite(item) else item

    return plain(answer), buffers


def framed(header, buffers):
    """Header and buffers as one binary message; the header gets the lengths of the buffers."""
    text = json.dumps([header, [len(buffer) for buffer in buffers]], separators=(",", ":")).encode()
    text += b" " * (-(LENGTH_BYTES + len(text)) % ALIGNMENT)
    parts = [len(text).to_bytes(LENGTH_BYTES, "little"), text]
    for buffer in buffers:
        parts += [buffer, bytes(-len(buffer) % ALIGNMENT)]
    return b"".join(parts)


def unframed(message):
    """Header and buffers of a binary message."""
    end = LENGTH_BYTES + int.from_bytes(message[:LENGTH_BYTES], "little")
    header, lengths = json.loads(message[LENGTH_BYTES:end])
    buffers = []
    for length in lengths:
        buffers.append(message[end : end + length])
        end += length + -length % ALIGNMENT
    return header, buffers
