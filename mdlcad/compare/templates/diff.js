"use strict";
(() => {
  const NS = "http://www.w3.org/2000/svg";
  const scene = JSON.parse(document.getElementById("scene").textContent);
  const spots = JSON.parse(document.getElementById("spots").textContent);
  const plateBox = document.getElementById("plate"), modeBox = document.getElementById("mode");
  const under = document.getElementById("under");
  const panes = ["a", "b", "o"].map((id) => ({ id, figure: document.getElementById("pane-" + id) }));
  panes.forEach((pane) => { pane.svg = pane.figure.querySelector("svg"); });
  const [x0, y0, x1, y1] = scene.box, margin = 0.04 * Math.max(x1 - x0, y1 - y0);
  const whole = { x: (x0 + x1) / 2, y: (y0 + y1) / 2, w: x1 - x0 + 2 * margin, h: y1 - y0 + 2 * margin };
  // one view for all panes: its centre in mm, and the extent that must be visible
  let view = { ...whole }, focus = null;

  for (const { svg } of panes) svg.style.aspectRatio = String(whole.w / whole.h);

  const element = (name, attributes, parent) => {
    const made = document.createElementNS(NS, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (parent) parent.append(made);
    return made;
  };
  const changed = (plate) => plate.only_a !== null || plate.only_b !== null;

  const option = (value, words) => {
    const made = document.createElement("option");
    made.value = value;
    made.textContent = words;
    plateBox.append(made);
  };
  scene.plates.forEach((plate) => option(plate.name, plate.name + (changed(plate) ? "  ≠" : "")));
  option("*", "all plates");

  const chosen = () => scene.plates.filter((plate) => plateBox.value === "*" || plate.name === plateBox.value);

  function draw() {
    const overlay = modeBox.value === "overlay";
    for (const pane of panes) {
      pane.figure.hidden = (pane.id === "o") !== overlay;
      pane.svg.replaceChildren();
      pane.svg.classList.toggle("overlay", pane.id === "o");
      if (pane.figure.hidden) continue;
      const flip = element("g", { transform: "scale(1,-1)" }, pane.svg);
      for (const plate of chosen()) {
        for (const side of pane.id === "o" ? ["a", "b"] : [pane.id]) {
          for (const shape of plate[side]) {
            const path = element("path", { class: "body", d: scene.paths[shape.path], fill: shape.colour }, flip);
            path.dataset.name = shape.name;
          }
        }
      }
      for (const plate of chosen()) {
        if (plate.only_a !== null && pane.id !== "b")
          element("path", { class: "gone", d: scene.paths[plate.only_a], fill: "url(#gone)" }, flip);
        if (plate.only_b !== null && pane.id !== "a")
          element("path", { class: "new", d: scene.paths[plate.only_b], fill: "url(#new)" }, flip);
      }
      if (!flip.childNodes.length)
        element("text", { x: whole.x, y: -whole.y, "font-size": whole.w / 24, "text-anchor": "middle", fill: "#5b6876" }, pane.svg)
          .textContent = "nothing here";
      pane.marks = element("g", {}, pane.svg);
      marks(pane);
    }
    place();
  }

  function marks(pane) {
    const counts = {};
    for (const spot of spots) {
      counts[spot.plate] = (counts[spot.plate] || 0) + 1;
      if (plateBox.value !== "*" && spot.plate !== plateBox.value) continue;
      const [left, low, right, high] = spot.box;
      const mark = element("g", { class: "mark" }, pane.marks);
      mark.dataset.x = right;
      mark.dataset.y = -high;
      element("circle", { r: 8 }, mark);
      element("text", { y: 3.6, "font-size": 10, "text-anchor": "middle" }, mark).textContent = counts[spot.plate];
      const words = `${spot.plate}: ${spot.area_mm2.toPrecision(4)} mm² differ around (${((left + right) / 2).toFixed(2)}, ` +
        `${((low + high) / 2).toFixed(2)}) mm` + (spot.bodies.length ? `: ${spot.bodies.join(", ")}` : "");
      element("title", {}, mark).textContent = words;
      mark.addEventListener("click", () => { say(words); go(spot.box); });
    }
  }

  function place() {
    for (const pane of panes) {
      if (pane.figure.hidden) continue;
      pane.svg.setAttribute("viewBox", `${view.x - view.w / 2} ${-view.y - view.h / 2} ${view.w} ${view.h}`);
      const scale = perPixel(pane.svg);
      for (const mark of pane.marks.querySelectorAll(".mark"))
        mark.setAttribute("transform", `translate(${mark.dataset.x} ${mark.dataset.y}) scale(${scale})`);
      pane.svg.querySelector(".focus")?.remove();
      if (focus) {
        const grow = 4 * scale, [left, low, right, high] = focus;
        element("rect", { class: "focus", x: left - grow, y: -high - grow, width: right - left + 2 * grow, height: high - low + 2 * grow }, pane.svg);
      }
      // patterns keep their size on the screen
      for (const [id, turn] of [["gone", "rotate(45) "], ["new", ""]])
        document.getElementById(id).setAttribute("patternTransform", `${turn}scale(${scale})`);
    }
  }

  const perPixel = (svg) => {
    const box = svg.getBoundingClientRect();
    return Math.max(view.w / Math.max(box.width, 1), view.h / Math.max(box.height, 1));
  };
  const say = (words) => { under.textContent = words; };

  function zoom(factor, x = view.x, y = view.y) {
    const w = Math.min(Math.max(view.w * factor, 0.2), 8 * whole.w), f = w / view.w;
    view = { x: x + (view.x - x) * f, y: y + (view.y - y) * f, w, h: view.h * f };
    place();
  }

  function go(box) {
    const [left, low, right, high] = box, side = Math.max(right - left, high - low, 1);
    const w = Math.min(2.6 * side + 6, whole.w), f = w / whole.w;
    focus = box;
    view = { x: (left + right) / 2, y: (low + high) / 2, w, h: Math.max(whole.h * f, 1) };
    place();
  }

  const at = (svg, event) => {
    const box = svg.getBoundingClientRect(), scale = perPixel(svg);
    return {
      x: view.x + (event.clientX - box.left - box.width / 2) * scale,
      y: view.y - (event.clientY - box.top - box.height / 2) * scale,
    };
  };
  for (const { svg } of panes) {
    const pointers = new Map();
    svg.addEventListener("wheel", (event) => {
      event.preventDefault();
      const point = at(svg, event);
      zoom(Math.exp(event.deltaY * 0.0015), point.x, point.y);
    }, { passive: false });
    svg.addEventListener("pointerdown", (event) => pointers.set(event.pointerId, event));
    svg.addEventListener("pointermove", (event) => {
      const before = pointers.get(event.pointerId);
      const name = event.target.dataset?.name;
      if (!before) { if (name) say(name); return; }
      if (!svg.hasPointerCapture(event.pointerId)) svg.setPointerCapture(event.pointerId);
      const others = [...pointers.values()].filter((one) => one.pointerId !== event.pointerId);
      pointers.set(event.pointerId, event);
      const scale = perPixel(svg);
      if (others.length) {
        const gap = (one) => Math.hypot(one.clientX - others[0].clientX, one.clientY - others[0].clientY);
        const point = at(svg, others[0]);
        zoom(Math.max(gap(before), 1) / Math.max(gap(event), 1), point.x, point.y);
      } else {
        view.x -= (event.clientX - before.clientX) * scale;
        view.y += (event.clientY - before.clientY) * scale;
        place();
      }
    });
    for (const end of ["pointerup", "pointercancel", "pointerleave"])
      svg.addEventListener(end, (event) => pointers.delete(event.pointerId));
    svg.addEventListener("keydown", (event) => {
      const step = 0.1 * view.w;
      const act = {
        "+": () => zoom(0.8), "-": () => zoom(1.25), "0": fit,
        ArrowLeft: () => { view.x -= step; }, ArrowRight: () => { view.x += step; },
        ArrowUp: () => { view.y += step; }, ArrowDown: () => { view.y -= step; },
      }[event.key];
      if (act) { event.preventDefault(); act(); place(); }
    });
  }

  function fit() { view = { ...whole }; focus = null; place(); }
  document.getElementById("in").addEventListener("click", () => zoom(0.7));
  document.getElementById("out").addEventListener("click", () => zoom(1.4));
  document.getElementById("fit").addEventListener("click", fit);
  plateBox.addEventListener("change", draw);
  modeBox.addEventListener("change", draw);
  addEventListener("resize", place);

  for (const button of document.querySelectorAll(".change button[data-box]")) {
    button.addEventListener("click", () => {
      document.querySelector(".change button[aria-current]")?.removeAttribute("aria-current");
      button.setAttribute("aria-current", "true");
      const plate = button.dataset.plate;
      const known = scene.plates.some((one) => one.name === plate);
      if (known && plateBox.value !== plate) plateBox.value = plate;
      else if (!known && plate === "" && scene.plates.some((one) => one.name === "unit") && plateBox.value !== "*") plateBox.value = "unit";
      draw();
      go(button.dataset.box.split(" ").map(Number));
      say(button.textContent.trim().replace(/\s+/g, " "));
      if (matchMedia("(max-width: 860px)").matches) document.querySelector(".viewer").scrollIntoView({ behavior: "smooth" });
    });
  }
  document.getElementById("find").addEventListener("input", (event) => {
    const wanted = event.target.value.toLowerCase();
    for (const item of document.querySelectorAll(".change"))
      item.hidden = wanted !== "" && !item.textContent.toLowerCase().includes(wanted);
  });
  for (const chip of document.querySelectorAll(".chip"))
    chip.addEventListener("click", () => { document.querySelector(chip.getAttribute("href")).open = true; });

  // start where the largest difference is
  const first = spots.length ? spots.reduce((a, b) => (b.area_mm2 > a.area_mm2 ? b : a)).plate : null;
  const start = scene.plates.find((plate) => plate.name === first) || scene.plates.find(changed) ||
    scene.plates.find((plate) => plate.name === "unit") || scene.plates[0];
  plateBox.value = start.name;
  const asked = new URLSearchParams(location.hash.slice(1));
  if (asked.has("plate")) plateBox.value = asked.get("plate");
  if (asked.has("mode")) modeBox.value = asked.get("mode");
  draw();
})();
