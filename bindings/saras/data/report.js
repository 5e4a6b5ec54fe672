// Shows the values under the pointer, and the same moment in every other time chart.
"use strict";
(() => {
  const tip = document.createElement("div");
  tip.className = "tip";
  tip.hidden = true;
  document.body.append(tip);
  const charts = [...document.querySelectorAll("svg.chart")].map((svg) => {
    const numbers = (name) => svg.dataset[name].split(" ").map(Number);
    const [x0, x1] = numbers("x"), [y0, y1] = numbers("y"), [left, right, top, bottom] = numbers("box");
    const cross = document.createElementNS("http://www.w3.org/2000/svg", "line");
    cross.setAttribute("class", "cross");
    cross.setAttribute("y1", top);
    cross.setAttribute("y2", bottom);
    cross.style.display = "none";
    svg.append(cross);
    return { svg, cross, x0, x1, y0, y1, left, right, top, bottom, time: svg.dataset.time === "1" };
  });
  const nearest = (line, px) => {
    let best = null;
    for (const polyline of line.children) {
      for (const point of polyline.points) {
        const distance = Math.abs(point.x - px);
        if (best === null || distance < best.distance) best = { distance, y: point.y };
      }
    }
    return best !== null && best.distance < 6 ? best.y : null;
  };
  const hide = () => {
    tip.hidden = true;
    for (const chart of charts) chart.cross.style.display = "none";
  };
  for (const chart of charts.filter((each) => each.time)) {
    chart.svg.addEventListener("pointermove", (event) => {
      const box = chart.svg.getBoundingClientRect();
      const px = ((event.clientX - box.left) * chart.svg.viewBox.baseVal.width) / box.width;
      if (px < chart.left || px > chart.right) return hide();
      const t = chart.x0 + ((px - chart.left) / (chart.right - chart.left)) * (chart.x1 - chart.x0);
      const rows = [`${t.toFixed(3)} s`];
      for (const line of chart.svg.querySelectorAll("g.line")) {
        const y = nearest(line, px);
        const value = y === null ? "unknown" : (chart.y1 - ((y - chart.top) / (chart.bottom - chart.top)) * (chart.y1 - chart.y0)).toPrecision(4);
        rows.push(`${line.dataset.label}: ${value}`);
      }
      tip.textContent = rows.join("\n");
      tip.hidden = false;
      tip.style.left = `${Math.min(event.clientX + 14, innerWidth - tip.offsetWidth - 8)}px`;
      tip.style.top = `${event.clientY + 14}px`;
      for (const other of charts) {
        if (!other.time) continue;
        const at = other.left + ((t - other.x0) / (other.x1 - other.x0)) * (other.right - other.left);
        other.cross.setAttribute("x1", at);
        other.cross.setAttribute("x2", at);
        other.cross.style.display = "";
      }
    });
    chart.svg.addEventListener("pointerleave", hide);
  }
})();
