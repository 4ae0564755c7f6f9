"use strict";
// Draws the charts of a page over their still drawings. Without it the drawings stay; in print they come back.
(() => {
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
  const CROWD = 40, SPARSE = 400;

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

  class Drawing {
    constructor(figure) {
      this.figure = figure;
      this.data = JSON.parse(figure.querySelector("script").textContent);
      this.on = this.data.series.map(() => true);
      this.log = { x: this.data.x.is_log, y: this.data.y.is_log };
      this.at = -1;
      for (const axis of ["x", "y"]) this.scaleUp(axis);
      this.build();
      this.draw();
      figure.classList.add("drawn");
    }

    // Shares become per cent.
    scaleUp(name) {
      const axis = this.data[name], times = v => v === null ? null : 100 * v;
      if (axis.unit !== "percent") return;
      for (const s of this.data.series) {
        for (const key of name === "x" ? ["x", "width"] : ["y", "low", "high"]) if (s[key]) s[key] = s[key].map(times);
        if (s.fit) s.fit[name] = s.fit[name].map(times);
      }
      if (name === "y") for (const r of this.data.rules) r.y *= 100;
      for (const key of ["log", "linear"]) if (axis[key]) axis[key] = axis[key].map(times);
    }

    build() {
      const live = this.figure.querySelector(".live");
      this.stage = element("div", { class: "stage", tabindex: "0", role: "group", "aria-roledescription": "interactive chart",
        "aria-label": `${this.data.title}. Left and right arrow go from point to point, plus and minus zoom, 0 shows all.` });
      this.said = element("p", { class: "said", "aria-live": "polite" });
      this.handles = element("div", { class: "handles" });
      for (const axis of ["x", "y"]) if (this.data[axis].log && !this.data[axis].names) this.handle(axis);
      const reset = element("button", { type: "button", class: "reset" }, "Show all");
      reset.addEventListener("click", () => this.reset());
      this.handles.append(reset);
      this.keys = element("div", { class: "keys", role: "group", "aria-label": "Shown; a double click shows one alone" });
      this.data.series.forEach((s, k) => { if (s.name && s.x.length) this.key(s, k); });
      this.stage.addEventListener("keydown", e => this.pressed(e));
      this.stage.addEventListener("blur", () => Plotly.Fx.unhover(this.stage));
      live.append(this.handles, this.stage, this.keys, this.said);
      live.hidden = false;
    }

    // The switch between linear and logarithmic.
    handle(axis) {
      const button = element("button", { type: "button", class: "log-" + axis });
      const show = () => {
        button.textContent = `${axis === "x" ? "Horizontal" : "Vertical"}: ${this.log[axis] ? "logarithmic" : "linear"}`;
        button.setAttribute("aria-pressed", this.log[axis]);
      };
      button.addEventListener("click", () => { this.log[axis] = !this.log[axis]; show(); this.draw(); });
      show();
      this.handles.append(button);
    }

    key(s, k) {
      const line = s.shape === "line" || s.shape === "steps", ns = "http://www.w3.org/2000/svg";
      const svg = document.createElementNS(ns, "svg"), path = (d, parts) => {
        const p = document.createElementNS(ns, "path");
        for (const [name, value] of Object.entries({ d, ...parts })) p.setAttribute(name, value);
        svg.append(p);
      };
      svg.setAttribute("viewBox", "0 0 30 12");
      svg.setAttribute("aria-hidden", "true");
      const dash = { solid: "none", dash: "6 4", dot: "2 3" }[s.dash];
      if (line) path("M0 6h30", { style: `stroke: var(--${s.paint})`, "stroke-width": 1.8, "stroke-dasharray": dash });
      const mark = s.shape === "bars" ? "M7 1h16v10h-16z" : s.shape === "steps" ? "" : MARKS[s.mark];
      if (mark) path(mark, { style: `fill: var(--${s.paint})` });
      const button = element("button", { type: "button", "aria-pressed": "true", "data-series": k }, svg, element("span", {}, s.name));
      if (s.fit && s.fit.text) button.append(element("small", {}, s.fit.text));
      button.addEventListener("click", () => { this.on[k] = !this.on[k]; this.shown(); });
      button.addEventListener("dblclick", () => this.alone(k));
      this.keys.append(button);
    }

    // One alone; all again where it is alone already. The two clicks before have changed nothing.
    alone(k) {
      const alone = this.on.every((on, j) => on === (j === k));
      this.on = this.on.map((_, j) => alone || j === k);
      this.shown();
    }

    shown() {
      for (const b of this.keys.children) b.setAttribute("aria-pressed", this.on[b.dataset.series]);
      this.at = -1;
      this.draw();
    }

    // Where points at no cost stand on a logarithmic axis, as a power of ten, if there are any.
    margin() {
      if (!this.log.x || !this.data.series.some(s => s.x.some(x => x <= 0))) return null;
      const [low, high] = this.data.x.log.map(Math.log10), width = 0.09 * (high - low);
      return { low: low - width, at: low - 0.6 * width, end: low };
    }

    traces() {
      const margin = this.margin(), floor = this.log.y ? this.data.y.log[0] : -Infinity;
      const x = v => v > 0 || !margin ? v : 10 ** margin.at;
      // What reaches to 0 or below ends at the axis; pointed at, it says what it is.
      const y = v => v === null ? null : Math.max(v, floor);
      const out = [];
      this.data.series.forEach((s, k) => {
        const common = { visible: this.on[k], showlegend: false, type: "scatter", meta: k };
        const silent = { ...common, hoverinfo: "skip" };
        const hover = { text: s.text.map(t => this.hint(s, t)), hovertemplate: "%{text}<extra></extra>",
          hoverlabel: { bordercolor: colour(s.paint) } };
        if (s.shape === "bars") {
          const bar = { ...common, ...hover, type: "bar", x: s.x, y: s.y, width: s.width,
            marker: { color: colour(s.paint), line: { width: 0 } }, textposition: "none" };
          if (s.high) bar.error_y = this.whiskers(s, y, "ink");
          out.push(bar);
          return;
        }
        // A step runs over its whole width.
        if (s.shape === "steps") {
          const ends = s.x.flatMap((v, i) => [v - s.width[i] / 2, v + s.width[i] / 2]), twice = list => list.flatMap(v => [v, v]);
          out.push({ ...common, ...hover, text: twice(hover.text), x: ends, y: twice(s.y.map(y)), mode: "lines",
            line: { color: colour(s.paint), width: 2, dash: s.dash } });
          return;
        }
        // From left to right, as the drawing has it.
        const order = s.x.map((_, i) => i);
        if (s.shape === "line") order.sort((a, b) => s.x[a] - s.x[b]);
        const of = (list, f) => order.map(i => f(list[i]));
        const xs = of(s.x, x), back = list => list.slice().reverse();
        if (s.shape === "line" && s.high && xs.length > 1)
          out.push({ ...silent, x: xs.concat(back(xs)), y: of(s.high, y).concat(back(of(s.low, y))), fill: "toself",
            fillcolor: rgba(s.paint, 0.15), line: { width: 0 }, mode: "lines" });
        if (s.fit) out.push({ ...silent, x: s.fit.x, y: s.fit.y, mode: "lines", line: { color: colour(s.paint), width: 1.3, dash: "dot" } });
        const crowded = xs.length > CROWD;
        const trace = { ...common, ...hover, text: of(hover.text, t => t), x: xs, y: of(s.y, y), name: plain(s.name),
          mode: s.shape === "line" ? "lines+markers" : "markers", line: { color: colour(s.paint), width: 2, dash: s.dash },
          cliponaxis: false,
          marker: { color: colour(s.paint), symbol: s.mark, size: crowded ? 4 : 8, opacity: xs.length > SPARSE ? 0.6 : 1 } };
        if (s.high && !crowded) trace.error_y = this.whiskers({ y: of(s.y, v => v), low: of(s.low, v => v), high: of(s.high, v => v) }, y, s.paint);
        out.push(trace);
      });
      return out;
    }

    whiskers(s, y, paint) {
      return { type: "data", symmetric: false, array: s.high.map((v, i) => y(v) - y(s.y[i])), arrayminus: s.low.map((v, i) => y(s.y[i]) - y(v)),
        color: colour(paint), thickness: 1.3, width: 4 };
    }

    hint(s, text) {
      const name = s.name ? `<b>${plain(s.name)}</b><br>` : "";
      return name + plain(text);
    }

    layout() {
      const margin = this.margin(), soft = colour("soft"), ink = colour("ink"), narrow = this.stage.clientWidth < 460;
      const layout = {
        paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", barmode: "overlay", bargap: 0.04,
        margin: { l: narrow ? 58 : 66, r: 12, t: 10, b: this.data.x.names ? 64 : 50 },
        font: { family: getComputedStyle(document.body).fontFamily, size: narrow ? 11 : 12.5, color: soft },
        hovermode: this.data.series.some(s => s.shape === "line") ? "x unified" : "closest", hoverdistance: 40,
        hoverlabel: { bgcolor: colour("card"), bordercolor: colour("line"), align: "left", namelength: -1,
          font: { color: ink, family: getComputedStyle(document.body).fontFamily, size: 12.5 } },
        dragmode: matchMedia("(pointer: coarse)").matches ? false : "zoom", uirevision: "same", shapes: [], annotations: [],
        xaxis: this.axis("x", margin), yaxis: this.axis("y", null),
      };
      for (const r of this.data.rules) this.rule(r, layout, soft, margin);
      if (margin) {
        layout.shapes.push({ type: "rect", xref: "x", yref: "paper", x0: 10 ** margin.low, x1: 10 ** margin.end, y0: 0, y1: 1,
          fillcolor: colour("well"), line: { width: 0 }, layer: "below" });
      }
      this.labels(layout, soft);
      return layout;
    }

    // What is written beside points: above or below, where nothing else is written.
    labels(layout, soft) {
      const taken = [], place = (name, v) => {
        const [a, b] = layout[name + "axis"].range, at = this.log[name] ? Math.log10(v) : v;
        return (at - a) / (b - a) * (name === "x" ? this.stage.clientWidth - 80 : this.stage.clientHeight - 60);
      };
      this.data.series.forEach((s, k) => (this.on[k] && s.label || []).forEach((text, i) => {
        if (!text || (this.log.x && !(s.x[i] > 0)) || (this.log.y && !(s.y[i] > 0))) return;
        const x = place("x", s.x[i]), y = place("y", s.y[i]), half = 3.4 * text.length;
        const free = shift => taken.every(t => Math.abs(t.x - x) > t.half + half || Math.abs(t.y - y - shift) > 13);
        const yshift = [14, -14, 27, -27].find(free);
        if (yshift === undefined) return;
        taken.push({ x, y: y + yshift, half });
        layout.annotations.push({ x: this.log.x ? Math.log10(s.x[i]) : s.x[i], y: this.log.y ? Math.log10(s.y[i]) : s.y[i],
          text: plain(text), showarrow: false, yshift, font: { size: 11, color: soft } });
      }));
    }

    // A line across; curves come down from the left, so that its name stands there.
    rule(r, layout, soft, margin) {
      layout.shapes.push({ type: "line", xref: "paper", x0: 0, x1: 1, y0: r.y, y1: r.y, line: { color: soft, width: 1.3, dash: "dash" } });
      const inside = !this.log.y || r.y >= this.data.y.log[0];
      const lines = this.data.series.some(s => s.shape === "line"), at = lines ? { x: margin ? 0.09 : 0.005, xanchor: "left" } : { x: 1, xanchor: "right" };
      if (r.name) layout.annotations.push({ xref: "paper", ...at, yref: inside ? "y" : "paper", yanchor: "bottom",
        y: inside ? (this.log.y ? Math.log10(r.y) : r.y) : 0, text: plain(r.name) + (inside ? "" : " (below)"), showarrow: false, font: { size: 11, color: soft },
        bgcolor: colour("card"), opacity: 0.85 });
    }

    axis(name, margin) {
      const axis = this.data[name], log = this.log[name], grid = colour("line");
      const out = { title: { text: plain(axis.title), standoff: 8 }, type: log ? "log" : "linear", range: this.range(name, margin),
        gridcolor: grid, zerolinecolor: grid, linecolor: colour("soft"), showline: true, ticks: "", automargin: true,
        uirevision: String(log), spikecolor: colour("soft"), spikethickness: 1, spikedash: "dot" };
      if (name === "x") out.unifiedhovertitle = { text: plain(axis.title) };
      if (axis.names) return { ...out, tickmode: "array", tickvals: axis.names.map((_, k) => k),
        ticktext: axis.names.map(n => plain(n).replace(/ (?=\S+$)/, "<br>")), showgrid: false, fixedrange: true };
      if (log) return { ...out, ...this.marks(name, out.range, margin) };
      return { ...out, tickformat: axis.unit === "count" ? "~s" : "", ticksuffix: axis.unit === "percent" ? " %" : "", exponentformat: "power" };
    }

    marks(name, [low, high], margin) {
      // Close up, the axis finds marks of its own.
      if (high - low < 0.4) return { tickmode: "auto", tickformat: "~g", ticksuffix: this.data[name].unit === "percent" ? " %" : "" };
      const { values, texts } = logMarks(margin ? Math.max(low, margin.end) : low, high, this.data[name].unit);
      return margin ? { tickmode: "array", tickvals: [10 ** margin.at, ...values], ticktext: ["0", ...texts] }
        : { tickmode: "array", tickvals: values, ticktext: texts };
    }

    range(name, margin) {
      const axis = this.data[name];
      if (this.log[name]) return [margin ? margin.low : Math.log10(axis.log[0]), Math.log10(axis.log[1])];
      if (axis.linear) return axis.linear;
      // From 0 to what is highest, with some room.
      const all = this.data.series.flatMap(s => name === "y" && s.high ? s.y.concat(s.high.map((h, i) => Math.min(h, 2 * s.y[i]))) : s[name]);
      return [Math.min(0, ...all), 1.05 * Math.max(...all, ...(name === "y" ? this.data.rules.map(r => r.y) : []))];
    }

    draw() {
      const config = { displayModeBar: false, displaylogo: false, responsive: true, doubleClick: "reset", typesetMath: false,
        showTips: false, plotlyServerURL: "" };
      const first = !this.stage.data;
      Plotly.react(this.stage, this.traces(), this.layout(), config);
      if (first) this.stage.on("plotly_relayout", change => this.zoomed(change));
    }

    // New marks for what is seen now.
    zoomed(change) {
      const update = {};
      for (const name of ["x", "y"]) {
        if (!this.log[name] || !Object.keys(change).some(k => k.startsWith(name + "axis.") && /range/.test(k))) continue;
        const marks = this.marks(name, this.stage.layout[name + "axis"].range, name === "x" ? this.margin() : null);
        for (const [key, value] of Object.entries(marks)) update[`${name}axis.${key}`] = value;
      }
      if (Object.keys(update).length) Plotly.relayout(this.stage, update);
    }

    reset() {
      Plotly.relayout(this.stage, { "xaxis.range": this.range("x", this.margin()), "yaxis.range": this.range("y", null) });
    }

    zoom(factor) {
      const update = {};
      for (const name of ["xaxis", "yaxis"]) {
        if (this.stage.layout[name].fixedrange) continue;
        const [a, b] = this.stage.layout[name].range, middle = (a + b) / 2, half = factor * (b - a) / 2;
        update[name + ".range"] = [middle - half, middle + half];
      }
      Plotly.relayout(this.stage, update);
    }

    pressed(e) {
      const steps = { ArrowLeft: -1, ArrowRight: 1 };
      if (e.ctrlKey || e.metaKey || e.altKey) return;
      if (e.key in steps) this.step(steps[e.key]);
      else if (e.key === "+" || e.key === "=") this.zoom(0.7);
      else if (e.key === "-") this.zoom(1 / 0.7);
      else if (e.key === "0") this.reset();
      else if (e.key === "Escape") Plotly.Fx.unhover(this.stage);
      else return;
      e.preventDefault();
    }

    // The next place along the axis with a point on it: shown, and said.
    step(by) {
      const shown = this.data.series.map((s, k) => [s, k]).filter(([, k]) => this.on[k]);
      const places = [...new Set(shown.flatMap(([s]) => s.x))].sort((a, b) => a - b);
      if (!places.length) return;
      this.at = this.at < 0 ? (by > 0 ? 0 : places.length - 1) : Math.min(Math.max(this.at + by, 0), places.length - 1);
      const x = places[this.at], points = [], texts = [];
      const full = this.stage.data;
      for (const [s, k] of shown) {
        const curve = full.findIndex(t => t.meta === k && t.text);
        s.x.forEach((v, i) => {
          if (v !== x) return;
          const wanted = this.hint(s, s.text[i]);
          points.push({ curveNumber: curve, pointNumber: full[curve].text.indexOf(wanted) });
          texts.push(`${s.name} ${s.text[i]}`);
        });
      }
      Plotly.Fx.hover(this.stage, points);
      this.said.textContent = texts.join("; ");
    }
  }

  const drawings = [];
  for (const figure of document.querySelectorAll("figure[data-chart]"))
    try { drawings.push(new Drawing(figure)); } catch (e) { figure.classList.remove("drawn"); figure.querySelector(".live").hidden = true; console.error(e); }
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => drawings.forEach(d => d.draw()));
})();
