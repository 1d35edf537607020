"""Sweeps: thousands of variants of one design, each measured by its facts, and the best of them.

A *sweep* gives values to keys of a design: lists, ranges, or distributions that are sampled. Each
combination is a *variant* with a number. A variant is built in another process and leaves a *row*:
its values, facts, findings or refusal, and the time it took. Rows are appended to a *log* as they
come; a sweep that was ended goes on from its log.

============ ====================================================================
`axes`       what is written for a key: values, a range, a distribution
`plan`       which variants there are: a grid or samples
`rows`       one variant built and measured
`engine`     what is missing in the log, built by an engine
`pool`       the engine of this machine: processes, each with limits of time and memory
`cluster`    the engine of dask.distributed
`log`        the rows that are there
`tables`     ``sweep.csv`` and Parquet
`page`       ``sweep.html``
`methods`    where an optimizer looks next
============ ====================================================================

Inputs are a design file and settings as typed, or the table ``[sweep]`` of the file; outputs are
``sweep.log``, ``sweep.csv``, ``sweep.parquet`` and ``sweep.html`` in a folder.

Refused before anything is built: keys that do not exist, ranges without a step in a grid, more than
a million variants, addresses at which nothing answers, and the log of another sweep.

Depends on results and designs; the page on the report.
"""
