"""The command line, as ``kinetostatics`` and ``python -m kinetostatics`` start it."""

import gc
import sys

COLLECTION_THRESHOLD = 100_000
"""Number of new objects between garbage collections; libraries and figures create many long-lived objects."""


def main():
    """Run the command line; returns the exit status. Ctrl-C ends it in the same way while its libraries are loaded."""
    gc.set_threshold(COLLECTION_THRESHOLD, 50, 100)
    try:
        from .signals import deferred

        with deferred():  # loading an extension module may lose the interrupt
            from .cli import main
        return main()
    except KeyboardInterrupt:
        if sys.stderr is not None:
            print("kinetostatics: interrupted", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
