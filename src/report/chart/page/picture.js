"use strict";
// A chart as the library draws it: its points, its axes and what is written beside them.
etalonChart.Picture = (() => {
  const { colour, rgba, plain, logMarks } = etalonChart;
  // Beyond so many points marks are small, beyond so many more they are faint.
  const CROWD = 40, SPARSE = 400;

  return class Picture {
    constructor(data) {
      this.data = data;
      this.on = data.series.map(() => true);
      this.log = { x: data.x.is_log, y: data.y.is_log };
      for (const axis of ["x", "y"]) this.scaleUp(axis);
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
  };
})();
