// The view as a whole: what is shown, from where, and what the page does with it.
const SLOW = 70;

function start(gl) {
  const [stage, canvas] = [$("stage"), $("canvas")];
  const drawing = new Drawing(canvas, !isSoftware(gl));
  const now = { layer: layerOf(data.start) ?? layers[0], other: null, share: 0.5, patch: null, former: null };
  let waiting = 0;
  let timer = 0;
  const sides = () => (now.other ? [now.layer, now.other] : [now.layer]);
  // Where a frame comes long after it was asked for, motion is shown coarse, and what stands still is drawn again in full.
  let [asked, settle] = [Infinity, 0];
  const finish = () => {
    clearTimeout(settle);
    drawing.resize(drawing.width, drawing.height, false);
    asked = Infinity;
    waiting ||= requestAnimationFrame(frame);
  };
  const pace = () => {
    const slow = performance.now() - asked > SLOW;
    asked = Infinity;
    clearTimeout(settle);
    if (slow && !drawing.coarse) drawing.resize(drawing.width, drawing.height, true);
    if (drawing.coarse) settle = setTimeout(finish, 250);
  };
  const frame = time => {
    waiting = 0;
    pace();
    const flying = eye.step(time);
    eye.apply(drawing.width, drawing.height);
    drawing.draw(sides(), now.share, eye.camera, now.patch);
    if (flying) redraw();
  };
  const redraw = () => {
    if (waiting) return;
    asked = performance.now();
    waiting = requestAnimationFrame(frame);
  };
  const eye = new Eye(geometry.origin, geometry.bounds(), redraw);
  const panel = new Panel($("panel"), { next: by => next(by), leave: () => select(null) });
  const scales = [$("scale-a"), $("scale-b")].map(box => new ScaleBox(box, () => { refreshBars(); redraw(); }));
  const noteOf = layer => {
    if (layer.natural === "before") return data.before_note;
    return layer.natural ? drawing.colouring.note : layer.film === null ? layer.note : `${layer.note} ${data.films[layer.film].note}`;
  };
  function refreshBars() { for (const s of scales) if (s.layer && !s.layer.natural && !s.box.hidden) s.mark(); }

  // Puts words and controls in step with what is shown.
  function refresh() {
    const all = sides();
    const film = Math.max(0, ...all.map(l => (l.natural || l.film === null ? 0 : data.films[l.film].steps.length)));
    $("layer").value = now.layer.key;
    $("split").checked = !!now.other;
    $("other-box").hidden = $("divider").hidden = $("left").hidden = $("right").hidden = !now.other;
    $("colouring-box").hidden = data.colourings.length < 2 || !all.some(l => l.natural);
    if (now.other) {
      $("other").value = now.other.key;
      $("left").textContent = now.layer.title;
      $("right").textContent = now.other.title;
    }
    scales.forEach((s, k) => {
      s.box.hidden = !all[k];
      if (all[k]) s.show(all[k], noteOf(all[k]));
    });
    $("film").hidden = !film;
    if (film) {
      const layer = all.find(l => !l.natural && l.film !== null);
      $("step").max = film - 1;
      $("step").value = layer.step;
      $("step-label").textContent = data.films[layer.film].steps[layer.step].label;
    } else play(false);
    panel.show(now.patch, all);
    redraw();
  }
  function show(layer) { if (layer) { now.layer = layer; refresh(); } }
  function step(k) {
    for (const l of layers) if (!l.natural && l.film !== null) l.step = Math.max(0, Math.min(data.films[l.film].steps.length - 1, k));
    refresh();
  }
  function play(on) {
    clearInterval(timer);
    timer = 0;
    $("play").textContent = on ? "pause" : "play";
    if (!on) return;
    if (Number($("step").value) >= Number($("step").max)) step(0);
    timer = setInterval(() => {
      step(Number($("step").value) + 1);
      if (Number($("step").value) >= Number($("step").max)) play(false);
    }, 450);
  }
  function split(on) {
    if (on) {
      now.former = now.layer;
      now.layer = layerOf(data.before ? "natural-before" : "natural-reference") ?? layers[0];
      now.other = layerOf(data.before ? "natural-reference" : "natural-candidate");
      if (data.films.length) [now.layer, now.other] = [layerOf("reference"), layerOf("film-1")];
    } else [now.layer, now.other] = [now.former ?? now.layer, null];
    refresh();
  }
  function select(patch) {
    now.patch = patch;
    panel.show(patch, sides());
    redraw();
  }
  function fly(patch) {
    const source = geometry.has(patch) ? geometry : geometryBefore;
    if (!source || !source.has(patch)) return;
    select(patch);
    const [centre, normal] = [source.centre(patch), source.normal(patch)];
    const size = Math.max(...source.outline(patch).map(p => p.distanceTo(centre)));
    eye.at(centre, normal, size, source.room(centre.clone().addScaledVector(normal, 1e-4 * eye.sphere.radius), normal));
  }
  function next(by) {
    const all = data.worst;
    if (!all.length) return;
    const at = all.indexOf(now.patch);
    fly(all[at < 0 ? (by > 0 ? 0 : all.length - 1) : (at + by + all.length) % all.length]);
  }
  const pickAt = (x, y) => {
    eye.apply(drawing.width, drawing.height);
    return drawing.pick(now.other && x >= now.share * drawing.width ? now.other : now.layer, x, y, eye.camera);
  };
  function home() {
    $("camera").value = "0";
    look(0);
  }
  function look(k) { if (k < data.cameras.length) eye.through(data.cameras[k]); else eye.whole(data.cameras[0]); }
  function help() {
    $("keys").hidden = !$("keys").hidden;
    $("help").ariaExpanded = String(!$("keys").hidden);
  }

  const option = (value, text) => Object.assign(element("option", "", text), { value });
  for (const box of ["layer", "other"]) {
    const group = (label, of) => {
      const g = element("optgroup");
      g.label = label;
      g.append(...layers.filter(of).map(l => option(l.key, l.title)));
      if (g.children.length) $(box).append(g);
    };
    group("natural colours", l => l.natural);
    group("false colour", l => !l.natural);
    $(box).addEventListener("change", () => { now[box] = layerOf($(box).value); refresh(); });
  }
  $("colouring").append(...data.colourings.map((c, k) => option(k, c.title)));
  $("colouring").addEventListener("change", () => { drawing.colouring = data.colourings[$("colouring").value]; refresh(); });
  $("camera").append(...data.cameras.map((c, k) => option(k, `camera ${c.name}`)), option(data.cameras.length, "outside, all of it"));
  $("camera").addEventListener("change", () => look(Number($("camera").value)));
  $("outlines").checked = drawing.outlines;
  $("outlines").addEventListener("change", () => { drawing.outlines = $("outlines").checked; redraw(); });
  $("backs").addEventListener("change", () => { drawing.backs = $("backs").checked; redraw(); });
  $("split").addEventListener("change", () => split($("split").checked));
  $("help").addEventListener("click", help);
  $("step").addEventListener("input", () => { play(false); step(Number($("step").value)); });
  $("play").addEventListener("click", () => play(!timer));
  takePointers(canvas, eye, (x, y) => select(pickAt(x, y)));
  takeKeys(canvas, eye, { home, next, help, leave: () => select(null),
    layer: by => show(layers[(layers.indexOf(now.layer) + by + layers.length) % layers.length]) });
  takeDivider($("divider"), stage, share => { now.share = share; redraw(); });
  takeRows(fly);
  document.getElementById("viewer").hidden = false;
  const fill = () => {
    const [width, height] = [stage.clientWidth, stage.clientHeight];
    if (width && height && (width !== drawing.width || height !== drawing.height)) {
      drawing.resize(width, height);
      frame(performance.now());
    }
  };
  new ResizeObserver(fill).observe(stage);
  addEventListener("beforeprint", () => { finish(); fill(); frame(performance.now()); });
  look(0);
  refresh();
  fill();

  // For tests and for scripts in the console: what is shown, and the same actions that the mouse has.
  window.etalonViewer = {
    ready: true,
    readyAfter: performance.now(),
    select: fly,
    get selected() { return now.patch; },
    camera: () => eye.tell(),
    pick: pickAt,
    // Where a point of the scene lies on the canvas, in CSS pixels.
    project: point => {
      eye.apply(drawing.width, drawing.height);
      const p = V(...point).sub(geometry.origin).project(eye.camera);
      return [(p.x + 1) / 2 * drawing.width, (1 - p.y) / 2 * drawing.height];
    },
    get layer() { return now.layer.key; },
    get layers() { return layers.map(l => l.key); },
    setLayer: key => show(layerOf(key)),
    get worst() { return [...data.worst]; },
    turn: angle => { eye.turn(angle, 0); frame(performance.now()); },
    get coarse() { return drawing.coarse; },
    split, step,
  };
}

// A processor that draws for want of a graphics card has no time for smooth edges.
function isSoftware(gl) {
  const more = gl.getExtension("WEBGL_debug_renderer_info");
  return !!more && /swiftshader|llvmpipe|software/i.test(gl.getParameter(more.UNMASKED_RENDERER_WEBGL));
}

const probe = document.createElement("canvas").getContext("webgl2");
if (probe) start(probe); else $("missing").hidden = false;
