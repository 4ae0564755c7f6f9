"use strict";
// Draws the charts of a page over their still drawings. Without it the drawings stay; in print they come back.
(() => {
  const { MARKS, element, Picture } = etalonChart;

  class Drawing extends Picture {
    constructor(figure) {
      super(JSON.parse(figure.querySelector("script").textContent));
      this.figure = figure;
      this.at = -1;
      this.build();
      this.draw();
      figure.classList.add("drawn");
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
