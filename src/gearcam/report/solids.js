// The view of the solids: a separate page in a frame, loaded when first opened; of parts in space it
// is open from the beginning, and loaded when the page has been drawn. Its globals (scene,
// camera, controls, render, THREE) serve to move, fit, colour and print it. Each solid is an object
// with the name of its body. The live view asks the server for it, and again for each document.

const solids = (() => {
  const home = document.querySelector("#solids details");
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const METAL = [0x4d7fb8, 0xb8803f, 0x5c8f5c]; // colours of the bodies in order
  const TURN = Math.PI / 18; // per arrow key, rad
  const ZOOM = 1.15; // factor per + or -
  const AROUND = 24; // places at which all must be in sight
  const MARGIN = 1.02;
  const stage = home.querySelector(".view");
  const tools = home.querySelector(".tools");
  const cut = new SolidCut(home);
  const measure = new SolidMeasure(home, cut, axisOf);
  const hint = home.querySelector(".hint");
  const HINT = hint.textContent;
  let frame = null;
  let load = null; // asks for the view where the page does not hold it
  let asked = 0;
  let late = true; // whether what is shown is not that of the document
  let posesAt = () => new Map(); // by name, at a place of the driver
  let scene = { places: [0], eye: [0.3, -0.7, 1], up: [0, 1, 0] };
  let place = 0;

  // The globals of the view; null until it is drawn.
  const view = () => {
    const inside = frame && frame.contentWindow;
    return inside && inside.controls ? inside : null;
  };

  const drawn = () => {
    const canvas = document.createElement("canvas");
    return canvas.getContext("webgl2") || canvas.getContext("webgl");
  };

  // Show the solids at a place; what is folded is moved when it is opened.
  function move(poses, at, shown) {
    [posesAt, place, scene] = [poses, at, shown];
    const inside = view();
    if (!inside || !home.open) return;
    pose(inside);
    inside.render();
  }

  function pose(inside) {
    for (const [name, { axis, turn, x, y, z }] of posesAt(place)) {
      const body = inside.scene.getObjectByName(name);
      if (!body) continue;
      body.position.set(x, y, z ?? body.position.z); // in the plane: at its own height
      body.quaternion.setFromAxisAngle(new inside.THREE.Vector3(...axis), turn);
    }
    inside.scene.updateMatrixWorld(true);
  }

  function open() {
    if (!home.open) return;
    if (frame) move(posesAt, place, scene);
    const held = document.getElementById("solids-view"); // stands after the script
    if (!late || !(load || held)) return;
    late = false;
    if (!drawn()) hint.textContent = "This browser cannot show solids: it has no WebGL.";
    else if (load) ask();
    else show(JSON.parse(held.textContent));
  }

  // Ask for the view of another document; what is folded is asked for when it is opened.
  function renew() {
    if (!load) return;
    late = true;
    open();
  }

  async function ask() {
    const turn = ++asked;
    if (!frame) hint.textContent = "The solids are being made.";
    const found = await load();
    if (turn !== asked || found.stale) return;
    hint.textContent = found.view ? HINT : whyNot(found);
    show(found.view);
  }

  const whyNot = ({ error, refusal }) =>
    error ? "There are no solids: the design cannot be made."
      : refusal ? `The solids cannot be shown: ${refusal}` : "This design has no solids.";

  // Put a view in the place of another one, seen from where that was.
  function show(text) {
    const before = view();
    frame?.remove();
    frame = null;
    delete home.dataset.drawn;
    stage.hidden = tools.hidden = true;
    if (!text) return;
    stage.hidden = false;
    frame = document.createElement("iframe");
    frame.title = "The solids, to be turned and zoomed";
    frame.srcdoc = text;
    stage.prepend(frame);
    ready(frame, before && [before.camera, before.controls]);
  }

  // The view loads its data itself and does not report when it is done.
  function ready(own, before) {
    if (own !== frame) return;
    const inside = view();
    if (!inside) {
      requestAnimationFrame(() => ready(own, before));
      return;
    }
    // the loader knows boxes only
    for (const one of solidBodies(inside.scene)) one.geometry.computeBoundingSphere();
    pose(inside);
    paint(inside);
    aim(inside);
    fit(inside);
    if (before) resume(inside, ...before);
    inside.addEventListener("resize", () => fit(inside));
    inside.addEventListener("keydown", key);
    cut.put(inside, reached(inside));
    measure.put(inside);
    tools.hidden = false;
    home.dataset.drawn = "true";
  }

  function paint(inside) {
    let count = 0;
    inside.scene.background.set(dark.matches ? 0x1a2027 : 0xffffff);
    inside.tracklight.intensity = 1.1;
    for (const one of solidBodies(inside.scene)) {
      one.material = one.material.clone(); // bodies share one material
      one.material.color.set(METAL[count++ % METAL.length]);
      one.material.metalness = 0;
      one.material.roughness = 0.7;
    }
    inside.render();
  }

  // Balls that contain the bodies at all places.
  function balls(inside) {
    const { places } = scene;
    const now = place;
    const found = [];
    for (let k = 0; k <= AROUND; k++) {
      place = places[Math.round((k * (places.length - 1)) / AROUND)];
      pose(inside);
      for (const one of solidBodies(inside.scene)) {
        found.push(one.geometry.boundingSphere.clone().applyMatrix4(one.matrixWorld));
      }
    }
    place = now;
    pose(inside);
    return found;
  }

  // The box that the bodies reach at all places.
  function reached(inside) {
    const { THREE } = inside;
    const box = new THREE.Box3();
    for (const ball of balls(inside)) box.union(ball.getBoundingBox(new THREE.Box3()));
    return box;
  }

  // The axis about which a body turns; nothing if it does not.
  function axisOf(name) {
    const { places } = scene;
    const at = (share) => new Map(posesAt(places[Math.round(share * (places.length - 1))])).get(name);
    const [first, ...others] = [0, 0.3, 0.7, 0.9].map(at);
    return first && others.some((one) => one.turn !== first.turn) ? first.axis : null;
  }

  // Look at the middle of what the bodies reach.
  function aim(inside) {
    const { camera, controls, THREE } = inside;
    reached(inside).getCenter(controls.target);
    camera.up.set(...scene.up);
    camera.position.copy(controls.target).add(new THREE.Vector3(...scene.eye));
  }

  // Set the camera at the distance at which the bodies fit, seen from where it looks, at all places.
  function fit(inside) {
    const { camera, controls } = inside;
    const way = camera.position.clone().sub(controls.target).normalize();
    const across = camera.up.clone().cross(way).normalize();
    const up = way.clone().cross(across);
    const tall = Math.tan((camera.fov * Math.PI) / 360);
    const wide = tall * camera.aspect;
    const room = (aside, radius, half) => (Math.abs(aside) + radius * Math.hypot(1, half)) / half;
    const away = ({ center, radius }) => {
      const off = center.sub(controls.target);
      const sides = [room(off.dot(across), radius, wide), room(off.dot(up), radius, tall)];
      return off.dot(way) + Math.max(...sides);
    };
    const far = MARGIN * Math.max(...balls(inside).map(away));
    camera.position.copy(controls.target).addScaledVector(way, far);
    camera.near = far / 1000;
    camera.far = 10 * far;
    camera.updateProjectionMatrix();
    controls.update();
    inside.render();
  }

  function resume({ camera, controls, render }, before, middle) {
    camera.up.copy(before.up);
    camera.position.copy(before.position);
    controls.target.copy(middle.target);
    controls.update();
    render();
  }

  function key(event) {
    if (measure.key(event)) return;
    const { camera, controls, THREE } = view();
    const way = camera.position.clone().sub(controls.target);
    const across = camera.up.clone().cross(way).normalize();
    const moves = {
      ArrowLeft: () => way.applyAxisAngle(camera.up, TURN),
      ArrowRight: () => way.applyAxisAngle(camera.up, -TURN),
      ArrowUp: () => way.applyAxisAngle(across, TURN) && camera.up.applyAxisAngle(across, TURN),
      ArrowDown: () => way.applyAxisAngle(across, -TURN) && camera.up.applyAxisAngle(across, -TURN),
      "+": () => way.divideScalar(ZOOM),
      "-": () => way.multiplyScalar(ZOOM),
    };
    if (!moves[event.key]) return;
    event.preventDefault();
    moves[event.key]();
    camera.position.copy(controls.target).add(way);
    controls.update();
    view().render();
  }

  // In print a frame is cut off and its canvas is empty, so an image is printed instead.
  function picture() {
    const inside = view();
    if (!inside) return;
    inside.scene.background.set(0xffffff);
    inside.render();
    const shown = document.createElement("img");
    shown.alt = "The solids";
    shown.src = measure.printed(inside.renderer.domElement);
    home.querySelectorAll("img").forEach((one) => one.remove());
    home.append(shown);
    paint(inside);
  }

  home.addEventListener("toggle", open);
  addEventListener("DOMContentLoaded", () => requestAnimationFrame(open));
  dark.addEventListener("change", () => view() && paint(view()));
  addEventListener("beforeprint", picture);
  const from = (ask) => {
    load = ask;
    open();
  };
  return { move, renew, from };
})();
