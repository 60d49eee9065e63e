"""Results of a sweep by chunk: in memory, or as the files of a Parquet dataset that outlive the process."""

import json
from pathlib import Path

import pandas as pd

from .errors import ParameterError
from .files import written_whole

MANIFEST = "_sweep.json"
"""What sweep a folder holds; readers of datasets pass files by whose names begin so."""


class Parts:
    """Designs and results by number of chunk, in memory."""

    def __init__(self, designs, chunk):
        self._designs, self._chunk = designs, chunk
        self.numbers = range(-(-len(designs) // chunk))
        self._kept: dict[int, pd.DataFrame] = {}

    def rows(self, number):
        """The designs of a chunk."""
        return self._designs.iloc[number * self._chunk : (number + 1) * self._chunk]

    def holds(self, number):
        """Whether the results of a chunk are there."""
        return number in self._kept

    def keep(self, number, found):
        """Keep the results of a chunk, with its designs."""
        self._put(number, pd.concat([self.rows(number), found], axis=1))

    def table(self):
        """All rows, in the order of the designs."""
        return pd.concat([self._get(number) for number in self.numbers])

    def _put(self, number, whole):
        self._kept[number] = whole

    def _get(self, number):
        return self._kept[number]


class Dataset(Parts):
    """The same as a folder of Parquet files, each written whole or not at all.

    Raises
    ------
    ParameterError
        The folder holds another sweep: its identity, a dict of texts and numbers, differs.
    """

    def __init__(self, designs, chunk, folder, identity):
        super().__init__(designs, chunk)
        self._folder = Path(folder)
        manifest = self._folder / MANIFEST
        if not manifest.exists():
            with written_whole(manifest) as temporary:
                Path(temporary).write_text(json.dumps(identity, indent=1), encoding="utf-8")
        before = json.loads(manifest.read_text(encoding="utf-8"))
        differing = [name for name, value in identity.items() if before.get(name) != value]
        if differing:
            raise ParameterError(
                f"sweep: {self._folder} holds another sweep, which differs in {', '.join(differing)}; give another "
                "folder, or delete that one"
            )

    def holds(self, number):
        return self._path(number).exists()

    def _path(self, number):
        return self._folder / f"part-{number:06d}.parquet"

    def _put(self, number, whole):
        with written_whole(self._path(number)) as temporary:
            whole.to_parquet(temporary)

    def _get(self, number):
        return pd.read_parquet(self._path(number))
