"""What every other package uses: errors, findings, facts, numbers as text, units, registries.

- `errors`: `DesignError` (a mistake in a design), `InfeasibleError` (a design that cannot be made),
  `WriteError` (the disk); `findings`: remarks about a design that can be built, and the registry
  of checks.
- `quantities` and `tolerances`: units of parameters, where degrees become radians, and the accuracy
  of internal computations; `numerals`: how numbers are printed and written into files.
- `inches`: designs, messages and files in inches.
- `facts`: the quantities of a result as a tree; `changes`: values of a change between two ends.
- `display`: objects as one line of text or, in notebooks, as a picture with facts.
- `registry`: entries that are loaded when they are used; `kinds`: names and studies of the kinds of
  design; `reading`: files read whole and within limits; `interrupts`: signals, and code that they
  must not interrupt.

Depends on no other package.
"""
