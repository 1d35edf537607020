"""The processes that build designs for the live view, started anew when one of them was killed."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from functools import partial
from multiprocessing import active_children, get_context
from typing import Any, Final, ParamSpec, TypeVar

from gearcam.view.work import begin

_P = ParamSpec("_P")
_T = TypeVar("_T")

COUNTS: Final = range(2, 5)
"""Number of workers: drafts overlap with other builds, but more than four do not help."""


class Workers(Executor):
    """Workers, each a process; what one did that was killed is done once more by others.

    The system kills a process, for example, where memory is short. All workers end then.
    """

    def __init__(self) -> None:
        self.count = min(max(os.cpu_count() or 1, COUNTS.start), COUNTS.stop - 1)
        self._lock = threading.Lock()
        self._ended = False
        self._pool = self._started()

    def _started(self) -> ProcessPoolExecutor:
        context = get_context("spawn")  # threads of a server do not survive a fork
        return ProcessPoolExecutor(self.count, mp_context=context, initializer=begin)

    def submit(self, fn: Callable[_P, _T], /, *args: _P.args, **kwargs: _P.kwargs) -> Future[_T]:
        """Return the future of a call in a worker.

        Parameters
        ----------
        fn : callable
            The function, of a module.
        *args, **kwargs
            Its arguments.

        Returns
        -------
        Future
            It fails with `BrokenExecutor` if the worker is killed twice.
        """
        answer: Future[_T] = Future()
        self._try(answer, partial(fn, *args, **kwargs), None)
        return answer

    def _try(self, answer: Future[_T], call: Callable[[], _T], lost: Executor | None) -> None:
        """Have a worker do what the workers `lost` did not do."""
        with self._lock:
            # of the lost ones nothing may be asked: they are about to end
            if self._pool is lost and not self._ended:
                self._pool = self._started()
            pool = self._pool
            try:
                done = pool.submit(call)
            except BrokenExecutor:
                pool = self._pool = self._started()
                done = pool.submit(call)
        done.add_done_callback(partial(self._take, answer, call, None if lost else pool))

    def _take(
        self,
        answer: Future[_T],
        call: Callable[[], _T],
        again: Executor | None,
        done: Future[_T],
    ) -> None:
        """Hand on an outcome; where `again` was lost with the call it is tried once more."""
        if done.cancelled():
            answer.cancel()
        elif (error := done.exception()) is None:
            answer.set_result(done.result())
        elif isinstance(error, BrokenExecutor) and again and not self._ended:
            self._try(answer, call, again)
        else:
            answer.set_exception(error)

    def end(self) -> None:
        """End all whatever they are doing: one that is still building would delay the exit."""
        with self._lock:
            self._ended = True
        replies: Any = vars(self._pool)["_result_queue"]
        self._pool.shutdown(wait=False, cancel_futures=True)
        for worker in active_children():
            worker.kill()
        # the rest of a reply that one was writing is waited for as long as the pipe has a writer:
        # here
        replies._writer.close()
