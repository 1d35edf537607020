"""Make the pictures of the home page of the docs from designs: `python tools/gallery.py`.

Each is the picture of a report at a place of its driver, or of its solids. It needs what
tools/picture.py needs.
"""

from __future__ import annotations

import base64
import io
import shutil
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image, ImageChops
from selenium.webdriver import Chrome
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

from picture import PICTURES, PROFILES, report, taken

HOME = PICTURES / "home"
SIZE = (480, 320)
"""Width and height of a picture, pixels: twice what the page gives it."""
MARGIN = 12
FRAME = 4
"""Width of the frame around solids, pixels."""
SHOWN = {
    "ellipse": 40.0,
    "nautilus": 30.0,
    "nail_machine_two_phase": 118.0,
    "ring_ellipse": 60.0,
    "plate_cam_offset_roller": 60.0,
    "groove_cam": 60.0,
    "conjugate_cams": 60.0,
    "four_bar": 60.0,
    "geneva": 20.0,
    "nail_machine_slide": 110.0,
}
"""Places of the driver by profile."""
SOLID = {"cylinder_cam": 60.0, "globoidal_indexer": 30.0}
"""Those that are shown as solids."""

_DRAWN = """
const [place, width, height, done] = arguments;
gearcam.go(place);
const picture = new Image();
picture.onload = () => {
  const canvas = Object.assign(document.createElement("canvas"), { width, height });
  const pen = canvas.getContext("2d");
  pen.fillStyle = "white";
  pen.fillRect(0, 0, width, height);
  const scale = Math.min(width / picture.width, height / picture.height);
  const [w, h] = [scale * picture.width, scale * picture.height];
  pen.drawImage(picture, (width - w) / 2, (height - h) / 2, w, h);
  done(canvas.toDataURL("image/png").split(",")[1]);
};
picture.src = URL.createObjectURL(new Blob([gearcam.svg()], { type: "image/svg+xml" }));
"""


def opened() -> Chrome:
    """Return a browser without a window."""
    flags = Options()
    flags.binary_location = shutil.which("chromium") or sys.exit("there is no chromium")
    for flag in ("--headless=new", "--no-sandbox", "--hide-scrollbars"):
        flags.add_argument(flag)
    return Chrome(options=flags, service=Service(shutil.which("chromedriver")))


def fitted(content: bytes, frame: int = 0) -> bytes:
    """Return a picture, PNG, without its frame and the ground around it, in the size of all."""
    picture = Image.open(io.BytesIO(content)).convert("RGB")
    picture = picture.crop((frame, frame, picture.width - frame, picture.height - frame))
    ground = Image.new("RGB", picture.size, picture.getpixel((0, 0)))
    picture = picture.crop(ImageChops.difference(picture, ground).getbbox())
    width, height = SIZE
    scale = min((width - 2 * MARGIN) / picture.width, (height - 2 * MARGIN) / picture.height)
    picture = picture.resize(
        (round(scale * picture.width), round(scale * picture.height)), Image.Resampling.LANCZOS
    )
    sheet = Image.new("RGB", SIZE, ground.getpixel((0, 0)))
    sheet.paste(picture, ((width - picture.width) // 2, (height - picture.height) // 2))
    small = io.BytesIO()
    sheet.quantize(64, dither=Image.Dither.NONE).save(small, "PNG", optimize=True)
    return small.getvalue()


def main() -> None:
    """Write all pictures."""
    HOME.mkdir(exist_ok=True)
    with TemporaryDirectory() as folder:
        browser = opened()
        try:
            for name, place in SHOWN.items():
                browser.get(report(PROFILES / f"{name}.toml", str(Path(folder, name))))
                drawn = browser.execute_async_script(_DRAWN, place, 4 * SIZE[0], 4 * SIZE[1])
                (HOME / f"{name}.png").write_bytes(fitted(base64.b64decode(drawn)))
        finally:
            browser.quit()
        for name, place in SOLID.items():
            page = report(PROFILES / f"{name}.toml", str(Path(folder, name)))
            shot = taken(page, place, (1100, 4000), solid=True)
            (HOME / f"{name}.png").write_bytes(fitted(shot, FRAME))


if __name__ == "__main__":
    main()
