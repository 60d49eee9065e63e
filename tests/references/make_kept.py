"""Writes tests/data/kept: results of the whole package that a change of its internals must keep.

    python tests/references/make_kept.py                 everything
    python tests/references/make_kept.py shaper drives   only these: a shipped case, or a study of support/kept.py
    python tests/references/make_kept.py --new shaper    only results that are not kept yet, as of a new variant

Needs the extra `precision`. Written once, before such a change, by the package as it was; `test_kept.py` compares.
"""

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from support import kept


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("name", nargs="*", help=f"of {', '.join(kept.SUBJECTS)}; all unless given")
    parser.add_argument("--new", action="store_true", help="leave what is kept as it is")
    options = parser.parse_args()
    names = options.name
    if unknown := sorted(set(names) - kept.SUBJECTS.keys()):
        parser.error(f"not known: {', '.join(unknown)}; there are {', '.join(kept.SUBJECTS)}")
    for name in names or kept.SUBJECTS:
        began = time.monotonic()
        found = kept.SUBJECTS[name]()
        written = kept.write(name, found | kept.read(name) if options.new else found)
        files = ", ".join(f"{path.name} {path.stat().st_size / 1e3:.0f} kB" for path in written)
        print(f"{name}: {len(found)} results, {time.monotonic() - began:.1f} s: {files}", flush=True)


if __name__ == "__main__":
    main()
