"""``python -m gearcam``, and the command: interrupted well even while it is loaded."""

import sys


def main() -> int:
    """Run the command line of this process and return its exit code."""
    try:
        from gearcam.cli import main as run
    except KeyboardInterrupt:  # while it is loaded
        sys.stderr.write("interrupted: nothing was done\n")
        return 130
    return run()


if __name__ == "__main__":
    raise SystemExit(main())
