// Mouse, touch and keys.
const STEP = Math.PI / 36;
const CLICK = 4;

// Turns drags, wheels and pinches on the canvas into motions of the eye; a press that goes nowhere is a click.
function takePointers(canvas, eye, click) {
  const down = new Map();
  let moved = 0;
  const local = e => { const box = canvas.getBoundingClientRect(); return [e.clientX - box.left, e.clientY - box.top]; };
  const spread = () => { const [a, b] = [...down.values()]; return Math.hypot(a.x - b.x, a.y - b.y); };
  canvas.addEventListener("pointerdown", e => {
    canvas.focus({ preventScroll: true });
    canvas.setPointerCapture(e.pointerId);
    if (!down.size) moved = 0;
    down.set(e.pointerId, { x: e.clientX, y: e.clientY });
  });
  canvas.addEventListener("pointermove", e => {
    const last = down.get(e.pointerId);
    if (!last) return;
    const [dx, dy] = [e.clientX - last.x, e.clientY - last.y];
    const before = down.size === 2 ? spread() : 0;
    Object.assign(last, { x: e.clientX, y: e.clientY });
    moved += Math.abs(dx) + Math.abs(dy);
    if (moved <= CLICK) return;
    if (down.size === 2) {
      if (before > 0 && spread() > 0) eye.zoom(before / spread());
      eye.pan(dx / canvas.clientHeight / 2, dy / canvas.clientHeight / 2);
    } else if (e.shiftKey || e.buttons & 2 || e.buttons & 4) eye.pan(dx / canvas.clientHeight, dy / canvas.clientHeight);
    else eye.turn(dx * 0.006, dy * 0.006);
  });
  const up = e => {
    if (down.delete(e.pointerId) && e.type === "pointerup" && moved <= CLICK && e.button === 0) click(...local(e));
  };
  for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, up);
  canvas.addEventListener("contextmenu", e => e.preventDefault());
  // The wheel scrolls the page until the scene has been taken in hand.
  canvas.addEventListener("wheel", e => {
    if (document.activeElement !== canvas && !e.ctrlKey) return;
    e.preventDefault();
    eye.zoom(Math.exp(Math.max(-0.5, Math.min(0.5, e.deltaY * 0.0012))));
  }, { passive: false });
}

function takeKeys(canvas, eye, act) {
  const pan = { w: [0, 0.05], s: [0, -0.05], a: [0.05, 0], d: [-0.05, 0] };
  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  const others = { "+": () => eye.zoom(0.87), "=": () => eye.zoom(0.87), "-": () => eye.zoom(1.15), 0: act.home, Home: act.home,
    n: () => act.next(1), p: () => act.next(-1), "[": () => act.layer(-1), "]": () => act.layer(1), "?": act.help, Escape: act.leave };
  canvas.addEventListener("keydown", e => {
    if (e.ctrlKey || e.altKey || e.metaKey) return;
    const [arrow, move] = [arrows[e.key], pan[e.key.toLowerCase()]];
    if (arrow && e.shiftKey) eye.pan(-0.05 * arrow[0], -0.05 * arrow[1]);
    else if (arrow) eye.turn(-STEP * arrow[0], -STEP * arrow[1]);
    else if (move) eye.pan(...move);
    else if (others[e.key]) others[e.key]();
    else return;
    e.preventDefault();
  });
}

// A divider that is dragged, or moved by arrows.
function takeDivider(divider, stage, moved) {
  let share = 0.5;
  const put = to => {
    share = Math.max(0, Math.min(1, to));
    divider.style.left = `${100 * share}%`;
    divider.ariaValueNow = String(Math.round(100 * share));
    moved(share);
  };
  divider.addEventListener("pointerdown", e => { divider.setPointerCapture(e.pointerId); divider.focus(); e.preventDefault(); });
  divider.addEventListener("pointermove", e => {
    if (!divider.hasPointerCapture(e.pointerId)) return;
    const box = stage.getBoundingClientRect();
    put((e.clientX - box.left) / box.width);
  });
  divider.addEventListener("keydown", e => {
    const by = { ArrowLeft: -0.02, ArrowRight: 0.02, PageDown: -0.1, PageUp: 0.1 }[e.key];
    const to = e.key === "Home" ? 0 : e.key === "End" ? 1 : by && share + by;
    if (to === undefined) return;
    e.preventDefault();
    put(to);
  });
  put(share);
}
