"""Requests as JSON; packed answers as messages: JSON with places for arrays, and the bytes of the arrays behind it."""

import json

from ...casefile.reading import is_deeper

LENGTH_BYTES = 4
"""Bytes in front of a message with the length of its JSON, little-endian."""
ALIGNMENT = 8
"""The JSON ends and arrays begin at multiples of this, as typed arrays in browsers must."""

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
