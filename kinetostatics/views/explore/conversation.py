"""Requests of one page and their answers, sent in parts when ready; a newer request cancels older ones."""

import asyncio
import contextlib

from ..page import packed
from .session import OF_NEWEST

PAUSE = 0.05
"""Time until a part that is not ready is asked for again, s."""


class Conversation:
    """Answers each request of a page; results for an older state are not sent once a newer state is requested.

    `send` is called with the header and the buffers of each answer, as `packed` gives them.
    """

    def __init__(self, session, send):
        self.session, self._send = session, send
        self._tasks: dict[str, asyncio.Task] = {}

    def answer(self, request):
        """Answer a request: at once, or part by part in a task of the running event loop."""
        kind = request.get("kind")
        found = self.session.answer(request)
        self._drop(OF_NEWEST if kind in ("look", "drag") else [kind])
        if isinstance(found, dict):
            self._send(*packed(found))
        else:
            self._tasks[kind] = asyncio.ensure_future(self._send_parts(found))

    def end(self):
        """Cancel all answers that are not ready."""
        self._drop(list(self._tasks))

    def _drop(self, kinds):
        for kind in kinds:
            if task := self._tasks.pop(kind, None):
                task.cancel()

    async def _send_parts(self, answers):
        with contextlib.closing(answers):
            for answer in answers:
                if answer:
                    self._send(*packed(answer))
                await asyncio.sleep(0 if answer else PAUSE)
