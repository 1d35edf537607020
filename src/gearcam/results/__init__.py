"""Results: everything computed from a design on demand, its files, studies and remedies.

- `result`: the stages, facts, charts, solids and files of a design; `written`: what was written.
- `study`: the outcome of a further computation on a result, as data that can be written.
- `advice`: the search for changes that make a refused design, or one with errors, work.
- `accuracy`: error against run time. A *ladder* (`ladders`) computes one stage of a design at
  several levels; a *rung* is one measured level: error, median run time, number of points.

Depends on designs, export and pictures.
"""
