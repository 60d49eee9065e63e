"""What all tests share."""

import gc
import os
import sys
from functools import cache
from importlib.machinery import ModuleSpec
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

gc.set_threshold(20_000, 20, 20)  # modules and thousands of tests live to the end: seldom look for garbage among them


@pytest.hookimpl(wrapper=True)
def pytest_collect_file():
    """Tests themselves have no examples to look for."""
    found = yield
    return [one for one in found if type(one).__name__ != "DoctestModule"]


@pytest.hookimpl(trylast=True)
def pytest_collection_finish():
    """What is there before the first test stays, and need not be looked at again and again."""
    gc.collect()
    gc.freeze()


@pytest.fixture(scope="session", autouse=True)
def programs(tmp_path_factory):
    """A folder for compiled programs that goes with pytest's others, unless the environment names one.

    Processes of one run share it, so that each program is compiled once.
    """
    own = tmp_path_factory.getbasetemp()
    run = own.parent if os.environ.get("PYTEST_XDIST_WORKER") else own
    with pytest.MonkeyPatch.context() as patch:
        if not os.environ.get("KINETOSTATICS_CACHE"):
            patch.setenv("KINETOSTATICS_CACHE", str(run / "compiled"))
        yield


@pytest.fixture
def interpreted(monkeypatch):
    """Programs run by Python as they are written, without numba: the same arithmetic, and nothing to compile."""
    from kinetostatics.engines import code_cache, jax_backend, numba_backend, program
    from kinetostatics.numbers import parameter_tree
    from support import by_arrays

    numba = ModuleType("numba")
    numba.njit = lambda *signature, **options: np.errstate(all="ignore")
    numba.types = None
    numba.config = SimpleNamespace(DISABLE_JIT=0)
    numba.__spec__ = ModuleSpec("numba", None)
    numba.extending = ModuleType("numba.extending")
    numba.extending.intrinsic = lambda function: lambda one, other, more: one * other + more  # there is one: fma
    core = ModuleType("numba.core.compiler")
    core.Compiler = object
    for module in (numba, numba.extending, core):
        monkeypatch.setitem(sys.modules, module.__name__, module)
    by_arrays.stand_in(monkeypatch)
    loaded = cache(code_cache.load_module)
    for module in (numba_backend, program, jax_backend):
        monkeypatch.setattr(module, "load_compiled", loaded)
    parameter_tree.structure_cache.cache_clear()
    yield
    parameter_tree.structure_cache.cache_clear()


@pytest.fixture
def numba():
    return pytest.importorskip("numba", reason="numba is not installed (extra: fast)")


@pytest.fixture
def jax():
    return pytest.importorskip("jax", reason="jax is not installed (extra: grad)")


@pytest.fixture
def double(jax):
    """JAX in double precision, and back to what it was."""
    before = jax.config.jax_enable_x64
    jax.config.update("jax_enable_x64", True)
    yield jax
    jax.config.update("jax_enable_x64", before)


@pytest.fixture
def flint():
    """python-flint at 200 bits, and back to what it was."""
    flint = pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")
    with flint.ctx.workprec(200):
        yield flint


@pytest.fixture(scope="session")
def tell(request):
    """Prints a line past pytest's capturing; first of all the machine and the versions."""
    from kinetostatics.studies.methods import method

    capturing = request.config.pluginmanager.getplugin("capturemanager")

    def line(text):
        with capturing.global_and_fixture_disabled():
            print(f"\n{text}", end="")

    for text in method.circumstances().values():
        line(text)
    return line


@pytest.fixture
def axes():
    """Axes of a figure that is closed behind the test."""
    import matplotlib.pyplot as plt

    figure, ax = plt.subplots()
    yield ax
    plt.close(figure)
