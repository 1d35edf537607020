"""The report: one page that shows what was made, how it moves, and how accurate it is.

A *page* is one HTML file that opens without a network. It holds *blocks*, HTML written from the
facts and findings of a result; the *scene* and the *charts* (see `gearcam.pictures`), data that the
page's script draws; and the *solids*, a view in three dimensions.
It shows the same facts and arrays that Python users get. Verdict, picture, findings, the first
charts and those of studies are in sight; the rest is folded. Without a scene or solids their
sections are left out. The folder of each kind of design defines its scene and its charts.

Input is a `gearcam.Result`, output text. The page's data are in mm and rad, positions of the
driver in the unit of its axis. uPlot, included as published, draws the charts; ``page.js`` and the
scripts beside it draw the rest.

Refused: nothing of its own; a design that cannot be made raises the errors of its stages.

Depends on scenes, charts and facts; jinja2, imported when a page is made.
"""
