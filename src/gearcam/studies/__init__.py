"""Studies of what the program itself does: how exact a result is, and what that costs.

A *ladder* makes one stage of a design at several levels (see `gearcam.ladders`); a *rung* is one
level of it, measured: error, median run time, points. `accuracy` climbs the ladders of a result in
turns, `commands` brings it to the command line, and `svg` draws it: error against run time, both
logarithmic.

Inputs are a `gearcam.result.Result`, names of stages and a number of repeats; outputs are rungs,
with errors in the unit of their ladder (mm, rad, deg, mm3, 1/mm) and times in s, and from them a
table, ``accuracy.csv`` and ``accuracy.svg``. Which stages there are, and how they are refined, each
kind of design says; nothing here names one.

Refused: stages that a kind does not have, fewer than one repeat; a design that cannot be made
raises as its stages do. A level at which nothing can be made is left out by name.

Depends on ladders, results and export.
"""
