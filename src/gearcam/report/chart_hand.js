// The hand on a chart: it reads curves, moves the parts, and chooses a stretch of the axis.

const LEAST = 5; // pixels of a stretch that is chosen; less is a click
const NEARER = 0.6; // share of the stretch that a key keeps
const REACH = 10; // of the pointer to a handle, pixels
const STEPS = 100; // of a key, over a chart without moving parts

class ChartHand {
  constructor(view) {
    this.view = view;
    this.peek = null; // where curves are read, on the horizontal axis
    this.choosing = false; // whether dragging chooses a stretch
    this.from = null; // where dragging began, pixels
    this.handle = null; // what is dragged, with its numbers when that began
    this.line = add(document.createElement("div"), "div", { class: "peek" });
    this.band = add(document.createElement("div"), "div", { class: "band" });
    const { tools, home } = view;
    this.zoom = add(tools, "button", { type: "button", "aria-pressed": "false" }, "Zoom");
    this.zoom.title = "Then drag over a stretch of the axis; or hold Shift";
    this.whole = add(tools, "button", { type: "button" }, "Whole");
    this.zoom.addEventListener("click", () => this.choose(!this.choosing));
    this.whole.addEventListener("click", () => view.zoom(null));
    home.addEventListener("keydown", (event) => this.key(event));
    home.addEventListener("blur", () => this.read(null));
  }

  describe(title) {
    const { chart, stretch } = this.view;
    this.zoom.hidden = chart.equal;
    this.whole.hidden = !stretch;
    this.zoom.setAttribute("aria-label", `Zoom by dragging: ${title}`);
    this.whole.setAttribute("aria-label", `Show the whole: ${title}`);
  }

  choose(on) {
    this.choosing = on;
    this.zoom.setAttribute("aria-pressed", on);
  }

  // Take hold of a plot that was drawn anew.
  hold(over) {
    over.append(this.line, this.band);
    this.band.hidden = true;
    over.addEventListener("pointerdown", (event) => this.down(event));
    over.addEventListener("pointermove", (event) => this.move(event));
    over.addEventListener("pointerup", (event) => this.up(event));
    over.addEventListener("pointercancel", () => this.up(null));
    over.addEventListener("pointerleave", () => {
      this.read(null);
      this.view.page.point?.(undefined);
    });
    over.addEventListener("dblclick", () => this.view.stretch && this.view.zoom(null));
    this.follow();
  }

  get varied() { return this.view.chart.lines[0]?.called !== undefined; }

  leftOf(event) {
    const { left, width } = this.view.plot.over.getBoundingClientRect();
    return Math.min(width, Math.max(0, event.clientX - left));
  }

  valueOf(left) { return this.view.plot.posToVal(left, "x"); }

  // The handle at a pointer.
  handleAt(event) {
    const { plot, movable } = this.view;
    const { left, top } = plot.over.getBoundingClientRect();
    return movable.find(({ x, y }) => {
      const across = plot.valToPos(x, "x") - (event.clientX - left);
      const up = plot.valToPos(y, "y") - (event.clientY - top);
      return Math.hypot(across, up) < REACH;
    });
  }

  // Hold a handle: the ends of the axes stay until it is dropped.
  grasp(handle, event) {
    const { view } = this;
    const { numbers } = view.page;
    const keys = Object.keys(handle.keys).filter(numbers.has);
    const at = Object.fromEntries(keys.map((key) => [key, numbers.at(key)]));
    view.frozen = view.ends(view.plot);
    this.handle = { ...handle, from: this.placeOf(event), at };
  }

  placeOf(event) {
    const { plot } = this.view;
    const { left, top } = plot.over.getBoundingClientRect();
    const [right, below] = [event.clientX - left, event.clientY - top];
    return { x: plot.posToVal(right, "x"), y: plot.posToVal(below, "y") };
  }

  // Move the numbers of the handle by as much as the pointer has moved.
  pull(event) {
    const { keys, from, at } = this.handle;
    const to = this.placeOf(event);
    const changes = Object.entries(at).map(([key, before]) => {
      const [right, up] = keys[key];
      return [key, before + right * (to.x - from.x) + up * (to.y - from.y)];
    });
    this.view.page.numbers.move(Object.fromEntries(changes));
  }

  down(event) {
    if (event.button) return;
    const { chart, page, plot } = this.view;
    const handle = !event.shiftKey && this.handleAt(event);
    if (handle) {
      plot.over.setPointerCapture(event.pointerId);
      this.read(null);
      this.grasp(handle, event);
      return;
    }
    this.from = this.leftOf(event);
    this.chosen = !chart.equal && (this.choosing || event.shiftKey || !chart.moves);
    plot.over.setPointerCapture(event.pointerId);
    this.read(null);
    if (!this.chosen) page.go(this.valueOf(this.from));
  }

  move(event) {
    const { chart, page, plot } = this.view;
    const left = this.leftOf(event);
    if (this.handle) {
      this.pull(event);
      return;
    }
    if (this.from === null) {
      plot.over.classList.toggle("grab", Boolean(this.handleAt(event)));
      if (event.pointerType !== "touch") this.read(this.valueOf(left));
      if (this.varied) page.point(this.view.nearest(event));
    } else if (this.chosen) {
      const [low, high] = [this.from, left].sort((a, b) => a - b);
      this.band.hidden = high - low < LEAST;
      Object.assign(this.band.style, { left: `${low}px`, width: `${high - low}px` });
    } else if (chart.moves) {
      page.go(this.valueOf(left));
    }
  }

  up(event) {
    if (this.handle) {
      if (event) this.pull(event);
      this.view.page.numbers.settle();
      this.handle = this.view.frozen = null;
      return;
    }
    const [from, chosen] = [this.from, this.chosen];
    this.from = null;
    this.band.hidden = true;
    if (from === null || !chosen || !event) return;
    const ends = [from, this.leftOf(event)].sort((a, b) => a - b);
    if (ends[1] - ends[0] < LEAST) {
      if (this.view.chart.moves) this.view.page.go(this.valueOf(from));
      return;
    }
    this.choose(false);
    this.view.zoom(ends.map((left) => this.valueOf(left)));
  }

  // Read the curves at a place, or no longer.
  read(place) {
    if (this.peek === place) return;
    this.peek = place;
    this.follow();
    this.view.mark(this.view.page.place);
  }

  follow() {
    const { plot } = this.view;
    this.line.hidden = this.peek === null;
    if (this.peek === null || !plot) return;
    this.line.style.transform = `translateX(${plot.valToPos(this.peek, "x")}px)`;
  }

  key(event) {
    const { view } = this;
    if (!view.plot || event.ctrlKey || event.metaKey || event.altKey) return;
    const keys = {
      "+": () => this.scale(NEARER), "=": () => this.scale(NEARER),
      "-": () => this.scale(1 / NEARER), 0: () => view.zoom(null),
      ...(!view.chart.moves && { ArrowRight: () => this.step(1), ArrowLeft: () => this.step(-1) }),
    };
    if (keys[event.key]) {
      event.preventDefault();
      keys[event.key]();
    } else if (view.chart.moves) view.page.key(event);
  }

  // Read the curves one step on, where no part moves.
  step(count) {
    const [low, high] = this.view.ends(this.view.plot)[0];
    const next = (this.peek ?? low) + (count * (high - low)) / STEPS;
    this.read(Math.min(high, Math.max(low, next)));
  }

  // Show a shorter or longer stretch about what is read, or about the place of the parts.
  scale(factor) {
    const { view } = this;
    const [low, high] = view.ends(view.plot)[0];
    const whole = view.chart.ends[0];
    if (view.chart.equal || view.chart.log.includes("x")) return;
    const given = this.peek ?? (view.chart.moves ? view.page.place : NaN);
    const about = given >= low && given <= high ? given : 0.5 * (low + high);
    const next = [low, high].map((end) => about + factor * (end - about));
    const [least, most] = [Math.max(whole[0], next[0]), Math.min(whole[1], next[1])];
    view.zoom(least <= whole[0] && most >= whole[1] ? null : [least, most]);
  }
}
