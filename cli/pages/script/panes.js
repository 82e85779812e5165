// Panes: every picture is drawn through one view (the image point in the middle, and CSS pixels a pixel), so all move
// together. A canvas is as large as its pane, never as the image.

const painted_tiles = new RecentlyUsed(256 * kMebibyte);
const kValuesFrom = 44;  // CSS pixels a pixel: from here on its values stand in it
const kLargestZoom = 160, kMark = 5;  // CSS pixels

/// What changes the colours of a layer's tiles.
function look_key(layer) {
  if (layer.look === "difference") return `${looks.gain} ${layer.is_float ? looks.exposure : 0}`;
  if (layer.look === "linear") return `${looks.exposure}`;
  if (layer.look === "classes") return [...looks.hidden_classes].join(" ");
  return "";
}

class Panes {
  constructor(manifest, layers, changed) {
    Object.assign(this, {manifest, layers, changed});
    this.width = manifest.width;
    this.height = manifest.height;
    this.view = {x: this.width / 2, y: this.height / 2, zoom: 0};  // zoom 0: as large as fits
    this.list = [];
    this.pin = null;
    this.cursor = null;
    this.marks = [];
    this.split = 0.5;
    this.is_due = false;
    this.missing = 0;
    this.sizes = new ResizeObserver(() => this.redraw());
    // Reduced pictures, which are for paper too: they stand where a layer of their name is not yet unpacked.
    this.small = new Map([...document.querySelectorAll(".static img")].map(image => [image.alt, image]));
  }

  /// Shows these, each {canvas, layer} or, for the slider, {canvas, layer, right}.
  show(list) {
    for (const pane of this.list) this.sizes.unobserve(pane.canvas);
    this.list = list;
    for (const pane of list) this.sizes.observe(pane.canvas);
    this.redraw();
  }

  get pane_size() {
    const canvas = this.list[0].canvas;
    return [Math.max(canvas.clientWidth, 1), Math.max(canvas.clientHeight, 1)];
  }
  get fit_zoom() {
    const [width, height] = this.pane_size;
    return Math.min(width / this.width, height / this.height);
  }
  get zoom() { return this.view.zoom || this.fit_zoom; }

  /// The image point under a point of a pane.
  point_at(left, top) {
    const [width, height] = this.pane_size;
    return [this.view.x + (left - width / 2) / this.zoom, this.view.y + (top - height / 2) / this.zoom];
  }
  pixel_at(left, top) {
    const [x, y] = this.point_at(left, top).map(Math.floor);
    return x >= 0 && y >= 0 && x < this.width && y < this.height ? [x, y] : null;
  }

  zoom_to(zoom, left, top) {
    const [width, height] = this.pane_size, fit = this.fit_zoom;
    const [x, y] = this.point_at(left ?? width / 2, top ?? height / 2);
    const next = Math.min(Math.max(zoom, Math.min(fit, 1)), kLargestZoom);
    this.view.zoom = next <= fit * 1.001 && fit < 1 ? 0 : next;
    this.view.x = x - ((left ?? width / 2) - width / 2) / this.zoom;
    this.view.y = y - ((top ?? height / 2) - height / 2) / this.zoom;
    this.moved();
  }
  fit() {
    this.view = {x: this.width / 2, y: this.height / 2, zoom: 0};
    this.moved();
  }
  pan(dx, dy) {
    this.view.x -= dx / this.zoom;
    this.view.y -= dy / this.zoom;
    this.moved();
  }
  centre_on(x, y, zoom) {
    this.view = {x: x + 0.5, y: y + 0.5, zoom: Math.min(zoom, kLargestZoom)};
    this.moved();
  }
  moved() {
    // Some of the image stays in sight; an image that fits stays whole in sight.
    const [width, height] = this.pane_size, half_x = width / 2 / this.zoom, half_y = height / 2 / this.zoom;
    const held = (at, half, size) => size <= 2 * half ? size / 2 : Math.min(Math.max(at, half), size - half);
    this.view.x = held(this.view.x, half_x, this.width);
    this.view.y = held(this.view.y, half_y, this.height);
    this.changed();
    this.redraw();
  }

  redraw() {
    if (this.is_due) return;
    this.is_due = true;
    requestAnimationFrame(() => {
      this.is_due = false;
      this.missing = 0;  // tiles that are not yet unpacked
      if (this.list.length) for (const pane of this.list) this.draw(pane);
    });
  }

  draw(pane) {
    const {canvas} = pane, ratio = window.devicePixelRatio || 1;
    const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
    if (!width || !height) return;
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    const context = canvas.getContext("2d");
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = "#0c0d10";
    context.fillRect(0, 0, width, height);
    const frame = {context, ratio, zoom: this.zoom * ratio,
                   left: width / 2 - this.view.x * this.zoom * ratio, top: height / 2 - this.view.y * this.zoom * ratio};
    if (pane.right) {
      const edge = Math.round(this.split * width);
      this.draw_side(pane.layer, frame, 0, edge, height);
      this.draw_side(pane.right, frame, edge, width, height);
    } else {
      this.draw_side(pane.layer, frame, 0, width, height);
    }
    this.draw_pixel_frame(frame, this.cursor, "#ffffff", 1);
    this.draw_pixel_frame(frame, this.pin, "#ffb000", 2);
  }

  draw_side(layer, frame, from, to, height) {
    const {context} = frame;
    context.save();
    context.beginPath();
    context.rect(from, 0, to - from, height);
    context.clip();
    const area = {from, to, height};
    const reduced = layer.reduced, small = this.small.get(layer.name);
    if (small?.complete && !this.is_painted(layer, reduced || layer.whole_level, frame, area))
      context.drawImage(small, frame.left, frame.top, this.width * frame.zoom, this.height * frame.zoom);
    if (!reduced || frame.zoom * reduced.scale > 1.5) {
      if (reduced && !this.is_painted(layer, layer.whole_level, frame, area)) this.draw_level(layer, reduced, frame, area);
      this.draw_level(layer, layer.whole_level, frame, area);
    } else {
      this.draw_level(layer, reduced, frame, area);
    }
    if (layer.look === "classes") this.draw_marks(layer, frame);
    if (this.zoom >= kValuesFrom) this.draw_values(layer, frame, area);
    context.restore();
  }

  tiles_in(level, frame, area) {
    const step = level.tile * level.scale * frame.zoom;
    const bound = (at, most) => Math.min(Math.max(at, 0), most);
    return {first_column: bound(Math.floor((area.from - frame.left) / step), level.columns),
            first_row: bound(Math.floor(-frame.top / step), level.rows),
            last_column: bound(Math.ceil((area.to - frame.left) / step), level.columns),
            last_row: bound(Math.ceil((area.height - frame.top) / step), level.rows)};
  }
  each_tile(level, frame, area, job) {
    const t = this.tiles_in(level, frame, area);
    for (let row = t.first_row; row < t.last_row; ++row)
      for (let column = t.first_column; column < t.last_column; ++column) job(column, row);
  }
  /// How many pixels of a level share a canvas pixel: of classes and differences the largest of them is shown.
  cell_of(layer, level, frame) {
    if (layer.look !== "classes" && layer.look !== "difference") return 1;
    return 2 ** Math.max(0, Math.min(6, Math.floor(Math.log2(1 / (frame.zoom * level.scale)))));
  }
  key_of(layer, level, frame, column, row) {
    return `${layer.id} ${level.scale} ${column} ${row} ${this.cell_of(layer, level, frame)} ${look_key(layer)}`;
  }
  is_painted(layer, level, frame, area) {
    let all = true;
    this.each_tile(level, frame, area, (column, row) => {
      all = all && painted_tiles.get(this.key_of(layer, level, frame, column, row)) !== undefined;
    });
    return all;
  }

  draw_level(layer, level, frame, area) {
    const {context, zoom, left, top} = frame;
    const is_coarse = zoom * level.scale < 1;
    context.imageSmoothingEnabled = is_coarse && layer.look !== "classes";
    context.imageSmoothingQuality = "high";
    this.each_tile(level, frame, area, (column, row) => {
      const canvas = this.painted(layer, level, frame, column, row);
      if (!canvas) return;
      const [width, height] = level.size_of(column, row), x = column * level.tile, y = row * level.tile;
      const at = (origin, pixels) => Math.round(origin + Math.min(pixels * level.scale, 1e9) * zoom);
      const x0 = at(left, x), y0 = at(top, y);
      context.drawImage(canvas, x0, y0, at(left, x + width) - x0, at(top, y + height) - y0);
    });
  }

  /// A tile in colours; where its values are still packed, the colours it had last, and it is drawn again soon.
  painted(layer, level, frame, column, row) {
    const key = this.key_of(layer, level, frame, column, row), place = `${layer.id} ${level.scale} ${column} ${row}`;
    const canvas = painted_tiles.get(key);
    if (canvas) return canvas;
    const needs = this.sources_of(layer, level).map(source => [source, source.known(column, row)]);
    if (needs.some(([, codes]) => !codes)) {
      ++this.missing;
      Promise.all(needs.map(([source]) => source.codes(column, row))).then(() => this.redraw());
      const last = this.last_keys?.get(place);
      return last && painted_tiles.get(last);
    }
    const made = this.paint(layer, level, needs.map(([, codes]) => codes), this.cell_of(layer, level, frame),
                            level.size_of(column, row));
    this.last_keys = this.last_keys || new Map();
    painted_tiles.delete(this.last_keys.get(place));
    this.last_keys.set(place, key);
    painted_tiles.set(key, made, made.width * made.height * 4);
    return made;
  }

  /// The packed values that a layer's colours are made of.
  sources_of(layer, level) {
    if (layer.look === "difference" && level.scale === 1) return layer.of.map(id => this.layers.get(id).whole);
    if (layer.look === "classes" && layer.under && looks.hidden_classes.size && level.scale === 1)
      return [level, this.layers.get(layer.under).whole];
    return [level];
  }

  paint(layer, level, codes, cell, [width, height]) {
    if (layer.look === "difference") {
      const is_whole = level.scale === 1, of = is_whole ? this.layers.get(layer.of[0]) : layer;  // reduced: from 0
      const second = is_whole ? codes[1] : new codes[0].constructor(codes[0].length);
      return canvas_of(width, height, set => paint_difference(of, codes[0], second, set), cell);
    }
    if (layer.look === "classes") {
      const picture = codes[1] && this.layers.get(layer.under);
      const grey = picture && this.grey_of(picture, codes[1], width * height);
      const ranks = layer.classes.map(c => looks.hidden_classes.has(c.name) ? -0.5 : c.rank);
      return canvas_of(width, height, set => paint_classes(layer, codes[0], grey && (i => [grey[i], grey[i], grey[i]]), set),
                       cell, i => ranks[codes[0][i]]);
    }
    return canvas_of(width, height, set => painters[layer.look](layer, codes[0], set), 1);
  }
  grey_of(layer, codes, pixels) {
    const grey = new Uint8ClampedArray(pixels);
    painters[layer.look](layer, codes, (i, r, g, b) => { grey[i] = (0.3 * r + 0.6 * g + 0.1 * b) * kHiddenShare; });
    return grey;
  }

  /// Violations are single pixels: where pixels are small, each has a square of its own.
  draw_marks(layer, frame) {
    const side = kMark * frame.ratio;
    if (frame.zoom >= side || looks.hidden_classes.has("VIOLATION")) return;
    frame.context.fillStyle = `rgb(${this.mark_color})`;
    for (const [x, y] of this.marks.filter(mark => mark[2] === undefined || mark[2] === layer.id))
      frame.context.fillRect(Math.round(frame.left + (x + 0.5) * frame.zoom - side / 2),
                             Math.round(frame.top + (y + 0.5) * frame.zoom - side / 2), side, side);
  }

  draw_pixel_frame({context, zoom, left, top, ratio}, pixel, color, weight) {
    if (!pixel) return;
    const side = Math.max(zoom, 7 * ratio), line = weight * ratio;
    const x = left + (pixel[0] + 0.5) * zoom - side / 2, y = top + (pixel[1] + 0.5) * zoom - side / 2;
    context.lineWidth = line + 2 * ratio;
    context.strokeStyle = "#000000";
    context.strokeRect(x, y, side, side);
    context.lineWidth = line;
    context.strokeStyle = color;
    context.strokeRect(x, y, side, side);
  }

  draw_values(layer, frame, area) {
    const {context, zoom, left, top, ratio} = frame;
    const first_x = Math.max(0, Math.floor((area.from - left) / zoom)), first_y = Math.max(0, Math.floor(-top / zoom));
    const last_x = Math.min(this.width, Math.ceil((area.to - left) / zoom));
    const last_y = Math.min(this.height, Math.ceil((area.height - top) / zoom));
    context.textAlign = "center";
    context.textBaseline = "middle";
    for (let y = first_y; y < last_y; ++y)
      for (let x = first_x; x < last_x; ++x) {
        const lines = this.values_of(layer, x, y);
        if (!lines) continue;
        const longest = Math.max(...lines.map(line => line.length));
        const size = Math.min(zoom / (lines.length + 0.6) / 1.1, zoom / longest * 1.5, 15 * ratio);
        context.font = `${size}px ui-monospace, Menlo, Consolas, monospace`;
        context.lineWidth = size / 4;
        context.lineJoin = "round";
        lines.forEach((line, i) => {
          const at_x = left + (x + 0.5) * zoom, at_y = top + (y + 0.5) * zoom + (i - (lines.length - 1) / 2) * size * 1.12;
          context.strokeStyle = "rgb(0 0 0 / 0.75)";
          context.strokeText(line, at_x, at_y);
          context.fillStyle = "#ffffff";
          context.fillText(line, at_x, at_y);
        });
      }
  }

  values_of(layer, x, y) {
    const again = () => this.redraw();
    if (layer.look === "difference") {
      const [from, to] = layer.of.map(id => this.layers.get(id).pixel(x, y, again));
      return from && to && from.map((code, k) => difference_text(this.layers.get(layer.of[0]), code, to[k], k));
    }
    const codes = layer.pixel(x, y, again);
    if (!codes) return null;
    if (layer.look === "classes") return [layer.classes[codes[0]].name];
    return codes.map((code, k) => short_text(layer, code, k));
  }
}

/// Test minus reference, with its sign.
function difference_text(layer, from, to, channel, digits = 3) {
  if (from === to) return "0";
  const apart = layer.value(to, channel) - layer.value(from, channel);
  if (Number.isNaN(apart)) return "NaN";
  const text = layer.is_float ? String(Number(Math.abs(apart).toPrecision(digits))) : String(Math.abs(apart));
  return (apart < 0 ? "\u2212" : "+") + text;
}
