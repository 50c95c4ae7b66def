// What the pages do beyond being read: values under the cursor of a drawing, folds that links and printing open,
// tables that are filtered. Without it everything stands there still. Nothing is fetched.
(() => {
  "use strict";

  // ---- values under the cursor -------------------------------------------------------------------------------
  // A drawing is a <figure data-scales='{"panels": [...]}'> around an <svg>. A panel says where its frame is in
  // the drawing's own units, which data values its edges have, and which elements are its lines.
  const NS = "http://www.w3.org/2000/svg";

  // Points of a line, as drawn: of a path, of a polyline, or of the marks that stand for it.
  const pointsOf = (element) => {
    const line = element.matches("polyline") ? element : element.querySelector(":scope > path, :scope > g > path, polyline");
    const text = line && (line.getAttribute("points") || line.getAttribute("d"));
    if (text) {
      const numbers = text.match(/-?\d+(?:\.\d+)?(?:e-?\d+)?/g).map(Number);
      const at = [];
      for (let k = 0; k + 1 < numbers.length; k += 2) at.push([numbers[k], numbers[k + 1]]);
      return { joined: true, at };
    }
    const marks = [...element.querySelectorAll("use")];
    return { joined: false, at: marks.map((m) => [Number(m.getAttribute("x")), Number(m.getAttribute("y"))]) };
  };

  // Data value at a place between two edges of a panel.
  const valueAt = (place, [from, to], [low, high, log]) => {
    const part = (place - from) / (to - from);
    return log ? low * (high / low) ** part : low + part * (high - low);
  };
  const shown = (value) => (Math.abs(value) < 5e-4 ? "0" : String(Number(value.toPrecision(Math.abs(value) < 1 ? 2 : 4))));

  // Place of a joined line at x; null beside its ends.
  const between = (points, x) => {
    for (let k = 1; k < points.length; k++) {
      const [a, b] = [points[k - 1], points[k]];
      if (a[0] <= x && x <= b[0]) return [x, a[0] === b[0] ? a[1] : a[1] + ((x - a[0]) / (b[0] - a[0])) * (b[1] - a[1])];
    }
    return null;
  };

  const nearest = (panel, x, y) => {
    let best = null;
    for (const line of panel.lines) {
      const places = line.points.joined ? [between(line.points.at, x)] : line.points.at;
      for (const place of places) {
        if (!place) continue;
        const far = line.points.joined ? Math.abs(place[1] - y) : Math.hypot(place[0] - x, place[1] - y);
        if (!best || far < best.far) best = { far, place, line };
      }
    }
    return best;
  };

  // A space-time map is a grey picture, the root of the force over its largest as darkness; read off its own pixels.
  const pixels = (panel, svg) => {
    if (!panel.map || panel.pixels) return;
    const picture = new Image();
    picture.onload = () => {
      const canvas = document.createElement("canvas");
      [canvas.width, canvas.height] = [picture.width, picture.height];
      const context = canvas.getContext("2d", { willReadFrequently: true });
      context.drawImage(picture, 0, 0);
      panel.pixels = context.getImageData(0, 0, picture.width, picture.height);
    };
    picture.src = svg.querySelector("image").getAttribute("href");
  };
  const forceAt = (panel, x, y) => {
    if (!panel.pixels) return null;
    const [left, top, right, bottom] = panel.box;
    const { width, height, data } = panel.pixels;
    const column = Math.min(width - 1, Math.floor(((x - left) / (right - left)) * width));
    const row = Math.min(height - 1, Math.floor(((y - top) / (bottom - top)) * height));
    return { row, force: panel.map.most * (1 - data[4 * (row * width + column)] / 255) ** 2 };
  };

  // What all lines of some panels show at x.
  const readings = (panels, x) =>
    panels.flatMap((panel) => panel.lines.map((line) => ({ panel, line, place: between(line.points.at, x) }))).filter((r) => r.place);

  for (const figure of document.querySelectorAll("figure[data-scales]")) {
    const svg = figure.querySelector("svg");
    const { panels } = JSON.parse(figure.dataset.scales);
    let ready = false;
    const prepare = () => {
      ready = true;
      for (const panel of panels) {
        panel.lines = (panel.lines || []).map((line) => ({ ...line, element: document.getElementById(line.id) }));
        panel.lines = panel.lines.filter((line) => line.element);
        for (const line of panel.lines) line.points = pointsOf(line.element);
        pixels(panel, svg);
      }
    };
    const value = (panel, line, place) => {
      const [left, top, right, bottom] = panel.box;
      const y = valueAt(place[1], [bottom, top], panel.y) - (line.base || 0);
      return { x: valueAt(place[0], [left, right], panel.x), y };
    };
    const dot = document.createElementNS(NS, "circle");
    dot.setAttribute("r", 2.6);
    dot.setAttribute("class", "cursor");
    const rule = document.createElementNS(NS, "line");
    rule.setAttribute("class", "cursor");
    const told = document.createElement("output");
    told.className = "told";
    told.hidden = true;
    figure.append(told);
    const away = () => {
      dot.remove();
      rule.remove();
      told.hidden = true;
      for (const line of figure.querySelectorAll(".picked")) line.classList.remove("picked");
    };
    const upright = (x) => {
      for (const [k, v] of Object.entries({ x1: x, x2: x, y1: panels[0].box[1], y2: panels.at(-1).box[3] })) rule.setAttribute(k, v);
      svg.append(rule);
    };
    // What the cursor tells over a map: time, contact, force, and every gauge at that time.
    const overMap = (panel, x, y) => {
      const time = valueAt(x, [panel.box[0], panel.box[2]], panel.x);
      const seen = forceAt(panel, x, y);
      const parts = [`${shown(time)} ${panel.xunit}`];
      if (seen) parts.push(`${panel.map.rows[seen.row]}: ${shown(seen.force)} N`);
      for (const { panel: own, line, place } of readings(panels.slice(1), x)) {
        parts.push(`${line.name}: ${shown(value(own, line, place).y)} ${own.yunit}`);
        line.element.classList.toggle("picked", Boolean(seen) && line.rows.includes(seen.row));
      }
      upright(x);
      return parts.join(" · ");
    };
    const overLines = (panel, x, y) => {
      const found = nearest(panel, x, y);
      if (!found) return "";
      const at = value(panel, found.line, found.place);
      dot.setAttribute("cx", found.place[0]);
      dot.setAttribute("cy", found.place[1]);
      svg.append(dot);
      if (panels[0].map) upright(found.place[0]);
      return `${found.line.name}: ${shown(at.x)} ${panel.xunit}, ${shown(at.y)} ${panel.yunit}`;
    };
    const move = (event) => {
      if (!ready) prepare();
      const matrix = svg.getScreenCTM();
      if (!matrix) return;
      const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse());
      const panel = panels.find(({ box: [left, top, right, bottom] }) => left <= x && x <= right && top <= y && y <= bottom);
      away();
      if (!panel) return;
      told.textContent = panel.map ? overMap(panel, x, y) : overLines(panel, x, y);
      told.hidden = !told.textContent;
      const frame = figure.getBoundingClientRect();
      const wanted = Math.min(event.clientX - frame.left + 14, frame.width - told.offsetWidth);
      told.style.left = `${figure.scrollLeft + Math.max(0, wanted)}px`;
      told.style.top = `${event.clientY - frame.top + 14}px`;
    };
    svg.addEventListener("pointermove", move);
    svg.addEventListener("pointerdown", move);
    svg.addEventListener("pointerleave", away);
  }

  // ---- tables that are filtered ------------------------------------------------------------------------------
  for (const controls of document.querySelectorAll(".controls[data-table]")) {
    const rows = [...document.querySelectorAll(`#${controls.dataset.table} > tbody > tr`)];
    const buttons = [...controls.querySelectorAll("button")];
    const search = controls.querySelector("input");
    const counted = controls.querySelector("[aria-live]");
    let group = "";
    const show = () => {
      const words = search.value.toLowerCase().split(/\s+/);
      let count = 0;
      for (const row of rows) {
        const text = row.textContent.toLowerCase();
        row.hidden = !((!group || row.dataset.group === group) && words.every((word) => text.includes(word)));
        count += !row.hidden;
      }
      counted.textContent = `${count} shown`;
    };
    for (const button of buttons) button.addEventListener("click", () => {
      group = button.dataset.group;
      for (const other of buttons) other.setAttribute("aria-pressed", other === button);
      show();
    });
    search.addEventListener("input", show);
    show();
  }

  // ---- folds -------------------------------------------------------------------------------------------------
  const unfold = () => {
    const target = location.hash.length > 1 && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (!target) return;
    for (let part = target; part; part = part.parentElement) if (part.matches("details")) part.open = true;
    for (const part of target.querySelectorAll(":scope > details")) part.open = true;
    target.scrollIntoView();
  };
  addEventListener("hashchange", unfold);
  unfold();
  // Paper has no folds: what is folded is printed unless it says otherwise, and folded again.
  let opened = [];
  addEventListener("beforeprint", () => {
    opened = [...document.querySelectorAll("details:not([open]):not(.unprinted)")];
    for (const part of opened) part.open = true;
  });
  addEventListener("afterprint", () => {
    for (const part of opened) part.open = false;
  });

  // ---- animations --------------------------------------------------------------------------------------------
  const quiet = matchMedia("(prefers-reduced-motion: reduce)").matches;
  for (const button of document.querySelectorAll("button.play")) {
    const svg = button.closest("figure").querySelector("svg");
    const toggle = (stop) => {
      svg[stop ? "pauseAnimations" : "unpauseAnimations"]();
      button.textContent = stop ? "play" : "pause";
    };
    button.addEventListener("click", () => toggle(!svg.animationsPaused()));
    toggle(quiet);
  }
})();
