// The parts in motion on a canvas: drawing, zoom and pan.

const LEVELS = 10; // colours of a scale of values

// Colours by name from the style sheet; on paper the light ones.
function palette(paper = false) {
  const root = document.documentElement;
  const before = root.classList.contains("paper");
  root.classList.toggle("paper", paper || before);
  const style = getComputedStyle(root);
  const names = ["ground", "text", "muted", "rule", "contact", "pitch", "centrode", "limit",
    "accent"];
  for (const k of [1, 2, 3]) names.push(`fill-${k}`, `ink-${k}`, `floor-${k}`, `carry-${k}`);
  for (const k of [1, 2, 3, 4, 5, 6]) names.push(`line-${k}`);
  for (let k = 1; k <= LEVELS; k++) names.push(`level-${k}`);
  const colours = Object.fromEntries(
    names.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]),
  );
  root.classList.toggle("paper", before);
  return colours;
}

const traced = new WeakMap(); // paths of chains with the step that they were traced with
const STEP = 0.35; // pixels: points that are closer are merged
const SMALLEST = 0.6; // share of the view that a changed scene fills, or the view changes
const NARROW = 500; // pixels: on a narrower picture contacts are marked smaller

// Outlines have many points and never change; zoomed out, few of the points suffice.
function pathOf({ chains, closed }, dot) {
  const step = 2 ** Math.floor(Math.log2(STEP * dot)); // seldom changes with the zoom
  const known = traced.get(chains);
  if (known?.step === step) return known.path;
  const path = new Path2D();
  for (const points of chains) {
    trace(path, points, step);
    if (closed) path.closePath();
  }
  traced.set(chains, { path, step });
  return path;
}

function trace(path, points, step) {
  let [x, y] = points;
  path.moveTo(x, y);
  for (let k = 2; k < points.length; k += 2) {
    const near = Math.abs(points[k] - x) < step && Math.abs(points[k + 1] - y) < step;
    if (near && k < points.length - 2) continue;
    [x, y] = [points[k], points[k + 1]];
    path.lineTo(x, y);
  }
}

class Parts {
  constructor(canvas, moved, resized) {
    this.canvas = canvas;
    this.moved = moved; // called when the user moves the view
    this.resized = resized; // called when the box changes, before it is shown
    this.fitted = true;
    this.following = false;
    this.touches = new Map();
    this.tool = null; // is offered what the pointer does before the view is moved
    this.held = null; // the pointer that the tool has taken
    this.view = { x: 0, y: 0, scale: 1 }; // centre, mm, and pixels per mm
    new ResizeObserver(() => this.resize()).observe(canvas);
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.drag(event));
    for (const name of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(name, (event) => this.up(event));
    }
  }

  // Where a pointer is, mm, and how many mm a pixel has.
  spotOf({ offsetX, offsetY }) {
    const { width, height } = this.size;
    const { x, y, scale } = this.view;
    return {
      x: x + (offsetX - 0.5 * width) / scale, y: y - (offsetY - 0.5 * height) / scale,
      pixel: 1 / scale,
    };
  }

  // The view stays where it is while a tool holds something in it, or a changed scene fits.
  set scene(scene) {
    const before = this.own;
    this.own = scene;
    if (this.held !== null || (before && this.fitted && this.fits)) return;
    const [left, bottom, right, top] = scene.box;
    const shape = (right - left) / (top - bottom);
    // a scene that is very flat gets a flatter canvas, with room to zoom
    const flat = Math.min(2.2, Math.max(1.35, shape / 2));
    this.canvas.style.setProperty("--own", shape); // which paper gives it
    this.canvas.style.setProperty("--shape", Math.min(flat, Math.max(0.8, shape)));
    if (this.fitted) this.fit();
  }

  // Whether the view shows all of the scene, at a size that is not too small for it.
  get fits() {
    const [left, bottom, right, top] = this.own.box;
    const { width, height } = this.size;
    const { x, y, scale } = this.view;
    const [wide, tall] = [width / scale, height / scale];
    const inside = left > x - 0.5 * wide && right < x + 0.5 * wide
      && bottom > y - 0.5 * tall && top < y + 0.5 * tall;
    return inside && Math.max((right - left) / wide, (top - bottom) / tall) > SMALLEST;
  }

  get size() {
    return { width: this.canvas.clientWidth || 1, height: this.canvas.clientHeight || 1 };
  }

  resize() {
    if (this.own && this.fitted) this.fit();
    this.resized();
  }

  // Show the whole scene at all places.
  fit() {
    const [left, bottom, right, top] = this.own.box;
    const { width, height } = this.size;
    const scale = 0.95 * Math.min(width / (right - left), height / (top - bottom));
    this.view = { x: 0.5 * (left + right), y: 0.5 * (bottom + top), scale };
    this.fitted = true;
    this.following = false;
  }

  // Follow the mesh.
  follow() {
    this.fit();
    this.view.scale *= closer(this.own);
    this.fitted = false;
    this.following = true;
  }

  // Zoom about a point, which stays in place.
  zoom(factor, x = 0.5 * this.size.width, y = 0.5 * this.size.height) {
    const { width, height } = this.size;
    const before = this.view.scale;
    const after = Math.min(1e5, Math.max(1e-3, before * factor));
    this.view.scale = after;
    this.fitted = false;
    const back = 1 - after / before;
    if (!this.following) this.pan((x - 0.5 * width) * back, (y - 0.5 * height) * back);
    this.moved();
  }

  pan(right, down) {
    this.view.x -= right / this.view.scale;
    this.view.y += down / this.view.scale;
    this.fitted = this.following = false;
    this.moved();
  }

  wheel(event) {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 30 : 1;
    this.zoom(Math.exp(-0.002 * lines * event.deltaY), event.offsetX, event.offsetY);
  }

  down(event) {
    if (!this.touches.size && !event.button && this.tool?.take(this.spotOf(event), event)) {
      this.held = event.pointerId;
      this.canvas.setPointerCapture(event.pointerId);
      return;
    }
    this.touches.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    this.canvas.setPointerCapture(event.pointerId);
  }

  up(event) {
    if (this.held === event.pointerId) {
      this.held = null;
      this.tool?.drop();
      this.scene = this.own;
      this.moved();
    }
    this.touches.delete(event.pointerId);
  }

  drag(event) {
    if (this.held === event.pointerId) {
      this.tool?.drag(this.spotOf(event));
      return;
    }
    const before = this.touches.get(event.pointerId);
    if (!before) {
      this.tool?.over(this.spotOf(event), event);
      return;
    }
    const now = { x: event.offsetX, y: event.offsetY };
    const other = [...this.touches].find(([id]) => id !== event.pointerId)?.[1];
    this.touches.set(event.pointerId, now);
    const share = other ? 0.5 : 1; // two fingers move the point between them
    this.pan(share * (now.x - before.x), share * (now.y - before.y));
    if (!other) return;
    const apart = (one) => Math.hypot(one.x - other.x, one.y - other.y) || 1;
    this.zoom(apart(now) / apart(before), 0.5 * (now.x + other.x), 0.5 * (now.y + other.y));
  }

  draw(place, cycles, seen, colours) {
    const ratio = Math.max(window.devicePixelRatio, colours.print ? 3 : 1);
    const { width, height } = this.size;
    const [wide, tall] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.canvas.width !== wide || this.canvas.height !== tall) {
      Object.assign(this.canvas, { width: wide, height: tall });
    }
    if (this.following) Object.assign(this.view, meshAt(this.own, place) ?? {});
    const pen = this.canvas.getContext("2d", { alpha: false });
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.fillStyle = colours.ground;
    pen.fillRect(0, 0, wide, tall);
    pen.lineJoin = "round";
    const { x, y, scale } = this.view;
    const size = scale * ratio;
    const base = [size, 0, 0, -size, 0.5 * wide - size * x, 0.5 * tall + size * y];
    const unit = (width < NARROW ? 0.6 : 1) / scale;
    const edge = x + (0.5 * width) / scale;
    for (const mark of marksOf(this.own, place, cycles, seen, unit, edge)) {
      pen.setTransform(...base);
      if (mark.text) this.name(pen, mark, ratio, colours);
      else this.mark(pen, mark, 1 / scale, 1 / size, colours);
    }
  }

  // Letters are upright, with an edge that parts them from what is below.
  name(pen, { text, x, y, drop, left, ink }, ratio, colours) {
    const at = pen.getTransform().transformPoint({ x, y });
    pen.setTransform(ratio, 0, 0, ratio, at.x, at.y);
    pen.globalAlpha = 1;
    pen.font = `${NAMES}px sans-serif`;
    pen.setLineDash([]);
    pen.lineWidth = 3;
    pen.strokeStyle = colours.ground;
    const start = left ? -BESIDE - pen.measureText(text).width : BESIDE;
    pen.strokeText(text, start, drop);
    pen.fillStyle = colours[ink];
    pen.fillText(text, start, drop);
  }

  mark(pen, mark, pixel, dot, colours) {
    pen.globalAlpha = mark.faint ? FAINT : 1;
    if (mark.pose) {
      pen.translate(mark.pose.x, mark.pose.y);
      pen.rotate(mark.pose.turn);
    }
    const path = pathOf(mark, dot);
    if (mark.fill) {
      pen.fillStyle = colours[mark.fill];
      pen.fill(path, "evenodd");
    }
    pen.strokeStyle = colours[mark.ink];
    pen.lineWidth = (mark.width ?? 1.2) * pixel;
    pen.setLineDash((mark.dash ?? []).map((length) => length * pixel));
    pen.stroke(path);
  }
}
