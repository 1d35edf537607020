"""Studies of the program itself: the accuracy of a result against its run time.

A *ladder* computes one stage of a design at several levels (see `gearcam.ladders`); a *rung* is one
measured level: error, median run time, number of points. `accuracy` measures the ladders of a
result, `commands` is the command line, and `svg` draws error against run time on logarithmic axes.

Inputs are a `gearcam.result.Result`, names of stages and a number of runs. Outputs are rungs, with
errors in the unit of their ladder (mm, rad, deg, mm3, 1/mm) and times in s, and from them a table,
``accuracy.csv`` and ``accuracy.svg``. The stages are defined by each kind of design.

Refused: stages that a kind does not have, and fewer than one run. A design that cannot be made
raises the error of its stage. A level that cannot be computed is left out, with the reason.

Depends on ladders, results and export.
"""
