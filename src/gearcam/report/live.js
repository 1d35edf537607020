// The script of a page that is served: it follows the design file, and changes its numbers.
"use strict";

(() => {
  const live = JSON.parse(document.getElementById("live").textContent);
  let { made, number } = live;

  // Numbers that the page shows and the file does not hold, by key.
  let pending = {};
  const rows = new Map();

  // A second request is on its way while the server answers the first; more would only wait there.
  const MOST = 2;
  let wanted = null;
  let flying = 0;
  let sent = 0;
  let arrived = 0;

  function element(name, settings = {}, ...children) {
    const one = Object.assign(document.createElement(name), settings);
    one.append(...children);
    return one;
  }

  function tell(error) {
    const place = document.getElementById("error");
    place.hidden = !error;
    place.replaceChildren(...(error ? [element("pre", { textContent: error })] : []));
  }

  async function post(route, data) {
    const answer = await fetch(route, {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(data),
    });
    return answer.json();
  }

  function ask(last, exact) {
    wanted = { changes: { ...pending }, last, exact };
    send();
  }

  async function send() {
    if (!wanted || flying >= MOST) return;
    const asked = wanted;
    const turn = ++sent;
    const from = made;
    wanted = null;
    flying += 1;
    try {
      const reply = await post("follow", asked);
      if (!reply.stale && turn > arrived && from === made) {
        arrived = turn;
        take(reply, asked.last);
      }
    } catch {
      ended();
    }
    flying -= 1;
    send();
  }

  function take(reply, last) {
    tell(reply.error);
    if (reply.document) window.gearcam.show(reply.document);
    for (const [key, value] of Object.entries(reply.changes ?? {})) {
      if (key !== last) set(key, value);
    }
  }

  // Show a number at its slider and its field; it is pending until the file holds it.
  function set(key, value) {
    pending[key] = value;
    const row = rows.get(key);
    if (!row) return;
    row.slider.value = row.field.value = value;
    if (value === row.key.value) delete pending[key];
    row.place.classList.toggle("changed", key in pending);
    enable();
  }

  function enable() {
    const none = Object.keys(pending).length === 0;
    for (const id of ["save", "undo"]) document.getElementById(id).disabled = none;
    document.getElementById("saved").textContent = none ? "" : "Not saved.";
  }

  // The nearest number that a slider's step allows.
  function stepped(key, value) {
    return Number((Math.round(value / key.step) * key.step).toPrecision(10));
  }

  function rowOf(key) {
    const word = key.key.replace(/^.*\./, "");
    const label = element("label", { htmlFor: `key-${key.key}`, textContent: word });
    const range = { type: "range", min: key.low, max: key.high, step: "any", value: key.value };
    const slider = element("input", { id: label.htmlFor, ...range });
    const field = element("input", { type: "number", step: "any", value: key.value });
    const told = element("small", { id: `doc-${key.key}`, textContent: key.doc });
    slider.setAttribute("aria-label", key.key);
    field.setAttribute("aria-label", `${key.key}, number`);
    slider.setAttribute("aria-describedby", told.id);
    const move = (exact) => {
      set(key.key, stepped(key, slider.valueAsNumber));
      ask(key.key, exact);
    };
    slider.addEventListener("input", () => move(false));
    slider.addEventListener("change", () => move(true));
    field.addEventListener("change", () => {
      if (!Number.isFinite(field.valueAsNumber)) return;
      set(key.key, field.valueAsNumber);
      ask(key.key, true);
    });
    const unit = element("span", { textContent: key.unit });
    const place = element("div", { className: "key" }, label, slider, field, unit, told);
    rows.set(key.key, { key, slider, field, place });
    return place;
  }

  // Make the sliders, or give those that are there their new numbers, so that the focus stays.
  function offer(keys) {
    pending = {};
    if (keys.map((one) => one.key).join() !== [...rows.keys()].join()) build(keys);
    for (const key of keys) {
      const row = rows.get(key.key);
      Object.assign(row.key, key);
      Object.assign(row.slider, { min: key.low, max: key.high });
      set(key.key, key.value);
    }
    enable();
  }

  function build(keys) {
    rows.clear();
    const groups = new Map();
    for (const key of keys) {
      const title = key.key.replace(/\.[^.]*$/, "");
      if (!groups.has(title)) {
        groups.set(title, element("fieldset", {}, element("legend", { textContent: title })));
      }
      groups.get(title).append(rowOf({ ...key }));
    }
    const save = element("button", { id: "save", type: "button", textContent: "Save to the file" });
    const undo = element("button", { id: "undo", type: "button", textContent: "Back to the file" });
    const saved = element("span", { id: "saved", role: "status" });
    save.addEventListener("click", store);
    undo.addEventListener("click", back);
    const heading = element("h2", { id: "numbered", textContent: "Numbers of the file" });
    const buttons = element("p", {}, save, " ", undo, " ", saved);
    document.getElementById("numbers").replaceChildren(heading, ...groups.values(), buttons);
  }

  async function store() {
    try {
      const reply = await post("save", { changes: pending, made });
      tell(reply.error);
      if (!reply.error) document.getElementById("saved").textContent = "Saved.";
    } catch {
      ended();
    }
  }

  async function back() {
    for (const row of rows.values()) set(row.key.key, row.key.value);
    arrived = sent; // what is still on its way is of no use
    wanted = null;
    location.reload();
  }

  async function follow(event) {
    if (Number(event.data) <= number) return;
    const state = await (await fetch("document")).json();
    if (state.number <= number) return;
    number = state.number;
    tell(state.error);
    if (state.document) window.gearcam.show(state.document);
    if (state.made !== made) {
      made = state.made;
      offer(state.keys);
    }
  }

  function ended() {
    tell("The view has ended: nothing follows the file any more. Start gearcam view again.");
  }

  const events = new EventSource("events");
  events.onmessage = (event) => follow(event).catch(ended);
  events.onerror = ended;
  offer(live.keys);
  tell(live.error);
})();
