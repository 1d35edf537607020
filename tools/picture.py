"""Make the pictures of README and docs from designs: `python tools/picture.py`.

It needs chromium with its driver (tools/browser installs them), and pillow, which comes with
matplotlib.
"""

from __future__ import annotations

import base64
import io
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pypdfium2
from PIL import Image
from selenium.webdriver import Chrome
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

import gearcam
from gearcam.export.svg import svg_bytes
from gearcam.parts.shapes import Circle
from gearcam.pictures.drawings import (
    CENTER,
    FOLLOWER,
    GROUND,
    OUTLINE,
    TRACE,
    Cross,
    Drawing,
    Feature,
)
from gearcam.pictures.drawings import (
    Path as Line,
)
from gearcam.pictures.labels import Label

ROOT = Path(__file__).resolve().parents[1]
PROFILES = ROOT / "profiles"
PICTURES = ROOT / "docs" / "pictures"
PROFILE = PROFILES / "nail_machine_two_phase.toml"
PICTURE = ROOT / "docs" / "nail_machine_two_phase.png"
SIZE = (1280, 900)
"""Width and height, pixels."""
PLACE = 118.0
"""Driver angle in the picture, deg."""
DRAWN = {
    "ellipse_pair": ("ellipse", 640),
    "nautilus": ("nautilus", 560),
    "disc_cam": ("plate_cam_offset_roller", 420),
    "groove_cam": ("groove_cam", 420),
    "conjugate_cams": ("conjugate_cams", 420),
    "yoke_cam": ("yoke_cam", 420),
    "translating_cam": ("translating_cam", 640),
    "cylinder_cam": ("cylinder_cam", 640),
    "globoidal_cam": ("globoidal_indexer", 640),
    "four_bar": ("four_bar", 480),
    "nail_machine_slide": ("nail_machine_slide", 720),
}
"""Pictures of assembled parts: profile, and width in pixels."""

ORDERED = "shop_order"
"""Profile of the pictures of what is measured, and of a workshop drawing."""

FITS = {
    "blank.bore_diameter_mm": ["25 H7", "20 H7"],
    "blank.keyway_width_mm": ["8 JS9", "6 JS9"],
    "blank.keyway_depth_mm": [3.3, 2.8],
}
"""What its drawing has beside the table in docs/drawings.md."""


_PLACE_OF_SOLIDS = """
const frame = document.querySelector("#solids iframe");
const box = frame.getBoundingClientRect();
return {x: box.x, y: box.y, width: box.width, height: box.height, scale: 1};
"""


def taken(url: str, place: float, size: tuple[int, int] = SIZE, *, solid: bool = False) -> bytes:
    """Return a screenshot of a page that shows a place of the driver, deg, PNG.

    Of its top, or of its solids.
    """
    flags = Options()
    flags.binary_location = shutil.which("chromium") or sys.exit("there is no chromium")
    drawing = ("--enable-unsafe-swiftshader", "--use-gl=angle", "--use-angle=swiftshader")
    for flag in ("--headless=new", "--no-sandbox", "--hide-scrollbars", *drawing * solid):
        flags.add_argument(flag)
    browser = Chrome(options=flags, service=Service(shutil.which("chromedriver")))
    try:
        width, height = size
        metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
        browser.get(url)
        wait = "const done = arguments[0]; setTimeout(() => requestAnimationFrame(done), 2000)"
        browser.execute_async_script(wait)  # a live view builds its charts
        browser.execute_script("gearcam.go(arguments[0])", place)
        browser.execute_async_script(wait)  # charts are drawn a few at a time
        options: dict[str, object] = {"format": "png"}
        if solid:
            browser.execute_script("document.querySelector('#solids details').open = true")
            for _ in range(4):  # the view loads its data itself
                browser.execute_async_script(wait)
            options["clip"] = browser.execute_script(_PLACE_OF_SOLIDS)
        shot = browser.execute_cdp_cmd("Page.captureScreenshot", options)["data"]
        picture = Image.open(io.BytesIO(base64.b64decode(shot))).convert("RGB")
        small = io.BytesIO()
        picture.quantize(128, dither=Image.Dither.NONE).save(small, "PNG", optimize=True)
        return small.getvalue()
    finally:
        browser.quit()


def report(profile: Path, folder: str) -> str:
    """Return the address of the report of a profile, written into a folder."""
    written = gearcam.build(gearcam.load(profile)).write(folder, files=["report"])
    return (written.directory / "report.html").as_uri()


def live_view(folder: str) -> bytes:
    """Return a screenshot of the live view of a pair for a laser."""
    run = (sys.executable, "-m", "gearcam")
    design = Path(folder, "my_pair.toml")
    subprocess.run([*run, "new", "gear-pair", str(design), "--for", "laser"], check=True)
    shown = [*run, "view", str(design), "--no-browser"]
    with subprocess.Popen(shown, stdout=subprocess.PIPE, text=True) as view:
        try:
            line = view.stdout.readline() if view.stdout else ""
            (url,) = re.findall(r"http://\S+", line)
            return taken(url, 60.0, (1500, 950))
        finally:
            view.terminate()


def drawn(profile: Path, width: int, folder: str) -> str:
    """Return the picture of assembled parts, SVG."""
    written = gearcam.build(gearcam.load(profile)).write(folder, files=["svg"])
    (name,) = [name for name in written.files if name.endswith(".svg")]
    return sized((written.directory / name).read_text("utf-8"), width)


def sized(text: str, width: int) -> str:
    """Return a picture, SVG, that is so many pixels wide."""
    (size,) = re.findall(r'width="(\d+)" height="(\d+)" role', text)
    height = round(width * int(size[1]) / int(size[0]))
    return re.sub(r'width="\d+" height="\d+" role', f'width="{width}" height="{height}" role', text)


def measured(profile: Path) -> str:
    """Return a picture of pins and of the jaws of all spans on the driver of a pair, SVG."""
    gear = gearcam.build(gearcam.load(profile)).gear1
    diameter, pins = gear.measuring.pins()
    spans, module = gear.measuring.spans, gear.pair.module
    features = [
        Feature(layer=OUTLINE, shape=gear.profile.contour, metal=True),
        Feature(layer=CENTER, shape=Cross(center=0j, size=2.0 * module)),
    ]
    opposite, third = int(pins.opposite[0]), 3 * len(pins.center) // 8
    for space in (0, opposite, third):
        center = complex(pins.center[space])
        features.append(Feature(layer=FOLLOWER, shape=Circle(center=center, diameter=diameter)))
    across = pins.center[[0, opposite]]
    features.append(Feature(layer=TRACE, shape=Line(points=across, closed=False)))
    beside = complex(pins.center[third] * (1.0 + 2.2 * module / abs(pins.center[third])))
    labels = [Label(f"pin {diameter:g}", beside, 0.9 * module)]
    for place in sorted(set(spans.place)):
        number = int(np.flatnonzero(spans.place == place)[0])
        last, first = spans.contact[:, number]
        normal = (last - first) / abs(last - first)
        jaw = gear.toothing.turn * normal * module
        for contact in (last, first):
            ends = contact + np.array([-1.0, 3.5]) * jaw
            features.append(Feature(layer=GROUND, shape=Line(points=ends, closed=False)))
        line = np.array([first, last]) + 3.0 * jaw
        features.append(Feature(layer=TRACE, shape=Line(points=line, closed=False)))
        text = f"{spans.reading[number]:.3f}"
        labels.append(Label(text, complex(line.mean() + 0.9 * jaw), 0.9 * module))
    labels.append(
        Label(f"{pins.over[0]:.3f}", complex(across.mean() + 1.2j * module), 0.9 * module)
    )
    drawing = Drawing(name="measuring", features=tuple(features))
    title = "Over two pins, and the four spans of an ellipse, mm"
    return sized(svg_bytes(drawing, title=title, labels=labels).decode(), 560)


def sheet(profile: Path, folder: str) -> bytes:
    """Return the workshop drawing of the driver of a pair as in docs/drawings.md, PNG."""
    (block,) = re.findall(r"```toml\n(.*?)```", (ROOT / "docs/drawings.md").read_text(), re.DOTALL)
    notes = {f"drawing.{key}": value for key, value in tomllib.loads(block)["drawing"].items()}
    made = gearcam.build(gearcam.load(profile).with_({**FITS, **notes}))
    written = made.write(folder, files=["drawing-pdf"])
    (page,) = pypdfium2.PdfDocument(written.directory / "gear1_drawing.pdf")
    small = io.BytesIO()
    page.render(scale=2, grayscale=True).to_pil().quantize(8).save(small, "PNG", optimize=True)
    return small.getvalue()


if __name__ == "__main__":
    with TemporaryDirectory() as folder:
        PICTURE.write_bytes(taken(report(PROFILE, folder), PLACE))
        cam = report(PROFILES / "plate_cam_offset_roller.toml", folder)
        (PICTURES / "report.png").write_bytes(taken(cam, 60.0, (1500, 950)))
        drum = report(PROFILES / "cylinder_cam.toml", folder)
        (PICTURES / "cylinder_cam.png").write_bytes(taken(drum, 60.0, (1100, 4000), solid=True))
        table = report(PROFILES / "globoidal_indexer.toml", folder)
        (PICTURES / "globoidal_cam.png").write_bytes(taken(table, 30.0, (1100, 4000), solid=True))
        (PICTURES / "live_view.png").write_bytes(live_view(folder))
        ordered = PROFILES / f"{ORDERED}.toml"
        (PICTURES / "drawing.png").write_bytes(sheet(ordered, folder))
        picture = measured(ordered)
        (PICTURES / "measuring.svg").write_text(picture, "utf-8")
        for name, (profile, width) in DRAWN.items():
            picture = drawn(PROFILES / f"{profile}.toml", width, folder)
            (PICTURES / f"{name}.svg").write_text(picture, "utf-8")
