"""Results of a sweep by chunk: in memory, or as the files of a Parquet dataset that outlive the process."""

import hashlib
import json
import warnings
from contextlib import suppress
from pathlib import Path
from uuid import uuid4

import pandas as pd

from ..errors import CacheWarning, KinetostaticsError, ParameterError
from ..numbers.files import write_atomically

MANIFEST = "_sweep.json"
"""What sweep a folder holds; readers of datasets pass files by whose names begin so."""
MAX_MANIFEST_BYTES = 10**7
"""Bytes that it may have."""
METADATA_KEY = "kinetostatics"
"""Where a part tells of itself, among the metadata of its schema."""
MAX_LISTED_FILES = 5
"""Files that a warning names."""


class ChunkResults:
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


class Dataset(ChunkResults):
    """The same as a folder of Parquet files, each written whole or not at all.

    Each tells of what sweep it is, which chunk, and a digest of what it holds; one that does not is computed anew, with
    a `CacheWarning`. Equal sweeps may share the folder, also at the same time.

    Raises
    ------
    ParameterError
        The folder cannot be used, or holds something else: another sweep, whose identity, a dict of texts and numbers,
        differs, or files of which no sweep is recorded.
    """

    def __init__(self, designs, chunk, folder, identity):
        super().__init__(designs, chunk)
        self._folder = Path(folder)
        self._sweep = hashlib.sha256(json.dumps(identity, sort_keys=True).encode()).hexdigest()
        try:
            self._claim(identity)
            problems = {path: self._problem(path) for path in sorted(self._folder.glob("part-*.parquet"))}
        except OSError as error:
            raise ParameterError(f"sweep: {self._folder} cannot be used: {error}") from error
        self._sound = {path for path, problem in problems.items() if problem is None}
        unsound = [f"{path.name} ({problem})" for path, problem in problems.items() if problem]
        if unsound:
            listed = ", ".join(unsound[:MAX_LISTED_FILES]) + f" and {len(unsound) - MAX_LISTED_FILES} more" * (
                len(unsound) > MAX_LISTED_FILES
            )
            warnings.warn(
                f"sweep: in {self._folder} these are no parts of it as it wrote them, and are made anew or left out: "
                f"{listed}",
                CacheWarning,
                stacklevel=3,
            )

    def holds(self, number):
        return self._path(number) in self._sound

    def _claim(self, identity):
        """Write down what sweep the folder holds, or raise `ParameterError` if it holds another or anything else."""
        self._folder.mkdir(parents=True, exist_ok=True)
        manifest = self._folder / MANIFEST
        if not manifest.exists():
            strange = [path for path in self._folder.glob("part-*.parquet") if self._problem(path)]
            if strange:
                raise ParameterError(
                    f"sweep: {self._folder} holds {strange[0].name}, but no {MANIFEST} that tells of what sweep; give "
                    "another folder"
                )
            _write_new(manifest, json.dumps(identity, indent=1))
        before = _read_manifest(manifest)
        differing = [name for name, value in identity.items() if before.get(name) != value]
        if differing:
            raise ParameterError(
                f"sweep: {self._folder} holds another sweep, which differs in {', '.join(differing)}; give another "
                "folder, or delete that one"
            )

    def _path(self, number):
        return self._folder / f"part-{number:06d}.parquet"

    def _put(self, number, whole):
        import pyarrow as pa
        from pyarrow import parquet

        path, told = self._path(number), {METADATA_KEY: json.dumps(self._told(number, whole))}
        try:
            table = pa.Table.from_pandas(whole)
            with write_atomically(path) as temporary:
                parquet.write_table(table.replace_schema_metadata({**table.schema.metadata, **told}), temporary)
        except (OSError, pa.ArrowException) as error:
            raise KinetostaticsError(
                f"sweep: {path} cannot be written: {error}; what is done is kept, and the same call goes on from there"
            ) from error

    def _get(self, number):
        try:
            return self._read(number)
        except _DamagedPartError as error:
            raise KinetostaticsError(f"sweep: {self._path(number)} was changed while the sweep ran: {error}") from error

    def _problem(self, path):
        """Why a file is no part of this sweep as it was written, or None."""
        if not path.is_file():
            raise ParameterError(f"sweep: {path} is no file; remove it, or give another folder")
        number = path.stem.removeprefix("part-")
        if not (number.isdecimal() and int(number) in self.numbers and path == self._path(int(number))):
            return "the sweep has no such chunk"
        try:
            self._read(int(number))
        except _DamagedPartError as error:
            return str(error)
        return None

    def _read(self, number):
        """Designs and results of a chunk, if they are what was written."""
        from pyarrow import parquet

        try:
            with self._path(number).open("rb") as file:
                told = json.loads((parquet.read_metadata(file).metadata or {})[METADATA_KEY.encode()])
                file.seek(0)
                frame = pd.read_parquet(file)
        except KeyError as error:
            raise _DamagedPartError("it does not tell of what sweep it is") from error
        except Exception as error:  # whatever a damaged file leads to
            raise _DamagedPartError(f"it cannot be read: {error}") from error
        for name, value in self._told(number, frame).items():
            if not isinstance(told, dict) or told.get(name) != value:
                raise _DamagedPartError(f"another {name} than was written")
        return frame

    def _told(self, number, frame):
        """What a part tells of itself."""
        rows = pd.util.hash_pandas_object(frame, index=True).to_numpy().tobytes()
        heads = [*zip(map(str, frame.columns), (kind.kind for kind in frame.dtypes), strict=True), *frame.index.names]
        content = hashlib.sha256(repr(heads).encode() + rows).hexdigest()
        return {"sweep": self._sweep, "chunk": number, "content": content}


class _DamagedPartError(Exception):
    """A file is not as the sweep wrote it."""


def _write_new(path, text):
    """Write a file whole that is not there, unless another process has just done so."""
    temporary = path.with_name(f".{path.name}-{uuid4().hex}")
    try:
        temporary.write_text(text, encoding="utf-8")
        path.hardlink_to(temporary)
    except FileExistsError:
        pass
    except OSError:  # no hard links here
        with suppress(FileExistsError), path.open("x", encoding="utf-8") as file:
            file.write(text)
    finally:
        temporary.unlink(missing_ok=True)


def _read_manifest(manifest):
    """Identity that a manifest tells."""
    try:
        if not manifest.is_file() or manifest.stat().st_size > MAX_MANIFEST_BYTES:
            raise ValueError("it is no such file")
        found = json.loads(manifest.read_text(encoding="utf-8"))
        if not isinstance(found, dict):
            raise ValueError(f"it holds no table but {str(found)[:40]!r}")
    except (ValueError, RecursionError) as error:
        raise ParameterError(
            f"sweep: {manifest} does not tell of what sweep the folder is: {error}; give another folder, or delete it"
        ) from error
    return found
