/* The address keeps what is seen, so that a link shows the same: `at`, the place of the driver;
   `view`, the middle of the picture, mm, and its pixels per mm; `open`, the blocks that are open; and
   in the live view `set.KEY`, the numbers that are not saved. Old links are read for ever: a word
   may be added, none may change its meaning. */

const LATER = 250; // ms after which the address tells of a change

const address = (() => {
  const FOLDED = "section[id] details:not(details details)";
  let timer = null;

  const homeOf = (one) => one.closest("section[id]").id;
  const given = () => new URLSearchParams(location.hash.includes("=") ? location.hash.slice(1) : "");

  // Show what the address tells.
  function read() {
    const asked = given();
    const view = (asked.get("view") ?? "").split(",").map(Number);
    if (view.length === 3 && view.every(Number.isFinite) && view[2] > 0) {
      Object.assign(parts.view, { x: view[0], y: view[1], scale: view[2] });
      parts.fitted = false;
    }
    const open = (asked.get("open") ?? "").split(",");
    for (const one of document.querySelectorAll(FOLDED)) {
      if (open.includes(homeOf(one))) one.open = true;
    }
    const at = Number.parseFloat(asked.get("at"));
    if (Number.isFinite(at)) page.go(at);
  }

  // The numbers that the address tells, by key.
  function numbers() {
    const found = [...given()].filter(([name]) => name.startsWith("set."));
    return Object.fromEntries(found.map(([name, value]) => [name.slice(4), Number(value)]));
  }

  function write() {
    timer = null;
    const { scene, place } = page;
    const told = new URLSearchParams();
    if (place !== scene.start) told.set("at", Number(place.toPrecision(8)));
    if (!parts.fitted && !parts.following) {
      const { x, y, scale } = parts.view;
      told.set("view", [x, y, scale].map((one) => Number(one.toPrecision(6))).join());
    }
    const open = [...document.querySelectorAll(FOLDED)].filter((one) => one.open).map(homeOf);
    if (open.length) told.set("open", [...new Set(open)].join());
    for (const [key, value] of Object.entries(page.unsaved?.() ?? {})) told.set(`set.${key}`, value);
    const hash = told.size ? `#${told.toString().replaceAll("%2C", ",")}` : "";
    if (hash === location.hash || (!hash && !location.hash.includes("="))) return;
    history.replaceState(null, "", hash || location.pathname + location.search);
  }

  // Tell of a change soon; not while the parts play.
  function changed() {
    if (page.playing) return;
    clearTimeout(timer);
    timer = setTimeout(write, LATER);
  }

  document.addEventListener("toggle", changed, true);
  window.addEventListener("hashchange", read);
  return { read, numbers, changed };
})();

address.read();
page.changed = address.changed;
window.gearcam.address = address;
