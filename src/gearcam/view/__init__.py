"""The live view: the page of a design file, which follows the file and sliders in the page.

A *watch* sees that the file, or a table that it reads, has been saved. A *session* then has the
design built by *workers*, processes of their own, and keeps the last page's *document* that could
be made (see `gearcam.report.page`), with what is wrong since. A *draft* is a document that can be
made ten times a second: coarser chords, no charts. A *number* of the file is one that a slider may
change: *tried* in the page first, and written into the file, whose comments and order stay, only
when the page asks to save it. A *server* gives the page, and only it, to this computer alone.

Inputs are a design file and requests of the page; outputs the page, its documents, and the file
with other numbers. Values are in the units of the file.

Refused: a file that is not there, a port that is taken; requests from elsewhere, without the
token, of more than a few kilobytes, for anything but the page's own; a value that is no number of
the file; saving where the file has changed since, or would not read as a design.

Depends on the report, on designs and, for its words, on the console.
"""
