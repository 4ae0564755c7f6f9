// The numbers of one patch, and the rows of the tables that lead to it.
class Panel {
  constructor(box, { next, leave }) {
    Object.assign(this, { box, next, leave });
  }
  button(text, act) {
    const b = element("button", "", text);
    b.type = "button";
    b.addEventListener("click", act);
    return b;
  }
  row(title, value, note, on) {
    const row = element("tr", on ? "on" : "");
    const cell = element("td", "num", value);
    if (note) cell.append(element("small", "", note));
    row.append(element("td", "", title), cell);
    return row;
  }
  show(patch, onShow) {
    for (const row of document.querySelectorAll("tr.flies")) row.classList.toggle("shown", patch !== null && Number(row.dataset.patch) === patch);
    const turn = element("div", "viewer-turn");
    if (data.worst.length) turn.append(this.button("next of the worst", () => this.next(1)), this.button("previous", () => this.next(-1)));
    if (patch === null) {
      this.box.replaceChildren(element("p", "", "Click a patch for its numbers."), turn);
      return;
    }
    turn.append(this.button("let go", this.leave));
    const [surface, object] = data.surfaces[about.surface[patch]] ?? ["", ""];
    const rank = data.worst.indexOf(patch);
    const place = [surface, object !== surface && object].filter(Boolean).join(" \u00b7 ");
    const table = element("table");
    table.append(this.row("Material", data.materials[about.material[patch]] ?? ""), this.row("Area", `${shown(about.area[patch])} m\u00b2`));
    for (const layer of layers.filter(l => !l.natural && !(l.film !== null && !onShow.includes(l)))) {
      const value = valuesOf(layer)[patch] * layer.factor;
      const error = layer.key === "reference" && layerOf("std_err");
      const std = error ? ` \u00b1 ${shown(valuesOf(error)[patch])}` : "";
      table.append(this.row(layer.title, shown(value, isSigned(layer)) + std, layer.unit.replace(", luminance", ""), onShow.includes(layer)));
    }
    this.box.replaceChildren(element("h4", "", `Patch ${patch}`), element("p", "", place + (rank < 0 ? "" : ` \u00b7 no. ${rank + 1} of the worst`)), table, turn);
  }
}

// Rows that name a patch fly to it, by mouse and by keyboard.
function takeRows(fly) {
  for (const row of document.querySelectorAll("tr[data-patch]")) {
    const patch = Number(row.dataset.patch);
    if (!geometry.has(patch)) continue;
    row.classList.add("flies");
    row.tabIndex = 0;
    row.title = `Show patch ${patch} in the scene`;
    const go = () => { fly(patch); $("stage").scrollIntoView({ block: "nearest", behavior: calm.matches ? "auto" : "smooth" }); };
    row.addEventListener("click", go);
    row.addEventListener("keydown", e => { if (e.key === "Enter" || e.key === " ") { e.preventDefault(); go(); } });
  }
}
