"""Modules of generated source, with machine code of numba kept on disk.

Code from disk is executed, so only files with correct checksums in a folder that no other user can write to are used;
otherwise the source is compiled in memory. The name of a program's folder is a hash of its source, numba, Python and
the processor: programs of other versions are never used. A folder appears complete and never changes.
"""

import hashlib
import json
import os
import platform
import shutil
import stat
import sys
import tempfile
import warnings
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from types import ModuleType

from ..errors import CacheWarning
from ..signals import deferred

CHECKSUMS = "checksums.json"
"""The file with the checksums of all others in a program's folder."""


class UntrustedError(OSError):
    """Another user may change the cached files."""


def programs_folder() -> Path:
    """Folder of cached programs: KINETOSTATICS_CACHE, else the user's cache folder; created if missing.

    `OSError` if there is no folder, it cannot be created, or other users may write to it.
    """
    given = os.environ.get("KINETOSTATICS_CACHE")
    try:
        if given:
            folder = Path(given).expanduser().absolute()
        else:
            from platformdirs import user_cache_path

            home, folder = Path.home(), Path(user_cache_path("kinetostatics"))
            if not folder.is_absolute() or (folder.is_relative_to(home) and not home.is_dir()):
                raise FileNotFoundError(f"there is no home folder for {folder}")
    except ImportError as error:
        raise OSError('platformdirs, which finds the folder, is missing: pip install "kinetostatics[fast]"') from error
    except RuntimeError as error:
        raise OSError(f"KINETOSTATICS_CACHE is {given!r}: {error}" if given else str(error)) from error
    for step in reversed([folder, *folder.parents]):
        step.mkdir(mode=0o700, exist_ok=True)
    require_private(folder)
    return folder


def require_private(path):
    """Raise `UntrustedError` if users other than this one and root may write to a file or folder, or replace it.

    Not checked on systems without user numbers, such as Windows.
    """
    if not hasattr(os, "getuid"):
        return
    for place in dict.fromkeys([path.absolute(), path.resolve()]):
        for step in (place, *place.parents):
            status = step.lstat()
            if status.st_uid not in (0, os.getuid()):
                raise UntrustedError(f"{step} belongs to another user")
            shared = status.st_mode & (stat.S_IWGRP | stat.S_IWOTH) and not stat.S_ISLNK(status.st_mode)
            kept = step != place and status.st_mode & stat.S_ISVTX  # in a folder like /tmp others own their files
            if shared and not kept:
                raise UntrustedError(f"others may write to {step}; give another folder, or chmod go-w {step}")


def is_intact(entry) -> bool:
    """Whether the files of a program's folder have the stored checksums; `UntrustedError` if others may write there."""
    files = _files(entry)
    if any(path.is_symlink() or not (path.is_file() or path.is_dir()) for path in (entry, *files)):
        return False
    for path in (entry, *files):
        require_private(path)
    try:
        expected = json.loads((entry / CHECKSUMS).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return False
    return expected == _checksums(entry)


@contextmanager
def new_entry(entry):
    """Private folder that is renamed to `entry` when the block ends without an error.

    If two processes write the same entry, the first one wins.
    """
    made = Path(tempfile.mkdtemp(prefix=f".{entry.name}-", dir=entry.parent))
    try:
        yield made
        for path in _files(made):
            path.chmod(0o700 if path.is_dir() else 0o600)
        (made / CHECKSUMS).write_text(json.dumps(_checksums(made)), encoding="utf-8")
        (made / CHECKSUMS).chmod(0o600)
        try:
            made.rename(entry)
        except OSError:
            if not entry.exists():
                raise
    finally:
        shutil.rmtree(made, ignore_errors=True)


def _files(entry):
    return sorted(entry.rglob("*"))


def _checksums(entry):
    files = [path for path in _files(entry) if path.name != CHECKSUMS and not path.is_dir()]
    return {path.relative_to(entry).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def load_module(text, keep=False) -> ModuleType:
    """Module of a source text, in which `KEEP` tells numba to cache machine code: ``njit(signature, cache=KEEP)``.

    Only functions with a signature are cached, because they are compiled while the module is loaded. `keep` reads
    machine code from disk and writes it there; if that fails, the module is compiled in memory, with a `CacheWarning`
    once.
    """
    with deferred():  # LLVM calls back into Python, where an interruption is lost
        if keep:
            try:
                return _kept(text)
            except OSError as error:
                _tell(f"machine code is not cached on disk but compiled again in each session: {error}")
        name = _name(text)
        return _executed(text, name, f"<{name}>", keep=False)


def _kept(text):
    """The module with machine code from its folder, compiled and written there if missing; or an `OSError`."""
    from numba import config

    if vars(config)["CACHE_DIR"]:
        raise OSError("NUMBA_CACHE_DIR is set, so numba would store it elsewhere")
    name = _name(text, *_machine())
    entry = programs_folder() / name
    damaged = entry.exists() and not is_intact(entry)
    if damaged:
        shutil.rmtree(entry)
    if entry.exists():
        return _beside(text, name, entry)
    with new_entry(entry) as made:
        (made / f"{name}.py").write_text(text, encoding="utf-8")  # numba stores its file next to this one
        module = _beside(text, name, made)
    if damaged:
        _tell(f"{entry} was damaged and is compiled again")
    return module


def _beside(text, name, folder):
    """The module with machine code in the folder of its source."""
    place = folder / "__pycache__"
    place.mkdir(mode=0o700, exist_ok=True)
    tempfile.TemporaryFile(dir=place).close()  # if numba cannot write here it goes elsewhere
    return _executed(text, name, str(folder / f"{name}.py"), keep=True)


def _executed(text, name, file, keep):
    module = ModuleType(name)
    module.__dict__.update(__file__=file, KEEP=keep)
    sys.modules[name] = module  # numba looks it up by name
    exec(compile(text, file, "exec", dont_inherit=True), module.__dict__)
    return module


def _name(*parts):
    return f"kinetostatics_{hashlib.sha256(repr(parts).encode()).hexdigest()[:32]}"


@cache
def _machine():
    """Versions and processor that machine code depends on, besides its source."""
    import numba
    from llvmlite import binding

    processor = binding.get_host_cpu_name(), binding.get_host_cpu_features().flatten()
    options = [repr(vars(numba.config)[name]) for name in ("CPU_NAME", "CPU_FEATURES", "OPT")]
    return numba.__version__, sys.implementation.cache_tag, platform.machine(), *processor, *options


@cache
def _tell(message):
    warnings.warn(message, CacheWarning, stacklevel=2)
