// What can be saved: the drawing as SVG and PNG, data as CSV.

const PIXELS = 960; // width of a saved drawing for which widths of lines are told

const digits = (value) => String(Number(value.toFixed(4)));

// The whole drawing in mm, y upwards within the group; colours of paper.
function svgOf(scene, place, cycles, seen) {
  const [left, bottom, right, top] = scene.box;
  const margin = 0.03 * (right - left);
  const pixel = (right - left) / PIXELS;
  const [wide, tall] = [right - left + 2 * margin, top - bottom + 2 * margin];
  const colours = palette(true);
  const view = [left - margin, -top - margin, wide, tall].map(digits).join(" ");
  const size = `width="${digits(wide)}mm" height="${digits(tall)}mm" viewBox="${view}"`;
  const ground = `x="${digits(left - margin)}" y="${digits(-top - margin)}" width="${digits(wide)}" height="${digits(tall)}"`;
  const drawn = [];
  for (const mark of marksOf(scene, place, cycles, seen, pixel)) {
    if (mark.chains.length) drawn.push(elementOf(mark, pixel, colours));
  }
  return [
    `<svg xmlns="http://www.w3.org/2000/svg" ${size}>`,
    `<title>${escaped(`${scene.title}, ${scene.driver}: ${digits(place)}`)}</title>`,
    `<rect ${ground} fill="${colours.ground}"/>`,
    `<g transform="scale(1 -1)" stroke-linejoin="round" fill-rule="evenodd">`,
    ...drawn,
    "</g>",
    "</svg>",
    "",
  ].join("\n");
}

function elementOf(mark, pixel, colours) {
  const { x = 0, y = 0, turn = 0 } = mark.pose ?? {};
  // degrees in all digits: a wheel's rim moves a micrometre in a few millionths of a turn
  const pose = mark.pose ? ` transform="translate(${digits(x)} ${digits(y)}) rotate(${(turn * 180) / Math.PI})"` : "";
  const dash = mark.dash ? ` stroke-dasharray="${mark.dash.map((one) => digits(one * pixel)).join(" ")}"` : "";
  const way = mark.chains.map((points) => {
    const steps = [];
    for (let k = 0; k < points.length; k += 2) steps.push(`${digits(points[k])} ${digits(points[k + 1])}`);
    return `M${steps.join(" ")}${mark.closed ? "Z" : ""}`;
  });
  const style = `fill="${mark.fill ? colours[mark.fill] : "none"}" stroke="${colours[mark.ink]}" stroke-width="${digits((mark.width ?? 1.2) * pixel)}"`;
  return `<path${pose} ${style}${dash} d="${way.join("")}"/>`;
}

const escaped = (text) => text.replace(/[&<>"]/g, (sign) => `&#${sign.charCodeAt(0)};`);

// A column for each line, and one of its x before it where that is another than the last line's.
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
  const cell = (value) => (typeof value === "string" ? `"${value.replaceAll('"', '""')}"` : value ?? "");
  const row = (_, k) => columns.map((column) => cell(column[k])).join(",");
  return `${Array.from({ length: rows }, row).join("\r\n")}\r\n`;
}

function save(name, content, type) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000); // the browser may still be reading it
}
