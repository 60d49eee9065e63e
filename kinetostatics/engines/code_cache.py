"""Modules of generated source: Python's own, or numba's with machine code that outlives the process.

What a module does comes from the text in hand, never from a file of Python's. Of numba's machine code on disk only what
is sealed in a folder that others cannot write to is taken (`programs_folder`); failing that, it is compiled in memory.
"""

import hashlib
import platform
import shutil
import sys
import tempfile
import warnings
from functools import cache
from types import ModuleType

from ..errors import CacheWarning
from ..signals import deferred
from .programs_folder import is_intact, new_entry, programs_folder


def load_module(text, keep=False) -> ModuleType:
    """Module of a source text.

    Parameters
    ----------
    text : str
        It may ask for `KEEP`, whether machine code is to be kept, and hands it to numba: ``njit(signature,
        cache=KEEP)``. Only functions with a signature are kept, for they are compiled while the module is loaded; what
        other programs need of them must be called from there.
    keep : bool
        Whether machine code is looked for on disk, and left there. When that cannot be, the module is the same, with a
        `CacheWarning` once.
    """
    with deferred():  # LLVM calls back into Python, where an interruption is lost
        if keep:
            try:
                return _kept(text)
            except OSError as error:
                _tell(f"machine code is not kept on disk but made anew in each session: {error}")
        name = _name(text)
        return _executed(text, name, f"<{name}>", keep=False)


def _kept(text):
    """The module with machine code from its folder, where it is put if it is not there.

    Raises
    ------
    OSError
        It can be neither found there nor put there.
    """
    from numba import config

    if vars(config)["CACHE_DIR"]:
        raise OSError("NUMBA_CACHE_DIR is set, so numba would put it elsewhere")
    name = _name(text, *_machine())
    entry = programs_folder() / name
    damaged = entry.exists() and not is_intact(entry)
    if damaged:
        shutil.rmtree(entry)
    if entry.exists():
        return _beside(text, name, entry)
    with new_entry(entry) as made:
        (made / f"{name}.py").write_text(text, encoding="utf-8")  # numba wants a file to put its own beside
        module = _beside(text, name, made)
    if damaged:
        _tell(f"{entry} was damaged, and is compiled anew")
    return module


def _beside(text, name, folder):
    """The module with machine code in the folder of its source."""
    place = folder / "__pycache__"
    place.mkdir(mode=0o700, exist_ok=True)
    tempfile.TemporaryFile(dir=place).close()  # where numba cannot do this it goes elsewhere
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
    """What machine code depends on besides its source."""
    import numba
    from llvmlite import binding

    processor = binding.get_host_cpu_name(), binding.get_host_cpu_features().flatten()
    options = [repr(vars(numba.config)[name]) for name in ("CPU_NAME", "CPU_FEATURES", "OPT")]
    return numba.__version__, sys.implementation.cache_tag, platform.machine(), *processor, *options


@cache
def _tell(message):
    warnings.warn(message, CacheWarning, stacklevel=2)
