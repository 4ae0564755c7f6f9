// Loops of corners as triangles and outlines. Built once; layers and ranges never touch it.
const [PIECE, OUTLINE] = [1, 2];
const V = (x, y, z) => new THREE.Vector3(x, y, z);

class Geometry {
  // Points are counted from `origin`, or from where the source counts them.
  constructor(source, origin = source.origin) {
    this.points = floatsOf(source.points).map((x, k) => x + (source.origin[k % 3] - origin[k % 3]));
    this.loops = countsOf(source.loops);
    this.origin = V(...origin);
    this.first = new Int32Array(patches).fill(-1);
    this.normals = new Float32Array(4 * WIDTH * HEIGHT);
    this.centres = new Float32Array(3 * patches);
    this.measure();
  }
  // Calls visit(patch, kind, start, count) for every loop; its corners are loops[start ..].
  each(visit) {
    for (let at = 0; at < this.loops.length; at += 3 + this.loops[at + 2])
      visit(this.loops[at], this.loops[at + 1], at + 3, this.loops[at + 2]);
  }
  point(k, to = V()) {
    const at = 3 * this.loops[k];
    return to.set(this.points[at], this.points[at + 1], this.points[at + 2]);
  }
  // Sizes of what is to be built; normal and centre of area of each patch.
  measure() {
    const [a, b, c, n] = [V(), V(), V(), V()];
    const areas = new Float32Array(patches);
    this.corners = this.triangles = this.edges = 0;
    this.each((patch, kind, start, count) => {
      if (kind !== PIECE) { this.edges += count; this.first[patch] = start; }
      if (kind === OUTLINE) return;
      this.corners += count;
      this.triangles += count - 2;
      this.point(start, a);
      for (let k = 1; k + 1 < count; k++) {
        this.point(start + k, b); this.point(start + k + 1, c);
        n.subVectors(b, a).cross(c.clone().sub(a));
        const area = n.length() / 2;
        areas[patch] += area;
        for (let d = 0; d < 3; d++) {
          this.normals[4 * patch + d] += n.getComponent(d);
          this.centres[3 * patch + d] += area * (a.getComponent(d) + b.getComponent(d) + c.getComponent(d)) / 3;
        }
      }
    });
    for (let i = 0; i < patches; i++) {
      const length = Math.hypot(this.normals[4 * i], this.normals[4 * i + 1], this.normals[4 * i + 2]) || 1;
      for (let d = 0; d < 3; d++) {
        this.normals[4 * i + d] /= length;
        this.centres[3 * i + d] /= areas[i] || 1;
      }
    }
  }
  has(patch) { return patch >= 0 && patch < patches && this.first[patch] >= 0; }
  normal(patch) { return V(...this.normals.subarray(4 * patch, 4 * patch + 3)); }
  centre(patch) { return V(...this.centres.subarray(3 * patch, 3 * patch + 3)); }
  outline(patch) {
    const start = this.first[patch];
    return Array.from({ length: this.loops[start - 1] }, (_, k) => this.point(start + k));
  }
  bounds() {
    const box = new THREE.Box3();
    const p = V();
    for (let k = 0; k < this.points.length; k += 3) box.expandByPoint(p.set(this.points[k], this.points[k + 1], this.points[k + 2]));
    return box.getBoundingSphere(new THREE.Sphere());
  }
  filled() {
    const [xyz, number, index] = [new Float32Array(3 * this.corners), new Float32Array(this.corners), new Uint32Array(3 * this.triangles)];
    let [v, t] = [0, 0];
    this.each((patch, kind, start, count) => {
      if (kind === OUTLINE) return;
      for (let k = 0; k < count; k++) {
        const at = 3 * this.loops[start + k];
        for (let d = 0; d < 3; d++) xyz[3 * (v + k) + d] = this.points[at + d];
        number[v + k] = patch;
      }
      for (let k = 1; k + 1 < count; k++, t += 3) { index[t] = v; index[t + 1] = v + k; index[t + 2] = v + k + 1; }
      v += count;
    });
    const g = this.buffers(xyz, number);
    g.setIndex(new THREE.BufferAttribute(index, 1));
    return g;
  }
  outlines() {
    const [xyz, number] = [new Float32Array(6 * this.edges), new Float32Array(2 * this.edges)];
    let v = 0;
    this.each((patch, kind, start, count) => {
      if (kind === PIECE) return;
      for (let k = 0; k < 2 * count; k++, v++) {
        const at = 3 * this.loops[start + ((k + 1) >> 1) % count];
        for (let d = 0; d < 3; d++) xyz[3 * v + d] = this.points[at + d];
        number[v] = patch;
      }
    });
    return this.buffers(xyz, number);
  }
  buffers(xyz, number) {
    const g = new THREE.BufferGeometry();
    g.setAttribute("position", new THREE.BufferAttribute(xyz, 3));
    g.setAttribute("patchNumber", new THREE.BufferAttribute(number, 1));
    return g;
  }
  // How far one can step back from a point before something stands behind.
  room(from, direction) {
    let nearest = Infinity;
    const [a, b, c, h, s, q] = [V(), V(), V(), V(), V(), V()];
    this.each((_, kind, start, count) => {
      if (kind === OUTLINE) return;
      this.point(start, a);
      for (let k = 1; k + 1 < count; k++) {
        this.point(start + k, b).sub(a); this.point(start + k + 1, c).sub(a);
        const det = b.dot(h.crossVectors(direction, c));
        if (Math.abs(det) < 1e-14) continue;
        const u = s.subVectors(from, a).dot(h) / det;
        const w = direction.dot(q.crossVectors(s, b)) / det;
        const t = c.dot(q) / det;
        if (u >= 0 && w >= 0 && u + w <= 1 && t > 1e-5 && t < nearest) nearest = t;
      }
    });
    return nearest;
  }
}
