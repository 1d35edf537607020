// A page without moving parts.

const page = {
  shown: JSON.parse(document.getElementById("document").textContent),
  colours: palette(),
  get title() { return this.shown.title; },
};
const charts = new Charts(document.getElementById("charts"), page, document.getElementById("further"));

function repaint() {
  page.colours = palette();
  charts.repaint();
}

function print(on) {
  paper(on);
  page.colours = palette();
  charts.print(on);
}

function show(next) {
  page.shown = replaced(page.shown, next);
  if (!next.charts) return;
  charts.show(next.charts);
  solids.renew();
}

window.gearcam = { show, solids };

matchMedia("(prefers-color-scheme: dark)").addEventListener("change", repaint);
window.addEventListener("beforeprint", () => print(true));
window.addEventListener("afterprint", () => print(false));
charts.show(page.shown.charts);
