// Blocks: the parts of a page that are written as HTML.

// Replace the content of a block; sections that are open stay open.
function block(name, html) {
  const home = document.getElementById(name);
  const open = [...home.querySelectorAll("details")].map((one) => one.open);
  home.innerHTML = html;
  home.querySelectorAll("details").forEach((one, k) => (one.open = open[k] ?? false));
}

// Put another document or a draft, which lacks most charts, contacts and some blocks, in the place of
// the document shown, and return both together: what is missing stays unchanged.
function replaced(shown, next) {
  const blocks = { ...shown.blocks, ...next.blocks };
  for (const [name, html] of Object.entries(blocks)) {
    if (html !== shown.blocks[name]) block(name, html);
  }
  document.title = next.title;
  const { leading = [], ...others } = next;
  const drafted = new Map(leading.map((one) => [one.name, one]));
  const former = new Map(shown.charts.map((one) => [one.name, one]));
  const charts = (next.charts ?? shown.charts.map((one) => drafted.get(one.name) ?? one))
    .map((one) => inUnitOf(one, former.get(one.name)));
  return { ...shown, ...others, charts, blocks };
}
