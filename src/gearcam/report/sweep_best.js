"use strict";
// The best variants of a sweep: found among those that are kept, drawn, named, and listed with their
// pictures and files.

const MOST_ROWS = 200;
let front = [];  // by the first goal
let names = new Map();  // of some of them, by their places: the best in each goal, and in all

/** Return the facts that are goals, each with 1 if it should be small and -1 if it should be large. */
const goals = () => [...document.querySelectorAll("#goals select")].filter((one) => one.value)
  .map((one) => [columns.get(one.name), Number(one.value)]);

function surpassing(wanted) {
  const rows = [];
  for (let k = 0; k < count; k += 1) {
    if (!kept[k] || sweep.errors[k]) continue;
    const values = wanted.map(([one, sign]) => sign * one.values[k]);
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

/** Return names of the best in each goal, and of the one nearest to the best of all, as shares. */
function namesOf(best, wanted) {
  const found = new Map();
  const name = (k, text) => found.set(k, found.has(k) ? `${found.get(k)}, ${text}` : text);
  if (!best.length) return found;
  if (wanted.length < 2) { name(best[0], "best"); return found; }
  const least = (of) => best.reduce((a, b) => of(b) < of(a) ? b : a);
  const ends = wanted.map(([one, sign]) => {
    const value = (k) => sign * one.values[k];
    const [low, high] = [value(least(value)), -leastOf(best, (k) => -value(k))];
    name(least(value), `${sign > 0 ? "least" : "largest"} ${one.label.replace(/^(least|smallest|largest) /, "")}`);
    return (k) => high > low ? (value(k) - low) / (high - low) : 0;
  });
  const away = (k) => Math.hypot(...ends.map((part) => part(k)));
  if (best.length > 2) name(least(away), wanted.length > 2 ? "nearest to all" : "nearest to both");
  return found;
}

/** Return the values of some variants with the same number of decimals. */
function cellsOf(one, list) {
  const values = list.map((k) => one.values[k]);
  const plain = one.words.length || values.every(Number.isInteger);
  return plain ? list.map((k) => cellOf(one, k)) : lined(values.map(clean), one.unit);
}

const kindOf = (one) => one.words.length ? "" : "number";
const leastOf = (list, of) => list.reduce((least, k) => Math.min(least, of(k)), Infinity);

function findFront() {
  const wanted = goals();
  front = wanted.length ? surpassing(wanted) : [];
  names = namesOf(front, wanted);
  const heads = [...wanted.map(([one]) => one), ...inputs];
  const pictured = front.some((k) => sweep.pictures[k]);
  const bests = new Map(wanted.map(([one, sign]) =>
    [one, sign * leastOf(front, (k) => sign * one.values[k])]));
  const cells = new Map(heads.map((one) => [one, cellsOf(one, front)]));
  const row = (k, number) => made("tr", {
    tabIndex: 0, onclick: () => choose(k),
    onkeydown: (event) => { if (event.key === "Enter" && event.target === event.currentTarget) choose(k); },
  }, made("td", { textContent: sweep.numbers[k] }), ...(pictured ? [made("td", {}, ...pictureOf(k))] : []),
  ...heads.map((one) => made("td", { textContent: cells.get(one)[number],
    className: `${kindOf(one)} ${bests.get(one) === one.values[k] ? "most" : ""}` })),
  made("td", { textContent: names.get(k) ?? "" }), made("td", {}, linkTo(k)));
  const more = front.length > MOST_ROWS ? `, the first ${MOST_ROWS} are listed` : "";
  const titles = ["variant", ...(pictured ? ["to one scale"] : []), ...heads.map(titled), "", "design file"];
  byId("front").replaceChildren(...(front.length ? [
    made("p", { textContent: `${front.length} of ${inside}${more}` }),
    made("table", {}, made("thead", {}, made("tr", {}, ...titles.map((textContent) =>
      made("th", { textContent })))), made("tbody", {}, ...front.slice(0, MOST_ROWS).map(row)))] : []));
}

/** Draw the best: the edge of what can be had, if the axes are two goals, and a mark for each. */
function drawFront(pen, { x, y, at }, size) {
  const best = front.filter((k) => kept[k]);
  const sign = (one) => goals().find(([goal]) => goal === one)?.[1];
  const both = sign(x) && sign(y) && x !== y;
  pen.strokeStyle = colours.pitch;
  pen.lineWidth = 1.5;
  if (both) {
    const along = best.toSorted((k, j) => sign(x) * (x.values[k] - x.values[j]));
    pen.beginPath();
    along.forEach((k, number) => {
      const [a, b] = at(k);
      if (number) pen.lineTo(a, at(along[number - 1])[1]);
      pen.lineTo(a, b);
    });
    pen.stroke();
  }
  for (const k of best) {
    const name = names.get(k);
    if (!name) { ring(pen, at(k), "pitch", 2 + size / 2); continue; }
    const [a, b] = at(k);
    pen.fillStyle = colours.pitch;
    pen.strokeStyle = colours.ground;
    pen.lineWidth = 1.5;
    pen.beginPath(); pen.arc(a, b, 5 + size / 2, 0, 7); pen.fill(); pen.stroke();
  }
}

/** Name the best ones beside their marks, each on the side where there is room. */
function nameBest(pen, { at }, width) {
  pen.font = "600 12px system-ui, sans-serif";
  pen.textBaseline = "middle";
  const taken = [];
  for (const [k, name] of names) {
    if (!kept[k]) continue;
    const [a, b] = at(k);
    const wide = pen.measureText(name).width;
    const right = a + 14 + wide < width - MARGIN.right;
    const from = right ? a + 12 : a - 12 - wide;
    let level = b;
    while (taken.some((one) => Math.abs(one.level - level) < 15
      && one.from < from + wide && from < one.from + one.wide)) level += 15;
    taken.push({ from, wide, level });
    pen.textAlign = "left";
    pen.lineWidth = 4;
    pen.lineJoin = "round";
    pen.strokeStyle = colours.ground;
    pen.strokeText(name, from, level);
    pen.fillStyle = colours.text;
    pen.fillText(name, from, level);
  }
}


// --- pictures and files ----------------------------------------------------------------------------

/** Return the small picture of a variant in a list; an empty one if there is none. */
function pictureOf(k) {
  const paths = sweep.pictures[k];
  if (!paths) return [];
  const picture = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  picture.setAttribute("viewBox", "-2 -2 136 92");
  picture.setAttribute("preserveAspectRatio", "xMidYMid");
  picture.setAttribute("role", "img");
  picture.setAttribute("aria-label", `Variant ${sweep.numbers[k]}`);
  picture.setAttribute("class", "small");
  for (const { ink, filled, d } of paths) {
    const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
    path.setAttribute("d", d);
    path.setAttribute("class", filled ? `ink-${ink} filled` : `ink-${ink}`);
    picture.append(path);
  }
  return [picture];
}

function file(k) {
  const name = `${sweep.name.slice(0, 80)}_${sweep.numbers[k]}`;
  const text = sweep.file.replace(/"@@(name|\d+)@@"/g, (_, mark) =>
    mark === "name" ? JSON.stringify(name) : written(inputs[mark], k));
  return [name, text];
}

/** Return a link that saves the design file of a variant. */
function linkTo(k) {
  const [name, text] = file(k);
  return made("a", { textContent: `${name}.toml`, download: `${name}.toml`,
    href: `data:application/toml;charset=utf-8,${encodeURIComponent(text)}` });
}

/** Show the variants that have pictures, where no goal lists them. */
function showSome() {
  const some = Object.keys(sweep.pictures).map(Number);
  byId("some").hidden = !some.length || Object.keys(sweep.goals).length > 0;
  const told = (k) => inputs.filter((one) => one.differs).slice(0, 2)
    .map((one) => `${one.label} ${measure(one, one.values[k])}`).join(", ");
  byId("pictured").replaceChildren(...some.map((k) => made("button", { type: "button",
    onclick: () => choose(k) }, ...pictureOf(k), made("span", {
    textContent: `${sweep.numbers[k]}: ${told(k)}` }))));
}
