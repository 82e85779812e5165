// What a pixel holds, and why: the line under the panes, and the card of the pixel that was clicked.

/// An element with properties and children; texts become text, never HTML.
function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (name in made && !name.includes("-")) made[name] = value;
    else made.setAttribute(name, value);
  }
  made.append(...children.filter(child => child !== null && child !== undefined));
  return made;
}

const color_chip = rgb => {
  const chip = element("i", {className: "key", "aria-hidden": "true"});
  chip.style.background = `rgb(${rgb})`;
  return chip;
};

function copy_button(text) {
  const button = element("button", {type: "button", className: "small", onclick: async () => {
    try {
      await navigator.clipboard.writeText(text());
      button.textContent = "Copied";
    } catch {
      button.textContent = "Press Ctrl+C";  // a page from a file may have no clipboard; its text is selected instead
      getSelection().selectAllChildren(button.previousElementSibling);
    }
    setTimeout(() => { button.textContent = "Copy"; }, 1500);
  }}, "Copy");
  return button;
}

class Inspector {
  constructor(manifest, layers, panes) {
    Object.assign(this, {manifest, layers, panes});
    this.readout = element("output", {className: "readout"});
    this.card = element("section", {className: "card pixel", "aria-live": "polite", "aria-label": "The pixel that was clicked"});
    this.points = new Map();
    for (const point of manifest.points) {
      const key = `${point.x},${point.y}`;
      if (!this.points.has(key)) this.points.set(key, []);
      this.points.get(key).push(point);
    }
    this.show_cursor(null);
    this.show_pin(null);
  }

  /// A layer's values at a pixel as text: `12 34 56 255`.
  text_of(layer, x, y, wanted) {
    const codes = layer.pixel(x, y, wanted);
    if (!codes) return "\u2026";
    if (layer.look === "classes") return layer.classes[codes[0]].name;
    return codes.map((code, k) => stored_text(layer, code, k)).join("  ");
  }

  show_cursor(pixel) {
    this.at = pixel;
    const parts = [];
    if (!pixel) {
      parts.push(element("span", {className: "quiet"}, this.hint || "Point at a pixel to read it."));
    } else {
      const [x, y] = pixel, again = () => { if (this.at === pixel) this.show_cursor(pixel); };
      parts.push(element("b", {}, `${x}, ${y}`));
      for (const layer of this.layers.values())
        if (layer.read && layer.whole)
          parts.push(element("span", {}, element("span", {className: "quiet"}, `${layer.name} `), this.text_of(layer, x, y, again)));
    }
    this.readout.replaceChildren(...parts);
  }

  show_pin(pixel) {
    this.pinned = pixel;
    this.card.classList.toggle("empty", !pixel);  // which is left out on paper
    if (!pixel) {
      this.card.replaceChildren(
        element("h3", {}, "Pixel"),
        element("p", {className: "quiet small wide"}, "Click a pixel, or press Enter for the one in the middle, to keep it here with what is known of it."));
      return;
    }
    const [x, y] = pixel, again = () => { if (this.pinned === pixel) this.show_pin(pixel); };
    const values = element("div", {}), reasons = element("div", {});
    if (this.manifest.compared) values.append(this.comparison_at(x, y, again));
    values.append(...this.planes_at(x, y, again));
    reasons.append(...this.classes_at(x, y, again));
    for (const point of this.points.get(`${x},${y}`) || [])
      reasons.append(element("h4", {}, point.title), element("pre", {className: "explanation"}, point.text));
    const parts = [element("h3", {}, `Pixel ${x}, ${y} `, element("span", {className: "quiet small"}, "column, row from the top left, from 0")), values];
    if (reasons.childElementCount) parts.push(reasons);
    if (this.manifest.explain) {
      const command = this.manifest.explain.replaceAll("{x}", x).replaceAll("{y}", y);
      parts.push(element("div", {className: "wide"}, element("p", {className: "quiet small"}, "Every triangle, light, blend and store of this pixel, with each rounding:"),
                         element("div", {className: "command"}, element("code", {}, command), copy_button(() => command))));
    }
    this.card.replaceChildren(...parts);
  }

  classes_at(x, y, again) {
    const parts = [];
    for (const layer of this.layers.values()) {
      if (layer.look !== "classes" || !layer.whole) continue;
      const codes = layer.pixel(x, y, again);
      if (!codes) continue;
      const found = layer.classes[codes[0]];
      parts.push(element("p", {className: "class-line"}, color_chip(found.color), element("b", {}, found.name), ` ${layer.stage || ""}`,
                         element("br"), element("span", {className: "quiet"}, found.meaning)));
    }
    return parts;
  }

  /// Both values of each channel, how far they are apart, and what is legal.
  comparison_at(x, y, again) {
    const {compared} = this.manifest, layer_of = id => id && this.layers.get(id);
    const [reference, test] = [compared.reference, compared.test].map(layer_of);
    const [from, to] = [reference, test].map(layer => layer.pixel(x, y, again));
    const legal = (this.points.get(`${x},${y}`) || []).find(point => point.legal)?.legal;
    if (!from || !to) return element("p", {className: "quiet"}, "\u2026");
    const head = ["", reference.name, test.name, "Test \u2212 ref."].concat(legal ? ["Legal"] : []);
    const rows = from.map((code, k) => element("tr", {className: code === to[k] ? "" : "differs"},
      element("th", {scope: "row"}, reference.channel_names[k]),
      element("td", {}, stored_text(reference, code, k)), element("td", {}, stored_text(test, to[k], k)),
      element("td", {}, difference_text(reference, code, to[k], k)),
      legal ? element("td", {}, legal[k] ? this.legal_text(legal[k]) : "") : null));
    return element("div", {}, element("div", {className: "scroll"},
                   element("table", {className: "values"}, element("thead", {}, element("tr", {}, ...head.map(name => element("th", {scope: "col"}, name)))),
                   element("tbody", {}, ...rows))),
                   element("p", {className: "quiet small"}, compared.about, legal ? " Legal is what OpenGL allows any GPU on the captured surface." : null));
  }

  legal_text([low, high]) {
    const text = value => typeof value === "number" ? String(Number(value.toPrecision(9))).replace("-", "\u2212") : value;
    return low === high ? text(low) : `${text(low)} \u2026 ${text(high)}`;
  }

  planes_at(x, y, again) {
    const {compared = {}} = this.manifest, shown_above = new Set([compared.reference, compared.test]);
    const rows = [];
    for (const layer of this.layers.values()) {
      if (!layer.whole || layer.look === "classes" || layer.look === "difference" || shown_above.has(layer.id)) continue;
      const name = layer.channel_names.length > 1 ? `${layer.name} ${layer.channel_names.join(" ")}` : layer.name;
      rows.push(element("tr", {}, element("th", {scope: "row", title: layer.about}, name), element("td", {}, this.text_of(layer, x, y, again))));
    }
    return rows.length ? [element("table", {className: "values planes"}, element("tbody", {}, ...rows))] : [];
  }
}
