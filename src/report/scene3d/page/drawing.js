// What draws: one mesh a state, one draw call each; layers and ranges are textures and uniforms.
const OUTLINED = 6000;
const geometry = new Geometry(data.geometry);
const geometryBefore = data.before && new Geometry(data.before, data.geometry.origin);

class Drawing {
  constructor(canvas, antialias) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias, alpha: true, preserveDrawingBuffer: true });
    this.renderer.autoClear = false;
    this.renderer.setClearColor(0, 0);
    this.scene = new THREE.Scene();
    this.maps = { sequential: mapColours(maps.sequential), diverging: mapColours(maps.diverging) };
    this.colouring = data.colourings[0];
    this.backs = false;
    this.outlines = geometry.loops.length > 0 && patches <= OUTLINED;
    const blank = valueTexture([]);
    this.uniforms = { values: { value: blank }, colours: { value: blank }, map: { value: this.maps.sequential },
      range: { value: new THREE.Vector2(0, 1) }, inNature: { value: false }, picking: { value: false } };
    this.states = [geometry, geometryBefore].filter(Boolean).map(g => this.build(g));
    this.target = new THREE.WebGLRenderTarget(1, 1, { minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter });
    this.mark = [[0x000000, 0], [0x19e08a, 1]].map(([ink, order]) => this.ribbon(ink, order));
  }
  material(vertexShader, fragmentShader, uniforms, more) {
    return new THREE.RawShaderMaterial({ glslVersion: THREE.GLSL3, vertexShader, fragmentShader, uniforms, ...more });
  }
  build(source) {
    const shape = source.filled();
    const mesh = (isBack, side, offset) => {
      const uniforms = { ...this.uniforms, isBack: { value: isBack } };
      const m = new THREE.Mesh(shape, this.material(VERTEX, FRAGMENT, uniforms,
        { side, polygonOffset: true, polygonOffsetFactor: offset, polygonOffsetUnits: offset }));
      m.frustumCulled = false;
      this.scene.add(m);
      return m;
    };
    const BACK = 1;
    return { source, front: mesh(false, THREE.FrontSide, 1), back: mesh(true, BACK, 3), lines: null };
  }
  // Outlines are made when they are first wanted.
  linesOf(state) {
    if (state.lines) return state.lines;
    const normals = texture(state.source.normals, WIDTH, HEIGHT, THREE.RGBAFormat, THREE.FloatType);
    const uniforms = { normals: { value: normals }, backs: { value: false } };
    state.lines = new THREE.LineSegments(state.source.outlines(), this.material(LINE_VERTEX, LINE_FRAGMENT, uniforms, { transparent: true }));
    state.lines.frustumCulled = false;
    this.scene.add(state.lines);
    return state.lines;
  }
  ribbon(ink, order) {
    const g = new THREE.BufferGeometry();
    const uniforms = { ink: { value: new THREE.Vector3((ink >> 16) / 255, ((ink >> 8) & 255) / 255, (ink & 255) / 255) } };
    const m = new THREE.Mesh(g, this.material(PLAIN_VERTEX, PLAIN_FRAGMENT, uniforms, { side: THREE.DoubleSide, depthTest: false, depthWrite: false, transparent: true }));
    Object.assign(m, { renderOrder: 10 + order, frustumCulled: false, visible: false });
    this.scene.add(m);
    return m;
  }
  // Bands around a patch, so many pixels wide wherever the eye is.
  markPatch(state, patch, camera, height) {
    const there = patch !== null && state.source.has(patch);
    for (const m of this.mark) m.visible = there;
    if (!there) return;
    const centre = state.source.centre(patch);
    const pixel = 2 * Math.tan(camera.fov * Math.PI / 360) * Math.max(centre.distanceTo(camera.position), camera.near) / height;
    const corners = state.source.outline(patch);
    const out = corners.map(p => p.clone().sub(centre).normalize());
    this.mark.forEach((m, k) => {
      const [inner, outer] = k ? [0, 2.5] : [-1.2, 3.7];
      const at = (i, w) => corners[i].clone().addScaledVector(out[i], w * pixel).toArray();
      const xyz = corners.flatMap((_, i) => {
        const j = (i + 1) % corners.length;
        const [a, b, c, d] = [at(i, inner), at(j, inner), at(j, outer), at(i, outer)];
        return [...a, ...b, ...c, ...a, ...c, ...d];
      });
      m.geometry.dispose();
      m.geometry = new THREE.BufferGeometry();
      m.geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(xyz), 3));
    });
  }
  // Makes a layer the one that is drawn; returns its state.
  use(layer) {
    const u = this.uniforms;
    u.inNature.value = !!layer.natural;
    if (layer.natural) {
      const textures = (this.colouring.textures ??= {});
      u.colours.value = textures[layer.natural] ??= patchColours(this.colouring[layer.natural]);
    } else {
      layer.textures ??= [];
      u.values.value = layer.textures[layer.step] ??= valueTexture(valuesOf(layer));
      u.map.value = this.maps[layer.map];
      u.range.value.set(layer.range.low, layer.range.high);
    }
    const shownState = this.states[layer.before ? this.states.length - 1 : 0];
    for (const state of this.states) {
      const on = state === shownState;
      state.front.visible = on;
      state.back.visible = on && this.backs;
      if (state.lines || (on && this.outlines)) {
        const lines = this.linesOf(state);
        lines.visible = on && this.outlines;
        lines.material.uniforms.backs.value = this.backs;
      }
      for (const part of [state.front, state.back, state.lines]) if (part) part.material.uniformsNeedUpdate = true;
    }
    return shownState;
  }
  // Size in CSS pixels; a coarse picture has a quarter of the pixels.
  resize(width, height, coarse) {
    this.ratio = Math.min(2, devicePixelRatio || 1);
    this.renderer.setPixelRatio(this.ratio * (coarse ? 0.5 : 1));
    this.renderer.setSize(width, height, false);
    Object.assign(this, { width, height, coarse });
  }
  // One layer, or two with a divider at this share of the width.
  draw(shownLayers, share, camera, patch) {
    const r = this.renderer;
    r.setScissorTest(false);
    r.clear();
    const at = Math.round(share * this.width);
    shownLayers.forEach((layer, k) => {
      if (shownLayers.length > 1) {
        r.setScissorTest(true);
        if (k) r.setScissor(at, 0, this.width - at, this.height); else r.setScissor(0, 0, at, this.height);
      }
      const state = this.use(layer);
      this.markPatch(state, patch, camera, this.height);
      r.render(this.scene, camera);
    });
  }
  // Number of the patch at a point of the canvas; null where there is none.
  pick(layer, x, y, camera) {
    const ratio = this.ratio;
    const hidden = [...this.mark, ...this.states.map(s => s.lines)].filter(Boolean);
    this.use(layer);
    for (const part of hidden) part.visible = false;
    camera.setViewOffset(this.width * ratio, this.height * ratio, Math.floor(x * ratio), Math.floor(y * ratio), 1, 1);
    this.uniforms.picking.value = true;
    this.renderer.setScissorTest(false);
    this.renderer.setRenderTarget(this.target);
    this.renderer.clear();
    this.renderer.render(this.scene, camera);
    const texel = new Uint8Array(4);
    this.renderer.readRenderTargetPixels(this.target, 0, 0, 1, 1, texel);
    this.renderer.setRenderTarget(null);
    this.uniforms.picking.value = false;
    camera.clearViewOffset();
    const number = texel[0] + 256 * texel[1] + 65536 * texel[2];
    return number ? number - 1 : null;
  }
}
