"""``python -m gearcam``: the command line."""

from gearcam.cli import main

raise SystemExit(main())
