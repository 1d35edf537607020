// The page's own script: it moves the parts and links them with the charts.
"use strict";

window.gearcam = (() => {
  const read = (id) => JSON.parse(document.getElementById(id).textContent);
  let shown = read("document");

  // The driver's place, in the unit of its axis.
  let place = shown.scene.start;

  function go(to) {
    place = to;
    document.getElementById("told").textContent = `${shown.scene.driver}: ${to.toFixed(1)}`;
  }

  // Show another document; the place stays.
  function show(next) {
    shown = next;
    for (const [name, html] of Object.entries(next.blocks)) {
      document.getElementById(name).innerHTML = html;
    }
    go(place);
  }

  go(place);
  return { show, go, get place() { return place; } };
})();
