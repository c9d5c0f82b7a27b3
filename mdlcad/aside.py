"""A call in a process of its own, beside what this one does meanwhile."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable
from contextlib import suppress
from multiprocessing.connection import Connection, wait
from types import TracebackType
from typing import Any, Generic, TypeVar

Result = TypeVar("Result")


class Aside(Generic[Result]):
    """``call(*arguments)`` under way; all of them must be such that they can be sent to another process.

    Leaving its context ends the process, wherever it is; and the process ends by itself when this one does, however it
    ends.
    """

    def __init__(self, call: Callable[..., Result], *arguments: object) -> None:
        # a child that was forked would share the threads and the CAD kernel of this process
        context = multiprocessing.get_context("spawn")
        self._ours, theirs = context.Pipe()
        self._process = context.Process(target=_work, args=(theirs,), daemon=True)
        self._process.start()
        theirs.close()
        # the child takes seconds to load what the arguments are made of
        self._sender = threading.Thread(target=self._send, args=(call, arguments), daemon=True)
        self._sender.start()

    def __enter__(self) -> Aside[Result]:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.stop()

    def _send(self, call: Callable[..., Result], arguments: tuple[object, ...]) -> None:
        with suppress(OSError):  # a child that has ended is told of by result()
            self._ours.send((arguments, call))

    def result(self) -> Result:
        """What the call returns; waits for it.

        Raises:
            RuntimeError: the process ended before it had one (killed from outside, or out of memory).
            Exception: what the call raised.
        """
        self._sender.join()
        try:
            value, error = self._ours.recv()
        except (EOFError, OSError):
            self._process.join()
            raise RuntimeError(f"a process of this build ended with code {self._process.exitcode}") from None
        if error is not None:
            raise error
        found: Result = value
        return found

    def stop(self) -> None:
        """End the process, if it still runs."""
        self._process.kill()
        self._process.join()
        self._sender.join()
        self._ours.close()


def _work(pipe: Connection[Any, Any]) -> None:
    # an interrupt from the keyboard reaches all processes; what this one is to do then, the other decides
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    value, error = None, None
    try:
        arguments, call = pipe.recv()
        value = call(*arguments)
    except Exception as problem:
        error = problem
    pipe.send((value, error))


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(1)
