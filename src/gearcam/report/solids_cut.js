// A section through the solids: a plane across an axis of space, moved by a slider. What is before it
// is left out; the inner sides of the bodies that are then seen have a flat colour, so that the cut
// looks solid.

class SolidCut {
  constructor(home) {
    this.home = home;
    [this.choice, this.slider, this.other, this.told] =
      ["select", "input", "button", "output"].map((one) => home.querySelector(`.cut ${one}`));
    this.inside = null; // the view (see solids.js)
    this.reach = null; // the box that the bodies reach at all places
    this.plane = null;
    this.caps = [];
    this.choice.addEventListener("change", () => this.choose());
    this.slider.addEventListener("input", () => this.update());
    this.other.addEventListener("click", () => {
      this.plane.normal.negate();
      this.update();
    });
  }

  // The section goes through the solids of another view as well.
  put(inside, reach) {
    [this.inside, this.reach, this.caps] = [inside, reach, []];
    if (this.plane) this.show();
    if (this.plane) this.update();
  }

  // Whether a point is in the part that is left out.
  hides(point) {
    return Boolean(this.plane) && this.plane.distanceToPoint(point) < 0;
  }

  get axis() { return this.choice.value; }

  // Cut across another axis: at the shafts, or in the middle; the half nearer to the reader goes.
  choose() {
    const { THREE, camera, controls, render } = this.inside;
    this.plane = null;
    this.show();
    if (this.axis) {
      const { min, max } = this.reach;
      const [low, high] = [min[this.axis], max[this.axis]];
      const at = low < 0 && high > 0 && this.axis !== "z" ? 0 : (low + high) / 2;
      const near = camera.position[this.axis] > controls.target[this.axis] ? -1 : 1;
      const normal = new THREE.Vector3();
      normal[this.axis] = near;
      this.plane = new THREE.Plane(normal, 0);
      this.slider.value = (this.slider.max * (at - low)) / (high - low);
      this.show();
      this.update();
    }
    render();
  }

  // Show the controls, and the inner sides where there is a section.
  show() {
    const { THREE, scene, renderer } = this.inside;
    for (const one of [this.slider, this.other, this.told]) one.hidden = !this.plane;
    for (const cap of this.caps) cap.removeFromParent();
    this.caps = [];
    renderer.clippingPlanes = this.plane ? [this.plane] : [];
    if (!this.plane) return;
    for (const body of solidBodies(scene)) {
      const color = body.material.color.clone().lerp(new THREE.Color(0xffffff), 0.55);
      const cap = new THREE.Mesh(
        body.geometry, new THREE.MeshBasicMaterial({ color, side: THREE.BackSide }),
      );
      cap.userData.cap = true;
      body.add(cap);
      this.caps.push(cap);
    }
  }

  update() {
    const { min, max } = this.reach;
    const share = this.slider.value / this.slider.max;
    const at = min[this.axis] + share * (max[this.axis] - min[this.axis]);
    this.plane.constant = -at * this.plane.normal[this.axis];
    this.told.textContent = `${this.axis} = ${at.toFixed(1)} mm`;
    this.slider.setAttribute("aria-valuetext", this.told.textContent);
    this.inside.render();
  }
}

// The bodies of a view, without their inner sides.
function solidBodies(scene) {
  const found = [];
  scene.traverse((one) => one.isMesh && !one.userData.cap && found.push(one));
  return found;
}
