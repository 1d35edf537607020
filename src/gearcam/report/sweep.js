// Charts of a sweep: all show the same variants, filtered by ranges of facts.
const sweep = JSON.parse(document.getElementById("document").textContent);
const count = sweep.numbers.length;
const byId = (id) => document.getElementById(id);
const made = (tag, more = {}, ...inside) => {
  const element = Object.assign(document.createElement(tag), more);
  element.append(...inside);
  return element;
};

// --- columns -------------------------------------------------------------------------------------

function column(one) {
  const { buffer } = Uint8Array.from(atob(one.data), (sign) => sign.charCodeAt(0));
  const values = one.input ? new Float64Array(buffer) : new Float32Array(buffer);
  if (one.factor && one.factor !== 1) values.forEach((value, k) => (values[k] = value * one.factor));
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return { ...one, values, low, high };  // with its label and unit
}

const all = sweep.columns.map(column);
const inputs = all.filter((one) => one.input);
const columns = new Map(all.filter((one) => one.differs).map((one) => [one.name, one]));
const span = (one) => one.high > one.low ? one.high - one.low : 1;
const share = (one, value) => one.high > one.low ? (value - one.low) / span(one) : 0.5;
const clean = (value) => Number(value.toPrecision(7)); // facts come in single precision
const shown = (value) => brief(clean(value));
const word = (one, value) => one.words.length ? one.words[value] ?? "" : shown(value);
const titled = (one) => one.unit ? `${one.label}, ${one.unit}` : one.label;
const measure = (one, value) => one.unit ? `${word(one, value)} ${one.unit}` : word(one, value);
// as a design file has it: inputs have all their digits
const written = (one, k) => one.words.length ? one.words[one.values[k]] : String(one.values[k]);

/** Return a value for a column of numbers: with the decimals that its largest one needs. */
function cellOf(one, k) {
  const value = one.values[k];
  if (one.words.length || Number.isNaN(value)) return word(one, value);
  if (one.values.every((each) => Number.isNaN(each) || Number.isInteger(each))) return String(value);
  const most = Math.max(Math.abs(one.low), Math.abs(one.high));
  return lined([value, most].map(clean), one.unit)[0];
}

// --- which variants ------------------------------------------------------------------------------

const MOST = { points: 10000, lines: 3000, small: 2000 };  // drawn; more are thinned
const ranges = new Map();
const kept = new Uint8Array(count).fill(1);
let inside = count;
let chosen = -1;

// by chance, but the same each time: a regular choice would miss values of a grid
const order = Uint32Array.from({ length: count }, (_, k) => k);
for (let k = count - 1, seed = 1; k > 0; k -= 1) {
  seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
  const other = Math.floor(seed / 2 ** 32 * (k + 1));
  [order[k], order[other]] = [order[other], order[k]];
}

function filter() {
  kept.fill(1);
  for (const [name, [low, high]] of ranges) {
    const { values } = columns.get(name);
    for (let k = 0; k < count; k += 1) if (!(values[k] >= low && values[k] <= high)) kept[k] = 0;
  }
  inside = kept.reduce((a, b) => a + b, 0);
}

/** Return at most so many variants that are kept (1) or not (0). */
function some(pass, most) {
  const found = [];
  for (let k = 0; k < count && found.length < most; k += 1) {
    if (kept[order[k]] === pass) found.push(order[k]);
  }
  return found;
}

// --- drawing -------------------------------------------------------------------------------------

let colours = {};
let tints = [];

function readColours() {
  const root = document.documentElement;
  const style = getComputedStyle(root);
  const dark = matchMedia("(prefers-color-scheme: dark)").matches && !root.classList.contains("paper");
  for (const name of ["text", "muted", "edge", "rule", "line-1", "error", "pitch", "contact", "accent",
    "ground"]) {
    colours[name] = style.getPropertyValue(`--${name}`).trim();
  }
  // dark to light by hue and lightness, so that it is read without hues too
  const [from, to] = dark ? [45, 80] : [28, 56];
  tints = Array.from({ length: 33 }, (_, k) =>
    `hsl(${250 - 200 * k / 32} 70% ${from + (to - from) * k / 32}%)`);
}

const inkOf = (ink, k) => ink ? tints[Math.round(32 * share(ink, ink.values[k])) || 0]
  : colours["line-1"];

function begin(canvas) {
  const ratio = document.documentElement.classList.contains("paper") ? 3 : window.devicePixelRatio || 1;
  const { clientWidth: width, clientHeight: height } = canvas;
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  const pen = canvas.getContext("2d");
  pen.scale(ratio, ratio);
  pen.font = "12px system-ui, sans-serif";
  pen.fillStyle = colours.text;
  pen.strokeStyle = colours.edge;
  return [pen, width, height];
}

/** Return places on an axis with their texts, in steps of 1, 2 or 5, about `most` of them. */
function ticks(one, most = 6) {
  const { low, high } = one;
  if (one.words.length) {
    const step = Math.ceil(one.words.length / 12);
    const places = Array.from({ length: Math.ceil(one.words.length / step) }, (_, k) => k * step);
    return places.map((value) => [value, one.words[value]]);
  }
  const rough = (high - low) / most;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((factor) => factor * power >= rough);
  const first = Math.ceil(low / step);
  const count = Math.floor(high / step) - first + 1;
  const decimals = Math.max(0, -Math.floor(Math.log10(step * 1.0001)));
  const plain = decimals < 7 && Math.max(Math.abs(low), Math.abs(high)) < 1e7;
  return Array.from({ length: count }, (_, k) => {
    const value = (first + k) * step;
    return [value, plain ? value.toFixed(decimals) : shown(value)];
  });
}

const MARGIN = { left: 78, right: 14, top: 10, bottom: 42 };

/** Return where variants are in a chart; what a refused one does not have is at the edge. */
function placed(canvas, x, y, margin) {
  const { clientWidth: width, clientHeight: height } = canvas;
  const wide = width - margin.left - margin.right;
  const high = height - margin.top - margin.bottom;
  const across = (value) => margin.left + wide * (0.03 + 0.94 * share(x, value));
  const up = (value) => height - margin.bottom - high * (0.03 + 0.94 * share(y, value));
  const at = (k) => {
    const [a, b] = [across(x.values[k]), up(y.values[k])];
    if (sweep.refused[k] < 0 || (Number.isNaN(a) && Number.isNaN(b))) return [a, b];
    return [Number.isNaN(a) ? margin.left + 5 : a, Number.isNaN(b) ? height - margin.bottom - 5 : b];
  };
  return { x, y, at, across, up };
}

const axis = (id) => columns.get(byId(id).value);
const places = () => placed(byId("points"), axis("x"), axis("y"), MARGIN);

function drawVariants(pen, at, size, most) {
  const ink = axis("ink");
  for (const pass of [0, 1]) {
    for (const k of some(pass, most)) {
      const [a, b] = at(k);
      if (Number.isNaN(a) || Number.isNaN(b)) continue;
      const refused = sweep.refused[k] >= 0;
      if (refused || sweep.errors[k]) {
        pen.strokeStyle = pass ? colours.error : colours.rule;
        const half = Math.max(2, size * 0.7);
        pen.beginPath();
        pen.moveTo(a - half, b + half); pen.lineTo(a + half, b - half);
        if (refused) { pen.moveTo(a - half, b - half); pen.lineTo(a + half, b + half); }
        pen.stroke();
      } else {
        pen.fillStyle = pass ? inkOf(ink, k) : colours.rule;
        pen.fillRect(a - size / 2, b - size / 2, size, size);
      }
    }
  }
}

function ring(pen, [a, b], name, radius) {
  pen.strokeStyle = colours[name];
  pen.lineWidth = 2;
  pen.beginPath(); pen.arc(a, b, radius, 0, 7); pen.stroke();
}

function drawPoints(most = MOST.points) {
  const [pen, width, height] = begin(byId("points"));
  const plane = places();
  const { x, y, at, across, up } = plane;
  const bottom = height - MARGIN.bottom;
  pen.strokeStyle = colours.rule;
  pen.fillStyle = colours.muted;
  pen.textAlign = "center";
  let last = -Infinity;  // the end of a text, which the next one does not touch
  for (const [value, text] of ticks(x, width < 500 ? 4 : 6)) {
    const [place, half] = [across(value), pen.measureText(text).width / 2];
    pen.beginPath(); pen.moveTo(place, MARGIN.top); pen.lineTo(place, bottom); pen.stroke();
    if (place - half < last + 6) continue;
    last = place + half;
    pen.fillText(text, place, bottom + 16);
  }
  pen.textAlign = "right";
  for (const [value, text] of ticks(y)) {
    const level = up(value);
    pen.beginPath(); pen.moveTo(MARGIN.left, level); pen.lineTo(width - MARGIN.right, level); pen.stroke();
    pen.fillText(text, MARGIN.left - 6, level + 4, MARGIN.left - 26);
  }
  pen.strokeStyle = colours.edge;
  pen.strokeRect(MARGIN.left, MARGIN.top, width - MARGIN.left - MARGIN.right, bottom - MARGIN.top);
  pen.fillStyle = colours.text;
  pen.textAlign = "center";
  pen.fillText(titled(x), (MARGIN.left + width - MARGIN.right) / 2, height - 6,
    width - MARGIN.left - MARGIN.right);
  pen.save();
  pen.translate(12, (MARGIN.top + bottom) / 2);
  pen.rotate(-Math.PI / 2);
  pen.fillText(titled(y), 0, 0, bottom - MARGIN.top);
  pen.restore();
  const size = count > 3000 ? 2 : count > 600 ? 3 : 5;
  drawVariants(pen, at, size, most);
  drawFront(pen, plane, size);
  if (chosen >= 0) ring(pen, at(chosen), "contact", 8 + size / 2);
  nameBest(pen, plane, width);
  const ink = axis("ink");
  byId("shown").textContent = [
    `${inside} of ${count} variants are kept${inside > MOST.points ? `, ${MOST.points} are drawn` : ""}.`,
    sweep.reasons.length ? "× refused, at the edge where they have no fact." : "",
    sweep.errors.some(Boolean) ? "/ with errors." : "",
    front.length > 1 ? "Ringed: no other one is better in all goals." : "",
    ink ? `Colour: ${titled(ink)}, from ${word(ink, ink.low)} dark to ${word(ink, ink.high)} light.` : "",
  ].filter(Boolean).join(" ");
}

const picked = () => [...document.querySelectorAll("#choice input:checked")]
  .map((box) => columns.get(box.value));
const AXIS = { top: 74, bottom: 36, least: 110 };  // room for labels and ends of ranges, pixels

function drawAxes(most = MOST.lines) {
  const [pen, width, height] = begin(byId("axes"));
  const axes = picked();
  const step = width / Math.max(1, axes.length);
  const high = height - AXIS.top - AXIS.bottom;
  const place = (one, value) => height - AXIS.bottom - high * share(one, value);
  const ink = axis("ink");
  const drawn = Math.min(inside, most);
  for (const pass of [0, 1]) {
    pen.globalAlpha = pass ? Math.max(0.12, Math.min(0.8, 60 / drawn)) : 0.3;
    for (const k of some(pass, pass ? most : 300)) {
      pen.strokeStyle = !pass ? colours.rule : sweep.refused[k] >= 0 ? colours.error : inkOf(ink, k);
      pen.beginPath();
      let drawing = false;
      for (let j = 0; j < axes.length; j += 1) {
        const value = axes[j].values[k];
        if (Number.isNaN(value)) { drawing = false; continue; }
        if (drawing) pen.lineTo(step * (j + 0.5), place(axes[j], value));
        else pen.moveTo(step * (j + 0.5), place(axes[j], value));
        drawing = true;
      }
      pen.stroke();
    }
  }
  pen.globalAlpha = 1;
  axes.forEach((one, number) => drawAxis(pen, one, step * (number + 0.5), step, height, place));
  for (const end of byId("ends").children) putEnd(end, place);
  byId("thinned").textContent = inside > MOST.lines
    ? `${MOST.lines} of ${inside} are drawn as lines, ${MOST.small} in each small chart; ranges, `
      + "distributions and the best are those of all." : "";
}

function drawAxis(pen, one, x, step, height, place) {
  pen.strokeStyle = colours.text;
  pen.fillStyle = colours.text;
  pen.beginPath(); pen.moveTo(x, AXIS.top); pen.lineTo(x, height - AXIS.bottom); pen.stroke();
  pen.textAlign = "center";
  const lines = [""];
  for (const part of titled(one).split(/(?<= )/)) {
    if (pen.measureText(lines.at(-1) + part).width > step - 8 && lines.at(-1)) lines.push("");
    lines[lines.length - 1] += part;
  }
  lines.slice(0, 3).forEach((line, row) => {
    pen.fillText(row === 2 && lines.length > 3 ? `${line.trim()} …` : line.trim(), x, 12 + 14 * row, step - 6);
  });
  pen.fillText(word(one, one.high), x, AXIS.top - 17, step - 6);
  pen.fillText(word(one, one.low), x, height - AXIS.bottom + 26, step - 6);
  if (!ranges.has(one.name)) return;
  const [low, high] = ranges.get(one.name).map((value) => place(one, value));
  pen.fillStyle = colours.accent;
  pen.globalAlpha = 0.4;
  pen.fillRect(x - 7, high, 14, Math.max(2, low - high));
  pen.globalAlpha = 1;
}

const rangeOf = (one) => ranges.get(one.name) ?? [one.low, one.high];

/** Put an end of a range, which takes keys, where it is, and tell its value. */
function putEnd(element, place) {
  const { fact, end } = element;
  const range = rangeOf(fact).map((value) => Math.min(fact.high, Math.max(fact.low, value)));
  element.style.top = `${place(fact, range[end]) - (end ? element.offsetHeight : 0)}px`;
  for (const [name, value] of [["min", end ? range[0] : fact.low],
    ["max", end ? fact.high : range[1]], ["now", range[end]],
    ["text", word(fact, fact.words.length ? Math.round(range[end]) : range[end])]]) {
    element.setAttribute(`aria-value${name}`, value);
  }
}

/** Make the ends of the ranges on the axes: below one that is kept at least, above one at most. */
function makeEnds() {
  const axes = picked();
  byId("lanes").style.minWidth = `${AXIS.least * axes.length}px`;
  byId("ends").replaceChildren(...axes.flatMap((fact, number) => [0, 1].map((end) => {
    const element = made("div", { fact, end, tabIndex: 0, className: end ? "most" : "least" });
    element.style.left = `${100 * (number + 0.5) / axes.length}%`;
    element.setAttribute("role", "slider");
    element.setAttribute("aria-orientation", "vertical");
    element.setAttribute("aria-label", `${titled(fact)}, at ${end ? "most" : "least"}`);
    return element;
  })));
}

const SMALL = { left: 4, right: 4, top: 4, bottom: 4 };

/** Make the small charts and the distributions of what is picked. */
function makeCharts() {
  makeEnds();
  const figure = (one) => made("figure", {}, made("figcaption", { textContent: titled(one) }),
    made("canvas"), made("small"));
  byId("over").textContent = axis("x").label;
  byId("spreads").replaceChildren(...picked().filter((one) => !one.words.length).map((one) =>
    Object.assign(figure(one), { fact: one })));
  byId("smalls").replaceChildren(...picked().filter((one) => one !== axis("x")).map((one) => {
    const chart = Object.assign(figure(one), { fact: one });
    chart.querySelector("small").textContent = `${word(one, one.low)} to ${measure(one, one.high)}`;
    const canvas = chart.querySelector("canvas");
    canvas.onclick = (event) => pick(event, placed(canvas, axis("x"), one, SMALL));
    return chart;
  }));
}

function drawSmalls(most = MOST.small) {
  for (const chart of byId("smalls").children) {
    const canvas = chart.querySelector("canvas");
    const [pen, width, height] = begin(canvas);
    pen.strokeRect(0.5, 0.5, width - 1, height - 1);
    const plane = placed(canvas, axis("x"), chart.fact, SMALL);
    const size = count > 600 ? 2 : 4;
    drawVariants(pen, plane.at, size, most);
    drawFront(pen, plane, size);
    if (chosen >= 0) ring(pen, plane.at(chosen), "contact", 5 + size / 2);
  }
}

const SHARES = [0.05, 0.25, 0.5, 0.75, 0.95];

/** Return the value below which a share of sorted values is, linear between two. */
function quantile(sorted, part) {
  const place = part * (sorted.length - 1);
  const below = Math.floor(place);
  const next = sorted[Math.min(below + 1, sorted.length - 1)];
  return sorted[below] + (place - below) * (next - sorted[below]);
}

function drawSpreads() {
  const told = [];
  for (const { fact, children: [, canvas, words] } of byId("spreads").children) {
    const values = fact.values.filter((value, k) => kept[k] && !Number.isNaN(value)).sort();
    const quantiles = values.length ? SHARES.map((part) => quantile(values, part)) : [];
    told.push([words, quantiles.map((value, j) => `${100 * SHARES[j]} %: ${shown(value)}`)]);
    const [pen, width, height] = begin(canvas);
    const bins = new Array(40).fill(0);
    for (const value of values) bins[Math.min(39, Math.floor(40 * share(fact, value)))] += 1;
    const most = Math.max(1, ...bins);
    pen.fillStyle = colours["line-1"];
    bins.forEach((number, k) => pen.fillRect(k * width / 40, height - number / most * (height - 4),
      width / 40 - 1, number / most * (height - 4)));
    pen.strokeStyle = colours.contact;
    for (const value of quantiles) {
      const x = width * share(fact, value);
      pen.beginPath(); pen.moveTo(x, 0); pen.lineTo(x, height); pen.stroke();
    }
  }
  // at the end, since a canvas asks for its size, which a changed text would lay out again
  for (const [words, quantiles] of told) words.textContent = quantiles.join(" · ") || "no variant";
}

let waiting = 0;

function paint() {
  waiting = 0;
  filter();
  if (!drag) findFront();
  drawPoints(drag ? 3000 : undefined);
  drawAxes(drag ? 500 : undefined);
  if (!drag || count <= MOST.lines) drawSpreads();
  if (!drag) drawSmalls();
}

/** Draw all once before the next picture; fewer variants while a range is dragged. */
function draw() {
  waiting ||= requestAnimationFrame(paint);
}
