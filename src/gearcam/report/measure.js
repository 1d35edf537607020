// Measuring in the picture: distances, angles and radii between places that are picked. The places
// belong to bodies and move with them.

const SNAP = 10; // pixels to a corner, a centre or a point of contact
const KINDS = {
  distance: { places: 2 },
  angle: { places: 3 }, // the second is its corner
  radius: { places: 3 }, // of the circle through them
};

class MeasureTool {
  constructor(page, parts, home, asked, redraw) {
    Object.assign(this, { page, parts, home, asked, redraw });
    this.kind = ""; // empty: the pointer moves the view
    this.picked = []; // places so far
    this.all = []; // measures: `kind`, `places`
    this.near = null; // the place at the pointer
  }

  choose(kind) {
    this.kind = kind;
    this.picked = [];
    this.near = null;
    this.redraw();
  }

  get poses() { return posesOf(this.page.scene, this.page.place, this.page.cycles); }

  // The place at a pointer: a corner, centre or contact nearby, else on an outline, else anywhere.
  placeAt({ x, y, pixel }) {
    const { scene, seen, place } = this.page;
    const { poses } = this;
    const contacts = touchingIn(scene, seen.contacts, place);
    const nearest = (spots) => nearestTo({ x, y }, spots, SNAP * pixel);
    const found = nearest(this.centres(poses))
      ?? nearest(contacts.map((one) => ({ x: one.x, y: one.y, body: -1 })))
      ?? nearest(this.corners(poses))
      ?? this.onOutline({ x, y, pixel }, poses)
      ?? { x, y, body: -1 };
    const at = found.body < 0 ? [found.x, found.y] : unplaced(poses[found.body], found);
    return { body: found.body, at };
  }

  * centres(poses) {
    for (const [body, { handles }] of this.page.scene.bodies.entries()) {
      for (const at of [[0, 0], ...Object.values(handles)]) {
        yield { ...placed(poses[body], at), body };
      }
    }
  }

  * corners(poses) {
    for (const [body, { metal, lines }] of this.page.scene.bodies.entries()) {
      for (const chain of [...metal, ...lines.map((one) => one.points)]) {
        for (const at of cornersOf(chain)) yield { ...placed(poses[body], at), body };
      }
    }
  }

  onOutline({ x, y, pixel }, poses) {
    let [least, found] = [SNAP * pixel, null];
    for (const [body, { metal, lines }] of this.page.scene.bodies.entries()) {
      const [px, py] = unplaced(poses[body], { x, y });
      for (const chain of [...metal, ...lines.map((one) => one.points)]) {
        for (let k = 2; k < chain.length; k += 2) {
          const at = nearestOn(chain.slice(k - 2, k + 2), px, py);
          const away = Math.hypot(at[0] - px, at[1] - py);
          if (away < least) [least, found] = [away, { ...placed(poses[body], at), body }];
        }
      }
    }
    return found;
  }

  over(spot) {
    this.near = this.placeAt(spot);
    this.redraw();
  }

  take(spot) {
    this.picked.push(this.placeAt(spot));
    if (this.picked.length === KINDS[this.kind].places) {
      this.all.push({ kind: this.kind, places: this.picked });
      this.picked = [];
      this.list();
    }
    this.redraw();
    return true;
  }

  drag() {}

  drop() {}

  spotsOf({ places }, poses = this.poses) {
    return places.map(({ body, at }) => (body < 0 ? { x: at[0], y: at[1] } : placed(poses[body], at)));
  }

  // Of another design: what belongs to bodies that it lacks is gone.
  keep() {
    const { bodies } = this.page.scene;
    this.all = this.all.filter(({ places }) => places.every(({ body }) => body < bodies.length));
    this.picked = [];
    this.list();
  }

  // A row for each measure, with its value now and a button that removes it.
  list() {
    this.home.replaceChildren();
    this.rows = this.all.map((one) => {
      const row = add(this.home, "li", {}, `${one.kind} `);
      const value = add(row, "output");
      row.append(" ");
      const button = add(row, "button", { type: "button", "aria-label": `Remove the ${one.kind}` }, "×");
      button.addEventListener("click", () => {
        this.all = this.all.filter((other) => other !== one);
        this.list();
        this.redraw();
      });
      return value;
    });
    this.home.hidden = !this.all.length;
    this.tell();
  }

  tell() {
    const { places = 0 } = KINDS[this.kind] ?? {};
    this.asked.textContent = places ? `click on ${places} places: ${this.picked.length} so far` : "";
    for (const [k, one] of this.all.entries()) {
      const text = measured(one.kind, this.spotsOf(one));
      if (this.rows[k].textContent !== text) this.rows[k].textContent = text;
    }
  }

  // Lines between the places, and values beside them.
  * marks(poses, pixel) {
    const open = this.picked.length || (this.kind && this.near);
    const ended = this.near ? [...this.picked, this.near] : this.picked;
    for (const one of open ? [...this.all, { places: ended }] : this.all) {
      const spots = this.spotsOf(one, poses);
      const round = one.kind === "radius" && circleOf(spots);
      const chain = spots.flatMap(({ x, y }) => [x, y]);
      if (round) yield { ...dot(round, round.radius, null), ink: "pitch", dash: [4, 3] };
      else if (spots.length > 1) yield { chains: [chain], closed: false, ink: "pitch", width: 1.5 };
      for (const spot of spots) yield dot(spot, 3.5 * pixel, "pitch");
      if (!one.kind) continue;
      const middle = one.kind === "angle" ? spots[1] : {
        x: 0.5 * (spots[0].x + spots[1].x), y: 0.5 * (spots[0].y + spots[1].y),
      };
      const text = measured(one.kind, spots);
      yield { text, chains: [], ink: "pitch", drop: ABOVE, ...(round || middle) };
    }
  }
}

// Where an outline bends by more than its chords do: its ends too.
function cornersOf(chain) {
  if (chain.corners) return chain.corners;
  chain.corners = [];
  if (chain.length < 4) return chain.corners;
  const count = chain.length / 2;
  const shut = chain[0] === chain.at(-2) && chain[1] === chain.at(-1);
  const point = (k) => [chain[2 * k], chain[2 * k + 1]];
  for (let k = 0; k < count; k++) {
    const ends = !shut && (k === 0 || k === count - 1);
    const [before, here, after] = [k ? k - 1 : count - 2, k, k < count - 1 ? k + 1 : 1].map(point);
    const way = [here[0] - before[0], here[1] - before[1]];
    const next = [after[0] - here[0], after[1] - here[1]];
    const turn = Math.atan2(way[0] * next[1] - way[1] * next[0], way[0] * next[0] + way[1] * next[1]);
    if (ends || Math.abs(turn) > SHARP_TURN) chain.corners.push(here);
  }
  return chain.corners;
}

const SHARP_TURN = 0.35; // rad: chords of curves turn less

// The point of a piece (flat) that is nearest to another.
function nearestOn([ax, ay, bx, by], x, y) {
  const [dx, dy] = [bx - ax, by - ay];
  const share = ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1);
  const part = Math.min(1, Math.max(0, share));
  return [ax + part * dx, ay + part * dy];
}

// The circle through three points; null if they are in a line.
function circleOf([a, b, c]) {
  const [bx, by, cx, cy] = [b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y];
  const twice = 2 * (bx * cy - by * cx);
  const [bb, cc] = [bx * bx + by * by, cx * cx + cy * cy];
  if (Math.abs(twice) < 1e-9 * (bb + cc)) return null;
  const [ux, uy] = [(cy * bb - by * cc) / twice, (bx * cc - cx * bb) / twice];
  return { x: a.x + ux, y: a.y + uy, radius: Math.hypot(ux, uy) };
}

// A measure in words.
function measured(kind, spots) {
  const [a, b, c] = spots;
  if (kind === "distance") return `${brief(Math.hypot(b.x - a.x, b.y - a.y), "mm")} mm`;
  if (kind === "radius") {
    const round = circleOf(spots);
    const [radius, wide] = round ? [round.radius, 2 * round.radius].map((one) => brief(one, "mm")) : [];
    return round ? `R ${radius} mm, diameter ${wide} mm` : "in a line";
  }
  const way = ({ x, y }) => Math.atan2(y - b.y, x - b.x);
  const turn = Math.abs(way(c) - way(a)) % (2 * Math.PI);
  return `${brief((Math.min(turn, 2 * Math.PI - turn) * 180) / Math.PI, "deg")} deg`;
}
