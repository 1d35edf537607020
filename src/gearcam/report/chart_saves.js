// Saving a chart: its data as CSV, itself as SVG and PNG, in the colours of paper.

const LINE = 18; // height of a row of text, pixels
const GAP = 10; // around the whole, pixels
const SHARP = 3; // pixels of a saved picture for each of the page

// The buttons that save a chart, by the form of the file.
function savesOf(view) {
  const name = (end) => `${view.page.title}_${view.chart.name}.${end}`;
  const ways = {
    CSV: () => save(name("csv"), csvOf(view.chart), "text/csv"),
    SVG: () => save(name("svg"), chartSvgOf(view), "image/svg+xml"),
    PNG: () => pictured(chartSvgOf(view), (blob) => save(name("png"), blob, "image/png")),
  };
  view.tools.append(" Save ");
  return Object.entries(ways).map(([form, write]) => {
    const button = add(view.tools, "button", { type: "button", class: "save" }, form);
    button.addEventListener("click", write);
    return [form, button];
  });
}

// Make a PNG of an SVG, and hand it over.
function pictured(svg, take) {
  const image = new Image();
  const url = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
  image.addEventListener("load", () => {
    const size = { width: SHARP * image.width, height: SHARP * image.height };
    const canvas = Object.assign(document.createElement("canvas"), size);
    canvas.getContext("2d").drawImage(image, 0, 0, size.width, size.height);
    URL.revokeObjectURL(url);
    canvas.toBlob(take, "image/png");
  });
  image.src = url;
}

// A chart as it is seen, with its title above and its legend below.
function chartSvgOf({ chart, plot }) {
  const colours = palette(true);
  const head = 2 * LINE + GAP;
  const rows = rowsOf(chart);
  const [width, height] = [plot.width + 2 * GAP, head + plot.height + (rows.length + 0.5) * LINE];
  const box = Object.fromEntries(
    ["left", "top", "width", "height"].map((side) => [side, plot.bbox[side] / uPlot.pxRatio]),
  );
  const sheet = { xmlns: "http://www.w3.org/2000/svg", width, height, "font-size": 12 };
  const frame = { x: box.left, y: box.top, width: box.width, height: box.height };
  return [
    `<svg${attributes({ ...sheet, "font-family": "sans-serif", fill: colours.text })}>`,
    `<rect${attributes({ width, height, fill: colours.ground })}/>`,
    textOf(GAP, LINE + 2, chart.title, { "font-weight": "bold", "font-size": 14 }),
    textOf(GAP, 2 * LINE, chart.y, { fill: colours.muted }),
    `<g transform="translate(${GAP} ${head})">`,
    `<clipPath id="inside"><rect${attributes(frame)}/></clipPath>`,
    ...axesOf(chart, plot, box, colours),
    `<g clip-path="url(#inside)" fill="none">`,
    ...chart.lines.map((line, k) => lineOf(line, k, plot, box, colours)),
    ...limitsOf(chart, plot, box, colours),
    "</g></g>",
    ...rows.map(({ text, look, dots }, k) => {
      const y = head + plot.height + (k + 0.7) * LINE;
      return rowOf(GAP + box.left, y, text, look, dots, colours);
    }),
    "</svg>",
    "",
  ].join("\n");
}

// Rows of the legend: the lines, or the variants, and the limits.
function rowsOf({ lines, limits }) {
  const rows = lines.map((line, k) => ({ text: line.label, look: lookOf(line, k), dots: line.dots }));
  return [...rows, ...limits.map(({ label, value }) => ({ text: `${label}: ${brief(value)}` }))];
}

const textOf = (x, y, text, more = {}) =>
  `<text${attributes({ x, y, ...more })}>${escaped(text)}</text>`;

function rowOf(x, y, text, look, dots, colours) {
  const ink = look ? colours[look.ink] : colours.limit;
  const dash = look ? look.dash : [6, 4];
  const paint = { stroke: ink, "stroke-width": 1.6, fill: look?.full ? ink : "none" };
  const sample = dots
    ? `<circle${attributes({ cx: x + 14, cy: y - 4, r: 3, ...paint })}/>`
    : `<path${attributes({ d: `M${x} ${y - 4}h28`, "stroke-dasharray": dash.join(" "), ...paint })}/>`;
  return sample + textOf(x + 36, y, text);
}

function* axesOf(chart, plot, box, colours) {
  const rule = { stroke: colours.rule, "stroke-width": 1 };
  const ink = { fill: colours.muted };
  const [across, up] = plot.axes;
  const bottom = box.top + box.height;
  for (const [k, value] of across._splits.entries()) {
    const x = box.left + plot.valToPos(value, "x");
    yield `<path${attributes({ d: `M${digits(x)} ${box.top}V${bottom + 4}`, ...rule })}/>`;
    const text = across._values[k] ?? "";
    yield textOf(x, bottom + LINE, text, { "text-anchor": "middle", ...ink });
  }
  for (const [k, value] of up._splits.entries()) {
    const y = box.top + plot.valToPos(value, "y");
    yield `<path${attributes({ d: `M${box.left - 4} ${digits(y)}h${box.width + 4}`, ...rule })}/>`;
    yield textOf(box.left - 8, y + 4, up._values[k] ?? "", { "text-anchor": "end", ...ink });
  }
  const middle = box.left + 0.5 * box.width;
  yield textOf(middle, bottom + 2 * LINE, chart.x, { "text-anchor": "middle", ...ink });
}

function lineOf(line, k, plot, box, colours) {
  const { ink, dash, full } = lookOf(line, k);
  const paint = { stroke: colours[ink], "stroke-width": 1.6 };
  const spots = line.x.map((x, i) =>
    x === null || line.y[i] === null
      ? null
      : [box.left + plot.valToPos(x, "x"), box.top + plot.valToPos(line.y[i], "y")].map(digits));
  if (line.dots) {
    const fill = full ? colours[ink] : "none";
    const dot = ([cx, cy]) => `<circle cx="${cx}" cy="${cy}" r="2.5"/>`;
    return `<g${attributes({ ...paint, fill })}>${spots.filter(Boolean).map(dot).join("")}</g>`;
  }
  const way = spots.map((spot, i) => spot && `${i && spots[i - 1] ? "L" : "M"}${spot.join(" ")}`);
  return `<path${attributes({
    d: way.filter(Boolean).join(""), ...paint, "stroke-dasharray": dash.join(" ") || null,
  })}/>`;
}

function* limitsOf(chart, plot, box, colours) {
  const paint = { stroke: colours.limit, "stroke-dasharray": "6 4" };
  for (const { value } of chart.limits.filter((one) => one.seen)) {
    const y = digits(box.top + plot.valToPos(value, "y"));
    yield `<path${attributes({ d: `M${box.left} ${y}h${box.width}`, ...paint })}/>`;
  }
}

// A column for each line, preceded by its x if this differs from that of the line before.
function csvOf(chart) {
  const columns = [];
  let last = "";
  for (const line of chart.lines) {
    const own = JSON.stringify(line.x);
    if (own !== last) columns.push([chart.x, ...line.x]);
    columns.push([`${line.label}: ${chart.y}`, ...line.y]);
    last = own;
  }
  const rows = Math.max(...columns.map((column) => column.length));
  const quoted = (text) => `"${text.replaceAll('"', '""')}"`;
  const cell = (value) => (typeof value === "string" ? quoted(value) : value ?? "");
  const row = (_, k) => columns.map((column) => cell(column[k])).join(",");
  return `${Array.from({ length: rows }, row).join("\r\n")}\r\n`;
}
