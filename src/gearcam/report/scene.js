// A scene at a place of its driver: positions of bodies, contacts, and the marks to draw.

const NAMES = 13; // height of names, pixels
const BESIDE = 7; // their distance from what they name
const [ABOVE, BELOW] = [-BESIDE, BESIDE + 0.75 * NAMES];

// The index of the place before a place, and the share of the step beyond it.
function spotOf(places, place) {
  let low = 0;
  let high = places.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (places[middle] <= place) low = middle;
    else high = middle;
  }
  const part = (place - places[low]) / (places[high] - places[low]);
  return { index: low, part: Math.min(1, Math.max(0, part)) };
}

const steady = (values) => typeof values === "number";

function between(values, { index, part }) {
  if (steady(values)) return values;
  return values[index] + part * (values[index + 1] - values[index]);
}

// Change over a cycle: a driven wheel need not make a full turn.
const gain = (values) => (steady(values) ? 0 : values.at(-1) - values[0]);

// Rotation, rad, and origin, mm, of every body.
function posesOf(scene, place, cycles = 0) {
  const spot = spotOf(scene.places, place);
  return scene.bodies.map((body) => ({
    name: body.name,
    turn: between(body.turn, spot) + cycles * gain(body.turn),
    x: between(body.x, spot),
    y: between(body.y, spot),
  }));
}

// Poses of solids by name: those of the bodies, and of what moves in space by itself.
function solidPosesOf(scene, place, cycles = 0) {
  const spot = spotOf(scene.places, place);
  const poses = posesOf(scene, place, cycles).map((one) => [one.name, { axis: [0, 0, 1], ...one }]);
  for (const [name, one] of Object.entries(scene.solids)) {
    const turn = between(one.turn, spot) + cycles * gain(one.turn);
    const [x, y, z] = [one.x, one.y, one.z].map((values) => between(values, spot));
    poses.push([name, { axis: one.axis, turn, x, y, z }]);
  }
  return new Map(poses);
}

// The rows of contacts at one of the places by their teeth, or else by their order.
function rowsAt(contacts, index) {
  const rows = new Map();
  for (let row = contacts.start[index]; row < contacts.start[index + 1]; row++) {
    let key = contacts.teeth ? contacts.teeth[row].join(":") : "";
    while (rows.has(key)) key += "+";
    rows.set(key, row);
  }
  return rows;
}

// Points of contact, interpolated where the same teeth touch at both neighbouring places.
function touching(contacts, spot) {
  const here = rowsAt(contacts, spot.index);
  const next = rowsAt(contacts, spot.index + 1);
  return [...(spot.part < 0.5 ? here : next)].map(([key, row]) => {
    const first = here.get(key) ?? row;
    const last = next.get(key) ?? row;
    const at = (values) => values[first] + spot.part * (values[last] - values[first]);
    return {
      x: at(contacts.x), y: at(contacts.y), fx: at(contacts.fx), fy: at(contacts.fy),
      teeth: contacts.teeth?.[row],
    };
  });
}

// All points of contact of the given sets.
function touchingIn(scene, names, place) {
  const spot = spotOf(scene.places, place);
  const known = names.filter((name) => name in scene.contacts); // a draft has no contacts
  return known.flatMap((name) => touching(scene.contacts[name], spot));
}

function pitchAt(scene, place) {
  if (!scene.pitch) return null;
  const { index, part } = spotOf(scene.places, place);
  const at = (k) => scene.pitch[k] + part * (scene.pitch[k + 2] - scene.pitch[k]);
  return { x: at(2 * index), y: at(2 * index + 1) };
}

// The point that the view follows: the pitch point, or the middle of the contacts.
function meshAt(scene, place) {
  const pitch = pitchAt(scene, place);
  if (pitch) return pitch;
  const found = touchingIn(scene, Object.keys(scene.contacts), place);
  if (!found.length) return null;
  const mean = (key) => found.reduce((sum, one) => sum + one[key], 0) / found.length;
  return { x: mean("x"), y: mean("y") };
}

// Magnification of the mesh: about five teeth, or a quarter of the parts, fill the view.
function closer(scene) {
  const teeth = Object.values(scene.contacts).flatMap((one) => one.teeth ?? []);
  const most = teeth.reduce((count, pair) => Math.max(count, pair[0]), 0);
  return Math.max(4, most / 6);
}

// Colours by name, so that wheel 1 keeps its colour whatever the order of bodies; links have one.
function tones(scene) {
  const own = scene.bodies.map((body) => body.name.split("_")[0]); // steps of one wheel
  const wheels = own.filter((name, k) => name !== "frame" && !scene.bodies[k].link);
  const names = [...new Set(wheels)].sort();
  const toneOf = (name, body) => {
    if (body.variant !== undefined) return 1; // its edge has the colour of the variant
    return body.link ? 3 : (names.indexOf(name) % 2) + 1;
  };
  return own.map((name, k) => toneOf(name, scene.bodies[k]));
}

// Members of variants, which differ in dashes: bodies by their names, in order.
const membersOf = ({ bodies }) => [...new Set(bodies
  .filter((one) => one.variant !== undefined && one.name !== "frame").map((one) => one.name))];

// A tooth of an outline, closed by its chord.
function toothOf(outline, [first, last]) {
  const tooth = outline.slice(2 * first, first <= last ? 2 * last + 2 : undefined);
  return first <= last ? tooth : tooth.concat(outline.slice(0, 2 * last + 2));
}

// The coloured pieces of a curve, by their colours and all together.
function piecesOf(curve, label, scale) {
  const known = (curve.pieces ??= new Map());
  if (!known.has(label)) {
    const levels = levelsOf(curve.points, curve.values[label], scale);
    known.set(label, { body: curve.body, levels, whole: levels.flat() });
  }
  return known.get(label);
}

// The pieces by their colours: that of the larger of the values at the ends of a piece.
function levelsOf(points, values, { least, largest }) {
  const levels = Array.from({ length: LEVELS }, () => []);
  let before = -1;
  for (let k = 1; k < values.length; k++) {
    const ends = [values[k - 1], values[k]];
    const share = (Math.max(...ends) - least) / (largest - least || 1);
    const level = ends.includes(null) ? -1 : Math.min(LEVELS - 1, Math.floor(LEVELS * share));
    const piece = points.slice(2 * k - 2, 2 * k + 2);
    if (level >= 0 && level === before) levels[level].at(-1).push(piece[2], piece[3]);
    else if (level >= 0) levels[level].push(piece);
    before = level;
  }
  return levels;
}

// Curves in the colours of values, large ones on top, within an edge that stands out from any
// ground, and a ring around the largest.
function* colouredMarks({ coloured, scales }, label, poses, pixel) {
  const scale = scales[label];
  const poseOf = (name) => poses.find((one) => one.name === name);
  const curves = coloured
    .filter((one) => label in one.values)
    .map((one) => ({ ...piecesOf(one, label, scale), pose: poseOf(one.body) }));
  for (const { whole, pose } of curves) {
    yield { chains: whole, closed: false, ink: "text", width: 7, pose };
  }
  for (let k = 0; k < LEVELS; k++) {
    for (const { levels, pose } of curves) {
      yield { chains: levels[k], closed: false, ink: `level-${k + 1}`, width: 5, pose };
    }
  }
  const ring = { ...dot(scale, 9 * pixel, null), pose: poseOf(scale.body) };
  yield { ...ring, ink: "ground", width: 6 };
  yield { ...ring, ink: "text", width: 2.5 };
}

/* The marks to draw, later ones on top. A mark has `chains` of points (flat, mm), `closed` or not,
   the names of the colours of its area (`fill`) and edges (`ink`), an optional `pose`, and its
   `width` and `dash` in units of `pixel`, mm; or a `text` on the right of `x` and `y`, or `left` of
   them where it would reach over `edge`, its base so many pixels below (`drop`). `seen` selects what
   is shown. */
function* marksOf(scene, place, cycles, seen, pixel, edge = Infinity) {
  if (seen.ghost) yield* ghostMarks(seen.ghost, place);
  const found = touchingIn(scene, seen.contacts, place);
  const poses = posesOf(scene, place, cycles);
  const tone = tones(scene);
  const members = membersOf(scene);
  // Contacts refer to the teeth of the first cycle, at their positions in it.
  const first = cycles ? posesOf(scene, place) : poses;
  const toothed = scene.bodies.filter((body) => body.teeth);
  for (const [k, body] of scene.bodies.entries()) {
    const faint = aside(seen, body.variant);
    const dash = DASHES[Math.max(0, members.indexOf(body.name)) % DASHES.length];
    for (const mark of bodyMarks(body, poses[k], tone[k], pixel)) {
      yield { dash: mark.closed && dash.length ? dash : undefined, ...mark, faint };
    }
    const column = body.teeth && seen.carry ? columnOf(toothed, body) : -1;
    if (column < 0) continue;
    const chains = found
      .filter((one) => one.teeth && body.teeth[one.teeth[column] - 1])
      .map((one) => toothOf(body.metal[0], body.teeth[one.teeth[column] - 1]));
    yield { chains, closed: true, fill: `carry-${tone[k]}`, ink: `ink-${tone[k]}`, pose: first[k] };
  }
  // Auxiliary lines are drawn on top of the bodies.
  for (const [k, body] of scene.bodies.entries()) yield* dashedMarks(body, poses[k], seen);
  if (scene.scales[seen.colouring]) yield* colouredMarks(scene, seen.colouring, poses, pixel);
  if (seen.forces) yield* forceMarks(scene, place, pixel);
  if (seen.action) yield* actionMarks(found, pixel);
  if (seen.points) yield* found.map((one) => dot(one, 4 * pixel, "contact"));
  const pitch = seen.pitch && pitchAt(scene, place);
  if (pitch) yield dot(pitch, 4 * pixel, "pitch");
  if (seen.names) yield* nameMarks(scene, poses, pixel, edge);
  for (const k of seen.lit ?? []) {
    if (!scene.bodies[k]) continue;
    const chains = edgesOf(scene.bodies[k]);
    yield { chains, closed: true, ink: "contact", width: 2.5, pose: poses[k] };
  }
  for (const { body, tooth } of seen.teeth ?? []) {
    const { metal, teeth } = scene.bodies[body] ?? {};
    if (!teeth?.[tooth - 1]) continue;
    const chains = [toothOf(metal[0], teeth[tooth - 1])];
    yield { chains, closed: true, ink: "contact", width: 3, pose: poses[body] };
  }
  for (const marks of seen.marked ?? []) yield* marks(poses, pixel);
}

// Another design at the same place, as outlines beneath this one.
function* ghostMarks(scene, place) {
  const { places, bodies } = scene;
  const poses = posesOf(scene, Math.min(places.at(-1), Math.max(places[0], place)));
  for (const [k, body] of bodies.entries()) {
    const lines = body.lines.filter((one) => !one.dashed);
    for (const line of lines) line.chains ??= [line.points];
    const drawn = [
      { chains: body.metal, closed: true },
      ...lines.map(({ chains, closed }) => ({ chains, closed })),
    ];
    for (const one of drawn) yield { ...one, ink: "muted", dash: [3, 3], pose: poses[k] };
  }
}

// The one of some spots that is nearest to a point, within a reach; null if all are farther.
function nearestTo({ x, y }, spots, reach) {
  let [least, found] = [reach, null];
  for (const spot of spots) {
    const away = Math.hypot(spot.x - x, spot.y - y);
    if (away < least) [least, found] = [away, spot];
  }
  return found;
}

// The closed edges of a body; the same list each time, by which its path is known.
function edgesOf(body) {
  return (body.edges ??= [
    ...body.metal,
    ...body.lines.filter((one) => !one.dashed && one.closed).map((one) => one.points),
  ]);
}

// Where a point in the frame of a body is.
function placed({ turn, x, y }, [left, up]) {
  const [cos, sin] = [Math.cos(turn), Math.sin(turn)];
  return { x: x + cos * left - sin * up, y: y + sin * left + cos * up };
}

// The names of joints and members: those of one place in one line, others that would cover each
// other above and below.
function nameMarks(scene, poses, pixel, edge) {
  const found = [];
  for (const [k, body] of scene.bodies.entries()) {
    for (const { text, x, y } of body.names) {
      const at = placed(poses[k], [x, y]);
      const near = found.find((one) => Math.hypot(one.x - at.x, one.y - at.y) < NAMES * pixel);
      if (near) near.text += `, ${text}`;
      else found.push({ text, chains: [], ink: "text", drop: ABOVE, ...at });
    }
  }
  const wide = (one) => 0.6 * NAMES * one.text.length * pixel;
  for (const one of found) one.left = one.x + BESIDE * pixel + wide(one) > edge;
  const first = (one) => (one.left ? one.x - 2 * BESIDE * pixel - wide(one) : one.x);
  const covered = (one, other) =>
    Math.abs(one.y - other.y - (one.drop - other.drop) * pixel) < NAMES * pixel &&
    first(one) < first(other) + wide(other) &&
    first(other) < first(one) + wide(one);
  for (const [k, one] of found.entries()) {
    if (found.slice(0, k).some((other) => covered(one, other))) one.drop = BELOW;
  }
  return found;
}

// Overlapping plates, each with its openings.
function platesOf(body) {
  return (body.split ??= body.plates.map((from, k) => body.metal.slice(from, body.plates[k + 1])));
}

// Column of a body in the teeth of contacts: toothed bodies in the order of their names.
function columnOf(toothed, body) {
  return toothed.map((one) => one.name).sort().indexOf(body.name);
}

function* bodyMarks(body, pose, tone, pixel) {
  const own = body.name === "frame" ? "text" : `ink-${tone}`;
  const ink = body.variant === undefined ? own : inkOf(body.variant);
  for (const chains of platesOf(body)) {
    yield { chains, closed: true, fill: `fill-${tone}`, ink, pose };
  }
  yield { chains: body.floor, closed: true, fill: `floor-${tone}`, ink, pose };
  for (const line of body.lines.filter((one) => !one.dashed)) {
    const fill = line.layer === "MARK" && line.closed ? ink : null;
    yield { chains: (line.chains ??= [line.points]), closed: line.closed, fill, ink, pose };
    if (body.variant >= INKS && line.layer === "OUTLINE") {
      const places = alongOf(line.points, APART * pixel, body.variant);
      const chains = places.map(([x, y]) => diamond(x, y, MARK * pixel).flat());
      yield { chains, closed: true, fill: ink, ink, pose };
    }
  }
}

function* dashedMarks(body, pose, seen) {
  for (const line of body.lines.filter((one) => one.dashed && seen.lines[one.layer])) {
    const chains = (line.chains ??= [line.points]);
    yield { chains, closed: line.closed, ink: "centrode", dash: [7, 4], pose };
  }
}

// Lines of action through each contact, with the head of an arrow in the direction of the force.
function* actionMarks(found, pixel) {
  const reach = 60 * pixel;
  for (const { x, y, fx, fy } of found) {
    yield* arrow([x - reach * fx, y - reach * fy], [x + reach * fx, y + reach * fy], 8 * pixel);
  }
}

// Forces in joints: arrows that begin there, to one scale; short ones have a smaller head.
function* forceMarks({ places, forces }, place, pixel) {
  const spot = spotOf(places, place);
  const [reach, head] = [120 * pixel, 8 * pixel];
  for (const one of forces) {
    const near = spot.part < 0.5 ? spot.index : spot.index + 1;
    if (one.fx[near] === null) continue;
    const known = one.fx[spot.index] !== null && one.fx[spot.index + 1] !== null;
    const at = (values) => (known ? between(values, spot) : values[near]);
    const [x, y, fx, fy] = [one.x, one.y, one.fx, one.fy].map(at);
    const long = reach * Math.hypot(fx, fy);
    if (long > pixel) yield* arrow([x, y], [x + reach * fx, y + reach * fy], Math.min(head, long));
  }
}

// An arrow from one point to another.
function* arrow([x, y], [ex, ey], head) {
  const long = Math.hypot(ex - x, ey - y);
  const [ux, uy] = [(head * (ex - x)) / long, (head * (ey - y)) / long];
  const wing = (side) => [ex - ux + side * uy, ey - uy - side * ux];
  const tip = [ex, ey, ...wing(0.4), ...wing(-0.4)];
  yield { chains: [[x, y, ex, ey]], closed: false, ink: "contact", width: 1.5 };
  yield { chains: [tip], closed: true, fill: "contact", ink: "contact" };
}

function dot({ x, y }, radius, ink) {
  const points = [];
  for (let angle = 0; angle < 2 * Math.PI; angle += Math.PI / 12) {
    points.push(x + radius * Math.cos(angle), y + radius * Math.sin(angle));
  }
  return { chains: [points], closed: true, fill: ink, ink: "ground" };
}
