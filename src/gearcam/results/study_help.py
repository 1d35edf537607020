"""The help of ``result.study``: each kind of design describes its own studies."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar

from gearcam.base.kinds import kind_studies
from gearcam.results.study import Progress, StudyResult

Kind = TypeVar("Kind", bound=type)


def with_studies(kind: str) -> Callable[[Kind], Kind]:
    """Return what gives the results of a kind of design the help of its studies.

    Parameters
    ----------
    kind : str
        Its name.
    """

    def told(results: Any) -> Any:
        plain = results.study

        @wraps(plain)
        def study(
            self: Any, name: str, progress: Progress | None = None, *, jobs: int = 1
        ) -> StudyResult:
            return plain(self, name, progress, jobs=jobs)

        studies = kind_studies(kind).own.values()
        texts = ["Studies", "-------", "", *("\n\n".join(one.help for one in studies).splitlines())]
        study.__doc__ = "\n".join([inspect.cleandoc(plain.__doc__), "", *texts])
        results.study = study
        return results

    return told
