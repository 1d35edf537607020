"""``python -m gearcam``, and the command: interrupted well even while it is loaded."""

import os
import sys


def main() -> int:
    """Run the command line of this process and return its exit code."""
    # No array here is worth the threads of linear algebra; those that wait take the others' time.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # read when numpy is loaded
    try:
        from gearcam.cli import main as run

        return run()
    except KeyboardInterrupt:  # before the command line answers it, or after
        sys.stderr.write("interrupted\n")
        return 130


if __name__ == "__main__":
    raise SystemExit(main())
