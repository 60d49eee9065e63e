"""What follows from the numbers that a design varies: all numbers of its scene, with their derivatives.

A case file derives numbers from others, as a mass centre at mid-length. Its variant is built once on numbers that write
down every operation, so that what it derives is known for all values, and exactly how it changes.
"""

import numpy as np

from ..engines.graph import Graph, Node
from ..engines.program import Program
from ..engines.record import Recording
from ..errors import KinetostaticsError, NotGivenError
from ..numbers import paths


class Derived:
    """Numbers of a scene as functions of some varied ones.

    Attributes
    ----------
    names : tuple of str
        Paths of the varied numbers, as the source calls them.
    paths : tuple of str
        Paths of the scene's numbers that change with them.
    """

    def __init__(self, source, names):
        scene = scene_of(source)
        self.names, graph = tuple(names), Graph()
        nodes = [graph.parameter(place) for place in range(len(self.names))]
        try:
            made = scene_of(source.varied(dict(zip(self.names, nodes, strict=True))))
        except KinetostaticsError:
            raise
        except (TypeError, AttributeError, ValueError) as error:
            raise NotGivenError(
                f"what follows from {', '.join(self.names)} cannot be derived ({error}); vary numbers of the variant's "
                "scene instead, for which all others stay"
            ) from error
        places = paths.places(scene)
        found = {path: place.value(made) for path, place in places.items()}
        found = {path: value for path, value in found.items() if isinstance(value, Node)}
        self.paths = tuple(found)
        shape = (1,) * len(found)
        recording = Recording(self.paths, tuple(found.values()), shape, (False,) * len(found), tuple(nodes), (), graph)
        self._slopes = Program(recording).by_parameters(tuple(range(len(nodes))))

    def __call__(self, values):
        """Numbers by path, and their derivatives (paths, names, ...), from an array of values (names, ...)."""
        count, shape = len(self.paths), values.shape[1:]
        rows = self._slopes.by_numpy(np.zeros(1), list(values), (), shape or (1,))
        rows = rows if shape else rows[:, 0]
        slopes = rows[count:].reshape(count, len(self.names), *shape)
        numbers = {path: row if shape else float(row) for path, row in zip(self.paths, rows[:count], strict=True)}
        return numbers, slopes


def scene_of(item):
    """The scene of a variant, or the scene itself."""
    return getattr(item, "scene", item)
