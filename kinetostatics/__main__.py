"""The command line, as ``kinetostatics`` and ``python -m kinetostatics`` start it."""

import sys


def main():
    """Run the command line; returns the exit status. Ctrl-C ends it in the same way while its libraries are loaded."""
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
