// Dragging what is drawn in the live view: joints, axes, rollers. Numbers follow the pointer.

const REACHED = 12; // of the pointer to a handle, pixels
const CLOSE = 0.5; // pixels between the pointer and what was dragged that are let be
const WEAK = 1e-3; // of the larger of two squared ways: the handle does not go the other way
const SMALL = 1e-3; // share of the range of a slider for derivatives

const dotted = ([x, y], [u, v]) => x * u + y * v;

// A tool of the picture (see `Parts`); `numbers` are those of the live view.
class HandleTool {
  constructor(gearcam, numbers) {
    Object.assign(this, { gearcam, numbers });
    this.known = null; // the handles of a place
    this.near = null; // the handle at the pointer
    this.held = null; // what is dragged: handle, moves, goal
    this.asking = false;
  }

  get scene() { return this.gearcam.page.scene; }

  // The handles are found anew at another place or for other numbers.
  forget() {
    if (!this.held) this.known = null;
  }

  // Ask for the handles at this place.
  async find() {
    const place = this.gearcam.page.place;
    if (this.asking || this.known?.place === place) return;
    this.asking = true;
    const steps = this.numbers.steps(SMALL);
    const found = Object.keys(steps).length ? await this.numbers.find(steps, place) : {};
    this.asking = false;
    if (!found.handles || place !== this.gearcam.page.place) return;
    this.known = { place, handles: found.handles };
    this.gearcam.redraw();
  }

  // Where a handle is; nothing where the scene has another form.
  spotOf({ body, name }) {
    const one = this.scene.bodies[body];
    const at = one?.handles[name];
    const poses = this.gearcam.poses();
    return at && this.gearcam.placed(poses[body], at);
  }

  keysOf({ moves }) {
    return Object.keys(moves).filter((key) => this.numbers.free(key));
  }

  // Those of some handles that numbers move, with where they are.
  * spotsOf(handles) {
    for (const handle of handles) {
      const spot = this.keysOf(handle).length && this.spotOf(handle);
      if (spot) yield { ...spot, handle };
    }
  }

  at(spot) {
    if (this.known?.place !== this.gearcam.page.place) return null;
    const spots = this.spotsOf(this.known.handles);
    return this.gearcam.nearestTo(spot, spots, REACHED * spot.pixel)?.handle ?? null;
  }

  over(spot, event) {
    if (!this.gearcam.page.playing) this.find();
    const near = this.at(spot);
    if (near === this.near) return;
    this.near = near;
    event.target.style.cursor = near ? "move" : "";
    event.target.title = near ? `Drag to change ${this.keysOf(near).map(this.numbers.called).join("; ")}` : "";
    this.gearcam.redraw();
  }

  take(spot) {
    const handle = this.at(spot);
    if (!handle) return false;
    const keys = this.keysOf(handle);
    const moves = Object.fromEntries(keys.map((key) => [key, [...handle.moves[key]]]));
    const { x, y } = this.spotOf(handle);
    const others = (key) => this.known.handles.filter((one) => key in one.moves).length;
    const counts = Object.fromEntries(keys.map((key) => [key, others(key)]));
    const { unit, range } = this.numbers;
    const widest = (key) => Math.max(...keys.filter((one) => unit(one) === unit(key)).map(range));
    const weights = Object.fromEntries(keys.map((key) => [key, widest(key) ** 2]));
    this.held = { handle, moves, counts, weights, goal: spot, off: [x - spot.x, y - spot.y] };
    return true;
  }

  drag(spot) {
    this.held.goal = spot;
    this.step();
  }

  drop() {
    const { before } = this.held;
    this.held = null;
    this.known = null;
    if (before) this.numbers.settle();
  }

  // What is left between the handle and where it is to be.
  left() {
    const { goal, off, handle } = this.held;
    const now = this.spotOf(handle);
    return now && [goal.x + off[0] - now.x, goal.y + off[1] - now.y];
  }

  // Change numbers so that the handle comes to the pointer.
  step() {
    const { held } = this;
    const left = this.left();
    if (!left || held.waits || Math.hypot(...left) < CLOSE * held.goal.pixel) return;
    const keys = Object.keys(held.moves);
    const now = Object.fromEntries(keys.map((key) => [key, this.numbers.at(key)]));
    const changes = Object.entries(this.solved(held.moves, left, now));
    if (!changes.length) return;
    held.before = { spot: this.spotOf(held.handle), now };
    held.waits = this.numbers.move(Object.fromEntries(changes.map(([key, by]) => [key, now[key] + by])));
  }

  // The least change, relative to the widest range of each unit, that moves the handle by so much. Numbers
  // that move few other handles change first; one at the end of what is allowed stays there.
  solved(moves, [dx, dy], now) {
    let left = Object.keys(moves);
    const found = {};
    let goal = [dx, dy];
    while (left.length) {
      const { rows, push } = this.chosen(left, moves, goal);
      const beyond = rows.find(({ key, way, weight }) => {
        const [low, high] = this.numbers.allowed(key);
        const next = now[key] + weight * dotted(way, push);
        return next < low || next > high;
      });
      if (!beyond) {
        for (const { key, way, weight } of rows) found[key] = weight * dotted(way, push);
        break;
      }
      const [low, high] = this.numbers.allowed(beyond.key);
      const by = (dotted(beyond.way, push) > 0 ? high : low) - now[beyond.key];
      found[beyond.key] = by;
      goal = goal.map((one, k) => one - by * beyond.way[k]);
      left = left.filter((key) => key !== beyond.key);
    }
    return found;
  }

  // The first numbers that move the handle both ways, and the push that does it; if they do it one
  // way only, the push is along that one.
  chosen(keys, moves, goal) {
    const tiers = [...new Set(keys.map((key) => this.held.counts[key]))].sort((a, b) => a - b);
    let found;
    for (const tier of tiers) {
      const own = keys.filter((key) => this.held.counts[key] <= tier);
      const rows = own.map((key) => ({ key, way: moves[key], weight: this.held.weights[key] }));
      const sum = (k, l) => rows.reduce((all, { way, weight }) => all + weight * way[k] * way[l], 0);
      const [a, b, c] = [sum(0, 0), sum(0, 1), sum(1, 1)];
      const [middle, half] = [0.5 * (a + c), Math.hypot(0.5 * (a - c), b)];
      const angle = 0.5 * Math.atan2(2 * b, a - c);
      const axes = [
        [middle + half, [Math.cos(angle), Math.sin(angle)]],
        [middle - half, [-Math.sin(angle), Math.cos(angle)]],
      ];
      const firm = axes.filter(([size]) => size > WEAK * axes[0][0]);
      const push = [0, 1].map((k) =>
        firm.reduce((all, [size, axis]) => all + (dotted(axis, goal) / size) * axis[k], 0));
      found = { rows, push };
      if (firm.length === 2) break;
    }
    return found;
  }

  // A draft has come: correct the derivatives by how far the handle has moved (Broyden), go on.
  came(refused) {
    const { held } = this;
    if (!held?.waits) return;
    held.waits = false;
    if (refused) {
      this.numbers.restore(held.before.now);
      return;
    }
    const spot = this.spotOf(held.handle);
    if (!spot) return;
    this.learn(spot);
    this.step();
  }

  learn(spot) {
    const { moves, before } = this.held;
    const rows = Object.entries(moves).map(([key, way]) => {
      return { way, by: this.numbers.at(key) - before.now[key], share: 1 / this.held.weights[key] };
    });
    const size = rows.reduce((total, { by, share }) => total + share * by * by, 0);
    if (!(size > 0)) return;
    for (const [row, axis] of ["x", "y"].entries()) {
      const foretold = rows.reduce((total, { way, by }) => total + way[row] * by, 0);
      const missed = spot[axis] - before.spot[axis] - foretold;
      for (const { way, by, share } of rows) way[row] += (missed * share * by) / size;
    }
  }

  // A request was overtaken: go on from what is shown.
  missed() {
    if (!this.held?.waits) return;
    this.held.waits = false;
    this.step();
  }

  // The handles: a ring around each, a larger one at the pointer.
  * marks(pixel) {
    if (this.known?.place !== this.gearcam.page.place && !this.held) return;
    const handles = this.held ? [this.held.handle] : this.known.handles;
    for (const { handle, ...spot } of this.spotsOf(handles)) {
      const ring = this.gearcam.dot(spot, (handle === this.near ? 9 : 6) * pixel, null);
      yield { ...ring, ink: "accent", width: 2 };
    }
  }
}
