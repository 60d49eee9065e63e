"""Results of a sweep by chunk: in memory, or as files of a Parquet dataset that a stopped sweep continues."""

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
"""File with the identity of the sweep; readers of datasets skip names with a leading underscore."""
MAX_MANIFEST_BYTES = 10**7
"""Largest size of the manifest."""
METADATA_KEY = "kinetostatics"
"""Key of a part's signature in the metadata of its schema."""
MAX_LISTED_FILES = 5
"""Largest number of files named in a warning."""


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
        """Whether the results of a chunk exist."""
        return number in self._kept

    def keep(self, number, found):
        """Store the results of a chunk, with its designs."""
        self._kept[number] = pd.concat([self.rows(number), found], axis=1)

    def table(self):
        """All rows, in the order of the designs."""
        return pd.concat([self._kept[number] for number in self.numbers])


class Dataset(ChunkResults):
    """Chunk results in a folder of Parquet files, each written whole or not at all.

    Each file has a signature: its sweep, its chunk and a digest of its content. A file without the right signature is
    computed again, with a `CacheWarning`. Equal sweeps may share the folder at the same time.

    Raises
    ------
    ParameterError
        The folder cannot be used, or contains another sweep (with another identity, a dict of texts and numbers) or
        files without a manifest.
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
                f"sweep: in {self._folder} these files are not parts of this sweep and are computed again or left out: "
                f"{listed}",
                CacheWarning,
                stacklevel=3,
            )

    def holds(self, number):
        return self._path(number) in self._sound

    def keep(self, number, found):
        import pyarrow as pa
        from pyarrow import parquet

        whole = pd.concat([self.rows(number), found], axis=1)
        path, told = self._path(number), {METADATA_KEY: json.dumps(self._signature(number, whole))}
        try:
            table = pa.Table.from_pandas(whole)
            with write_atomically(path) as temporary:
                parquet.write_table(table.replace_schema_metadata({**table.schema.metadata, **told}), temporary)
        except (OSError, pa.ArrowException) as error:
            raise KinetostaticsError(
                f"sweep: {path} cannot be written: {error}; finished chunks stay, and the same call goes on"
            ) from error

    def table(self):
        parts = []
        for number in self.numbers:
            try:
                parts.append(self._read(number))
            except _DamagedPartError as error:
                path = self._path(number)
                raise KinetostaticsError(f"sweep: {path} was changed while the sweep ran: {error}") from error
        return pd.concat(parts)

    def _claim(self, identity):
        """Write the manifest, or raise `ParameterError` if the folder contains another sweep or other files."""
        self._folder.mkdir(parents=True, exist_ok=True)
        manifest = self._folder / MANIFEST
        if not manifest.exists():
            strange = [path for path in self._folder.glob("part-*.parquet") if self._problem(path)]
            if strange:
                raise ParameterError(
                    f"sweep: {self._folder} contains {strange[0].name}, but no {MANIFEST} that identifies its sweep; "
                    "give another folder"
                )
            _write_new(manifest, json.dumps(identity, indent=1))
        before = _read_manifest(manifest)
        differing = [name for name, value in identity.items() if before.get(name) != value]
        if differing:
            raise ParameterError(
                f"sweep: {self._folder} contains another sweep, which differs in {', '.join(differing)}; give another "
                "folder, or delete that one"
            )

    def _path(self, number):
        return self._folder / f"part-{number:06d}.parquet"

    def _problem(self, path):
        """Reason why a file is not an undamaged part of this sweep, or None."""
        if not path.is_file():
            raise ParameterError(f"sweep: {path} is no file; remove it, or give another folder")
        number = path.stem.removeprefix("part-")
        if not (number.isdecimal() and int(number) in self.numbers and path == self._path(int(number))):
            return "the sweep does not have this chunk"
        try:
            self._read(int(number))
        except _DamagedPartError as error:
            return str(error)
        return None

    def _read(self, number):
        """Designs and results of a chunk; an error if the file was changed."""
        from pyarrow import parquet

        try:
            with self._path(number).open("rb") as file:
                told = json.loads((parquet.read_metadata(file).metadata or {})[METADATA_KEY.encode()])
                file.seek(0)
                frame = pd.read_parquet(file)
        except KeyError as error:
            raise _DamagedPartError("it does not name its sweep") from error
        except Exception as error:  # any error from a damaged file
            raise _DamagedPartError(f"it cannot be read: {error}") from error
        for name, value in self._signature(number, frame).items():
            if not isinstance(told, dict) or told.get(name) != value:
                raise _DamagedPartError(f"the {name} differs from the written one")
        return frame

    def _signature(self, number, frame):
        """Signature of a part: sweep, chunk and digest of the content."""
        rows = pd.util.hash_pandas_object(frame, index=True).to_numpy().tobytes()
        heads = [*zip(map(str, frame.columns), (kind.kind for kind in frame.dtypes), strict=True), *frame.index.names]
        content = hashlib.sha256(repr(heads).encode() + rows).hexdigest()
        return {"sweep": self._sweep, "chunk": number, "content": content}


class _DamagedPartError(Exception):
    """A file was changed after the sweep wrote it."""


def _write_new(path, text):
    """Write a new file whole, unless another process creates it first."""
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
    """Identity of a sweep from its manifest."""
    try:
        if not manifest.is_file() or manifest.stat().st_size > MAX_MANIFEST_BYTES:
            raise ValueError("it is not a manifest")
        found = json.loads(manifest.read_text(encoding="utf-8"))
        if not isinstance(found, dict):
            raise ValueError(f"it contains no table but {str(found)[:40]!r}")
    except (ValueError, RecursionError) as error:
        raise ParameterError(
            f"sweep: {manifest} does not name the sweep of the folder: {error}; give another folder, or delete it"
        ) from error
    return found
