// A page without moving parts.

const { title, charts: shown } = JSON.parse(document.getElementById("document").textContent);
const page = { title, colours: palette() };
const charts = new Charts(document.getElementById("charts"), page);

function repaint() {
  page.colours = palette();
  charts.repaint();
}

function print(on) {
  paper(on);
  page.colours = palette();
  charts.print(on);
}

matchMedia("(prefers-color-scheme: dark)").addEventListener("change", repaint);
window.addEventListener("beforeprint", () => print(true));
window.addEventListener("afterprint", () => print(false));
charts.show(shown);
