"""The command ``report``: one page of a case, and the same printed to a PDF."""

import shlex
import sys

from ..views.report.making import report as write


def report(options):
    variant = ["--variant", options.variant] if options.variant else []
    pdf = ["--pdf", options.pdf] if options.pdf else []
    command = shlex.join(["kinetostatics", "report", options.case, "--out", options.out, *variant, *pdf])
    bar = sys.stderr is not None and sys.stderr.isatty()
    path = write(options.case, options.out, variant=options.variant, pdf=options.pdf, command=command, progress=bar)
    print(f"wrote {path}; open it in a browser")
    if options.pdf:
        print(f"wrote {options.pdf}")
