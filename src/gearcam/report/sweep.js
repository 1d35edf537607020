"use strict";
// The page of a sweep: all charts show the same variants, filtered by ranges of facts.
const sweep = JSON.parse(document.getElementById("document").textContent);
const count = sweep.numbers.length;
const columns = new Map(sweep.columns.map((one) => [one.name, {
  ...one, values: Float64Array.from(one.values, (value) => value === null ? NaN : value),
}]));
for (const one of columns.values()) {
  const finite = one.values.filter(Number.isFinite);
  one.low = finite.reduce((a, b) => Math.min(a, b), Infinity);
  one.high = finite.reduce((a, b) => Math.max(a, b), -Infinity);
}
const byId = (id) => document.getElementById(id);
const made = (tag, more = {}, ...inside) => {
  const element = Object.assign(document.createElement(tag), more);
  element.append(...inside);
  return element;
};
const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const shown = (value) => typeof value === "number"
  ? String(Number(value.toPrecision(6))) : String(value);
const MOST = 20000;  // points drawn; more are thinned
const every = Math.max(1, Math.ceil(count / MOST));
const ranges = new Map();
let chosen = -1;
let front = [];
let kept = new Uint8Array(count).fill(1);

function filter() {
  kept = new Uint8Array(count).fill(1);
  for (const [name, [low, high]] of ranges) {
    const values = columns.get(name).values;
    for (let k = 0; k < count; k += 1) if (!(values[k] >= low && values[k] <= high)) kept[k] = 0;
  }
}

// --- charts --------------------------------------------------------------------------------------

function begin(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const { clientWidth: width, clientHeight: height } = canvas;
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  const pen = canvas.getContext("2d");
  pen.scale(ratio, ratio);
  pen.font = "12px system-ui, sans-serif";
  pen.fillStyle = colour("--text");
  pen.strokeStyle = colour("--edge");
  return [pen, width, height];
}

function ticks(low, high, most = 6) {
  if (!(high > low)) return [low];
  const rough = (high - low) / most;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((one) => one * power >= rough);
  const first = Math.ceil(low / step);
  return Array.from({ length: Math.floor(high / step) - first + 1 }, (_, k) => (first + k) * step);
}

const span = (one) => one.high > one.low ? one.high - one.low : 1;
const share = (one, value) => one.high > one.low ? (value - one.low) / span(one) : 0.5;
// dark to light by hue and lightness, so that it is read without hues too
const tint = (part) => `hsl(${Math.round(250 - 200 * part)} 70% ${Math.round(38 + 24 * part)}%)`;
const MARGIN = { left: 64, right: 14, top: 10, bottom: 34 };

function places() {
  const canvas = byId("points");
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  const [x, y] = [columns.get(byId("x").value), columns.get(byId("y").value)];
  const across = width - MARGIN.left - MARGIN.right;
  const up = height - MARGIN.top - MARGIN.bottom;
  return {
    x, y,
    at: (k) => [
      MARGIN.left + across * (0.02 + 0.96 * share(x, x.values[k])),
      height - MARGIN.bottom - up * (0.02 + 0.96 * share(y, y.values[k])),
    ],
    across: (value) => MARGIN.left + across * (0.02 + 0.96 * share(x, value)),
    up: (value) => height - MARGIN.bottom - up * (0.02 + 0.96 * share(y, value)),
  };
}

function drawPoints() {
  const [pen, width, height] = begin(byId("points"));
  const { x, y, at, across, up } = places();
  const ink = columns.get(byId("ink").value);
  pen.textAlign = "center";
  for (const value of ticks(x.low, x.high)) pen.fillText(shown(value), across(value), height - 18);
  pen.fillText(x.label, width / 2, height - 3);
  pen.textAlign = "right";
  for (const value of ticks(y.low, y.high)) pen.fillText(shown(value), MARGIN.left - 6, up(value) + 4);
  pen.strokeRect(MARGIN.left, MARGIN.top, width - MARGIN.left - MARGIN.right,
    height - MARGIN.top - MARGIN.bottom);
  const size = count > 3000 ? 1.5 : count > 600 ? 3 : 5;
  for (const pass of [0, 1]) {
    for (let k = 0; k < count; k += every) {
      if (kept[k] !== pass) continue;
      const [a, b] = at(k);
      if (!Number.isFinite(a) || !Number.isFinite(b)) continue;
      pen.fillStyle = !pass ? colour("--rule") : ink ? tint(share(ink, ink.values[k]) || 0)
        : colour("--line-1");
      if (sweep.refused[k] >= 0 || sweep.errors[k]) {
        pen.strokeStyle = pass ? colour("--error") : colour("--rule");
        pen.beginPath();
        pen.moveTo(a - size, b - size); pen.lineTo(a + size, b + size);
        if (sweep.refused[k] >= 0) { pen.moveTo(a - size, b + size); pen.lineTo(a + size, b - size); }
        pen.stroke();
      } else pen.fillRect(a - size / 2, b - size / 2, size, size);
    }
  }
  const ring = (k, name, radius) => {
    const [a, b] = at(k);
    pen.strokeStyle = colour(name);
    pen.lineWidth = 2;
    pen.beginPath(); pen.arc(a, b, radius, 0, 7); pen.stroke();
  };
  for (const k of front) ring(k, "--pitch", 5);
  if (chosen >= 0) ring(chosen, "--contact", 8);
  const inside = kept.reduce((a, b) => a + b, 0);
  byId("shown").textContent = `${inside} of ${count} variants are kept.`
    + (every > 1 ? ` Each ${every}th is drawn.` : "")
    + (sweep.refused.some((one) => one >= 0) ? " × refused" : "")
    + (sweep.errors.some(Boolean) ? " \\ with errors" : "")
    + (ink ? ` Colour: ${ink.label}, ${shown(ink.low)} dark to ${shown(ink.high)} light.` : "");
}

const picked = () => [...document.querySelectorAll("#choice input:checked")]
  .map((box) => columns.get(box.value));
const AXIS = { top: 44, bottom: 26 };

function drawAxes() {
  const [pen, width, height] = begin(byId("axes"));
  const axes = picked();
  const step = width / Math.max(1, axes.length);
  const up = height - AXIS.top - AXIS.bottom;
  const place = (one, value) => height - AXIS.bottom - up * share(one, value);
  const ink = columns.get(byId("ink").value);
  pen.globalAlpha = Math.max(0.08, Math.min(0.8, 60 / count));
  for (const pass of [0, 1]) {
    for (let k = 0; k < count; k += every) {
      if (kept[k] !== pass || (!pass && count > 2000)) continue;
      pen.strokeStyle = pass ? (ink ? tint(share(ink, ink.values[k]) || 0) : colour("--line-1"))
        : colour("--rule");
      pen.beginPath();
      let drawing = false;
      axes.forEach((one, number) => {
        const value = one.values[k];
        if (!Number.isFinite(value)) { drawing = false; return; }
        const point = [step * (number + 0.5), place(one, value)];
        if (drawing) pen.lineTo(...point); else pen.moveTo(...point);
        drawing = true;
      });
      pen.stroke();
    }
  }
  pen.globalAlpha = 1;
  axes.forEach((one, number) => {
    const x = step * (number + 0.5);
    pen.strokeStyle = colour("--text");
    pen.beginPath(); pen.moveTo(x, AXIS.top); pen.lineTo(x, height - AXIS.bottom); pen.stroke();
    pen.fillStyle = colour("--text");
    pen.textAlign = "center";
    const words = one.label.split(/(?<=[._ ])/);
    const lines = [""];
    for (const word of words) {
      if (pen.measureText(lines.at(-1) + word).width > step - 8 && lines.at(-1)) lines.push("");
      lines[lines.length - 1] += word;
    }
    lines.slice(-2).forEach((line, row) => pen.fillText(line, x, 12 + 14 * row, step));
    pen.fillText(shown(one.high), x, AXIS.top - 4);
    pen.fillText(shown(one.low), x, height - 10);
    if (ranges.has(one.name)) {
      const [low, high] = ranges.get(one.name);
      pen.fillStyle = colour("--accent");
      pen.globalAlpha = 0.4;
      pen.fillRect(x - 7, place(one, high), 14, Math.max(2, place(one, low) - place(one, high)));
      pen.globalAlpha = 1;
    }
  });
}

const SHARES = [0.05, 0.25, 0.5, 0.75, 0.95];

function drawSpreads() {
  byId("spreads").replaceChildren(...picked().map((one) => {
    const values = [];
    for (let k = 0; k < count; k += 1) {
      if (kept[k] && Number.isFinite(one.values[k])) values.push(one.values[k]);
    }
    values.sort((a, b) => a - b);
    const at = (part) => values[Math.min(values.length - 1, Math.floor(part * values.length))];
    const words = values.length
      ? SHARES.map((part) => `${100 * part} %: ${shown(at(part))}`).join(" · ") : "no variant";
    const canvas = made("canvas");
    const figure = made("figure", {}, made("figcaption", { textContent: one.label }), canvas,
      made("small", { textContent: words }));
    requestAnimationFrame(() => {
      const [pen, width, height] = begin(canvas);
      const bins = new Array(40).fill(0);
      for (const value of values) bins[Math.min(39, Math.floor(40 * share(one, value)))] += 1;
      const most = Math.max(1, ...bins);
      pen.fillStyle = colour("--line-1");
      bins.forEach((number, k) => pen.fillRect(k * width / 40, height - number / most * (height - 4),
        width / 40 - 1, number / most * (height - 4)));
      pen.strokeStyle = colour("--contact");
      for (const part of values.length ? SHARES : []) {
        const x = width * share(one, at(part));
        pen.beginPath(); pen.moveTo(x, 0); pen.lineTo(x, height); pen.stroke();
      }
    });
    return figure;
  }));
}

function draw() {
  filter();
  drawPoints();
  drawAxes();
  drawSpreads();
}

// --- the best ------------------------------------------------------------------------------------

function findFront() {
  const goals = [...document.querySelectorAll("#goals select")]
    .filter((one) => one.value).map((one) => [columns.get(one.name).values, Number(one.value)]);
  front = [];
  if (goals.length) {
    const rows = [];
    for (let k = 0; k < count; k += 1) {
      const values = goals.map(([column, sign]) => sign * column[k]);
      if (!sweep.errors[k] && values.every(Number.isFinite)) rows.push([k, values]);
    }
    const less = (a, b) => a.findIndex((one, j) => one !== b[j]);
    rows.sort(([, a], [, b]) => { const j = less(a, b); return j < 0 ? 0 : a[j] - b[j]; });
    const best = [];  // sorted, so that a later row never surpasses an earlier one
    for (const [k, values] of rows) {
      const beaten = best.some((other) => other.every((one, j) => one <= values[j])
        && other.some((one, j) => one < values[j]));
      if (!beaten) { best.push(values); front.push(k); }
    }
  }
  const names = [...sweep.keys, ...[...document.querySelectorAll("#goals select")]
    .filter((one) => one.value).map((one) => one.name)];
  const cell = (k, name) => name in sweep.given ? JSON.stringify(sweep.given[name][k])
    : shown(columns.get(name).values[k]);
  const rows = front.slice(0, 100).map((k) => {
    const row = made("tr", { tabIndex: 0, onclick: () => choose(k) },
      made("td", { textContent: sweep.numbers[k] }),
      ...names.map((name) => made("td", { textContent: cell(k, name) })));
    row.onkeydown = (event) => { if (event.key === "Enter") choose(k); };
    return row;
  });
  byId("front").replaceChildren(...(rows.length ? [made("table", {},
    made("tr", {}, ...["variant", ...names].map((name) => made("th", { textContent: name }))),
    ...rows)] : []));
  drawPoints();
}

// --- one variant -----------------------------------------------------------------------------------

function file(k) {
  const name = `${sweep.name}_${sweep.numbers[k]}`;
  let text = sweep.file.replace('"@@name@@"', JSON.stringify(name));
  sweep.keys.forEach((key, j) => {
    text = text.replace(`"@@${j}@@"`, () => JSON.stringify(sweep.given[key][k]));
  });
  return [name, text];
}

function choose(k) {
  chosen = k;
  const [name, text] = file(k);
  const facts = [...columns.values()].filter((one) => !one.input && Number.isFinite(one.values[k]))
    .map((one) => made("tr", {}, made("td", { textContent: one.label }),
      made("td", { textContent: shown(one.values[k]) })));
  const reason = sweep.refused[k] >= 0 ? sweep.reasons[sweep.refused[k]] : "";
  const findings = sweep.findings[k];
  const link = made("a", {
    textContent: `Save ${name}.toml`, download: `${name}.toml`,
    href: URL.createObjectURL(new Blob([text], { type: "application/toml" })),
  });
  const copy = made("button", { type: "button", textContent: "Copy",
    onclick: () => navigator.clipboard.writeText(text) });
  byId("variant").replaceChildren(
    made("p", {}, made("strong", { textContent: `Variant ${sweep.numbers[k]}` }),
      ...(reason ? [`: refused, ${reason}`] : findings ? [`: ${findings}`] : [])),
    made("table", {}, ...sweep.keys.map((key) => made("tr", {}, made("td", { textContent: key }),
      made("td", { textContent: JSON.stringify(sweep.given[key][k]) })))),
    made("div", { className: "facts" }, made("table", {}, ...facts)),
    made("p", {}, link, " ", copy, " then ", made("code", { textContent: `gearcam build ${name}.toml` })),
    made("pre", { textContent: text }));
  drawPoints();
}

byId("points").addEventListener("click", (event) => {
  const box = byId("points").getBoundingClientRect();
  const [a, b] = [event.clientX - box.left, event.clientY - box.top];
  const { at } = places();
  let [best, least] = [-1, 400];
  for (let k = 0; k < count; k += 1) {
    if (!kept[k]) continue;
    const [x, y] = at(k);
    const square = (x - a) ** 2 + (y - b) ** 2;
    if (square < least) [best, least] = [k, square];
  }
  if (best >= 0) choose(best);
});

let drag = null;
byId("axes").addEventListener("pointerdown", (event) => {
  const axes = picked();
  const box = byId("axes").getBoundingClientRect();
  const number = Math.floor((event.clientX - box.left) / (box.width / axes.length));
  byId("axes").setPointerCapture(event.pointerId);
  drag = { one: axes[number], from: event.clientY, box };
});
byId("axes").addEventListener("pointermove", (event) => {
  if (!drag || Math.abs(event.clientY - drag.from) < 3) return;
  const { one, from, box } = drag;
  const up = box.height - AXIS.top - AXIS.bottom;
  const value = (y) => one.low + span(one) * (box.bottom - AXIS.bottom - y) / up;
  ranges.set(one.name, [value(Math.max(from, event.clientY)), value(Math.min(from, event.clientY))]);
  requestAnimationFrame(draw);
});
byId("axes").addEventListener("pointerup", (event) => {
  if (drag && Math.abs(event.clientY - drag.from) < 3) { ranges.delete(drag.one.name); draw(); }
  drag = null;
});

function start() {
  const option = (one) => made("option", { value: one.name, textContent: one.label });
  for (const id of ["x", "y", "ink"]) {
    byId(id).append(...(id === "ink" ? [made("option", { value: "", textContent: "none" })] : []),
      ...[...columns.values()].map(option));
    byId(id).value = sweep[id];
    byId(id).onchange = draw;
  }
  for (const one of columns.values()) {
    byId("choice").append(made("label", {}, made("input", {
      type: "checkbox", value: one.name, checked: sweep.picked.includes(one.name), onchange: draw,
    }), ` ${one.label}`));
    if (one.input) continue;
    const select = made("select", { name: one.name, onchange: findFront },
      ...[["", "–"], ["1", "small"], ["-1", "large"]].map(
        ([value, textContent]) => made("option", { value, textContent })));
    select.value = sweep.goals[one.name] ?? "";
    byId("goals").append(made("label", {}, select, ` ${one.label}`));
  }
  draw();
  findFront();
}

window.addEventListener("resize", draw);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
if (columns.size) start();
