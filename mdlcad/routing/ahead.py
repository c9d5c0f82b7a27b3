"""Work begun ahead of its turn on the processors there are, and taken strictly in turn.

So a search comes to the same result for any number of workers: what it would not have come to is thrown away.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from types import TracebackType
from typing import TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")


def _all(item: object) -> bool:
    return True


class Ahead:
    """Threads for compiled kernels and solvers, which let go of the interpreter.

    Leaving its context waits for nothing: what still runs has no effect on anything.
    """

    def __init__(self, workers: int) -> None:
        self._pool, self.workers = ThreadPoolExecutor(workers), workers

    def __enter__(self) -> Ahead:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self._pool.shutdown(wait=False, cancel_futures=True)

    def each(
        self, items: Iterable[Item], work: Callable[[Item], Result], wanted: Callable[[Item], bool] = _all
    ) -> Iterator[tuple[Item, Result]]:
        """Every item with what ``work`` makes of it, in order; as many at once as there are workers.

        Args:
            wanted: whether an item is still of interest when its turn comes; one that is not is left out. What was of
                none before must stay so.
        """
        waiting = iter(items)
        begun: deque[tuple[Item, Future[Result]]] = deque()
        try:
            while True:
                while len(begun) < self.workers:
                    item = next((item for item in waiting if wanted(item)), None)
                    if item is None:
                        break
                    begun.append((item, self._pool.submit(work, item)))
                if not begun:
                    return
                item, future = begun.popleft()
                if wanted(item):
                    yield item, future.result()
        finally:
            for _, future in begun:
                future.cancel()
