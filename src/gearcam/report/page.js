// The page: its controls, and the place of the driver that parts and charts show.

const CYCLE = 12; // seconds of a cycle at speed 1
const EVEN = [0.05, 0.2, 0.5, 1, 2]; // speeds where the machine's is not known
const SHARES = [1, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 0.0005, 0.0002, 0.0001];
const WIDER = 0.5; // of the view that follows the contact: so that the wheels are known again
const LEAP = 20; // steps of the driver for Page Up and Page Down
const STRIDES = 36; // steps in a cycle with reduced motion

const LINES = {
  CENTRODE: "centrodes", PITCH: "pitch curve", PRIME: "prime circle", PATH: "paths of points",
};
const SIDES = { drive: "driving flanks", coast: "coast flanks" };

const element = (id) => document.getElementById(id);
const read = (id) => JSON.parse(element(id).textContent);

const still = matchMedia("(prefers-reduced-motion: reduce)");
const dark = matchMedia("(prefers-color-scheme: dark)");

const page = {
  shown: read("document"),
  place: 0,
  cycles: 0, // played so far: wheels need not have returned to their start
  // what is shown of the scene
  seen: {
    points: true, action: true, carry: true, pitch: false, names: true, forces: true,
    contacts: [], lines: { PITCH: true },
    colouring: "", // a label of values, or nothing
  },
  colours: palette(),
  playing: false,
  ghost: null, // another document that is drawn beneath this one
  numbers: null, // those of the design file in the live view: `at`, `has`, `move`
  changed() {}, // is told when what is seen has changed
  forth: 1, // -1 on the way back of an open pair
  get scene() { return this.shown.scene; },
  get title() { return this.shown.title; },
  get chosen() { return this.seen.chosen; },
  go,
  point,
  key,
};

const parts = new Parts(element("parts"), moved, draw);
const charts = new Charts(element("charts"), page, element("further"));
const measuring = new MeasureTool(page, parts, element("measures"), element("asked"), redraw);
page.seen.marked = [(poses, pixel) => measuring.marks(poses, pixel)];
page.tool = null; // of the picture, where nothing is measured

// --- places --------------------------------------------------------------------------------------

// Move parts and cursors to a place of the driver, in its unit.
function go(place) {
  const { places } = page.scene;
  page.place = Math.min(places.at(-1), Math.max(places[0], Number(place)));
  page.cycles = 0;
  page.changed();
  redraw();
}

const step = (count) => {
  const { places } = page.scene;
  const { index, part } = spotOf(places, page.place);
  const near = index + Math.round(part);
  go(places[Math.min(places.length - 1, Math.max(0, near + count))]);
};

// Decimals that distinguish neighbouring places.
function decimals() {
  const { places } = page.scene;
  const least = (places.at(-1) - places[0]) / (places.length - 1);
  return Math.max(0, Math.ceil(-Math.log10(least)));
}

// The place in words, with the value of the ratio, or of the first chart that moves.
function told() {
  const [name, unit = ""] = page.scene.driver.split(", ");
  const words = [`${name} = ${page.place.toFixed(decimals())} ${unit}`.trim()];
  const moving = page.shown.charts.filter((one) => one.moves);
  const chart = moving.find((one) => one.name === "ratio") ?? moving[0];
  const lines = chart?.lines.filter((one) => !one.dots) ?? [];
  const values = lines.length ? valuesAt(lines[0], page.place) : [];
  const [axis, measure = ""] = chart?.y.split(", ") ?? [];
  const whose = lines.length > 1 ? `${lines[0].label}: ` : "";
  // of one output by name, as in "Place of ram"; lines of several outputs have their names
  const [title, output] = chart?.title.toLowerCase().split(" of ") ?? [];
  const alone = title === axis && output && !/, |^the /.test(output);
  const named = alone && !whose.toLowerCase().startsWith(output);
  const what = named ? axis + chart.title.slice(axis.length) : axis;
  if (values.length) words.push(`${whose}${what} = ${values.join(" | ")} ${measure}`.trim());
  return words.join(", ");
}

// The view was moved.
function moved() {
  redraw();
  page.changed();
}

let waiting = null;

function redraw() {
  waiting ??= requestAnimationFrame(() => {
    waiting = null;
    draw();
  });
}

function draw() {
  parts.draw(page.place, page.cycles, page.seen, page.colours);
  charts.mark(page.place);
  const poses = (place) => solidPosesOf(page.scene, place, page.cycles);
  solids.move(poses, page.place, page.scene);
  const slider = element("place");
  const { index, part } = spotOf(page.scene.places, page.place);
  slider.value = index + Math.round(part);
  const words = told();
  slider.setAttribute("aria-valuetext", words);
  element("told").textContent = words;
  element("mesh").setAttribute("aria-pressed", parts.following);
  element("parts").classList.toggle("near", !parts.fitted);
  measuring.tell();
}

// --- playing -------------------------------------------------------------------------------------

const stepwise = () => still.matches && !element("animate").checked;

function play(on) {
  if (on && stepwise()) {
    advance(1 / STRIDES);
    redraw();
    return;
  }
  page.playing = on;
  if (!on) page.changed();
  element("told").setAttribute("aria-live", on ? "off" : "polite");
  name();
  if (on) requestAnimationFrame((start) => tick(start, start));
}

function name() {
  const button = element("play");
  button.textContent = page.playing ? "Pause" : stepwise() ? "Step" : "Play";
  element("motions").hidden = !still.matches;
}

function tick(now, before) {
  if (!page.playing) return;
  const seconds = Math.min(0.1, (now - before) / 1000); // no jump after a pause of the page
  advance(seconds / lasting().shown);
  draw();
  requestAnimationFrame((next) => tick(next, now));
}

// What goes on evenly while the parts play: the time of the motion, or the place itself.
const clock = () => (element("true").checked && page.scene.times) || page.scene.places;

// Play a share of a cycle. Closed cycles repeat; open ones reverse at their ends, or begin again if
// their time is known, which holds one way only.
function advance(share) {
  const { places, closed } = page.scene;
  const hands = clock();
  const [first, last] = [hands[0], hands.at(-1)];
  const again = closed || hands !== places;
  let now = between(hands, spotOf(places, page.place));
  now += (again ? 1 : page.forth) * share * (last - first);
  if (again && now > last) {
    now -= last - first;
    page.cycles += Number(closed);
  } else if (now > last || now < first) {
    page.forth = now > last ? -1 : 1;
  }
  page.place = between(places, spotOf(hands, now));
}

// Seconds that the whole motion lasts in the picture, and in the machine, or nothing.
const lasting = () => {
  const { times, places, rpm } = page.scene;
  const turns = (places.at(-1) - places[0]) / 360;
  const machine = times?.at(-1) ?? (rpm ? (60 * turns) / rpm : undefined);
  return { machine, shown: (machine ?? CYCLE) / Number(element("speed").value) };
};

// The speeds to choose from: shares of the machine's, or of an even one where it has none.
function speeds() {
  const { machine } = lasting();
  const shares = machine ? SHARES : EVEN;
  const choice = element("speed");
  if (choice.options.length === shares.length) return;
  choice.replaceChildren();
  for (const share of shares) {
    const text = share < 1 ? `1/${Math.round(1 / share)}` : String(share);
    add(choice, "option", { value: share }, text);
  }
  // about a cycle in twelve seconds
  const wanted = machine ? machine / CYCLE : 1;
  const far = (share) => Math.abs(Math.log(share / wanted));
  choice.value = shares.reduce((best, share) => (far(share) < far(best) ? share : best));
}

// How fast the parts play, where the machine's speed is known: in turns a minute, or as a share.
function factor() {
  const { scene } = page;
  const { machine } = lasting();
  const [, unit] = scene.driver.split(", ");
  const turns = unit === "deg" ? (scene.places.at(-1) - scene.places[0]) / 360 : 0;
  const rpm = (60 * turns) / machine;
  const share = Number(element("speed").value);
  const even = scene.times && clock() !== scene.times;
  element("factor").textContent = !machine || even ? ""
    : rpm ? `of true speed: ${brief(rpm * share)} of ${brief(rpm)} rpm` : "of true speed";
}

// --- controls ------------------------------------------------------------------------------------

const KEYS = {
  ArrowRight: () => step(1), ArrowUp: () => step(1),
  ArrowLeft: () => step(-1), ArrowDown: () => step(-1),
  PageUp: () => step(LEAP), PageDown: () => step(-LEAP),
  Home: () => go(page.scene.places[0]), End: () => go(page.scene.places.at(-1)),
  " ": () => play(!page.playing),
  "+": () => parts.zoom(1.25), "=": () => parts.zoom(1.25), "-": () => parts.zoom(0.8),
  0: () => fit(),
  Escape: () => measuring.choose(measuring.kind),
};

function key(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || !(event.key in KEYS)) return;
  event.preventDefault();
  KEYS[event.key]();
}

function fit() {
  parts.fit();
  redraw();
}

function check(home, text, on, set) {
  const label = add(home, "label");
  const box = add(label, "input", { type: "checkbox" });
  box.checked = on;
  box.addEventListener("change", () => {
    set(box.checked);
    redraw();
  });
  label.append(` ${text}`);
}

// Controls for what the scene contains; they are kept while this is the same.
let offered = "";

function offer() {
  const { scene, seen } = page;
  const sets = Object.keys(scene.contacts);
  const lines = scene.bodies.flatMap((body) => body.lines).filter((line) => line.dashed);
  const dashed = new Set(lines.map((line) => line.layer));
  const teeth = scene.bodies.some((body) => body.teeth);
  const named = scene.bodies.some((body) => body.names.length);
  const forces = scene.largest_force && `forces in joints, up to ${scene.largest_force}`;
  const members = membersOf(scene);
  const own = [teeth, Boolean(scene.pitch), named, forces, members];
  const wanted = JSON.stringify([sets.toSorted(), [...dashed].sort(), ...own]);
  if (wanted === offered) return;
  offered = wanted;
  const home = element("seen");
  home.replaceChildren();
  if (sets.length) {
    check(home, "contact points", seen.points, (on) => (seen.points = on));
    check(home, "line of action", seen.action, (on) => (seen.action = on));
  }
  if (teeth) check(home, "teeth in contact", seen.carry, (on) => (seen.carry = on));
  if (scene.pitch) check(home, "pitch point", seen.pitch, (on) => (seen.pitch = on));
  if (forces) check(home, forces, seen.forces, (on) => (seen.forces = on));
  if (named) check(home, "names", seen.names, (on) => (seen.names = on));
  for (const layer of dashed) {
    seen.lines[layer] ??= layer === "PATH";
    const text = LINES[layer] ?? layer.toLowerCase();
    check(home, text, seen.lines[layer], (on) => (seen.lines[layer] = on));
  }
  for (const [k, member] of members.length > 1 ? members.entries() : []) {
    const { called } = scene.bodies.find((one) => one.name === member);
    const row = add(home, "span", { class: "member" }, ` ${called}`);
    row.prepend(sampleOf({ ink: "what", dash: DASHES[k % DASHES.length] }));
  }
  sides(sets, teeth || sets.some((name) => scene.contacts[name].teeth));
  home.hidden = !home.children.length;
  element("mesh").hidden = !sets.length && !scene.pitch;
}

// Flanks touch on one side at a time; of cams all contacts are shown.
function sides(sets, single) {
  const choice = element("side");
  choice.replaceChildren();
  for (const name of sets) add(choice, "option", { value: name }, SIDES[name] ?? name);
  if (sets.length > 1) add(choice, "option", { value: "" }, "all");
  choice.value = single ? sets[0] : "";
  choice.parentNode.hidden = sets.length < 2;
  side();
}

function side() {
  const sets = Object.keys(page.scene.contacts);
  const one = element("side").value;
  page.seen.contacts = sets.length > 1 && one ? [one] : sets;
}

// The quantities that curves can be coloured by; the choice is kept while there is such a one.
function colourings() {
  const labels = Object.keys(page.scene.scales);
  if (!labels.includes(page.seen.colouring)) page.seen.colouring = "";
  const choice = element("colouring");
  choice.replaceChildren();
  for (const label of ["", ...labels]) {
    add(choice, "option", { value: label }, label.split(", ")[0] || "nothing");
  }
  choice.value = page.seen.colouring;
  element("colours").hidden = !labels.length;
}

// The scale of the colours, with the place of the largest value; empty for a draft without it.
function legend() {
  const { scene, seen } = page;
  const scale = scene.scales[seen.colouring];
  const home = element("scale");
  home.replaceChildren();
  if (!scale) return;
  const range = add(home, "span", {}, scale.told[0]);
  const bar = add(range, "span", { class: "bar", "aria-hidden": "true" });
  for (let k = 1; k <= LEVELS; k++) add(bar, "i", { style: `background: var(--level-${k})` });
  range.append(scale.told[1]);
  const [name, measure] = scene.driver.split(", ");
  add(home, "span", { class: "most" }, `largest at ${name} = ${brief(scale.place, measure)} ${measure}`);
}

function listen() {
  element("place").addEventListener("input", (event) => go(page.scene.places[event.target.value]));
  element("place").addEventListener("keydown", key);
  element("parts").addEventListener("keydown", key);
  element("play").addEventListener("click", () => play(!page.playing));
  element("animate").addEventListener("change", name);
  for (const id of ["speed", "true"]) element(id).addEventListener("change", factor);
  element("fit").addEventListener("click", fit);
  element("mesh").addEventListener("click", () => {
    if (parts.following) parts.fit();
    else parts.follow();
    redraw();
  });
  element("nearer").addEventListener("click", () => parts.zoom(1.25));
  element("farther").addEventListener("click", () => parts.zoom(0.8));
  element("poses").addEventListener("click", () => {
    save(`${page.title}_poses.svg`, posesSvgOf(page.scene, page.seen), "image/svg+xml");
  });
  element("measure").addEventListener("change", (event) => measure(event.target.value));
  document.addEventListener("click", (event) => {
    const told = event.target.closest(".goes");
    if (told) visit(told.textContent);
  });
  document.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && event.target.matches(".goes")) visit(event.target.textContent);
  });
  element("parts").addEventListener("pointermove", ({ offsetX, offsetY, buttons }) => {
    if (!buttons) reflect(parts.spotOf({ offsetX, offsetY }));
  });
  element("parts").addEventListener("pointerleave", () => reflect(null));
  element("side").addEventListener("change", () => {
    side();
    redraw();
  });
  element("colouring").addEventListener("change", (event) => {
    page.seen.colouring = event.target.value;
    legend();
    redraw();
  });
  element("svg").addEventListener("click", () => save(`${page.title}.svg`, svg(), "image/svg+xml"));
  element("png").addEventListener("click", () => {
    draw();
    element("parts").toBlob((blob) => save(`${page.title}.png`, blob, "image/png"));
  });
  still.addEventListener("change", name);
  dark.addEventListener("change", repaint);
  for (const [name, on] of [["pointerover", true], ["pointerout", false]]) {
    document.addEventListener(name, ({ target }) => {
      const row = target.closest?.(ABOUT);
      if (row) light(on ? bodiesIn(saidIn(row), page.scene) : []);
    });
  }
  const variantAt = ({ target }) => target.closest?.("[data-variant]")?.dataset.variant;
  for (const name of ["pointerover", "focusin"]) {
    document.addEventListener(name, (event) => {
      const variant = variantAt(event);
      if (variant !== undefined) point(Number(variant));
    });
  }
  for (const name of ["pointerout", "focusout"]) {
    document.addEventListener(name, (event) => {
      if (variantAt(event) !== undefined) point(undefined);
    });
  }
  window.addEventListener("hashchange", unfold);
  window.addEventListener("beforeprint", () => print(true));
  window.addEventListener("afterprint", () => print(false));
}

// What is told of parts: findings, main numbers, facts.
const ABOUT = "#findings li, #main dl > div, #facts tbody tr";

// The words of a row, without those of a whole message, which may name other parts.
const saidIn = (row) => (row.querySelector(".what") ?? row).textContent;

// Let bodies stand out in the picture.
function light(bodies) {
  if (String(page.seen.lit ?? []) === String(bodies)) return;
  page.seen.lit = bodies;
  redraw();
}

// Let what is told of the body at a point stand out.
let reflected = -1;

function reflect(spot) {
  const poses = posesOf(page.scene, page.place, page.cycles);
  const body = spot ? bodyAt(spot, page.scene, poses) : -1;
  if (body === reflected) return;
  reflected = body;
  for (const row of document.querySelectorAll(ABOUT)) {
    row.classList.toggle("lit", body >= 0 && bodiesIn(saidIn(row), page.scene).includes(body));
  }
}

// Go to the place, or to the tooth, that a text names, near enough to see it.
function visit(text) {
  const { scene } = page;
  const teeth = teethIn(text, scene);
  const [tooth] = teeth;
  page.seen.teeth = teeth;
  const place = placeIn(text, scene) ?? (tooth && placeOfTooth(scene, tooth.body, tooth.tooth));
  if (place !== null && place !== undefined) go(place);
  if (tooth) {
    const pose = posesOf(scene, page.place)[tooth.body];
    const { metal, teeth: ends } = scene.bodies[tooth.body];
    const points = toothOf(metal[0], ends[tooth.tooth - 1]);
    const middle = 2 * Math.floor(0.25 * points.length);
    parts.fit();
    Object.assign(parts.view, placed(pose, points.slice(middle, middle + 2)));
    parts.view.scale *= closer(scene);
    parts.fitted = false;
  } else if (meshAt(scene, page.place) && /phi1/.test(text)) {
    parts.follow();
    parts.view.scale *= WIDER;
  }
  page.changed();
  redraw();
  element("parts").scrollIntoView({ block: "nearest" });
}

// Mark what leads somewhere.
function enliven() {
  for (const one of document.querySelectorAll(".where")) {
    const text = one.textContent;
    const leads = placeIn(text, page.scene) !== null || teethIn(text, page.scene).length > 0;
    one.classList.toggle("goes", leads);
    if (!leads) continue;
    one.setAttribute("role", "link");
    one.tabIndex = 0;
  }
}

function measure(kind) {
  measuring.choose(kind);
  parts.tool = kind ? measuring : page.tool;
  element("parts").classList.toggle("measuring", Boolean(kind));
  measuring.tell();
}

// Have one variant stand out from the others, or none.
function point(variant) {
  if (page.chosen === variant) return;
  page.seen.chosen = variant;
  for (const row of document.querySelectorAll("[data-variant]")) {
    row.classList.toggle("chosen", Number(row.dataset.variant) === variant);
  }
  redraw();
  charts.repaint();
}

const svg = () => svgOf(page.scene, page.place, page.cycles, page.seen);

// --- looks ---------------------------------------------------------------------------------------

function repaint() {
  page.colours = palette();
  draw();
  charts.repaint();
}

// Open a folded section that a link leads to.
function unfold() {
  const folded = location.hash && document.querySelector(`${location.hash} > details:first-child`);
  if (folded) folded.open = true;
}

// On paper: another width as well.
function print(on) {
  paper(on);
  page.colours = { ...palette(), print: on };
  if (parts.fitted) parts.fit();
  draw();
  charts.print(on);
}

// --- documents -----------------------------------------------------------------------------------

// Show another document or a draft; the place, the view and the choices stay as they are.
function show(next) {
  page.shown = replaced(page.shown, next);
  present(Boolean(next.charts));
  if (next.charts) solids.renew();
}

function present(whole) {
  const { scene } = page;
  parts.scene = scene;
  if (whole) {
    offer();
    colourings();
    element("pace").hidden = !scene.times;
  }
  legend();
  enliven();
  measuring.keep();
  speeds();
  factor();
  element("place").max = scene.places.length - 1;
  page.place = Math.min(scene.places.at(-1), Math.max(scene.places[0], page.place));
  draw();
  charts.show(page.shown.charts);
}

// Keep the document shown as a ghost beneath those to come, or let go of it.
function freeze(on) {
  page.ghost = on ? page.shown : null;
  page.seen.ghost = page.ghost?.scene;
  draw();
  charts.repaint();
}

window.gearcam = {
  show,
  page,
  parts,
  charts,
  freeze,
  redraw,
  placed,
  nearestTo,
  dot,
  go,
  svg,
  solids,
  get place() { return page.place; },
  poses: () => posesOf(page.scene, page.place, page.cycles),
};

page.place = page.scene.start;
listen();
name();
present(true);
performance.mark("first-picture");
