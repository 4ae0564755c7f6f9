// What the page holds, decoded once. All numbers are by patch.
const $ = name => document.getElementById("viewer-" + name);
const bytesOf = text => Uint8Array.fromBase64 ? Uint8Array.fromBase64(text) : Uint8Array.from(atob(text), c => c.charCodeAt(0));
const floatsOf = text => new Float32Array(bytesOf(text).buffer);
const countsOf = text => new Uint32Array(bytesOf(text).buffer);
const data = JSON.parse(document.getElementById("viewer-data").textContent);
const patches = data.patches;

// Values stand in a texture this wide, row by row.
const WIDTH = 1024;
const HEIGHT = Math.max(1, Math.ceil(patches / WIDTH));
// What a texture holds where there is no number: shaders cannot be trusted with NaN.
const NONE = -3e38;

const maps = {};
for (const name of ["sequential", "diverging"]) maps[name] = bytesOf(data.maps[name]);

const about = { surface: countsOf(data.surface), material: countsOf(data.material), area: floatsOf(data.area) };

// Everything that can be shown, in order: natural colours first, then numbers.
const layers = [];
const natural = (key, title, side, before) => layers.push({ key, title, natural: side, before, note: "" });
if (data.colourings.length) {
  natural("natural-reference", "Reference", "reference", false);
  if (data.colourings[0].candidate) natural("natural-candidate", "Solution", "candidate", false);
  if (data.before) natural("natural-before", "Before the edit", "before", true);
}
// Layers of one range keep it together when it is changed.
const ranges = {};
for (const l of data.layers) {
  const key = l.range + " " + l.map;
  ranges[key] ??= { low: l.low, high: l.high, low0: l.low, high0: l.high };
  layers.push({ ...l, range: ranges[key], step: 0 });
}
const layerOf = key => layers.find(l => l.key === key);

// The numbers of a layer: of its step, where it is a film.
function valuesOf(layer) {
  if (layer.natural) return null;
  if (layer.film === null) return (layer.decoded ??= floatsOf(layer.values));
  layer.cache ??= [];
  return (layer.cache[layer.step] ??= stepValues(layer, layer.step));
}
function stepValues(layer, k) {
  const step = data.films[layer.film].steps[k];
  const values = (step.decoded ??= floatsOf(step.values));
  if (!layer.minus) return values;
  const from = valuesOf(layerOf(layer.minus));
  return values.map((v, i) => v - from[i]);
}

// A number as people read it, four figures, with a true minus sign.
function shown(x, signed) {
  if (!Number.isFinite(x)) return "\u2013";
  const size = Math.abs(x);
  let text = x === 0 ? "0" : size >= 1e5 || size < 1e-4 ? x.toExponential(3) : String(Number(x.toPrecision(4)));
  if (signed && x > 0) text = "+" + text;
  return text.replace(/-/g, "\u2212");
}
const isSigned = layer => layer.map === "diverging";
