"""Results: everything computed from a design on demand, its files, studies and remedies.

- `kind`: what a kind of design is; `studies`: what it says of its studies.
- `staged`: a design with its stages, which are timed; `study`: the outcome of a study; `result`:
  facts, charts and files of a design and its studies; `parts`: drawings and solids of designs of
  which parts are made; `nested`: refusals and findings of a design within another; `table_rows`:
  those of the rows of tables; `written`: the summary, and what is written with it.
- `advice`: the search for changes that make a refused design, or one with errors, work.
- `accuracy`: error against run time. A *ladder* (`ladders`) computes one stage of a design at
  several levels; a *rung* is one measured level: error, median run time, number of points.

Depends on designs, export and pictures.
"""
