"use strict";
// Colours, marks and numbers of charts.
const etalonChart = (() => {
  const style = getComputedStyle(document.documentElement);
  const colour = name => style.getPropertyValue("--" + name).trim();
  const rgba = (name, share) => {
    const hex = colour(name).slice(1), part = k => parseInt(hex.slice(k, k + 2), 16);
    return `rgba(${part(0)}, ${part(2)}, ${part(4)}, ${share})`;
  };
  // Plotly takes a little HTML in texts; names are no HTML.
  const plain = text => String(text).replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");
  const MARKS = {
    circle: "M15 2.4a3.6 3.6 0 1 0 .01 0z", square: "M11.8 2.8h6.4v6.4h-6.4z", "triangle-up": "M15 1.6l4.1 7.6h-8.2z",
    diamond: "M15 1.4l4.6 4.6l-4.6 4.6l-4.6-4.6z", "triangle-down": "M15 10.4l4.1-7.6h-8.2z",
    cross: "M13.6 1.6h2.8v3h3v2.8h-3v3h-2.8v-3h-3v-2.8h3z",
  };

  function element(tag, parts, ...children) {
    const e = document.createElement(tag);
    for (const [name, value] of Object.entries(parts)) e.setAttribute(name, value);
    e.append(...children);
    return e;
  }

  // Round numbers along a logarithmic axis, ends given as powers of ten.
  function logMarks(low, high, unit) {
    const span = high - low, digits = span < 1.2 ? [1, 2, 3, 5, 7] : span < 3 ? [1, 2, 5] : [1];
    const values = [];
    for (let p = Math.floor(low); p <= Math.ceil(high); p++)
      for (const d of digits) {
        const at = p + Math.log10(d);
        if (at >= low && at <= high && (span < 9 || p % 2 === 0)) values.push(Number(d + "e" + p));
      }
    return { values, texts: values.map(v => label(v, unit)) };
  }
  function label(v, unit) {
    if (unit === "percent") return short(v) + " %";
    if (unit !== "count" || v < 1) return short(v);
    for (const [size, letter] of [[1e9, "G"], [1e6, "M"], [1e3, "k"]])
      if (v >= size && v >= 1e5) return short(v / size) + letter;
    return v.toLocaleString("en-US");
  }
  const short = v => v !== 0 && (Math.abs(v) < 1e-4 || Math.abs(v) >= 1e7) ? v.toExponential().replace("e+", "e") : String(Number(v.toPrecision(10)));

  return { colour, rgba, plain, MARKS, element, logMarks };
})();
