// Distances between places on the solids. A place is picked with a click or a tap, or with the keys: it
// snaps to corners and to centres nearby. Distances stay with their bodies while these move.

const PICK_SNAP = 14; // pixels
const PICK_STILL = 6; // pixels that a click may move
const PICK_REACH = 2; // how far a corner may be in space, in distances that snap in the view
const PICK_AROUND = [[0, 0], [7, 0], [-7, 0], [0, 7], [0, -7]]; // pixels: edges are easily missed
const PICK_NUDGE = 10; // pixels per arrow key, 1 with Shift

class SolidMeasure {
  // `axisOf(name)` is the axis about which a body turns, or nothing.
  constructor(home, cut, axisOf) {
    [this.home, this.cut, this.axisOf] = [home, cut, axisOf];
    this.button = home.querySelector(".measure button");
    this.told = home.querySelector(".measure [role=status]");
    this.marks = home.querySelector(".marks");
    this.lines = this.marks.querySelector("svg");
    this.inside = null;
    this.on = false;
    this.first = null; // the place picked first
    this.pointer = null; // where the keys point, pixels
    this.kept = []; // pairs of places, each with its label
    this.button.addEventListener("click", () => {
      this.turn(!this.on);
      if (this.on) this.inside.focus();
    });
  }

  // Measure in another view, whose bodies are others.
  put(inside) {
    this.inside = inside;
    this.axes = new Map(solidBodies(inside.scene).map(({ name }) => [name, this.axisOf(name)]));
    inside.document.body.style.cursor = this.on ? "crosshair" : "";
    if (this.kept.length) this.told.textContent = "The solids are new: distances were removed.";
    for (const { label } of this.kept) label.remove();
    [this.kept, this.first] = [[], null];
    inside.scene.onAfterRender = () => this.draw();
    const canvas = inside.renderer.domElement;
    let down = null;
    canvas.addEventListener("pointerdown", (event) => (down = event));
    canvas.addEventListener("pointerup", (event) => {
      const moved = down && Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY);
      if (this.on && down && moved < PICK_STILL) this.pick(event.clientX, event.clientY);
      down = null;
    });
  }

  turn(on) {
    [this.on, this.first, this.pointer] = [on, null, null];
    this.button.setAttribute("aria-pressed", on);
    this.inside.document.body.style.cursor = on ? "crosshair" : "";
    this.told.textContent = on ? "Pick two places; with the keys: arrows and Enter, Escape ends." : "";
    this.inside.render();
  }

  // Take a key while measuring; returns whether it was one.
  key(event) {
    const step = event.shiftKey ? 1 : PICK_NUDGE;
    const way = {
      ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step],
    }[event.key];
    if (!this.on || !(way || ["Enter", "Escape"].includes(event.key))) return false;
    event.preventDefault();
    const { innerWidth, innerHeight } = this.inside;
    if (way) {
      const [x, y] = this.pointer ?? [innerWidth / 2, innerHeight / 2];
      const within = (value, most) => Math.min(most, Math.max(0, value));
      this.pointer = [within(x + way[0], innerWidth), within(y + way[1], innerHeight)];
    } else if (event.key === "Enter") {
      this.pick(...(this.pointer ?? [innerWidth / 2, innerHeight / 2]));
    } else if (this.first) {
      this.first = null;
    } else {
      this.turn(false);
      this.button.focus();
    }
    this.draw();
    return true;
  }

  // --- picking ------------------------------------------------------------------------------------

  // Pick the place at a point of the view.
  pick(x, y) {
    const found = this.centreAt(x, y) ?? this.placeAt(x, y);
    if (!found) {
      this.told.textContent = "There is no solid at this place.";
      return;
    }
    if (this.first) this.keep(this.first, found);
    this.told.textContent = this.first
      ? `${this.kept.at(-1).text}, ${this.first.what} to ${found.what}.`
      : `First place: ${found.what}. Pick the second.`;
    this.first = this.first ? null : found;
    this.draw();
  }

  // The place on the nearest body that is seen there, or just beside; a corner if there is one nearby.
  placeAt(x, y) {
    for (const [across, along] of PICK_AROUND) {
      const found = this.hitAt(x + across, y + along);
      if (!found) continue;
      const { body, at, what } = found;
      const near = what ? null : this.nearest(this.cornersNear(body, at), x, y);
      return this.place(body, near ?? at, what || (near ? "a corner" : "a place"));
    }
    return null;
  }

  // What is seen at a point of the view: the body, the place, and what that is if it is of a section.
  hitAt(x, y) {
    const { THREE, camera, scene, innerWidth, innerHeight } = this.inside;
    const ray = new THREE.Raycaster();
    ray.setFromCamera({ x: (2 * x) / innerWidth - 1, y: 1 - (2 * y) / innerHeight }, camera);
    const hits = ray.intersectObjects([...solidBodies(scene), ...this.cut.caps], false);
    const hit = hits.find((one) => !this.cut.hides(one.point));
    if (!hit) return null;
    if (!hit.object.userData.cap) return { body: hit.object, at: hit.point, what: "" };
    const at = ray.ray.intersectPlane(this.cut.plane, new THREE.Vector3()) ?? hit.point;
    return { body: hit.object.parent, at, what: "a place of the section" };
  }

  // The corners of a body that are as near to a place as snapping reaches.
  cornersNear(body, at) {
    const { THREE, camera, innerHeight } = this.inside;
    const pixel = (2 * camera.position.distanceTo(at) * Math.tan((camera.fov * Math.PI) / 360)) / innerHeight;
    const own = body.worldToLocal(at.clone());
    const places = body.geometry.attributes.position;
    const found = new THREE.Vector3();
    const corners = [];
    for (let k = 0; k < places.count; k++) {
      found.fromBufferAttribute(places, k);
      if (found.distanceTo(own) < PICK_REACH * PICK_SNAP * pixel) corners.push(body.localToWorld(found.clone()));
    }
    return corners;
  }

  // The centre of a body nearby: the ends of its axis, or the middle of one that does not turn.
  centreAt(x, y) {
    const all = this.centres();
    const near = this.nearest(all.map((one) => one.at), x, y);
    const found = all.find((one) => one.at === near);
    return found && this.place(found.body, near, "a centre");
  }

  centres() {
    const { THREE, scene } = this.inside;
    return solidBodies(scene).flatMap((body) => {
      const { min, max } = body.geometry.boundingBox;
      const axis = this.axes.get(body.name) ?? [];
      const along = axis.findIndex((share) => Math.abs(share) > 0.99); // an axis of the frame
      const end = (one) => new THREE.Vector3().setComponent(along, one.getComponent(along));
      const ends = along < 0 ? [min.clone().lerp(max, 0.5)] : [end(min), end(max)];
      return ends.map((at) => ({ body, at: body.localToWorld(at) }));
    }).filter(({ at }) => !this.cut.hides(at));
  }

  // The one of some points that is nearest to a point of the view; nothing if none is near.
  nearest(points, x, y) {
    const away = (point) => {
      const seen = this.seen(point);
      return seen ? Math.hypot(seen[0] - x, seen[1] - y) : Infinity;
    };
    const [best] = points.toSorted((a, b) => away(a) - away(b));
    return best && away(best) < PICK_SNAP ? best : null;
  }

  // A place is kept in the frame of its body.
  place(body, at, what) {
    return { body, at: body.worldToLocal(at.clone()), what };
  }

  // --- what is kept -------------------------------------------------------------------------------

  keep(from, to) {
    const label = document.createElement("span");
    const text = document.createElement("b");
    const remove = document.createElement("button");
    Object.assign(remove, { type: "button", textContent: "\u00d7" });
    const one = { from, to, label, value: text, remove, text: "" };
    remove.addEventListener("click", () => {
      label.remove();
      this.kept = this.kept.filter((other) => other !== one);
      this.draw();
      this.button.focus();
    });
    label.append(text, remove);
    this.marks.append(label);
    this.kept.push(one);
    this.tell(one);
  }

  tell(one) {
    const [from, to] = [one.from, one.to].map(({ body, at }) => body.localToWorld(at.clone()));
    const far = from.distanceTo(to);
    one.text = `${far.toFixed(far < 1 ? 3 : 2)} mm`;
    if (one.value.textContent === one.text) return;
    one.value.textContent = one.text;
    const way = to.sub(from);
    one.label.title = ["x", "y", "z"].map((key) => `${key}: ${way[key].toFixed(2)} mm`).join(", ");
    one.remove.setAttribute("aria-label", `Remove the distance ${one.text}`);
  }

  // A picture of what is drawn, with the distances, as an address.
  printed(drawn) {
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [drawn.width, drawn.height];
    const pen = canvas.getContext("2d");
    pen.drawImage(drawn, 0, 0);
    pen.scale(drawn.width / this.inside.innerWidth, drawn.height / this.inside.innerHeight);
    pen.stroke(new Path2D(this.lines.firstElementChild.getAttribute("d") ?? ""));
    Object.assign(pen, { font: "bold 15px sans-serif", textAlign: "center", lineWidth: 5, strokeStyle: "#fff" });
    for (const { label, text } of this.kept.filter((one) => !one.label.hidden)) {
      const at = [parseFloat(label.style.left), parseFloat(label.style.top)];
      pen.strokeText(text, ...at);
      pen.fillText(text, ...at);
    }
    return canvas.toDataURL();
  }

  // Where a point is in the view, pixels; nothing behind the reader.
  seen(point) {
    const { camera, innerWidth, innerHeight } = this.inside;
    const at = point.clone().project(camera);
    return at.z < 1 ? [((1 + at.x) * innerWidth) / 2, ((1 - at.y) * innerHeight) / 2] : null;
  }

  draw() {
    const at = ({ body, at: own }) => this.seen(body.localToWorld(own.clone()));
    const parts = [];
    for (const one of this.kept) {
      this.tell(one);
      const [a, b] = [at(one.from), at(one.to)];
      one.label.hidden = !a || !b;
      if (!a || !b) continue;
      parts.push(`M${a} L${b}`, pickRing(a), pickRing(b));
      one.label.style.left = `${(a[0] + b[0]) / 2}px`;
      one.label.style.top = `${(a[1] + b[1]) / 2}px`;
    }
    const first = this.first && at(this.first);
    if (first) parts.push(pickRing(first));
    const [path, centres] = this.lines.children;
    path.setAttribute("d", parts.join(" "));
    const crosses = this.on ? this.centres().map((one) => this.seen(one.at)).filter(Boolean) : [];
    if (this.on && this.pointer) crosses.push(this.pointer, this.pointer);
    const size = (k) => (this.pointer && k >= crosses.length - 1 ? 14 : 5);
    centres.setAttribute("d", crosses.map((one, k) => pickCross(one, size(k))).join(" "));
  }
}

const pickRing = ([x, y]) => `M${x - 4},${y} a4,4 0 1 0 8,0 a4,4 0 1 0 -8,0`;
const pickCross = ([x, y], size) => `M${x - size},${y} h${2 * size} M${x},${y - size} v${2 * size}`;
