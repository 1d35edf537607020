// Saving: the drawing as SVG, and how a file is handed over.

const POSES = 12; // of a sheet of poses
const ACROSS = 4; // of them in a row
const SHEET = 277; // width of the sheet, mm: A4 across
const PIXELS = 960; // nominal width of a saved drawing, for the widths of its lines

const digits = (value) => String(Number(value.toFixed(4)));

// Attributes of an element, numbers in steps of a tenth of a micrometre.
function attributes(values) {
  const shown = (value) => (typeof value === "number" ? digits(value) : value);
  const told = Object.entries(values).filter(([, value]) => value !== null);
  return told.map(([name, value]) => ` ${name}="${shown(value)}"`).join("");
}

// The whole drawing in mm, y upwards within the group, in the colours of paper.
function svgOf(scene, place, cycles, seen) {
  const [left, bottom, right, top] = scene.box;
  const margin = 0.03 * (right - left);
  const pixel = (right - left) / PIXELS;
  const corner = { x: left - margin, y: -top - margin };
  const size = { width: right - left + 2 * margin, height: top - bottom + 2 * margin };
  const sheet = {
    xmlns: "http://www.w3.org/2000/svg",
    width: `${digits(size.width)}mm`,
    height: `${digits(size.height)}mm`,
    viewBox: [corner.x, corner.y, size.width, size.height].map(digits).join(" "),
  };
  const colours = palette(true);
  const marks = [...marksOf(scene, place, cycles, seen, pixel)];
  return [
    `<svg${attributes(sheet)}>`,
    `<title>${escaped(`${scene.title}, ${scene.driver}: ${digits(place)}`)}</title>`,
    `<rect${attributes({ ...corner, ...size, fill: colours.ground })}/>`,
    `<g transform="scale(1 -1)" stroke-linejoin="round" fill-rule="evenodd">`,
    ...marks.filter((mark) => mark.chains.length).map((mark) => elementOf(mark, pixel, colours)),
    "</g>",
    ...marks.filter((mark) => mark.text).map((mark) => nameOf(mark, pixel, colours)),
    "</svg>",
    "",
  ].join("\n");
}

// A sheet of poses: the whole drawing at places evenly apart, each with its place.
function posesSvgOf(scene, seen) {
  const { places, closed, driver } = scene;
  const [left, bottom, right, top] = scene.box;
  const [wide, tall] = [1.08 * (right - left), 1.08 * (top - bottom)];
  const pixel = (right - left) / (PIXELS / ACROSS);
  const line = 1.6 * NAMES * pixel;
  const rows = Math.ceil(POSES / ACROSS);
  const size = { width: ACROSS * wide, height: rows * (tall + line) };
  const shown = { width: SHEET, height: (SHEET * size.height) / size.width };
  const sheet = {
    xmlns: "http://www.w3.org/2000/svg", width: `${digits(shown.width)}mm`,
    height: `${digits(shown.height)}mm`, viewBox: `0 0 ${digits(size.width)} ${digits(size.height)}`,
  };
  const colours = palette(true);
  const [name, unit = ""] = driver.split(", ");
  const count = closed ? POSES : POSES - 1; // a cycle ends where it begins
  const pictures = Array.from({ length: POSES }, (_, k) => {
    const place = places[0] + (k / count) * (places.at(-1) - places[0]);
    const marks = [...marksOf(scene, place, 0, { ...seen, marked: [] }, pixel)];
    const corner = { x: (k % ACROSS) * wide, y: Math.floor(k / ACROSS) * (tall + line) };
    const [x, y] = [corner.x - left + 0.04 * wide, corner.y + line + top + 0.04 * tall];
    const drawn = marks.filter((mark) => mark.chains.length);
    const label = { x: corner.x + 0.04 * wide, y: corner.y + line, "font-size": NAMES * pixel };
    return [
      `<text${attributes({ ...label, "font-family": "sans-serif", fill: colours.text })}>`,
      `${escaped(`${name} = ${digits(place)} ${unit}`)}</text>`,
      `<g transform="translate(${digits(x)} ${digits(y)}) scale(1 -1)" stroke-linejoin="round"`,
      ` fill-rule="evenodd">${drawn.map((mark) => elementOf(mark, pixel, colours)).join("")}</g>`,
    ].join("");
  });
  const ground = `<rect${attributes({ ...size, fill: colours.ground })}/>`;
  return [`<svg${attributes(sheet)}>`, ground, ...pictures, "</svg>", ""].join("\n");
}

function elementOf({ chains, closed, pose, fill, ink, width = 1.2, dash }, pixel, colours) {
  const end = closed ? "Z" : "";
  const ways = chains.map((points) => `M${points.map(digits).join(" ")}${end}`);
  return `<path${attributes({
    // degrees in full precision: rounded ones would move a rim by more than a micrometre
    transform: pose
      ? `translate(${digits(pose.x)} ${digits(pose.y)}) rotate(${(pose.turn * 180) / Math.PI})`
      : null,
    fill: fill ? colours[fill] : "none",
    stroke: colours[ink],
    "stroke-width": width * pixel,
    "stroke-dasharray": dash ? dash.map((one) => digits(one * pixel)).join(" ") : null,
    d: ways.join(""),
  })}/>`;
}

// y is downwards here
function nameOf({ text, x, y, drop, ink }, pixel, colours) {
  const place = {
    x: x + BESIDE * pixel,
    y: -y + drop * pixel,
    "font-family": "sans-serif",
    "font-size": NAMES * pixel,
  };
  // twice, as few programs but browsers know paint-order
  const halo = { fill: "none", stroke: colours.ground, "stroke-width": 3 * pixel };
  return [halo, { fill: colours[ink] }]
    .map((paint) => `<text${attributes({ ...place, ...paint })}>${escaped(text)}</text>`)
    .join("");
}

const escaped = (text) => text.replace(/[&<>"]/g, (sign) => `&#${sign.charCodeAt(0)};`);

function save(name, content, type) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000); // the browser may still be reading it
}
