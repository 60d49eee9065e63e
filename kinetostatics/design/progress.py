"""Progress of searches on the screen: a bar that counts the optimiser's steps."""

from contextlib import contextmanager

SHOWN_AFTER = 1.0
"""Seconds of work after which a bar appears."""


@contextmanager
def moving_bar(problem, wanted=True, label=None):
    """Within the block, steps of searches of a problem move a bar, if one is wanted."""
    from tqdm import tqdm

    with tqdm(desc=label, unit=" steps", delay=SHOWN_AFTER, leave=False, disable=not wanted) as bar:
        problem.stepped = lambda *_: bar.update()
        yield
    problem.stepped = no_bar


def no_bar(*_):
    """What steps move where none is shown."""
