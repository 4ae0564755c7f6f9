// The eye turns around a point: heading and height in the frame of an up direction, so that straight up is no special case.
const calm = matchMedia("(prefers-reduced-motion: reduce)");
const FLIGHT = 450;

class Eye {
  constructor(origin, sphere, redraw) {
    Object.assign(this, { origin, sphere, redraw });
    this.camera = new THREE.PerspectiveCamera(45, 1, 1, 1);
    this.state = { target: sphere.center.clone(), distance: 3 * sphere.radius, yaw: 0, pitch: 0, fov: 45, aspect: 0 };
    this.upright(V(0, 0, 1));
  }
  upright(up) {
    this.up = up.clone().normalize();
    const any = Math.abs(this.up.x) < 0.9 ? V(1, 0, 0) : V(0, 1, 0);
    this.east = any.sub(this.up.clone().multiplyScalar(any.dot(this.up))).normalize();
    this.north = this.up.clone().cross(this.east);
  }
  heading(direction) {
    const d = direction.clone().normalize();
    const [x, y] = [d.dot(this.east), d.dot(this.north)];
    // Looking straight up or down leaves the heading as it is.
    const yaw = Math.hypot(x, y) < 1e-6 ? this.state.yaw : Math.atan2(y, x);
    return { yaw, pitch: Math.asin(Math.max(-1, Math.min(1, d.dot(this.up)))) };
  }
  axes({ yaw, pitch }) {
    const level = this.east.clone().multiplyScalar(Math.cos(yaw)).addScaledVector(this.north, Math.sin(yaw));
    const forward = level.clone().multiplyScalar(Math.cos(pitch)).addScaledVector(this.up, Math.sin(pitch));
    const right = level.cross(this.up);
    return { forward, right, above: right.clone().cross(forward) };
  }
  place() { return this.state.target.clone().addScaledVector(this.axes(this.state).forward, -this.state.distance); }
  // Puts the camera where the state says; a camera of the scene shows at least its whole picture.
  apply(width, height) {
    const { fov, aspect, target, distance } = this.state;
    const { forward, right, above } = this.axes(this.state);
    const c = this.camera;
    c.aspect = width / height;
    const half = Math.tan(fov * Math.PI / 360) * Math.max(1, aspect / c.aspect);
    c.fov = Math.atan(half) * 360 / Math.PI;
    c.position.copy(target).addScaledVector(forward, -distance);
    c.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(right, above, forward.clone().negate()));
    const reach = c.position.distanceTo(this.sphere.center) + this.sphere.radius;
    c.far = 1.05 * reach;
    c.near = Math.max(c.far * 2e-4, Math.min(0.2 * distance, reach - 2.1 * this.sphere.radius));
    c.updateProjectionMatrix();
    c.updateMatrixWorld(true);
  }
  turn(dx, dy) {
    this.stop();
    this.state.yaw -= dx;
    this.state.pitch = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.state.pitch - dy));
    this.redraw();
  }
  pan(dx, dy) {
    this.stop();
    const { right, above } = this.axes(this.state);
    const unit = 2 * Math.tan(this.camera.fov * Math.PI / 360) * this.state.distance;
    this.state.target.addScaledVector(right, -dx * unit).addScaledVector(above, dy * unit);
    this.redraw();
  }
  zoom(factor) {
    this.stop();
    const r = this.sphere.radius;
    this.state.distance = Math.max(1e-3 * r, Math.min(20 * r, this.state.distance * factor));
    this.redraw();
  }
  stop() { this.flight = null; }
  // A camera of the scene, exactly: eye, target, up, field of view.
  through({ eye, target, up, fov, size }) {
    const [from, to] = [V(...eye).sub(this.origin), V(...target).sub(this.origin)];
    this.upright(V(...up));
    const direction = to.clone().sub(from);
    this.fly({ target: to, distance: direction.length(), ...this.heading(direction), fov, aspect: size[0] / size[1] });
  }
  // All of the scene, from outside and above, to the side of where the first camera stands.
  whole(camera) {
    if (camera) this.upright(V(...camera.up));
    const ahead = camera ? V(...camera.target).sub(V(...camera.eye)) : V(-1, 1, 0);
    const yaw = this.heading(ahead).yaw + 0.5;
    this.fly({ target: this.sphere.center.clone(), distance: 1.12 * this.sphere.radius / Math.sin(Math.PI / 9), yaw, pitch: -0.45, fov: 40, aspect: 1 });
  }
  // Straight at a patch, from its front, no farther than there is room.
  at(centre, normal, size, room) {
    const wanted = Math.max(7 * size, 0.45 * this.sphere.radius);
    const distance = Math.min(wanted, 0.9 * room);
    this.fly({ target: centre, distance, ...this.heading(normal.clone().negate()), fov: 50, aspect: 0 });
  }
  fly(goal) {
    const from = { ...this.state, place: this.place() };
    if (calm.matches || !this.started) {
      this.started = true;
      Object.assign(this.state, goal);
      this.flight = null;
      return this.redraw();
    }
    const turn = Math.atan2(Math.sin(goal.yaw - from.yaw), Math.cos(goal.yaw - from.yaw));
    const to = goal.target.clone().addScaledVector(this.axes(goal).forward, -goal.distance);
    this.flight = { from, goal, turn, to, begin: performance.now() };
    this.redraw();
  }
  // One frame of a flight; true while it lasts.
  step(now) {
    const f = this.flight;
    if (!f) return false;
    const t = Math.min(1, Math.max(0, (now - f.begin) / FLIGHT));
    if (t === 1) {
      Object.assign(this.state, f.goal);
      this.flight = null;
      return false;
    }
    const s = t * t * (3 - 2 * t);
    const mix = (a, b) => a + (b - a) * s;
    const state = { yaw: f.from.yaw + f.turn * s };
    for (const key of ["pitch", "distance", "fov", "aspect"]) state[key] = mix(f.from[key], f.goal[key]);
    state.target = f.from.place.clone().lerp(f.to, s).addScaledVector(this.axes(state).forward, state.distance);
    Object.assign(this.state, state);
    return true;
  }
  tell() {
    const { target, distance, yaw, pitch, fov } = this.state;
    const world = v => v.clone().add(this.origin).toArray();
    return { eye: world(this.place()), target: world(target), distance, yaw, pitch, fov, flying: !!this.flight };
  }
}
