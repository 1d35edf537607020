"""The report: one page that shows what was made, how it moves, and why to trust it.

A *page* is one HTML file that opens without a network. It holds *blocks*, HTML written from the
facts and findings of a result; the *scene* (see `gearcam.scenes`) and the *charts* (see
`gearcam.charts`), data that the page's own script draws; and the *solids*, a view in three
dimensions. All that it says is facts; all that it draws are the arrays that Python users get. A
kind of design makes its scene and its charts; nothing here knows what they tell of.

Inputs are a `gearcam.result.Result`; outputs text. In: mm, deg and rad as the names say; the
page's data are in mm and rad, and the driver's place in the unit of its axis.

What draws charts is uPlot, whose folder is its package as it was published; what moves the parts is
``page.js``.

Refused: nothing of its own; a design that cannot be made raises as its stages do.

Depends on scenes, charts and facts; jinja2, which loads with a page and not before.
"""
