// What is done on the page of a sweep: goals, a variant that is picked, ranges that are dragged.

// --- the best ------------------------------------------------------------------------------------

const MOST_ROWS = 200;

function surpassing(goals) {
  const rows = [];
  for (let k = 0; k < count; k += 1) {
    if (!kept[k] || sweep.errors[k]) continue;
    const values = goals.map(([one, sign]) => sign * one.values[k]);
    if (values.every(Number.isFinite)) rows.push([k, values]);
  }
  rows.sort(([, a], [, b]) => {
    const j = a.findIndex((one, place) => one !== b[place]);
    return j < 0 ? 0 : a[j] - b[j];
  });
  const best = [];  // sorted, so that a later row never surpasses an earlier one
  for (const [k, values] of rows) {
    const beaten = best.some(([, other]) => other.every((one, j) => one <= values[j])
      && other.some((one, j) => one < values[j]));
    if (!beaten) best.push([k, values]);
  }
  return best.map(([k]) => k);
}

function findFront() {
  const goals = [...document.querySelectorAll("#goals select")].filter((one) => one.value)
    .map((one) => [columns.get(one.name), Number(one.value)]);
  front = goals.length ? surpassing(goals) : [];
  const heads = [...inputs, ...goals.map(([one]) => one)];
  const listed = front.slice(0, MOST_ROWS);
  const cells = heads.map((one) => one.input ? listed.map((k) => written(one, k))
    : lined(listed.map((k) => clean(one.values[k]))));
  const rows = listed.map((k, row) => made("tr", {
    tabIndex: 0, onclick: () => choose(k),
    onkeydown: (event) => { if (event.key === "Enter") choose(k); },
  }, ...[sweep.numbers[k], ...cells.map((column) => column[row])]
    .map((textContent) => made("td", { textContent }))));
  const more = front.length > MOST_ROWS ? `, the first ${MOST_ROWS} are listed` : "";
  byId("front").replaceChildren(...(rows.length ? [
    made("p", { textContent: `${front.length} of ${inside}${more}` }),
    made("table", {}, made("tr", {}, ...["variant", ...heads.map((one) => one.name)]
      .map((textContent) => made("th", { textContent }))), ...rows)] : []));
}

// --- one variant -----------------------------------------------------------------------------------

function file(k) {
  const name = `${sweep.name.slice(0, 80)}_${sweep.numbers[k]}`;
  const text = sweep.file.replace(/"@@(name|\d+)@@"/g, (_, mark) =>
    mark === "name" ? JSON.stringify(name) : written(inputs[mark], k));
  return [name, text];
}

function choose(k) {
  chosen = k;
  byId("number").value = sweep.numbers[k];
  const [name, text] = file(k);
  const table = (pairs) => made("table", {}, ...pairs.map((pair) =>
    made("tr", {}, ...pair.map((textContent) => made("td", { textContent })))));
  const facts = [...columns.values()].filter((one) => !one.input && !Number.isNaN(one.values[k]));
  const words = sweep.reasons[sweep.refused[k]] ? `refused, ${sweep.reasons[sweep.refused[k]]}`
    : sweep.findings[sweep.found[k]] ?? "no findings";
  const link = made("a", {
    textContent: `Save ${name}.toml`, download: `${name}.toml`,
    href: URL.createObjectURL(new Blob([text], { type: "application/toml" })),
  });
  const copy = made("button", { type: "button", textContent: "Copy",
    onclick: async () => { await navigator.clipboard.writeText(text); copy.textContent = "Copied"; } });
  byId("variant").replaceChildren(
    made("p", {}, made("strong", { textContent: `Variant ${sweep.numbers[k]}` }), `: ${words}`),
    table(inputs.map((one) => [one.name, written(one, k)])),
    made("div", { className: "facts" }, table(facts.map((one) => [one.name, word(one, one.values[k])]))),
    made("p", {}, link, " ", copy, " then ", made("code", { textContent: `gearcam build ${name}.toml` })),
    made("pre", { textContent: text }));
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
  const option = (one) => made("option", { value: one.name, textContent: one.name });
  for (const id of ["x", "y", "ink"]) {
    byId(id).append(...(id === "ink" ? [made("option", { value: "", textContent: "none" })] : []),
      ...[...columns.values()].map(option));
    byId(id).value = sweep[id];
    byId(id).onchange = redraw;
  }
  for (const one of columns.values()) {
    byId("choice").append(made("label", {}, made("input", {
      type: "checkbox", value: one.name, checked: sweep.picked.includes(one.name), onchange: redraw,
    }), one.name));
    if (one.input || one.words.length) continue;
    const select = made("select", { name: one.name, onchange: draw },
      ...[["", "–"], ["1", "small"], ["-1", "large"]].map(
        ([value, textContent]) => made("option", { value, textContent })));
    select.value = sweep.goals[one.name] ?? "";
    byId("goals").append(made("label", {}, select, one.name));
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
  readColours();
  redraw();
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
