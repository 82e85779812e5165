// The viewer: panes, what they show, and the means to move through them by mouse, touch and keyboard.

const kKeys = [["+  \u2212", "zoom"], ["0", "fit the whole image"], ["1", "a pixel a pixel"], ["Arrows", "pan; with Shift move the pixel that is kept"],
               ["Enter", "keep the pixel in the middle"], ["Esc", "let it go"], ["n  p", "next, previous place"],
               ["s  w  o", "side by side, slider, one"], ["[  ]", "the layer before, the layer after"], ["<  >", "move the slider"]];
const kDrag = 5;  // CSS pixels that a click may move

class Viewer {
  constructor(root, manifest) {
    this.manifest = manifest;
    this.root = root;
    this.layers = new Map(manifest.layers.map(spec => [spec.id, new Layer(spec, manifest.tile)]));
    for (const layer of this.layers.values()) {
      layer.whole_level = layer.whole || this.layers.get(layer.of[0]).whole;
      for (const level of layer.levels)
        if (layer.base) level.base = this.layers.get(layer.base).levels.find(other => other.scale === level.scale);
    }
    this.shown = [...this.layers.values()].filter(layer => layer.shown);
    const {compared, opens} = manifest;  // of which both sides, their difference and a map of classes are shown first
    const is_first_map = layer => layer.look === "classes" && (!opens || layer.id === opens);
    const comes_first = layer => !compared || is_first_map(layer) || [compared.reference, compared.test].includes(layer.id) ||
                                 (layer.look === "difference" && layer.of[0] === compared.reference);
    this.chosen = new Set(this.shown.filter(comes_first).slice(0, 4).map(layer => layer.id));
    this.one = this.shown[0].id;
    this.sides = manifest.compared ? [manifest.compared.reference, manifest.compared.test]
                                   : [this.shown[0].id, (this.shown[1] || this.shown[0]).id];
    this.mode = this.shown.length < 2 || innerWidth < 640 ? "one" : "side";
    if (this.mode === "one" && (opens || compared)) this.one = opens || compared.test;
    looks.gain = manifest.gain || looks.gain;
    this.panes = new Panes(manifest, this.layers, () => this.show_zoom());
    this.inspector = new Inspector(manifest, this.layers, this.panes);
    this.build();
    const at = /^#(\d+),(\d+)$/.exec(location.hash);
    if (at) this.go_to(Number(at[1]), Number(at[2]));
  }

  build() {
    this.stage = element("div", {className: "stage", tabIndex: 0, role: "group", "aria-label": "Pictures: arrows pan, plus and minus zoom, question mark lists all keys"});
    this.bar = element("div", {className: "bar"});
    this.choices = element("div", {className: "choices", role: "group", "aria-label": "Layers"});
    this.zoom_text = element("output", {className: "zoom"});
    const button = (text, title, action) => element("button", {type: "button", title, "aria-label": title, onclick: action}, text);
    this.modes = element("div", {className: "segments", role: "group", "aria-label": "How pictures are shown"});
    this.bar.append(this.modes, this.choices, element("span", {className: "gap"}),
      element("div", {className: "segments"}, button("\u2212", "Zoom out (\u2212)", () => this.zoom_by(0.5)), this.zoom_text,
              button("+", "Zoom in (+)", () => this.zoom_by(2)), button("Fit", "Fit the whole image (0)", () => this.panes.fit()),
              button("1:1", "A pixel a pixel (1)", () => this.panes.zoom_to(1))),
      button("?", "Keys", () => this.keys.hidden = !this.keys.hidden));
    this.keys = element("dl", {className: "keys card", hidden: true}, ...kKeys.flatMap(([keys, what]) => [element("dt", {}, keys), element("dd", {}, what)]));
    this.side = element("aside", {className: "side"}, ...this.navigation(), ...this.settings(), ...this.legends());
    this.inspector.hint = "Point at a pixel to read it; click to keep it. Click a picture, or hold Ctrl, and the wheel zooms.";
    this.inspector.show_cursor(null);
    this.root.replaceChildren(this.bar, this.keys,
      element("div", {className: "desk"}, element("div", {className: "pictures-side"}, this.stage, this.inspector.readout, this.inspector.card), this.side));
    this.listen();
    this.show();
  }

  show() {
    const names = {side: "Side by side", slider: "Slider", one: "One"};
    this.modes.replaceChildren(...Object.entries(names).filter(() => this.shown.length > 1).map(([mode, name]) => element("button",
      {type: "button", "aria-pressed": String(this.mode === mode), onclick: () => { this.mode = mode; this.show(); }}, name)));
    this.choices.replaceChildren(...(this.mode === "slider" ? this.side_choices() : this.layer_buttons()));
    const panes = [];
    const pane = (layer, right) => {
      const canvas = element("canvas", {role: "img"});
      canvas.setAttribute("aria-label", right ? `${layer.name} left, ${right.name} right` : `${layer.name}: ${layer.about}`);
      panes.push({canvas, layer, right});
      const label = right ? element("figcaption", {className: "both"}, element("span", {}, layer.name), element("span", {}, right.name))
                          : element("figcaption", {title: layer.about}, layer.name);
      return element("figure", {className: "pane"}, canvas, label);
    };
    let figures;
    if (this.mode === "slider") {
      figures = [pane(this.layers.get(this.sides[0]), this.layers.get(this.sides[1]))];
      figures[0].append(this.slider_handle());
    } else {
      const list = this.mode === "one" ? [this.layers.get(this.one)] : this.shown.filter(layer => this.chosen.has(layer.id));
      figures = list.map(layer => pane(layer));
    }
    this.stage.replaceChildren(...figures);
    this.stage.dataset.panes = figures.length;
    this.stage.style.setProperty("--shape", String(this.panes.width / this.panes.height));
    this.panes.show(panes);
    this.show_zoom();
  }

  layer_buttons() {
    return this.shown.map(layer => element("button", {
      type: "button", title: layer.about, "aria-pressed": String(this.mode === "one" ? this.one === layer.id : this.chosen.has(layer.id)),
      onclick: () => this.choose(layer.id)}, layer.name));
  }
  choose(id) {
    if (this.mode === "one") this.one = id;
    else if (!this.chosen.has(id)) this.chosen.add(id);
    else if (this.chosen.size > 1) this.chosen.delete(id);
    this.show();
  }
  side_choices() {
    return [0, 1].map(i => element("label", {}, element("span", {className: "quiet"}, i === 0 ? "left " : "right "),
      element("select", {onchange: event => { this.sides[i] = event.target.value; this.show(); }},
        ...this.shown.map(layer => element("option", {value: layer.id, selected: layer.id === this.sides[i]}, layer.name)))));
  }

  slider_handle() {
    const handle = element("div", {className: "handle", role: "slider", tabIndex: 0, "aria-label": "Where the left picture ends",
                                   "aria-valuemin": "0", "aria-valuemax": "100"});
    const move = split => {
      this.panes.split = Math.min(Math.max(split, 0), 1);
      handle.style.left = `${this.panes.split * 100}%`;
      handle.setAttribute("aria-valuenow", String(Math.round(this.panes.split * 100)));
      this.panes.redraw();
    };
    handle.addEventListener("pointerdown", event => { handle.setPointerCapture(event.pointerId); event.stopPropagation(); event.preventDefault(); handle.focus(); });
    handle.addEventListener("pointermove", event => {
      if (!handle.hasPointerCapture(event.pointerId)) return;
      const box = handle.parentElement.getBoundingClientRect();
      move((event.clientX - box.left) / box.width);
    });
    this.move_slider = by => move(this.panes.split + by);
    handle.addEventListener("keydown", event => {
      const by = {ArrowLeft: -0.02, ArrowRight: 0.02, Home: -1, End: 1}[event.key];
      if (by === undefined) return;
      this.move_slider(by);
      event.preventDefault();
      event.stopPropagation();
    });
    move(this.panes.split);
    return handle;
  }

  /// Buttons from place to place: violations, the largest differences, samples of each class.
  navigation() {
    const groups = (this.manifest.marks || []).filter(group => group.pixels.length);
    if (!groups.length) return [];
    this.place = 0;
    const first = this.manifest.marks[0];
    this.panes.marks = first.is_violations ? first.pixels : [];
    this.panes.mark_color = first.color;
    const choice = element("select", {"aria-label": "Places to go through", onchange: () => { this.place = 0; told.textContent = about(); }},
      ...groups.map((group, i) => element("option", {value: i}, group.name)));
    const told = element("p", {className: "quiet small"});
    const group_now = () => groups[Number(choice.value)] || groups[0];
    const about = () => group_now().about;
    let is_first = true;
    this.step = by => {
      const {pixels} = group_now();
      this.place = is_first ? 0 : (this.place + by + pixels.length) % pixels.length;
      is_first = false;
      const [x, y] = pixels[this.place];
      this.go_to(x, y);
      told.textContent = `${this.place + 1} of ${pixels.length}. ${about()}`;
    };
    choice.addEventListener("change", () => { is_first = true; });
    told.textContent = groups[0].about;
    return [element("section", {className: "card"}, element("h3", {}, "Places"),
      element("div", {className: "row"}, choice,
        element("button", {type: "button", title: "Previous (p)", "aria-label": "Previous place", onclick: () => this.step(-1)}, "\u2039"),
        element("button", {type: "button", title: "Next (n)", "aria-label": "Next place", className: "next", onclick: () => this.step(1)}, "\u203a")), told)];
  }

  go_to(x, y) {
    if (x >= this.panes.width || y >= this.panes.height) return;
    this.panes.centre_on(x, y, Math.max(this.panes.zoom, 24));
    this.pin([x, y]);
  }
  pin(pixel) {
    this.panes.pin = pixel;
    this.inspector.show_pin(pixel);
    this.panes.redraw();
  }

  settings() {
    const parts = [], layers = [...this.layers.values()];
    const range = (name, about, min, max, value, text, changed) => {
      const told = element("output", {}, text(value));
      const input = element("input", {type: "range", min, max, step: 1, value, "aria-label": name, oninput: () => {
        changed(Number(input.value));
        told.textContent = text(Number(input.value));
        this.panes.redraw();
      }});
      return element("div", {className: "setting"}, element("label", {}, element("span", {}, name), told, input), element("p", {className: "quiet small"}, about));
    };
    if (layers.some(layer => layer.look === "difference"))
      parts.push(range("Gain", "How much the picture of differences enlarges them.", 0, 16, Math.round(Math.log2(looks.gain)), value => `\u00d7${2 ** value}`,
                       value => { looks.gain = 2 ** value; }));
    if (layers.some(layer => layer.look === "linear"))
      parts.push(range("Exposure", "Makes linear light brighter for the eye; values stay as they are.", -16, 16, 0,
                       value => `${value > 0 ? "+" : ""}${value} stops`, value => { looks.exposure = value; }));
    return parts.length ? [element("section", {className: "card"}, element("h3", {}, "Looks"), ...parts)] : [];
  }

  legends() {
    const maps = [...this.layers.values()].filter(layer => layer.look === "classes");
    if (!maps.length) return [];
    const counted = maps[0].classes.filter((found, i) => found.name === "VIOLATION" || maps.some(map => map.classes[i].count > 0));
    const counts = found => maps.map(map => map.classes.find(other => other.name === found.name).count);
    const rows = counted.map(found => {
      const box = element("input", {type: "checkbox", checked: true, onchange: () => {
        if (box.checked) looks.hidden_classes.delete(found.name); else looks.hidden_classes.add(found.name);
        this.panes.redraw();
      }});
      return element("li", {}, element("label", {}, box, color_chip(found.color), element("b", {}, found.name),
        element("span", {className: "count"}, counts(found).map(count => count.toLocaleString("en").replaceAll(",", "\u2009")).join(" | "))),
        element("p", {className: "quiet small"}, found.meaning));
    });
    return [element("section", {className: "card legend"}, element("h3", {}, "Classes"),
      element("p", {className: "quiet small"}, `Pixels of each class${maps.length > 1 ? ` in ${maps.map(map => map.stage).join(" | ")}` : ""}. A class that is switched off shows the picture, darkened.`),
      element("ul", {}, ...rows))];
  }

  show_zoom() {
    if (this.panes.list.length) this.zoom_text.textContent = `${Number((this.panes.zoom * 100).toPrecision(this.panes.zoom < 1 ? 2 : 3))} %`;
  }
  zoom_by(factor, left, top) {
    const next = Math.log2(this.panes.zoom * factor);
    this.panes.zoom_to(2 ** (factor === 2 ? Math.floor(next + 0.01) : Math.ceil(next - 0.01)), left, top);
  }

  listen() {
    const {stage, panes} = this, held = new Map();
    let moved = 0, apart = 0;
    const place = event => {
      const canvas = event.target.closest?.(".pane")?.querySelector("canvas");
      if (!canvas) return null;
      const box = canvas.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    stage.addEventListener("pointerdown", event => {
      if (event.button !== 0 || !place(event)) return;
      held.set(event.pointerId, event);
      moved = held.size > 1 ? kDrag + 1 : 0;
      apart = 0;
      stage.focus({preventScroll: true});
      stage.setPointerCapture?.(event.pointerId);
      event.preventDefault();
    });
    stage.addEventListener("pointermove", event => {
      const before = held.get(event.pointerId);
      if (!before) {
        const at = place(event);
        panes.cursor = at && panes.pixel_at(...at);
        this.inspector.show_cursor(panes.cursor);
        return panes.redraw();
      }
      held.set(event.pointerId, event);
      moved += Math.abs(event.clientX - before.clientX) + Math.abs(event.clientY - before.clientY);
      if (held.size === 1 && moved > kDrag) panes.pan(event.clientX - before.clientX, event.clientY - before.clientY);
      if (held.size === 2) {
        const [a, b] = [...held.values()], now = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
        const box = stage.querySelector("canvas").getBoundingClientRect();
        panes.pan((event.clientX - before.clientX) / 2, (event.clientY - before.clientY) / 2);
        if (apart) panes.zoom_to(panes.zoom * now / apart, (a.clientX + b.clientX) / 2 - box.left, (a.clientY + b.clientY) / 2 - box.top);
        apart = now;
      }
    });
    const release = event => {
      const start = held.get(event.pointerId);
      held.delete(event.pointerId);
      apart = 0;
      if (!start || event.type === "pointercancel" || moved > kDrag) return;
      const canvas = document.elementsFromPoint(event.clientX, event.clientY).find(e => e.tagName === "CANVAS" && stage.contains(e));
      if (!canvas) return;
      const box = canvas.getBoundingClientRect();
      this.pin(panes.pixel_at(event.clientX - box.left, event.clientY - box.top));
    };
    stage.addEventListener("pointerup", release);
    stage.addEventListener("pointercancel", release);
    stage.addEventListener("pointerleave", () => { panes.cursor = null; this.inspector.show_cursor(null); panes.redraw(); });
    stage.addEventListener("wheel", event => {
      const at = place(event);
      if (!at || !(event.ctrlKey || stage.contains(document.activeElement))) return;
      event.preventDefault();
      panes.zoom_to(panes.zoom * Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.002)), ...at);
    }, {passive: false});
    this.root.addEventListener("keydown", event => this.key(event));
    document.addEventListener("click", event => {
      const link = event.target.closest?.("a[data-pixel]");
      if (!link) return;
      event.preventDefault();
      this.go_to(...link.dataset.pixel.split(",").map(Number));
      this.root.scrollIntoView({block: "start"});
    });
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || /^(SELECT|INPUT)$/.test(event.target.tagName)) return;
    const {panes} = this, step = 60, arrows = {ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};
    const next_layer = by => {
      const at = this.shown.findIndex(layer => layer.id === this.one);
      this.mode = "one";
      this.one = this.shown[(at + by + this.shown.length) % this.shown.length].id;
      this.show();
    };
    const mode = name => () => { if (this.shown.length > 1) { this.mode = name; this.show(); } };
    const actions = {
      "+": () => this.zoom_by(2), "=": () => this.zoom_by(2), "-": () => this.zoom_by(0.5), "0": () => panes.fit(), "1": () => panes.zoom_to(1),
      n: () => this.step?.(1), p: () => this.step?.(-1), s: mode("side"), w: mode("slider"), o: mode("one"),
      "[": () => next_layer(-1), "]": () => next_layer(1), "<": () => this.mode === "slider" && this.move_slider(-0.05),
      ">": () => this.mode === "slider" && this.move_slider(0.05), "?": () => { this.keys.hidden = !this.keys.hidden; },
      Escape: () => this.pin(null),
    };
    if (arrows[event.key] && event.target === this.stage) {
      const [dx, dy] = arrows[event.key];
      if (event.shiftKey && panes.pin) this.move_pin(-dx, -dy);
      else panes.pan(dx * step, dy * step);
    } else if (event.key === "Enter" && event.target === this.stage) {
      this.pin([Math.floor(panes.view.x), Math.floor(panes.view.y)]);
    } else if (actions[event.key]) {
      actions[event.key]();
    } else {
      return;
    }
    event.preventDefault();
  }
  move_pin(dx, dy) {
    const held = (at, size) => Math.min(Math.max(at, 0), size - 1), {panes} = this;
    const pixel = [held(panes.pin[0] + dx, panes.width), held(panes.pin[1] + dy, panes.height)];
    if (panes.zoom > 4) panes.centre_on(...pixel, panes.zoom);
    this.pin(pixel);
  }
}
