"""Requests as JSON; answers as messages: JSON with places for arrays, and the bytes of the arrays behind it."""

import json
import math

import numpy as np

from ...casefile.reading import is_deeper

LENGTH_BYTES = 4
"""Bytes in front of a message with the length of its JSON, little-endian."""
ALIGNMENT = 8
"""The JSON ends and arrays begin at multiples of this, as typed arrays in browsers must."""
KINDS = {np.dtype(np.float32): "f4", np.dtype(np.float64): "f8"}

MAX_DEPTH = 20
"""Largest depth of nested objects and lists of a request."""


def parsed(message):
    """The request in a message: a dict with a whole number `id` and a text `kind`; `ValueError` for all others."""
    try:
        request = json.loads(message, parse_constant=_refuse_constant)
    except (ValueError, RecursionError):
        raise ValueError("a request is JSON in UTF-8, nested at most 20 deep") from None
    if not isinstance(request, dict) or type(request.get("id")) is not int or not isinstance(request.get("kind"), str):
        raise ValueError("a request is an object with a whole number id and a text kind")
    if is_deeper(request, MAX_DEPTH):
        raise ValueError("a request is JSON in UTF-8, nested at most 20 deep")
    return request


def _refuse_constant(name):
    raise ValueError(f"{name} is no JSON")


def packed(answer):
    """An answer as header and buffers: an array becomes {"array": number, "kind": "f4" or "f8"}, NaN becomes None."""
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
