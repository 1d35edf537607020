"use strict";
// What is done on the page of a sweep: a variant that is picked, ranges that are dragged.

// --- one variant -----------------------------------------------------------------------------------

function choose(k) {
  chosen = k;
  byId("number").value = sweep.numbers[k];
  const [name, text] = file(k);
  const table = (pairs) => made("table", {}, ...pairs.map(([one, value]) => made("tr", {},
    made("td", { textContent: one.label, title: one.name }), made("td", { className: kindOf(one), textContent: value }),
    made("td", { textContent: one.unit }))));
  const facts = [...columns.values()].filter((one) => !one.input && !Number.isNaN(one.values[k]));
  const told = sweep.reasons[sweep.refused[k]] ? `refused, ${sweep.reasons[sweep.refused[k]]}`
    : sweep.findings[sweep.found[k]]?.replaceAll(" ", ", ") ?? "no findings";
  const link = linkTo(k);
  link.textContent = `Save ${name}.toml`;
  const copy = made("button", { type: "button", textContent: "Copy",
    onclick: async () => { await navigator.clipboard.writeText(text); copy.textContent = "Copied"; } });
  byId("variant").replaceChildren(
    made("p", {}, made("strong", { textContent: `Variant ${sweep.numbers[k]}` }),
      `${names.has(k) ? `, ${names.get(k)}` : ""}: ${told}`),
    ...pictureOf(k),
    table(inputs.map((one) => [one, cellOf(one, k)])),
    made("div", { className: "facts" }, table(facts.map((one) => [one, cellOf(one, k)]))),
    made("p", {}, link, " ", copy, " then ", made("code", { textContent: `gearcam build ${name}.toml` })),
    made("details", {}, made("summary", { textContent: "The file" }), made("pre", { textContent: text })));
  if (columns.size) draw();
}

/** Show the variant that is nearest to a click, within 20 pixels. */
function pick(event, { at }) {
  let [best, least] = [-1, 400];
  for (let k = 0; k < count; k += 1) {
    if (!kept[k]) continue;
    const [x, y] = at(k);
    const square = (x - event.offsetX) ** 2 + (y - event.offsetY) ** 2;
    if (square < least) [best, least] = [k, square];
  }
  if (best >= 0) choose(best);
}

// --- ranges ----------------------------------------------------------------------------------------

let drag = null;

/** Keep the variants in a range of a fact; the whole range keeps those without the fact too. */
function keep(one, range) {
  const [low, high] = range;
  if (low <= one.low && high >= one.high) ranges.delete(one.name);
  else ranges.set(one.name, range);
  draw();
}

/** Return a range of which one end is moved, not beyond the other. */
function moved(one, end, value) {
  const range = [...rangeOf(one)];
  range[end] = end ? Math.max(range[0], Math.min(one.high, value))
    : Math.min(range[1], Math.max(one.low, value));
  return range;
}

function grab(event) {
  const axes = picked();
  const box = byId("axes").getBoundingClientRect();
  const { fact, end } = event.target;
  const one = fact ?? axes[Math.floor((event.clientX - box.left) / (box.width / axes.length))];
  if (!one) return;
  event.target.setPointerCapture(event.pointerId);
  const high = box.height - AXIS.top - AXIS.bottom;
  const value = (y) => one.low + span(one) * (box.bottom - AXIS.bottom - y) / high;
  const old = ranges.get(one.name);
  const from = value(event.clientY);
  drag = { one, end, value, from, y: event.clientY,
    old: old && old[0] <= from && from <= old[1] ? old : null };
}

function pull(event) {
  if (!drag || Math.abs(event.clientY - drag.y) < 3) return;
  const to = drag.value(event.clientY);
  const { one, end, from, old } = drag;
  drag.moved = true;
  if (end !== undefined) keep(one, moved(one, end, to));
  else keep(one, old ? old.map((each) => each + to - from) : [Math.min(from, to), Math.max(from, to)]);
}

function release() {
  if (!drag) return;
  if (!drag.moved && drag.end === undefined) ranges.delete(drag.one.name);
  drag = null;
  draw();
}

const KEYS = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1, PageUp: 10, PageDown: -10,
  Home: -Infinity, End: Infinity };

/** Move an end by keys: by a hundredth of the axis, by one word, by ten of them, all the way. */
function press(event) {
  const { fact, end } = event.target;
  if (event.key === "Delete" || event.key === "Escape") { ranges.delete(fact.name); draw(); return; }
  if (!(event.key in KEYS) || event.ctrlKey || event.altKey || event.metaKey) return;
  event.preventDefault();
  const step = fact.words.length ? 1 : span(fact) / 100;
  const value = rangeOf(fact)[end];
  keep(fact, moved(fact, end, (fact.words.length ? Math.round(value) : value) + step * KEYS[event.key]));
}

// --- start -----------------------------------------------------------------------------------------

function start() {
  const redraw = () => { makeCharts(); draw(); };
  const option = (one) => made("option", { value: one.name, textContent: titled(one) });
  for (const id of ["x", "y", "ink"]) {
    byId(id).append(...(id === "ink" ? [made("option", { value: "", textContent: "none" })] : []),
      ...[...columns.values()].map(option));
    byId(id).value = sweep[id];
    byId(id).onchange = redraw;
  }
  for (const one of columns.values()) {
    byId("choice").append(made("label", {}, made("input", {
      type: "checkbox", value: one.name, checked: sweep.picked.includes(one.name), onchange: redraw,
    }), made("span", { title: one.name, textContent: titled(one) })));
    if (one.input || one.words.length) continue;
    const select = made("select", { name: one.name, onchange: draw },
      ...[["", "–"], ["1", "small"], ["-1", "large"]].map(
        ([value, textContent]) => made("option", { value, textContent })));
    select.value = sweep.goals[one.name] ?? "";
    byId("goals").append(made("label", {}, select,
      made("span", { title: one.name, textContent: titled(one) })));
  }
  byId("wanted").open = !Object.keys(sweep.goals).length;
  byId("points").addEventListener("click", (event) => pick(event, places()));
  byId("lanes").addEventListener("pointerdown", grab);
  byId("lanes").addEventListener("pointermove", pull);
  for (const end of ["pointerup", "pointercancel"]) byId("lanes").addEventListener(end, release);
  byId("ends").addEventListener("keydown", press);
  byId("all").onclick = () => { ranges.clear(); draw(); };
  window.addEventListener("resize", draw);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { readColours(); draw(); });
  for (const [name, on] of [["beforeprint", true], ["afterprint", false]]) {
    window.addEventListener(name, () => {
      document.documentElement.classList.toggle("paper", on);
      readColours();
      paint();
    });
  }
  readColours();
  showSome();
  redraw();
  findFront();
  const best = [...names.keys()].at(-1) ?? Number(Object.keys(sweep.pictures)[0] ?? -1);
  if (best >= 0) choose(best);
}

byId("number").onchange = () => {
  const k = sweep.numbers.indexOf(Number(byId("number").value));
  if (k >= 0) choose(k);
};
if (columns.size) start();
else {
  for (const one of document.querySelectorAll(".drawn")) one.hidden = true;
  choose(0);
}
