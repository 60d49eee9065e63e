"""Messages of the explore page: requests that are read, answers with arrays and back."""

import json

import numpy as np
import pytest

from kinetostatics.views.explore.messages import ALIGNMENT, MAX_DEPTH, framed, parsed, unframed
from kinetostatics.views.page import packed
from support.every import every


def answered(answer):
    """An answer sent and read again, with its arrays in their places."""
    header, buffers = unframed(framed(*packed(answer)))

    def whole(item):
        if isinstance(item, dict):
            if "array" in item:
                return np.frombuffer(buffers[item["array"]], f"<{item['kind']}")
            return {key: whole(value) for key, value in item.items()}
        return [whole(value) for value in item] if isinstance(item, list) else item

    return whole(header)


def test_an_answer_comes_back_with_its_arrays():
    values = {"f8": np.linspace(0, 1, 7), "f4": np.arange(3, dtype=np.float32)}
    values["turned"] = np.arange(6.0).reshape(2, 3).T
    found = answered({"id": 3, "inner": [{"text": 'a "title" <b>', **values}], "number": np.float64(0.1)})
    (inner,) = found["inner"]
    assert (found["id"], found["number"], inner["text"]) == (3, 0.1, 'a "title" <b>')
    for name, array in values.items():
        assert inner[name].dtype == array.dtype
        np.testing.assert_array_equal(inner[name], array.ravel())


def test_what_json_has_no_number_for_is_null_but_in_arrays():
    found = answered(
        {"nan": np.nan, "inf": -np.inf, "curve": {"of": np.array([np.nan, np.inf])}, "whole": np.arange(2)}
    )
    assert (found["nan"], found["inf"]) == (None, None)
    np.testing.assert_array_equal(found["curve"]["of"], [np.nan, np.inf])
    np.testing.assert_array_equal(found["whole"], [0.0, 1.0])


@every("size", range(1, 10))
def test_arrays_begin_where_typed_arrays_may(size):
    """A Float64Array of a browser begins at a multiple of 8 bytes."""
    message = framed(*packed({"text": "x" * size, "first": np.zeros(size, np.float32), "second": np.zeros(2)}))
    _, buffers = unframed(message)
    assert message.index(bytes(4 * size)) % ALIGNMENT == 0
    assert len(message) % ALIGNMENT == 0
    assert [len(buffer) for buffer in buffers] == [4 * size, 16]


def deep(depth):
    """A request nested to this depth, as text."""
    return f'{{"id": 1, "kind": "look", "state": {"[" * (depth - 1)}{"]" * (depth - 1)}}}'


WRONG = {
    "no JSON": "look",
    "nothing": "",
    "no UTF-8": b"\xff\xfe\x00",
    "NaN": '{"id": 1, "kind": "look", "count": NaN}',
    "infinite": '{"id": 1, "kind": "look", "count": -Infinity}',
    "longer than whole numbers may be": f'{{"id": {"9" * 5000}, "kind": "look"}}',
    "deeper than Python": deep(100_000),
    "too deep": deep(MAX_DEPTH + 1),
    "a list": "[1]",
    "a number": "1",
    "null": "null",
    "without a kind": '{"id": 1}',
    "without a number": '{"kind": "look"}',
    "a kind that is no text": '{"id": 1, "kind": ["look"]}',
    "a number that is not whole": '{"id": 1.5, "kind": "look"}',
    "a number that is true": '{"id": true, "kind": "look"}',
}


@every("name", WRONG)
def test_a_wrong_request_is_refused_in_one_sentence(name):
    with pytest.raises(ValueError, match=r"^a request is ") as refused:
        parsed(WRONG[name])
    assert len(str(refused.value).encode()) <= 123  # what the end of a socket may say


def test_a_request_is_read():
    request = {"id": 7, "kind": "look", "state": {"variant": "säge", "values": {"crank_length": 1e-300}}}
    assert parsed(json.dumps(request)) == parsed(json.dumps(request).encode()) == request
    assert parsed(deep(MAX_DEPTH))["kind"] == "look"
