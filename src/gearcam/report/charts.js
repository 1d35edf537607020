// The charts: uPlot draws the axes; lines, limits, values and the cursor are added here.

// Lines differ in colour and dashes.
const DASHES = [[], [9, 3], [9, 3, 2, 3], [2, 3], [14, 4], [5, 2]];
const INKS = 6; // colours of lines
const APART = 70; // between the marks of a line, pixels
const MARK = 4; // half the width of a mark
const NEAR = 12; // from the pointer, pixels
const FAINT = 0.15; // opacity of other variants than the one pointed at
const HEIGHT = 230; // of a chart, pixels
const PRINTED = { width: 312, height: 200 };
const PRINTED_FIRST = { ...PRINTED, width: 640 }; // over both columns
const MOST_TICKS = 8; // of a logarithmic axis
const ANGLES = [1, 2, 5, 10, 15, 30, 45, 90, 180, 360, 720]; // steps of an axis in degrees
const FEW = 4; // lines whose largest and least values are told in the legend
const FLAT = 1e-9; // a line that changes less, relative to its size, has no largest value
const SHORT = 2.5; // decades on an axis with ticks between powers of ten
const LETTERS = 12; // height of a line of text in a chart, pixels

// Numbers at an axis without rounding errors, however small the steps are.
const ticks = (_, values, axis, space, step) =>
  values.map((value) => String(Number((Math.round(value / step) * step).toPrecision(12))));

const inDegrees = (label) => label.endsWith(", deg");

// Steps between the ticks of an axis in degrees: parts of a turn, and decimals below a degree.
const angleSteps = [1e-6, 1e-5, 1e-4, 1e-3, 0.01, 0.1].flatMap((one) => [one, 2 * one, 5 * one])
  .concat(ANGLES, [10, 20, 50, 100].map((turns) => 360 * turns));

// The corners of a triangle that points to a place from above (1) or below (-1), pixels.
const peakOf = (side) => [[0, -side], [4, -7 * side], [-4, -7 * side]];

// Ticks of a logarithmic axis: powers of ten, and their double and fivefold on a short axis.
function powers(_, axis, low, high) {
  const decades = Math.log10(high / low);
  const step = Math.ceil(decades / MOST_TICKS);
  const found = [];
  for (let power = Math.floor(Math.log10(low)); 10 ** power <= high; power += step) {
    for (const part of decades < SHORT ? [1, 2, 5] : [1]) found.push(Number(`${part}e${power}`));
  }
  return found.filter((value) => value >= low && value <= high);
}

const powerTexts = (_, values) =>
  values.map((value) => {
    const plain = value >= 1e-3 && value < 1e4;
    return plain ? brief(value) : value.toExponential().replace("+", "");
  });

// All values of a line at a place: two at a jump, more where its pieces overlap.
function valuesAt(line, place) {
  const found = new Set();
  for (let k = 1; k < line.x.length; k++) {
    const [from, to] = [line.x[k - 1], line.x[k]];
    if (from === null || to === null || place < from || place > to) continue;
    const [low, high] = [line.y[k - 1], line.y[k]];
    if (low === null || high === null) continue;
    if (from === to) found.add(brief(low)).add(brief(high));
    else found.add(brief(low + ((place - from) / (to - from)) * (high - low)));
  }
  return [...found];
}

function add(parent, tag, attributes = {}, text = "") {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.textContent = text;
  parent.append(made);
  return made;
}

/* How a line is drawn. Lines of one design differ in colour and dashes; of variants the colour says
   which one, the second six having marks too, and dashes say what. Dots are alternately full and
   hollow. */
function lookOf({ variant, kind, dots }, k) {
  const [whose, what] = [variant ?? k, kind ?? k];
  return {
    ink: inkOf(whose), dash: DASHES[what % DASHES.length], full: dots && what % 2 === 0,
    marked: variant >= INKS,
  };
}

const inkOf = (number) => `line-${(number % INKS) + 1}`;

// A sample of a line, drawn by the style sheet's colours.
function sampleOf({ ink, dash, full, marked }, dots) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  made.setAttribute("class", `sample ${ink} ${full ? "full" : ""}`);
  made.setAttribute("viewBox", "0 0 28 8");
  made.setAttribute("aria-hidden", "true");
  const mark = marked ? `<path class="mark" d="M14 0L18 4L14 8L10 4Z"/>` : "";
  const dot = marked ? `<rect x="11" y="1" width="6" height="6"/>` : `<circle cx="14" cy="4" r="3"/>`;
  made.innerHTML = dots ? dot : `<path d="M0 4H28" stroke-dasharray="${dash.join(" ")}"/>${mark}`;
  return made;
}

class ChartView {
  constructor(chart, home, page) {
    this.page = page; // has `colours` and `go(place)`
    this.figure = add(home, "figure", { class: "chart" });
    const caption = add(this.figure, "figcaption");
    this.title = add(caption, "h3");
    const below = add(caption, "p", { class: "unit" });
    this.unit = add(below, "span");
    this.at = add(below, "output", { class: "at", "aria-live": "off" });
    this.home = add(this.figure, "div", { class: "plot", role: "img", tabindex: "0" });
    this.legend = add(this.figure, "ul", { class: "legend" });
    this.tools = add(this.figure, "div", { class: "tools" });
    this.cursor = add(document.createElement("div"), "div", { class: "cursor" });
    this.near = false;
    this.chart = chart;
    this.stretch = null; // the part of the horizontal axis that is shown
    this.hand = new ChartHand(this);
    this.saves = savesOf(this);
    this.describe();
    new ResizeObserver(() => this.resize()).observe(this.home);
  }

  describe() {
    const { title, x, y, lines, limits, marks, range } = this.chart;
    this.title.textContent = title;
    this.unit.textContent = y;
    const names = lines.map((line) => line.label).join(", ");
    const levels = limits.map((limit) => `; ${limit.label} ${brief(limit.value)}`).join("");
    const ends = range.map(brief).join(" to ");
    this.home.setAttribute("aria-label", `${title}. ${y} over ${x}: ${names}, ${ends}${levels}`);
    for (const [form, button] of this.saves) {
      button.setAttribute("aria-label", `Save ${form}: ${title}`);
    }
    this.hand.describe(title);
    this.legend.replaceChildren();
    this.values = lines[0]?.called === undefined ? this.rows() : this.rowsOfVariants();
    for (const limit of limits) {
      const beyond = limit.seen ? "" : ", outside this chart";
      const row = add(this.legend, "li", { class: "limit" });
      row.textContent = `${limit.label}: ${brief(limit.value)}${beyond}`;
    }
    for (const label of new Set(marks.map((one) => one.label))) {
      add(this.legend, "li", { class: "mark" }, label);
    }
  }

  // Add a row to the legend for each line, and return the elements that show its value.
  rows() {
    return this.chart.lines.map((line, k) => {
      const row = add(this.legend, "li");
      row.append(sampleOf(lookOf(line, k), line.dots), ` ${line.label} `);
      const value = add(row, "output", { "aria-live": "off" });
      const extremes = this.chart.lines.length <= FEW && this.extremes(line);
      if (extremes) add(row, "small", { class: "extremes" }, this.toldOf(extremes));
      return value;
    });
  }

  // A row for each variant, with the values of its lines, and one for what each dash means.
  rowsOfVariants() {
    const rows = new Map();
    const values = this.chart.lines.map((line, k) => {
      const { variant, called, dots } = line;
      if (!rows.has(variant)) {
        const row = add(this.legend, "li", { "data-variant": variant });
        row.append(sampleOf(lookOf({ ...line, kind: 0 }, k), dots), ` ${called} `);
        rows.set(variant, row);
      } else rows.get(variant).append(" ");
      return add(rows.get(variant), "output", { "aria-live": "off" });
    });
    const whats = new Map(this.chart.lines.map((line) => [line.kind, line]));
    for (const [kind, { what, dots }] of whats.size > 1 ? whats : []) {
      const look = { ...lookOf({ variant: 0, kind, dots }, kind), ink: "what" };
      add(this.legend, "li", { class: "what" }, ` ${what}`).prepend(sampleOf(look, dots));
    }
    return values;
  }

  toldOf({ largest, least }) {
    const [top, bottom] = [largest, least].map(({ x, y }) => `${brief(y)} at ${brief(x)}`);
    return ` largest ${top}, least ${bottom}`;
  }

  // The largest and the least value of a line in sight, with their places; none of a flat one.
  extremes({ dots, x, y }) {
    const [low, high] = this.stretch ?? [-Infinity, Infinity];
    let [largest, least] = [-1, -1];
    for (let k = 0; k < x.length; k++) {
      if (dots || this.chart.equal || y[k] === null || x[k] === null || x[k] < low || x[k] > high) continue;
      if (largest < 0 || y[k] > y[largest]) largest = k;
      if (least < 0 || y[k] < y[least]) least = k;
    }
    const size = Math.max(Math.abs(y[largest]), Math.abs(y[least]));
    if (largest < 0 || !(y[largest] - y[least] > FLAT * size)) return null;
    const spot = (k) => ({ x: x[k], y: y[k] });
    return { largest: spot(largest), least: spot(least) };
  }

  // Replace this chart by another one when it is in sight.
  expect(chart) {
    if (chart !== (this.waiting ?? this.chart)) this.waiting = chart;
  }

  // Replace this chart by another one.
  show(chart) {
    const shape = (one) => [one.log, one.equal, ...one.lines.map((line) => line.dots)].join();
    const same = shape(chart) === shape(this.chart) && chart.x === this.chart.x;
    this.chart = chart;
    if (!same) this.stretch = null;
    this.describe();
    if (!this.plot) return;
    if (same) {
      this.rescale();
    } else {
      this.plot.destroy();
      this.plot = null;
      this.draw();
    }
  }

  // Show another stretch of the horizontal axis, or the whole of it.
  zoom(stretch) {
    this.stretch = stretch;
    this.describe();
    this.rescale();
    this.mark(this.page.place);
  }

  // Draw anew what may have other ends.
  rescale() {
    this.plot.setData(this.data());
    this.level();
  }

  data() {
    return [null, ...this.chart.lines.map((line) => [line.x, line.y])];
  }

  draw() {
    if (this.plot) return;
    const ink = (name) => () => this.page.colours[name];
    const axis = {
      stroke: ink("muted"),
      font: "12px system-ui, sans-serif",
      labelFont: "12px system-ui, sans-serif",
      grid: { stroke: ink("rule"), width: 1 }, ticks: { stroke: ink("rule"), width: 1, size: 4 },
    };
    const scale = (name, k) => ({
      distr: this.chart.log.includes(name) ? 3 : 1, // logarithmic or linear
      range: (plot) => this.ends(plot)[k],
    });
    const ticked = (name) =>
      this.chart.log.includes(name)
        ? { splits: powers, values: powerTexts, filter: (_, values) => values }
        : { values: ticks, ...(inDegrees(this.chart[name]) && { incrs: angleSteps }) };
    // wide enough for most numbers, so that charts line up
    const wide = (_, texts) => 14 + 7 * Math.max(6, ...(texts ?? []).map((text) => text.length));
    this.plot = new uPlot({
      mode: 2, // each line has its own places, in any order
      width: this.home.clientWidth || PRINTED.width,
      height: this.home.clientHeight || HEIGHT,
      legend: { show: false },
      cursor: { x: false, y: false, drag: { x: false, y: false }, points: { show: false } },
      scales: { x: { time: false, ...scale("x", 0) }, y: scale("y", 1) },
      axes: [
        { ...axis, ...ticked("x"), label: this.chart.x, labelSize: 18, size: 30 },
        { ...axis, ...ticked("y"), size: wide },
      ],
      series: [null, ...this.chart.lines.map((line, k) => this.series(line, k))],
      hooks: {
        drawAxes: [(plot) => this.ghost(plot)],
        draw: [
          () => this.marks(), () => this.limits(), () => this.peaks(), () => this.handles(),
          () => this.follow(),
        ],
      },
    }, this.data(), this.home);
    this.level();
    this.plot.over.append(this.cursor);
    if (this.chart.moves) this.plot.over.classList.add("moves");
    this.hand.hold(this.plot.over);
  }

  // The ends of both axes; of one scale the shorter axis goes on to both sides.
  ends({ bbox }) {
    const { equal, ends } = this.chart;
    if (this.frozen) return this.frozen;
    if (this.stretch) return [this.stretch, this.heights()];
    if (!equal || !bbox?.width) return ends;
    const sizes = [bbox.width, bbox.height];
    const unit = Math.max(...ends.map(([low, high], k) => (high - low) / sizes[k]));
    return ends.map(([low, high], k) => {
      const [middle, half] = [0.5 * (low + high), 0.5 * unit * sizes[k]];
      return [middle - half, middle + half];
    });
  }

  // The ends of the vertical axis for what is within the stretch.
  heights() {
    const [low, high] = this.stretch;
    const seen = [];
    for (const { x, y } of this.chart.lines) {
      for (let k = 0; k < x.length; k++) {
        const after = Math.min(k + 1, x.length - 1);
        if (y[k] !== null && x[after] >= low && x[Math.max(k - 1, 0)] <= high) seen.push(y[k]);
      }
    }
    const [least, most] = [Math.min(...seen), Math.max(...seen)];
    if (!seen.length || !(most > least)) return this.chart.ends[1];
    if (this.chart.log.includes("y")) return [least / 1.1, most * 1.1];
    const room = 0.06 * (most - least);
    return [least - room, most + room];
  }

  // Give both axes one scale, now that their sizes are known.
  level() {
    if (!this.chart.equal) return;
    const [x, y] = this.ends(this.plot).map(([min, max]) => ({ min, max }));
    this.plot.batch(() => {
      this.plot.setScale("x", x);
      this.plot.setScale("y", y);
    });
  }

  series(line, k) {
    const facets = [{ scale: "x", auto: true }, { scale: "y", auto: true }];
    const look = lookOf(line, k);
    const paths = (plot, row) => this.line(plot, row, line, look);
    return { label: line.label, stroke: "none", facets, paths };
  }

  // The lines of the same chart of another design, beneath.
  ghost(plot) {
    const one = this.page.ghost?.charts.find(({ name }) => name === this.chart.name);
    if (!one || one.x !== this.chart.x) return;
    const { ctx: pen, bbox } = plot;
    pen.save();
    pen.beginPath();
    pen.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    pen.clip();
    pen.strokeStyle = this.page.colours.muted;
    pen.lineWidth = uPlot.pxRatio;
    pen.setLineDash([3 * uPlot.pxRatio, 3 * uPlot.pxRatio]);
    pen.beginPath();
    for (const { x, y, dots } of one.lines) {
      for (let k = 0; k < x.length && !dots; k++) {
        if (x[k] === null || y[k] === null) continue;
        const spot = [plot.valToPos(x[k], "x", true), plot.valToPos(y[k], "y", true)];
        if (k && x[k - 1] !== null && y[k - 1] !== null) pen.lineTo(...spot);
        else pen.moveTo(...spot);
      }
    }
    pen.stroke();
    pen.restore();
  }

  // Straight from point to point; null interrupts the line.
  line(plot, row, { dots, variant }, { ink, dash, full, marked }) {
    const [xs, ys] = plot.data[row];
    const { left, top, width, height } = plot.bbox;
    const pen = plot.ctx;
    const ratio = uPlot.pxRatio;
    pen.save();
    pen.beginPath();
    pen.rect(left, top - ratio, width, height + 2 * ratio);
    pen.clip();
    pen.strokeStyle = pen.fillStyle = this.page.colours[ink];
    pen.lineWidth = 1.6 * ratio;
    pen.setLineDash(dots ? [] : dash.map((length) => length * ratio));
    if (aside(this.page, variant)) pen.globalAlpha = FAINT;
    // many dots are drawn small, a single one large, and dots below lines
    const most = xs.length > 1 ? 2.5 : 5;
    const radius = Math.max(1.2 * ratio, Math.min(most * ratio, (0.5 * width) / xs.length));
    if (dots) pen.globalCompositeOperation = "destination-over";
    pen.beginPath();
    let up = true;
    const way = []; // of the line, for its marks
    for (let i = 0; i < xs.length; i++) {
      if (xs[i] === null || ys[i] === null) {
        up = true;
        continue;
      }
      const [x, y] = [plot.valToPos(xs[i], "x", true), plot.valToPos(ys[i], "y", true)];
      if (dots && marked) {
        pen.rect(x - radius, y - radius, 2 * radius, 2 * radius);
      } else if (dots) {
        pen.moveTo(x + radius, y);
        pen.arc(x, y, radius, 0, 7);
      } else if (up) pen.moveTo(x, y);
      else pen.lineTo(x, y);
      if (marked) way.push(x, y);
      up = false;
    }
    if (full) pen.fill();
    pen.stroke();
    if (marked && !dots) {
      pen.beginPath();
      for (const [x, y] of alongOf(way, APART * ratio, variant)) {
        const [first, ...others] = diamond(x, y, MARK * ratio);
        pen.moveTo(...first);
        for (const corner of others) pen.lineTo(...corner);
        pen.closePath();
      }
      pen.fill();
    }
    pen.restore();
    return null; // drawn already
  }

  // Marked places as dotted vertical lines.
  marks() {
    const { ctx: pen, bbox } = this.plot;
    const ratio = uPlot.pxRatio;
    pen.save();
    pen.strokeStyle = this.page.colours.muted;
    pen.lineWidth = ratio;
    pen.setLineDash([ratio, 3 * ratio]);
    for (const { value } of this.chart.marks) {
      const x = this.plot.valToPos(value, "x", true);
      pen.beginPath();
      pen.moveTo(x, bbox.top);
      pen.lineTo(x, bbox.top + bbox.height);
      pen.stroke();
    }
    pen.restore();
  }

  limits() {
    const { ctx: pen, bbox } = this.plot;
    const ratio = uPlot.pxRatio;
    pen.save();
    pen.strokeStyle = pen.fillStyle = this.page.colours.limit;
    pen.lineWidth = ratio;
    pen.setLineDash([6 * ratio, 4 * ratio]);
    pen.font = `${11 * ratio}px system-ui, sans-serif`;
    pen.textAlign = "right";
    pen.textBaseline = "alphabetic"; // the axes have set another one
    const height = (limit) => this.plot.valToPos(limit.value, "y", true);
    const middle = bbox.top + 0.5 * bbox.height;
    const off = (limit) => Math.abs(height(limit) - middle);
    const seen = this.chart.limits.filter((one) => one.seen).sort((a, b) => off(a) - off(b));
    const labels = []; // of limits close together the inner one is labelled; the legend lists all
    for (const limit of seen) {
      const y = height(limit);
      pen.beginPath();
      pen.moveTo(bbox.left, y);
      pen.lineTo(bbox.left + bbox.width, y);
      pen.stroke();
      const above = y > middle; // on the inner side, where there is room
      const base = y + (above ? -4 : LETTERS) * ratio;
      if (labels.some((other) => Math.abs(other - base) < LETTERS * ratio)) continue;
      pen.fillText(limit.label, bbox.left + bbox.width - 4 * ratio, base);
      labels.push(base);
    }
    pen.restore();
  }

  // Small triangles at the largest and the least value of each line.
  peaks() {
    const { ctx: pen, bbox } = this.plot;
    const ratio = uPlot.pxRatio;
    pen.save();
    pen.beginPath();
    pen.rect(bbox.left, bbox.top - 6 * ratio, bbox.width, bbox.height + 12 * ratio);
    pen.clip();
    pen.setLineDash([]);
    pen.lineWidth = ratio;
    pen.strokeStyle = this.page.colours.ground;
    for (const [k, line] of this.chart.lines.entries()) {
      const found = this.extremes(line);
      if (!found || aside(this.page, line.variant)) continue;
      pen.fillStyle = this.page.colours[lookOf(line, k).ink];
      for (const [{ x, y }, up] of [[found.largest, 1], [found.least, -1]]) {
        const [left, top] = [this.plot.valToPos(x, "x", true), this.plot.valToPos(y, "y", true)];
        pen.beginPath();
        for (const [dx, dy] of peakOf(up)) pen.lineTo(left + dx * ratio, top + dy * ratio);
        pen.closePath();
        pen.fill();
        pen.stroke();
      }
    }
    pen.restore();
  }

  // The handles whose numbers can be moved here.
  get movable() {
    const { numbers } = this.page;
    if (!numbers) return [];
    return this.chart.handles.filter(({ keys }) => Object.keys(keys).some(numbers.has));
  }

  // Small squares that can be dragged.
  handles() {
    const { ctx: pen } = this.plot;
    const ratio = uPlot.pxRatio;
    pen.save();
    pen.setLineDash([]);
    pen.lineWidth = 1.5 * ratio;
    pen.strokeStyle = this.page.colours.accent;
    pen.fillStyle = this.page.colours.ground;
    for (const { x, y } of this.movable) {
      const spot = [this.plot.valToPos(x, "x", true), this.plot.valToPos(y, "y", true)];
      const [left, top] = spot.map((one) => one - 4 * ratio);
      pen.fillRect(left, top, 8 * ratio, 8 * ratio);
      pen.strokeRect(left, top, 8 * ratio, 8 * ratio);
    }
    pen.restore();
  }

  // The variant whose line or dot is nearest to the pointer; none if all are far.
  nearest({ offsetX, offsetY }) {
    let [least, variant] = [NEAR, undefined];
    for (const line of this.chart.lines) {
      for (let k = 0; k < line.x.length; k++) {
        if (line.x[k] === null || line.y[k] === null) continue;
        const [x, y] = [this.plot.valToPos(line.x[k], "x"), this.plot.valToPos(line.y[k], "y")];
        const away = Math.hypot(x - offsetX, y - offsetY);
        if (away < least) [least, variant] = [away, line.variant];
      }
    }
    return variant;
  }

  // Show values and cursor at the place of the parts; the values at that of a pointer before it.
  mark(place) {
    if (!this.plot) return;
    const [low, high] = this.ends(this.plot)[0];
    const within = (x) => x >= low && x <= high;
    const inside = this.chart.moves && within(place);
    this.cursor.hidden = !inside;
    if (inside) this.follow();
    const { peek } = this.hand;
    const [, unit = ""] = this.chart.x.split(", ");
    this.at.textContent = peek === null ? "" : ` at ${brief(peek)} ${unit}`.trimEnd();
    const read = peek ?? (inside ? place : null);
    for (const [k, line] of this.chart.lines.entries()) {
      const told = read !== null && !line.dots ? valuesAt(line, read).slice(0, 3).join(" | ") : "";
      if (this.values[k].textContent !== told) this.values[k].textContent = told;
    }
  }

  // Called after each drawing, because the scale may have changed.
  follow() {
    this.hand.follow();
    this.cursor.style.transform = `translateX(${this.plot.valToPos(this.page.place, "x")}px)`;
  }

  resize(size = { width: this.home.clientWidth, height: this.home.clientHeight || HEIGHT }) {
    const { width, height } = this.plot ?? {};
    if (!this.plot || !size.width || (size.width === width && size.height === height)) return;
    this.plot.setSize(size);
    this.level();
  }

  // Colours have changed.
  repaint() {
    this.plot?.redraw(false, true);
  }
}

// Places along a way of points (flat), evenly apart; marks of different variants do not begin alike.
function alongOf(way, apart, variant) {
  const found = [];
  let left = apart * (0.2 + 0.13 * (variant % INKS)); // to the next one
  for (let k = 2; k < way.length; k += 2) {
    const [x, y, ex, ey] = way.slice(k - 2, k + 2);
    const long = Math.hypot(ex - x, ey - y);
    for (; left < long; left += apart) {
      found.push([x + (left / long) * (ex - x), y + (left / long) * (ey - y)]);
    }
    left -= long;
  }
  return found;
}

const diamond = (x, y, half) => [[x + half, y], [x, y + half], [x - half, y], [x, y - half]];

// Whether what belongs to a variant stands back behind another one that is pointed at.
const aside = ({ chosen }, variant) =>
  chosen !== undefined && variant !== undefined && variant !== chosen;
