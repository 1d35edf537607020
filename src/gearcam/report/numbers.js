// Numbers as people read them; gearcam.base.readable does the same in Python, which chooses units.

const READ = {
  finest: { mm: 3, in: 4, deg: 2 }, // decimals of what is made and set, within five digits
  digits: 4, // significant ones, one more where a number begins with 1
  written: 5, // digits of a decimal that is written as it is
  faint: 2, // least digits of a small number beside a large one
  rounding: 1e-10, // distance from a decimal, as a share of it
  noise: 1e-6, // share of the largest number of a column that may be rounded to 0
  small: 1e-4, // smaller numbers have an exponent
  large: 1e7, // and larger ones
  kept: [0.01, 1e5], // sizes at which a chart keeps the unit that it had
};

const leadOf = (value) => Number(value.toExponential(6).split("e")[1]);

// The decimal that somebody wrote, or null.
function writtenOf(value) {
  const near = Number(value.toPrecision(READ.written));
  const size = Math.abs(value);
  const fits = value === 0 || (size >= READ.small && size < READ.large);
  return fits && Math.abs(near - value) <= READ.rounding * size ? near : null;
}

const placesOf = (written) => (String(written).split(".")[1] ?? "").length;

function decimalsOf(value, unit, digits) {
  if (value === 0) return 0;
  const lead = leadOf(value);
  const usual = unit in READ.finest
    ? Math.max(READ.digits, Math.min(READ.digits + 1, lead + 1 + READ.finest[unit]))
    : READ.digits + (value.toExponential(6).replace("-", "")[0] === "1");
  return (digits ?? usual) - 1 - lead;
}

function roundedTo(value, decimals) {
  const text = decimals < 0
    ? String(Math.round(value / 10 ** -decimals) * 10 ** -decimals)
    : value.toFixed(Math.min(decimals, 100));
  const size = Math.abs(Number(text));
  if (size === 0) return text.replace("-", "");
  if (size >= READ.small && size < READ.large) return text;
  return value.toExponential(Math.max(0, decimals + leadOf(value))).replace("+", "");
}

// A number without its unit, on which the digits depend.
function brief(value, unit = "") {
  const written = writtenOf(value);
  return written === null ? roundedTo(value, decimalsOf(value, unit)) : String(written + 0);
}

// Numbers of one quantity with the same number of decimals.
function lined(values, unit = "") {
  const written = values.map(writtenOf);
  const largest = values.reduce((one, other) => (Math.abs(other) > Math.abs(one) ? other : one), 0);
  const decimals = written.includes(null)
    ? decimalsOf(largest, unit)
    : Math.max(0, ...written.map(placesOf));
  return values.map((value, k) => {
    const faint = Math.abs(value) <= READ.noise * Math.abs(largest);
    const own = faint ? -Infinity : decimalsOf(value, unit, READ.faint);
    const least = written[k] === null ? own : Math.min(own, placesOf(written[k]));
    return roundedTo(value, Math.max(decimals, least));
  });
}

// A chart with its vertical axis in the unit that it had, while its numbers are not far from easy
// to read there: so the unit does not change while something is dragged.
function inUnitOf(chart, former) {
  const ratio = former ? former.factor / chart.factor : 1;
  const size = Math.max(...chart.range.map(Math.abs)) * ratio;
  const [low, high] = READ.kept;
  if (ratio === 1 || former.own !== chart.own || !(size >= low && size < high)) return chart;
  const scaled = (value) => (value === null ? null : value * ratio);
  return {
    ...chart,
    y: former.y,
    factor: former.factor,
    range: chart.range.map(scaled),
    ends: [chart.ends[0], chart.ends[1].map(scaled)],
    lines: chart.lines.map((line) => ({ ...line, y: line.y.map(scaled) })),
    limits: chart.limits.map((one) => ({ ...one, value: scaled(one.value) })),
    handles: chart.handles.map((one) => ({
      ...one, y: scaled(one.y),
      keys: Object.fromEntries(
        Object.entries(one.keys).map(([key, [by, up]]) => [key, [by, up / ratio]]),
      ),
    })),
  };
}
