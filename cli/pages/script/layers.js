// Layers: the values of each pixel, unpacked tile by tile as they are looked at.

const read_table = id => document.getElementById(id).textContent;

function bytes_of_base64(text) {
  const binary = atob(text), bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/// What was looked at last stays, as many bytes of it as `most`.
class RecentlyUsed {
  constructor(most) { this.most = most; this.bytes = 0; this.entries = new Map(); }
  get(key) {
    const entry = this.entries.get(key);
    if (!entry) return undefined;
    this.entries.delete(key);
    this.entries.set(key, entry);
    return entry.value;
  }
  set(key, value, bytes) {
    this.delete(key);
    this.entries.set(key, {value, bytes});
    this.bytes += bytes;
    for (const [oldest] of this.entries) {
      if (this.bytes <= this.most || oldest === key) break;
      this.delete(oldest);
    }
  }
  delete(key) {
    const entry = this.entries.get(key);
    if (!entry) return;
    this.bytes -= entry.bytes;
    this.entries.delete(key);
  }
}

const kMebibyte = 1 << 20;
const decoded_tiles = new RecentlyUsed(256 * kMebibyte);

/// Adds to each code the neighbour that PNG's filter Paeth predicts it by (PNG, section 9.4), modulo its size.
function undo_prediction(codes, width, height, channels) {
  const row = width * channels;
  for (let y = 0; y < height; ++y)
    for (let i = y * row, end = i + row, first = i + channels; i < end; ++i) {
      const left = i >= first ? codes[i - channels] : 0, up = y > 0 ? codes[i - row] : 0;
      if (left === up) { codes[i] += left; continue; }
      const corner = i >= first && y > 0 ? codes[i - row - channels] : 0;
      const guess = left + up - corner;
      const by_left = Math.abs(guess - left), by_up = Math.abs(guess - up), by_corner = Math.abs(guess - corner);
      codes[i] += by_left <= by_up && by_left <= by_corner ? left : by_up <= by_corner ? up : corner;
    }
}

/// One picture of a layer: all of it, or all of it reduced by a whole factor.
class Level {
  constructor(layer, spec, tile) {
    Object.assign(this, {layer, tile, scale: spec.scale, width: spec.width, height: spec.height, id: spec.data});
    this.columns = Math.ceil(this.width / tile);
    this.rows = Math.ceil(this.height / tile);
    this.lines = null;
    this.waiting = new Map();
    this.base = null;
  }

  size_of(column, row) {
    return [Math.min(this.tile, this.width - column * this.tile), Math.min(this.tile, this.height - row * this.tile)];
  }

  /// The codes of a tile, channel beside channel; undefined where they have not been unpacked.
  known(column, row) { return decoded_tiles.get(`${this.id} ${column} ${row}`); }

  /// The same, unpacked where they have to be.
  codes(column, row) {
    const known = this.known(column, row);
    if (known) return Promise.resolve(known);
    const index = row * this.columns + column;
    if (!this.waiting.has(index)) {
      this.waiting.set(index, this.unpack(column, row, index).then(codes => {
        decoded_tiles.set(`${this.id} ${column} ${row}`, codes, codes.byteLength);
        this.waiting.delete(index);
        return codes;
      }));
    }
    return this.waiting.get(index);
  }

  async unpack(column, row, index) {
    this.lines = this.lines || read_table(this.id).split("\n");
    const [width, height] = this.size_of(column, row), pixels = width * height;
    const {channels, bits} = this.layer;
    const codes = new (bits === 8 ? Uint8Array : bits === 16 ? Uint16Array : Uint32Array)(pixels * channels);
    if (this.lines[index] !== "") {
      const bytes = await inflated(bytes_of_base64(this.lines[index]));
      for (let channel = 0, from = 0; channel < channels; ++channel)
        for (let shift = 0; shift < bits; shift += 8)
          for (let i = channel, end = pixels * channels; i < end; i += channels) codes[i] |= bytes[from++] << shift;
    }
    if (!this.base) {
      undo_prediction(codes, width, height, channels);
      return codes;
    }
    const base = await this.base.codes(column, row);
    for (let i = 0; i < codes.length; ++i) codes[i] += base[i];
    return codes;
  }
}

const float_word = new Uint32Array(1), float_value = new Float32Array(float_word.buffer);
const float_of_code = code => { float_word[0] = code; return float_value[0]; };

/// Floats of 16, 11 or 10 bits: five bits of exponent, a sign where there are 16.
function small_float_of_code(code, bits) {
  const fraction = bits === 16 ? 10 : bits - 5, one = 2 ** fraction;
  const sign = bits === 16 && code >> 15 ? -1 : 1, exponent = (code >> fraction) & 31, rest = code & (one - 1);
  if (exponent === 31) return rest ? NaN : sign * Infinity;
  return sign * (exponent ? (1 + rest / one) * 2 ** (exponent - 15) : rest / one * 2 ** -14);
}

const small_tables = new Map();
function small_table(bits) {
  if (!small_tables.has(bits))
    small_tables.set(bits, Float64Array.from({length: 2 ** bits}, (_, code) => small_float_of_code(code, bits)));
  return small_tables.get(bits);
}

/// A plane of the page: its name, how it is to be shown, and the codes of its pixels.
class Layer {
  constructor(spec, tile) {
    Object.assign(this, spec);
    this.levels = spec.levels.map(level => new Level(this, level, tile));
  }
  get whole() { return this.levels.find(level => level.scale === 1); }
  get reduced() { return this.levels.find(level => level.scale > 1); }
  get is_float() { return this.numbers === "float"; }

  value(code, channel) {
    if (!this.is_float) return code;
    return this.widths[channel] === 32 ? float_of_code(code) : small_table(this.widths[channel])[code];
  }

  /// The codes of one pixel, or null where its tile has not been unpacked; `wanted` is called once it has.
  pixel(x, y, wanted) {
    const level = this.whole;
    if (!level) return null;
    const column = Math.floor(x / level.tile), row = Math.floor(y / level.tile), codes = level.known(column, row);
    if (!codes) {
      if (wanted) level.codes(column, row).then(wanted);
      return null;
    }
    const [width] = level.size_of(column, row);
    const at = ((y - row * level.tile) * width + x - column * level.tile) * this.channels;
    return Array.from(codes.subarray(at, at + this.channels));
  }
}

/// A float in the fewest digits that give it back.
function float_text(value, bits) {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "NaN" : value > 0 ? "+Inf" : "\u2212Inf";
  if (value === 0) return Object.is(value, -0) ? "\u22120" : "0";
  const back = bits === 32 ? Math.fround : v => v;
  for (let digits = 1; digits <= 9; ++digits) {
    const text = value.toPrecision(digits);
    if (back(Number(text)) === value) return String(Number(text)).replace("-", "\u2212");
  }
  return value.toPrecision(9).replace("-", "\u2212");
}

/// A pixel's channel as it is stored: a code, a count or a float.
function stored_text(layer, code, channel) {
  return layer.is_float ? float_text(layer.value(code, channel), layer.widths[channel]) : String(code);
}

/// As much of it as stands inside a magnified pixel.
function short_text(layer, code, channel) {
  if (!layer.is_float) return String(code);
  const value = layer.value(code, channel);
  if (!Number.isFinite(value)) return float_text(value, 32);
  const size = Math.abs(value);
  return (size !== 0 && (size < 1e-3 || size >= 1e5) ? value.toExponential(1) : String(Number(value.toPrecision(4))))
    .replace("-", "\u2212");
}
