// The traces of a page: choose run and gauge, zoom by dragging, read values under the cursor. Data: plots.py.
"use strict";
(() => {
  const place = document.getElementById("traces");
  place.hidden = false;
  const traces = JSON.parse(document.getElementById("traces-data").textContent);
  const LINES = { measured: "measured", nominal: "nominal", extended: "extended" };
  const pick = { run: place.querySelector("[name=run]"), sensor: place.querySelector("[name=sensor]") };
  const boxes = { signal: place.querySelector(".signal"), left: place.querySelector(".left-over") };
  const note = place.querySelector(".thinned");
  const sync = uPlot.sync("traces");
  const digits = (v) => (v == null ? "–" : Number(v.toPrecision(4)).toString());
  let drawn = [];

  function fill(select, names) {
    const before = select.value;
    select.replaceChildren(...names.map((name) => new Option(name, name)));
    select.value = names.includes(before) ? before : names[0];
  }

  function colours() {
    const style = getComputedStyle(document.documentElement);
    const of = (name) => style.getPropertyValue(name).trim();
    return { ink: of("--ink"), line: of("--line"), measured: of("--measured"), nominal: of("--nominal"),
             extended: of("--extended") };
  }

  // Means of so many neighbours, times the root of their number: white noise keeps its size, one. null where
  // they are no neighbours, as samples between them do not count.
  function running(values, count, time) {
    const half = count >> 1, sums = [0], steps = time.slice(1).map((t, k) => t - time[k]).sort((a, b) => a - b);
    const longest = 3 * count * (steps[steps.length >> 1] || Infinity);
    for (const v of values) sums.push(sums[sums.length - 1] + v);
    return values.map((_, k) => {
      const a = k - half, b = a + count;
      const lone = a < 0 || b > values.length || time[b - 1] - time[a] > longest ||
        time[k] - time[k - 1] > longest;
      return lone ? null : (sums[b] - sums[a]) / Math.sqrt(count);
    });
  }

  function chart(box, height, data, series, label, range) {
    const c = colours();
    const values = (_, ticks) => ticks.map((v) => String(v).replace("-", "−"));
    // As wide as its longest number, so that these do not run into the name of the axis.
    const wide = (_, ticks) => Math.max(50, 18 + 7 * Math.max(0, ...(ticks || []).map((t) => String(t).length)));
    const axis = { stroke: c.ink, values, grid: { stroke: c.line, width: 1 }, ticks: { stroke: c.line, width: 1 } };
    const options = {
      width: box.clientWidth, height, scales: { x: { time: false }, y: range ? { range } : {} },
      cursor: { sync: { key: sync.key }, drag: { x: true, y: false } },
      axes: [{ ...axis, label: "time (µs)", labelSize: 20, size: 34 },
             { ...axis, label, labelSize: 20, size: wide, space: range ? 16 : 30 }],
      series: [{ label: "time (µs)", value: (_, v) => digits(v) }, ...series],
    };
    return new uPlot(options, data, box);
  }

  function draw() {
    const trace = traces.find((t) => t.run === pick.run.value && t.sensor === pick.sensor.value);
    drawn.forEach((one) => one.destroy());
    drawn = [];
    if (!trace) return;
    const c = colours(), kinds = Object.keys(LINES).filter((name) => name in trace);
    const values = Object.fromEntries(kinds.map((name) => [name, trace[name].map((v) => v * trace.value)]));
    const time = trace.times || trace.measured.map((_, k) => trace.start + k * trace.step);
    const shown = { N: "force (N)", "m/s": "velocity (m/s)", "m/s2": "acceleration (m/s²)",
                    "as recorded": "reading (as recorded)" };
    const signal = kinds.map((name) => ({
      label: LINES[name], stroke: c[name], width: name === "measured" ? 1 : 2, value: (_, v) => digits(v),
      dash: name === "nominal" ? [7, 4] : undefined,
      points: name === "measured" ? { show: true, size: 3, fill: c.measured } : { show: false },
      ...(name === "measured" ? { paths: () => null } : {}),
    }));
    const narrow = place.clientWidth < 520;
    drawn.push(chart(boxes.signal, narrow ? 240 : 300, [time, ...kinds.map((n) => values[n])], signal,
      shown[trace.unit] || trace.unit));
    const models = kinds.slice(1), count = Math.max(1, Math.floor(time.length / 60));
    const left = models.map((name) =>
      running(trace.measured.map((v, k) => (v - trace[name][k]) / trace.sigma), count, time));
    const lines = models.map((name) => ({
      label: LINES[name], stroke: c[name], width: 1.5, value: (_, v) => digits(v),
      dash: name === "nominal" ? [7, 4] : undefined, points: { show: false },
    }));
    const least = (u, low, high) => [Math.min(-3, low), Math.max(3, high)];
    drawn.push(chart(boxes.left, narrow ? 150 : 170, [time, ...left], lines, "over the noise", least));
    note.textContent = (trace.every > 1 ? `One sample in ${trace.every} is drawn. ` : "") +
      (trace.times ? "Samples that do not count are left out: there the lines of the models only join their neighbours." : "");
  }

  function gauges() {
    fill(pick.sensor, traces.filter((t) => t.run === pick.run.value).map((t) => t.sensor));
    draw();
  }

  function step(by) {
    const k = traces.findIndex((t) => t.run === pick.run.value && t.sensor === pick.sensor.value) + by;
    const next = traces[(k + traces.length) % traces.length];
    pick.run.value = next.run;
    gauges();
    pick.sensor.value = next.sensor;
    draw();
  }

  fill(pick.run, [...new Set(traces.map((t) => t.run))]);
  pick.run.value = place.dataset.run || pick.run.value;
  gauges();
  if (place.dataset.sensor) pick.sensor.value = place.dataset.sensor;
  draw();
  pick.run.addEventListener("change", gauges);
  pick.sensor.addEventListener("change", draw);
  place.querySelector("[name=earlier]").addEventListener("click", () => step(-1));
  place.querySelector("[name=later]").addEventListener("click", () => step(1));
  let wide = place.clientWidth;
  new ResizeObserver(() => {
    if (place.clientWidth !== wide) { wide = place.clientWidth; draw(); }
  }).observe(place);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
})();
