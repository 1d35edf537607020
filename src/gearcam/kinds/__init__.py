"""The kinds of design: each a folder that holds all that only it needs.

What a folder has, and how it is found, `gearcam.designs.kind` says; nothing outside this package
names one of them.
"""
