"""A property is computed when first read, and kept; its class shows what it is."""

from kinetostatics.numbers.lazy import cached_property


class Counted:
    def __init__(self):
        self.count = 0

    @cached_property
    def found(self):
        """How often."""
        self.count += 1
        return self.count


def test_it_is_computed_once_and_can_be_forgotten():
    item = Counted()
    assert (item.found, item.found) == (1, 1)
    del item.found
    assert item.found == 2


def test_the_class_shows_it_with_its_docstring():
    assert Counted.found.__doc__ == "How often."
