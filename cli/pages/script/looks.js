// Looks: how the values of a layer become colours. Nothing here changes a value.

/// What a reader can set: how much differences are enlarged, how bright linear light is shown, which classes are shown.
const looks = {gain: 16, exposure: 0, hidden_classes: new Set()};

const kNotANumber = [255, 0, 255], kNothing = [24, 26, 31];
const kHiddenShare = 0.35;  // of its brightness that the picture keeps under classes that are switched off

const clamped = share => share > 0 ? Math.min(share, 1) * 255 + 0.5 : 0;  // NaN gives 0
const encoded = value => value <= 0.0031308 ? value * 12.92 : 1.055 * value ** (1 / 2.4) - 0.055;  // IEC 61966-2-1

/// sRGB codes of floats by their upper bits: 9 bits of fraction are more than 8 bits of code can show.
const light_tables = new Map();
function light_table(bits, exposure) {
  const key = `${bits} ${exposure}`;
  if (!light_tables.has(key)) {
    if (light_tables.size > 8) light_tables.clear();
    const brighter = 2 ** exposure, size = bits === 32 ? 1 << 17 : 2 ** bits;
    light_tables.set(key, Uint8Array.from({length: size}, (_, code) => {
      const value = bits === 32 ? float_of_code((code << 14) >>> 0) : small_table(bits)[code];
      return clamped(encoded(value * brighter));
    }));
  }
  return light_tables.get(key);
}

function is_nan_code(code, bits) {
  return bits === 32 ? (code & 0x7fffffff) > 0x7f800000 : Number.isNaN(small_table(bits)[code]);
}

/// Colours of a layer's codes: out[i] for pixel i is set by set(i, r, g, b).
const painters = {
  /// Codes as a screen is sent them; of one channel grey.
  codes(layer, codes, set) {
    const {channels, largest} = layer, scale = largest.map(most => 255 / most);
    for (let i = 0, at = 0; at < codes.length; ++i, at += channels) {
      if (channels < 3) set(i, codes[at] * scale[0], codes[at] * scale[0], codes[at] * scale[0]);
      else set(i, codes[at] * scale[0], codes[at + 1] * scale[1], codes[at + 2] * scale[2]);
    }
  },
  /// Linear light, brighter by 2^exposure, as sRGB codes.
  linear(layer, codes, set) {
    const {channels, widths} = layer, tables = widths.map(bits => light_table(bits, looks.exposure));
    const shift = widths.map(bits => bits === 32 ? 14 : 0);
    const shown = (code, k) => widths[k] === 32 && code >>> 31 ? 0 : tables[k][code >>> shift[k]];
    for (let i = 0, at = 0; at < codes.length; ++i, at += channels) {
      const second = channels > 1 ? 1 : 0, third = channels > 2 ? 2 : 0;
      if (is_nan_code(codes[at], widths[0]) || is_nan_code(codes[at + second], widths[second]) ||
          is_nan_code(codes[at + third], widths[third]))
        set(i, ...kNotANumber);
      else set(i, shown(codes[at], 0), shown(codes[at + second], second), shown(codes[at + third], third));
    }
  },
  /// Unit vectors, (N + 1) / 2; all 0 is nothing.
  direction(layer, codes, set) {
    const {channels} = layer;
    for (let i = 0, at = 0; at < codes.length; ++i, at += channels) {
      if (!(codes[at] | codes[at + 1] | codes[at + 2])) set(i, ...kNothing);
      else set(i, ...[0, 1, 2].map(k => clamped((layer.value(codes[at + k], k) + 1) / 2)));
    }
  },
  /// Each channel from the least to the most it has in the picture; `extent` says both. All 0 is nothing.
  extent(layer, codes, set) {
    const {channels, extent} = layer;
    const share = (at, k) => {
      const [low, high] = extent[k];
      return high === low ? 128 : clamped((layer.value(codes[at + k], k) - low) / (high - low));
    };
    for (let i = 0, at = 0; at < codes.length; ++i, at += channels) {
      if (!(codes[at] | codes[at + (channels > 1 ? 1 : 0)] | codes[at + (channels > 2 ? 2 : 0)])) {
        set(i, ...kNothing);
        continue;
      }
      const first = share(at, 0);
      if (channels < 3) set(i, first, first, first);
      else set(i, first, share(at, 1), share(at, 2));
    }
  },
  /// A heat map of a count.
  counts(layer, codes, set) {
    const {channels, heat, most} = layer, steps = heat.length - 1;
    for (let i = 0, at = 0; at < codes.length; ++i, at += channels)
      set(i, ...heat[Math.min(steps, Math.floor(codes[at] * steps / most))]);
  },
  /// A colour for each number, so that neighbours differ; 0 is nothing.
  ids(layer, codes, set) {
    for (let i = 0, at = 0; at < codes.length; ++i, at += layer.channels) {
      const mixed = Math.imul(codes[at] ^ codes[at] >>> 15, 0x9e3779b1) ^ codes[at];
      if (codes[at] === 0) set(i, ...kNothing);
      else set(i, 64 + (mixed >>> 8 & 127), 64 + (mixed >>> 16 & 127), 64 + (mixed >>> 24 & 127));
    }
  },
};

/// How far the larger of two codes' channels are apart, enlarged, as a colour.
function paint_difference(layer, first, second, set) {
  const {channels, is_float, widths, largest} = layer;
  const scale = is_float ? 255 * looks.gain * 2 ** looks.exposure : 0;
  for (let i = 0, at = 0; at < first.length; ++i, at += channels) {
    const rgb = [0, 0, 0];
    let unlike = false;
    for (let k = 0; k < channels; ++k) {
      const a = first[at + k], b = second[at + k];
      if (a === b) continue;
      let apart = 0;
      if (is_float) {
        const from = layer.value(a, k), to = layer.value(b, k);
        if (Number.isNaN(from) !== Number.isNaN(to)) unlike = true;
        apart = from === to ? 0 : Math.abs(from - to) * scale;
      } else {
        apart = Math.abs(a - b) * 255 / largest[k] * looks.gain;
      }
      if (k < 3 && channels >= 3) rgb[k] = apart;
      else for (let j = 0; j < 3; ++j) rgb[j] = Math.max(rgb[j], apart);  // alpha, or a plane of one channel: grey
    }
    if (unlike) set(i, ...kNotANumber);
    else set(i, rgb[0], rgb[1], rgb[2]);
  }
}

function paint_classes(layer, codes, under, set) {
  const colors = layer.classes.map(c => c.color), hidden = layer.classes.map(c => looks.hidden_classes.has(c.name));
  for (let i = 0; i < codes.length; ++i) {
    if (!hidden[codes[i]]) set(i, ...colors[codes[i]]);
    else if (under) set(i, ...under(i));
    else set(i, 16, 17, 20);
  }
}

/// Pixels as a canvas, of which each stands for `cell` by `cell` of them; `rank` of several pixels picks the one shown.
function canvas_of(width, height, paint, cell, rank) {
  const whole = new Uint8ClampedArray(width * height * 4);
  paint((i, r, g, b) => { whole[4 * i] = r; whole[4 * i + 1] = g; whole[4 * i + 2] = b; whole[4 * i + 3] = 255; });
  const canvas = document.createElement("canvas");
  canvas.width = Math.ceil(width / cell);
  canvas.height = Math.ceil(height / cell);
  const context = canvas.getContext("2d");
  if (cell === 1) {
    context.putImageData(new ImageData(whole, width, height), 0, 0);
    return canvas;
  }
  const shown = context.createImageData(canvas.width, canvas.height), best = new Float64Array(canvas.width * canvas.height).fill(-1);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const from = y * width + x, to = Math.floor(y / cell) * canvas.width + Math.floor(x / cell);
      const value = rank ? rank(from) : whole[4 * from] + whole[4 * from + 1] + whole[4 * from + 2];
      if (value <= best[to]) continue;
      best[to] = value;
      for (let k = 0; k < 4; ++k) shown.data[4 * to + k] = whole[4 * from + k];
    }
  context.putImageData(shown, 0, 0);
  return canvas;
}
