// The bar of a layer, its ends to be set by hand.
const element = (name, className, text) => {
  const e = document.createElement(name);
  if (className) e.className = className;
  if (text !== undefined) e.textContent = text;
  return e;
};
const gradient = rgb => {
  const count = rgb.length / 3;
  const stop = k => { const i = Math.round(k * (count - 1) / 32); return `rgb(${rgb[3 * i]} ${rgb[3 * i + 1]} ${rgb[3 * i + 2]})`; };
  return `linear-gradient(to right, ${Array.from({ length: 33 }, (_, k) => stop(k)).join(",")})`;
};

class ScaleBox {
  constructor(box, changed) {
    Object.assign(this, { box, changed });
  }
  show(layer, note) {
    this.layer = layer;
    this.box.replaceChildren(element("b", "", layer.title), element("p", "", note));
    if (layer.natural) return;
    const map = element("div", "viewer-map");
    map.style.background = gradient(maps[layer.map]);
    this.ticks = element("div", "ticks");
    const range = element("div", "viewer-range");
    this.ends = ["low", "high"].map(end => {
      const input = element("input");
      Object.assign(input, { type: "number", step: "any", value: this.text(end), ariaLabel: end === "low" ? "Lower end" : "Upper end" });
      input.addEventListener("change", () => this.set(end, Number(input.value) / layer.factor));
      return input;
    });
    const button = (text, hint, act) => {
      const b = element("button", "", text);
      Object.assign(b, { type: "button", title: hint });
      b.addEventListener("click", act);
      return b;
    };
    range.append(this.ends[0], "to", this.ends[1], button("fit", "From the least to the greatest value", () => this.fit()),
      button("reset", "The range of the pictures", () => this.put(layer.range.low0, layer.range.high0)));
    if (valuesOf(layer).some(v => !Number.isFinite(v))) range.append(element("span", "missing", "no number"));
    this.box.append(map, this.ticks, element("div", "unit", layer.unit), range);
    this.mark();
  }
  text(end) { return String(Number((this.layer.range[end] * this.layer.factor).toPrecision(6))); }
  mark() {
    const { range, factor } = this.layer;
    this.ticks.replaceChildren(...[0, 0.25, 0.5, 0.75, 1].map(at => {
      const tick = element("span", "", shown((range.low + (range.high - range.low) * at) * factor, isSigned(this.layer)));
      tick.style.left = `${100 * at}%`;
      return tick;
    }));
    this.ends.forEach((input, k) => { input.value = this.text(k ? "high" : "low"); });
  }
  set(end, value) {
    const range = { low: this.layer.range.low, high: this.layer.range.high, [end]: value };
    this.put(range.low, range.high);
  }
  // From the least to the greatest value; signed layers keep 0 in the middle, amounts at the end.
  fit() {
    const values = valuesOf(this.layer);
    let [low, high] = [Infinity, -Infinity];
    for (let i = 0; i < patches; i++) if (about.area[i] > 0 && Number.isFinite(values[i])) { low = Math.min(low, values[i]); high = Math.max(high, values[i]); }
    if (high < low) return;
    const reach = Math.max(Math.abs(low), Math.abs(high));
    if (isSigned(this.layer)) this.put(-reach, reach); else this.put(Math.min(0, low), high);
  }
  // What is no range is not taken.
  put(low, high) {
    if (Number.isFinite(low) && Number.isFinite(high) && high > low) Object.assign(this.layer.range, { low, high });
    this.mark();
    this.changed();
  }
}
