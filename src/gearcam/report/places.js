// What a line of text on the page is about: a place of the driver, a tooth, bodies.

// The place of the driver that a text names, in its unit; of several the largest value's.
function placeIn(text, { driver, places }) {
  const unit = driver.split(", ")[1] ?? "";
  const said = [...text.matchAll(/(largest )?(?:at|phi1 =|theta =|u =) (-?[\d.]+) ([a-z]+)/g)]
    .filter((one) => one[3] === unit);
  const found = said.find((one) => one[1]) ?? said[0];
  const place = found && Number(found[2]);
  return place >= places[0] && place <= places.at(-1) ? place : null;
}

// The teeth that a text names, such as "wheel 2, teeth 15, 17-18": each its body and its number.
function teethIn(text, scene) {
  const said = text.match(/wheel (\d)[^,]*, t(?:ooth|eeth) ([\d, -]+)/);
  if (!said) return [];
  const body = scene.bodies.findIndex((one) => one.teeth && one.name.endsWith(`gear${said[1]}`));
  if (body < 0) return [];
  const numbers = said[2].split(",").flatMap((part) => {
    const [first, last = first] = part.trim().split("-").map(Number);
    return Array.from({ length: last - first + 1 }, (_, k) => first + k);
  });
  return numbers.filter((tooth) => scene.bodies[body].teeth[tooth - 1]).map((tooth) => ({ body, tooth }));
}

// The middle of the places at which a tooth is in contact; null if it is not.
function placeOfTooth(scene, body, tooth) {
  const column = columnOf(scene.bodies.filter((one) => one.teeth), scene.bodies[body]);
  for (const { start, teeth } of Object.values(scene.contacts)) {
    const at = scene.places.filter((_, k) =>
      teeth?.slice(start[k], start[k + 1]).some((pair) => pair[column] === tooth));
    if (at.length) return at[Math.floor(0.5 * at.length)];
  }
  return null;
}

// The bodies, by index, whose part, name, or joint a text names.
function bodiesIn(text, { bodies }) {
  const words = (name) => new RegExp(`(^|[^\\w])${escapedName(name)}($|[^\\w])`);
  const numbered = text.match(/wheel (\d)/);
  return bodies.flatMap((body, k) => {
    if (body.name === "frame") return [];
    const own = [body.called, body.name, ...body.names.map((one) => one.text)];
    const wheel = numbered && body.name.endsWith(`gear${numbered[1]}`);
    return wheel || own.some((name) => words(name).test(text)) ? [k] : [];
  });
}

const escapedName = (name) => name.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");

// The uppermost body at a point, by index; -1 on the ground.
function bodyAt({ x, y }, { bodies }, poses) {
  for (let k = bodies.length - 1; k >= 0; k--) {
    const [px, py] = unplaced(poses[k], { x, y });
    const chains = [...bodies[k].metal, ...bodies[k].floor];
    if (chains.filter((chain) => within(chain, px, py)).length % 2) return k;
  }
  return -1;
}

// Whether a point is within a closed chain (flat): a ray to the right crosses it an odd number of times.
function within(chain, x, y) {
  let inside = false;
  for (let k = 0, j = chain.length - 2; k < chain.length; j = k, k += 2) {
    const [ax, ay, bx, by] = [chain[j], chain[j + 1], chain[k], chain[k + 1]];
    if (ay > y !== by > y && x < ax + ((y - ay) * (bx - ax)) / (by - ay)) inside = !inside;
  }
  return inside;
}

// A point of the fixed frame in that of a body.
function unplaced({ turn, x: ox, y: oy }, { x, y }) {
  const [cos, sin] = [Math.cos(turn), Math.sin(turn)];
  return [cos * (x - ox) + sin * (y - oy), cos * (y - oy) - sin * (x - ox)];
}
