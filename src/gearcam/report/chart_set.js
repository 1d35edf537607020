// All charts of a page: which are in sight, and how they are printed.

const LEADING = 3; // charts in sight, with those of studies; the others are folded
const AT_ONCE = 3; // charts drawn per frame, so that the parts keep moving

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
  // On a page of charts all are in sight, and there are no `further` ones.
  constructor(home, page, further = null) {
    this.home = home;
    this.further = further;
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
    for (const { figure } of this.views) figure.remove();
    const { home, further } = this;
    const more = further?.querySelector("details");
    // a design has asked for the charts of studies, whose names are study.chart
    const folded = (chart) => !chart.name.includes(".");
    const place = (chart, k) =>
      further === null || k < LEADING ? home : folded(chart) ? more.querySelector("div") : further;
    this.views = charts.map((chart, k) => new ChartView(chart, place(chart, k), this.page));
    if (more) {
      const count = charts.slice(LEADING).filter(folded).length;
      further.hidden = charts.length <= LEADING;
      more.hidden = !count;
      more.querySelector("summary").textContent = `${count} more ${count === 1 ? "chart" : "charts"}`;
      further.append(more);
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
