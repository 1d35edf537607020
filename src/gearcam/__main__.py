"""``python -m gearcam`` and the command ``gearcam``."""

import os
import sys


def main() -> int:
    """Run the command line of this process and return its exit code."""
    # Arrays are too small for threads of linear algebra, and waiting threads cost processor time.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # read when numpy is imported
    try:
        from gearcam.cli import main as run

        return run()
    except KeyboardInterrupt:  # while the command line is imported, or after it
        sys.stderr.write("interrupted\n")
        return 130


if __name__ == "__main__":
    raise SystemExit(main())
