"""Comparison of variants: a table of facts, and a page with their curves and outlines.

Variants are design files of one kind, or one file with different values of some keys. They are
compared by facts, findings, charts and scenes, which every result has.

Inputs are design files and settings as typed on the command line; outputs are lines of text and a
page.

Refused: settings that cannot be read, designs of different kinds, a single variant, and too many
variants. A variant that cannot be made is listed with the reason.

Depends on the report; through it on all that results need.
"""
