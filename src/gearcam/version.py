"""The version of the program."""

__version__ = "0.1.0"


def versions() -> dict[str, str]:
    """Return versions of what makes numbers: the program, Python, libraries loaded so far."""
    import platform
    import sys

    found = {"gearcam": __version__, "python": platform.python_version()}
    for name in ("numpy", "shapely", "ezdxf", "manifold3d", "trimesh"):
        module = sys.modules.get(name)
        if module is not None and hasattr(module, "__version__"):
            found[name] = str(module.__version__)
    return found
