// The charts: uPlot draws the axes; lines, limits, values and the cursor are added here.

// Lines differ in colour and dashes.
const DASHES = [[], [9, 3], [9, 3, 2, 3], [2, 3], [14, 4], [5, 2]];
const INKS = 6; // colours of lines
const APART = 70; // between the marks of a line, pixels
const MARK = 4; // half the width of a mark
const NEAR = 12; // from the pointer, pixels
const FAINT = 0.15; // opacity of other variants than the one pointed at
const HEIGHT = 230; // of a chart, pixels
const PRINTED = { width: 330, height: 200 };
const PRINTED_FIRST = { ...PRINTED, width: 676 }; // over both columns
const MOST_TICKS = 8; // of a logarithmic axis
const SHORT = 2.5; // decades on an axis with ticks between powers of ten
const LETTERS = 12; // height of a line of text in a chart, pixels
const AT_ONCE = 3; // charts drawn per frame, so that the parts keep moving
const LEADING = 3; // charts in sight, with those of studies; the others are folded

const brief = (value) => String(Number(value.toPrecision(5)));

// Numbers at an axis without rounding errors, however small the steps are.
const ticks = (_, values, axis, space, step) =>
  values.map((value) => String(Number((Math.round(value / step) * step).toPrecision(12))));

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
    this.unit = add(caption, "p", { class: "unit" });
    this.home = add(this.figure, "div", { class: "plot", role: "img" });
    this.legend = add(this.figure, "ul", { class: "legend" });
    this.button = add(this.figure, "button", { type: "button", class: "save" }, "Save CSV");
    this.button.addEventListener("click", () => {
      save(`${page.title}_${this.chart.name}.csv`, csvOf(this.chart), "text/csv");
    });
    this.cursor = document.createElement("div");
    this.cursor.className = "cursor";
    this.near = false;
    this.chart = chart;
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
    this.button.setAttribute("aria-label", `Save CSV: ${title}`);
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
      return add(row, "output", { "aria-live": "off" });
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

  // Replace this chart by another one when it is in sight.
  expect(chart) {
    if (chart !== (this.waiting ?? this.chart)) this.waiting = chart;
  }

  // Replace this chart by another one.
  show(chart) {
    const shape = (one) => [one.log, one.equal, ...one.lines.map((line) => line.dots)].join();
    const same = shape(chart) === shape(this.chart) && chart.x === this.chart.x;
    this.chart = chart;
    this.describe();
    if (!this.plot) return;
    if (same) {
      this.plot.setData(this.data());
      this.level();
    } else {
      this.plot.destroy();
      this.plot = null;
      this.draw();
    }
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
        : { values: ticks };
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
      hooks: { draw: [() => this.marks(), () => this.limits(), () => this.follow()] },
    }, this.data(), this.home);
    this.level();
    this.plot.over.append(this.cursor);
    if (this.chart.moves) this.plot.over.classList.add("moves");
    this.plot.over.addEventListener("click", (event) => this.clicked(event));
    if (this.chart.lines[0]?.called === undefined) return;
    this.plot.over.addEventListener("pointermove", (event) => this.page.point(this.nearest(event)));
    this.plot.over.addEventListener("pointerleave", () => this.page.point(undefined));
  }

  // The ends of both axes; of one scale the shorter axis goes on to both sides.
  ends({ bbox }) {
    const { equal, ends } = this.chart;
    if (!equal || !bbox?.width) return ends;
    const sizes = [bbox.width, bbox.height];
    const unit = Math.max(...ends.map(([low, high], k) => (high - low) / sizes[k]));
    return ends.map(([low, high], k) => {
      const [middle, half] = [0.5 * (low + high), 0.5 * unit * sizes[k]];
      return [middle - half, middle + half];
    });
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

  clicked(event) {
    if (!this.chart.moves) return;
    const left = event.clientX - this.plot.over.getBoundingClientRect().left;
    this.page.go(this.plot.posToVal(left, "x"));
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

  // Show values and cursor at the place of the parts.
  mark(place) {
    if (!this.plot) return;
    const [low, high] = this.chart.ends[0];
    const inside = this.chart.moves && place >= low && place <= high;
    this.cursor.hidden = !inside;
    if (inside) this.follow();
    for (const [k, line] of this.chart.lines.entries()) {
      const told = inside && !line.dots ? valuesAt(line, place).slice(0, 3).join(" | ") : "";
      if (this.values[k].textContent !== told) this.values[k].textContent = told;
    }
  }

  // Called after each drawing, because the scale may have changed.
  follow() {
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

// On paper: light colours, and folded sections open.
function paper(on) {
  for (const one of document.querySelectorAll(".printed")) {
    if (on) one.dataset.open = one.open;
    one.open = on || one.dataset.open === "true";
  }
  document.documentElement.classList.toggle("paper", on);
}

// All charts of a document. They are drawn once in sight, a few per frame.
class Charts {
  constructor(home, page) {
    this.home = home;
    this.page = page;
    this.views = [];
    this.next = null;
    this.sight = new IntersectionObserver((entries) => this.seen(entries), { rootMargin: "200px" });
  }

  show(charts) {
    const names = (list) => list.map((one) => one.name).join();
    if (names(charts) !== names(this.views.map((view) => view.chart))) this.rebuild(charts);
    else this.views.forEach((view, k) => view.expect(charts[k]));
    this.wake();
  }

  rebuild(charts) {
    this.sight.disconnect();
    this.home.querySelectorAll("figure").forEach((figure) => figure.remove());
    const more = this.home.querySelector("details"); // on a page of charts none is folded
    // a design has asked for the charts of studies, whose names are study.chart
    const folded = (chart, k) => more && k >= LEADING && !chart.name.includes(".");
    const place = (...one) => (folded(...one) ? more.querySelector("div") : this.home);
    this.views = charts.map((chart, k) => new ChartView(chart, place(chart, k), this.page));
    if (more) {
      const count = charts.filter(folded).length;
      more.hidden = !count;
      more.querySelector("summary").textContent = `${count} more charts`;
      this.home.append(more);
    }
    for (const view of this.views) this.sight.observe(view.figure);
  }

  seen(entries) {
    for (const { target, isIntersecting } of entries) {
      const view = this.views.find((one) => one.figure === target);
      view.near = isIntersecting;
      if (isIntersecting) view.mark(this.page.place);
    }
    this.wake();
  }

  wake() {
    this.next ??= requestAnimationFrame(() => {
      this.next = null;
      const due = this.views.filter((view) => view.near && (view.waiting || !view.plot));
      due.slice(0, AT_ONCE).forEach((view) => this.update(view));
      if (due.length > AT_ONCE) this.wake();
    });
  }

  update(view) {
    if (view.waiting) view.show(view.waiting);
    view.waiting = null;
    view.draw();
    view.mark(this.page.place);
  }

  mark(place) {
    for (const view of this.views) if (view.near) view.mark(place);
  }

  print(on) {
    for (const [k, view] of this.views.entries()) {
      if (on) this.update(view);
      const wide = !k && !this.home.classList.contains("alike");
      view.resize(on ? (wide ? PRINTED_FIRST : PRINTED) : undefined);
      view.repaint();
    }
  }

  repaint() {
    for (const view of this.views) view.repaint();
  }
}
