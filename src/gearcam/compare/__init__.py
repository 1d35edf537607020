"""Variants side by side: a table of facts, and one page with their curves and outlines.

Variants are design files of one kind, or one file with other values of some keys. What they are
told by is what every result tells: facts, findings, charts, scenes. Nothing here knows what they
are of.

Inputs are design files and settings as they are typed; outputs lines of text, and a page.

Refused: settings that cannot be read, designs of different kinds, one variant only, and too many
to be seen side by side. A variant that cannot be made is told with its reason.

Depends on the report; through it on all that results need.
"""
