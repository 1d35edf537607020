// The script of the live view: the page follows the design file and changes its numbers.
"use strict";

(() => {
  const live = JSON.parse(document.getElementById("live").textContent);
  let { made, number, values } = live; // values are all numbers of the file
  const FINE = 0.01; // step of a number without a slider

  // Numbers in the page that are not saved in the file, by key.
  let pending = {};
  const SAVED = "Saved. Files that were built before are as they were: gearcam build makes them anew.";
  let told = ""; // beside the buttons when nothing is pending
  let over = false; // whether the server has ended, or was started again
  const rows = new Map();
  const locked = new Set(); // keys that dragging in the picture leaves as they are

  // While the server answers one request a second one is sent; more would only wait there.
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

  // Show an error; if the design is refused, mark the page as that of the last valid design.
  function tell(error, refused = document.body.classList.contains("refused")) {
    const box = document.getElementById("error");
    const [words, remedies] = box.children;
    box.hidden = !error;
    words.textContent = error;
    remedies.replaceChildren();
    document.body.classList.toggle("refused", refused);
    document.querySelector("#refusal h1").textContent = document.title;
    const heading = document.getElementById("moving"); // absent without moving parts
    if (heading) heading.textContent = refused ? "Last valid design" : "Parts in motion";
  }

  // Search for changes with which the refused design can be made, and offer them.
  async function remedy(tried, last, turn) {
    const place = document.querySelector("#error div");
    place.textContent = "Searching for remedies.";
    const { found, lines, stale } = await post("remedies", { changes: tried, last });
    if (stale || turn !== arrived) return;
    if (!found?.length) {
      place.textContent = lines ?? "";
      return;
    }
    const items = found.map(({ text, notes, changes }) => {
      const item = element("li", {}, element("code", { textContent: text }), ` ${notes}`);
      item.dataset.changes = JSON.stringify({ ...tried, ...changes });
      return item;
    });
    place.replaceChildren(lines.split("\n")[0], element("ul", {}, ...items));
    addButtons();
  }

  // Give remedies that change nothing but numbers of the file a button.
  function addButtons() {
    for (const item of document.querySelectorAll("li[data-changes]:not(:has(button))")) {
      const changes = Object.entries(JSON.parse(item.dataset.changes)).flatMap(([key, value]) =>
        Array.isArray(value) ? value.map((one, k) => [`${key}[${k}]`, one]) : [[key, value]]);
      if (!changes.every(([key, value]) => key in values && Number.isFinite(value))) continue;
      const button = element("button", { type: "button", textContent: "Use this" });
      button.setAttribute("aria-label", `Use this: ${item.firstChild.textContent}`);
      button.addEventListener("click", () => {
        for (const [key, value] of changes) set(key, value);
        ask(changes[0][0], true);
      });
      item.append(" ", button);
    }
  }

  async function post(route, data) {
    const answer = await fetch(route, {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(data),
    });
    return answer.json();
  }

  // The numbers, for what is dragged in the picture and in charts.
  const numbers = {
    has: (key) => key in values,
    free: (key) => rows.has(key) && !locked.has(key) && !rows.get(key).key.integer,
    at: (key) => pending[key] ?? values[key],
    range: (key) => rows.get(key).key.high - rows.get(key).key.low,
    unit: (key) => rows.get(key).key.unit,
    called: (key) => `${rows.get(key).key.group}, ${rows.get(key).key.label}`,
    allowed(key) {
      const { least, most } = rows.get(key)?.key ?? {};
      return [least ?? -Infinity, most ?? Infinity];
    },
    // small changes of those that may move, as shares of their ranges
    steps: (share) => Object.fromEntries(
      [...rows.values()]
        .filter(({ key }) => numbers.free(key.key))
        .map(({ key }) => [key.key, share * (key.high - key.low)]),
    ),
    async find(steps, place) {
      try {
        return await post("handles", { changes: pending, steps, place });
      } catch {
        return {}; // `ask` tells that the server has ended
      }
    },
    move(changes) {
      for (const [key, value] of Object.entries(changes)) {
        const [least, most] = numbers.allowed(key);
        const step = rows.get(key)?.key.step ?? FINE;
        set(key, stepped({ step }, Math.min(most, Math.max(least, value))));
      }
      numbers.last = Object.keys(changes).filter((key) => key in pending);
      if (numbers.last.length) ask(numbers.last, false);
      return numbers.last.length > 0;
    },
    settle() {
      if (numbers.last.every((key) => key in pending)) ask(numbers.last, true);
    },
    last: [], // those that were moved last
    restore(values) {
      for (const [key, value] of Object.entries(values)) set(key, value);
    },
  };
  const tool = window.gearcam.parts && new HandleTool(window.gearcam, numbers);

  function ask(last, exact) {
    told = "";
    const asked = Object.fromEntries([last].flat().map((key) => [key, numbers.at(key)]));
    wanted = { changes: { ...pending, ...asked }, last, exact };
    send();
  }

  async function send() {
    if (!wanted || flying >= MOST || over) return;
    const asked = wanted;
    const turn = ++sent;
    const from = made;
    wanted = null;
    flying += 1;
    let taken = false;
    try {
      const reply = await post("follow", asked);
      if (!reply.stale && turn > arrived && from === made) {
        arrived = turn;
        taken = true;
        take(reply, asked.last);
        if (reply.refused && asked.exact) remedy(reply.changes, asked.last, turn).catch(ended);
      }
    } catch {
      wanted ??= asked; // again when the server answers
      ended();
    }
    flying -= 1;
    if (!taken) tool?.missed();
    send();
  }

  // Show a document, or a draft, which is said to be one.
  function show(next) {
    document.body.classList.toggle("draft", !next.charts);
    window.gearcam.show(next);
  }

  function take(reply, last) {
    tell(reply.error, Boolean(reply.error));
    if (reply.document) {
      show(reply.document);
      for (const [key, value] of Object.entries(reply.changes)) {
        if (![last].flat().includes(key)) set(key, value);
      }
    }
    tool?.forget();
    tool?.came(Boolean(reply.error));
    addButtons();
  }

  // The numbers that the address tells are tried.
  function addressed() {
    const asked = Object.entries(window.gearcam.address?.numbers() ?? {})
      .filter(([key, value]) => key in values && Number.isFinite(value));
    for (const [key, value] of asked) set(key, value);
    if (asked.length) ask(asked.map(([key]) => key), true);
  }

  // Show a number at its slider and in its field; it is pending until it is saved.
  function set(key, value) {
    pending[key] = value;
    if (value === values[key]) delete pending[key];
    const row = rows.get(key);
    if (row) {
      row.slider.min = Math.min(row.slider.min, value);
      row.slider.max = Math.max(row.slider.max, value);
      row.slider.value = row.field.value = value;
      row.place.classList.toggle("changed", key in pending);
    }
    enable();
    window.gearcam.page?.changed();
  }

  function enable() {
    const none = Object.keys(pending).length === 0;
    for (const id of ["save", "undo"]) document.getElementById(id).disabled = none || over;
    const shown = new Set([...rows.values()].flatMap(({ key }) => [key.key, ...key.same]));
    const others = Object.entries(pending).filter(([key]) => !shown.has(key));
    const also = others.map(([key, value]) => ` ${key} = ${value}`).join(",");
    document.getElementById("saved").textContent = none ? told
      : also ? `Not saved, also${also}.` : "Not saved.";
  }

  // The value rounded to the step of the slider.
  function stepped(key, value) {
    return Number((Math.round(value / key.step) * key.step).toPrecision(10));
  }

  // The words for a key are seen once: not below its own name, nor at the next items of a list.
  function rowOf(key, above) {
    const names = { textContent: key.label, title: key.key };
    const label = element("label", { htmlFor: `key-${key.key}`, ...names });
    const range = { type: "range", min: key.low, max: key.high, step: "any", value: key.value };
    const slider = element("input", { id: label.htmlFor, ...range });
    const field = element("input", { type: "number", step: "any", value: key.value });
    const told = element("small", { id: `doc-${key.key}`, textContent: key.doc });
    told.hidden = [key.label, above?.doc].includes(key.doc);
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
    const lock = element("input", { type: "checkbox", className: "lock", checked: locked.has(key.key) });
    lock.title = "Locked: what is dragged in the picture leaves this number";
    lock.setAttribute("aria-label", `lock ${key.key}`);
    lock.addEventListener("change", () => {
      locked[lock.checked ? "add" : "delete"](key.key);
      window.gearcam.redraw?.();
    });
    label.prepend(lock, " ");
    const place = element("div", { className: "key" }, label, slider, field, unit, told);
    rows.set(key.key, { key, slider, field, place });
    return place;
  }

  // Make the sliders, or update those that exist, so that the focus stays.
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
    for (const [k, key] of keys.entries()) {
      const table = key.key.replace(/\.[^.]*$/, "");
      const names = { textContent: key.group, title: table };
      if (!groups.has(table)) {
        groups.set(table, element("fieldset", {}, element("legend", names)));
      }
      groups.get(table).append(rowOf({ ...key }, keys[k - 1]));
    }
    const save = element("button", { id: "save", type: "button", textContent: "Save to the file" });
    const undo = element("button", { id: "undo", type: "button", textContent: "Undo the changes" });
    const saved = element("span", { id: "saved", role: "status" });
    save.addEventListener("click", store);
    undo.addEventListener("click", back);
    const heading = element("h2", { id: "numbered", textContent: "Numbers in the design file" });
    const ghost = element("button", { id: "ghost", type: "button", textContent: "Compare with this" });
    ghost.title = "Draw the design as it is now, dotted, beneath what comes";
    ghost.setAttribute("aria-pressed", "false");
    ghost.addEventListener("click", () => freeze(ghost));
    const buttons = element("p", {}, save, " ", undo, " ", saved);
    const hint = element("p", { className: "hint", textContent: "Rings in the picture, seen when the "
      + "pointer is there, and squares on charts can be dragged too. Tick a number to lock it." });
    const home = document.getElementById("numbers");
    const drawn = Boolean(window.gearcam.parts);
    buttons.append(...(drawn ? [" ", ghost] : []));
    home.replaceChildren(heading, ...(drawn ? [hint] : []), ...groups.values(), buttons);
  }

  function freeze(button) {
    const on = button.getAttribute("aria-pressed") !== "true";
    button.setAttribute("aria-pressed", on);
    window.gearcam.freeze(on);
  }

  async function store() {
    try {
      const reply = await post("save", { changes: pending, made });
      if (reply.error) tell(reply.error);
      else document.getElementById("saved").textContent = told = SAVED;
    } catch {
      ended();
    }
  }

  async function back() {
    for (const key of Object.keys(pending)) set(key, values[key]);
    arrived = sent; // replies to earlier requests are ignored
    wanted = null;
    location.reload();
  }

  async function follow(event) {
    if (Number(event.data) <= number) return;
    const state = await (await fetch("document")).json();
    if (state.number <= number) return;
    number = state.number;
    // another kind of design has another page
    const { kind, solids } = state.document ?? {};
    if (kind && (kind !== live.kind || (solids ?? live.solids) !== live.solids)) {
      reload();
      return;
    }
    if (state.document) show(state.document);
    tell(state.error, Boolean(state.error));
    if (state.made !== made) {
      ({ made, values } = state);
      offer(state.keys);
    }
    addButtons();
  }

  // --- the server ------------------------------------------------------------------------------

  const PAUSE = 2000; // ms between two tries to reach it
  const KEPT = `gearcam numbers of ${location.pathname}`;
  let events = null;

  // Say something about the live view itself, above all else; or nothing more.
  function notify(text, ...buttons) {
    const box = document.getElementById("notice");
    box.hidden = !text;
    box.replaceChildren(text, ...buttons);
  }

  // Try to reach the server until it answers.
  function listen() {
    events = new EventSource("events");
    events.addEventListener("run", ({ data }) => met(data));
    events.onmessage = (event) => !over && follow(event).catch(ended);
    events.onerror = ended;
  }

  function ended() {
    if (!events) return; // it is known
    events.close();
    events = null;
    setTimeout(listen, PAUSE);
    over = true;
    enable();
    notify("The live view has ended: the page no longer follows the file. Start gearcam view again.");
  }

  // The server answers: the one of this page, or one that was started since.
  function met(run) {
    if (run === live.run) {
      if (over) notify("");
      over = false;
      send();
    } else {
      over = true;
      const button = element("button", { type: "button", textContent: "Reload" });
      button.addEventListener("click", reload);
      notify("The live view was started again. ", button);
    }
    enable();
  }

  // Reload the page; numbers that are not saved are kept.
  function reload() {
    sessionStorage.setItem(KEPT, JSON.stringify(pending));
    pending = {};
    location.reload();
  }

  // Have the numbers that were kept again; those that the file no longer has are told.
  function resume() {
    const kept = JSON.parse(sessionStorage.getItem(KEPT) ?? "{}");
    sessionStorage.removeItem(KEPT);
    const known = Object.keys(kept).filter((key) => key in values);
    if (known.length) {
      for (const key of known) set(key, kept[key]);
      ask(known.at(-1), true);
    }
    const lost = Object.keys(kept).filter((key) => !(key in values));
    if (!lost.length) return;
    const button = element("button", { type: "button", textContent: "Close" });
    button.addEventListener("click", () => notify(""));
    notify(`Not kept, because the file has no such number to change now: ${lost.join(", ")}. `, button);
  }

  // The solids of the numbers in the page.
  async function solids() {
    try {
      return await post("solids", { changes: pending });
    } catch {
      ended();
      return { stale: true };
    }
  }

  // Numbers that are not saved are lost with the page.
  window.addEventListener("beforeunload", (event) => {
    if (Object.keys(pending).length) event.preventDefault();
  });

  window.gearcam.solids.from(solids);
  if (tool) {
    window.gearcam.page.numbers = numbers;
    window.gearcam.page.unsaved = () => pending;
    window.gearcam.page.seen.marked.push((_, pixel) => tool.marks(pixel));
    window.gearcam.parts.tool = window.gearcam.page.tool = tool;
  }
  offer(live.keys);
  addressed();
  addButtons();
  tell(live.error, Boolean(live.error));
  listen();
  resume();
})();
