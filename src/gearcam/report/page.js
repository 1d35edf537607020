// The page: controls, and the one place of the driver that parts and charts show.

const CYCLE = 12; // seconds of a cycle at speed 1
const LEAP = 20; // steps of the driver that Page Up and Page Down go
const STRIDES = 36; // steps in a cycle where motion is to be reduced

const LINES = { CENTRODE: "centrodes", PITCH: "pitch curve", PRIME: "prime circle" };
const SIDES = { drive: "driving flanks", coast: "coast flanks" };

const element = (id) => document.getElementById(id);
const read = (id) => JSON.parse(element(id).textContent);

const still = matchMedia("(prefers-reduced-motion: reduce)");
const dark = matchMedia("(prefers-color-scheme: dark)");

const page = {
  shown: read("document"),
  place: 0,
  cycles: 0, // that were played: wheels need not have come round
  // of the scene, by what is asked for
  seen: {
    points: true, action: true, carry: true, pitch: false, contacts: [], lines: { PITCH: true },
  },
  colours: palette(),
  playing: false,
  forth: 1, // -1 on the way back of what does not repeat
  get scene() { return this.shown.scene; },
  get title() { return this.shown.title; },
  go,
};

const parts = new Parts(element("parts"), () => redraw());
const charts = new Charts(element("charts"), page);

// --- places --------------------------------------------------------------------------------------

// Move parts and cursors to a place of the driver, in its unit.
function go(place) {
  const { places } = page.scene;
  page.place = Math.min(places.at(-1), Math.max(places[0], Number(place)));
  page.cycles = 0;
  redraw();
}

const step = (count) => {
  const { places } = page.scene;
  const { index, part } = spotOf(places, page.place);
  const near = index + Math.round(part);
  go(places[Math.min(places.length - 1, Math.max(0, near + count))]);
};

// Decimals in which neighbouring places differ.
function decimals() {
  const { places } = page.scene;
  const least = (places.at(-1) - places[0]) / (places.length - 1);
  return Math.max(0, Math.ceil(-Math.log10(least)));
}

// The place in words, with what the chart of the ratio, or else the first, tells there.
function told() {
  const [name, unit = ""] = page.scene.driver.split(", ");
  const words = [`${name} = ${page.place.toFixed(decimals())} ${unit}`.trim()];
  const moving = page.shown.charts.filter((one) => one.moves);
  const chart = moving.find((one) => one.name === "ratio") ?? moving[0];
  const line = chart?.lines[0];
  const values = line ? valuesAt(line, page.place) : [];
  const [, measure = ""] = chart?.y.split(", ") ?? [];
  if (values.length) words.push(`${line.label} = ${values.join(" | ")} ${measure}`.trim());
  return words.join(", ");
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
  const slider = element("place");
  const { index, part } = spotOf(page.scene.places, page.place);
  slider.value = index + Math.round(part);
  const words = told();
  slider.setAttribute("aria-valuetext", words);
  element("told").textContent = words;
  element("mesh").setAttribute("aria-pressed", parts.following);
  element("parts").classList.toggle("near", !parts.fitted);
}

// --- playing -------------------------------------------------------------------------------------

const stepwise = () => still.matches && !element("animate").checked;

function play(on) {
  if (on && stepwise()) {
    advance((page.scene.places.at(-1) - page.scene.places[0]) / STRIDES);
    redraw();
    return;
  }
  page.playing = on;
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
  const { places } = page.scene;
  const seconds = Math.min(0.1, (now - before) / 1000); // after a pause of the page nothing leaps
  advance((seconds * element("speed").value * (places.at(-1) - places[0])) / CYCLE);
  draw();
  requestAnimationFrame((next) => tick(next, now));
}

// What repeats goes on, what does not turns back at its ends.
function advance(way) {
  const { places, closed } = page.scene;
  const [first, last] = [places[0], places.at(-1)];
  page.place += closed ? way : page.forth * way;
  if (closed && page.place > last) {
    page.place -= last - first;
    page.cycles += 1;
  } else if (!closed && (page.place > last || page.place < first)) {
    page.forth = page.place > last ? -1 : 1;
    page.place = Math.min(last, Math.max(first, page.place));
  }
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

// Those controls that the scene has something for; they stay while it has the same.
let offered = "";

function offer() {
  const { scene, seen } = page;
  const sets = Object.keys(scene.contacts);
  const lines = scene.bodies.flatMap((body) => body.lines).filter((line) => line.dashed);
  const dashed = new Set(lines.map((line) => line.layer));
  const teeth = scene.bodies.some((body) => body.teeth);
  const wanted = JSON.stringify([sets.toSorted(), [...dashed].sort(), teeth, Boolean(scene.pitch)]);
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
  for (const layer of dashed) {
    seen.lines[layer] ??= false;
    const text = LINES[layer] ?? layer.toLowerCase();
    check(home, text, seen.lines[layer], (on) => (seen.lines[layer] = on));
  }
  sides(sets, teeth || sets.some((name) => scene.contacts[name].teeth));
  home.hidden = !home.children.length;
  element("mesh").hidden = !sets.length && !scene.pitch;
}

// Flanks touch on one side at a time; elsewhere all that touches is shown.
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

function listen() {
  element("place").addEventListener("input", (event) => go(page.scene.places[event.target.value]));
  element("place").addEventListener("keydown", key);
  element("parts").addEventListener("keydown", key);
  element("play").addEventListener("click", () => play(!page.playing));
  element("animate").addEventListener("change", name);
  element("fit").addEventListener("click", fit);
  element("mesh").addEventListener("click", () => {
    if (parts.following) parts.fit();
    else parts.follow();
    redraw();
  });
  element("nearer").addEventListener("click", () => parts.zoom(1.25));
  element("farther").addEventListener("click", () => parts.zoom(0.8));
  element("side").addEventListener("change", () => {
    side();
    redraw();
  });
  element("svg").addEventListener("click", () => save(`${page.title}.svg`, svg(), "image/svg+xml"));
  element("png").addEventListener("click", () => {
    draw();
    element("parts").toBlob((blob) => save(`${page.title}.png`, blob, "image/png"));
  });
  still.addEventListener("change", name);
  dark.addEventListener("change", repaint);
  window.addEventListener("hashchange", unfold);
  window.addEventListener("beforeprint", () => print(true));
  window.addEventListener("afterprint", () => print(false));
}

const svg = () => svgOf(page.scene, page.place, page.cycles, page.seen);

// --- looks ---------------------------------------------------------------------------------------

function repaint() {
  page.colours = palette();
  draw();
  charts.repaint();
}

// What a link leads to is open.
function unfold() {
  const folded = location.hash && document.querySelector(`${location.hash} > details`);
  if (folded) folded.open = true;
}

// Paper has a width of its own, light colours, no use for what moves, and nothing to open.
function print(on) {
  for (const one of document.querySelectorAll(".printed")) {
    if (on) one.dataset.open = one.open;
    one.open = on || one.dataset.open === "true";
  }
  document.documentElement.classList.toggle("paper", on);
  page.colours = { ...palette(), print: on };
  if (parts.fitted) parts.fit();
  draw();
  charts.print(on);
}

// --- documents -----------------------------------------------------------------------------------

// What a block says anew; what a reader had opened in it stays open.
function block(name, html) {
  const home = element(name);
  const open = [...home.querySelectorAll("details")].map((one) => one.open);
  home.innerHTML = html;
  home.querySelectorAll("details").forEach((one, k) => (one.open = open[k] ?? false));
}

// Show another document, or a draft of one without charts, contacts or some of its blocks: what it
// does not tell stays as it was, as do place, view and choices.
function show(next) {
  const blocks = { ...page.shown.blocks, ...next.blocks };
  for (const [name, html] of Object.entries(blocks)) {
    if (html !== page.shown.blocks[name]) block(name, html);
  }
  page.shown = { ...page.shown, ...next, blocks };
  present(Boolean(next.charts));
}

function present(whole) {
  const { scene } = page;
  document.title = page.title;
  parts.scene = scene;
  if (whole) offer();
  element("place").max = scene.places.length - 1;
  page.place = Math.min(scene.places.at(-1), Math.max(scene.places[0], page.place));
  draw();
  if (whole) charts.show(page.shown.charts);
}

window.gearcam = {
  show,
  go,
  svg,
  get place() { return page.place; },
  poses: () => posesOf(page.scene, page.place, page.cycles),
};

page.place = page.scene.start;
listen();
name();
present(true);
performance.mark("first-picture");
