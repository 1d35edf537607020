"""The live view: the page of a design file, updated when the file or a slider in the page changes.

A *watch* detects that the file, or a table that it reads, was saved. A *session* has the design
built by *workers*, separate processes, and keeps the last valid *document* (see
`gearcam.report.page`) together with the errors since. A *draft* is a document that can be made ten
times a second: coarser chords, no charts. Numbers of the file have sliders: a changed number is
first tried in the page, and written into the file, with comments and order kept, only when the user
saves it. A *server* serves the page to this computer only.

Inputs are a design file and requests of the page; outputs are the page, its documents, and the file
with changed numbers. Values are in the units of the file.

Refused: a missing file, a port in use; requests from other pages or computers, without the token,
that are too long or for other paths; values that are not numbers of the file; saving if the file
has changed meanwhile or would not be a valid design.

Depends on the report, on designs and, for its texts, on the console.
"""
